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

/// The number that names a start in its trials' streams: other starts, other noise. From the start
/// in the scene's own units (Scale), so that a rescaled scene has the same noise.
[[nodiscard]] std::uint64_t stream_row(const GateParams& p, const BodyState& start);

/// How a run through a gate ended, as a passage.
[[nodiscard]] Passage passage_of(const GateParams& p, const GateRun& run);

/// Bodies carry their exact state, which an entry rounds to the boundary, and the random force:
/// its draw in force is held on in the next gate.
class DiscCell : public Cell {
 public:
  /// Throws InvalidParameter as make_method and disc_section(p).
  explicit DiscCell(const GateParams& p);
  DiscCell(const DiscCell&) = delete;  // its method refers to its own p_
  DiscCell& operator=(const DiscCell&) = delete;

  [[nodiscard]] const Section& section() const override { return section_; }
  [[nodiscard]] bool is_symmetric() const override { return symmetric(p_); }
  [[nodiscard]] Passage pass(Body& body) const override;
  void carry_out(const NextPassage& next, Health& health, std::int64_t at_once) const override;
  [[nodiscard]] bool has_to_show_itself() const override { return false; }

  void begin(Body& body) const override;
  /// At a place inside the gate too, which no entry shows.
  void begin_at(Body& body, const BodyState& start) const;
  /// Drops the rest of the draw in force: the next one of the same sequence comes now.
  void forget(Body& body) const override;
  /// The draw in force is held on; those after it are of another sequence.
  void fork(Body& body, const Random& random) const override;
  [[nodiscard]] bool lays_noise() const override { return true; }
  /// By the slowest parts of the force, over as long as a body takes from rest through a gate
  /// without beams.
  void lay_noise(Body& body, const Point& point) const override;
  [[nodiscard]] std::uint64_t stream_of(const Entry& start) const override;

  /// Those of gate_param_table that are what a scene is, not how it is computed.
  [[nodiscard]] std::vector<Number> numbers() const override;
  [[nodiscard]] std::unique_ptr<Cell> with(std::size_t number, double times) const override;
  /// To the nearer of the beams at rest (m).
  [[nodiscard]] double clearance(const Entry& entry) const override;

  [[nodiscard]] const GateParams& params() const { return p_; }

 private:
  GateParams p_;
  Section section_;
  std::unique_ptr<const Method> method_;
  int block_;  // draws, of RandomForce::lay
};

}  // namespace gatewalk::dynamics
