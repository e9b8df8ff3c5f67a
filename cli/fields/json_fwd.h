// SPDX-License-Identifier: MIT
#pragma once
/// Declares the type Json for headers; nlohmann's own header takes long to compile.

#include <nlohmann/json_fwd.hpp>

namespace gatewalk::cli {

using Json = nlohmann::ordered_json;

}  // namespace gatewalk::cli
