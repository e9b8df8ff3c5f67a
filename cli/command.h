// SPDX-License-Identifier: MIT
#pragma once
/// What all commands share: declaring and reading options, and giving out results.

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

/// The parts of a command's help page.
struct CommandHelp {
  std::string synopsis, about, example;
  std::vector<std::pair<std::string, std::string>> arguments;  // name as shown, meaning
  struct Option {
    std::string name, value, text;  // value: as shown; empty for a flag
    char letter = 0;                // the letter of a short option, as o in -o
    bool is_file = false;
    std::string kind = "text";  // text, flag, count, seed or number
    bool is_repeated = false;
    std::string group{};  // heading on the page; options of one group stand together
  };
  std::vector<Option> options;
};

/// Command-line arguments after the command's name, plus what only a caller in the same process can
/// pass, such as the Python module: progress and warning callbacks, a receiver for the result, a
/// Cell object, and files that are open already.
struct Arguments {
  Arguments(std::vector<std::string> given) : words(std::move(given)) {}  // NOLINT: the usual case
  Arguments(std::initializer_list<std::string> given) : words(given) {}

  std::vector<std::string> words;
  std::optional<dynamics::Work> work = std::nullopt;
  std::function<void(const std::string&)> warned = nullptr;
  std::vector<std::string> parts{};  // merge: the files that hold the pieces of all parts
  std::function<void(const Description&)> given_out = nullptr;
  std::shared_ptr<const dynamics::Cell> cell = nullptr;
  std::vector<std::shared_ptr<const lattice::SourceFile>> files{};
  std::function<void(const CommandHelp&)> helped = nullptr;  // receives the help page alone
};

/// The command line split into its parts, so that another run of the command can be recognised or
/// started.
struct CommandWords {
  std::string command;
  std::vector<std::string> shaping, outputs;  // that shape the result; that name outputs
  std::string main_output;                    // output (-o) or json
  bool output_is_folder = false;
  std::vector<std::string> others{};  // what else shapes the result, though no word says it
  std::vector<std::string> parts{};   // as Arguments::parts
};

/// Exit statuses, which scripts may rely on.
enum ExitCode : int {
  kFine = 0,
  kFailure = 1,
  kWrongUse = 2,
  kResumable = 75,
  kStopped = 130,
  kReaderWentAway = 141  // 128 + SIGPIPE, as shells report it
};

/// The command line itself is wrong (exit status kWrongUse).
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr std::int64_t kMostCount = 1'000'000'000'000'000;  // doubles are exact up to here

/// What a command shows on the terminal.
struct Screen {
  Screen(std::string text, std::string more = {}, std::vector<std::string> then = {},  // NOLINT
         std::string what_details_show = {})
      : answer(std::move(text)),
        details(std::move(more)),
        next(std::move(then)),
        details_shown(std::move(what_details_show)) {}

  std::string answer;             // at most 15 lines for one start, without maps
  std::string details;            // printed after the answer with --details
  std::vector<std::string> next;  // what the user can do next: shell commands (NextCommands)
  std::string details_shown;      // what `details` shows, in words; empty: as add_details() says
};

class Options;

/// An option of a command, as the variable that its declaration returns. A misspelt option then
/// does not compile.
class Option {
 public:
  Option() = default;  // an option that the command does not have
  Option(const Options& options, std::string name) : options_(&options), name_(std::move(name)) {}
  /// Whether the option has a value: a given one, or its default.
  [[nodiscard]] explicit operator bool() const;
  [[nodiscard]] const std::string& name() const { return name_; }

 protected:
  /// The option's value; null where it has none.
  [[nodiscard]] const boost::any* given() const;

 private:
  const Options* options_ = nullptr;
  std::string name_;
};
class CountOption : public Option {
 public:
  using Option::Option;
  /// The whole number given. Throws UsageError unless it lies in [low, high].
  [[nodiscard]] std::int64_t value(std::int64_t low = 1, std::int64_t high = kMostCount) const;
};
class NumberOption : public Option {
 public:
  using Option::Option;
  [[nodiscard]] double value() const;
  /// The number given, or `usual` without one. Throws UsageError unless it lies in [low, high].
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
  /// The text given; empty without one.
  [[nodiscard]] std::string value() const;
};
class TextsOption : public Option {
 public:
  using Option::Option;
  [[nodiscard]] std::vector<std::string> values() const;
};

/// The options of one command, with those that all commands share: --threads, --quiet, --json,
/// --force, --help. parse() checks all files before any work: it refuses an output that is also an
/// input or another output, or that cannot be written. Files that a scene names count as inputs.
class Options {
 public:
  /// `synopsis` is for example "gate SCENE [options]"; `about` and `example` complete the help
  /// page.
  Options(std::string synopsis, std::string about, std::string example);
  ~Options();
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;

  /// Declares the next positional argument, an input file. If `required`, the user must give it.
  TextOption positional(const std::string& name, const std::string& help, bool required);
  /// Declares the last positional argument: one or more input files.
  TextsOption positional_list(const std::string& name, const std::string& help);
  /// Declares the positional argument SCENE, which the user must give.
  TextOption scene() { return positional("scene", "scene file (TOML; -: standard input)", true); }
  /// Declares an optional positional argument SCENE after a matrix.
  TextOption second_scene() {
    return positional("scene", "of a matrix: another scene; without it the matrix's own", false);
  }

  /// Declares an option --name; `shown` is its value on the help page, `by_default` a value as a
  /// user would give it. add_count takes a whole number of at most 1e15 either way, such as 20000
  /// or 2e4.
  CountOption add_count(const std::string& name, const std::string& shown, const std::string& help,
                        const std::string& by_default = "");
  NumberOption add_number(const std::string& name, const std::string& shown,
                          const std::string& help);
  TextOption add_text(const std::string& name, const std::string& shown, const std::string& help,
                      const std::string& by_default = "");
  /// Declares an option that may be repeated.
  NumbersOption add_numbers(const std::string& name, const std::string& shown,
                            const std::string& help);
  TextsOption add_texts(const std::string& name, const std::string& shown, const std::string& help);
  /// Declares an option that may be repeated. Each value begins with KEY=, a key of the scene that
  /// the command varies.
  TextsOption add_varied(const std::string& name, const std::string& shown,
                         const std::string& help);
  /// Declares an option without a value.
  Option add_flag(const std::string& name, const std::string& help);
  /// Declares --seed, a whole number of at least 0. A negative number is refused, not wrapped.
  Option add_seed(
      const std::string& help = "seed of all random numbers; the same seed gives the same result");
  /// Declares --trials, 100 by default as in the paper, and --seed.
  CountOption add_trials_and_seed(const std::string& trials_help);
  Option add_strict();
  /// Declares --details, which also prints Screen::details; `shown` says in words what these are.
  void add_details(const std::string& shown);

  /// Declares that the command keeps its finished pieces of work (kept/kept_run.h): adds
  /// --checkpoint, which is returned, --resume and --max-time. `divided` names the stages that
  /// several machines may divide, for which --shard and --part are added.
  TextOption add_kept(std::set<std::string> divided = {});
  /// Declares --first-trial, the number of the first trial, beside --trials.
  CountOption add_first_trial();

  /// Declares --name, an input file.
  TextOption input_file(const std::string& name, const std::string& help);
  /// Declares that a value of this option makes the command read the file `file_in(value)`.
  void reads(const Option& option, std::function<std::string(const std::string&)> file_in);
  /// Declares --name, an output file; `shown` is FILE, FILE.html, ... Only one output may go to
  /// standard output (-), and no binary one.
  enum class Content { text, binary };
  TextOption output_file(const std::string& name, const std::string& shown, const std::string& help,
                         Content content = Content::text);
  /// Declares -o, --output, an output file that the user must name.
  TextOption main_output_file(const std::string& shown, const std::string& help, Content content);
  /// Declares -o, --output, a folder that the user must name; `files` are written into it.
  void output_folder(const std::string& help, std::vector<std::string> files);
  /// Declares --figure FILE.svg|pdf|png, a picture of the result; `shows` ends the help text.
  TextOption add_figure(const std::string& shows);
  /// Declares that the command has no scene, so that --set is refused with `reason` and missing on
  /// the help page.
  void without_scene(const std::string& reason);

  /// Names the options that most users need, five at most: they stand first on the help page.
  void most_used(std::vector<std::string> names);

  /// Reads the arguments and checks every file that they name. Returns false if --help was asked
  /// for; the help page is then printed. Throws UsageError.
  [[nodiscard]] bool parse(const Arguments& arguments);

  /// Options that have the same name in all commands, for code that does not declare them itself.
  const TextOption scene_file{*this, "scene"}, json{*this, "json"}, csv{*this, "csv"},
      output{*this, "output"}, figure{*this, "figure"}, passages{*this, "passages"},
      checkpoint{*this, "checkpoint"}, max_time{*this, "max-time"}, shard{*this, "shard"},
      part{*this, "part"};
  const Option force{*this, "force"}, quiet{*this, "quiet"}, resume{*this, "resume"},
      strict{*this, "strict"}, set{*this, "set"}, details{*this, "details"};
  const CountOption trials{*this, "trials"}, first_trial{*this, "first-trial"},
      threads{*this, "threads"};

  /// The trials that --first-trial and --trials ask for; 0 to 99 without them, as in the paper.
  [[nodiscard]] dynamics::TrialRange trial_range() const;
  [[nodiscard]] std::uint64_t seed() const;
  /// The values of --set, KEY=VALUE.
  [[nodiscard]] std::vector<std::string> overrides() const;
  /// The options that add_varied has declared.
  [[nodiscard]] const std::vector<TextsOption>& varied() const;
  /// The file at a path. A file is opened once and then shared by all callers.
  [[nodiscard]] const lattice::SourceFile& file(const std::string& path) const;
  /// The scene of SCENE and --set. Throws lattice::SceneError.
  [[nodiscard]] lattice::Scene read_scene() const;

  /// The cell that the caller passed (Arguments::cell); null if none.
  [[nodiscard]] const std::shared_ptr<const dynamics::Cell>& cell() const;

  /// Whether the user wants progress lines and remarks.
  [[nodiscard]] bool talk() const;
  /// How long work of this command runs: its progress is shown unless --quiet, a signal or
  /// --max-time stops it, and its pieces are kept if add_kept was called. A caller's
  /// Arguments::work replaces all this. Throws UsageError as KeptRun.
  [[nodiscard]] dynamics::Work work() const;
  /// The words of the command, without options that only say how it runs.
  [[nodiscard]] const CommandWords& words() const;
  /// Declares that the result also depends on `text`: --resume and merge refuse pieces of a run
  /// with another text.
  void depends_on(const std::string& text) const;
  /// All input files, including those that a scene names.
  [[nodiscard]] std::vector<std::string> files_read() const;
  /// Warns, with --quiet too, that the result cannot be taken at face value. An empty text prints
  /// nothing.
  void warn(const std::string& text) const;
  /// Prints a remark on a terminal, unless --quiet.
  void remark(const std::string& text) const;

  /// The command that shaped the result, without options that cannot change it (threads, outputs).
  [[nodiscard]] std::string canonical() const;
  /// What the result was made from: command, seed, scene or cells, parts.
  [[nodiscard]] Provenance provenance() const;
  [[nodiscard]] Provenance provenance(const lattice::Scene& scene) const;
  [[nodiscard]] Provenance provenance(const lattice::Source& source) const;

  /// Passes the result to Arguments::given_out. Without that function, writes JSON where --json
  /// says and prints the screen on standard output; beside --json FILE the screen is printed unless
  /// there is --quiet. `indent` -1 writes JSON on one line, for long arrays.
  void give_out(const Description& describe, const Screen& screen, int indent = 2) const;
  /// give_out of a result that has a function describe().
  template <class Result>
  requires requires(Fields& out, const Result& result) { describe(out, result); }
  void give_out(const Result& result, const Screen& screen, int indent = 2) const {
    give_out(Description([&](Fields& out) { describe(out, result); }), screen, indent);
  }
  /// Keeps the file at `path` as a Backup until the command ends, unless --force is given. To be
  /// called before an output is written. At the command's end a remark names the backups that stay.
  /// Throws std::runtime_error.
  void keep_old(const std::string& path) const;
  /// keep_old, then write_text_atomically.
  void write(const std::string& path, std::string_view text) const;
  /// Draws the picture that --figure asks for; does nothing without --figure. To be called after
  /// give_out. Throws std::runtime_error when gnuplot fails; the message says that the numbers are
  /// written.
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

/// The word quoted as a shell needs it.
[[nodiscard]] std::string shell_quoted(const std::string& word);

/// The message for std::bad_alloc, with the options of the current command that would need less
/// memory.
[[nodiscard]] std::string out_of_memory();

/// The folder of -o, with the numbers of a study and the figures drawn from them.
class ResultFolder {
 public:
  /// Makes the folder if there is none. `files` are all files that are written into it; `options`
  /// must outlive this object. Throws std::runtime_error when the folder cannot be written to.
  ResultFolder(const Options& options, const std::vector<std::string>& files);
  /// Writes the table and the JSON, each file as a whole. Removes old figures first, so that no old
  /// figure stands beside new numbers.
  void write(const std::string& csv_file, const std::string& csv, const std::string& json_file,
             const Description& describe) const;
  /// write() of a result that has a function describe().
  template <class Result>
  requires requires(Fields& out, const Result& result) { describe(out, result); }
  void write(const std::string& csv_file, const std::string& csv, const std::string& json_file,
             const Result& result) const {
    write(csv_file, csv, json_file, Description([&](Fields& out) { describe(out, result); }));
  }
  /// Draws a figure. Throws std::runtime_error when gnuplot fails; the message says that the other
  /// files are written.
  void draw(const std::string& file, const Figure& figure) const;
  [[nodiscard]] std::string path(const std::string& file) const;

 private:
  const Options& options_;
  std::string folder_;
  std::vector<std::string> files_;
};

/// The exit status of a command whose result is written. With --strict and a result that is not
/// clean, warns and returns kFailure.
[[nodiscard]] int exit_status(const Options& options, bool clean);

}  // namespace gatewalk::cli
