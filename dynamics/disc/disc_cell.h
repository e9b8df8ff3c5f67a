// SPDX-License-Identifier: MIT
#pragma once
/// A gate of two hinged, springy beams that a disc pushes through, as a Cell.

#include <cstdint>
#include <memory>
#include <vector>

#include "dynamics/cells/cell.h"
#include "dynamics/disc/disc_section.h"
#include "dynamics/disc/gate.h"

namespace gatewalk::dynamics {

/// The number that names a start in the random streams of its trials, so that different starts have
/// different noise. It is computed in the scene's own units (Scale), so a rescaled scene has the
/// same noise.
[[nodiscard]] std::uint64_t stream_row(const GateParams& p, const BodyState& start);

/// Converts the result of a gate run into a passage.
[[nodiscard]] Passage passage_of(const GateParams& p, const GateRun& run);

/// A gate as a Cell. A body carries its exact state, which its entry rounds to the boundary, and
/// its random force: the current draw goes on in the next gate.
class DiscCell : public Cell {
 public:
  /// Throws InvalidParameter as make_method and disc_section(p) do.
  explicit DiscCell(const GateParams& p);
  DiscCell(const DiscCell&) = delete;  // method_ refers to p_
  DiscCell& operator=(const DiscCell&) = delete;

  [[nodiscard]] const Section& section() const override { return section_; }
  [[nodiscard]] bool is_symmetric() const override { return symmetric(p_); }
  [[nodiscard]] Passage pass(Body& body) const override;
  void carry_out(const NextPassage& next, Health& health, std::int64_t at_once) const override;
  [[nodiscard]] bool has_to_show_itself() const override { return false; }

  void begin(Body& body) const override;
  /// Begins a trial at any state, also inside the gate, where no entry could be.
  void begin_at(Body& body, const BodyState& start) const;
  /// Drops the rest of the current draw; the next draw of the same sequence begins now.
  void forget(Body& body) const override;
  /// The random force's current draw (in its standard deviations) and how long it still holds.
  [[nodiscard]] std::vector<Remembered> remembered(const Body& body) const override;
  /// Keeps the current draw until its end; later draws come from another sequence.
  void fork(Body& body, const Random& random) const override;
  [[nodiscard]] bool lays_noise() const override { return true; }
  /// The point determines the slowest modes of the random force, over the time that a body takes
  /// from rest through a gate without beams.
  void lay_noise(Body& body, const Point& point) const override;
  [[nodiscard]] std::uint64_t stream_of(const Entry& start) const override;

  /// The numbers of gate_param_table that describe the scene, without those that describe its
  /// computation.
  [[nodiscard]] std::vector<Number> numbers() const override;
  [[nodiscard]] std::unique_ptr<Cell> with(std::size_t number, double times) const override;
  /// Distance (m) to the nearer beam at rest.
  [[nodiscard]] double clearance(const Entry& entry) const override;

  [[nodiscard]] const GateParams& params() const { return p_; }

 private:
  GateParams p_;
  Section section_;
  std::unique_ptr<const Method> method_;
  int block_;  // draws per block, for RandomForce::lay
};

}  // namespace gatewalk::dynamics
