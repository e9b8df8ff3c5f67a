// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace gatewalk::fuzz {

/// Reads a matrix file and its content, as commands do.
void use_matrix(const std::string& path);

}  // namespace gatewalk::fuzz
