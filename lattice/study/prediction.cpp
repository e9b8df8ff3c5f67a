#include "lattice/study/prediction.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <stdexcept>

namespace gatewalk::lattice {
namespace {

std::string name_of(const RowMatrix& o) {
  return "--row " + std::to_string(o.first) +
         (o.last == o.first ? "" : "-" + std::to_string(o.last)) + "=" + o.path;
}

std::string metres(double x) {
  char text[64];
  std::snprintf(text, sizeof text, "%.3f", x);
  return text;
}

/// Throws std::invalid_argument unless gates of `other` can lie in the field of `base`.
void require_same_kind(const RowMatrix& other, const SceneMatrix& base,
                       const std::string& base_path) {
  const dynamics::GateParams &a = other.matrix.scene.gate, &b = base.scene.gate;
  if (a.body.mass != b.body.mass || a.body.radius != b.body.radius)
    throw std::invalid_argument(name_of(other) + ": it was built with another body than " +
                                base_path);
  if (a.beams.joint_x != b.beams.joint_x || a.run.traverse_y != b.run.traverse_y)
    throw std::invalid_argument(name_of(other) + ": its gates are " + metres(a.gate_width()) +
                                " m wide and " + metres(a.gate_length()) + " m long, those of " +
                                base_path + " " + metres(b.gate_width()) + " and " +
                                metres(b.gate_length()) + " m: they make no field");
  if (other.matrix.file.transitions.space != base.file.transitions.space)
    throw std::invalid_argument(name_of(other) + ": its states are not those of " + base_path +
                                " (other bins): what leaves one row could not enter the next");
}

/// What resampled matrices predict for one start.
struct Resampled {
  MatrixNoise noise;
  std::vector<ExitShares> exits{};
};

/// Replicates' spread around the predictions, one per start; none, and prediction.failed, where a
/// resampled matrix cannot be predicted from.
std::vector<Resampled> resampled_predictions(const CountedField& gates, const markov::Field& field,
                                             const std::vector<markov::Start>& starts,
                                             Prediction& prediction, int max_cells,
                                             std::uint64_t seed, const dynamics::Work& work) {
  constexpr std::int64_t kMost = 200, kTogether = 8;
  std::vector<Resampled> all;
  for (std::size_t k = 0; k < starts.size(); ++k)
    all.push_back({MatrixNoise(prediction.starts[k].final, gates.runs_at(starts[k]))});
  const std::int64_t replicates = affordable_replicates(gates, field, max_cells, kMost);
  const auto add = [&](std::int64_t begin) {
    const auto found = replicate_predictions(gates, field, starts, max_cells, seed, begin,
                                             std::min(kTogether, replicates - begin));
    for (std::size_t k = 0; k < starts.size(); ++k)
      for (const markov::FinalDistribution& f : found[k]) {
        all[k].noise.add(f);
        all[k].exits.push_back(exit_shares(f));
      }
  };
  work.in_pieces("resampled matrices", (replicates + kTogether - 1) / kTogether,
                 [&](dynamics::TrialRange batches) {
                   try {
                     for (std::int64_t i = 0; i < batches.count && !prediction.failed; ++i)
                       add((batches.first + i) * kTogether);
                   } catch (const std::runtime_error& e) {
                     prediction.failed = e.what();
                   }
                 });
  if (prediction.failed) all.clear();
  return all;
}

}  // namespace

CountedField field_of(const SceneMatrix& base, const std::string& base_path,
                      const std::vector<RowMatrix>& others) {
  if (others.empty())
    return counted_field(gates_of(base.scene).map(), matrices_of(base.file, base.scene));
  for (const Scene* scene : {&base.scene, &others.front().matrix.scene})
    if (scene->terrain)
      throw std::invalid_argument(name_of(others.front()) +
                                  ": cannot be put into a field with a table [terrain], which says "
                                  "what stands where");
  const int rows = base.scene.field.rows;
  std::vector<int> type_of_row(static_cast<std::size_t>(rows), 0);
  std::vector<markov::Chain> chains{make_chain(base.file.transitions)};
  std::vector<markov::Counts> counts{base.file.transitions.counts()};
  std::map<std::string, int> known;  // matrix files
  for (const RowMatrix& o : others) {
    if (o.first > o.last) throw std::invalid_argument(name_of(o) + ": the lower row comes first");
    if (o.last >= rows)
      throw std::invalid_argument(name_of(o) + ": the rows of this field are 0 to " +
                                  std::to_string(rows - 1));
    for (int row = o.first; row <= o.last; ++row)
      if (type_of_row[static_cast<std::size_t>(row)] != 0)
        throw std::invalid_argument(name_of(o) + ": row " + std::to_string(row) +
                                    " is given twice");
    require_same_kind(o, base, base_path);
    const auto [type, is_new] = known.emplace(o.path, static_cast<int>(chains.size()));
    if (is_new) {
      chains.push_back(make_chain(o.matrix.file.transitions));
      counts.push_back(o.matrix.file.transitions.counts());
    }
    std::fill(type_of_row.begin() + o.first, type_of_row.begin() + o.last + 1, type->second);
  }
  return {markov::FieldChain::by_row(std::move(chains), std::move(type_of_row)), std::move(counts)};
}

Prediction predict(const CountedField& gates, const FieldParams& field_params,
                   const std::vector<ChainStart>& starts, markov::PredictOptions how,
                   std::uint64_t seed, const dynamics::Work& work) {
  const markov::Field field{field_params.columns, field_params.rows};
  how.max_cells = field_params.max_gates;
  std::vector<markov::Start> places;
  for (const ChainStart& s : starts) places.push_back(s.start);

  Prediction result;
  const dynamics::Stopwatch watch;
  std::vector<markov::FinalDistribution> found = markov::predict(gates.chains, field, places, how);
  result.seconds = watch.seconds();
  for (std::size_t k = 0; k < starts.size(); ++k) {
    EndingShares shares(found[k].endings);
    result.starts.push_back({starts[k], std::move(found[k]), shares, {}});
  }
  const std::vector<Resampled> resampled =
      resampled_predictions(gates, field, places, result, how.max_cells, seed, work);
  for (std::size_t k = 0; k < starts.size(); ++k) {
    StartPrediction& s = result.starts[k];
    const Resampled none{MatrixNoise(s.final, 0)};
    const Resampled& of_start = resampled.empty() ? none : resampled[k];
    const MatrixNoise& spread = of_start.noise;
    s.shares = EndingShares(s.final, spread, how.max_cells);
    s.exits = exits_of(exit_shares(s.final), of_start.exits, spread.runs());
    s.replicates = spread.replicates();
    s.mean_total_variation = spread.mean_total_variation();
    s.total_variation_95 = spread.total_variation_95();
  }
  return result;
}

}  // namespace gatewalk::lattice
