// SPDX-License-Identifier: MIT
#include "cli/kept/kept_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "cli/command.h"
#include "cli/fields/json_value.h"
#include "cli/render/version.h"
#include "cli/terminal/interrupt.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/text/toml_text.h"
#include "markov/formats/counts.h"

namespace gatewalk::cli {
namespace {

using dynamics::TrialRange;

constexpr std::int64_t kMostParts = 1'000'000;

/// The head as JSON. Throws markov::BadFile unless it has all keys that a run writes there.
Json checked_head(const std::string& path, const std::string& text) {
  const Json head = parsed_json(text);
  // Another commit may have written other keys, so messages name the commit.
  const std::string commit =
      head.is_object() && head.contains("commit") && head.at("commit").is_string()
          ? head.at("commit").get<std::string>()
          : kCommit;
  const auto require = [&](bool is_right, const char* key) {
    if (!is_right)
      throw markov::BadFile(fmt::format(
          "{}: its second line, which says what the command was, has no {} as a run writes it{}",
          path, key,
          commit == kCommit ? std::string()
                            : fmt::format("; commit {} wrote it, and this is {}",
                                          lattice::printable(commit), kCommit)));
  };
  require(head.is_object(), "object");
  const auto is_list = [&](const char* key, const auto& is_one) {
    const auto at = head.find(key);
    return at != head.end() && at->is_array() && std::all_of(at->begin(), at->end(), is_one);
  };
  const auto is_text = [](const Json& value) { return value.is_string(); };
  const auto is_whole = [](const Json& value, std::int64_t low, std::int64_t high) {
    return value.is_number_integer() && value.get<double>() >= static_cast<double>(low) &&
           value.get<double>() <= static_cast<double>(high);
  };
  for (const char* key : {"version", "commit", "command", "main_output"})
    require(head.contains(key) && head.at(key).is_string(), key);
  for (const char* key : {"words", "outputs", "others"}) require(is_list(key, is_text), key);
  require(is_list("inputs",
                  [&](const Json& input) {
                    return input.is_object() && input.contains("file") && is_text(input.at("file"));
                  }),
          "inputs");
  require(head.contains("scene") && (head.at("scene").is_null() || is_text(head.at("scene"))),
          "scene");
  if (const auto shard = head.find("shard"); shard != head.end())
    require(shard->is_array() && shard->size() == 2 && is_whole((*shard)[1], 1, kMostParts) &&
                is_whole((*shard)[0], 1, (*shard)[1].get<std::int64_t>()),
            "shard");
  if (head.contains("first_trial"))
    require(is_whole(head.at("first_trial"), 0, kMostCount) && head.contains("trials") &&
                is_whole(head.at("trials"), 1, kMostCount),
            "first_trial and trials");
  return head;
}

std::int64_t end_of(TrialRange items) { return items.first + items.count; }

std::string shown(TrialRange items) {
  return fmt::format("items {} to {}", items.first, end_of(items) - 1);
}

/// The part of a run, in words: "part 1 of 8", or the numbers of its trials.
std::string name_of_part(const Json& head) {
  if (head.contains("shard"))
    return fmt::format("part {} of {}", head["shard"][0].get<std::int64_t>(),
                       head["shard"][1].get<std::int64_t>());
  if (head.contains("first_trial")) {
    const auto first = head["first_trial"].get<std::int64_t>();
    return fmt::format("trials {} to {}", first, first + head["trials"].get<std::int64_t>() - 1);
  }
  return "a run";
}

/// The keys that differ between two scenes, both TOML, a line each.
std::string scene_difference(const std::string& there, const std::string& here) {
  try {
    const auto differences = lattice::physics_differences(lattice::parse_scene(here, "here"),
                                                          lattice::parse_scene(there, "there"));
    std::string text;
    for (const std::string& line : differences) text += "\n  " + line;
    return text;
  } catch (const lattice::SceneError&) {
    return "";
  }
}

/// What differs between two heads; empty if both belong to one command.
std::string difference(const Json& there, const Json& here) {
  for (const char* key : {"version", "commit", "command"})
    if (there.at(key) != here.at(key))
      return fmt::format("{}: {} there, {} here", key, there.at(key).get<std::string>(),
                         here.at(key).get<std::string>());
  if (there.at("scene") != here.at("scene")) {
    const std::string keys = there.at("scene").is_string() && here.at("scene").is_string()
                                 ? scene_difference(there.at("scene"), here.at("scene"))
                                 : "";
    return "the scene" + (keys.empty() ? " is another one" : ":" + keys);
  }
  // Parts that are given by trial numbers differ in these two options.
  const bool by_trials = there.contains("first_trial");
  const auto words = [&](const Json& head) {
    std::string all;
    for (const std::string word : head.at("words"))
      if (!by_trials || !(word.starts_with("--trials=") || word.starts_with("--first-trial=")))
        all += " " + word;
    return all;
  };
  if (words(there) != words(here))
    return fmt::format("there:{}; here:{}", words(there), words(here));
  if (there.at("others") != here.at("others"))
    return fmt::format("there: {}; here: {}", there.at("others").dump(), here.at("others").dump());
  for (const Json& input : here.at("inputs"))
    if (std::find(there.at("inputs").begin(), there.at("inputs").end(), input) ==
        there.at("inputs").end())
      return input.at("file").get<std::string>() + " has changed";
  return there.at("inputs").size() == here.at("inputs").size() ? "" : "other input files";
}

}  // namespace

Json head_of(const PieceFile& file) { return checked_head(file.path(), file.head()); }

Json head_in(const std::string& path) { return checked_head(path, piece_head(path)); }

Shard shard_of(const std::string& text) {
  Shard shard;
  const auto slash = text.find('/');
  const auto number = [&](std::string_view digits, std::int64_t& n) {
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), n);
    return read.ec == std::errc() && read.ptr == digits.data() + digits.size();
  };
  const std::string_view all = text;
  if (slash == text.npos || !number(all.substr(0, slash), shard.number) ||
      !number(all.substr(slash + 1), shard.of) || shard.number < 1 || shard.of < shard.number ||
      shard.of > kMostParts)
    throw UsageError(fmt::format(
        "--shard {}: must be I/N, part I of N, such as 3/8: I from 1 to N, N at most 1e6", text));
  return shard;
}

KeptRun::KeptRun(KeptPlan plan) : plan_(std::move(plan)) {
  if (!plan_.parts.empty()) {
    for (const std::string& part : plan_.parts) files_.emplace_back(part);
    check_parts();
    for (std::size_t i = 0; i < files_.size(); ++i) read(i);
    return;
  }
  if (plan_.file.empty()) return;
  if (std::filesystem::exists(plan_.file) && plan_.goes_on) {
    files_.emplace_back(plan_.file);
    read(0);
    if (plan_.writes) writer_.emplace(files_.front());
    set_kept_file(plan_.file);
  } else if (plan_.at_once || plan_.goes_on) {
    set_kept_file(plan_.file);
  }
}

void KeptRun::read(std::size_t number) {
  const PieceFile& file = files_[number];
  const std::string& path = file.path();
  const Json head = head_of(file), own = parsed_json(plan_.head);
  const bool goes_on = plan_.parts.empty();
  std::string differs = difference(head, own);
  // The text comes from a file, so control characters, which a terminal would obey, are replaced.
  std::replace_if(
      differs.begin(), differs.end(),
      [](unsigned char c) { return (c < ' ' && c != '\n') || c == 127; }, '?');
  if (!differs.empty())
    throw UsageError(
        fmt::format("{}: is of another run{}, {}{}", path,
                    goes_on || path == plan_.parts.front() ? "" : " than " + plan_.parts.front(),
                    differs, goes_on ? ". --force instead of --resume begins anew" : ""));
  const bool skips = !goes_on && head.contains("shard") && head["shard"][0] != 1;
  const auto part_of = [](const Json& h) {
    return std::array{h.value("shard", Json()), h.value("first_trial", Json()),
                      h.value("trials", Json())};
  };
  if (goes_on && part_of(head) != part_of(own))
    throw UsageError(
        fmt::format("{}: holds {}, and this is {}", path, name_of_part(head), name_of_part(own)));
  for (const PieceRecord& record : file.records()) {
    if (record.stage == kEndStage) continue;
    if (is_name(record)) {
      const std::string name = lattice::printable(file.bytes_of(record));
      const auto [known, is_new] = names_.emplace(record.stage, name);
      if (!is_new && known->second != name)
        throw UsageError(fmt::format("{}: its stage {} is {}, that of other parts {}", path,
                                     record.stage, name, known->second));
      continue;
    }
    // Every part repeats the undivided stages; they are taken from one part.
    if (skips && !plan_.divided.contains(names_[record.stage])) continue;
    auto& pieces = found_[record.stage];
    const auto after = pieces.upper_bound(record.items.first);
    const auto overlaps = [&](const Found& other) {
      return other.record.items.first < end_of(record.items) &&
             record.items.first < end_of(other.record.items);
    };
    for (const auto& other : {after == pieces.begin() ? after : std::prev(after), after})
      if (other != pieces.end() && overlaps(other->second))
        throw UsageError(fmt::format("{} and {} both have {} of {}", path,
                                     files_[other->second.file].path(),
                                     shown(other->second.record.items), names_[record.stage]));
    pieces.emplace(record.items.first, Found{number, record});
  }
}

void KeptRun::check_parts() const {
  const Json first = head_of(files_.front());
  const std::int64_t of = first.contains("shard") ? first["shard"][1].get<std::int64_t>() : 0;
  std::set<std::int64_t> missing, to_do;
  for (std::int64_t i = 1; i <= of; ++i) missing.insert(i);
  std::vector<std::string> unfinished;
  for (const PieceFile& file : files_) {
    const Json head = head_of(file);
    const std::string name = name_of_part(head);
    if (head.contains("shard") != (of > 0) || (of > 0 && head["shard"][1] != of))
      throw UsageError(fmt::format("{}: is {}, and {} is {}", file.path(), name,
                                   files_.front().path(), name_of_part(first)));
    if (of > 0 && missing.erase(head["shard"][0].get<std::int64_t>()) == 0)
      throw UsageError(fmt::format("{}: {} is given twice", file.path(), name));
    if (file.is_finished()) continue;
    if (of > 0) to_do.insert(head["shard"][0].get<std::int64_t>());
    unfinished.push_back(fmt::format("{} ({})", file.path(), name));
  }
  if (missing.empty() && unfinished.empty()) return;
  std::vector<std::string> lacks, shards;
  if (!missing.empty())
    lacks.push_back(fmt::format("missing: part {} of {}", fmt::join(missing, ", "), of));
  if (!unfinished.empty())
    lacks.push_back(fmt::format("not finished: {}", fmt::join(unfinished, ", ")));
  to_do.insert(missing.begin(), missing.end());
  for (const std::int64_t i : to_do) shards.push_back(fmt::format("{}/{}", i, of));
  throw UsageError(fmt::format(
      "{}; the parts' command with {}--resume does what is left", fmt::join(lacks, "; "),
      shards.empty() ? "" : fmt::format("--shard {} and ", fmt::join(shards, ", "))));
}

TrialRange KeptRun::own_share(const dynamics::Stage& stage) const {
  if (!divides(stage)) return stage.items;
  // Part I of N is a contiguous stretch of the items of all divided stages, taken together.
  const auto bound = [&](std::int64_t i) {
    const std::int64_t of = plan_.shard->of;  // i * stage.of / of, without overflow
    const std::int64_t at = stage.of / of * i + stage.of % of * i / of;
    return std::clamp<std::int64_t>(at - stage.before, 0, stage.items.count);
  };
  const std::int64_t from = bound(plan_.shard->number - 1), to = bound(plan_.shard->number);
  return {stage.items.first + from, to - from};
}

bool KeptRun::has_share(const dynamics::Stage& stage) const { return own_share(stage).count > 0; }

void KeptRun::begin(const dynamics::Stage& stage) {
  ++stage_;
  what_ = stage.what;
  is_named_ = true;
  own_ = own_share(stage);
  if (const auto known = names_.find(stage_); known == names_.end()) {
    is_named_ = false;
  } else if (known->second != what_) {
    throw markov::BadFile(fmt::format("{}: its stage {} is {}, and here {} comes next",
                                      files_.empty() ? plan_.file : files_.front().path(), stage_,
                                      known->second, what_));
  }
}

std::optional<dynamics::KeptPieces::Next> KeptRun::next(std::int64_t at) {
  const bool is_late = since_start_.seconds() >= plan_.most_seconds && plan_.writes;
  at = std::max(at, own_.first);
  if (at >= end_of(own_)) return {};
  const auto& pieces = found_[stage_];
  const auto there = pieces.lower_bound(at);
  if (there != pieces.end() && there->first == at) {
    const Found& found = there->second;
    const PieceFile& file = files_[found.file];
    if (end_of(found.record.items) > end_of(own_))
      throw markov::BadFile(fmt::format("{}: has {} of {}, which has none from {} on", file.path(),
                                        shown(found.record.items), what_, end_of(own_)));
    return Next{found.record.items, file.bytes_of(found.record)};
  }
  const std::int64_t end =
      there == pieces.end() ? end_of(own_) : std::min(end_of(own_), there->first);
  const TrialRange gap{at, end - at};
  if (!plan_.parts.empty())
    throw UsageError(fmt::format("missing: {} of {}, which no part has", shown(gap), what_));
  if (is_late && goes_ahead_) throw Interrupted{};
  return Next{gap, {}};
}

void KeptRun::keep(TrialRange items, std::string bytes) {
  goes_ahead_ = true;
  if (!std::exchange(is_named_, true)) write(stage_, {items.first, 0}, what_);
  write(stage_, items, bytes);
}

void KeptRun::write(std::uint32_t stage, TrialRange items, std::string_view bytes) {
  if (plan_.file.empty() || !plan_.writes) return;
  try {
    if (!writer_) {
      constexpr std::size_t kMostWaiting = std::size_t{64} << 20;
      constexpr double kMinute = 60.0;  // s
      waiting_.push_back({stage, items, std::string(bytes)});
      waiting_bytes_ += bytes.size();
      const bool is_time = since_start_.seconds() >= kMinute || waiting_bytes_ > kMostWaiting;
      if (plan_.at_once || plan_.goes_on || is_time) open();
      return;
    }
    writer_->add(stage, items, bytes);
  } catch (const std::runtime_error& e) {
    give_up(e);
  }
}

void KeptRun::open() {
  writer_.emplace(plan_.file, plan_.head);
  set_kept_file(plan_.file);
  for (const Waiting& w : waiting_) writer_->add(w.stage, w.items, w.bytes);
  writer_->sync();
  waiting_.clear();
}

void KeptRun::give_up(const std::exception& e) {
  // A file that the user asked for must work. Without the default file, the run goes on.
  if (plan_.at_once || plan_.goes_on) throw;
  plan_.warn(std::string(e.what()) + "; the run goes on, and could not be resumed");
  done();
  plan_.file.clear();
  waiting_.clear();
}

void KeptRun::end_part() {
  if (!plan_.is_part) return;
  if (!plan_.writes) throw PartDone{plan_.file};
  if (!writer_) open();
  writer_->add(kEndStage, {}, "");
  writer_->sync();
  writer_.reset();
  throw PartDone{plan_.file};
}

void KeptRun::done() {
  set_kept_file("");
  if (!writer_) return;
  const bool is_ours = writer_->is_at_its_path();
  writer_.reset();
  std::error_code error;
  if (is_ours) std::filesystem::remove(plan_.file, error);
}

std::vector<std::pair<std::string, std::string>> part_names(const std::vector<std::string>& parts) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const std::string& part : parts) names.emplace_back(part, name_of_part(head_in(part)));
  return names;
}

}  // namespace gatewalk::cli
