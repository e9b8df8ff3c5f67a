#pragma once
/// A field of gates: indices, moves, local and global coordinates.

namespace gatewalk::lattice {

struct FieldParams {
  int columns = 9;     // gates side by side; i_x runs from -columns/2
  int rows = 9;        // gates one behind the other; i_y runs from 0
  int max_gates = 13;  // gates a trial may visit, 0: no limit
};

}  // namespace gatewalk::lattice
