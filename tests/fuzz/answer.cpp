// SPDX-License-Identifier: MIT
// What a cell program writes behind its first line: an answer a line.
#include "cli/cells/answer.h"

#include <cmath>
#include <optional>

#include "cli/cells/hello.h"
#include "tests/fuzz/fuzz.h"

namespace gatewalk::fuzz {
namespace {

constexpr const char* kHello =
    R"({"gatewalk": 1, "costs": [{"key": "time_s", "unit": "s"}, {"key": "work_J", "unit": "J"}],
"coordinates": [{"name": "s", "unit": "m", "scale": 1}, {"name": "v", "unit": "m s-1", "scale": 1}],
"faces": [{"name": "S", "move": [0, 1]}, {"name": "W", "move": [1, 0], "mirror": "E"},
{"name": "E", "move": [-1, 0], "mirror": "W"}]})";

}  // namespace

void answer(std::string_view bytes) {
  static const dynamics::Section section = cli::read_hello(kHello).section;
  while (!bytes.empty()) {
    const std::string_view line = take_line(bytes);
    dynamics::Body body{.entry = {}, .random = dynamics::Random(dynamics::Purpose::gate, {})};
    std::optional<dynamics::Passage> passage;
    try {
      passage = cli::read_answer(cli::answer_words(line), section, body);
    } catch (const cli::WrongAnswer& wrong) {
      require(!wrong.what.empty(), "a refusal has a message");
      continue;
    }
    for (const double cost : passage->costs) require(std::isfinite(cost), "costs are numbers");
    require(passage->costs[0] >= 0.0, "a time is not negative");
    if (passage->fate != dynamics::Fate::left) continue;
    require(passage->next.face >= 0 && passage->next.face < std::ssize(section.faces) &&
                body.entry == passage->next,
            "a body goes on by a face");
    for (const double at : passage->next.at) require(std::isfinite(at), "entries are numbers");
    const std::string_view memory = body.carried.as<cli::CarriedWords>().words();
    require(!memory.empty() && line.find(memory) != line.npos, "a body carries words of the line");
  }
}

}  // namespace gatewalk::fuzz
