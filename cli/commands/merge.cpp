// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/fields/json_value.h"
#include "cli/kept/kept_run.h"
#include "markov/formats/counts.h"

namespace gatewalk::cli {
namespace {

/// The trials of the whole run, from parts that are given by trial numbers.
dynamics::TrialRange trials_of(const std::vector<Json>& heads) {
  std::int64_t first = kMostCount, end = 0;
  for (const Json& head : heads) {
    const auto from = head.at("first_trial").get<std::int64_t>();
    first = std::min(first, from);
    end = std::max(end, from + head.at("trials").get<std::int64_t>());
  }
  return {first, end - first};
}

/// Appends the options of a list that `words` lacks, each option once.
void add_options(std::vector<std::string>& words, const Json& more) {
  for (const std::string word : more) {
    const std::string name = word.substr(0, word.find('='));
    if (std::none_of(words.begin(), words.end(),
                     [&](const std::string& w) { return w.substr(0, w.find('=')) == name; }))
      words.push_back(word);
  }
}

/// The words of the whole run's command.
std::vector<std::string> words_of(const std::vector<Json>& heads, const std::string& output) {
  const Json& head = heads.front();
  std::vector<std::string> words, outputs;
  for (const std::string word : head.at("words")) words.push_back(word);
  std::erase(words, "--passages");
  if (head.contains("first_trial")) {
    for (const Json& other : heads)
      if (!other.contains("first_trial"))
        throw UsageError("some parts are by --shard, others by --first-trial");
    const dynamics::TrialRange trials = trials_of(heads);
    const auto put = [&](const std::string& name, std::int64_t value) {
      const auto there = std::find_if(words.begin(), words.end(),
                                      [&](const std::string& w) { return w.starts_with(name); });
      (there == words.end() ? words.emplace_back() : *there) = name + std::to_string(value);
    };
    put("--trials=", trials.count);
    put("--first-trial=", trials.first);
    if (trials.first == 0) std::erase(words, "--first-trial=0");
  }
  for (const Json& each : heads) add_options(outputs, each.at("outputs"));
  if (!output.empty()) {
    std::string name = head.at("main_output");
    if (head.at("command") == "sweep" && output.ends_with(".csv")) name = "csv";
    std::erase_if(outputs,
                  [&](const std::string& w) { return w.starts_with(fmt::format("--{}=", name)); });
    outputs.push_back(fmt::format("--{}={}", name, output));
  }
  words.insert(words.end(), outputs.begin(), outputs.end());
  return words;
}

}  // namespace

int run_merge(const Arguments& arguments) {
  Options options(
      "merge PART... [-o FILE] [options] [-- options of the parts' command]",
      "Makes one run of parts that were done on several machines (--shard I/N --part FILE, or\n"
      "--first-trial I --part FILE): the same bits as if one machine had done all. What the parts\n"
      "were told to write (--json, -o, --figure ...) is written now; -o names the main output\n"
      "anew: the matrix of build, the CSV of sweep, the JSON of others. Parts that overlap or are\n"
      "missing are named.",
      "gatewalk merge part1 part2 part3 -o all.json");
  const TextsOption part_files = options.positional_list("part", "files that --part wrote");
  options.output_file("output", "FILE", "the main output", Options::Content::binary);
  options.without_scene("the parts have their scene");
  options.add_details("what the parts' command shows with --details");
  options.most_used({"output", "json"});
  const auto own_end = std::find(arguments.words.begin(), arguments.words.end(), "--");
  Arguments own = arguments;
  own.words.assign(arguments.words.begin(), own_end);
  if (!options.parse(own)) return kFine;

  const std::vector<std::string> parts = part_files.values();
  std::vector<Json> heads;
  for (const std::string& part : parts) heads.push_back(head_in(part));
  const std::string name = heads.front().at("command");
  const Command* const command = command_named(name);
  if (!command)
    throw markov::BadFile(fmt::format("{}: is of a command {}, unknown here", parts.front(), name));
  if (options.output && options.json && heads.front().at("main_output") == "json")
    throw UsageError(
        fmt::format("-o and --json name the same output of gatewalk {}: give one", name));
  Arguments all(words_of(heads, options.output.value()));
  for (const Option& flag : {options.quiet, options.force, options.details})
    if (flag) all.words.push_back("--" + flag.name());
  if (options.json) all.words.push_back("--json=" + options.json.value());
  for (auto word = own_end; word != arguments.words.end(); ++word) {
    for (const char* option : {"shard", "part", "checkpoint", "resume", "max-time", "first-trial"})
      if (word->starts_with("--" + std::string(option)))
        throw UsageError(*word + " has no meaning in merge, which has all parts");
    if (word != own_end) all.words.push_back(*word);
  }
  all.parts = parts;
  all.work = arguments.work;
  all.warned = arguments.warned;
  all.given_out = arguments.given_out;
  return command->run(all);
}

}  // namespace gatewalk::cli
