// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/render/files.h"
#include "cli/web/embedded.h"
#include "lattice/text/edit_distance.h"

namespace gatewalk::cli {
namespace {

/// The description of a sample file: its first comment, up to the first colon or the last full stop
/// of the line.
std::string first_words(std::string_view text) {
  text = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), text.find_first_not_of("# ")));
  if (const std::size_t colon = text.find(": "); colon != text.npos)
    text = text.substr(0, colon);
  else if (const std::size_t stop = text.rfind(". "); stop != text.npos)
    text = text.substr(0, stop);
  return std::string(text.substr(0, text.find_last_not_of(". :,") + 1));
}

std::vector<Sample> samples() {
  std::vector<Sample> all;
  for (const std::string& file : carried_files()) {
    if (!file.starts_with("scenes/")) continue;
    const std::size_t begin = file.rfind('/') + 1;
    all.push_back(
        {file.substr(begin, file.rfind('.') - begin), file, first_words(carried_file(file))});
  }
  return all;
}

}  // namespace

int run_sample(const Arguments& arguments) {
  Options options("sample [NAME] [options]",
                  "Writes a ready file to begin with: a scene, tracks of bodies and the cells that "
                  "cut them, recorded\n"
                  "passages, or counts of an experiment. Without NAME, sample lists all files.",
                  "gatewalk sample walker -o mine.toml");
  const TextOption name = options.positional("name", "name of the sample", false);
  const TextOption output =
      options.output_file("output", "FILE", "the file to write (default: standard output)");
  options.without_scene("a sample is written as it is");
  if (!options.parse(arguments)) return kFine;
  const std::vector<Sample> all = samples();
  if (!name) {
    if (output) throw UsageError("-o without NAME: name a sample (gatewalk sample lists all)");
    options.give_out(SampleResult{all},
                     {table_of(all), "", {"gatewalk sample walker -o walker.toml  # writes one"}});
    return kFine;
  }
  const std::string given = name.value();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Sample& s) { return s.name == given; });
  if (found == all.end()) {
    std::vector<std::string> names;
    for (const Sample& s : all) names.push_back(s.name);
    const std::string meant = lattice::meant_name(given, names);
    throw UsageError(fmt::format("there is no sample '{}'{} (gatewalk sample lists all)", given,
                                 meant.empty() ? "" : "; did you mean " + meant + "?"));
  }
  const std::string text(carried_file(found->file));
  if (output) options.write(output.value(), text);
  options.give_out(SampleResult{{*found}, text}, output ? "" : text);
  return kFine;
}

}  // namespace gatewalk::cli
