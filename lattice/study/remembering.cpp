// SPDX-License-Identifier: MIT
#include "lattice/study/remembering.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "dynamics/base/random.h"
#include "lattice/field/field_trials.h"
#include "lattice/study/trials.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// The coordinates of `plain`, then the remembered numbers.
Section remembering_section(Section plain, const std::vector<Cell::Remembered>& numbers) {
  if (plain.coordinates.size() + numbers.size() > kMostCoordinates)
    throw std::invalid_argument("cell: coordinates and remembered numbers must be at most " +
                                std::to_string(kMostCoordinates) + " together, these are " +
                                std::to_string(plain.coordinates.size()) + " and " +
                                std::to_string(numbers.size()));
  for (const Cell::Remembered& number : numbers) {
    const auto bit = static_cast<std::uint8_t>(1U << plain.coordinates.size());
    plain.coordinates.push_back(
        {.name = number.key, .key = number.key, .unit = "", .words = number.key});
    if (number.odd)
      for (Face& face : plain.faces) face.odd |= bit;
  }
  return plain;
}

/// A cell whose entries show what its bodies remember. Only whole trials use it: they do not fork
/// or forget, and lay no noise.
class RememberingCell : public Cell {
 public:
  RememberingCell(std::shared_ptr<const Cell> cell, Section section)
      : cell_(std::move(cell)),
        section_(std::move(section)),
        first_(cell_->section().coordinates.size()) {}

  [[nodiscard]] const Section& section() const override { return section_; }
  [[nodiscard]] bool is_symmetric() const override { return cell_->is_symmetric(); }
  [[nodiscard]] Passage pass(Body& body) const override {
    const Passage passage = cell_->pass(body);
    return shown(body, passage);
  }
  void carry_out(const NextPassage& next, Health& health, std::int64_t at_once) const override {
    cell_->carry_out(showing(next), health, at_once);
  }
  [[nodiscard]] bool has_to_show_itself() const override { return cell_->has_to_show_itself(); }
  void carry_out_once_more(const NextPassage& next, Health& health,
                           std::int64_t at_once) const override {
    cell_->carry_out_once_more(showing(next), health, at_once);
  }
  void begin(Body& body) const override { cell_->begin(body); }
  [[nodiscard]] std::uint64_t stream_of(const Entry& start) const override {
    return cell_->stream_of(start);
  }

 private:
  /// The passage with what the body remembers, also in its entry.
  Passage shown(Body& body, Passage passage) const {
    if (passage.fate != Fate::left) return passage;
    std::size_t at = first_;
    for (const Remembered& number : cell_->remembered(body)) passage.next.at[at++] = number.value;
    body.entry = passage.next;
    return passage;
  }
  [[nodiscard]] NextPassage showing(const NextPassage& next) const {
    return [&next, this](Body& body, const Passage* ended) {
      if (ended == nullptr) return next(body, nullptr);
      const Passage passage = shown(body, *ended);
      return next(body, &passage);
    };
  }

  std::shared_ptr<const Cell> cell_;
  Section section_;
  std::size_t first_;  // index of the first remembered number among the coordinates
};

/// What bodies remember, by a body that begins a trial in each type of cell.
std::vector<Cell::Remembered> remembered_by(const Problem& problem) {
  std::vector<Cell::Remembered> numbers;
  for (std::size_t type = 0; type < problem.cells.cells.size(); ++type) {
    const Cell& cell = *problem.cells.cells[type];
    Body body{.entry = problem.start, .random = Random(Purpose::field, {})};
    cell.begin(body);
    std::vector<Cell::Remembered> of_type = cell.remembered(body);
    if (of_type.size() > Cell::kMostRemembered)
      throw std::invalid_argument("cell: at most " + std::to_string(Cell::kMostRemembered) +
                                  " numbers may be remembered");
    const auto alike = [](const Cell::Remembered& a, const Cell::Remembered& b) {
      return a.key == b.key && a.odd == b.odd;
    };
    if (type > 0 &&
        !std::equal(numbers.begin(), numbers.end(), of_type.begin(), of_type.end(), alike))
      throw std::invalid_argument("cell: all types must remember the same numbers");
    numbers = std::move(of_type);
  }
  return numbers;
}

/// Replaces a remembered number of all passages by its rank among them, between -1/2 and 1/2, so
/// that its unit and its tails do not matter. Numbers that change their sign in the mirror are
/// ranked together with those of mirror images. Returns the ranks' standard deviation (1 if all are
/// equal). Throws std::runtime_error if a number is not finite.
double rank(std::vector<CellPassage>& passages, std::size_t coordinate,
            const Cell::Remembered& number) {
  std::vector<double> all;
  for (const CellPassage& passage : passages) {
    if (passage.fate != Fate::left) continue;
    const double x = passage.entry.at[coordinate];
    if (!std::isfinite(x))
      throw std::runtime_error("cell: a body left a cell with a number that is not finite: " +
                               number.key);
    all.push_back(x);
    if (number.odd) all.push_back(-x);
  }
  std::sort(all.begin(), all.end());
  double squares = 0.0, count = 0.0;
  for (CellPassage& passage : passages) {
    if (passage.fate != Fate::left) continue;
    double& x = passage.entry.at[coordinate];
    const auto [from, to] = std::equal_range(all.begin(), all.end(), x);
    x = 0.5 * static_cast<double>((from - all.begin()) - (all.end() - to)) /
        static_cast<double>(all.size());
    squares += x * x;
    count += 1.0;
  }
  return squares > 0.0 ? std::sqrt(squares / count) : 1.0;
}

}  // namespace

RunPool simulated_bodies(const Problem& problem, std::int64_t trials, std::uint64_t seed,
                         const Work& work) {
  RunPool pool;
  static_cast<void>(field_trials(
      problem, {0, trials}, seed, work,
      [&](const FieldTrials& each) { pool.scattered.each.append(each); }, true));
  pool.scattered.starts.assign(pool.scattered.each.passed.size(), problem.start);
  for (std::int32_t body = 0; body < std::ssize(pool.scattered.starts); ++body)
    pool.scattered.each.bodies.push_back(body);
  return pool;
}

RunPool Remembering::seen_in(const Problem& plain) const {
  RunPool seen = pool;
  PassageTable passages(plain.map().section);
  for (const CellPassage passage : pool.scattered.each.passages.rows()) passages.push_back(passage);
  seen.scattered.each.passages = std::move(passages);
  return seen;
}

std::optional<Remembering> remembering_bodies(const Problem& problem, std::int64_t trials,
                                              std::uint64_t seed, const Work& work) {
  const std::vector<Cell::Remembered> numbers = remembered_by(problem);
  if (numbers.empty()) return {};
  Problem showing = problem;
  Section& section = showing.cells.map.section;
  section = remembering_section(std::move(section), numbers);
  for (std::shared_ptr<const Cell>& cell : showing.cells.cells)
    cell = std::make_shared<RememberingCell>(cell, section);
  Remembering bodies{.map = {}, .pool = simulated_bodies(showing, trials, seed, work), .keys = {}};
  PassageTable& table = bodies.pool.scattered.each.passages;
  std::vector<CellPassage> passages;
  for (const CellPassage passage : table.rows()) passages.push_back(passage);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const std::size_t coordinate = problem.map().section.coordinates.size() + k;
    section.coordinates[coordinate].scale = rank(passages, coordinate, numbers[k]);
    bodies.keys.push_back(numbers[k].key);
  }
  table = PassageTable(section);
  for (const CellPassage& passage : passages) table.push_back(passage);
  bodies.map = showing.cells.map;
  return bodies;
}

}  // namespace gatewalk::lattice
