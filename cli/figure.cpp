#include "cli/figure.h"

#include <cstdio>
#include <stdexcept>

namespace gatewalk::cli {

void plot(const std::string& script) {
  FILE* const pipe = ::popen("gnuplot", "w");
  if (pipe == nullptr) throw std::runtime_error("gnuplot cannot be started");
  const bool written = std::fwrite(script.data(), 1, script.size(), pipe) == script.size();
  if (::pclose(pipe) != 0 || !written)
    throw std::runtime_error("gnuplot is missing or refused the figure");
}

}  // namespace gatewalk::cli
