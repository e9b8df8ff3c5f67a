#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

#include "cli/arguments.h"
#include "cli/render/drawing.h"
#include "cli/render/gnuplot.h"
#include "cli/render/quantity.h"
#include "cli/render/report.h"
#include "cli/render/start.h"
#include "cli/terminal/output.h"
#include "cli/terminal/progress.h"

namespace gatewalk::cli {
namespace {

using gatewalk::cli::to_json;
using lattice::Fidelity;

/// `active` is enough while the total variation that it costs is no more than this: what is asked
/// of a good chain.
constexpr double kBound = 0.03;
constexpr std::int64_t kRepeats = 5;  // of each timing, the least counts
constexpr std::int64_t kTimedTrials = 64;
constexpr std::int64_t kTimedAtOnce = 16;

/// What is run. The first is what the others are compared with; the last shows what another
/// integrator changes, as a measure for the rest.
struct Variant {
  std::string label;
  lattice::Scene scene;
};

std::vector<Variant> variants_of(const lattice::Scene& scene) {
  std::vector<Variant> all;
  const auto add = [&](Fidelity fidelity, const std::string& method) {
    lattice::Scene s = scene;
    s.field.fidelity = fidelity;
    s.gate.run.method = method;
    if (!s.named.contains("run.step_s")) s.gate.run.step = dynamics::default_step(s.gate);
    lattice::validate(s.gate, s.field);
    (void)dynamics::make_method(s.gate);
    all.push_back({std::string(name_of(fidelity)) + " (" + method + ")", s});
  };
  for (const Fidelity f : {Fidelity::active, Fidelity::remember, Fidelity::all}) add(f, "moreau");
  add(Fidelity::active, dynamics::GateParams{}.run.method);
  return all;
}

/// One variant from one start.
struct Run {
  lattice::FieldTally tally;
  double seconds_per_trial = std::numeric_limits<double>::infinity();  // wall clock
  // Against the first variant:
  double changed = 0.0;          // share of trials whose final gate is another one
  lattice::Comparison apart;     // as if the noise were not shared
  lattice::Comparison in_pairs;  // trial by trial

  explicit Run(const lattice::FieldParams& field) : tally(field) {}
};

struct StartRuns {
  lattice::PaperStart start;
  std::vector<Run> runs;  // as the variants
};

StartRuns run_start(const Options& options, const std::vector<Variant>& variants,
                    const lattice::PaperStart& start, std::int64_t trials) {
  const auto space = dynamics::StateSpace::paper(variants[0].scene.gate);
  const auto run = [&](const Variant& v, std::int64_t first, std::int64_t n) {
    return lattice::run_field(v.scene.gate, v.scene.field, start.body(), space, options.seed(),
                              {first, n});
  };
  const lattice::FieldParams& field = variants[0].scene.field;
  StartRuns r{start, std::vector<Run>(variants.size(), Run(field))};
  for (std::size_t v = 0; v < variants.size(); ++v)
    run_in_batches(
        variants[v].label, trials, options.talk(),
        [&](std::int64_t first, std::int64_t n) { r.runs[v].tally += run(variants[v], first, n); });

  // The same trials by every variant in turn, so that a busy moment of the machine hits them alike.
  const std::int64_t timed = std::min(trials, kTimedTrials);
  const std::int64_t pieces = (timed + kTimedAtOnce - 1) / kTimedAtOnce;
  const auto kinds = static_cast<std::int64_t>(variants.size());
  std::vector<double> seconds(kRepeats * kinds, 0.0);
  run_in_batches("timing", kRepeats * pieces * kinds, options.talk(),
                 [&](std::int64_t first, std::int64_t n) {
                   for (std::int64_t item = first; item < first + n; ++item) {
                     const std::int64_t kind = item % kinds, piece = item / kinds % pieces,
                                        repeat = item / kinds / pieces;
                     const std::int64_t from = piece * kTimedAtOnce;
                     const Stopwatch watch;
                     (void)run(variants[kind], from, std::min(kTimedAtOnce, timed - from));
                     seconds[repeat * kinds + kind] += watch.seconds();
                   }
                 });
  for (std::int64_t i = 0; i < kRepeats * kinds; ++i) {
    double& least = r.runs[i % kinds].seconds_per_trial;
    least = std::min(least, seconds[i] / static_cast<double>(timed));
  }

  const lattice::FieldTally& base = r.runs[0].tally;
  const std::int64_t null_draws = std::clamp<std::int64_t>(100'000'000 / trials, 999, 9999);
  for (std::size_t v = 1; v < variants.size(); ++v) {
    const lattice::FieldTally& t = r.runs[v].tally;
    std::int64_t changed = 0;
    for (std::size_t i = 0; i < t.final_gate_of_trial.size(); ++i)
      changed += t.final_gate_of_trial[i] != base.final_gate_of_trial[i];
    r.runs[v].changed = static_cast<double>(changed) / static_cast<double>(trials);
    r.runs[v].apart = lattice::compare(t.final_gates, base.final_gates, null_draws, options.seed());
    r.runs[v].in_pairs =
        lattice::compare_pairs(t.final_gate_of_trial, base.final_gate_of_trial, field.rows,
                               field.columns, null_draws, options.seed());
  }
  return r;
}

/// What these trials say about doing without memory or neighbours.
enum class Finding { enough, cannot_tell, not_enough };

/// How far the total variation seen may be from that of infinitely many trials, at 95 %: as much as
/// chance makes of the pairs that differ (triangle inequality), and what 3 of N trials change when
/// none of N shows it.
double uncertainty(const Run& r) {
  return r.in_pairs.floor_total_variation_95 + 3.0 / static_cast<double>(r.tally.trials);
}
Finding finding(const Run& r) {
  const double tv = r.apart.total_variation;
  if (tv + uncertainty(r) <= kBound) return Finding::enough;
  return tv - uncertainty(r) > kBound ? Finding::not_enough : Finding::cannot_tell;
}
Finding finding(const StartRuns& r) { return std::max(finding(r.runs[1]), finding(r.runs[2])); }

/// "Start 0, 0, 15: active is enough: ..."
std::string sentence(const StartRuns& r) {
  const auto about = [](const char* name, const Run& run) {
    return std::string(name) + " has TV " + fixed(run.apart.total_variation, 4) + " +- " +
           fixed(uncertainty(run), 4) + " where chance makes " +
           fixed(run.in_pairs.floor_total_variation, 4) + " (p " +
           p_text(run.in_pairs.p_total_variation) + ")";
  };
  const std::string words[] = {
      "active is enough",
      std::to_string(r.runs[0].tally.trials) + " trials cannot tell whether active is enough",
      "active is not enough"};
  return "Start " + digits(r.start.d) + ", " + digits(r.start.vx) + ", " + digits(r.start.vy) +
         ": " + words[static_cast<int>(finding(r))] + ": " + about("remember", r.runs[1]) + ", " +
         about("all", r.runs[2]) + ".";
}

/// "0.02 s (moreau)"
std::string step_text(const Variant& v) {
  return quantity(v.scene.gate.run.step, "s", 7) + " (" + v.scene.gate.run.method + ")";
}

std::string table_of(const std::vector<StartRuns>& starts, const std::vector<Variant>& variants,
                     std::int64_t trials, std::size_t threads) {
  std::ostringstream out;
  out << trials << " trials per start and line, the same noise in all of them; step "
      << step_text(variants.front()) << ", " << step_text(variants.back()) << ".\n"
      << "Against the first line: share of trials that end in another gate; total variation (TV),\n"
         "what chance gives between independent samples (floor) and between samples that share "
         "their\n"
         "noise (pairs), with p-values; corrcoef and RMSE (trials per 100). ms: wall clock per "
         "trial, "
      << threads << (threads == 1 ? " thread" : " threads") << ",\nleast of " << kRepeats
      << " interleaved repeats.\n\n"
      << "   d   vx   vy  | fidelity (method)      ms  trapped    left     cut | changed      TV   "
         "floor   pairs"
         "       p p pairs  corrcoef    RMSE\n";
  for (const StartRuns& r : starts)
    for (std::size_t v = 0; v < variants.size(); ++v) {
      const Run& run = r.runs[v];
      const auto share = [&](std::int64_t n, int width) {
        return padded(percent(static_cast<double>(n), static_cast<double>(run.tally.trials), 2),
                      width);
      };
      out << start_text(r.start) << "  | " << padded(variants[v].label, -18)
          << padded(fixed(1e3 * run.seconds_per_trial, 2), 7) << share(run.tally.trapped, 9)
          << share(run.tally.left_field, 8) << share(run.tally.cut_off, 8) << " |";
      if (v > 0) {
        const lattice::Comparison &a = run.apart, &p = run.in_pairs;
        out << padded(percent(run.changed, 1.0), 8) << padded(fixed(a.total_variation, 4), 8)
            << padded(fixed(a.floor_total_variation, 4), 8)
            << padded(fixed(p.floor_total_variation, 4), 8)
            << padded(p_text(a.p_total_variation), 8) << padded(p_text(p.p_total_variation), 8)
            << padded(fixed(a.corrcoef, 4), 10) << padded(fixed(a.rmse_per_100, 3), 8);
      }
      out << "\n";
    }
  out << "\nActive is enough where TV is at most " << kBound
      << " with its uncertainty (+-) added, and\n"
      << "not enough where it is more with that taken off: what chance makes of pairs 95 times in\n"
      << "100, and 3 trials of " << trials << " that may yet show what none did.\n";
  for (const StartRuns& r : starts) out << sentence(r) << "\n";
  return out.str();
}

std::string csv_of(const std::vector<StartRuns>& starts, const std::vector<Variant>& variants) {
  std::string csv =
      "d_m,vx_m_per_s,vy_m_per_s,fidelity,method,step_s,trials,seconds_per_trial,trapped_share,"
      "left_field_share,cut_off_share,broken_share,changed_share,total_variation,"
      "total_variation_uncertainty,total_variation_floor,total_variation_floor_pairs,p_total_"
      "variation,p_total_variation_pairs,"
      "p_energy,p_energy_pairs,corrcoef,corrcoef_floor,rmse_per_100,rmse_per_100_floor,clean\n";
  for (const StartRuns& r : starts)
    for (std::size_t v = 0; v < variants.size(); ++v) {
      const lattice::Scene& scene = variants[v].scene;
      const Run& run = r.runs[v];
      const lattice::FieldTally& t = run.tally;
      const auto n = static_cast<double>(t.trials);
      const auto number = [&](double x) { csv += (std::isfinite(x) ? digits(x) : "") + ","; };
      for (const double x : {r.start.d, r.start.vx, r.start.vy}) number(x);
      csv += std::string(name_of(scene.field.fidelity)) + "," + scene.gate.run.method + ",";
      for (const double x : {scene.gate.run.step, n, run.seconds_per_trial}) number(x);
      for (const std::int64_t k : {t.trapped, t.left_field, t.cut_off, t.broken})
        number(static_cast<double>(k) / n);
      const lattice::Comparison &a = run.apart, &p = run.in_pairs;
      for (const double x :
           {run.changed, a.total_variation, uncertainty(run), a.floor_total_variation,
            p.floor_total_variation, a.p_total_variation, p.p_total_variation, a.p_energy,
            p.p_energy, a.corrcoef, a.floor.corrcoef, a.rmse_per_100, a.floor.rmse_per_100})
        number(v == 0 ? std::nan("") : x);
      csv += t.health.clean() ? "true\n" : "false\n";
    }
  return csv;
}

Json json_of(const std::vector<StartRuns>& starts, const std::vector<Variant>& variants) {
  Json list = Json::array();
  for (const StartRuns& r : starts) {
    Json one;
    one["start"] = {{"d_m", r.start.d}, {"vx_m_per_s", r.start.vx}, {"vy_m_per_s", r.start.vy}};
    one["active_is_enough"] = finding(r) == Finding::enough       ? Json(true)
                              : finding(r) == Finding::not_enough ? Json(false)
                                                                  : Json(nullptr);
    one["sentence"] = sentence(r);
    one["runs"] = Json::array();
    for (std::size_t v = 0; v < variants.size(); ++v) {
      const Run& run = r.runs[v];
      const lattice::FieldTally& t = run.tally;
      const auto share = [&](std::int64_t n) {
        return static_cast<double>(n) / static_cast<double>(t.trials);
      };
      Json j;
      j["fidelity"] = name_of(variants[v].scene.field.fidelity);
      j["method"] = variants[v].scene.gate.run.method;
      j["step_s"] = variants[v].scene.gate.run.step;
      j["seconds_per_trial"] = run.seconds_per_trial;
      j["fates"] = {{"trapped", share(t.trapped)},
                    {"left_field", share(t.left_field)},
                    {"cut_off", share(t.cut_off)},
                    {"not_finite", share(t.broken)}};
      if (v > 0) {
        j["changed_share"] = run.changed;
        j["total_variation_uncertainty"] = uncertainty(run);
        j["as_independent_samples"] = to_json(run.apart);
        j["in_pairs"] = to_json(run.in_pairs);
      }
      j["final_gates"] = grid(t.final_gates);
      j["status"] = to_json(t.health);
      one["runs"].push_back(std::move(j));
    }
    list.push_back(std::move(one));
  }
  return list;
}

/// Total variation against `active`, and what a trial costs, start by start.
std::string script_of(const std::vector<StartRuns>& starts, const std::vector<Variant>& variants,
                      std::int64_t trials, std::size_t threads) {
  std::ostringstream s;
  const std::size_t n = starts.size();
  s << "set terminal svg size " << std::max<std::size_t>(820, 240 + 150 * n)
    << ",760 font 'sans,13' background '#ffffff' enhanced\n"
    << "$d << EOD\n";
  for (const StartRuns& r : starts) {
    s << "\"" << digits(r.start.d) << ", " << digits(r.start.vx) << ", " << digits(r.start.vy)
      << "\"";
    for (const Run& run : r.runs) s << " " << digits(1e3 * run.seconds_per_trial);
    for (std::size_t v = 1; v < variants.size(); ++v)
      s << " " << digits(r.runs[v].apart.total_variation) << " "
        << digits(r.runs[v].in_pairs.floor_total_variation) << " "
        << digits(r.runs[v].apart.floor_total_variation);
    s << "\n";
  }
  s << "EOD\n"
       "array colour[4] = ['#6b7280', '#2a78b5', '#d1662b', '#9aa0a6']\n"
       "set style fill solid 0.85 noborder\n"
       "set boxwidth 0.2\n"
       "set grid ytics lc rgb '#dddddd'\n"
       "set border 3\n"
       "set tics nomirror out\n"
       "set key outside right top vertical Left reverse samplen 2\n"
       "set xlabel 'start: d (m), v_x, v_y (m/s)'\n"
    << "set xrange [-0.6:" << static_cast<double>(n) - 0.4 << "]\n"
    << "set yrange [0:*]\n"
       "set lmargin 13\n"
       "set rmargin 30\n"
       "set multiplot layout 2,1\n"
    << "set title 'What memory and neighbours change (final gates, " << trials
    << " trials per start)'\n"
    << "set ylabel 'total variation to active'\n"
       "plot $d using 0:(0):xtic(1) with dots lc rgb '#ffffff' notitle";
  const auto column = [&](std::size_t v, int what) {
    return 2 + variants.size() + 3 * (v - 1) + what;
  };
  const auto plain = [&](std::size_t v) {  // what a legend calls a variant
    return v == 3 ? "active, method " + variants[3].scene.gate.run.method
                  : std::string(name_of(variants[v].scene.field.fidelity));
  };
  const auto shift = [](std::size_t v) { return fixed(0.25 * (static_cast<double>(v) - 2.0), 2); };
  for (std::size_t v = 1; v < variants.size(); ++v)
    s << ", \\\n $d using ($0+" << shift(v) << "):" << column(v, 0) << " with boxes lc rgb colour["
      << v + 1 << "] title '" << plain(v) << "'";
  for (std::size_t v = 1; v < variants.size(); ++v)
    s << ", \\\n $d using ($0+" << shift(v) << "):" << column(v, 1)
      << ":(0.11) with xerrorbars pt 0 lw 2 lc rgb '#111111' "
      << (v == 1 ? "title 'chance, shared noise'" : "notitle");
  s << ", \\\n $d using 0:" << column(1, 2)
    << " with points pt 6 lc rgb '#111111' title 'chance, independent'"
    << ", \\\n " << kBound << " with lines dt 2 lc rgb '#444444' title 'bound " << kBound << "'\n"
    << "set title 'What a trial costs'\n"
       "set ylabel 'ms per trial, "
    << threads << (threads == 1 ? " thread" : " threads")
    << "'\n"
       "plot $d using 0:(0):xtic(1) with dots lc rgb '#ffffff' notitle";
  const auto place = [](std::size_t v) { return fixed(0.2 * (static_cast<double>(v) - 1.5), 2); };
  for (std::size_t v = 0; v < variants.size(); ++v)
    s << ", \\\n $d using ($0+" << place(v) << "):" << 2 + v << " with boxes lc rgb colour["
      << v + 1 << "] title '" << (v == 0 ? "active" : plain(v)) << "'";
  s << "\nunset multiplot\n";
  return s.str();
}

}  // namespace

int run_chart_field(const std::vector<std::string>& arguments) {
  Options options(
      "chart-field SCENE -o DIR [options]",
      "Runs the full dynamics at every field.fidelity, with the same noise: what do beams that\n"
      "remember, and beams of neighbouring gates, change in the final gates, and what do they\n"
      "cost? Method moreau at the scene's run.step_s, which the text names; run.method and\n"
      "field.fidelity of the scene are not used. Also the default method, to show what another\n"
      "integrator changes. Long steps let moreau sink into beams: a warning says so, and a "
      "smaller\n"
      "run.step_s helps. Writes fidelity.csv, fidelity.json and, with gnuplot, fidelity.svg into "
      "DIR.",
      "gatewalk chart-field scenes/field.toml --trials 2000 --set run.step_s=0.001 -o "
      "results/fidelity");
  options.positional("scene", "scene file (TOML)", true);
  add_trials_and_seed(options, "trials per start and fidelity");
  options.output_folder("folder to write to; made if missing",
                        {"fidelity.csv", "fidelity.json", "fidelity.svg"});
  add_starts(options);
  add_strict(options);
  if (!options.parse(arguments)) return kFine;
  const std::string folder = options.text("output");
  lattice::Scene scene = lattice::read_scene(options.text("scene"), options.overrides());
  if (scene.gate.run.method == "auto")
    throw UsageError(
        "run.method = \"auto\" is not permitted for chart-field, which runs method moreau: "
        "name a method, and give moreau's step as run.step_s");
  const std::vector<lattice::PaperStart> starts = starts_of(options, scene);
  lattice::require_inside(starts, scene);
  const std::vector<Variant> variants = variants_of(scene);
  (void)dynamics::StateSpace::paper(scene.gate);  // refuses gates too short for their beams

  const auto path = [&](const char* name) {
    return (std::filesystem::path(folder) / name).string();
  };
  const std::string csv_path = path("fidelity.csv"), json_path = path("fidelity.json"),
                    svg_path = path("fidelity.svg");
  require_folder(folder);

  const std::int64_t trials = options.count("trials");
  std::vector<StartRuns> reports;
  for (const lattice::PaperStart& start : starts)
    reports.push_back(run_start(options, variants, start, trials));
  std::vector<dynamics::Health> health(variants.size());
  for (const StartRuns& r : reports)
    for (std::size_t v = 0; v < variants.size(); ++v) health[v] += r.runs[v].tally.health;

  const std::size_t threads =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  Json json;
  json["machine"] = machine();
  json["trials"] = trials;
  json["threads"] = threads;
  json["bound"] = kBound;
  json["starts"] = json_of(reports, variants);
  json["made_by"] = manifest(options, scene);
  std::filesystem::remove(svg_path);  // an old figure shall not stand beside new numbers
  write_text_atomically(csv_path, csv_of(reports, variants));
  write_text_atomically(json_path, text_of(json) + "\n");
  options.give_out(json, table_of(reports, variants, trials, threads));
  for (std::size_t v = 0; v < variants.size(); ++v)
    if (!health[v].clean())
      warn(variants[v].label + ", step " + quantity(variants[v].scene.gate.run.step, "s", 7) +
           ": " + complaint(health[v]));
  try {
    write_text_atomically(svg_path, drawn(script_of(reports, variants, trials, threads)));
  } catch (const std::runtime_error& e) {
    throw std::runtime_error("no figure: " + std::string(e.what()) + "; " + csv_path + " and " +
                             json_path + " are written");
  }
  return exit_status(options, std::all_of(health.begin(), health.end(),
                                          [](const dynamics::Health& h) { return h.clean(); }));
}

}  // namespace gatewalk::cli
