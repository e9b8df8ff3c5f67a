#include <algorithm>
#include <sstream>

#include "cli/render/fidelity.h"
#include "cli/render/figure.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

using lattice::FidelityOfStart;
using lattice::FidelityRun;
using lattice::FidelityStudy;

/// Columns of the table $d: a start, ms per trial by variant, then three numbers of each but the
/// first variant.
std::size_t time_column(std::size_t variant) { return 2 + variant; }
enum Shown { total_variation, chance_shared, chance_apart };
std::size_t column(const FidelityStudy& study, std::size_t variant, Shown what) {
  return 2 + study.variants.size() + 3 * (variant - 1) + what;
}

std::string table_d(const FidelityStudy& study) {
  std::string rows;
  for (const FidelityOfStart& s : study.starts) {
    rows += "\"" + digits(s.start.d) + ", " + digits(s.start.vx) + ", " + digits(s.start.vy) + "\"";
    for (const FidelityRun& run : s.runs) rows += " " + digits(1e3 * run.seconds_per_trial);
    for (const FidelityRun& run : s.runs)
      if (run.change)
        rows += " " + digits(run.change->apart.total_variation) + " " +
                digits(run.change->in_pairs.floor_total_variation) + " " +
                digits(run.change->apart.floor_total_variation);
    rows += "\n";
  }
  return data_block("$d", rows);
}

/// What a legend calls a variant.
std::string plain_name(const FidelityStudy& study, std::size_t v) {
  const lattice::Scene& scene = study.variants[v].scene;
  return v == 3 ? "active, method " + scene.gate.run.method
                : std::string(name_of(scene.field.fidelity));
}

/// Boxes of a variant, beside those of the others.
std::string boxes(const std::string& shift, std::size_t column, std::size_t v,
                  const std::string& title) {
  return ", \\\n $d using ($0+" + shift + "):" + std::to_string(column) +
         " with boxes lc rgb colour[" + std::to_string(v + 1) + "] title '" + title + "'";
}

constexpr const char* kStartNames =
    "plot $d using 0:(0):xtic(1) with dots lc rgb '#ffffff' notitle";

std::string plot_of_changes(const FidelityStudy& study) {
  std::string s = kStartNames;
  const auto shift = [](std::size_t v) { return fixed(0.25 * (static_cast<double>(v) - 2.0), 2); };
  for (std::size_t v = 1; v < study.variants.size(); ++v)
    s += boxes(shift(v), column(study, v, total_variation), v, plain_name(study, v));
  for (std::size_t v = 1; v < study.variants.size(); ++v)
    s += ", \\\n $d using ($0+" + shift(v) +
         "):" + std::to_string(column(study, v, chance_shared)) +
         ":(0.11) with xerrorbars pt 0 lw 2 lc rgb '#111111' " +
         (v == 1 ? "title 'chance, shared noise'" : "notitle");
  const std::string bound = digits(lattice::kFidelityBound);
  return s + ", \\\n $d using 0:" + std::to_string(column(study, 1, chance_apart)) +
         " with points pt 6 lc rgb '#111111' title 'chance, independent'" + ", \\\n " + bound +
         " with lines dt 2 lc rgb '#444444' title 'bound " + bound + "'\n";
}

std::string plot_of_times(const FidelityStudy& study) {
  std::string s = kStartNames;
  for (std::size_t v = 0; v < study.variants.size(); ++v)
    s += boxes(fixed(0.2 * (static_cast<double>(v) - 1.5), 2), time_column(v), v,
               plain_name(study, v));
  return s + "\n";
}

}  // namespace

Figure figure_of(const FidelityStudy& study) {
  std::ostringstream s;
  const std::size_t n = study.starts.size();
  s << table_d(study)
    << "array colour[4] = ['#6b7280', '#2a78b5', '#d1662b', '#9aa0a6']\n"
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
    << "set title 'What memory and neighbours change (final gates, " << study.trials
    << " trials per start)'\n"
    << "set ylabel 'total variation to active'\n"
    << plot_of_changes(study) << "set title 'What a trial costs'\n"
    << "set ylabel 'ms per trial, " << study.threads
    << (study.threads == 1 ? " thread" : " threads") << "'\n"
    << plot_of_times(study) << "unset multiplot\n";
  return {static_cast<int>(std::max<std::size_t>(820, 240 + 150 * n)), 760, s.str(), 13};
}

}  // namespace gatewalk::cli
