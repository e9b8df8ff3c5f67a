// SPDX-License-Identifier: MIT
// A cell program that does next to nothing: what is left is what speaking to a program costs.
// Bodies go straight on, one in four to the right or left; every hundredth is trapped; its seed is
// its luck.
#include <cstdio>
#include <cstdlib>
#include <cstring>

int main() {
  std::puts(
      R"({"gatewalk": 1, "costs": [{"key": "time_s", "unit": "s"}], )"
      R"("coordinates": [{"name": "s", "unit": "m", "scale": 1}, {"name": "v", "unit": "m s-1", "scale": 1}], )"
      R"("faces": [{"name": "S", "move": [0, 1]}, {"name": "W", "move": [1, 0], "mirror": "E"}, )"
      R"({"name": "E", "move": [-1, 0], "mirror": "W"}]})");
  std::fflush(stdout);
  char line[1000];
  while (std::fgets(line, sizeof line, stdin) != nullptr) {
    if (line[0] == '\n') {
      std::fflush(stdout);
      continue;
    }
    // ID FACE s v SEED MEMORY
    char* end_of_id = std::strchr(line, ' ');
    char* const at = std::strchr(end_of_id + 1, ' ') + 1;
    char* const end_of_v = std::strchr(std::strchr(at, ' ') + 1, ' ');
    const unsigned long long luck = std::strtoull(end_of_v, nullptr, 10);
    *end_of_id = *end_of_v = '\0';
    if (luck % 100 == 0)
      std::printf("%s trapped 1\n", line);
    else
      std::printf("%s left %c %s 0.5 -\n", line, "SSSWSSSE"[luck >> 61], at);
  }
}
