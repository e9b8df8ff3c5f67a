// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <typeinfo>
#include <utility>

#include "cli/command_state.h"
#include "cli/fields/text.h"
#include "lattice/text/text_stream.h"

namespace gatewalk::cli {
namespace {

// Headings of a help page, in their order.
constexpr const char *kMostUsed = "Options that most people need", *kOthers = "Other options",
                     *kOutput = "Output", *kHowItRuns = "How it runs";

/// CommandHelp::Option::kind of an option, by the type of its value.
std::string kind_of(const po::value_semantic& value) {
  if (value.max_tokens() == 0) return "flag";
  const auto* typed = dynamic_cast<const po::typed_value_base*>(&value);
  const auto is = [&](const std::type_info& type) { return typed && typed->value_type() == type; };
  return is(typeid(Count))                                       ? "count"
         : is(typeid(Seed))                                      ? "seed"
         : is(typeid(Number)) || is(typeid(std::vector<Number>)) ? "number"
                                                                 : "text";
}

}  // namespace

void Options::most_used(std::vector<std::string> names) { state_->most_used = std::move(names); }

std::string Options::group_of(const std::string& name) const {
  static const std::set<std::string> kRun{"threads", "force",  "quiet", "help",     "checkpoint",
                                          "resume",  "strict", "shard", "max-time", "part"};
  if (std::count(state_->most_used.begin(), state_->most_used.end(), name) > 0) return kMostUsed;
  if (kRun.contains(name)) return kHowItRuns;
  return is_written(name) || name == "details" ? kOutput : kOthers;
}

bool Options::is_written(const std::string& name) const {
  return std::any_of(state_->output_files.begin(), state_->output_files.end(),
                     [&](const State::Output& o) { return o.name == name; }) ||
         name == "output" || name == "figure";
}

CommandHelp Options::help() const {
  CommandHelp help{state_->synopsis, state_->about, state_->example, {}, {}};
  for (const auto& [name, text] : state_->positional_help)
    help.arguments.emplace_back(upper_case(name), text);
  for (const auto* all : {&state_->own, &state_->shared})
    for (const auto& option : all->options()) {
      const std::string& name = option->long_name();
      const bool is_flag = option->semantic()->max_tokens() == 0;
      std::string value = is_flag ? "" : option->format_parameter();
      if (!is_flag && value.find("(=") != value.npos) value = value.substr(0, value.find(" (="));
      const std::string letters =
          option->canonical_display_name(po::command_line_style::allow_dash_for_short);
      const bool is_file =
          is_written(name) ||
          std::any_of(state_->reads.begin(), state_->reads.end(),
                      [&](const auto& r) { return r.first == name && name != "set"; });
      help.options.push_back(
          {name, value, option->description(), letters.size() == 2 ? letters[1] : char{0}, is_file,
           kind_of(*option->semantic()), option->semantic()->is_composing(), group_of(name)});
    }
  const auto place = [&](const CommandHelp::Option& o) {
    const auto& first = state_->most_used;
    const auto at = std::find(first.begin(), first.end(), o.name) - first.begin();
    const std::string groups[] = {kMostUsed, kOthers, kOutput, kHowItRuns};
    return std::pair(std::find(groups, std::end(groups), o.group) - groups, at);
  };
  std::stable_sort(help.options.begin(), help.options.end(),
                   [&](const auto& a, const auto& b) { return place(a) < place(b); });
  return help;
}

std::string Options::help_page() const {
  constexpr unsigned kColumns = 100;
  const CommandHelp page = help();
  lattice::TextStream text;
  text << "gatewalk " << page.synopsis << "\n\n" << page.about << "\n\n";
  for (const auto& [name, what] : page.arguments)
    text << wrapped(fmt::format("  {:<22}  {}", name, what), std::string(26, ' '));
  text << "\nExample:\n  " << page.example << "\n";
  for (auto at = page.options.begin(); at != page.options.end();) {
    po::options_description group(at->group, kColumns);
    for (const std::string& heading = at->group; at != page.options.end() && at->group == heading;
         ++at)
      for (const auto* all : {&state_->own, &state_->shared})
        for (const auto& option : all->options())
          if (option->long_name() == at->name) group.add(option);
    text << "\n" << group;
  }
  return text.str();
}

}  // namespace gatewalk::cli
