#include "cli/command.h"

#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

#include "cli/output.h"

namespace gatewalk::cli {
namespace {

/// Options that cannot change a result, left out of the recorded command.
bool shapes_nothing(const std::string& name) {
  return name == "threads" || name == "quiet" || name == "json" || name == "output";
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
  std::int64_t whole = 0;
  auto read = std::from_chars(text.data(), end, whole);
  if (read.ec == std::errc() && read.ptr == end) {
    v = Count{whole};
    return;
  }
  double number = 0.0;
  const auto real = std::from_chars(text.data(), end, number);
  if (real.ec != std::errc() || real.ptr != end || number != std::floor(number) ||
      !(std::abs(number) <= 1e15))
    throw UsageError("'" + text + "' is not a whole number, such as 20000 or 2e4");
  v = Count{static_cast<std::int64_t>(number)};
}

void validate(boost::any& v, const std::vector<std::string>& values, Seed*, int) {
  po::validators::check_first_occurrence(v);
  const std::string& text = po::validators::get_single_string(values);
  Seed seed;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), seed.value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size())
    throw UsageError("'" + text + "' is not a seed: a whole number from 0 to 2^64 - 1");
  v = seed;
}

Options::Options(std::string synopsis, std::string about, std::string example)
    : synopsis_(std::move(synopsis)), about_(std::move(about)), example_(std::move(example)),
      own_("Options") {
  shared_.add_options()
      ("json", po::value<std::string>()->value_name("FILE"),
       "write the result as JSON; - is standard output")
      ("threads", po::value<int>()->default_value(0)->value_name("N"),
       "threads to use, 0: all; never changes a result")
      ("quiet", "no progress, no remarks, no table when there is JSON")
      ("help,h", "this page");
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

bool Options::parse(const std::vector<std::string>& arguments) {
  (no_scene_.empty() ? own_ : hidden_).add_options()
      ("set", po::value<std::vector<std::string>>()->composing()->value_name("KEY=VALUE"),
       "override a key of the scene, e.g. forces.random_N=20 (may be repeated)");
  po::options_description all;
  all.add(own_).add(shared_).add(hidden_);
  using namespace po::command_line_style;
  const int style = unix_style & ~allow_guessing;  // an abbreviation is a typing error
  po::parsed_options parsed(&all);
  try {
    parsed = po::command_line_parser(arguments).options(all).positional(positions_).style(style).run();
    po::store(parsed, values_);
    po::notify(values_);
  } catch (const po::error& e) {
    throw UsageError(std::string(e.what()) + "; see gatewalk " +
                     synopsis_.substr(0, synopsis_.find(' ')) + " --help");
  }
  if (has("help")) {
    std::cout << "gatewalk " << synopsis_ << "\n\n" << about_ << "\n\n";
    for (const auto& [name, help] : positional_help_) {
      std::string shown = name;
      std::transform(shown.begin(), shown.end(), shown.begin(), ::toupper);
      std::cout << "  " << shown << std::string(24 - std::min<std::size_t>(22, shown.size()), ' ')
                << help << "\n";
    }
    std::cout << "\n" << own_ << "\n" << shared_ << "\nExample:\n  " << example_ << "\n";
    if (!std::cout.flush()) throw std::runtime_error("cannot write to standard output");
    return false;
  }
  if (!no_scene_.empty() && has("set")) throw UsageError("--set has no meaning here: " + no_scene_);
  for (const auto& name : required_) {
    if (has(name)) continue;
    std::string shown = name;
    std::transform(shown.begin(), shown.end(), shown.begin(), ::toupper);
    throw UsageError("missing " + shown + ": gatewalk " + synopsis_);
  }
  if (has("json") && text("json").empty()) throw UsageError("--json needs a file name, or -");
  if (!text("json").empty()) require_writable(text("json"));
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

std::int64_t Options::count(const std::string& name, std::int64_t low) const {
  const std::int64_t value = get<Count>(name).value;
  if (value < low)
    throw UsageError("--" + name + " " + std::to_string(value) + ": must be at least " +
                     std::to_string(low));
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
  if (!target.empty()) write_text_atomically(target, json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n");
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

void remark(const Options& options, const std::string& text) {
  if (options.talk() && ::isatty(STDERR_FILENO) == 1) warn(text);
}

void warn(const std::string& text) { std::cerr << "gatewalk: " << text << "\n"; }

void require_different(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty() || a == "-" || b == "-") return;
  std::error_code error;
  const auto same = [&](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path), error);
  };
  if (same(a) == same(b)) throw UsageError("two files of this command are the same: " + a);
}

}  // namespace gatewalk::cli
