// SPDX-License-Identifier: MIT
#pragma once
/// What all commands share: how options are declared and read, and how output is given out.

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "dynamics/base/work.h"

namespace boost {
class any;
}
namespace gatewalk::dynamics {
class Cell;
}
namespace gatewalk::lattice {
struct Scene;
struct Source;
class SourceFile;
}  // namespace gatewalk::lattice

namespace gatewalk::cli {

/// A command's help page, part by part.
struct CommandHelp {
  std::string synopsis, about, example;
  std::vector<std::pair<std::string, std::string>> arguments;  // name as shown, what it is
  struct Option {
    std::string name, value, text;  // value: as shown, empty of a flag
    char letter = 0;                // -o
    bool is_file = false;
    std::string kind = "text";  // or flag, count, seed, number
    bool is_repeated = false;
    std::string group{};  // heading on the page; options of a group stand together
  };
  std::vector<Option> options;
};

/// The words behind a command's name. A program that calls a command, such as the Python module,
/// also says who is told of progress and warnings, who takes the result, which cell --cell-program
/// means, and which files are open already and need not be read again.
struct Arguments {
  Arguments(std::vector<std::string> given) : words(std::move(given)) {}  // NOLINT: the usual case
  Arguments(std::initializer_list<std::string> given) : words(given) {}

  std::vector<std::string> words;
  std::optional<dynamics::Work> work = std::nullopt;
  std::function<void(const std::string&)> warned = nullptr;
  std::vector<std::string> parts{};  // files that hold all its work (merge)
  std::function<void(const Description&)> given_out = nullptr;
  std::shared_ptr<const dynamics::Cell> cell = nullptr;
  std::vector<std::shared_ptr<const lattice::SourceFile>> files{};
  std::function<void(const CommandHelp&)> helped = nullptr;  // the help page, and nothing else
};

/// A command by its words, for another run of it.
struct CommandWords {
  std::string command;
  std::vector<std::string> shaping, outputs;  // what shapes the result; what it is written to
  std::string main_output;                    // output (-o) or json
  bool output_is_folder = false;
  std::vector<std::string> others{};  // what else shapes the result, and is no word of it
  std::vector<std::string> parts{};   // Arguments::parts
};

/// Exit statuses, a contract for scripts.
enum ExitCode : int {
  kFine = 0,
  kFailure = 1,
  kWrongUse = 2,
  kResumable = 75,
  kStopped = 130,
  kReaderWentAway = 141  // as a shell says it of a process that SIGPIPE ended
};

/// The command line itself is wrong.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr std::int64_t kMostCount = 1'000'000'000'000'000;  // doubles are exact up to here

/// What a command shows on the terminal.
struct Screen {
  Screen(std::string text, std::string more = {}, std::vector<std::string> then = {})  // NOLINT
      : answer(std::move(text)), details(std::move(more)), next(std::move(then)) {}

  std::string answer;             // at most 15 lines for one start, without maps
  std::string details;            // printed behind the answer with --details
  std::vector<std::string> next;  // what the user can do next, a line each
};

class Options;

/// An option of a command as the variable that declares it, so that a misspelt one does not
/// compile: what the functions of Options that declare one return.
class Option {
 public:
  Option() = default;  // one that a command does not have
  Option(const Options& options, std::string name) : options_(&options), name_(std::move(name)) {}
  /// Whether it has a value: one that was given, or that by default.
  [[nodiscard]] explicit operator bool() const;
  [[nodiscard]] const std::string& name() const { return name_; }

 protected:
  /// Null where it has no value.
  [[nodiscard]] const boost::any* given() const;

 private:
  const Options* options_ = nullptr;
  std::string name_;
};
class CountOption : public Option {
 public:
  using Option::Option;
  /// Throws UsageError unless it lies in [low, high].
  [[nodiscard]] std::int64_t value(std::int64_t low = 1, std::int64_t high = kMostCount) const;
};
class NumberOption : public Option {
 public:
  using Option::Option;
  [[nodiscard]] double value() const;
  /// Of it, or the usual one. Throws UsageError for one outside [low, high].
  [[nodiscard]] double within(double usual, double low, double high) const;
};
class NumbersOption : public Option {
 public:
  using Option::Option;
  [[nodiscard]] std::vector<double> values() const;
};
class TextOption : public Option {
 public:
  using Option::Option;
  /// Empty where there is none.
  [[nodiscard]] std::string value() const;
};
class TextsOption : public Option {
 public:
  using Option::Option;
  [[nodiscard]] std::vector<std::string> values() const;
};

/// Options of one command with the shared ones: --threads, --quiet, --json, --force, --help. They
/// know which files are read, also those that a scene names, and which are written: parse() refuses
/// an output that is an input or another output, and one that cannot be written, before any work.
class Options {
 public:
  /// `synopsis` e.g. "gate SCENE [options]"; `about` and `example` complete the help page.
  Options(std::string synopsis, std::string about, std::string example);
  ~Options();
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;

  /// Declares a positional argument (in order), a file that is read; `required` ones must be given.
  TextOption positional(const std::string& name, const std::string& help, bool required);
  /// Declares the last positional argument, files that are read: at least one.
  TextsOption positional_list(const std::string& name, const std::string& help);
  /// Declares the positional argument SCENE, which must be given.
  TextOption scene() { return positional("scene", "scene file (TOML; -: standard input)", true); }
  /// Declares the positional argument SCENE behind a matrix.
  TextOption second_scene() {
    return positional("scene", "of a matrix: another scene; without it the matrix's own", false);
  }

  /// Declare --name, whose value is `shown` on the help page. `by_default` is a value as it would
  /// be given. A whole number up to 1e15 either way: 20000 or 2e4.
  CountOption add_count(const std::string& name, const std::string& shown, const std::string& help,
                        const std::string& by_default = "");
  NumberOption add_number(const std::string& name, const std::string& shown,
                          const std::string& help);
  TextOption add_text(const std::string& name, const std::string& shown, const std::string& help,
                      const std::string& by_default = "");
  /// May be repeated.
  NumbersOption add_numbers(const std::string& name, const std::string& shown,
                            const std::string& help);
  TextsOption add_texts(const std::string& name, const std::string& shown, const std::string& help);
  /// The same; each value begins with a key of the scene, KEY=..., which varies.
  TextsOption add_varied(const std::string& name, const std::string& shown,
                         const std::string& help);
  /// Has no value.
  Option add_flag(const std::string& name, const std::string& help);
  /// --seed: a whole number from 0 up (-1 is a mistake, not 2^64 - 1).
  Option add_seed(
      const std::string& help = "seed of all random numbers; the same seed gives the same result");
  /// --trials, by default the paper's 100, and --seed.
  CountOption add_trials_and_seed(const std::string& trials_help);
  Option add_strict();
  /// --details, which also prints Screen::details; `shown` says in words what these are.
  void add_details(const std::string& shown);

  /// Declare that the command's pieces are kept (kept/kept_run.h): --checkpoint, which it returns,
  /// --resume, --max-time; and, with the names of stages that may be divided, --shard and --part.
  TextOption add_kept(std::set<std::string> divided = {});
  /// --first-trial, beside --trials.
  CountOption add_first_trial();

  /// Declares --name, a file that is read.
  TextOption input_file(const std::string& name, const std::string& help);
  /// A value of this option makes the command read the file `file_in(value)`.
  void reads(const Option& option, std::function<std::string(const std::string&)> file_in);
  /// Declares --name, a file that is written; `shown` is FILE or FILE.html, ... Only one output may
  /// go to standard output (-), and none that is binary.
  enum class Content { text, binary };
  TextOption output_file(const std::string& name, const std::string& shown, const std::string& help,
                         Content content = Content::text);
  /// The same for -o, --output, which must be given.
  TextOption main_output_file(const std::string& shown, const std::string& help, Content content);
  /// Declares -o, --output, which must be given: a folder, in which `files` are written.
  void output_folder(const std::string& help, std::vector<std::string> files);
  /// Declares --figure FILE.svg|pdf|png, a picture of the result; `shows` ends the help.
  TextOption add_figure(const std::string& shows);
  /// There is no scene to override keys of: --set is refused with `reason`, and not on the help
  /// page.
  void without_scene(const std::string& reason);

  /// Names the options that most users need, five at most: they stand first on the help page.
  void most_used(std::vector<std::string> names);

  /// Reads the arguments and looks at every file they name. False when --help was asked for and
  /// printed. Throws UsageError.
  [[nodiscard]] bool parse(const Arguments& arguments);

  /// Options that have the same name in all commands, for what is not told who declares them.
  const TextOption scene_file{*this, "scene"}, json{*this, "json"}, csv{*this, "csv"},
      output{*this, "output"}, figure{*this, "figure"}, passages{*this, "passages"},
      checkpoint{*this, "checkpoint"}, max_time{*this, "max-time"}, shard{*this, "shard"},
      part{*this, "part"};
  const Option force{*this, "force"}, quiet{*this, "quiet"}, resume{*this, "resume"},
      strict{*this, "strict"}, set{*this, "set"}, details{*this, "details"};
  const CountOption trials{*this, "trials"}, first_trial{*this, "first-trial"},
      threads{*this, "threads"};

  /// Those of --first-trial and --trials; the paper's 100 without them.
  [[nodiscard]] dynamics::TrialRange trial_range() const;
  [[nodiscard]] std::uint64_t seed() const;
  /// Those of --set.
  [[nodiscard]] std::vector<std::string> overrides() const;
  /// What add_varied has declared.
  [[nodiscard]] const std::vector<TextsOption>& varied() const;
  /// A file by its path: opened once, whoever asks for it.
  [[nodiscard]] const lattice::SourceFile& file(const std::string& path) const;
  /// The scene of SCENE and --set. Throws lattice::SceneError.
  [[nodiscard]] lattice::Scene read_scene() const;

  /// Arguments::cell.
  [[nodiscard]] const std::shared_ptr<const dynamics::Cell>& cell() const;

  /// Progress lines and remarks are wanted.
  [[nodiscard]] bool talk() const;
  /// Long work of this command: shown unless --quiet, stopped by a signal or --max-time, its pieces
  /// kept if that was declared; or as the arguments say. Throws UsageError as KeptRun.
  [[nodiscard]] dynamics::Work work() const;
  /// Its words without what only says how it runs.
  [[nodiscard]] const CommandWords& words() const;
  /// The result depends on this too: pieces of other such are refused.
  void depends_on(const std::string& text) const;
  /// All files that it reads, also those that a scene names.
  [[nodiscard]] std::vector<std::string> files_read() const;
  /// A warning, always: the result cannot be taken at face value. Nothing for an empty text.
  void warn(const std::string& text) const;
  /// A remark, if wanted and if somebody is there to read it (a terminal).
  void remark(const std::string& text) const;

  /// The command as it shaped the result, without what cannot change it (threads, output names).
  [[nodiscard]] std::string canonical() const;
  /// Where the result of this command comes from.
  [[nodiscard]] Provenance provenance() const;
  [[nodiscard]] Provenance provenance(const lattice::Scene& scene) const;
  [[nodiscard]] Provenance provenance(const lattice::Source& source) const;

  /// Passes the result to Arguments::given_out. Without that function, writes JSON where --json
  /// says and prints the screen on standard output; beside --json FILE the screen is printed unless
  /// there is --quiet. `indent` -1 writes JSON on one line, for long arrays.
  void give_out(const Description& describe, const Screen& screen, int indent = 2) const;
  /// The same of a result that is described.
  template <class Result>
  requires requires(Fields& out, const Result& result) { describe(out, result); }
  void give_out(const Result& result, const Screen& screen, int indent = 2) const {
    give_out(Description([&](Fields& out) { describe(out, result); }), screen, indent);
  }
  /// To be called before an output is written: what is there is kept as a Backup until the command
  /// is done, unless there is --force or it is written again. Then it is said which backups stay.
  /// Throws std::runtime_error.
  void keep_old(const std::string& path) const;
  /// keep_old and write_text_atomically.
  void write(const std::string& path, std::string_view text) const;
  /// Draws the picture that --figure asks for, if it does, when the result has been given out.
  /// Throws std::runtime_error, which says so, when gnuplot fails.
  void draw(const std::function<Figure()>& picture) const;
  /// Title and command for the metadata of pictures.
  [[nodiscard]] AboutFigure about() const;

 private:
  friend class Option;
  struct NamedFile;
  struct State;
  std::unique_ptr<State> state_;

  [[nodiscard]] bool has(const std::string& name) const;
  [[nodiscard]] std::string text(const std::string& name) const;
  [[nodiscard]] std::vector<NamedFile> inputs() const;
  [[nodiscard]] bool is_written(const std::string& option) const;
  [[nodiscard]] std::string group_of(const std::string& option) const;
  [[nodiscard]] CommandHelp help() const;
  [[nodiscard]] std::string help_page() const;
  [[nodiscard]] std::string text_of(const Screen& screen) const;
  void check_values_given() const;
  void check_files();
};

/// The word as a shell reads it.
[[nodiscard]] std::string shell_quoted(const std::string& word);

/// What to say of std::bad_alloc: which options of the command that runs would help.
[[nodiscard]] std::string out_of_memory();

/// The folder of -o: the numbers of a study and the figures drawn of them.
class ResultFolder {
 public:
  /// `files`: all that are written into it; `options` must outlive it. Makes the folder if need be.
  /// Throws std::runtime_error when it cannot be written to.
  ResultFolder(const Options& options, const std::vector<std::string>& files);
  /// Each file replaces the one before as a whole. First old figures go: they shall not stand
  /// beside new numbers.
  void write(const std::string& csv_file, const std::string& csv, const std::string& json_file,
             const Description& describe) const;
  /// The same of a result that is described.
  template <class Result>
  requires requires(Fields& out, const Result& result) { describe(out, result); }
  void write(const std::string& csv_file, const std::string& csv, const std::string& json_file,
             const Result& result) const {
    write(csv_file, csv, json_file, Description([&](Fields& out) { describe(out, result); }));
  }
  /// Throws std::runtime_error, which says that the numbers are written, when gnuplot fails.
  void draw(const std::string& file, const Figure& figure) const;
  [[nodiscard]] std::string path(const std::string& file) const;

 private:
  const Options& options_;
  std::string folder_;
  std::vector<std::string> files_;
};

/// The exit status of a command whose result is written: with --strict, kFailure when the result's
/// status is not clean, which is said.
[[nodiscard]] int exit_status(const Options& options, bool clean);

}  // namespace gatewalk::cli
