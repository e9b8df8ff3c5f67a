// SPDX-License-Identifier: MIT
#include "cli/render/answer_page.h"

#include <zlib.h>

#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "cli/render/final_gates.h"
#include "cli/render/little_endian.h"
#include "cli/render/text.h"
#include "lattice/scene/gates.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

using Codes = std::vector<std::uint16_t>;

std::string base64(std::span<const unsigned char> bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < left ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= left ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// Numbers as base64 of their deflated bytes: all first bytes, then all second ones, ...
template <class Number>
std::string packed(const std::vector<Number>& numbers) {
  std::vector<unsigned char> bytes(numbers.size() * sizeof(Number));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const BytesOf<Number> one = little_endian(numbers[i]);
    for (std::size_t k = 0; k < sizeof(Number); ++k)
      bytes[k * numbers.size() + i] = static_cast<unsigned char>(one[k]);
  }
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<unsigned char> small(size);
  if (compress2(small.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), 9) != Z_OK)
    throw std::runtime_error("page: zlib cannot compress its numbers");
  return base64(std::span(small).first(size));
}

/// Shares by end (an ending or a gate) and place (a start's state, a cell): all places of an end
/// together.
struct ShareTable {
  Codes share, low, high;
  void add(double value, const std::array<double, 2>& interval) {
    share.push_back(share_code(value));
    low.push_back(share_code(interval[0]));
    high.push_back(share_code(interval[1]));
  }
  [[nodiscard]] Json json(bool intervals) const {
    Json json{{"share", packed(share)}};
    if (intervals) json.update({{"low", packed(low)}, {"high", packed(high)}});
    return json;
  }
};

/// What is known of a place: of a state, of a start, of a cell; nothing of those without runs.
struct Known {
  const lattice::EndingShares* endings;
  const markov::CellProbabilities* gates;
  const std::array<markov::CellProbabilities, 2>* gates_95;
};

ShareTable ending_table(const std::vector<Known>& places, bool back) {
  ShareTable table;
  for (const EndingName& e : kAllEndingNames) {
    if (e.ending == lattice::kWentBack.ending && !back) continue;
    const auto at = static_cast<std::size_t>(e.ending);
    for (const Known& k : places) {
      if (k.gates->size() == 0)
        table.add(kUnknown, {kUnknown, kUnknown});
      else
        table.add(k.endings->share[at], k.endings->interval[at]);
    }
  }
  return table;
}

ShareTable gate_table(const std::vector<Known>& places, Eigen::Index cells) {
  ShareTable table;
  for (Eigen::Index cell = 0; cell < cells; ++cell)
    for (const Known& k : places) {
      const bool known = k.gates->size() > 0,
                 bars = known && k.gates_95 && (*k.gates_95)[0].size() > 0;
      table.add(known ? k.gates->data()[cell] : kUnknown,
                {bars ? (*k.gates_95)[0].data()[cell] : kUnknown,
                 bars ? (*k.gates_95)[1].data()[cell] : kUnknown});
    }
  return table;
}

Json section_json(const dynamics::Section& section) {
  Json json;
  for (const dynamics::Face& f : section.faces)
    json["faces"].push_back({{"name", f.name}, {"origin", f.origin}, {"move", {f.di_x, f.di_y}}});
  for (const dynamics::Coordinate& c : section.coordinates)
    json["coordinates"].push_back(
        {{"name", c.name}, {"key", c.key}, {"unit", c.unit}, {"words", c.words}});
  return json;
}

/// How a start's state is found.
Json states_json(const AnswerPage& page) {
  const dynamics::StateSpace& space = page.space;
  const std::size_t coordinates = space.section().coordinates.size();
  Json faces = Json::array();
  for (const int face : page.faces) {
    const auto at = static_cast<std::size_t>(face);
    Json one{{"face", face}, {"first", space.first(face)}};
    std::array<std::vector<double>, dynamics::kMostCoordinates> seen;
    if (space.has_trees()) {
      std::vector<std::int8_t> axis;
      std::vector<double> cut;
      for (const dynamics::Tree::Node& n : space.trees()[at].nodes) {
        axis.push_back(static_cast<std::int8_t>(n.axis));
        if (n.axis != dynamics::Tree::kLeaf) cut.push_back(n.cut);
      }
      one["axis"] = packed(axis);
      one["cut"] = packed(cut);
      for (std::size_t c = 0; c < coordinates; ++c)
        one["seen"].push_back(space.trees()[at].seen[c]);
    } else {
      for (std::size_t c = 0; c < coordinates; ++c) {
        const std::vector<double>& edges = space.bins()[at].edges[c];
        one["edges"].push_back(edges);
        one["seen"].push_back({edges.front(), edges.back()});
      }
    }
    faces.push_back(std::move(one));
  }
  std::vector<std::int32_t> of_leaf(page.states.of_leaf.begin(), page.states.of_leaf.end()), runs;
  for (const lattice::StartState& s : page.states.states)
    runs.push_back(static_cast<std::int32_t>(s.runs));
  return {{"faces", faces},
          {"open", space.open()},
          {"of_leaf", packed(of_leaf)},
          {"count", page.states.states.size()},
          {"runs", packed(runs)},
          {"joined_for", page.states.least_runs}};
}

Json drawn_gate(const lattice::Scene& scene) {
  const lattice::FieldGates gates = lattice::gates_of(scene);
  Json json{{"radius_m", scene.gate.body.radius},
            {"joint_x_m", scene.gate.beams.joint_x},
            {"joint_y_m", scene.gate.beams.joint_y},
            {"propulsion_N", scene.gate.forces.propulsion}};
  for (const dynamics::GateParams& type : gates.types())
    json["beam_m"].push_back(type.beams.length);
  return json;
}

Json cells_json(const AnswerPage& page, Eigen::Index cells, bool back) {
  std::vector<Known> places;
  Json visits = Json::array();
  ShareTable next;
  for (const lattice::CellAhead& a : page.cells) {
    places.push_back({&a.endings, &a.gates, nullptr});
    visits.push_back({a.visits.mean, a.visits.interval[0], a.visits.interval[1]});
  }
  for (std::size_t move = 0; move <= page.moves.size(); ++move)
    for (const lattice::CellAhead& a : page.cells) {
      if (a.next.empty())
        next.add(kUnknown, {kUnknown, kUnknown});
      else
        next.add(a.next[move].mean, a.next[move].interval);
    }
  return {{"visits", visits},
          {"moves", page.moves},
          {"next", next.json(true)},
          {"endings", ending_table(places, back).json(true)},
          {"gates", gate_table(places, cells).json(false)}};
}

}  // namespace

std::uint16_t share_code(double share) {
  constexpr std::uint16_t kSmall = 10'001, kDigits = 90, kNone = 65'535;
  if (std::isnan(share)) return kNone;
  if (!(share > 0.0 && share < 5e-5))
    return static_cast<std::uint16_t>(
        std::lround(100.0 * lattice::number_of(fixed(100.0 * share, 2))));
  const std::string text = scientific(100.0 * share, 1);  // "6.9e-04", 5.0e-03 at most
  const int digits = (text[0] - '0') * 10 + (text[2] - '0'), power = -std::stoi(text.substr(4));
  return static_cast<std::uint16_t>(kSmall + (power - 3) * kDigits + digits - 10);
}

Json to_json(const AnswerPage& page, bool gates_95) {
  const lattice::FieldParams& field = page.shown.field;
  const Eigen::Index cells = Eigen::Index{field.columns} * field.rows;
  std::vector<Known> places;
  for (const lattice::StartState& s : page.states.states)
    places.push_back({&s.endings, &s.gates, &s.gates_95});
  std::vector<lattice::EndingShares> told;
  told.reserve(page.starts.size());
  Json starts = Json::array();
  for (const PageStart& s : page.starts) {
    told.push_back(shown_endings(s.endings, s.final));
    places.push_back({&told.back(), &s.final.final_cells, &s.gates_95});
    Json one{{"start", to_json(page.shown.map.section, s.start)},
             {"answer_from", s.from},
             {"error_95", s.error_95},
             {"first_runs", s.first_runs}};
    one["face"] = s.start ? s.start->face : 0;
    if (s.start)
      for (std::size_t c = 0; c < page.shown.map.section.coordinates.size(); ++c)
        one["at"].push_back(s.start->at[c]);
    starts.push_back(std::move(one));
  }
  const auto back_at = static_cast<std::size_t>(lattice::kWentBack.ending);
  bool back = false;
  for (const Known& k : places)
    back = back || (k.gates->size() > 0 && k.endings->share[back_at] > 0.0);
  Json names = Json::array();
  for (const EndingName& e : kAllEndingNames)
    if (back || e.ending != lattice::kWentBack.ending)
      names.push_back({{"key", e.key}, {"name", e.name}});

  Json json{{"title", page.title},
            {"columns", field.columns},
            {"rows", field.rows},
            {"start_column", field.start_column()},
            {"max_gates", field.max_gates},
            {"cell_m", {page.shown.width, page.shown.length}},
            {"time_limit_s", page.shown.time_limit},
            {"section", section_json(page.shown.map.section)},
            {"endings", names},
            {"states", states_json(page)},
            {"starts", starts},
            {"answers",
             {{"endings", ending_table(places, back).json(true)},
              {"gates", gate_table(places, cells).json(gates_95)}}},
            {"cells", cells_json(page, cells, back)},
            {"chain", page.chain},
            {"analysis", page.analysis}};
  if (page.scene) json["gate"] = drawn_gate(*page.scene);
  if (!page.shown.types.empty()) {
    json["types"] = page.shown.types;
    json["type_of_gate"] = page.shown.map.type_of_cell;
  }
  if (!gates_95)
    json["left_out"] = "intervals of single gates, with which the page would be too large";
  return json;
}

}  // namespace gatewalk::cli
