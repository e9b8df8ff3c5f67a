// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "cli/command_state.h"
#include "cli/kept/piece_log.h"
#include "cli/terminal/gnuplot.h"
#include "cli/terminal/output.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::cli {
namespace {

/// The identity of a regular file; none for a pipe, a device or a missing file, which nothing can
/// overwrite.
std::optional<FileId> id_of(int rc, const struct stat& found) {
  if (rc != 0 || !S_ISREG(found.st_mode)) return {};
  return FileId(found.st_dev, found.st_ino);
}

}  // namespace

Options::NamedFile::NamedFile(std::string shown_as, std::string file)
    : name(std::move(shown_as)), path(std::move(file)) {
  struct stat found = {};
  id_ = path == "-" ? id_of(::fstat(STDOUT_FILENO, &found), found)
                    : id_of(::stat(path.c_str(), &found), found);
  if (id_ || path == "-") return;
  std::error_code error;  // on an error the place stays empty
  place_ = std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
}

bool Options::NamedFile::is_same(const NamedFile& other) const {
  if (id_ || other.id_) return id_ == other.id_;
  return !place_.empty() && place_ == other.place_;
}

std::vector<Options::NamedFile> Options::inputs() const {
  std::vector<NamedFile> files;
  const auto add = [&](const std::string& name, const std::string& path) {
    if (path.empty() || path == "-") return;
    files.emplace_back(name + " " + path, path);
    if (!files.back().is_regular()) return;  // a pipe can be read only once
    if (const std::string map = this->file(path).toml().map_file(); !map.empty())
      files.emplace_back(fmt::format("{} (the map of {})", map, path), map);
  };
  const auto each = [&](const std::string& option, const auto& take) {
    if (!has(option)) return;
    const boost::any& value = state_->values[option].value();
    if (const auto* one = boost::any_cast<std::string>(&value)) take(*one);
    if (const auto* many = boost::any_cast<Strings>(&value))
      for (const std::string& one : *many) take(one);
  };
  for (const auto& [name, help] : state_->positional_help)
    each(name, [&, &name = name](const std::string& path) { add(upper_case(name), path); });
  for (const auto& [name, file_in] : state_->reads)
    each(name, [&, &name = name, &file_in = file_in](const std::string& value) {
      add(shown(name), file_in(value));
    });
  return files;
}

void Options::check_values_given() const {
  for (const po::option& option : state_->given) {
    if (option.position_key >= 0) continue;
    const std::string& name = option.string_key;
    const bool is_output = (name == "output" && !state_->needs_output.empty()) ||
                           std::any_of(state_->output_files.begin(), state_->output_files.end(),
                                       [&](const State::Output& o) { return o.name == name; });
    for (const std::string& value : option.value)
      if (value.starts_with("--") || (is_output && value.size() > 1 && value[0] == '-'))
        throw UsageError(fmt::format(
            "{} {}: looks like an option, so the value of {} is missing{}", shown(name), value,
            shown(name),
            is_output ? fmt::format("; write ./{} for a file of that name", value) : ""));
  }
}

void Options::check_files() {
  if (!state_->needs_output.empty() && !output)
    throw UsageError(
        fmt::format("missing -o {}: gatewalk {}", state_->needs_output, state_->synopsis));
  for (const auto& [name, file_in] : state_->reads)
    if (has(name) && state_->values[name].value().type() == typeid(std::string) &&
        text(name).empty())
      throw UsageError(shown(name) + " needs a file name");

  std::vector<NamedFile> outputs;
  std::string takes_stdout;
  for (const State::Output& file : state_->output_files) {
    if (!has(file.name)) continue;
    if (text(file.name) == "/dev/stdout")
      state_->values.find(file.name)->second.value() = std::string("-");
    const std::string path = text(file.name), option = shown(file.name);
    if (path.empty()) throw UsageError(option + " needs a file name");
    for (const char* ending : {".xlsx", ".xls", ".ods", ".parquet"})
      if (lattice::has_ending(path, ending))
        throw UsageError(fmt::format(
            "{} {}: no {} is written; tables are CSV, which spreadsheets read: a name in .csv",
            option, path, ending));
    if (path != "-") {
      outputs.emplace_back(option + " " + path, path);
      continue;
    }
    if (file.content == Content::binary)
      throw UsageError(option + " cannot go to standard output: it needs a file of its own");
    if (!takes_stdout.empty())
      throw UsageError(fmt::format("{} - and {} -: only one thing can go to standard output",
                                   takes_stdout, option));
    takes_stdout = option;
  }
  const bool has_folder = !state_->needs_output.empty() && state_->needs_output == "DIR";
  const std::string folder = has_folder ? output.value() : "";
  if (has_folder && (folder.empty() || folder == "-"))
    throw UsageError("-o needs the name of a folder");
  for (const std::string& file : state_->folder_files) {
    const std::string path = (std::filesystem::path(folder) / file).string();
    outputs.emplace_back(path + " (in the folder of -o)", path);
  }

  const auto refuse_same = [](const NamedFile& a, const NamedFile& b) {
    if (a.is_same(b))
      throw UsageError(fmt::format("{} and {} are the same file: an output needs a file of its own",
                                   a.name, b.name));
  };
  std::vector<NamedFile> others = inputs();
  const bool takes_parts =
      !state_->positional_help.empty() && state_->positional_help.front().first == "part";
  for (const NamedFile& input : others)
    if (!takes_parts && input.is_regular() && PieceFile::begins(file(input.path).toml().bytes()))
      throw UsageError(input.name +
                       ": holds pieces of a run: gatewalk merge makes one run of all parts, or its "
                       "command with --resume goes on");
  others.emplace_back("standard output", "-");
  for (const NamedFile& input : others)
    if (input.path != "-") refuse_same(input, others.back());
  for (const NamedFile& written : outputs) {
    for (const NamedFile& other : others) refuse_same(other, written);
    others.push_back(written);
  }

  const auto require_replaceable = [&](const std::string& path) {
    require_writable(path);
    if (path != "-" && !force) (void)Backup(path);
  };
  const auto check = [](const std::string& option, const auto& act) {
    try {
      act();
    } catch (const std::runtime_error& e) {
      throw UsageError(option + ": " + e.what());
    }
  };
  for (const State::Output& file : state_->output_files)
    if (has(file.name)) check(shown(file.name), [&] { require_replaceable(text(file.name)); });
  if (figure) {
    if (!can_be_drawn(figure.value()))
      throw UsageError(fmt::format("--figure {}: must end in .svg, .pdf or .png", figure.value()));
    check("--figure", require_gnuplot);
  }
  if (!has_folder) return;
  check("-o", [&] {
    require_possible_folder(folder);
    if (!std::filesystem::is_directory(folder)) return;
    for (const std::string& file : state_->folder_files)
      require_replaceable((std::filesystem::path(folder) / file).string());
  });
}

const lattice::SourceFile& Options::file(const std::string& path) const {
  auto& file = state_->files[path];
  if (!file) file = std::make_shared<const lattice::SourceFile>(path);
  return *file;
}

lattice::Scene Options::read_scene() const {
  return lattice::read_scene(file(scene_file.value()).toml(), overrides());
}

std::vector<std::string> Options::files_read() const {
  Strings paths;
  for (const NamedFile& file : inputs()) paths.push_back(file.path);
  return paths;
}

}  // namespace gatewalk::cli
