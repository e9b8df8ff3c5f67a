// SPDX-License-Identifier: MIT
#pragma once
/// JSON as a value, for what reads it; json.h writes JSON. The functions of both are in json.cpp.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cli/fields/fields.h"
#include "cli/fields/json_fwd.h"

namespace gatewalk::cli {

/// Of a text; one that is_discarded() where it is no JSON.
[[nodiscard]] Json parsed_json(std::string_view text);

/// Of what is described, to read in it or to change it.
[[nodiscard]] Json json_of(const Description& describe);

/// NaN for null.
[[nodiscard]] inline double number_in(const Json& json) {
  return json.is_null() ? kUnknown : json.get<double>();
}

/// As json_text writes it.
[[nodiscard]] std::string text_of(const Json& json, int indent = 2);

}  // namespace gatewalk::cli
