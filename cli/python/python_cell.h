// SPDX-License-Identifier: MIT
#pragma once
/// A cell whose passages a Python object simulates, many at once.

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "cli/cells/hello.h"
#include "dynamics/cells/cell.h"

namespace gatewalk::python {

/// `cell` has _hello(), the first line of a cell program (cli/site/reference/cell_program.md), and
/// _passes(face, at, seed, noise, memory) -> (out, at, costs, memory), all arrays with a row per
/// body: face (int32) and out (int64) number faces, out is -1 for trapped, -2 for broken. Both are
/// called with the GIL held; their exceptions end the run.
class PythonCell : public dynamics::Cell {
 public:
  /// Needs the GIL. Throws std::invalid_argument if `cell` does not describe a valid cell.
  explicit PythonCell(pybind11::object cell);
  ~PythonCell() override;
  PythonCell(const PythonCell&) = delete;
  PythonCell& operator=(const PythonCell&) = delete;

  [[nodiscard]] const dynamics::Section& section() const override { return hello_.section; }
  [[nodiscard]] bool is_symmetric() const override { return hello_.symmetric; }
  [[nodiscard]] dynamics::Passage pass(dynamics::Body& body) const override;
  void carry_out(const dynamics::NextPassage& next, dynamics::Health& health,
                 std::int64_t at_once) const override;
  /// Gives the body an empty memory: zeros.
  void begin(dynamics::Body& body) const override;
  [[nodiscard]] std::vector<Number> numbers() const override;
  [[nodiscard]] std::unique_ptr<Cell> with(std::size_t number, double times) const override;

 private:
  struct Slot;
  void run_batch(std::vector<Slot>& slots) const;

  pybind11::object cell_;
  cli::Hello hello_;
  int memory_ = 0;  // numbers that a body carries from cell to cell
};

/// Whether this thread is inside pass_ of a cell.
[[nodiscard]] bool is_in_cell();

}  // namespace gatewalk::python
