// SPDX-License-Identifier: MIT
#include "cli/render/validation.h"

#include <algorithm>
#include <array>

#include "cli/render/exits.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/memory.h"
#include "cli/render/start.h"
#include "cli/render/text.h"
#include "lattice/text/text_stream.h"

namespace gatewalk::cli {

std::string verdict(const lattice::StartValidation& r) {
  const lattice::Judgement& j = r.judgement;
  const std::string p = j.p < 0.001 ? "p < 0.001" : "p = " + fixed(j.p, 3);
  if (r.finding() != lattice::Finding::own_error)
    return "the chain agrees with the dynamics as far as these trials and this matrix can tell (" +
           p + ")";
  std::string text =
      "the chain differs from the dynamics by more than chance in trials and matrix makes (" + p +
      "):";
  const char* separator = " ";
  const auto say = [&](const std::string& what) {
    text += separator + what;
    separator = "; ";
  };
  for (const EndingName& e : kEndingNames) {
    if (!j.differs(e.ending)) continue;
    const auto at = static_cast<std::size_t>(e.ending);
    say(std::string(e.name) + " " +
        with_interval(r.dynamics_endings.share[at], r.dynamics_endings.interval[at]) +
        " % in the dynamics, " +
        with_interval(r.exact_endings.share[at], r.exact_endings.interval[at]) + " % by the chain");
  }
  if (j.differs(markov::Ending::unsampled))
    say("states never sampled, " + percent(r.exact.unsampled, 1.0, 2) + " by the chain");
  const auto gates = {j.total_variation.p_adjusted, j.energy.p_adjusted, j.chi_squared.p_adjusted};
  if (std::any_of(gates.begin(), gates.end(),
                  [](double x) { return x <= lattice::Judgement::kLevel; }))
    say("final gates, total variation " + fixed(j.total_variation.seen, 3) +
        " (chance: " + fixed(j.chance_total_variation, 3) + ")");
  return text;
}

namespace {

Json to_json(const lattice::MeanAndSd& m) { return {{"mean", m.mean()}, {"sd", m.sd()}}; }

Json to_json(const lattice::StartValidation& r, const lattice::PaperStart* paper,
             const ShownField& shown) {
  Json j;
  j["verdict"] = cli::verdict(r);
  j["trials_and_matrix"] = cli::to_json(r.judgement);
  j["trials_and_matrix"]["resampled_matrices"] = r.resampled;
  j["start"] = cli::to_json(shown.map.section, r.start);
  j["start"]["clamped"] = r.chain_start.clamped;
  if (paper && paper->corrcoef)
    j["paper"] = {{"corrcoef", *paper->corrcoef}, {"rmse_per_100", *paper->rmse}};
  j["exact"] = cli::to_json(r.exact_against);
  j["exact"]["total_variation_of_matrix_sampling"] = {{"mean", r.matrix_noise_mean},
                                                      {"sd", r.matrix_noise_sd}};
  j["walks"] = cli::to_json(r.walks_against);
  const lattice::PaperSized& p = r.paper_sized;
  j["at_100_trials"] = {{"repeats", p.exact_rmse.n},
                        {"exact_corrcoef", to_json(p.exact_corrcoef)},
                        {"exact_corrcoef_floor", r.floor_100_exact.corrcoef},
                        {"exact_rmse_per_100", to_json(p.exact_rmse)},
                        {"exact_rmse_per_100_floor", r.floor_100_exact.rmse_per_100},
                        {"exact_corrcoef_rmse_correlation", p.exact_correlation()},
                        {"walks_corrcoef", to_json(p.walks_corrcoef)},
                        {"walks_corrcoef_floor", r.floor_100_walks.corrcoef},
                        {"walks_rmse_per_100", to_json(p.walks_rmse)},
                        {"walks_rmse_per_100_floor", r.floor_100_walks.rmse_per_100}};
  j["seconds"] = {
      {"dynamics", r.dynamics_seconds}, {"walks", r.walks_seconds}, {"exact", r.exact_seconds}};
  const double per_trial = r.dynamics_seconds / static_cast<double>(r.dynamics.trials);
  const double per_walk = r.walks_seconds / static_cast<double>(r.walks.walks);
  j["speed_ratio"] = {{"dynamics_trial_over_walk", per_trial / per_walk},
                      {"dynamics_over_exact", r.dynamics_seconds / r.exact_seconds}};
  j["endings"] = {{"dynamics", endings(r.dynamics.endings)},
                  {"walks", endings(r.walks.endings)},
                  {"exact", endings(r.exact.endings)}};
  j["endings_95"] = {{"dynamics", endings_95(r.dynamics_endings)},
                     {"walks", endings_95(r.walks_endings)},
                     {"exact", endings_95(r.exact_endings)}};
  const auto fates = [](double trapped, double left, double cut) {
    return Json{{"trapped", trapped}, {"departed", left}, {"cut_off", cut}};
  };
  const auto n = static_cast<double>(r.dynamics.trials);
  j["fates"] = {{"dynamics", fates(static_cast<double>(r.dynamics.trapped) / n,
                                   static_cast<double>(r.dynamics.left_field) / n,
                                   static_cast<double>(r.dynamics.cut_off) / n)},
                {"exact", fates(r.exact.trapped, r.exact.left_field, r.exact.cut_off)}};
  j["final_gates"] = {{"dynamics", grid(r.dynamics.final_gates)},
                      {"walks", grid(r.walks.final_cells)},
                      {"exact", grid(r.exact.final_cells)}};
  j["trapped_gates"] = {{"dynamics", grid(r.dynamics.trapped_gates)},
                        {"walks", grid(r.walks.trapped_cells)},
                        {"exact", grid(markov::trapped_cells(r.exact))}};
  j["departed_gates"] = {{"dynamics", grid(r.dynamics.departed_gates)},
                         {"walks", grid(r.walks.departed_cells)},
                         {"exact", grid(markov::departed_cells(r.exact))}};
  j["exits"] = cli::to_json(r.dynamics_exits, r.exact_exits, shown);
  j["never_sampled"] = r.exact.unsampled;
  j["still_walking"] = r.exact.remainder;
  if (r.force) j["force_memory"] = cli::to_json(*r.force);
  return j;
}

std::string with_sd(const lattice::MeanAndSd& m) {
  return fixed(m.mean(), 3) + " (" + fixed(m.sd(), 3) + ")";
}

/// How trials ended, by the dynamics and by the chain, and the verdicts.
std::string endings_table(const lattice::Validation& v, const StartTexts& labels) {
  lattice::TextStream out;
  // Each column as wide as its widest cell: "17.61 [16.87, 18.37]*".
  std::vector<EndingName> names(kEndingNames.begin(), kEndingNames.end());
  for (const lattice::StartValidation& r : v.starts)
    if (names.size() == kEndingNames.size() &&
        !(r.dynamics_endings.rules_out(lattice::kWentBack.ending) &&
          r.exact_endings.rules_out(lattice::kWentBack.ending)))
      names.push_back(lattice::kWentBack);
  std::vector<std::size_t> width(names.size());
  const auto cell = [](const lattice::StartValidation& r, const lattice::EndingShares& shares,
                       const EndingName& e) {
    const auto at = static_cast<std::size_t>(e.ending);
    const bool marked = &shares == &r.exact_endings && r.judgement.differs(e.ending);
    return with_interval(shares.share[at], shares.interval[at]) + (marked ? "*" : " ");
  };
  for (const lattice::StartValidation& r : v.starts)
    for (std::size_t e = 0; e < width.size(); ++e)
      width[e] = std::max({width[e], cell(r, r.dynamics_endings, names[e]).size(),
                           cell(r, r.exact_endings, names[e]).size()});
  const auto line = [&](const auto& text_of) {
    std::string text;
    for (std::size_t e = 0; e < width.size(); ++e)
      text += "  " + padded(text_of(names[e]), static_cast<int>(width[e]));
    return text;
  };
  out << "Endings, % of " << v.trials
      << " trials of the full dynamics and by the exact chain, with 95 % intervals: chance in the\n"
         "trials, in the sampling of the matrix. p: how often chance in both together would make "
         "any ending\n"
         "or the final gates look as different; *: this ending differs.\n\n"
      << labels.header << "  |         ";
  out << line([](const EndingName& e) { return std::string(e.name) + " "; }) << "       p\n";
  for (std::size_t k = 0; k < v.starts.size(); ++k) {
    const lattice::StartValidation& r = v.starts[k];
    out << labels.texts[k] << "  | dynamics"
        << line([&](const EndingName& e) { return cell(r, r.dynamics_endings, e); }) << "\n"
        << labels.texts[k] << "  | chain   "
        << line([&](const EndingName& e) { return cell(r, r.exact_endings, e); })
        << padded(p_text(r.judgement.p), 8) << "\n";
  }
  out << "\n";
  for (std::size_t k = 0; k < v.starts.size(); ++k)
    out << labels.texts[k] << "  | " << cli::verdict(v.starts[k]) << "\n";
  for (std::size_t k = 0; k < v.starts.size(); ++k)
    if (const std::string rest = rest_warning(rest_of(v.starts[k].exact), "by the chain ");
        !rest.empty())
      out << labels.texts[k] << "  | " << rest << "\n";
  return out.str();
}

/// Beside what the paper prints, where these are its starts.
std::string table4_table(const lattice::Validation& v,
                         const std::vector<lattice::PaperStart>& starts, const StartTexts& labels,
                         bool like_table4) {
  lattice::TextStream out;
  const std::string blank(labels.header.size(), ' ');
  out << "\nAs in the paper's Table IV: 100 trials of the full dynamics against the chain, mean "
         "(sd) over\n"
         "repeats. Floor: what chance alone gives if the chain were perfect.\n\n"
      << blank << "  |            corrcoef                      |        RMSE, trials per 100\n"
      << labels.header
      << "  | paper  exact chain    floor  100 walks   | paper  exact chain    floor  100 walks\n";
  for (std::size_t k = 0; k < v.starts.size(); ++k) {
    const lattice::StartValidation& r = v.starts[k];
    const lattice::PaperSized& p = r.paper_sized;
    const auto printed = [&](std::optional<double> lattice::PaperStart::*x) {
      return padded(like_table4 && starts[k].*x ? fixed(*(starts[k].*x), 3) : "-", 6);
    };
    out << labels.texts[k] << "  |" << printed(&lattice::PaperStart::corrcoef) << "  "
        << padded(with_sd(p.exact_corrcoef), -15) << padded(fixed(r.floor_100_exact.corrcoef, 3), 5)
        << "  " << padded(with_sd(p.walks_corrcoef), -15) << "|"
        << printed(&lattice::PaperStart::rmse) << "  " << padded(with_sd(p.exact_rmse), -15)
        << padded(fixed(r.floor_100_exact.rmse_per_100, 3), 5) << "  " << with_sd(p.walks_rmse)
        << "\n";
  }
  return out.str();
}

/// Of all trials.
std::string final_gates_table(const lattice::Validation& v, const StartTexts& labels) {
  lattice::TextStream out;
  out << "\nFinal gates of all " << v.trials
      << " trials per start. Floor: chance in these trials (and walks) alone; matrix:\n"
         "total variation (TV) that the sampling of the matrix alone makes; chance: that both "
         "together make.\n\n"
      << labels.header
      << "  | against         corrcoef  floor    RMSE   floor      TV   floor  matrix  chance\n";
  for (std::size_t k = 0; k < v.starts.size(); ++k) {
    const lattice::StartValidation& r = v.starts[k];
    const auto compared = [&](const std::string& name, const lattice::Comparison& c,
                              const std::string& chance) {
      out << labels.texts[k] << "  | " << padded(name, -15) << padded(fixed(c.corrcoef, 4), 9)
          << padded(fixed(c.floor.corrcoef, 4), 8) << padded(fixed(c.rmse_per_100, 3), 8)
          << padded(fixed(c.floor.rmse_per_100, 3), 8) << padded(fixed(c.total_variation, 3), 8)
          << padded(fixed(c.floor_total_variation, 3), 8)
          << padded(fixed(r.matrix_noise_mean, 3), 8) << padded(chance, 8) << "\n";
    };
    compared("exact chain", r.exact_against, fixed(r.judgement.chance_total_variation, 3));
    compared(std::to_string(v.walks) + " walks", r.walks_against, "-");
  }
  return out.str();
}

std::string exits_table(const lattice::Validation& v, const StartTexts& labels) {
  std::string text =
      "\nPlaces along the sides at which the chain lets more or fewer leave than the 95 % "
      "intervals of\nthe dynamics have (chance alone: one in 20):\n\n";
  for (std::size_t k = 0; k < v.starts.size(); ++k)
    text += labels.texts[k] + "  | " +
            places_outside(v.starts[k].dynamics_exits, v.starts[k].exact_exits) + "\n";
  return text;
}

std::string seconds_table(const lattice::Validation& v, const StartTexts& labels) {
  lattice::TextStream out;
  out << "\nSeconds: " << v.trials << " trials and " << v.walks << " walks on " << v.threads
      << (v.threads == 1 ? " thread" : " threads") << ", one exact prediction on one.\n"
      << "\n"
      << labels.header
      << "  |           dynamics      walks      exact | dynamics/exact  trial/walk\n";
  for (std::size_t k = 0; k < v.starts.size(); ++k) {
    const lattice::StartValidation& r = v.starts[k];
    const double per_trial = r.dynamics_seconds / static_cast<double>(r.dynamics.trials);
    const double per_walk = r.walks_seconds / static_cast<double>(r.walks.walks);
    out << labels.texts[k] << "  |" << padded(fixed(r.dynamics_seconds, 2), 19)
        << padded(fixed(r.walks_seconds, 4), 11) << padded(fixed(r.exact_seconds, 6), 11) << " |"
        << padded(fixed(r.dynamics_seconds / r.exact_seconds, 0), 15)
        << padded(fixed(per_trial / per_walk, 0), 12) << "\n";
  }
  return out.str();
}

double share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

/// Of all types. Leaves of trees share runs and hold mirror images: then the runs are those of the
/// record.
dynamics::Transitions::Totals totals_of(const ValidatedMatrix& matrix) {
  dynamics::Transitions::Totals total;
  for (const dynamics::Transitions& t : matrix.matrices) total += t.totals();
  if (matrix.states && matrix.states->trees) total.runs = matrix.states->trees->gate_runs;
  return total;
}

/// Of a disc: crossings through the sides above the joints.
std::int64_t traverse_sides(const lattice::Validation& v) {
  return v.entries_by[dynamics::Boundary::right_traverse] +
         v.entries_by[dynamics::Boundary::left_traverse];
}

/// By which faces bodies went on: "S 61.2 %, W 19.4 %".
std::string by_face(const lattice::Validation& v, const dynamics::Section& section) {
  std::string text;
  for (std::size_t f = 0; f < section.faces.size(); ++f)
    text += (f > 0 ? ", " : "") + section.faces[f].name + " " +
            percent(static_cast<double>(v.entries_by[f]), static_cast<double>(v.entries));
  return text;
}

}  // namespace

Json to_json(const lattice::Validation& v, const ShownField& shown, const ValidatedMatrix& matrix) {
  Json json;
  json["trials"] = v.trials;
  json["walks"] = v.walks;
  json["left_out_matrices"] = v.left_out.matrices;
  json["starts"] = Json::array();
  for (std::size_t k = 0; k < v.starts.size(); ++k)
    json["starts"].push_back(
        to_json(v.starts[k], matrix.papers.empty() ? nullptr : &matrix.papers[k], shown));
  const auto& faces = shown.map.section.faces;
  Json& crossings = json["crossings"] = {{"between_gates", v.entries}};
  if (shown.mass)
    crossings["RT_and_LT_share"] = share(traverse_sides(v), v.entries);
  else
    for (std::size_t f = 0; f < faces.size(); ++f)
      crossings["by_face"][faces[f].name] = v.entries_by[f];
  crossings["clamped_share"] = share(v.clamped, v.entries);
  const auto total = totals_of(matrix);
  json["matrix"] = {{"gate_runs", total.runs},
                    {"clamped_share", total.clamped_share()},
                    {"rows_never_sampled", total.empty_rows},
                    {"status", matrix.status},
                    {"seconds", matrix.seconds}};
  if (matrix.states)
    json["state_space"] = json_of([&](Fields& out) { describe(out, *matrix.states); });
  json["markov"] = to_json(v.memory);
  json["threads"] = v.threads;
  json["status"] = to_json(v.health);
  if (!matrix.settled.is_null()) json["method"] = matrix.settled;
  return json;
}

std::string table_of(const lattice::Validation& v, const ShownField& shown,
                     const ValidatedMatrix& matrix) {
  std::vector<dynamics::Entry> starts;
  for (const lattice::StartValidation& r : v.starts) starts.push_back(r.start);
  const StartTexts labels(shown.map.section, starts);
  const auto crossings = static_cast<double>(v.entries);
  std::string table =
      endings_table(v, labels) +
      (matrix.papers.empty() ? "" : table4_table(v, matrix.papers, labels, matrix.like_table4)) +
      final_gates_table(v, labels) + exits_table(v, labels) + seconds_table(v, labels);
  table +=
      "\nMatrix: " + std::to_string(totals_of(matrix).runs) + " gate runs, " +
      (matrix.path.empty() ? fixed(matrix.seconds, 2) + " s" : "read from " + matrix.path) +
      ". Crossings between gates in the dynamics: " +
      (shown.mass ? percent(static_cast<double>(traverse_sides(v)), crossings) +
                        " through RT or LT" + (matrix.like_table4 ? " (paper: fewer than 4 %)" : "")
                  : by_face(v, shown.map.section)) +
      ", " + percent(static_cast<double>(v.clamped), crossings) + " outside the bins.\n" +
      (matrix.states ? states_line(*matrix.states) : "");
  table += text_of(v.memory);
  for (std::size_t k = 0; k < v.starts.size(); ++k)
    if (v.starts[k].force) table += labels.texts[k] + "  | " + text_of(*v.starts[k].force) + "\n";
  if (v.entries == 0) table += "No trial ever reached a second gate.\n";
  return table;
}

}  // namespace gatewalk::cli
