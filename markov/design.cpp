// SPDX-License-Identifier: MIT
#include "markov/design.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "markov/predict.h"

namespace gatewalk::markov {
namespace {

/// A change of one cell, or an exchange of two.
struct Change {
  double says = 0.0;  // gain predicted by the gradient
  int cell = 0, type = 0;
  int undone = -1;  // a cell that returns to its own type; -1: none
};

class Designer {
  using Map = std::vector<int>;

 public:
  Designer(const FieldChain& chain, const Field& field, const Start& start, const Gains& gains,
           const DesignOptions& options)
      : chain_(chain),
        field_(field),
        start_(start),
        gains_(gains),
        options_(options),
        sign_(options.least ? -1.0 : 1.0) {
    const auto require = [](bool holds, const std::string& what) {
      if (!holds) throw std::invalid_argument("design: " + what);
    };
    validate(chain, field, start, options.max_cells);
    require(gains.draw.empty(), "draws cannot have gains");
    cells_ = static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows);
    inputs_ = static_cast<std::size_t>(chain.inputs());
    require(options.most_changes >= 1 && static_cast<std::size_t>(options.most_changes) <= cells_,
            "1 to " + std::to_string(cells_) + " cells can be changed");
    const auto types = static_cast<int>(chain.chains().size());
    for (const int type : options.become)
      require(type >= 0 && type < types, "a cell cannot become what the chain does not have");
    may_become_.assign(static_cast<std::size_t>(types), options.become.empty());
    for (const int type : options.become) may_become_[static_cast<std::size_t>(type)] = 1;
    require(options.most_solves >= 0, "maps to solve: 0 (no bound) or more");
    require(options.kind_of_type.empty() || std::ssize(options.kind_of_type) == types,
            "there is a kind for each type");
    for (int row = 0; row < field.rows; ++row)
      for (int column = 0; column < field.columns; ++column)
        own_.push_back(chain.type_of(column, row));
    for (const Map& map : options.from) {
      require(map.size() == cells_, "a map to search from is of another field");
      for (std::size_t c = 0; c < cells_; ++c)
        require(map[c] == own_[c] || (map[c] >= 0 && map[c] < types && may(c, map[c])),
                "a map to search from has types that no cell may become");
      require(changes_of(map) <= options.most_changes, "a map to search from changes more cells");
    }
    if (8.0 * static_cast<double>(levels()) * static_cast<double>(cells_ * inputs_) > kMostBytes)
      throw std::runtime_error(
          "design: values of so many cells, states and draws do not fit into "
          "2 GB; a smaller limit of cells (0: none) needs less");
  }

  Designs search() {
    Designs found;
    found.before = sign_ * solved_of({own_}).front();
    if (!std::isfinite(found.before))
      throw std::runtime_error("design: walks can circle almost for ever in the field as it is");
    std::map<Map, FieldDesign> optima;
    std::vector<Map> from{own_};
    from.insert(from.end(), options_.from.begin(), options_.from.end());
    for (const Map& map : from) {
      if (!std::isfinite(solved_of({map}).front())) continue;
      FieldDesign end = search_from(map);
      ++search_;
      FieldDesign& known = optima.try_emplace(end.type_of_cell, std::move(end)).first->second;
      ++known.searches;
    }
    for (auto& [map, optimum] : optima) found.optima.push_back(std::move(optimum));
    std::stable_sort(found.optima.begin(), found.optima.end(),
                     [&](const auto& a, const auto& b) { return sign_ * a.gain > sign_ * b.gain; });
    found.gradient = std::move(own_gradient_);
    found.solves = static_cast<std::int64_t>(known_.size());
    found.finished = !has_enough_;
    return found;
  }

 private:
  static constexpr std::size_t kAtOnce = 8;    // maps solved at the same time
  static constexpr double kMostBytes = 2.0e9;  // bytes of the values of all draws
  // Without a limit: walks still under way that are dropped.
  static constexpr double kHardlyAny = 1e-9;
  static constexpr std::int64_t kMostDraws = 10000;  // largest number of draws if walks circle
  static constexpr double kRounding = 1e-12;         // relative rounding error of a gain

  /// Whether the cell may have this type.
  [[nodiscard]] bool may(std::size_t cell, int type) const {
    const std::vector<int>& kinds = options_.kind_of_type;
    return type == own_[cell] ||
           (may_become_[static_cast<std::size_t>(type)] != 0 &&
            (kinds.empty() ||
             kinds[static_cast<std::size_t>(type)] == kinds[static_cast<std::size_t>(own_[cell])]));
  }
  /// The changes of a map, which serve as its key.
  [[nodiscard]] std::vector<std::size_t> key_of(const Map& map) const {
    std::vector<std::size_t> key;
    for (std::size_t c = 0; c < cells_; ++c)
      if (map[c] != own_[c])
        key.push_back(c * chain_.chains().size() + static_cast<std::size_t>(map[c]));
    return key;
  }
  [[nodiscard]] int changes_of(const Map& map) const {
    return static_cast<int>(key_of(map).size());
  }
  [[nodiscard]] double gain(Ending e) const { return gains_.ending[static_cast<std::size_t>(e)]; }
  [[nodiscard]] std::size_t at(std::int64_t column, std::int64_t row, int input) const {
    return static_cast<std::size_t>(row * field_.columns + column) * inputs_ +
           static_cast<std::size_t>(input);
  }
  [[nodiscard]] bool all_may_change() const {
    return static_cast<std::size_t>(options_.most_changes) == cells_;
  }
  /// The number of sets of values: one for each number of draws made, or one for all.
  [[nodiscard]] std::size_t levels() const {
    return static_cast<std::size_t>(std::max(1, options_.max_cells));
  }

  [[nodiscard]] Decisions values_of(const Map& map) const {
    return decide({FieldChain::by_cell(chain_.chains(), field_.columns, map)}, field_, gains_,
                  {.max_cells = options_.max_cells});
  }
  /// The gain of a map, with the sign for which more is better.
  [[nodiscard]] double solved(const Map& map) const {
    PredictOptions how;
    how.max_cells = options_.max_cells;
    FinalDistribution final;
    try {
      final =
          predict(FieldChain::by_cell(chain_.chains(), field_.columns, map), field_, {start_}, how)
              .front();
    } catch (const std::runtime_error&) {  // walks can circle for ever in this map
      return -std::numeric_limits<double>::infinity();
    }
    double sum = 0.0;
    for (std::size_t e = 0; e < kEndings; ++e) sum += final.endings[e] * gains_.ending[e];
    return sign_ * sum;
  }

  /// The expected gain of a draw from `type`, if `after` holds the values of the following cells.
  /// Without `after` the draw is the last one.
  [[nodiscard]] double drawn(int type, std::size_t cell, int input, const double* after) const {
    const Chain& chain = chain_.chains()[static_cast<std::size_t>(type)];
    if (!chain.is_sampled(input)) return gain(Ending::unsampled);
    double sum = 0.0;
    for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
      auto column = static_cast<std::int64_t>(cell % static_cast<std::size_t>(field_.columns));
      auto row = static_cast<std::int64_t>(cell / static_cast<std::size_t>(field_.columns));
      const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
      const auto end = follow(field_, exit, after == nullptr, column, row);
      sum += it.value() * (end ? gain(*end) : after[at(column, row, exit.next_input)]);
    }
    return sum;
  }

  /// For each cell and type, the sum over all visits to the cell of the gain of a draw from the
  /// type less that of a draw from the cell's own type; and whether each cell is visited.
  struct Gradient {
    std::vector<double> of{};  // (cells x types)
    std::vector<char> visited{};
  };
  [[nodiscard]] Gradient gradient_at(const Map& map) const {
    const std::size_t size = cells_ * inputs_;
    const bool limited = options_.max_cells > 0;
    std::vector<std::vector<double>> values(levels());
    if (!limited) {
      const Decisions d = values_of(map);
      values[0] = d.value;
    } else {
      for (std::size_t k = levels(); k-- > 0;) {
        values[k].resize(size);
        const double* const after = k + 1 < levels() ? values[k + 1].data() : nullptr;
        tbb::parallel_for(std::size_t{0}, cells_, [&](std::size_t cell) {
          for (std::size_t input = 0; input < inputs_; ++input)
            values[k][cell * inputs_ + input] =
                drawn(map[cell], cell, static_cast<int>(input), after);
        });
      }
    }
    const std::size_t types = chain_.chains().size();
    Gradient gradient{std::vector<double>(cells_ * types, 0.0), std::vector<char>(cells_, 0)};
    std::vector<double> here(size, 0.0);
    here[at(start_.column, start_.row, start_.input)] = 1.0;
    for (std::int64_t k = 0; k < (limited ? options_.max_cells : kMostDraws); ++k) {
      const auto level = static_cast<std::size_t>(limited ? k : 0);
      const double* const now = values[level].data();
      const double* const after =
          limited ? (level + 1 < levels() ? values[level + 1].data() : nullptr) : now;
      tbb::parallel_for(std::size_t{0}, cells_, [&](std::size_t cell) {
        for (std::size_t type = 0; type < types; ++type)
          if (static_cast<int>(type) != map[cell] && may(cell, static_cast<int>(type)))
            for (std::size_t input = 0; input < inputs_; ++input)
              if (const double visits = here[cell * inputs_ + input]; visits > 0.0)
                gradient.of[cell * types + type] +=
                    visits * (drawn(static_cast<int>(type), cell, static_cast<int>(input), after) -
                              now[cell * inputs_ + input]);
      });
      if (after == nullptr) break;
      std::vector<double> next(size, 0.0);
      double walking = 0.0;
      for (std::size_t cell = 0; cell < cells_; ++cell)
        for (std::size_t input = 0; input < inputs_; ++input) {
          const double visits = here[cell * inputs_ + input];
          if (visits == 0.0) continue;
          gradient.visited[cell] = 1;
          const Chain& chain = chain_.chains()[static_cast<std::size_t>(map[cell])];
          for (Probabilities::InnerIterator it(chain.matrix(), static_cast<Eigen::Index>(input));
               it; ++it) {
            auto column =
                static_cast<std::int64_t>(cell % static_cast<std::size_t>(field_.columns));
            auto row = static_cast<std::int64_t>(cell / static_cast<std::size_t>(field_.columns));
            const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
            if (follow(field_, exit, false, column, row)) continue;
            next[at(column, row, exit.next_input)] += visits * it.value();
            walking += visits * it.value();
          }
        }
      here = std::move(next);
      if (walking <= (limited ? 0.0 : kHardlyAny)) break;
    }
    return gradient;
  }

  /// All permitted changes of one cell and exchanges of two, the most promising first.
  [[nodiscard]] std::vector<Change> changes_at(const Map& map, const Gradient& gradient) const {
    const std::size_t types = chain_.chains().size();
    const bool more = changes_of(map) < options_.most_changes;
    std::vector<Change> changes;
    for (std::size_t cell = 0; cell < cells_; ++cell)
      for (std::size_t type = 0; type < types && gradient.visited[cell] != 0; ++type) {
        const auto to = static_cast<int>(type);
        if (to == map[cell] || !may(cell, to)) continue;
        const Change one{sign_ * gradient.of[cell * types + type], static_cast<int>(cell), to};
        if (more || map[cell] != own_[cell]) changes.push_back(one);
        if (map[cell] != own_[cell] || all_may_change()) continue;
        for (std::size_t other = 0; other < cells_; ++other)
          if (map[other] != own_[other]) {
            Change two = one;
            two.undone = static_cast<int>(other);
            two.says += sign_ * gradient.of[other * types + static_cast<std::size_t>(own_[other])];
            changes.push_back(two);
          }
      }
    std::stable_sort(changes.begin(), changes.end(),
                     [](const Change& a, const Change& b) { return a.says > b.says; });
    return changes;
  }

  /// The map with the most promising 1/n of the changes that the gradient predicts as gains, taking
  /// the best change of each cell.
  [[nodiscard]] Map changed_at_once(const Map& map, const std::vector<Change>& changes,
                                    std::size_t n) const {
    std::vector<const Change*> best;
    std::vector<char> taken(cells_, 0);
    for (const Change& change : changes)
      if (char& is = taken[static_cast<std::size_t>(change.cell)]; change.says > 0.0 && is == 0) {
        is = 1;
        best.push_back(&change);
      }
    best.resize((best.size() + n - 1) / n);
    Map changed = map;
    for (const Change* change : best)
      changed[static_cast<std::size_t>(change->cell)] = change->type;
    return changed;
  }

  /// Searches from a map. If a search reaches a map that an earlier search has passed, it ends
  /// where the earlier search ended.
  FieldDesign search_from(Map map) {
    double gain = solved_of({map}).front();  // known already
    double error = 0.0;                      // largest error of the gradient's predictions
    std::vector<Map> way;
    for (;;) {
      if (const auto end = ends_.find(key_of(map)); end != ends_.end()) {
        for (const Map& on_way : way) ends_[key_of(on_way)] = end->second;
        return end->second;
      }
      way.push_back(map);
      Gradient gradient = gradient_at(map);
      const std::vector<Change> changes = changes_at(map, gradient);
      if (map == own_) own_gradient_ = std::move(gradient.of);
      std::optional<Map> better;
      double most = gain;
      for (std::size_t first = 0; first < changes.size() && !better; first += kAtOnce) {
        if (first > 0 && changes[first].says + error <= 0.0) break;
        std::vector<Map> maps;
        for (std::size_t i = first; i < std::min(changes.size(), first + kAtOnce); ++i) {
          maps.push_back(map);
          maps.back()[static_cast<std::size_t>(changes[i].cell)] = changes[i].type;
          if (const int undone = changes[i].undone; undone >= 0)
            maps.back()[static_cast<std::size_t>(undone)] = own_[static_cast<std::size_t>(undone)];
        }
        const std::size_t single = maps.size();
        if (first == 0 && all_may_change())
          for (const std::size_t n : {1, 2, 4, 8}) maps.push_back(changed_at_once(map, changes, n));
        if (options_.told) options_.told(search_);
        if (options_.most_solves > 0 && std::ssize(known_) >= options_.most_solves) {
          has_enough_ = true;
          break;
        }
        const std::vector<double> gains = solved_of(maps);
        for (std::size_t i = 0; i < maps.size(); ++i) {
          if (!std::isfinite(gains[i])) continue;
          if (i < single)
            error = std::max(error, std::abs(gains[i] - gain - changes[first + i].says));
          if (gains[i] > most + kRounding * std::max(std::abs(most), std::abs(gains[i]))) {
            most = gains[i];
            better = maps[i];
          }
        }
      }
      if (!better) {
        const FieldDesign end{.type_of_cell = map, .gain = sign_ * gain};
        for (const Map& on_way : way) ends_[key_of(on_way)] = end;
        return end;
      }
      map = std::move(*better);
      gain = most;
    }
  }

  [[nodiscard]] std::vector<double> solved_of(const std::vector<Map>& maps) {
    std::vector<double> gains(maps.size());
    std::vector<char> new_ones(maps.size());
    for (std::size_t i = 0; i < maps.size(); ++i) new_ones[i] = !known_.contains(key_of(maps[i]));
    tbb::parallel_for(std::size_t{0}, maps.size(), [&](std::size_t i) {
      if (new_ones[i]) gains[i] = solved(maps[i]);
    });
    for (std::size_t i = 0; i < maps.size(); ++i) {
      if (new_ones[i]) known_[key_of(maps[i])] = gains[i];
      gains[i] = known_.at(key_of(maps[i]));
    }
    return gains;
  }

  const FieldChain& chain_;
  Field field_;
  Start start_;
  const Gains& gains_;
  const DesignOptions& options_;
  double sign_ = 1.0;
  std::size_t cells_ = 0, inputs_ = 0;
  Map own_;
  std::vector<char> may_become_;                      // by type
  std::map<std::vector<std::size_t>, double> known_;  // gains of maps
  // Ends of the searches that pass these maps.
  std::map<std::vector<std::size_t>, FieldDesign> ends_;
  std::vector<double> own_gradient_;
  std::size_t search_ = 0;
  bool has_enough_ = false;  // most_solves is reached
};

}  // namespace

Designs design(const FieldChain& chain, const Field& field, const Start& start, const Gains& gains,
               const DesignOptions& options) {
  return Designer(chain, field, start, gains, options).search();
}

}  // namespace gatewalk::markov
