// SPDX-License-Identifier: MIT
#include "cli/render/provenance.h"

#include <fmt/core.h>

#include <fstream>
#include <thread>

#include "cli/fields/json_value.h"
#include "cli/render/version.h"

namespace gatewalk::cli {

void describe(Fields& out, const Provenance& p) {
  out.text({"program", "name of the program"}, "gatewalk");
  out.text({"version", "version of the program"}, kVersion);
  out.text({"commit", "commit of the sources from which the program was built"}, kCommit);
  out.text({"command", "the command line with everything that shaped the result"}, p.command);
  out.if_any({"seed", "1", "seed of all random numbers"}, p.seed);
  out.if_any({"scene", "the whole scene, as TOML"}, p.scene);
  out.optional(!p.derived.empty(), [&](Fields& f) {
    f.texts({"derived", "keys that the scene leaves out and the program derives from other keys"},
            {p.derived.begin(), p.derived.end()});
  });
  out.optional(!p.parts.empty(), [&](Fields& f) {
    f.list({"parts", "the files that were joined, of a run that was divided into parts"}, p.parts,
           [](Fields& part, const auto& file) {
             part.text({"file", "path of the file"}, file.first);
             part.text({"holds", "which part of the run the file holds"}, file.second);
           });
  });
  out.if_any({"cell", "the description of the cells, as TOML"}, p.cell);
}

void describe_made_by(Fields& out, const Provenance& provenance) {
  out.object(Label("made_by", "what is needed to make the same result again").shared(),
             [&](Fields& made) { describe(made, provenance); });
}

std::vector<std::pair<std::string, std::string>> attributes_of(const Provenance& provenance) {
  std::vector<std::pair<std::string, std::string>> all;
  const Json made_by = json_of([&](Fields& out) { describe(out, provenance); });
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
  return fmt::format("{}, {} cores", model, std::thread::hardware_concurrency());
}

}  // namespace gatewalk::cli
