// SPDX-License-Identifier: MIT
#include "cli/render/provenance.h"

#include <fstream>
#include <thread>

#include "cli/render/json.h"
#include "cli/render/version.h"

namespace gatewalk::cli {

Json to_json(const Provenance& p) {
  Json m;
  m["program"] = "gatewalk";
  m["version"] = kVersion;
  m["commit"] = kCommit;
  m["command"] = p.command;
  if (p.seed) m["seed"] = *p.seed;
  if (p.scene) m["scene"] = *p.scene;
  if (!p.derived.empty()) m["derived"] = p.derived;
  for (const auto& [file, name] : p.parts) m["parts"].push_back({{"file", file}, {"holds", name}});
  return m;
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
