// SPDX-License-Identifier: MIT
#include "cli/render/field_ends.h"

#include <fmt/core.h>

#include <concepts>
#include <string_view>

#include "cli/fields/text.h"
#include "cli/render/final_gates.h"
#include "dynamics/base/share.h"

namespace gatewalk::cli {

using dynamics::share_interval;

namespace {

void put(Fields& out, const Field& field, std::int64_t n) { out.count(field, n); }
void put(Fields& out, const Field& field, double share) { out.number(field, share); }

template <class Number>
constexpr std::string_view kOf = std::integral<Number> ? "number of" : "share of";

/// Calls use(field, number, is_cut_off) for each of the keys.
template <class Number, class Use>
void each_fate(Number trapped, Number departed, Number cut_off, Use use) {
  const auto one = [&](std::string_view key, std::string_view what, Number n) {
    const std::string meaning = fmt::format("{} bodies that {}", kOf<Number>, what);
    use(Field(key, "1", meaning), n);
  };
  one("trapped", "are trapped in a gate", trapped);
  one("departed", "leave the field", departed);
  one("cut_off", "field.max_gates cuts off", cut_off);
}

}  // namespace

template <class Number>
void FieldEnds<Number>::describe_endings(Fields& out) const {
  if constexpr (std::integral<Number>)
    cli::describe_endings(out, this->endings, bodies, shares);
  else
    cli::describe_endings(out, shares);
}

template <class Number>
void FieldEnds<Number>::describe_gates(Fields& out, const GateLimits* limits) const {
  const auto map = [&](std::string_view key, std::string_view who,
                       const markov::CellNumbers<Number>& cells,
                       const GateLimits* of_cells = nullptr) {
    const std::string meaning = fmt::format("{} all bodies, by gate: {}", kOf<Number>, who);
    const Field f(key, "1", meaning);
    if constexpr (!std::integral<Number>)
      if (of_cells) return describe_map(out, f, cells, *of_cells);
    describe_map(out, f, cells);
  };
  map("final_gates", "those that end there", this->final_cells, limits);
  map("trapped_gates", "those that are trapped there", trapped_cells(*this));
  map("departed_gates", "those that leave the field from there", departed_cells(*this));
}

template <class Number>
void FieldEnds<Number>::describe_sums(Fields& out, bool with_intervals) const {
  constexpr auto kCutOff = static_cast<std::size_t>(markov::Ending::cut_off);
  each_fate(this->trapped(), departed, this->cut_off(), [&](const Field& f, Number n) {
    if constexpr (std::integral<Number>)
      if (with_intervals)
        return out.counted(f, n, bodies,
                           f.key == "cut_off"
                               ? shares.interval[kCutOff]
                               : share_interval(n, static_cast<std::int64_t>(bodies)));
    put(out, f, n);
  });
}

template <class Number>
void FieldEnds<Number>::describe_never_sampled(Fields& out) const {
  put(out,
      {"never_sampled", "1",
       fmt::format("{} bodies left out of endings because they reach a state whose row has no run",
                   kOf<Number>)},
      this->unsampled());
}

template <class Number>
void FieldEnds<Number>::describe_still_walking(Fields& out,
                                               const std::optional<Interval>& share) const {
  const std::string meaning = fmt::format(
      "{} bodies left out of endings because they still walk when the program stops", kOf<Number>);
  const Field f("still_walking", "1", meaning);
  if constexpr (std::integral<Number>)
    if (share) return out.counted(f, still_walking, bodies, share);
  put(out, f, still_walking);
}

template <class Number>
std::string FieldEnds<Number>::maps(const lattice::FieldParams& field,
                                    const std::string& unit) const {
  const int start = field.start_column();
  return fmt::format("{}{}Departed over any side: {}\n",
                     map_of(share_of(this->final_cells), start, "Final gate", unit),
                     map_of_trapped(share_of(trapped_cells(*this)), start, unit),
                     percent(static_cast<double>(departed), bodies, 2));
}

namespace {

void describe_fates(Fields& out, double trapped, double departed, double cut_off) {
  each_fate(trapped, departed, cut_off, [&](const Field& f, double share) { put(out, f, share); });
}

}  // namespace

void describe_fates(Fields& out, const lattice::FieldTally& tally) {
  const auto share = [&](std::int64_t n) {
    return static_cast<double>(n) / static_cast<double>(tally.trials);
  };
  describe_fates(out, share(tally.trapped()), share(tally.left_field()), share(tally.cut_off()));
}
void describe_fates(Fields& out, const markov::FinalDistribution& f) {
  describe_fates(out, f.trapped(), f.left_field(), f.cut_off());
}

template struct FieldEnds<std::int64_t>;
template struct FieldEnds<double>;

FieldEnds<std::int64_t> ends_of(const lattice::FieldTally& tally,
                                const lattice::FieldParams& field) {
  return {tally, static_cast<double>(tally.trials),
          lattice::EndingShares(tally.endings, tally.trials).with_limit(field.max_gates)};
}

FieldEnds<std::int64_t> ends_of(const markov::WalkTally& tally, const lattice::FieldParams& field) {
  lattice::EndingShares shares(tally.endings, tally.walks);
  // Walks under way may still end in any way; the upper limits count them.
  for (std::size_t e = 0; e < markov::kEndings; ++e)
    shares.interval[e][1] = share_interval(tally.endings[e] + tally.still_walking, tally.walks)[1];
  return {tally, static_cast<double>(tally.walks), shares.with_limit(field.max_gates),
          tally.still_walking};
}

FieldEnds<double> ends_of(const markov::FinalDistribution& f, const lattice::EndingShares& shares) {
  constexpr auto kCutOff = static_cast<std::size_t>(markov::Ending::cut_off);
  FieldEnds<double> ends{f, 1.0, shown_endings(shares, f), f.remainder};
  ends.endings[kCutOff] = shown_endings(lattice::EndingShares(f.endings), f).share[kCutOff];
  return ends;
}

}  // namespace gatewalk::cli
