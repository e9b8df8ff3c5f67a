#include "cli/terminal/gnuplot.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "cli/terminal/child.h"
#include "cli/terminal/output.h"

namespace gatewalk::cli {

std::string drawn(const std::string& script) {
  const File in = scratch_file();
  if (std::fwrite(script.data(), 1, script.size(), in.get()) != script.size() ||
      std::fflush(in.get()) != 0)
    throw std::runtime_error(std::string("gnuplot cannot be run: its script cannot be written: ") +
                             std::strerror(errno));
  std::rewind(in.get());
  // As a named file, so that gnuplot's complaints have line numbers and any error ends it.
  Child gnuplot({"gnuplot", "/dev/stdin"}, ::fileno(in.get()),
                "gnuplot was not found; it draws the figures (Debian: gnuplot-nox)");
  return gnuplot.output();
}

void draw_svg(const std::string& path, const Figure& f) {
  write_text_atomically(path,
                        drawn("set terminal svg size " + std::to_string(f.width) + "," +
                              std::to_string(f.height) + " font 'sans," + std::to_string(f.font) +
                              "' background '#ffffff' enhanced\n" + f.commands + "\n"));
}

}  // namespace gatewalk::cli
