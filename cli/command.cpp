// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "cli/command_state.h"
#include "cli/fields/text.h"
#include "cli/kept/kept_options.h"
#include "cli/kept/ranks.h"
#include "cli/terminal/output.h"
#include "cli/terminal/progress.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/text/edit_distance.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::cli {
namespace {

std::string memory_advice;

/// Whether an option cannot change the result. The recorded command leaves these options out.
bool shapes_nothing(const std::string& name) {
  return name == "threads" || name == "quiet" || name == "json" || name == "csv" ||
         name == "output" || name == "strict" || name == "figure" || name == "netcdf" ||
         name == "page" || name == "details" || name == "force" || name == "checkpoint" ||
         name == "resume" || name == "max-time" || name == "shard" || name == "part";
}

/// Of an option that takes one value but is given several times, keeps the last. Returns a remark
/// for each such option.
Strings keep_last(std::vector<po::option>& given, const po::options_description& all) {
  Strings remarks;
  std::map<std::string, std::size_t> times;
  const auto once = [&](const po::option& o) {
    return o.position_key < 0 && !all.find(o.string_key, false).semantic()->is_composing();
  };
  for (const po::option& o : given)
    if (once(o)) ++times[o.string_key];
  const auto all_but_last = [&](const po::option& o) {
    return once(o) && times[o.string_key]-- > 1;
  };
  for (const auto& [name, count] : times) {
    const auto last = std::find_if(given.rbegin(), given.rend(), [&, &name = name](const auto& o) {
      return o.string_key == name;
    });
    if (count > 1 && !last->value.empty())
      remarks.push_back(fmt::format("{} is given {} times: the last one counts, {}", shown(name),
                                    count, last->value.front()));
  }
  given.erase(std::remove_if(given.begin(), given.end(), all_but_last), given.end());
  return remarks;
}

/// A remark for each key that the KEY=VALUE settings of one option give more than once, in any
/// unit: the last one counts. Returns none for keys that no scene has; the scene's reader refuses
/// these.
Strings repeated_keys(const std::string& option, const Strings& settings) {
  std::map<std::string, Strings> given;  // by key
  for (const std::string& setting : settings) {
    try {
      for (const std::string& key : lattice::keys_set_by(setting)) given[key].push_back(setting);
    } catch (const lattice::SceneError&) {
      return {};
    }
  }
  Strings remarks;
  for (const auto& [key, all] : given)
    if (all.size() > 1)
      remarks.push_back(fmt::format("{} gives {} {} times: the last one counts, {}", shown(option),
                                    key, all.size(), all.back()));
  return remarks;
}

/// The options among `offered` that reduce the memory of a command, in words.
std::string advice(const po::options_description& offered) {
  constexpr std::array<std::pair<const char*, const char*>, 7> kSmaller{
      {{"gate-runs", "--gate-runs N with a smaller N"},
       {"accuracy", "a larger --accuracy"},
       {"states", "fewer --states"},
       {"trials", "fewer --trials"},
       {"null-draws", "fewer --null-draws"},
       {"threads", "fewer --threads"},
       {"set", "--set field.rows and field.columns of a smaller field"}}};
  std::string all;
  for (const auto& [name, text] : kSmaller)
    if (offered.find_nothrow(name, false)) all += (all.empty() ? "" : ", ") + std::string(text);
  return all;
}

/// The message for a command line that Boost could not parse: what is wrong, and what is allowed.
std::string mistake_in(const po::error& error, const po::options_description& offered,
                       const Strings& words) {
  const bool takes_tables = offered.find_nothrow("cell", false) != nullptr;
  if (dynamic_cast<const po::too_many_positional_options_error*>(&error)) {
    const auto tables = std::count_if(words.begin(), words.end(), [](const std::string& word) {
      return lattice::has_ending(word, ".csv");
    });
    return std::string("there are more arguments than the command takes") +
           (takes_tables && tables > 1
                ? " (gatewalk passages cuts several recordings into one RUNS.csv)"
                : "");
  }
  const auto* named = dynamic_cast<const po::error_with_option_name*>(&error);
  if (!named) return error.what();
  std::string given = named->get_option_name();
  given = given.substr(0, given.find('='));
  if (dynamic_cast<const po::unknown_option*>(&error)) {
    if (given == "--cell" && !takes_tables)
      return "there is no option --cell here: gatewalk build TABLE --cell CELL.toml -o MATRIX.nc "
             "makes a matrix of recorded runs";
    Strings names;
    for (const auto& option : offered.options()) names.push_back(option->long_name());
    const std::string name = given.substr(given.find_first_not_of('-'));
    std::string meant = lattice::meant_name(name, names);
    if (meant.empty() && name.starts_with("trial") && offered.find_nothrow("walks", false))
      meant = "walks";  // the trials of a chain
    return "there is no option " + given +
           (meant.empty() ? "" : fmt::format(" (did you mean --{}?)", meant));
  }
  using Syntax = po::invalid_syntax;
  if (const auto* syntax = dynamic_cast<const Syntax*>(&error)) {
    if (syntax->kind() == Syntax::extra_parameter) return given + " takes no value";
    if (syntax->kind() == Syntax::missing_parameter ||
        syntax->kind() == Syntax::empty_adjacent_parameter)
      return given + " needs a value";
  }
  return error.what();  // a message of our own validators
}

}  // namespace

std::string shell_quoted(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-+=./,:@%") == std::string::npos;
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

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
    throw po::error_with_option_name(
        fmt::format("%canonical_option%: '{}' is not a whole number, such as 20000 or 2e4", text));
  if (is_large)
    throw po::error_with_option_name(
        fmt::format("%canonical_option%: '{}' is out of range: at most 1e15 is allowed", text));
  v = Count{static_cast<std::int64_t>(number)};
}

void validate(boost::any& v, const std::vector<std::string>& values, Number*, int) {
  po::validators::check_first_occurrence(v);
  const std::string& text = po::validators::get_single_string(values);
  Number number;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number.value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() ||
      !std::isfinite(number.value))
    throw po::error_with_option_name(
        fmt::format("%canonical_option%: '{}' is not a number, such as 0.01 or 1e-2", text));
  v = number;
}

void validate(boost::any& v, const std::vector<std::string>& values, Seed*, int) {
  po::validators::check_first_occurrence(v);
  const std::string& text = po::validators::get_single_string(values);
  Seed seed;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), seed.value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size())
    throw po::error_with_option_name(fmt::format(
        "%canonical_option%: '{}' is not a seed: a whole number from 0 to 2^64 - 1", text));
  v = seed;
}

namespace {}  // namespace

Options::Options(std::string synopsis, std::string about, std::string example)
    : state_(std::make_unique<State>()) {
  state_->synopsis = std::move(synopsis);
  state_->about = std::move(about);
  state_->example = std::move(example);
  state_->shared.add_options()("json", po::value<std::string>()->value_name("FILE"),
                               "write the result as JSON; - is standard output")(
      "threads", po::value<Count>()->default_value(Count{0}, "0")->value_name("N"),
      "threads to use, 0: all; never changes a result")(
      "force", "replace files that are there; without it they are kept, as FILE.~1~ and so on")(
      "quiet", "no progress, no remarks, no table when there is JSON or CSV")("help,h",
                                                                              "this page");
}

Options::~Options() {
  // The result is complete unless an exception is passing.
  const bool is_done = std::uncaught_exceptions() == state_->thrown_before;
  try {
    if (state_->kept && is_done) state_->kept->done();
    std::string kept;
    for (auto& [path, backup] : state_->backups)
      if (const std::string name = backup.settle(); !name.empty())
        kept += (kept.empty() ? "what was there is kept as " : ", ") + name;
    if (talk()) warn(kept);
  } catch (const std::exception&) {  // the files are in order; only the message is lost
  }
}

// ---- What is declared ----

TextOption Options::positional(const std::string& name, const std::string& help, bool required) {
  state_->hidden.add_options()(name.c_str(), po::value<std::string>());
  state_->positions.add(name.c_str(), 1);
  state_->positional_help.emplace_back(name, help);
  if (required) state_->required.push_back(name);
  return {*this, name};
}

TextsOption Options::positional_list(const std::string& name, const std::string& help) {
  state_->hidden.add_options()(name.c_str(), po::value<Strings>());
  state_->positions.add(name.c_str(), -1);
  state_->positional_help.emplace_back(name, help);
  state_->required.push_back(name);
  return {*this, name};
}

CountOption Options::add_count(const std::string& name, const std::string& shown,
                               const std::string& help, const std::string& by_default) {
  auto* value = po::value<Count>();
  if (!by_default.empty()) {
    boost::any parsed;
    validate(parsed, {by_default}, static_cast<Count*>(nullptr), 0);
    value->default_value(boost::any_cast<Count>(parsed), by_default);
  }
  state_->add(name, value, shown, help);
  return {*this, name};
}

NumberOption Options::add_number(const std::string& name, const std::string& shown,
                                 const std::string& help) {
  state_->add(name, po::value<Number>(), shown, help);
  return {*this, name};
}

TextOption Options::add_text(const std::string& name, const std::string& shown,
                             const std::string& help, const std::string& by_default) {
  auto* value = po::value<std::string>();
  if (!by_default.empty()) value->default_value(by_default);
  state_->add(name, value, shown, help);
  return {*this, name};
}

NumbersOption Options::add_numbers(const std::string& name, const std::string& shown,
                                   const std::string& help) {
  state_->add(name, po::value<std::vector<Number>>()->composing(), shown, help);
  return {*this, name};
}

TextsOption Options::add_texts(const std::string& name, const std::string& shown,
                               const std::string& help) {
  state_->add(name, po::value<Strings>()->composing(), shown, help);
  return {*this, name};
}

TextsOption Options::add_varied(const std::string& name, const std::string& shown,
                                const std::string& help) {
  return state_->varied.emplace_back(add_texts(name, shown, help));
}

Option Options::add_flag(const std::string& name, const std::string& help) {
  state_->own.add_options()(name.c_str(), help.c_str());
  return {*this, name};
}

Option Options::add_seed(const std::string& help) {
  state_->add("seed", po::value<Seed>()->default_value(Seed{1}, "1"), "S", help);
  return {*this, "seed"};
}

CountOption Options::add_trials_and_seed(const std::string& trials_help) {
  add_count("trials", "N", trials_help, "100");
  add_seed();
  return trials;
}

Option Options::add_strict() {
  return add_flag(
      "strict", "exit status 1 when the result's status is not clean; it is written all the same");
}

void Options::add_details(const std::string& shown) {
  add_flag("details", "also show " + shown);
  state_->details_shown = shown;
}

TextOption Options::add_kept(std::set<std::string> divided) {
  declare_kept(*this, !divided.empty());
  state_->divided = std::move(divided);
  return checkpoint;
}

CountOption Options::add_first_trial() {
  return add_count("first-trial", "I",
                   "number of the first trial: others than those of another run (default: 0)");
}

TextOption Options::input_file(const std::string& name, const std::string& help) {
  const TextOption file = add_text(name, "FILE", help);
  reads(file, [](const std::string& value) { return value; });
  return file;
}

void Options::reads(const Option& option, std::function<std::string(const std::string&)> file_in) {
  state_->reads.emplace_back(option.name(), std::move(file_in));
}

TextOption Options::output_file(const std::string& name, const std::string& shown,
                                const std::string& help, Content content) {
  add_text(name == "output" ? "output,o" : name, shown, help);
  state_->output_files.push_back({name, content});
  return {*this, name};
}

TextOption Options::main_output_file(const std::string& shown, const std::string& help,
                                     Content content) {
  output_file("output", shown, help, content);
  state_->needs_output = shown;
  return {*this, "output"};
}

void Options::output_folder(const std::string& help, std::vector<std::string> files) {
  add_text("output,o", "DIR", help);
  state_->folder_files = std::move(files);
  state_->needs_output = "DIR";
}

TextOption Options::add_figure(const std::string& shows) {
  return output_file("figure", "FILE.svg|pdf|png", fmt::format("draw {} (needs gnuplot)", shows),
                     Content::binary);
}

void Options::without_scene(const std::string& reason) { state_->no_scene = reason; }

// ---- What is given ----

bool Options::parse(const Arguments& arguments) {
  state_->work = arguments.work;
  state_->warned = arguments.warned;
  state_->given_out = arguments.given_out;
  state_->cell = arguments.cell;
  for (const auto& file : arguments.files) state_->files.emplace(file->path(), file);
  state_->words.parts = arguments.parts;
  (state_->no_scene.empty() ? state_->own : state_->hidden)
      .add_options()("set", po::value<Strings>()->composing()->value_name("KEY=VALUE"),
                     "override a key of the scene, e.g. forces.random_N=20 (may be repeated); what "
                     "the file leaves out stays as it follows from the file");
  if (!state_->own.find_nothrow("csv", false)) {
    state_->shared.add_options()(
        "csv", po::value<std::string>()->value_name("FILE"),
        "write the result's numbers as CSV: quantity,i,j,value,low_95,high_95; "
        "- is standard output");
    state_->output_files.push_back({"csv", Content::text});
    state_->has_table = true;
  }
  reads(set, [](const std::string& given) { return lattice::TomlFile(given, "").map_file(); });
  if (arguments.helped) {
    arguments.helped(help());
    return false;
  }
  po::options_description offered, all;
  offered.add(state_->own).add(state_->shared);
  all.add(offered).add(state_->hidden);
  using namespace po::command_line_style;
  const int style = unix_style & ~allow_guessing;  // an abbreviated option is an error
  const Strings& given = arguments.words;
  for (std::size_t i = 1; i < given.size() && state_->no_scene.empty(); ++i)
    if (given[i - 1] == "--set" && !given[i].starts_with("--") &&
        given[i].find('=') == Strings::value_type::npos)
      (void)lattice::keys_set_by(given[i]);  // throws if "=" is missing
  po::parsed_options parsed(&all);
  Strings remarks;
  try {
    parsed = po::command_line_parser(arguments.words)
                 .options(all)
                 .positional(state_->positions)
                 .style(style)
                 .run();
    remarks = keep_last(parsed.options, all);
    po::store(parsed, state_->values);
    po::notify(state_->values);
    for (const char* option : {"set", "versus"})
      for (std::string& remark : repeated_keys(option, TextsOption(*this, option).values()))
        remarks.push_back(std::move(remark));
  } catch (const po::error& e) {
    throw UsageError(fmt::format("{}; see gatewalk {} --help",
                                 mistake_in(e, offered, arguments.words), state_->name()));
  }
  if (Option(*this, "help")) {
    write_text_atomically("-", help_page());
    return false;
  }
  if (!state_->no_scene.empty() && set)
    throw UsageError("--set has no meaning here: " + state_->no_scene);
  for (const auto& name : state_->required) {
    if (!has(name))
      throw UsageError(fmt::format("missing {}: gatewalk {}", upper_case(name), state_->synopsis));
  }
  if (talk())
    for (const std::string& text : remarks) warn(text);
  state_->given = parsed.options;
  check_values_given();
  check_files();
  if (const std::int64_t n = threads.value(0, 1024); n > 0) {
    // The limit lives until the program ends.
    static const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                           static_cast<std::size_t>(n));
  }

  memory_advice = advice(offered);
  if (state_->divided) check_kept(*this);

  state_->words.command = state_->name();
  state_->words.main_output = state_->needs_output.empty() ? "json" : "output";
  state_->words.output_is_folder = state_->needs_output == "DIR";
  state_->canonical = "gatewalk " + state_->name();
  for (const auto& option : parsed.options) {
    const bool is_output =
        std::any_of(state_->output_files.begin(), state_->output_files.end(),
                    [&](const State::Output& o) { return o.name == option.string_key; }) ||
        (option.string_key == "output" && !state_->needs_output.empty());
    // Options that a merge of all parts may change.
    const bool is_of_whole = option.string_key == "strict" || option.string_key == "details";
    Strings& words = is_output || is_of_whole ? state_->words.outputs : state_->words.shaping;
    if (option.position_key >= 0) {
      words.push_back(option.value.front());
    } else if (option.string_key != "part" && option.string_key != "checkpoint" &&
               (is_output || is_of_whole || !shapes_nothing(option.string_key))) {
      if (option.value.empty()) words.push_back("--" + option.string_key);
      for (const auto& value : option.value)
        words.push_back(fmt::format("--{}={}", option.string_key, value));
    }
    if (option.position_key >= 0) {
      state_->canonical += " " + shell_quoted(option.value.front());
    } else if (!shapes_nothing(option.string_key)) {
      state_->canonical += " --" + option.string_key;
      for (const auto& value : option.value) state_->canonical += " " + shell_quoted(value);
    }
  }
  return true;
}

const boost::any* Option::given() const {
  return options_ && options_->has(name_) ? &options_->state_->values[name_].value() : nullptr;
}

Option::operator bool() const { return given() != nullptr; }

std::int64_t CountOption::value(std::int64_t low, std::int64_t high) const {
  const std::int64_t value = boost::any_cast<Count>(*given()).value;
  if (value < low || value > high)
    throw UsageError(
        fmt::format("--{} {}: must be at least {} and at most {}", name(), value, low, high));
  return value;
}

double NumberOption::value() const { return boost::any_cast<Number>(*given()).value; }

double NumberOption::within(double usual, double low, double high) const {
  if (!*this) return usual;
  const double given = value();
  if (!(given >= low && given <= high))
    throw UsageError(fmt::format("--{} {}: must lie in [{}, {}]", name(), digits(given),
                                 digits(low), digits(high)));
  return given;
}

std::vector<double> NumbersOption::values() const {
  std::vector<double> values;
  if (*this)
    for (const Number& n : boost::any_cast<const std::vector<Number>&>(*given()))
      values.push_back(n.value);
  return values;
}

std::string TextOption::value() const {
  return *this ? boost::any_cast<std::string>(*given()) : std::string();
}

std::vector<std::string> TextsOption::values() const {
  return *this ? boost::any_cast<Strings>(*given()) : Strings();
}

bool Options::has(const std::string& name) const { return state_->values.count(name) > 0; }

std::string Options::text(const std::string& name) const { return TextOption(*this, name).value(); }

std::vector<std::string> Options::overrides() const { return TextsOption(*this, "set").values(); }

const std::vector<TextsOption>& Options::varied() const { return state_->varied; }

std::uint64_t Options::seed() const { return state_->values["seed"].as<Seed>().value; }

const std::shared_ptr<const dynamics::Cell>& Options::cell() const { return state_->cell; }

std::string Options::canonical() const { return state_->canonical; }

bool Options::talk() const { return !quiet && is_first_rank(); }

dynamics::TrialRange Options::trial_range() const {
  const std::int64_t first = first_trial ? first_trial.value(0) : 0;
  constexpr std::int64_t kPapers = 100;
  return {first, trials ? trials.value(1, kMostCount - first) : kPapers};
}

dynamics::Work Options::work() const {
  const bool watched = !state_->work;
  if (watched) state_->work = watched_work(talk(), {}, !ranks());
  if (watched || (!state_->kept && !state_->words.parts.empty())) {
    if (state_->divided) {
      state_->kept = kept_run(*this, *state_->divided);
      state_->work = kept_work(*this, *state_->work, state_->kept.get());
    }
    // Only the first of several MPI processes writes.
    for (const TextOption& file : {output, passages})
      if (!is_first_rank() && file)
        state_->values.find(file.name())->second.value() = std::string("/dev/null");
  }
  return *state_->work;
}

const CommandWords& Options::words() const { return state_->words; }

void Options::depends_on(const std::string& text) const { state_->words.others.push_back(text); }

std::string out_of_memory() {
  return "out of memory; files that are written already are whole and stay" +
         (memory_advice.empty() ? "" : ". Less is needed with: " + memory_advice);
}

}  // namespace gatewalk::cli
