// SPDX-License-Identifier: MIT
#include "cli/fitted.h"

#include <filesystem>

namespace gatewalk::cli {
namespace {

/// "best.toml" of draw 3 is "best-3.toml".
std::string file_of_draw(const std::string& path, std::int64_t draw) {
  const std::size_t dot = path.rfind('.'), slash = path.rfind('/');
  const std::size_t at =
      dot == path.npos || (slash != path.npos && dot < slash) ? path.size() : dot;
  return path.substr(0, at) + "-" + std::to_string(draw) + path.substr(at);
}

}  // namespace

std::vector<std::string> files_of_draws(const Options& options, std::int64_t count) {
  std::vector<std::string> files, taken = options.files_read();
  const std::string path = options.text("output");
  if (path == "-" || std::filesystem::is_other(path))
    throw UsageError("--scenes: needs -o FILE.toml, beside which they are written");
  for (const char* output : {"json", "csv", "draws", "inference-data", "figure", "checkpoint"})
    if (options.has(output)) taken.push_back(options.text(output));
  for (std::int64_t draw = 1; draw <= count; ++draw) {
    files.push_back(file_of_draw(path, draw));
    for (const std::string& other : taken)
      if (std::filesystem::weakly_canonical(other) ==
          std::filesystem::weakly_canonical(files.back()))
        throw UsageError("--scenes: would write " + files.back() +
                         ", which is read, or another output");
  }
  return files;
}

std::string not_listed(const lattice::Observed& observed, const lattice::FieldParams& field) {
  std::string names;
  if (!observed.seen.has_endings()) return names;
  for (const lattice::EndingName& e : lattice::kEndingNames)
    if (!observed.listed[static_cast<std::size_t>(e.ending)] &&
        (e.ending != markov::Ending::cut_off || field.max_gates > 0))
      names += (names.empty() ? "" : ", ") + std::string(e.name);
  return names.empty() ? names : "the counts do not list " + names + ": taken as 0";
}

}  // namespace gatewalk::cli
