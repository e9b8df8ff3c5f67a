// SPDX-License-Identifier: MIT
/// Writes the schema of each command's results into a folder.   schemas FOLDER
#include <cstdio>
#include <exception>
#include <string>

#include "cli/render/schema.h"
#include "cli/terminal/output.h"

int main(int count, char** words) {
  if (count != 2) {
    std::fputs("schemas FOLDER\n", stderr);
    return 2;
  }
  try {
    for (const auto& result : gatewalk::cli::results())
      gatewalk::cli::write_text_atomically(
          std::string(words[1]) + "/" + result.command + ".schema.json",
          gatewalk::cli::schema_of(result));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "schemas: %s\n", e.what());
    return 1;
  }
}
