// SPDX-License-Identifier: MIT
#pragma once
/// The state of an Options object, shared by the files that define its functions: command.cpp
/// (declaring and parsing), command_files.cpp (files that are named) and command_output.cpp
/// (results).

#include <sys/types.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/kept/kept_run.h"
#include "cli/terminal/backup.h"
#include "lattice/source/source_file.h"

namespace gatewalk::cli {

namespace po = boost::program_options;
using Strings = std::vector<std::string>;

/// A whole number on the command line, from -kMostCount to kMostCount.
struct Count {
  std::int64_t value = 0;
};
/// A finite number on the command line.
struct Number {
  double value = 0.0;
};
/// A seed on the command line.
struct Seed {
  std::uint64_t value = 1;
};
/// The option as users write it: -o or --name.
[[nodiscard]] inline std::string shown(const std::string& name) {
  return name == "output" ? "-o" : "--" + name;
}

[[nodiscard]] inline std::string upper_case(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), ::toupper);
  return name;
}

/// The identity of a regular file (device, inode), the same for all its names.
using FileId = std::pair<dev_t, ino_t>;

/// A file with the name that the command line gives it.
struct Options::NamedFile {
  std::string name, path;

  NamedFile(std::string shown_as, std::string file);
  /// Whether both are one file. Existing files are compared by identity, so that links and other
  /// spellings do not hide a clash; a file that does not exist yet is compared by its path.
  [[nodiscard]] bool is_same(const NamedFile& other) const;
  [[nodiscard]] bool is_regular() const { return id_.has_value(); }

 private:
  std::optional<FileId> id_;
  std::filesystem::path place_;
};

struct Options::State {
  std::string synopsis, about, example;
  std::string details_shown;           // what --details shows, in words
  std::vector<std::string> most_used;  // in the order of the help page
  /// The command's name, one word or two: the beginning of the synopsis, "chart field SCENE ...".
  [[nodiscard]] std::string name() const {
    return synopsis.substr(0, synopsis.find_first_not_of("abcdefghijklmnopqrstuvwxyz ") - 1);
  }
  po::options_description own{"Options"}, shared{"Shared options"}, hidden;
  po::positional_options_description positions;
  std::vector<std::pair<std::string, std::string>> positional_help;
  std::vector<std::string> required;
  std::vector<TextsOption> varied;
  po::variables_map values;
  std::vector<po::option> given;
  std::string canonical;
  std::string no_scene;  // the reason why the command has no --set; empty if it has
  std::optional<dynamics::Work> work;
  std::function<void(const std::string&)> warned;
  std::function<void(const Description&)> given_out;
  std::shared_ptr<const dynamics::Cell> cell;
  std::map<std::string, std::shared_ptr<const lattice::SourceFile>> files;  // open files, by path

  std::optional<std::set<std::string>> divided;  // stages; none: no pieces are kept
  CommandWords words;
  std::unique_ptr<KeptRun> kept;
  int thrown_before = std::uncaught_exceptions();

  struct Output {
    std::string name;
    Content content = Content::text;
  };
  std::vector<Output> output_files{{"json", Content::text}};
  std::vector<std::string> folder_files;  // files in the folder of --output
  std::vector<std::pair<std::string, std::function<std::string(const std::string&)>>> reads;
  bool has_table = false;                 // whether --csv is the one that all commands share
  std::map<std::string, Backup> backups;  // by the file that is replaced
  std::string needs_output;               // the value of -o on the help page, if -o must be given

  template <class T>
  void add(const std::string& name, po::typed_value<T>* value, const std::string& shown,
           const std::string& help) {
    own.add_options()(name.c_str(), value->value_name(shown), help.c_str());
  }
};

}  // namespace gatewalk::cli
