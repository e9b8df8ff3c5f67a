// SPDX-License-Identifier: MIT
#include "cli/render/answer_page.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "cli/fields/text.h"
#include "cli/render/final_gates.h"
#include "cli/render/little_endian.h"
#include "lattice/gates/gates.h"
#include "lattice/scene/terrain.h"
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

/// Numbers as base64 of deflated bytes. The bytes are transposed: first all first bytes, then all
/// second bytes, ..., which compresses better.
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

/// Shares by end (an ending or a gate) and place (a start's state, a cell). All places of an end
/// stand together.
struct ShareTable {
  Codes share, low, high;
  void add(double value, const std::array<double, 2>& interval) {
    share.push_back(share_code(value));
    low.push_back(share_code(interval[0]));
    high.push_back(share_code(interval[1]));
  }
};

void describe(Fields& out, const Label& l, const ShareTable& table, bool intervals = true) {
  out.object(l, [&](Fields& f) {
    f.text({"share", "shares, all places of an end together"}, packed(table.share));
    f.optional(intervals, [&](Fields& bars) {
      bars.text({"low", "from where their 95 % intervals go"}, packed(table.low));
      bars.text({"high", "to where these go"}, packed(table.high));
    });
  });
}

/// The answers for a place (a state, a start or a cell); places without runs are left out.
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

void describe_section(Fields& out, const dynamics::Section& section) {
  out.object({"section", "how bodies enter a cell"}, [&](Fields& of) {
    of.list({"faces", "by which faces"}, section.faces, [](Fields& f, const dynamics::Face& face) {
      f.text({"name", "of the face"}, face.name);
      f.text({"origin", "from where bodies come"}, face.origin);
      f.counts({"move", "1", "columns and rows of the move by which it is entered"},
               {face.di_x, face.di_y});
    });
    of.list({"coordinates", "what tells one entry from another"}, section.coordinates,
            [](Fields& f, const dynamics::Coordinate& c) {
              f.text({"name", "of the coordinate"}, c.name);
              f.text({"key", "in results"}, c.key);
              f.text({"unit", "its unit"}, c.unit);
              f.text({"words", "what it is"}, c.words);
            });
  });
}

/// How the page finds the state of a start through this face.
void describe_face(Fields& out, const dynamics::StateSpace& space, int face) {
  const auto at = static_cast<std::size_t>(face);
  const std::size_t coordinates = space.section().coordinates.size();
  std::vector<Interval> seen;
  out.count({"face", "1", "its number, from 0"}, face);
  out.count({"first", "1", "number of its first leaf or bin"}, space.first(face));
  if (space.has_trees()) {
    const dynamics::Tree& tree = space.trees()[at];
    std::vector<std::int8_t> axis;
    std::vector<double> cut;
    for (const dynamics::Tree::Node& n : tree.nodes) {
      axis.push_back(static_cast<std::int8_t>(n.axis));
      if (n.axis != dynamics::Tree::kLeaf) cut.push_back(n.cut);
    }
    out.text({"axis", "coordinate that each node of its tree cuts; -1: a leaf"}, packed(axis));
    out.text({"cut", "where each node that is no leaf cuts"}, packed(cut));
    seen.assign(tree.seen.begin(), tree.seen.begin() + static_cast<std::ptrdiff_t>(coordinates));
  } else {
    NumberRows edges;
    for (std::size_t c = 0; c < coordinates; ++c) {
      edges.push_back(space.bins()[at].edges[c]);
      seen.push_back({edges.back().front(), edges.back().back()});
    }
    out.number_rows({"edges", "its own", "edges of the bins of each coordinate"}, edges);
  }
  out.points({"seen", "its own", "from where to where each coordinate was seen"}, seen);
}

/// How the page finds the state of a start.
void describe_states(Fields& out, const AnswerPage& page) {
  std::vector<std::int32_t> of_leaf(page.states.of_leaf.begin(), page.states.of_leaf.end()), runs;
  for (const lattice::StartState& s : page.states.states)
    runs.push_back(static_cast<std::int32_t>(s.runs));
  out.object({"states", "states in which bodies start"}, [&](Fields& f) {
    f.list({"faces", "by which starts may be"}, page.faces,
           [&](Fields& one, int face) { describe_face(one, page.space, face); });
    f.flag({"open", "whether the outermost states go on without end"}, page.space.open());
    f.text({"of_leaf", "number of each leaf's state; -1: it has none"}, packed(of_leaf));
    f.count({"count", "1", "number of states"}, page.states.states.size());
    f.text({"runs", "gate runs behind each of them"}, packed(runs));
    f.count({"joined_for", "1", "gate runs that states were joined for"}, page.states.least_runs);
  });
}

void describe_gate(Fields& out, const lattice::Scene& scene) {
  std::vector<double> beams;
  for (const lattice::FieldGates gates = lattice::gates_of(scene);
       const dynamics::GateParams& type : gates.types())
    beams.push_back(type.beams.length);
  out.object({"gate", "what is drawn to scale"}, [&](Fields& f) {
    f.number({"radius_m", "m", "radius of the body"}, scene.gate.body.radius);
    f.number({"joint_x_m", "m", "place of the right joint; the left one is at -x"},
             scene.gate.beams.joint_x);
    f.number({"joint_y_m", "m", "place of both joints"}, scene.gate.beams.joint_y);
    f.number({"propulsion_N", "N", "propulsion"}, scene.gate.forces.propulsion);
    f.numbers({"beam_m", "m", "length of a beam of each type"}, beams);
  });
}

void describe_cells(Fields& out, const AnswerPage& page, Eigen::Index cells, bool back) {
  std::vector<Known> places;
  NumberRows visits;
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
  markov::CellCounts moves(static_cast<Eigen::Index>(page.moves.size()), 2);
  for (Eigen::Index move = 0; move < moves.rows(); ++move)
    for (Eigen::Index axis = 0; axis < 2; ++axis)
      moves(move, axis) =
          page.moves[static_cast<std::size_t>(move)][static_cast<std::size_t>(axis)];
  out.object({"cells", "what becomes of bodies from each cell"}, [&](Fields& f) {
    f.number_rows({"visits", "1", "mean visits of a body to each cell, from and to in 95 %"},
                  visits);
    f.grid({"moves", "1", "columns and rows of each move out of a cell"}, moves);
    describe(f, {"next", "by move, and trapped here"}, next);
    describe(f, {"endings", "by ending"}, ending_table(places, back));
    describe(f, {"gates", "by final gate"}, gate_table(places, cells), false);
  });
}

void describe(Fields& out, const PageAnswer& s, const dynamics::Section& section) {
  describe_start(out, section, s.start);
  out.text(Label("answer_from", "what the answer is from").one_of({"chain", "trials", "matrix"}),
           s.from);
  out.number({"error_95", "1", "95 % of its total variation from the whole truth are below"},
             s.error_95);
  out.count({"first_runs", "1", "gate runs of the start's own"}, s.first_runs);
  out.count({"face", "1", "number of the face that is entered, from 0"},
            s.start ? s.start->face : 0);
  out.optional(s.start.has_value(), [&](Fields& f) {
    const dynamics::Entry entry = s.start.value_or(dynamics::Entry());
    const auto n = static_cast<std::ptrdiff_t>(section.coordinates.size());
    f.numbers({"at", "its own", "its coordinates"}, {entry.at.begin(), entry.at.begin() + n});
  });
}

void describe(Fields& out, const PageChain& chain) {
  out.text(Label("kind", "of states").one_of({"trees", "bins"}),
           chain.has_trees ? "trees" : "bins");
  out.count({"states", "1", "number of states"}, chain.states);
  out.count({"gate_runs", "1", "gate runs behind them"}, chain.gate_runs);
  out.text({"asked", "scene or file that was asked"}, chain.asked);
  out.flag({"is_matrix", "whether that is a matrix"}, chain.is_matrix);
  out.flag({"can_run", "whether more gate runs can be made"}, chain.can_run);
}

}  // namespace

std::uint16_t share_code(double share) {
  constexpr std::uint16_t kSmall = 10'001, kDigits = 90, kNone = 65'535;
  if (std::isnan(share)) return kNone;
  if (!(share > 0.0 && share < 5e-5))
    return static_cast<std::uint16_t>(
        std::lround(100.0 * lattice::number_of(fixed(100.0 * share, 2))));
  const std::string text = scientific(100.0 * share, 1);  // "6.9e-04"; at most 5.0e-03
  const int digits = (text[0] - '0') * 10 + (text[2] - '0'), power = -std::stoi(text.substr(4));
  return static_cast<std::uint16_t>(kSmall + (power - 3) * kDigits + digits - 10);
}

void describe(Fields& out, const AnswerPage& page, bool gates_95) {
  const lattice::FieldParams& field = page.shown.field;
  const dynamics::Section& section = page.shown.map.section;
  const Eigen::Index cells = Eigen::Index{field.columns} * field.rows;
  std::vector<Known> places;
  for (const lattice::StartState& s : page.states.states)
    places.push_back({&s.endings, &s.gates, &s.gates_95});
  std::vector<lattice::EndingShares> told;
  told.reserve(page.starts.size());
  for (const PageAnswer& s : page.starts) {
    told.push_back(shown_endings(s.endings, s.final));
    places.push_back({&told.back(), &s.final.final_cells, &s.gates_95});
  }
  const auto back_at = static_cast<std::size_t>(lattice::kWentBack.ending);
  const bool back = std::ranges::any_of(places, [&](const Known& k) {
    return k.gates->size() > 0 && k.endings->share[back_at] > 0.0;
  });
  std::vector<EndingName> names(std::begin(kAllEndingNames), std::end(kAllEndingNames));
  if (!back)
    std::erase_if(names, [](const EndingName& e) { return e.ending == lattice::kWentBack.ending; });

  out.text({"title", "of the page"}, page.title);
  out.count({"columns", "1", "cells side by side"}, field.columns);
  out.count({"rows", "1", "cells one behind the other"}, field.rows);
  out.count({"start_column", "1", "number of the column in which bodies start, from 0"},
            field.start_column());
  out.count({"start_row", "1", "number of the row in which bodies start, from 0"}, field.start_row);
  out.count({"max_gates", "1", "cells after which a body is cut off; 0: never"}, field.max_gates);
  out.numbers({"cell_m", "m", "width and depth of a cell"}, {page.shown.width, page.shown.length});
  out.number({"time_limit_s", "s", "until a body in a cell is trapped; null: somebody said so"},
             page.shown.time_limit);
  describe_section(out, section);
  out.list({"endings", "how bodies end"}, names, [](Fields& f, const EndingName& e) {
    f.text({"key", "in results"}, e.key);
    f.text({"name", "in words"}, e.name);
  });
  describe_states(out, page);
  out.list({"starts", "that were asked about"}, page.starts,
           [&](Fields& f, const PageAnswer& s) { describe(f, s, section); });
  out.object({"answers", "of each state, and behind them of each start"}, [&](Fields& f) {
    describe(f, {"endings", "by ending"}, ending_table(places, back));
    describe(f, {"gates", "by final gate"}, gate_table(places, cells), gates_95);
  });
  describe_cells(out, page, cells, back);
  out.object({"chain", "what the page was made from"}, [&](Fields& f) { describe(f, page.chain); });
  out.object({"analysis", "times, work and ways"},
             [&](Fields& f) { describe_for_page(f, page.analysis); });
  out.optional(page.scene != nullptr, [&](Fields& f) { describe_gate(f, *page.scene); });
  out.optional(!page.shown.types.empty(), [&](Fields& f) {
    f.texts({"types", "names of types of cells"}, page.shown.types);
    const std::vector<int>& types = page.shown.map.type_of_cell;
    f.counts({"type_of_gate", "1", "type of each cell, row by row from the near row on"},
             {types.begin(), types.end()});
  });
  out.optional(!gates_95, [](Fields& f) {
    f.text({"left_out", "what the page does not hold"},
           "intervals of single gates, with which the page would be too large");
  });
}

}  // namespace gatewalk::cli
