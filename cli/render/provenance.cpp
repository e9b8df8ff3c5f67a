// SPDX-License-Identifier: MIT
#include "cli/render/provenance.h"

#include <fstream>
#include <thread>

#include "cli/render/json.h"
#include "cli/render/version.h"

namespace gatewalk::cli {

void describe(Fields& out, const Provenance& p) {
  out.text({"program", "its name"}, "gatewalk");
  out.text({"version", "of the program"}, kVersion);
  out.text({"commit", "of the sources that the program was built from"}, kCommit);
  out.text({"command", "the command with all that shaped the result"}, p.command);
  out.optional(p.seed.has_value(), [&](Fields& f) {
    f.count({"seed", "1", "seed of all random numbers"}, p.seed.value_or(0));
  });
  out.optional(p.scene.has_value(), [&](Fields& f) {
    f.text({"scene", "the whole scene, as TOML"}, p.scene.value_or(""));
  });
  out.optional(!p.derived.empty(), [&](Fields& f) {
    f.texts({"derived", "keys that the scene left out, and the program derived from others"},
            {p.derived.begin(), p.derived.end()});
  });
  out.optional(!p.parts.empty(), [&](Fields& f) {
    f.list({"parts", "the files of a run in parts"}, p.parts, [](Fields& part, const auto& file) {
      part.text({"file", "its path"}, file.first);
      part.text({"holds", "which part of the run it is"}, file.second);
    });
  });
  out.optional(p.cell.has_value(), [&](Fields& f) {
    f.text({"cell", "what describes the cells, as TOML"}, p.cell.value_or(""));
  });
}

void describe_made_by(Fields& out, const Provenance& provenance) {
  out.object(Label("made_by", "what gives the same result again").shared(),
             [&](Fields& made) { describe(made, provenance); });
}

Json to_json(const Provenance& provenance) {
  return json_of([&](Fields& out) { describe(out, provenance); });
}

std::vector<std::pair<std::string, std::string>> attributes_of(const Provenance& provenance) {
  std::vector<std::pair<std::string, std::string>> all;
  const Json made_by = to_json(provenance);
  for (const auto& [key, value] : made_by.items())
    all.emplace_back(key, value.is_string() ? value.get<std::string>() : text_of(value, -1));
  return all;
}

std::string machine() {
  std::ifstream info("/proc/cpuinfo");
  std::string model = "unknown processor";
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    model = line.substr(line.find(':') + 2);
    break;
  }
  return model + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores";
}

}  // namespace gatewalk::cli
