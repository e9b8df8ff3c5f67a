// SPDX-License-Identifier: MIT
#include "cli/render/field_ends.h"

#include <fmt/core.h>

#include <concepts>
#include <string_view>

#include "cli/render/final_gates.h"
#include "cli/render/text.h"
#include "dynamics/base/share.h"

namespace gatewalk::cli {

using dynamics::share_interval;
using markov::CellCounts;
using markov::CellProbabilities;

namespace {

void put(Fields& out, const Field& field, std::int64_t n) { out.count(field, n); }
void put(Fields& out, const Field& field, double share) { out.number(field, share); }

template <class Number>
constexpr std::string_view kOf = std::integral<Number> ? "number of" : "share of";

}  // namespace

template <class Cells>
void FieldEnds<Cells>::describe_endings(Fields& out) const {
  if constexpr (std::integral<Number>)
    cli::describe_endings(out, endings, bodies, shares);
  else
    cli::describe_endings(out, shares);
}

template <class Cells>
void FieldEnds<Cells>::describe_gates(Fields& out, const GateLimits* limits) const {
  const auto map = [&](std::string_view key, std::string_view who, const Cells& cells,
                       const GateLimits* of_cells = nullptr) {
    const std::string meaning = fmt::format("{} all bodies, by gate: {}", kOf<Number>, who);
    const Field f(key, "1", meaning);
    if constexpr (!std::integral<Number>)
      if (of_cells) return describe_map(out, f, cells, *of_cells);
    describe_map(out, f, cells);
  };
  map("final_gates", "those that end there", final_gates, limits);
  map("trapped_gates", "those that are trapped there", trapped_gates);
  map("departed_gates", "those that leave the field from there", departed_gates);
}

template <class Cells>
void FieldEnds<Cells>::describe_sums(Fields& out, bool with_intervals) const {
  const auto sum = [&](std::string_view key, std::string_view what, Number n,
                       std::optional<Interval> interval = {}) {
    const std::string meaning = fmt::format("{} bodies that {}", kOf<Number>, what);
    if constexpr (std::integral<Number>)
      if (with_intervals)
        return out.counted(
            {key, "1", meaning}, n, bodies,
            interval ? interval : share_interval(n, static_cast<std::int64_t>(bodies)));
    put(out, {key, "1", meaning}, n);
  };
  sum("trapped", "are trapped in a gate", trapped);
  sum("departed", "leave the field", departed);
  sum("cut_off", "field.max_gates cuts off", cut_off,
      shares.interval[static_cast<std::size_t>(markov::Ending::cut_off)]);
}

template <class Cells>
void FieldEnds<Cells>::describe_never_sampled(Fields& out) const {
  put(out,
      {"never_sampled", "1",
       fmt::format("{} bodies left out of endings because they reach a state whose row has no run",
                   kOf<Number>)},
      never_sampled);
}

template <class Cells>
void FieldEnds<Cells>::describe_still_walking(Fields& out,
                                              const std::optional<Interval>& share) const {
  const std::string meaning = fmt::format(
      "{} bodies left out of endings because they still walk when the program stops", kOf<Number>);
  const Field f("still_walking", "1", meaning);
  if constexpr (std::integral<Number>)
    if (share) return out.counted(f, still_walking, bodies, share);
  put(out, f, still_walking);
}

template <class Cells>
std::string FieldEnds<Cells>::table(const std::string& of, const std::string& about) const {
  return fmt::format("{}{}{}{}departed {}\n", endings_text(shares, of), about,
                     map_of(share_of(final_gates)), map_of_trapped(share_of(trapped_gates)),
                     percent(static_cast<double>(departed), bodies, 2));
}

namespace {

void describe_shares(Fields& out, double trapped, double departed, double cut_off) {
  FieldEnds<CellProbabilities>{
      .shares = lattice::EndingShares(std::array<double, markov::kEndings>{}),
      .trapped = trapped,
      .departed = departed,
      .cut_off = cut_off}
      .describe_sums(out);
}

}  // namespace

void describe_fates(Fields& out, const lattice::FieldTally& tally) {
  const auto share = [&](std::int64_t n) {
    return static_cast<double>(n) / static_cast<double>(tally.trials);
  };
  describe_shares(out, share(tally.trapped), share(tally.left_field), share(tally.cut_off));
}
void describe_fates(Fields& out, const markov::FinalDistribution& f) {
  describe_shares(out, f.trapped, f.left_field, f.cut_off);
}

template struct FieldEnds<CellCounts>;
template struct FieldEnds<CellProbabilities>;

FieldEnds<CellCounts> ends_of(const lattice::FieldTally& tally, const lattice::FieldParams& field) {
  return {.bodies = static_cast<double>(tally.trials),
          .endings = tally.endings,
          .shares = lattice::EndingShares(tally.endings, tally.trials).with_limit(field.max_gates),
          .final_gates = tally.final_gates,
          .trapped_gates = tally.trapped_gates,
          .departed_gates = tally.departed_gates,
          .trapped = tally.trapped,
          .departed = tally.left_field,
          .cut_off = tally.cut_off};
}

FieldEnds<CellCounts> ends_of(const markov::WalkTally& tally, const lattice::FieldParams& field) {
  lattice::EndingShares shares(tally.endings, tally.walks);
  // Those who still walk may end in any way: the upper limits count them.
  for (std::size_t e = 0; e < markov::kEndings; ++e)
    shares.interval[e][1] = share_interval(tally.endings[e] + tally.still_walking, tally.walks)[1];
  return {.bodies = static_cast<double>(tally.walks),
          .endings = tally.endings,
          .shares = shares.with_limit(field.max_gates),
          .final_gates = tally.final_cells,
          .trapped_gates = tally.trapped_cells,
          .departed_gates = tally.departed_cells,
          .trapped = tally.trapped,
          .departed = tally.left_field,
          .cut_off = tally.cut_off,
          .never_sampled = tally.unsampled,
          .still_walking = tally.still_walking};
}

FieldEnds<CellProbabilities> ends_of(const markov::FinalDistribution& f,
                                     const lattice::EndingShares& shares) {
  const lattice::EndingShares shown = shown_endings(shares, f);
  return {.endings = shown.share,
          .shares = shown,
          .final_gates = f.final_cells,
          .trapped_gates = markov::trapped_cells(f),
          .departed_gates = markov::departed_cells(f),
          .trapped = f.trapped,
          .departed = f.left_field,
          .cut_off = shown_endings(lattice::EndingShares(f.endings), f)
                         .share[static_cast<std::size_t>(markov::Ending::cut_off)],
          .never_sampled = f.unsampled,
          .still_walking = f.remainder};
}

}  // namespace gatewalk::cli
