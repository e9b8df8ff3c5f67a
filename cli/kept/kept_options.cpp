// SPDX-License-Identifier: MIT
#include "cli/kept/kept_options.h"

#include <fmt/core.h>
#include <zlib.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>
#include <vector>

#include "cli/fields/json.h"
#include "cli/kept/ranks.h"
#include "cli/render/version.h"
#include "cli/terminal/interrupt.h"
#include "lattice/source/source.h"
#include "lattice/source/source_file.h"

namespace gatewalk::cli {
namespace {

/// Seconds of "90s", "45min", "3h", "2d". Throws UsageError.
double seconds_of(const std::string& text) {
  double number = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string_view unit(read.ptr, text.data() + text.size());
  constexpr std::array<std::pair<const char*, double>, 4> kUnits{
      {{"s", 1.0}, {"min", 60.0}, {"h", 3600.0}, {"d", 86400.0}}};
  for (const auto& [name, seconds] : kUnits)
    if (read.ec == std::errc() && unit == name && number > 0.0 && std::isfinite(number))
      return number * seconds;
  throw UsageError(
      fmt::format("--max-time {}: must be a time, such as 90s, 45min, 3h or 2d", text));
}

/// Path, size and checksum of an input file; `read` is the part of it that is in memory.
void describe_input(Fields& out, const std::string& path, const lattice::TomlFile& read) {
  std::uint64_t bytes = 0;
  uLong check = ::crc32_z(0, nullptr, 0);
  const auto add = [&](const char* data, std::size_t n) {
    check = ::crc32_z(check, reinterpret_cast<const Bytef*>(data), n);
    bytes += n;
  };
  if (read.is_whole()) {
    add(read.bytes().data(), read.bytes().size());
  } else {
    std::ifstream in(path, std::ios::binary);
    in.exceptions(std::ios_base::badbit);  // a read error is not the end of the file
    std::vector<char> buffer(std::size_t{1} << 16);
    while (in.read(buffer.data(), std::ssize(buffer)), in.gcount() > 0)
      add(buffer.data(), static_cast<std::size_t>(in.gcount()));
  }
  out.text({"file", "path of the file"}, path);
  out.count({"bytes", "byte", "size of the file"}, bytes);
  out.count({"crc32", "1", "checksum of the file's bytes"}, check);
}

bool is_by_trials(const Options& options) { return options.part && !options.shard; }

/// The scene as TOML; none if the command reads a matrix or recorded runs in place of a scene.
std::optional<std::string> scene_of(const Options& options) {
  if (!options.scene_file) return {};
  try {
    return lattice::to_toml(options.read_scene());
  } catch (const lattice::SceneError&) {
    return {};
  }
}

/// The head of a file of pieces: the command whose pieces it holds.
void describe_head(Fields& out, const Options& options) {
  const CommandWords& words = options.words();
  std::vector<std::string> shaping = words.shaping;
  if (options.passages) shaping.emplace_back("--passages");  // the kept pieces include passages
  out.text({"version", "version of the program"}, kVersion);
  out.text({"commit", "commit of its sources"}, kCommit);
  out.text({"command", "name of the command"}, words.command);
  out.texts({"words", "words that shape the result"}, shaping);
  out.texts({"outputs", "words that say where the result goes"}, words.outputs);
  out.text({"main_output", "option of the main output"}, words.main_output);
  out.text({"scene", "the scene, as TOML"}, scene_of(options));
  out.list({"inputs", "files that the command reads"}, options.files_read(),
           [&](Fields& f, const std::string& path) {
             describe_input(f, path, options.file(path).toml());
           });
  out.texts({"others", "what else shapes the result, and is no word"}, words.others);
  out.optional(static_cast<bool>(options.shard), [&](Fields& part) {
    const Shard shard = shard_of(options.shard.value());
    part.counts({"shard", "1", "number of the part, from 1, and number of parts"},
                {shard.number, shard.of});
  });
  out.optional(is_by_trials(options), [&](Fields& part) {
    const dynamics::TrialRange trials = options.trial_range();
    part.count({"first_trial", "1", "number of the part's first trial"}, trials.first);
    part.count({"trials", "1", "number of the part's trials"}, trials.count);
  });
}

/// The default file for pieces: beside the output file. Empty if the output is no file.
std::string file_beside_result(const Options& options) {
  const CommandWords& words = options.words();
  if (words.output_is_folder) return "";  // their studies are not kept
  for (const TextOption& output : {options.output, options.csv, options.json})
    if (output && output.value() != "-") {
      const std::string path = output.value();
      std::error_code error;
      const auto kind = std::filesystem::status(path, error).type();
      const bool is_file = kind == std::filesystem::file_type::regular ||
                           kind == std::filesystem::file_type::not_found;
      return is_file ? path + ".unfinished" : "";
    }
  return "";
}

}  // namespace

void declare_kept(Options& options, bool can_be_divided) {
  options.output_file("checkpoint", "FILE",
                      "keep what is done in FILE until the result is there (without it: beside the "
                      "output, once it is the work of a minute)",
                      Options::Content::binary);
  options.add_flag("resume", "go on with what was kept; from the beginning if nothing was");
  options.add_text("max-time", "T",
                   "stop after T, such as 90s, 45min, 3h, 2d, with exit status 75; --resume goes "
                   "on");
  if (!can_be_divided) return;
  options.add_text("shard", "I/N",
                   "do part I of N only, I from 1; gatewalk merge makes one run of the parts");
  options.output_file("part", "FILE", "where the part goes; merge writes all other outputs",
                      Options::Content::binary);
}

void check_kept(const Options& options) {
  if (options.max_time) (void)seconds_of(options.max_time.value());
  if (options.shard) {
    (void)shard_of(options.shard.value());
    if (!options.part) throw UsageError("--shard needs --part FILE, where the part goes");
    if (options.first_trial)
      throw UsageError("--shard and --first-trial both say which part: give one");
  }
  if (is_by_trials(options) && !options.first_trial)
    throw UsageError("--part needs --shard I/N: which part");
  if (options.part && options.checkpoint)
    throw UsageError("--checkpoint has no meaning beside --part, which keeps what is done");
}

std::unique_ptr<KeptRun> kept_run(const Options& options, const std::set<std::string>& divided) {
  std::vector<std::string> inputs = options.files_read();
  if (options.scene_file.value() == "-") inputs.emplace_back("-");
  for (const std::string& path : inputs) {
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error)) continue;
    for (const Option& option : std::initializer_list<Option>{options.checkpoint, options.resume,
                                                              options.max_time, options.part})
      if (option)
        throw UsageError(
            fmt::format("--{}: {} is no file, and what was read from it cannot be read again",
                        option.name(), path));
    return nullptr;
  }
  KeptPlan plan{.head = {},
                .file = (options.part ? options.part : options.checkpoint).value(),
                .goes_on = static_cast<bool>(options.resume),
                .is_part = static_cast<bool>(options.part),
                .divided = divided,
                .parts = options.words().parts,
                .writes = is_first_rank(),
                .warn = [&options](const std::string& text) { options.warn(text); }};
  if (options.shard) plan.shard = shard_of(options.shard.value());
  if (plan.file.empty() && plan.parts.empty()) {
    plan.file = file_beside_result(options);
    plan.at_once = static_cast<bool>(options.max_time);
    if (plan.file.empty() && (options.max_time || plan.goes_on))
      throw UsageError(fmt::format("--{} needs an output file, or --checkpoint FILE",
                                   plan.goes_on ? "resume" : "max-time"));
    if (plan.file.empty()) return nullptr;
  }
  const bool is_there = std::filesystem::exists(plan.file), is_kept = PieceFile::is_one(plan.file);
  if (is_kept && !plan.goes_on && !options.force)
    throw UsageError(plan.file +
                     ": holds what an earlier run has done: --resume goes on with it, --force "
                     "begins anew");
  if (is_there && !is_kept && !(options.force && !plan.goes_on))
    throw UsageError(plan.file +
                     ": is there and holds no pieces of a run: name another file, or --force");
  if (options.max_time && !ranks())  // several processes stop together, see kept_work
    plan.most_seconds = seconds_of(options.max_time.value());
  plan.head = json_text([&](Fields& out) { describe_head(out, options); }, -1);
  return std::make_unique<KeptRun>(std::move(plan));
}

dynamics::Work kept_work(const Options& options, dynamics::Work work, KeptRun* kept) {
  work.kept = kept;
  work.ranks = ranks();
  if (!work.ranks) return work;
  const double most = options.max_time ? seconds_of(options.max_time.value())
                                       : std::numeric_limits<double>::infinity();
  set_ranks_stop([most, since = dynamics::Stopwatch()] {  // stops all processes together
    return since.seconds() >= most || interrupted();
  });
  return work;
}

}  // namespace gatewalk::cli
