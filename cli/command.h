#pragma once
/// What all commands share: how options are declared and read, how a scene is taken, how output is
/// given out.

#include <boost/program_options.hpp>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "dynamics/work.h"
#include "lattice/scene/scene.h"

namespace gatewalk::cli {

namespace po = boost::program_options;
using Json = nlohmann::ordered_json;

/// Exit statuses, a contract for scripts.
enum ExitCode : int { kFine = 0, kFailure = 1, kWrongUse = 2, kStopped = 130 };

/// The command line itself is wrong.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A whole number on the command line, up to 1e15 either way: 20000 or 2e4.
struct Count {
  std::int64_t value = 0;
};
inline constexpr std::int64_t kMostCount = 1'000'000'000'000'000;  // doubles are exact up to here
void validate(boost::any& v, const std::vector<std::string>& values, Count*, int);

/// A seed on the command line: a whole number from 0 up (-1 is a mistake, not 2^64 - 1).
struct Seed {
  std::uint64_t value = 1;
};
void validate(boost::any& v, const std::vector<std::string>& values, Seed*, int);

struct Command {
  const char* name;
  const char* summary;
  int (*run)(const std::vector<std::string>& arguments);
};
/// Every command, in the order of the help page.
int run_scene(const std::vector<std::string>& arguments);
int run_gate(const std::vector<std::string>& arguments);
int run_sweep(const std::vector<std::string>& arguments);
int run_landscape(const std::vector<std::string>& arguments);
int run_trace(const std::vector<std::string>& arguments);
int run_build(const std::vector<std::string>& arguments);
int run_show(const std::vector<std::string>& arguments);
int run_walk(const std::vector<std::string>& arguments);
int run_predict(const std::vector<std::string>& arguments);
int run_lattice(const std::vector<std::string>& arguments);
int run_validate(const std::vector<std::string>& arguments);
int run_chart_field(const std::vector<std::string>& arguments);
int run_chart(const std::vector<std::string>& arguments);
int run_stability(const std::vector<std::string>& arguments);
int run_chart_chain(const std::vector<std::string>& arguments);
int run_reproduce(const std::vector<std::string>& arguments);

/// Options of one command with the shared ones: --threads, --quiet, --json, --help. They know which
/// files are read and which are written: parse() refuses an output that is an input or another
/// output, and one that cannot be written, before any work.
class Options {
 public:
  /// `synopsis` e.g. "gate SCENE [options]"; `about` and `example` complete the help page.
  Options(std::string synopsis, std::string about, std::string example);

  /// Declares a positional argument (in order), a file that is read; `required` ones must be given.
  void positional(const std::string& name, const std::string& help, bool required);
  /// Declares the last positional argument, files that are read: at least one; its value is a
  /// std::vector<std::string>.
  void positional_list(const std::string& name, const std::string& help);
  po::options_description_easy_init add() { return own_.add_options(); }
  /// Declares --name, a file that is read.
  void input_file(const std::string& name, const std::string& help);
  /// A value of the declared option --name makes the command read the file `file_in(value)`.
  void reads(const std::string& name, std::function<std::string(const std::string&)> file_in);
  /// Declares --name, a file that is written; `shown` is FILE or FILE.html, ... Only one output may
  /// go to standard output (-), and none that is binary.
  enum class Content { text, binary };
  void output_file(const std::string& name, const std::string& shown, const std::string& help,
                   Content content = Content::text);
  /// The same for -o, --output, which must be given.
  void main_output_file(const std::string& shown, const std::string& help, Content content);
  /// Declares -o, --output, which must be given: a folder, in which `files` are written.
  void output_folder(const std::string& help, std::vector<std::string> files);
  /// There is no scene to override keys of: --set is refused with `reason`, and not on the help
  /// page.
  void without_scene(const std::string& reason) { no_scene_ = reason; }

  /// Reads the arguments and looks at every file they name. False when --help was asked for and
  /// printed. Throws UsageError.
  [[nodiscard]] bool parse(const std::vector<std::string>& arguments);

  [[nodiscard]] bool has(const std::string& name) const { return values_.count(name) > 0; }
  template <class T>
  [[nodiscard]] const T& get(const std::string& name) const {
    return values_[name].as<T>();
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    return has(name) ? get<std::string>(name) : std::string();
  }
  /// Value of a Count option; throws UsageError unless it lies in [low, high].
  [[nodiscard]] std::int64_t count(const std::string& name, std::int64_t low = 1,
                                   std::int64_t high = kMostCount) const;
  [[nodiscard]] std::uint64_t seed() const { return get<Seed>("seed").value; }
  [[nodiscard]] const std::vector<std::string>& overrides() const;
  /// Progress lines and remarks are wanted.
  [[nodiscard]] bool talk() const { return !has("quiet"); }
  /// Long work of this command: shown unless --quiet, stopped by a signal.
  [[nodiscard]] dynamics::Work work() const;

  /// The command as it shaped the result, without what cannot change it (threads, output names).
  [[nodiscard]] std::string canonical() const;

  /// Prints the result: JSON where --json says, the table on standard output otherwise; with --json
  /// FILE the table too, unless --quiet.
  /// `indent` -1: JSON on one line, for long arrays.
  void give_out(const Json& json, const std::string& table, int indent = 2) const;

 private:
  std::string synopsis_, about_, example_;
  po::options_description own_, shared_{"Shared options"}, hidden_;
  po::positional_options_description positions_;
  std::vector<std::pair<std::string, std::string>> positional_help_;
  std::vector<std::string> required_;
  po::variables_map values_;
  std::string canonical_;
  std::string no_scene_;  // why there is no --set, if there is none

  struct Output {
    std::string name;
    Content content = Content::text;
  };
  std::vector<Output> output_files_{{"json", Content::text}};
  std::vector<std::string> folder_files_;  // what is written into the folder of --output
  std::vector<std::pair<std::string, std::function<std::string(const std::string&)>>> reads_;
  std::string needs_output_;  // what to call the value of -o, if it must be given

  struct NamedFile;
  [[nodiscard]] std::vector<NamedFile> inputs() const;
  void refuse_forgotten_values(const std::vector<po::option>& given) const;
  void check_files();
};

/// Adds --seed, and --trials with the paper's 100.
void add_seed(Options& options);
void add_trials_and_seed(Options& options, const char* trials_help);
/// Adds --strict.
void add_strict(Options& options);

/// The exit status of a command whose result is written: with --strict, kFailure when the result's
/// status is not clean, which is said.
[[nodiscard]] int exit_status(const Options& options, bool clean);

/// JSON as text; bytes that are no UTF-8 (names of files) become U+FFFD. `indent` -1: on one line.
[[nodiscard]] std::string text_of(const Json& json, int indent = 2);

/// A remark on standard error, if wanted and if somebody is there to read it (a terminal).
void remark(const Options& options, const std::string& text);
/// A warning on standard error, always: the result cannot be taken at face value.
void warn(const std::string& text);

}  // namespace gatewalk::cli
