// SPDX-License-Identifier: MIT
#include "lattice/field/matrix_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <stdexcept>
#include <vector>

#include "lattice/field/gate_chain.h"

namespace gatewalk::lattice {

using namespace dynamics;

namespace {

std::string edges_array(const Face& face, const Coordinate& coordinate) {
  return face.name + "_" + coordinate.name + "_edges";
}

// Names of the arrays of a face's tree. Axes and cuts are by node, in preorder; `seen` has low and
// high by coordinate. The many trees of a chain with words follow each other in the same arrays.
std::string tree_array(const std::string& face, const std::string& name) {
  return face + "_tree_" + name;
}
constexpr const char *kTreeAxis = "axis", *kTreeCut = "cut", *kTreeSeen = "seen";
constexpr const char* kAllFaces = "all";

/// The trees that share arrays: their name, and the number of the first one.
struct TreeArrays {
  std::string name;
  std::size_t first, count;
};
std::vector<TreeArrays> tree_arrays(const Section& section) {
  if (section.words) return {{kAllFaces, 0, section.faces.size()}};
  std::vector<TreeArrays> arrays;
  for (const Face& face : section.faces) arrays.push_back({face.name, arrays.size(), 1});
  return arrays;
}

// Only files of an open space have kOpenBins, only those of a space with points kPointBoundary.
constexpr const char* kOpenBins = "outermost_bins_are_open";
constexpr const char* kPointBoundary = "point_boundary";

std::string point_array(const Coordinate& coordinate) { return "point_" + coordinate.name; }

const std::vector<double>* find_array(const markov::CountsFile& in, const std::string& name) {
  for (const auto& array : in.arrays)
    if (array.name == name) return &array.values;
  return nullptr;
}

std::vector<Entry> points_in(const markov::CountsFile& in, const Section& section,
                             const std::string& path) {
  const std::vector<double>* const boundary = find_array(in, kPointBoundary);
  if (!boundary) return {};
  std::vector<Entry> points(boundary->size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double b = (*boundary)[i];
    if (!(b >= 0.0 && b < static_cast<double>(section.faces.size()) && b == std::floor(b)))
      throw markov::BadFile(path + ": " + kPointBoundary + " names no boundary");
    points[i].face = static_cast<int>(b);
  }
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    const std::string name = point_array(section.coordinates[axis]);
    const std::vector<double>* const values = find_array(in, name);
    if (!values || values->size() != points.size())
      throw markov::BadFile(path + ": " + name + " does not belong to " + kPointBoundary);
    for (std::size_t i = 0; i < points.size(); ++i) points[i].at[axis] = (*values)[i];
  }
  return points;
}

void add_trees(markov::CountsFile& out, const Section& section, const TreeArrays& of,
               const std::vector<Tree>& trees) {
  const std::string states = section.words
                                 ? "the tree of one face after the other, numbered as state_face"
                                 : "states are the leaves of " + names_of(section.faces);
  const auto add = [&](const std::string& name, const std::string& unit, const std::string& meaning,
                       std::vector<double> values) {
    out.arrays.push_back({tree_array(of.name, name), unit,
                          of.name + ": " + meaning + "; nodes in preorder, " + states,
                          std::move(values)});
    if (name != kTreeSeen) out.arrays.back().dimension = tree_array(of.name, "node");
    out.arrays.back().whole = name == kTreeAxis;
  };
  std::vector<double> axis, cut, seen;
  std::string sides;
  for (std::size_t k = 0; k < section.coordinates.size(); ++k) {
    const Coordinate& c = section.coordinates[k];
    sides += k == 0 ? c.name + " low, " + c.name + " high" : ", " + c.name;
  }
  for (std::size_t t = of.first; t < of.first + of.count; ++t) {
    for (const Tree::Node& node : trees[t].nodes) {
      axis.push_back(node.axis);
      cut.push_back(node.cut);
    }
    for (std::size_t k = 0; k < section.coordinates.size(); ++k)
      seen.insert(seen.end(), trees[t].seen[k].begin(), trees[t].seen[k].end());
  }
  add(kTreeAxis, "1",
      "axis of each node's cut: " + numbers_of(section.coordinates) +
          "; -1: a leaf, which is a state",
      std::move(axis));
  add(kTreeCut, "", "place of each node's cut, in the unit of its axis", std::move(cut));
  add(kTreeSeen, "", "between what entries were seen, in their units: " + sides, std::move(seen));
}

/// Adds the trees in these arrays to `trees`.
void read_trees(const markov::CountsFile& in, const Section& section, const TreeArrays& of,
                const std::string& path, std::vector<Tree>& trees) {
  const auto find = [&](const char* name) -> const std::vector<double>& {
    if (const auto* values = find_array(in, tree_array(of.name, name))) return *values;
    throw markov::BadFile(path + ": no " + tree_array(of.name, name));
  };
  const std::vector<double>&axis = find(kTreeAxis), &cut = find(kTreeCut), &seen = find(kTreeSeen);
  const std::size_t coordinates = section.coordinates.size();
  const auto misfit = [&] {
    return markov::BadFile(path + ": tables of the tree of " + of.name + " do not fit each other");
  };
  if (axis.size() != cut.size() || seen.size() != 2 * coordinates * of.count) throw misfit();
  std::size_t at = 0;
  for (std::size_t t = 0; t < of.count; ++t) {
    Tree& tree = trees.emplace_back();
    tree.nodes.clear();
    // A tree ends with its last leaf: each cut opens one more part.
    for (int open = 1; open > 0; ++at) {
      if (at == axis.size()) throw misfit();
      if (!(axis[at] >= Tree::kLeaf && axis[at] < static_cast<double>(coordinates) &&
            axis[at] == std::floor(axis[at])))
        throw markov::BadFile(path + ": " + tree_array(of.name, kTreeAxis) + " names no axis");
      tree.nodes.push_back({static_cast<int>(axis[at]), cut[at]});
      open += axis[at] == Tree::kLeaf ? -1 : 1;
    }
    for (std::size_t k = 0; k < 2 * coordinates; ++k)
      tree.seen[k / 2][k % 2] = seen[2 * coordinates * t + k];
  }
  if (at != axis.size()) throw misfit();
}

StateSpace bins_in(const markov::CountsFile& in, const Section& section, const std::string& path) {
  std::vector<Bins> bins;
  for (const Face& face : section.faces) {
    auto& edges = bins.emplace_back().edges;
    for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
      const std::string name = edges_array(face, section.coordinates[axis]);
      if (const auto* values = find_array(in, name)) edges[axis] = *values;
      if (edges[axis].empty()) throw markov::BadFile(path + ": no bin edges " + name);
    }
  }
  return {section, std::move(bins), find_array(in, kOpenBins) != nullptr,
          points_in(in, section, path)};
}

StateSpace trees_in(const markov::CountsFile& in, const Section& section, const std::string& path) {
  std::vector<Tree> trees;
  for (const TreeArrays& of : tree_arrays(section)) read_trees(in, section, of, path, trees);
  return {section, std::move(trees), points_in(in, section, path)};
}

void add_bins(markov::CountsFile& out, const Section& section, const Face& face, const Bins& bins) {
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    const Coordinate& c = section.coordinates[axis];
    out.arrays.push_back({edges_array(face, c), c.unit,
                          face.name + ": bin edges of the " + c.words + "; states are numbered " +
                              names_of(section.faces) + ", within each by " +
                              names_of(section.coordinates, ", then "),
                          bins.edges[axis]});
  }
}

// Names of the arrays of costs: sums over the runs behind each count, in the order of the counts.
constexpr const char* kCountCosts = "count_";
std::string cost_array(const CostInfo& cost, bool squares, const std::string& type) {
  return kCountCosts + cost.key + (squares ? "_squared" : "") + (type.empty() ? "" : "_of_" + type);
}

void add_costs(markov::CountsFile& out, const Transitions& t, const std::string& type) {
  const std::vector<CostInfo>& costs = t.space.section().costs;
  std::vector<std::array<std::vector<double>, 2>> tables(costs.size());
  for (std::size_t row = 0; row < t.rows.size(); ++row) {
    if (t.costs[row].size() != t.rows[row].size()) return;
    for (const auto& [column, sums] : t.costs[row])
      for (std::size_t c = 0; c < costs.size(); ++c) {
        tables[c][0].push_back(sums.sum[c]);
        tables[c][1].push_back(sums.squares[c]);
      }
  }
  for (std::size_t c = 0; c < costs.size(); ++c)
    for (const bool squares : {false, true}) {
      const std::string& unit = costs[c].unit;
      out.arrays.push_back({cost_array(costs[c], squares, type), squares ? "(" + unit + ")2" : unit,
                            std::string(squares ? "sum of squares" : "sum") + " over the runs of " +
                                "each count: " + costs[c].words,
                            std::move(tables[c][squares])});
      if (type.empty()) out.arrays.back().dimension = "nonzero";
    }
}

void read_costs(const markov::CountsFile& in, const std::string& type, const std::string& path,
                Transitions& t) {
  const std::vector<CostInfo>& costs = t.space.section().costs;
  std::vector<std::array<const std::vector<double>*, 2>> tables(costs.size());
  std::size_t counts = 0, missing = 0;
  for (const auto& row : t.rows) counts += row.size();
  for (std::size_t c = 0; c < costs.size(); ++c)
    for (const bool squares : {false, true}) {
      const std::string name = cost_array(costs[c], squares, type);
      const auto* const table = tables[c][squares] = find_array(in, name);
      missing += table == nullptr;
      if (table != nullptr && table->size() != counts)
        throw markov::BadFile(path + ": " + name + " does not belong to the counts");
    }
  if (missing == 2 * costs.size()) return;  // files of older versions have no costs
  if (missing > 0) throw markov::BadFile(path + ": some tables of what runs took are missing");
  std::size_t at = 0;
  for (std::size_t row = 0; row < t.rows.size(); ++row)
    for (const auto& [column, n] : t.rows[row]) {
      CostSums& sums = t.costs[row][column];
      for (std::size_t c = 0; c < costs.size(); ++c) {
        sums.sum[c] = (*tables[c][0])[at];
        sums.squares[c] = (*tables[c][1])[at];
      }
      ++at;
    }
}

// Arrays that describe the states to readers that know no trees and bins; read_matrix ignores them.
constexpr const char* kStates = "state_";

void add_states(markov::CountsFile& out, const StateSpace& space) {
  const Section& section = space.section();
  const auto add = [&](const std::string& name, const std::string& unit,
                       const std::string& meaning) {
    out.arrays.push_back({kStates + name, unit, meaning, {}, "input_state"});
    return out.arrays.size() - 1;
  };
  const std::size_t face = add("face", "1", "face by which bodies of each state enter");
  out.arrays[face].whole = true;
  for (const Face& f : section.faces) out.arrays[face].codes.push_back(f.name);
  for (int s = 0; s < space.size(); ++s) out.arrays[face].values.push_back(space.face(s));
  for (std::size_t c = 0; c < section.coordinates.size(); ++c)
    for (const std::size_t side : {0, 1}) {
      const Coordinate& coordinate = section.coordinates[c];
      const std::size_t at = add(
          coordinate.name + (side == 0 ? "_low" : "_high"), coordinate.unit,
          std::string(side == 0 ? "least " : "greatest ") + coordinate.words + " of each state");
      for (int s = 0; s < space.size(); ++s)
        out.arrays[at].values.push_back(space.range(s).at[c][side]);
    }
}

/// The arrays that do not belong to the state space, nor to the costs.
std::vector<markov::NamedArray> others_in(std::vector<markov::NamedArray> arrays,
                                          const Section& section) {
  std::set<std::string> own{kOpenBins, kPointBoundary, std::string(kStates) + "face"};
  for (const Coordinate& c : section.coordinates)
    own.insert({point_array(c), kStates + c.name + "_low", kStates + c.name + "_high"});
  for (const Face& face : section.faces)
    for (const Coordinate& c : section.coordinates) own.insert(edges_array(face, c));
  for (const TreeArrays& of : tree_arrays(section))
    for (const char* name : {kTreeAxis, kTreeCut, kTreeSeen}) own.insert(tree_array(of.name, name));
  std::erase_if(arrays, [&](const markov::NamedArray& a) {
    return own.contains(a.name) || a.name.starts_with(kCountCosts);
  });
  return arrays;
}

}  // namespace

namespace {

markov::RowCounts row_counts(const Transitions& t) { return {t.counts(), t.trials, t.clamped}; }

Transitions transitions_of(const StateSpace& space, const markov::RowCounts& in) {
  Transitions t(space);
  for (int row = 0; row < space.size(); ++row)
    for (markov::Counts::InnerIterator it(in.counts, row); it; ++it)
      t.rows[row][static_cast<int>(it.col())] = it.value();
  t.trials = in.trials;
  t.clamped = in.clamped;
  return t;
}

}  // namespace

std::vector<std::string> state_names(const StateSpace& space) {
  std::vector<std::string> names;
  for (int s = 0; s < space.size(); ++s)
    names.push_back(space.section().faces[static_cast<std::size_t>(space.face(s))].name + "_" +
                    std::to_string(s));
  names.emplace_back("trapped");
  return names;
}

std::vector<std::string> state_names(const MatrixFile& file) {
  return file.state_names.empty() ? state_names(file.transitions.space) : file.state_names;
}

void name_states(MatrixFile& file, std::vector<std::string> names) {
  file.state_names = std::move(names);
  const StateSpace& space = file.transitions.space;
  Section section = space.section();
  if (space.has_trees() || section.coordinates.size() > 1) return;
  const auto numbers = std::find_if(file.arrays.begin(), file.arrays.end(),
                                    [](const auto& array) { return array.name == kNumberOfState; });
  section.named.clear();
  std::set<double> taken;
  for (int s = 0; s < space.size(); ++s) {
    const dynamics::StateRange range = space.range(s);
    const auto& [from, to] = range.at[0];
    const auto at = static_cast<std::size_t>(s);
    section.named.push_back({range.face, from, to, file.state_names[at], s});
    if (numbers == file.arrays.end()) continue;
    const double number = at < numbers->values.size() ? numbers->values[at] : -1.0;
    if (!(number >= 0.0 && number < space.size()) || number != std::floor(number) ||
        !taken.insert(number).second)
      throw std::invalid_argument(std::string(kNumberOfState) + " must number the states from 0");
    section.named.back().number = static_cast<int>(number);
  }
  file.transitions.space = {std::move(section), space.bins(), space.open(), space.points()};
}

int shown_number(const StateSpace& space, int state) {
  const std::vector<dynamics::NamedEntries>& named = space.section().named;
  return state < std::ssize(named) ? named[static_cast<std::size_t>(state)].number : state;
}

std::vector<int> shown_order(const StateSpace& space) {
  std::vector<int> order(static_cast<std::size_t>(space.size()));
  for (int s = 0; s < space.size(); ++s)
    order[static_cast<std::size_t>(shown_number(space, s))] = s;
  return order;
}

std::vector<std::int64_t> counts_per_run(const MatrixFile& file) {
  std::vector<std::int64_t> all;
  for (const markov::NamedArray& array : file.arrays)
    if (array.name == kCountsPerRun && std::ssize(array.values) == file.transitions.space.size())
      for (const double n : array.values) all.push_back(n > 1.0 ? 2 : 1);
  return all;
}

std::optional<dynamics::Entry> named_state(const MatrixFile& file, const std::string& text) {
  const dynamics::StateSpace& space = file.transitions.space;
  for (int s = 0; s < std::ssize(space.section().named); ++s) {
    const dynamics::NamedEntries& state = space.section().named[static_cast<std::size_t>(s)];
    if (text != state.name && text != std::to_string(state.number)) continue;
    dynamics::Entry entry{space.face(s)};
    entry.at[0] = state.number;
    return entry;
  }
  return {};
}

std::string comment_on_counts(const CellMap& map, const StateSpace& space) {
  const bool any = std::any_of(map.types.begin(), map.types.end(),
                               [](const CellMap::Type& type) { return type.symmetric; });
  if (!space.has_trees() || !any) return "";
  return "count: a run of a gate that is its own mirror image is counted twice, as it was and as "
         "its mirror image: a posterior from these counts would be too narrow by the square root "
         "of 2. "
         "Rows with few runs are those of several neighbouring states together. run_* has each run "
         "once.";
}

namespace {

/// Writes a matrix file with these arrays in place of its own.
void write_matrix(const std::string& path, const MatrixFile& file,
                  std::vector<markov::NamedArray> arrays) {
  const Transitions& t = file.transitions;
  markov::CountsFile out;
  static_cast<markov::RowCounts&>(out) = row_counts(t);
  add_costs(out, t, "");
  for (const auto& [name, of_type] : file.types) {
    out.types.emplace(name, row_counts(of_type));
    add_costs(out, of_type, name);
  }
  out.exits = exits_of(t.space);
  add_states(out, t.space);
  out.state_names = state_names(file);
  std::move(arrays.begin(), arrays.end(), std::back_inserter(out.arrays));
  const Section& section = t.space.section();
  if (t.space.has_trees())
    for (const TreeArrays& of : tree_arrays(section)) add_trees(out, section, of, t.space.trees());
  else
    for (std::size_t f = 0; f < section.faces.size(); ++f)
      add_bins(out, section, section.faces[f], t.space.bins()[f]);
  if (t.space.open() && !t.space.has_trees())
    out.arrays.push_back(
        {kOpenBins, "1", "the outermost bins take what lies beyond their edges", {1.0}});
  if (!t.space.points().empty()) {
    std::vector<double> boundary;
    for (const Entry& c : t.space.points()) boundary.push_back(c.face);
    const std::string meaning = "entries that are states of their own, numbered after all bins";
    out.arrays.push_back({kPointBoundary, "1", meaning, boundary, "point", true});
    for (const Face& face : section.faces) out.arrays.back().codes.push_back(face.name);
    for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
      std::vector<double> values;
      for (const Entry& c : t.space.points()) values.push_back(c.at[axis]);
      const Coordinate& c = section.coordinates[axis];
      out.arrays.push_back({point_array(c), c.unit, meaning, std::move(values), "point"});
    }
  }
  out.text = file.text;
  markov::write_counts(path, out);
}

}  // namespace

void write_matrix(const std::string& path, const MatrixFile& file) {
  write_matrix(path, file, file.arrays);
}

void write_matrix(const std::string& path, MatrixFile&& file) {
  write_matrix(path, file, std::move(file.arrays));
}

MatrixFile read_matrix(const std::string& path, const SectionOf& section_of) {
  if (path == "-")
    throw markov::BadFile(
        "-: a matrix is not read from standard input: give the file that gatewalk build wrote");
  const markov::CountsFile in = [&] {
    try {
      return markov::read_counts(path);
    } catch (const markov::BadChecksum& e) {
      const std::string found = markov::diagnose_counts(path);
      throw markov::BadFile(e.what() + (found.empty() ? "" : "; " + found));
    } catch (const markov::BadFile& e) {
      const bool table = path.ends_with(".csv");
      if (!table && !path.ends_with(".toml")) throw;
      throw markov::BadFile(
          std::string(e.what()) +
          (table ? ", but a table by its name; of recorded runs gatewalk build TABLE --cell "
                   "CELL.toml makes a matrix"
                 : ", but a scene by its name; gatewalk build makes a matrix of one"));
    }
  }();
  try {
    const Section section = section_of(in.text);
    const bool has_trees =
        find_array(in, tree_array(tree_arrays(section).front().name, kTreeAxis)) != nullptr;
    const StateSpace space = has_trees ? trees_in(in, section, path) : bins_in(in, section, path);
    if (space.size() != in.counts.rows())
      throw markov::BadFile(path + ": its state space makes " + std::to_string(space.size()) +
                            " states, the counts have " + std::to_string(in.counts.rows()) +
                            " rows");
    if (in.exits != exits_of(space))
      throw markov::BadFile(path + ": exits are not those of its states");
    MatrixFile file{transitions_of(space, in), in.text, others_in(in.arrays, section)};
    if (in.state_names != state_names(space) || find_array(in, kNumberOfState))
      name_states(file, in.state_names);
    read_costs(in, "", path, file.transitions);
    for (const auto& [name, of_type] : in.types) {
      const auto at = file.types.emplace(name, transitions_of(space, of_type)).first;
      read_costs(in, name, path, at->second);
    }
    return file;
  } catch (const std::invalid_argument& e) {
    throw markov::BadFile(path + ": " + e.what());
  }
}

}  // namespace gatewalk::lattice
