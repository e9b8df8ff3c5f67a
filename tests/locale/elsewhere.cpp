// SPDX-License-Identifier: MIT
// The program in a process that took another locale before: LOCALE of the environment, for C and
// for C++. Whole numbers then come in groups, and others have no decimal point.

#define main gatewalk_main
#include "cli/main.cpp"
#undef main

#include <array>
#include <clocale>
#include <cstdio>
#include <locale>
#include <sstream>

int main(int argc, char** argv) {
  const char* const name = std::getenv("LOCALE");
  if (!name || !std::setlocale(LC_ALL, name)) {
    std::fprintf(stderr, "there is no locale '%s'\n", name ? name : "");
    return 99;
  }
  std::locale::global(std::locale(name));
  std::array<char, 16> by_c{};
  std::snprintf(by_c.data(), by_c.size(), "%.1f", 0.5);
  std::ostringstream by_streams;
  by_streams << 1000;
  if (by_c.data() == std::string("0.5") || by_streams.str() == "1000") {
    std::fprintf(stderr, "locale '%s' writes numbers as C does\n", name);
    return 99;
  }
  return gatewalk_main(argc, argv);
}
