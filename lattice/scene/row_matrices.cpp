// SPDX-License-Identifier: MIT
#include "lattice/scene/row_matrices.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace gatewalk::lattice {
namespace {

std::string name_of(const RowMatrix& o) {
  return "--row " + std::to_string(o.first) +
         (o.last == o.first ? "" : "-" + std::to_string(o.last)) + "=" + o.path;
}

std::string metres(double x) { return fmt::format("{:.3f}", x); }

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
  if (other.matrix.file->transitions.space != base.file->transitions.space)
    throw std::invalid_argument(name_of(other) + ": its states are not those of " + base_path +
                                " (other bins): what leaves one row could not enter the next");
}

}  // namespace

CountedField field_of(const SceneMatrix& base, const std::string& base_path,
                      const std::vector<RowMatrix>& others) {
  if (others.empty())
    return counted_field(gates_of(base.scene).map(), matrices_of(*base.file, base.scene));
  for (const Scene* scene : {&base.scene, &others.front().matrix.scene})
    if (scene->terrain)
      throw std::invalid_argument(name_of(others.front()) +
                                  ": cannot be put into a field with a table [terrain], which says "
                                  "what stands where");
  const int rows = base.scene.field.rows;
  std::vector<int> type_of_row(static_cast<std::size_t>(rows), 0);
  std::vector<markov::Chain> chains{make_chain(base.file->transitions)};
  std::vector<markov::Counts> counts{base.file->transitions.counts()};
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
      chains.push_back(make_chain(o.matrix.file->transitions));
      counts.push_back(o.matrix.file->transitions.counts());
    }
    std::fill(type_of_row.begin() + o.first, type_of_row.begin() + o.last + 1, type->second);
  }
  return {markov::FieldChain::by_row(std::move(chains), std::move(type_of_row)), std::move(counts)};
}

}  // namespace gatewalk::lattice
