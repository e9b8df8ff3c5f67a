// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/paper/claims.h"
#include "cli/paper/studies.h"
#include "lattice/field/field_trials.h"
#include "lattice/gates/disc_field.h"

namespace gatewalk::cli {
namespace {

/// The corrcoef and RMSE found here for a start of Table IV, and how many standard deviations away
/// the paper's values are.
struct Reading {
  Repeats ours;
  double corrcoef_off, rmse_off;

  Reading(const Repeats& repeats, const ValidatedStart& start)
      : ours(repeats),
        corrcoef_off(std::abs(start.paper_corrcoef - ours.corrcoef.mean) / ours.corrcoef.sd),
        rmse_off(std::abs(start.paper_rmse - ours.rmse.mean) / ours.rmse.sd) {}
  [[nodiscard]] bool fits() const { return corrcoef_off <= 2 && rmse_off <= 2; }
  [[nodiscard]] std::string text() const {
    return fmt::format("{} ({}) / {} ({})", fixed(ours.corrcoef.mean, 3),
                       fixed(ours.corrcoef.sd, 3), fixed(ours.rmse.mean, 2),
                       fixed(ours.rmse.sd, 2));
  }
};

/// Whether a start lies on an edge of its bin, so that chance decides to which of two bins it
/// belongs.
bool on_an_edge(const ValidatedStart& start) {
  using namespace dynamics;
  const Bins bins = table3_space({}).bins()[Boundary::enter];
  const auto among = [&](double x, std::size_t axis) {
    return std::count(bins.edges[axis].begin(), bins.edges[axis].end(), x) > 0;
  };
  return among(start.d, kEntryD) || among(start.vx, kEntryVx) || among(start.vy, kEntryVy);
}

template <std::size_t kStart>
Measured table4_row(const Findings& f) {
  const ValidatedStart& start = f.field.starts.at(kStart);
  const Reading exact(start.exact, start), walks(start.walks, start);
  const bool enough = start.repeats >= 50,  // enough to tell two standard deviations
      neither = !exact.fits() && !walks.fits();
  return {verdict_of(enough && neither, enough && exact.fits() && walks.fits(), enough),
          {{"start", start.label()},
           {"paper_corrcoef", start.paper_corrcoef},
           {"paper_rmse", start.paper_rmse},
           {"exact", exact.text()},
           {"exact_corrcoef", start.exact.corrcoef_floor},
           {"exact_rmse", start.exact.rmse_floor},
           {"walks", walks.text()},
           {"walks_corrcoef", start.walks.corrcoef_floor},
           {"walks_rmse", start.walks.rmse_floor},
           {"first", when(exact.fits() && !walks.fits(), "the first")},
           {"second", when(walks.fits() && !exact.fits(), "the second")},
           {"corrcoef_off", when(neither, exact.corrcoef_off)},
           {"rmse_off", exact.rmse_off},
           {"edge", when(on_an_edge(start), "an edge")}}};
}

Measured accuracy(const Findings& f) {
  double least = 1e9, most = 0;
  int within = 0, visible = 0;
  for (const ValidatedStart& s : f.field.starts) {
    least = std::min(least, s.rmse);
    most = std::max(most, s.rmse);
    within += s.finding != lattice::Finding::own_error;
    // The chain's error is visible in 100 trials.
    visible += s.exact.rmse.mean - s.exact.rmse_floor > 2 * s.exact.rmse.sd;
  }
  const std::int64_t starts = std::ssize(f.field.starts);
  return {verdict_of(within != starts && visible > 0, within == starts),
          {{"least", least},
           {"most", most},
           {"trials", f.field.trials},
           {"within", of(within, starts)},
           {"visible", visible},
           {"markov", f.field.markov}}};
}

Measured speed_up(const Findings& f) {
  const double dynamics = f.field.seconds_per_trial(), walk = f.field.seconds_per_walk(),
               euler = f.field_paper_method.seconds_per_trial(), ratio = dynamics / walk;
  return {holds_or_differs(ratio >= 36000),
          {{"ratio", ratio},
           {"dynamics_ms", 1e3 * 100 * dynamics},
           {"euler_ms", 1e3 * 100 * euler},
           {"walks_us", 1e6 * 100 * walk},
           {"dynamics_powers", std::log10(360000.0 / (100 * dynamics))},
           {"walks_powers", std::log10(10.0 / (100 * walk))}}};
}

/// Tests that a share of crossings lies below the paper's limit, and adds the shares at other
/// random forces.
Measured below(double limit, const Findings& f, Share (Crossings::*share)() const) {
  const Share ours = (f.field.crossings.*share)();
  std::string others;
  for (const auto& [random, study] : f.field_random)
    others += (others.empty() ? "" : ", ") + fixed(100 * (study.crossings.*share)().value, 1);
  return {verdict_of(ours.low >= limit, ours.high < limit), {{"ours", ours}, {"others", others}}};
}

Measured side_entries_free(const Findings& /*f*/) {
  const dynamics::GateParams p = gate_of("scenes/field.toml");
  constexpr std::int64_t kBodies = 200;
  std::int64_t entries = 0, touching = 0;
  for (std::int64_t trial = 0; trial < kBodies; ++trial) {
    const auto trace = lattice::trace_field(p, {}, {0, 0, 0, 15}, 1, trial);
    for (std::size_t i = 1; i < trace.visits.size(); ++i) {
      const auto& to = trace.visits[i];
      const auto& samples = to.trace.samples;
      if (to.row != trace.visits[i - 1].row || samples.front().state.body.y <= p.beams.joint_y)
        continue;
      ++entries;
      touching += std::any_of(samples.begin(), samples.end(), [](const dynamics::TraceSample& s) {
        return s.contact[0] != dynamics::ContactMode::free ||
               s.contact[1] != dynamics::ContactMode::free;
      });
    }
  }
  const Share share = share_by_bodies(touching, entries, kBodies);
  return {verdict_of(share.low > 0.05, share.high < 0.05),
          {{"ours", share}, {"visits", of(touching, entries)}}};
}

Measured drag(const Findings& f) {
  const Share with = f.field.crossings.clamped_share(),
              without = f.field_no_drag.crossings.clamped_share();
  const bool enough = std::min(with.whole, without.whole) >= kEnoughTrials;
  return {verdict_of(falls(with, without) || (enough && !rises(with, without)),
                     enough && rises(with, without)),
          {{"with", with}, {"without", without}}};
}

Measured states(const Findings& /*f*/) {
  const auto space = dynamics::table3_space({});
  return {holds_or_differs(space.size() == 87),
          {{"inputs", space.size()}, {"outputs", space.trapped() + 1}}};
}

Measured thirteen_steps(const Findings& f) {
  double most = 0;
  for (const ValidatedStart& s : f.field.starts) most = std::max(most, s.cut_off);
  const lattice::FieldParams field;
  const int needed = field.rows + field.columns / 2;
  return {holds_or_differs(needed == field.max_gates),
          {{"gates", needed}, {"cut_off", 100 * most}}};
}

ClaimRow table4_claim(const char* id, Measured (*measure)(const Findings&)) {
  return {{id, "Sec. III-C, Table IV", kTable4},
          "Chain and dynamics, {start}.",
          {"{paper_corrcoef:3} / {paper_rmse:3}", "{exact}", measure},
          {"Mean (sd) of 100 trials against the exact chain; by chance alone a perfect chain gives "
           "{exact_corrcoef:3} / {exact_rmse:2}. Against 100 walks, as the paper's text says: "
           "{walks}, chance {walks_corrcoef:3} / {walks_rmse:2}.",
           "The printed pair fits only {first}: it is better than two samples of 100 can be.",
           "The printed pair fits only {second}.",
           "The printed pair is {corrcoef_off:1} and {rmse_off:1} standard deviations from the "
           "first.",
           "This start lies on {edge} of its bin."}};
}

}  // namespace

std::vector<ClaimRow> claims_on_the_field() {
  return {
      {{"accuracy", "Abstract, Sec. III-C", "fig11"},
       "The chain predicts the final gates with high accuracy; the error is around 1 of 100 "
       "trials.",
       {"RMSE about 1", "RMSE {least:2} to {most:2}", accuracy},
       {"All {trials} trials a start, trials per 100. At {within} starts the difference is no more "
        "than chance in trials and matrix makes; at {visible} it would show in 100 trials. With "
        "100 trials a perfect chain would have an RMSE of about 1 as well. Is it Markov: "
        "{markov}"}},
      table4_claim("table4_1", table4_row<0>),
      table4_claim("table4_2", table4_row<1>),
      table4_claim("table4_3", table4_row<2>),
      table4_claim("table4_4", table4_row<3>),
      {{"speed", "Abstract, Sec. III-C", "speed"},
       "The chain saves computing time by a factor of 10^5: 10 s instead of 100 h for 100 trials.",
       {"10^5", "{ratio}", speed_up},
       {"A trial against a walk. The paper's own times make 36 000. Here 100 trials take "
        "{dynamics_ms:1} ms ({euler_ms:1} ms by the paper's Euler scheme) instead of 100 h, 100 "
        "walks {walks_us:1} us instead of 10 s: the dynamics has become {dynamics_powers:1} powers "
        "of ten faster, the walks {walks_powers:1}."}},
      {{"side_entries", "Sec. III-C", "crossings"},
       "Fewer than 4 % of the inputs come through RT or LT.",
       {"< 4 %", "{ours}",
        [](const Findings& f) { return below(0.04, f, &Crossings::rt_and_lt_share); }},
       {"At 7 N, Rm 50 N; {others} % at Rm 10, 20, 40 N. The paper does not print the field's "
        "forces; no pair for which Table IV fits gives so few (results/field_scan)."}},
      {{"side_entries_free", "Sec. III-C", "crossings"},
       "Bodies that come through RT or LT are not involved with the beams of that gate.",
       {"none", "{ours} touch a beam", side_entries_free},
       {"{visits} such visits in 200 trials of scenes/field.toml (gatewalk trace --field). One "
        "state each for RT and LT is enough."}},
      {{"velocities", "Sec. III-C, Table III", "crossings"},
       "With damping and drag the velocity stays in the range of Table III.",
       {"in the tested range", "{ours} of the crossings outside",
        [](const Findings& f) { return below(0.05, f, &Crossings::clamped_share); }},
       {"Outside Table III's bins, by velocity or place, at 7 N, Rm 50 N; {others} % at Rm 10, 20, "
        "40 N. They are put into the nearest bin, and counted; one in twenty would pass here."}},
      {{"drag", "Sec. III-C", "crossings"},
       "Without drag and with less damping the velocity leaves the range that the chain covers.",
       {"leaves it", "{without} outside; with them {with}", drag},
       {"D = 0 and d = 10 against D = 0.06 and d = 50; 7 N, Rm 50 N."}},
      {{"states", "Sec. III-C, Table III", "crossings"},
       "87 input and 88 output states.",
       {"87 x 88", "{inputs} x {outputs}", states},
       {"EN 25, RD 30, LD 30, RT 1, LT 1; and trapped."}},
      {{"thirteen_steps", "Sec. III-C", "fig11"},
       "At most 13 steps, to reach the furthest gate.",
       {"13", "{gates} gates to the furthest corner", thirteen_steps},
       {"The first one included. Up to {cut_off:1} % of the trials are still on their way after "
        "13, because they also go sideways; field.max_gates = 0 lifts the limit."}}};
}

}  // namespace gatewalk::cli
