// SPDX-License-Identifier: MIT
#include "lattice/field/gate_chain.h"

#include "lattice/statistics/matrix_noise.h"

namespace gatewalk::lattice {

using namespace dynamics;

std::vector<markov::Exit> exits_of(const StateSpace& space) {
  std::vector<markov::Exit> exits(space.size() + 1);
  for (int state = 0; state < space.size(); ++state) {
    const Face& face = space.section().faces[space.face(state)];
    exits[state] = {state, face.di_x, face.di_y};
  }
  return exits;  // the last exit is a default Exit: trapped
}

markov::Chain make_chain(const Transitions& t) {
  return markov::Chain::from_counts(t.counts(), exits_of(t.space));
}

markov::FieldChain field_chain(const CellMap& map, std::vector<markov::Chain> chains) {
  if (map.type_of_cell.empty()) return {std::move(chains.front())};
  return markov::FieldChain::by_cell(std::move(chains), map.columns, map.type_of_cell);
}

markov::FieldChain make_chain(const CellMap& map, const std::vector<Transitions>& matrices) {
  std::vector<markov::Chain> chains;
  for (const Transitions& t : matrices) chains.push_back(make_chain(t));
  return field_chain(map, std::move(chains));
}

CountedField counted_field(const CellMap& map, const std::vector<dynamics::Transitions>& matrices) {
  CountedField field{make_chain(map, matrices), {}, matrices.front().space.has_trees()};
  for (const dynamics::Transitions& t : matrices) field.counts.push_back(t.counts());
  if (!field.small_rows) return field;  // matrices of bins count no mirror images
  for (std::size_t m = 0; m < matrices.size(); ++m) {
    const dynamics::StateSpace& space = matrices[m].space;
    auto& images = field.images.emplace_back(static_cast<std::size_t>(space.size()), 1);
    if (!map.types[m].symmetric) continue;
    for (int row = 0; row < space.size(); ++row) {
      const int point = row - (space.size() - static_cast<int>(space.points().size()));
      if (point >= 0) {
        const dynamics::Entry& entry = space.points()[static_cast<std::size_t>(point)];
        if (dynamics::mirrored(space.section(), entry) != entry) continue;
      }
      images[static_cast<std::size_t>(row)] = 2;
    }
  }
  return field;
}

CountedField counted_field(const dynamics::Transitions& matrix) {
  return {make_chain(matrix), {matrix.counts()}, matrix.space.has_trees()};
}

ChainStart chain_start(const StateSpace& space, const FieldParams& field, const Entry& entry) {
  const auto index = space.index_of(entry);
  return {{field.start_column(), field.start_row, index.state}, index.clamped, index.beyond};
}

}  // namespace gatewalk::lattice
