// SPDX-License-Identifier: MIT
#include "cli/exchange/explicit_chain.h"

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <initializer_list>
#include <utility>

#include "cli/exchange/archive.h"
#include "cli/fields/csv.h"
#include "cli/fields/json.h"
#include "cli/render/files.h"
#include "cli/render/little_endian.h"
#include "cli/render/version.h"

namespace gatewalk::cli {

using markov::ExplicitChain;

namespace {

/// A probability in the fewest digits that restore it. A sum that rounding puts above 1 becomes 1.
std::string probability(double p) {
  std::array<char, 32> digits;
  return {digits.data(),
          std::to_chars(digits.data(), digits.data() + digits.size(), p < 1.0 ? p : 1.0).ptr};
}

/// A bit per state, in 64-bit words; only the bit of state `only` is set.
std::string one_bit(std::int64_t states, std::int64_t only) {
  std::string bits(static_cast<std::size_t>((states + 63) / 64 * 8), '\0');
  bits[static_cast<std::size_t>(only / 8)] = static_cast<char>(1 << (only % 8));
  return bits;
}

/// The type and size of the numbers in a file of the archive.
void describe_numbers(Fields& out, std::string_view type, int bits) {
  out.text({"type", "kind of the numbers"}, type);
  out.count({"size", "bit", "size of a number"}, bits);
}

/// The index of a Unified Markov Binary, which says what the other files of the archive hold.
void describe(Fields& out, const ExplicitChain& chain, const std::string& command) {
  out.count({"format-version", "1", "version of the format"}, 1);
  out.count({"format-revision", "1", "revision of this version"}, 0);
  out.object({"model-data", "what the model is"}, [](Fields& f) {
    f.text({"description", "the model in words"}, "a gatewalk field, as a Markov chain");
  });
  out.object({"file-data", "what made the file"}, [&](Fields& f) {
    f.text({"tool", "name of the program"}, "gatewalk");
    f.text({"tool-version", "version of the program"}, kVersion);
    f.text({"parameters", "the command"}, command);
  });
  out.object({"transition-system", "kind and size of the model"}, [&](Fields& f) {
    f.text({"time", "how time passes"}, "discrete");
    const std::int64_t states = chain.size(), branches = std::ssize(chain.target);
    for (const auto& [what, n] :
         std::initializer_list<std::pair<const char*, std::int64_t>>{{"#players", 0},
                                                                     {"#states", states},
                                                                     {"#initial-states", 1},
                                                                     {"#choices", states},
                                                                     {"#choice-actions", 0},
                                                                     {"#branches", branches},
                                                                     {"#branch-actions", 0},
                                                                     {"#observations", 0}})
      f.count({what, "1", "how many there are"}, n);
    f.object({"branch-probability-type", "how probabilities stand in their file"},
             [](Fields& type) { describe_numbers(type, "double", 64); });
  });
  out.object({"annotations", "what is said of states"}, [](Fields& f) {
    f.object({"aps", "atomic propositions: the endings"}, [](Fields& aps) {
      for (const char* label : kEndingLabels)
        aps.object({label, "states in which walks end so"}, [&](Fields& ending) {
          ending.text({"alias", "name of the ending"}, label);
          ending.texts({"applies-to", "what has this proposition"}, {"states"});
          ending.object({"type", "how its values stand in their file"},
                        [](Fields& type) { describe_numbers(type, "bool", 1); });
        });
    });
  });
}

}  // namespace

std::string umb_of(const ExplicitChain& chain, const std::string& command) {
  const std::int64_t n = chain.size();
  std::vector<PackedFile> files{
      {"index.json", json_text([&](Fields& out) { describe(out, chain, command); }) + "\n"},
      {"state-is-initial.bin", one_bit(n, 0)},
      {"choice-to-branches.bin", all_little_endian(chain.first)},
      {"branch-to-target.bin", all_little_endian(chain.target)},
      {"branch-to-probability.bin", all_little_endian(chain.probability)}};
  for (std::size_t e = 0; e < kEndingLabels.size(); ++e)
    files.push_back({fmt::format("annotations/aps/{}/states/values.bin", kEndingLabels[e]),
                     one_bit(n, chain.ends() + static_cast<std::int64_t>(e))});
  return pack(Packing::tar, files);
}

std::string drn_of(const ExplicitChain& chain) {
  std::string text = fmt::format(
      "@type: DTMC\n@parameters\n\n@reward_models\n\n"
      "@nr_states\n{0}\n@nr_choices\n{0}\n@model\n",
      chain.size());
  for (std::int64_t s = 0; s < chain.size(); ++s) {
    text += fmt::format("state {}", s);
    if (s == 0) text += " init";
    if (s >= chain.ends())
      text += fmt::format(" {}", kEndingLabels[static_cast<std::size_t>(s - chain.ends())]);
    text += "\n\taction 0\n";
    for (auto k = static_cast<std::size_t>(chain.first[static_cast<std::size_t>(s)]);
         k < static_cast<std::size_t>(chain.first[static_cast<std::size_t>(s) + 1]); ++k)
      text += fmt::format("\t\t{} : {}\n", chain.target[k], probability(chain.probability[k]));
  }
  return text;
}

PrismFiles prism_of(const ExplicitChain& chain, const std::vector<int>& numbers) {
  PrismFiles files;
  files.transitions = fmt::format("{} {}\n", chain.size(), chain.target.size());
  files.states = "(i_x,i_y,state,draws,ending)\n";
  files.labels = "0=\"init\" 1=\"deadlock\"";
  for (std::size_t e = 0; e < kEndingLabels.size(); ++e)
    files.labels += fmt::format(" {}=\"{}\"", e + 2, kEndingLabels[e]);
  files.labels += "\n0: 0\n";
  for (std::int64_t s = 0; s < chain.size(); ++s) {
    const bool is_end = s >= chain.ends();
    if (is_end) {
      const std::int64_t e = s - chain.ends();
      files.states += fmt::format("{}:(-1,-1,-1,-1,{})\n", s, e);
      files.labels += fmt::format("{}: {}\n", s, e + 2);
    } else {
      const ExplicitChain::State& state = chain.states[static_cast<std::size_t>(s)];
      files.states += fmt::format("{}:({},{},{},{},-1)\n", s, state.column, state.row,
                                  numbers[static_cast<std::size_t>(state.input)], state.draws);
    }
    for (auto k = static_cast<std::size_t>(chain.first[static_cast<std::size_t>(s)]);
         k < static_cast<std::size_t>(chain.first[static_cast<std::size_t>(s) + 1]); ++k)
      files.transitions +=
          fmt::format("{} {} {}\n", s, chain.target[k], probability(chain.probability[k]));
  }
  return files;
}

SparseTable table_of(const ExplicitChain& chain) {
  SparseTable table{chain.size(), chain.size(), {}, false};
  for (std::int64_t s = 0; s < chain.size(); ++s)
    for (auto k = static_cast<std::size_t>(chain.first[static_cast<std::size_t>(s)]);
         k < static_cast<std::size_t>(chain.first[static_cast<std::size_t>(s) + 1]); ++k)
      table.entries.push_back({s, chain.target[k], chain.probability[k]});
  return table;
}

namespace {

/// The name of the state in which a cell is entered. A start that the matrix lacks has its own row
/// after all states, and is named "start".
std::string entered_as(const ExplicitChain::State& state, const std::vector<std::string>& names) {
  const auto input = static_cast<std::size_t>(state.input);
  return input + 1 < names.size() ? names[input] : "start";
}

}  // namespace

std::vector<std::string> names_of(const ExplicitChain& chain,
                                  const std::vector<std::string>& names) {
  std::vector<std::string> all;
  for (const ExplicitChain::State& s : chain.states)
    all.push_back(fmt::format("x{}_y{}_{}_n{}", s.column, s.row, entered_as(s, names), s.draws));
  all.insert(all.end(), kEndingLabels.begin(), kEndingLabels.end());
  return all;
}

std::string states_csv(const ExplicitChain& chain, const std::vector<std::string>& names) {
  const std::vector<std::string> all = names_of(chain, names);
  std::string text = "number,name,column,row,state,entered_before,ending\n";
  for (std::size_t s = 0; s < all.size(); ++s) {
    text += fmt::format("{},{},", s, csv_text(all[s]));
    if (s < chain.states.size()) {
      const ExplicitChain::State& state = chain.states[s];
      text += fmt::format("{},{},{},{},\n", state.column, state.row,
                          csv_text(entered_as(state, names)), state.draws);
    } else {
      text += fmt::format(",,,,{}\n", all[s]);
    }
  }
  return text;
}

}  // namespace gatewalk::cli
