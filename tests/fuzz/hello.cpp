// SPDX-License-Identifier: MIT
// The first line of a cell program.
#include "cli/cells/hello.h"

#include "tests/fuzz/fuzz.h"

namespace gatewalk::fuzz {

void hello(std::string_view bytes) {
  const auto hello = accepted([&] { return cli::read_hello(bytes); });
  if (!hello) return;
  hello->section.validate();
  require(
      hello->normals >= 0 && hello->uniforms >= 0 && (hello->normals == 0 || hello->uniforms == 0),
      "noise is of one kind");
  for (const cli::Hello::Parameter& p : hello->parameters)
    require(p.permits(p.number.value) && !p.range().empty(), "a parameter permits its own value");
}

}  // namespace gatewalk::fuzz
