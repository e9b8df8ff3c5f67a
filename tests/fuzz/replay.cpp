// SPDX-License-Identifier: MIT
// Every target over the files of its corpus, without libFuzzer.   fuzz_replay CORPUS [TARGET]
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz.h"

namespace {

struct Target {
  const char* name;
  void (*run)(std::string_view);
};
constexpr Target kTargets[] = {
#define GATEWALK_FUZZ_TARGET(name) {#name, gatewalk::fuzz::name},
#include "tests/fuzz/targets.def"
#undef GATEWALK_FUZZ_TARGET
};

constexpr double kMostSeconds = 1.0;  // CPU time for one input

}  // namespace

int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  constexpr rlim_t kMostBytes = rlim_t{2} << 30;
  const rlimit limit{kMostBytes, kMostBytes};
  // Sanitizers need terabytes of addresses.
  if (std::getenv("SANITIZED") == nullptr) (void)setrlimit(RLIMIT_AS, &limit);
  if (argc < 2) {
    std::cerr << "usage: fuzz_replay CORPUS [TARGET]\n";
    return 2;
  }
  int failed = 0;
  for (const Target& target : kTargets) {
    if (argc > 2 && std::string(argv[2]) != target.name) continue;
    std::vector<fs::path> files;
    for (const auto& file : fs::directory_iterator(fs::path(argv[1]) / target.name))
      files.push_back(file.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
      // Printed before the target runs, because a finding ends the process.
      std::cout << target.name << ' ' << file.filename().string() << std::endl;
      const std::clock_t begin = std::clock();
      target.run(gatewalk::fuzz::bytes_of(file.string()));
      const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      if (seconds > kMostSeconds) {
        std::cout << "took " << seconds << " s\n";
        ++failed;
      }
    }
    if (files.empty()) {
      std::cout << target.name << " has no corpus\n";
      ++failed;
    }
  }
  return failed == 0 ? 0 : 1;
}
