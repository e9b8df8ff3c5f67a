#pragma once
/// The field's size, and where a trial starts in it.

namespace gatewalk::lattice {

/// i_x runs from -columns/2 (whole division), i_y from 0; a trial starts in gate (0, 0).
struct FieldParams {
  int columns = 9;
  int rows = 9;
  int max_gates = 13;  // gates a trial may visit, 0: no limit

  [[nodiscard]] int start_column() const { return columns / 2; }
  [[nodiscard]] bool contains(int column, int row) const {
    return column >= 0 && column < columns && row >= 0 && row < rows;
  }
};

}  // namespace gatewalk::lattice
