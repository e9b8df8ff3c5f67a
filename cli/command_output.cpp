// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>

#include "cli/command_state.h"
#include "cli/fields/csv.h"
#include "cli/fields/json.h"
#include "cli/fields/text.h"
#include "cli/kept/ranks.h"
#include "cli/terminal/gnuplot.h"
#include "cli/terminal/output.h"
#include "lattice/scene/cell_file.h"
#include "lattice/source/source.h"

namespace gatewalk::cli {

void Options::warn(const std::string& text) const {
  if (text.empty()) return;
  if (state_->warned)
    state_->warned(text);
  else
    std::cerr << "gatewalk: " << text << "\n";
}

void Options::remark(const std::string& text) const {
  if (talk() && ::isatty(STDERR_FILENO) == 1) warn(text);
}

Provenance Options::provenance() const {
  Provenance p{.command = canonical(),
               .seed = {},
               .scene = {},
               .derived = {},
               .parts = part_names(state_->words.parts)};
  if (has("seed")) p.seed = seed();
  return p;
}

Provenance Options::provenance(const lattice::Source& source) const {
  if (source.scene) return provenance(*source.scene);
  Provenance p = provenance();
  p.cell = lattice::to_toml(*source.cells);
  return p;
}

Provenance Options::provenance(const lattice::Scene& scene) const {
  Provenance p = provenance();
  p.scene = lattice::to_toml(scene);
  p.derived = scene.derived;
  return p;
}

std::string Options::text_of(const Screen& screen) const {
  std::string text = screen.answer;
  if (details) text += screen.details;
  if (!talk()) return text;
  constexpr std::int64_t kMostLines = 15;
  const std::string indent(6, ' ');
  std::int64_t shown = std::ranges::count(screen.answer, '\n') + 1;  // and the line on --details
  for (const std::string& command : screen.next) {
    const std::int64_t more = std::ranges::count(command, '\n') + 1;
    const bool is_first = &command == &screen.next.front();
    if (!is_first && more > 1 && shown + more > kMostLines) continue;  // too long for the rest
    shown += more;
    std::string lines = command;
    for (std::size_t at = 0; (at = lines.find('\n', at)) != lines.npos;) lines.insert(++at, indent);
    text += (is_first ? "Next: " : indent) + lines + "\n";
  }
  if (!details && !screen.details.empty())
    text += wrapped("--details shows " +
                    (screen.details_shown.empty() ? state_->details_shown : screen.details_shown));
  return text;
}

void Options::give_out(const Description& describe, const Screen& screen, int indent) const {
  const std::string table_file = state_->has_table ? csv.value() : "", json_file = json.value();
  if (!state_->given_out && is_first_rank()) {
    const bool to_stdout = json_file == "-" || table_file == "-";
    if (!to_stdout && ((json_file.empty() && table_file.empty()) || talk()))
      write_text_atomically("-", text_of(screen));
    if (json) write(json_file, result_json(describe, indent));
  }
  if (!table_file.empty()) write(table_file, table_of_numbers(describe));
  if (state_->given_out) state_->given_out(with_format_version(describe));
}

void Options::keep_old(const std::string& path) const {
  if (path != "-" && !force && is_first_rank()) state_->backups.try_emplace(path, path);
}

void Options::write(const std::string& path, std::string_view text) const {
  if (!is_first_rank()) return;
  keep_old(path);
  write_text_atomically(path, text);
}

void Options::draw(const std::function<Figure()>& picture) const {
  if (!figure || !is_first_rank()) return;
  try {
    keep_old(figure.value());
    cli::draw(figure.value(), picture(), about());
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(fmt::format("no figure: {}; the numbers are written", e.what()));
  }
}

AboutFigure Options::about() const { return {"gatewalk " + state_->name(), canonical()}; }

ResultFolder::ResultFolder(const Options& options, const std::vector<std::string>& files)
    : options_(options), folder_(options.output.value()), files_(files) {
  require_folder(folder_);
}

void ResultFolder::write(const std::string& csv_file, const std::string& csv,
                         const std::string& json_file, const Description& describe) const {
  for (const std::string& file : files_)
    if (file.ends_with(".svg")) {
      options_.keep_old(path(file));
      std::filesystem::remove(path(file));
    }
  options_.write(path(csv_file), csv);
  options_.write(path(json_file), result_json(describe));
}

void ResultFolder::draw(const std::string& file, const Figure& figure) const {
  try {
    options_.keep_old(path(file));
    cli::draw(path(file), figure, options_.about());
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(
        fmt::format("no figure: {}; the other files in {} are written", e.what(), folder_));
  }
}

std::string ResultFolder::path(const std::string& file) const {
  return (std::filesystem::path(folder_) / file).string();
}

int exit_status(const Options& options, bool clean) {
  if (clean || !options.strict) return kFine;
  options.warn(
      "--strict: the result's status is not clean, so the exit status is 1; the result is written");
  return kFailure;
}

}  // namespace gatewalk::cli
