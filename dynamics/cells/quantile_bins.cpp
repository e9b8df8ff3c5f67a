// SPDX-License-Identifier: MIT
#include "dynamics/cells/quantile_bins.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace gatewalk::dynamics {
namespace {

/// The number of bins along each of `coordinates` axes whose product is nearest to `states`.
int bins_per_axis(double states, std::size_t coordinates) {
  const auto half_of_product = [&](int bins) {
    double product = 0.5;
    for (std::size_t axis = 0; axis < coordinates; ++axis) product *= bins;
    return product;
  };
  int n = 1;
  while (half_of_product(n) + half_of_product(n + 1) <= states) ++n;
  return n;
}

/// The index nearest to `at` at which ascending `values` change, so that equal values stay
/// together; 0 or the end if none is nearer. If two are equally near: the lower one in the lower
/// half (side < 0), the upper one in the upper half, and none (0) in the middle, so mirrored data
/// have mirrored edges.
std::size_t between_values(const std::vector<double>& values, std::size_t at, int side) {
  const std::size_t n = values.size();
  if (at == 0 || at == n || values[at - 1] != values[at]) return at;
  const auto [low, high] = std::equal_range(values.begin(), values.end(), values[at]);
  const auto below = static_cast<std::size_t>(low - values.begin());
  const auto above = static_cast<std::size_t>(high - values.begin());
  if (at - below == above - at) return side < 0 ? below : side > 0 ? above : 0;
  return at - below < above - at ? below : above;
}

/// The edges of `bins` bins at the quantiles of `values` (not empty), the outermost at the
/// extremes. If all values are equal, the edges of `range`, widened to contain the value.
std::vector<double> quantile_edges(std::vector<double> values, int bins,
                                   const std::array<double, 2>& range) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  if (values.front() == values.back())
    return {std::min(range[0], values.front()), std::max(range[1], values.front())};
  std::vector<double> edges{values.front()};
  for (int i = 1; i < bins; ++i) {
    const int side = 2 * i - bins;
    const auto share = [&](int k) {
      return n * static_cast<std::size_t>(k) / static_cast<std::size_t>(bins);
    };
    const std::size_t at = between_values(values, side > 0 ? n - share(bins - i) : share(i), side);
    if (at == 0 || at == n) continue;
    const double edge = 0.5 * values[at - 1] + 0.5 * values[at];
    if (edge > edges.back() && edge < values.back()) edges.push_back(edge);
  }
  edges.push_back(values.back());
  return edges;
}

}  // namespace

void add_mirror_images(const Section& section, std::vector<Entry>& entries) {
  const std::size_t n = entries.size();
  entries.reserve(2 * n);
  for (std::size_t i = 0; i < n; ++i) entries.push_back(mirrored(section, entries[i]));
}

StateSpace quantile_space(const Section& section, const std::vector<Entry>& seen, int states,
                          const std::vector<Entry>& points) {
  if (states < 1 || states > kMostStates)
    throw std::invalid_argument("bins: " + std::to_string(states) +
                                " states are not permitted: must lie in [1, " +
                                std::to_string(kMostStates) + "]");
  const auto entries = static_cast<std::int64_t>(seen.size());
  const std::int64_t wanted = std::min<std::int64_t>(states, entries / kEntriesPerState);
  std::vector<std::vector<Entry>> at(section.faces.size());
  for (const Entry& c : seen) at[static_cast<std::size_t>(c.face)].push_back(c);
  const std::size_t coordinates = section.coordinates.size();
  std::vector<Bins> bins(section.faces.size());
  for (std::size_t f = 0; f < bins.size(); ++f) {
    const auto here = static_cast<double>(at[f].size());
    const int n = bins_per_axis(static_cast<double>(wanted) * here /
                                    static_cast<double>(std::max<std::int64_t>(1, entries)),
                                coordinates);
    for (std::size_t axis = 0; axis < coordinates; ++axis) {
      std::vector<double>& edges = bins[f].edges[axis];
      if (at[f].empty()) {
        const std::array<double, 2>& usual = usual_at(section, section.faces[f])[axis];
        edges = {usual[0], usual[1]};
        continue;
      }
      std::vector<double> values;
      for (const Entry& c : at[f]) values.push_back(c.at[axis]);
      edges = quantile_edges(std::move(values), n, section.faces[f].usual[axis]);
    }
  }
  return {section, std::move(bins), true, points};
}

bool Resolution::poor() const {
  if (entries == 0) return false;
  constexpr double kMostOutside = 0.5, kMostUnresolved = 0.9;
  return static_cast<double>(clamped) > kMostOutside * static_cast<double>(entries) ||
         *std::max_element(unresolved.begin(), unresolved.end()) > kMostUnresolved;
}

Resolution resolution_of(const StateSpace& space, const std::vector<Entry>& seen) {
  struct Group {  // sums over the entries of a state or face
    std::int64_t n = 0;
    // squares: of deviations from the mean (Welford)
    std::array<double, kMostCoordinates> mean{}, squares{};
    void add(const Entry& c, std::size_t coordinates) {
      ++n;
      for (std::size_t axis = 0; axis < coordinates; ++axis) {
        const double x = c.at[axis], before = x - mean[axis];
        mean[axis] += before / static_cast<double>(n);
        squares[axis] += before * (x - mean[axis]);
      }
    }
  };
  Resolution r;
  const std::size_t coordinates = space.section().coordinates.size();
  std::vector<Group> of_state(space.size()), of_face(space.section().faces.size());
  for (const Entry& c : seen) {
    const StateSpace::Index index = space.index_of(c);
    r.clamped += index.clamped;
    of_state[index.state].add(c, coordinates);
    of_face[static_cast<std::size_t>(c.face)].add(c, coordinates);
  }
  r.entries = static_cast<std::int64_t>(seen.size());
  std::sort(of_state.begin(), of_state.end(),
            [](const Group& a, const Group& b) { return a.n > b.n; });
  std::int64_t held = 0;
  for (const Group& g : of_state) {
    if (g.n == 0) break;
    if (10 * held < 9 * r.entries) ++r.states_of_90;
    held += g.n;
    ++r.states_entered;
  }
  for (std::size_t axis = 0; axis < coordinates; ++axis) {
    double within = 0.0, all = 0.0;
    for (const Group& g : of_state) within += g.squares[axis];
    for (const Group& g : of_face) all += g.squares[axis];
    r.unresolved[axis] = all > 0.0 ? within / all : 0.0;
  }
  return r;
}

}  // namespace gatewalk::dynamics
