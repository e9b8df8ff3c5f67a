#include "cli/command.h"

#include <sys/stat.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

#include "cli/terminal/output.h"
#include "cli/terminal/progress.h"

namespace gatewalk::cli {
namespace {

/// Options that cannot change a result, left out of the recorded command.
bool shapes_nothing(const std::string& name) {
  return name == "threads" || name == "quiet" || name == "json" || name == "output" ||
         name == "strict";
}

/// An option as users write it.
std::string shown(const std::string& name) { return name == "output" ? "-o" : "--" + name; }

std::string upper_case(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), ::toupper);
  return name;
}

/// A regular file by what no other one has, whatever its names. None for what cannot be lost:
/// pipes, devices, nothing at all.
using FileId = std::pair<dev_t, ino_t>;
std::optional<FileId> id_of(int rc, const struct stat& found) {
  if (rc != 0 || !S_ISREG(found.st_mode)) return {};
  return FileId(found.st_dev, found.st_ino);
}

std::string shell_quoted(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-+=./,:@%") == std::string::npos;
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

void validate(boost::any& v, const std::vector<std::string>& values, Count*, int) {
  po::validators::check_first_occurrence(v);
  const std::string& text = po::validators::get_single_string(values);
  const char* end = text.data() + text.size();
  constexpr auto kMost = static_cast<double>(kMostCount);
  double number = 0.0;
  const auto real = std::from_chars(text.data(), end, number);
  const bool is_tiny = text.find("e-") != text.npos || text.find("E-") != text.npos;
  const bool is_large =
      std::abs(number) > kMost || (real.ec == std::errc::result_out_of_range && !is_tiny);
  if (real.ptr != end || (real.ec != std::errc() && !is_large) || std::isnan(number) ||
      (!is_large && number != std::floor(number)))
    throw po::error_with_option_name("%canonical_option%: '" + text +
                                     "' is not a whole number, such as 20000 or 2e4");
  if (is_large)
    throw po::error_with_option_name("%canonical_option%: '" + text +
                                     "' is out of range: at most 1e15 is allowed");
  v = Count{static_cast<std::int64_t>(number)};
}

void validate(boost::any& v, const std::vector<std::string>& values, Seed*, int) {
  po::validators::check_first_occurrence(v);
  const std::string& text = po::validators::get_single_string(values);
  Seed seed;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), seed.value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size())
    throw po::error_with_option_name("%canonical_option%: '" + text +
                                     "' is not a seed: a whole number from 0 to 2^64 - 1");
  v = seed;
}

Options::Options(std::string synopsis, std::string about, std::string example)
    : synopsis_(std::move(synopsis)),
      about_(std::move(about)),
      example_(std::move(example)),
      own_("Options") {
  shared_.add_options()("json", po::value<std::string>()->value_name("FILE"),
                        "write the result as JSON; - is standard output")(
      "threads", po::value<int>()->default_value(0)->value_name("N"),
      "threads to use, 0: all; never changes a result")(
      "quiet", "no progress, no remarks, no table when there is JSON")("help,h", "this page");
}

void Options::positional(const std::string& name, const std::string& help, bool required) {
  hidden_.add_options()(name.c_str(), po::value<std::string>());
  positions_.add(name.c_str(), 1);
  positional_help_.emplace_back(name, help);
  if (required) required_.push_back(name);
}

void Options::positional_list(const std::string& name, const std::string& help) {
  hidden_.add_options()(name.c_str(), po::value<std::vector<std::string>>());
  positions_.add(name.c_str(), -1);
  positional_help_.emplace_back(name, help);
  required_.push_back(name);
}

void Options::input_file(const std::string& name, const std::string& help) {
  own_.add_options()(name.c_str(), po::value<std::string>()->value_name("FILE"), help.c_str());
  reads(name, [](const std::string& value) { return value; });
}

void Options::reads(const std::string& name,
                    std::function<std::string(const std::string&)> file_in) {
  reads_.emplace_back(name, std::move(file_in));
}

void Options::output_file(const std::string& name, const std::string& file, const std::string& help,
                          Content content) {
  const std::string declared = name == "output" ? "output,o" : name;
  own_.add_options()(declared.c_str(), po::value<std::string>()->value_name(file), help.c_str());
  output_files_.push_back({name, content});
}

void Options::main_output_file(const std::string& file, const std::string& help, Content content) {
  output_file("output", file, help, content);
  needs_output_ = file;
}

void Options::output_folder(const std::string& help, std::vector<std::string> files) {
  own_.add_options()("output,o", po::value<std::string>()->value_name("DIR"), help.c_str());
  folder_files_ = std::move(files);
  needs_output_ = "DIR";
}

/// A file by how the command line names it.
struct Options::NamedFile {
  std::string name, path;

  NamedFile(std::string shown_as, std::string file)
      : name(std::move(shown_as)), path(std::move(file)) {
    struct stat found = {};
    id = path == "-" ? id_of(::fstat(STDOUT_FILENO, &found), found)
                     : id_of(::stat(path.c_str(), &found), found);
    if (id || path == "-") return;
    std::error_code error;  // then the place stays empty
    place = std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  }

  /// By identity, so that links and other spellings do not hide it; by place where there is none
  /// yet.
  [[nodiscard]] bool is_same(const NamedFile& other) const {
    if (id || other.id) return id == other.id;
    return !place.empty() && place == other.place;
  }

 private:
  std::optional<FileId> id;
  std::filesystem::path place;
};

std::vector<Options::NamedFile> Options::inputs() const {
  std::vector<NamedFile> files;
  const auto add = [&](const std::string& name, const std::string& path) {
    if (!path.empty() && path != "-") files.emplace_back(name + " " + path, path);
  };
  const auto each = [&](const std::string& option, const auto& take) {
    if (!has(option)) return;
    const boost::any& value = values_[option].value();
    if (const auto* one = boost::any_cast<std::string>(&value)) take(*one);
    if (const auto* many = boost::any_cast<std::vector<std::string>>(&value))
      for (const std::string& one : *many) take(one);
  };
  for (const auto& [name, help] : positional_help_)
    each(name, [&, &name = name](const std::string& path) { add(upper_case(name), path); });
  for (const auto& [name, file_in] : reads_)
    each(name, [&, &name = name, &file_in = file_in](const std::string& value) {
      add(shown(name), file_in(value));
    });
  return files;
}

void Options::refuse_forgotten_values(const std::vector<po::option>& given) const {
  for (const po::option& option : given) {
    if (option.position_key >= 0) continue;
    const std::string& name = option.string_key;
    const bool is_output = (name == "output" && !needs_output_.empty()) ||
                           std::any_of(output_files_.begin(), output_files_.end(),
                                       [&](const Output& o) { return o.name == name; });
    for (const std::string& value : option.value)
      if (value.starts_with("--") || (is_output && value.size() > 1 && value[0] == '-'))
        throw UsageError(shown(name) + " " + value + ": looks like an option, so the value of " +
                         shown(name) + " is missing" +
                         (is_output ? "; write ./" + value + " for a file of that name" : ""));
  }
}

void Options::check_files() {
  if (!needs_output_.empty() && !has("output"))
    throw UsageError("missing -o " + needs_output_ + ": gatewalk " + synopsis_);
  for (const auto& [name, file_in] : reads_)
    if (has(name) && values_[name].value().type() == typeid(std::string) && text(name).empty())
      throw UsageError(shown(name) + " needs a file name");

  std::vector<NamedFile> outputs;
  std::string takes_stdout;
  for (const Output& output : output_files_) {
    if (!has(output.name)) continue;
    if (text(output.name) == "/dev/stdout")
      values_.find(output.name)->second.value() = std::string("-");
    const std::string path = text(output.name), option = shown(output.name);
    if (path.empty()) throw UsageError(option + " needs a file name");
    if (path != "-") {
      outputs.emplace_back(option + " " + path, path);
      continue;
    }
    if (output.content == Content::binary)
      throw UsageError(option + " cannot go to standard output: it needs a file of its own");
    if (!takes_stdout.empty())
      throw UsageError(takes_stdout + " - and " + option +
                       " -: only one thing can go to standard output");
    takes_stdout = option;
  }
  const bool has_folder = !needs_output_.empty() && needs_output_ == "DIR";
  const std::string folder = has_folder ? text("output") : "";
  if (has_folder && (folder.empty() || folder == "-"))
    throw UsageError("-o needs the name of a folder");
  for (const std::string& file : folder_files_) {
    const std::string path = (std::filesystem::path(folder) / file).string();
    outputs.emplace_back(path + " (in the folder of -o)", path);
  }

  const auto refuse_same = [](const NamedFile& a, const NamedFile& b) {
    if (a.is_same(b))
      throw UsageError(a.name + " and " + b.name +
                       " are the same file: an output needs a file of its own");
  };
  std::vector<NamedFile> others = inputs();
  others.emplace_back("standard output", "-");
  for (const NamedFile& input : others)
    if (input.path != "-") refuse_same(input, others.back());
  for (const NamedFile& output : outputs) {
    for (const NamedFile& other : others) refuse_same(other, output);
    others.push_back(output);
  }

  const auto check = [](const std::string& option, const auto& act) {
    try {
      act();
    } catch (const std::runtime_error& e) {
      throw UsageError(option + ": " + e.what());
    }
  };
  for (const Output& output : output_files_)
    if (has(output.name)) check(shown(output.name), [&] { require_writable(text(output.name)); });
  if (!has_folder) return;
  check("-o", [&] {
    require_possible_folder(folder);
    if (!std::filesystem::is_directory(folder)) return;
    for (const std::string& file : folder_files_)
      require_writable((std::filesystem::path(folder) / file).string());
  });
}

bool Options::parse(const std::vector<std::string>& arguments) {
  (no_scene_.empty() ? own_ : hidden_)
      .add_options()("set",
                     po::value<std::vector<std::string>>()->composing()->value_name("KEY=VALUE"),
                     "override a key of the scene, e.g. forces.random_N=20 (may be repeated); what "
                     "the file leaves out stays as it follows from the file");
  po::options_description all;
  all.add(own_).add(shared_).add(hidden_);
  using namespace po::command_line_style;
  const int style = unix_style & ~allow_guessing;  // an abbreviation is a typing error
  po::parsed_options parsed(&all);
  try {
    parsed =
        po::command_line_parser(arguments).options(all).positional(positions_).style(style).run();
    po::store(parsed, values_);
    po::notify(values_);
  } catch (const po::error& e) {
    throw UsageError(std::string(e.what()) + "; see gatewalk " +
                     synopsis_.substr(0, synopsis_.find(' ')) + " --help");
  }
  if (has("help")) {
    std::cout << "gatewalk " << synopsis_ << "\n\n" << about_ << "\n\n";
    for (const auto& [name, help] : positional_help_) {
      const std::string argument = upper_case(name);
      std::cout << "  " << argument
                << std::string(24 - std::min<std::size_t>(22, argument.size()), ' ') << help
                << "\n";
    }
    std::cout << "\n" << own_ << "\n" << shared_ << "\nExample:\n  " << example_ << "\n";
    if (!std::cout.flush()) throw std::runtime_error("cannot write to standard output");
    return false;
  }
  if (!no_scene_.empty() && has("set")) throw UsageError("--set has no meaning here: " + no_scene_);
  for (const auto& name : required_) {
    if (!has(name)) throw UsageError("missing " + upper_case(name) + ": gatewalk " + synopsis_);
  }
  refuse_forgotten_values(parsed.options);
  check_files();
  const int threads = get<int>("threads");
  if (threads < 0 || threads > 1024) throw UsageError("--threads must lie in [0, 1024]");
  if (threads > 0) {
    // Lives until the program ends.
    static const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  }

  canonical_ = "gatewalk " + synopsis_.substr(0, synopsis_.find(' '));
  for (const auto& option : parsed.options) {
    if (option.position_key >= 0) {
      canonical_ += " " + shell_quoted(option.value.front());
    } else if (!shapes_nothing(option.string_key)) {
      canonical_ += " --" + option.string_key;
      for (const auto& value : option.value) canonical_ += " " + shell_quoted(value);
    }
  }
  return true;
}

std::int64_t Options::count(const std::string& name, std::int64_t low, std::int64_t high) const {
  const std::int64_t value = get<Count>(name).value;
  if (value < low || value > high)
    throw UsageError("--" + name + " " + std::to_string(value) + ": must be at least " +
                     std::to_string(low) + " and at most " + std::to_string(high));
  return value;
}

const std::vector<std::string>& Options::overrides() const {
  static const std::vector<std::string> none;
  return has("set") ? get<std::vector<std::string>>("set") : none;
}

std::string Options::canonical() const { return canonical_; }

void Options::give_out(const Json& json, const std::string& table, int indent) const {
  const std::string target = text("json");
  if (target != "-" && (target.empty() || talk())) write_text_atomically("-", table);
  if (!target.empty()) write_text_atomically(target, text_of(json, indent) + "\n");
}

void add_seed(Options& options) {
  options.add()("seed", po::value<Seed>()->default_value(Seed{1}, "1")->value_name("S"),
                "seed of all random numbers; the same seed gives the same result");
}

void add_trials_and_seed(Options& options, const char* trials_help) {
  options.add()("trials", po::value<Count>()->default_value(Count{100}, "100")->value_name("N"),
                trials_help);
  add_seed(options);
}

void add_strict(Options& options) {
  options.add()("strict",
                "exit status 1 when the result's status is not clean; it is written all the same");
}

int exit_status(const Options& options, bool clean) {
  if (clean || !options.has("strict")) return kFine;
  warn(
      "--strict: the result's status is not clean, so the exit status is 1; the result is written");
  return kFailure;
}

dynamics::Work Options::work() const { return watched_work(talk()); }

std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

void remark(const Options& options, const std::string& text) {
  if (options.talk() && ::isatty(STDERR_FILENO) == 1) warn(text);
}

void warn(const std::string& text) { std::cerr << "gatewalk: " << text << "\n"; }

}  // namespace gatewalk::cli
