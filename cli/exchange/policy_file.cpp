// SPDX-License-Identifier: MIT
#include "cli/exchange/policy_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "cli/fields/json.h"
#include "cli/fields/json_value.h"
#include "dynamics/disc/disc_section.h"
#include "lattice/text/toml_text.h"
#include "markov/formats/counts.h"

namespace gatewalk::cli {
namespace {

constexpr std::string_view kLetters =
    "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
constexpr double kMostGates = 1e6;
constexpr std::size_t kMostPoints = 1000;  // a plan has one, its start
constexpr int kPolicyFormat = 1;

/// The first line that differs, of both texts.
std::string difference(const std::string& here, const std::string& there) {
  const auto [a, b] = std::mismatch(here.begin(), here.end(), there.begin(), there.end());
  const auto line = [](const std::string& text, std::string::const_iterator at) {
    const auto begin = static_cast<std::size_t>(at - text.begin());
    const std::size_t first = begin == 0 ? 0 : text.rfind('\n', begin - 1) + 1;
    return lattice::printable(std::string_view(text).substr(first, text.find('\n', begin) - first));
  };
  return fmt::format("\"{}\" here, \"{}\" there", line(here, a), line(there, b));
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(std::string("cannot be read: ") + std::strerror(errno));
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Reads a whole number from -1 to `most`.
int number_in(const Json& json, std::size_t most) {
  if (json.is_number_integer()) {
    const double number = json.get<double>();
    if (number >= -1.0 && number <= static_cast<double>(most)) return static_cast<int>(number);
  }
  throw std::runtime_error(
      fmt::format("{} is no whole number from -1 to {}",
                  json.is_number() ? json.dump() : std::string(json.type_name()), most));
}

lattice::Policy policy_of(const Json& json, const PolicyField& made_for) {
  const dynamics::Section& section = made_for.section;
  std::vector<dynamics::Tree> trees;
  for (const Json& given : json.at("trees")) {
    std::vector<int> axes;
    for (const Json& axis : given.at("axis"))
      axes.push_back(number_in(axis, section.coordinates.size() - 1));
    const auto cuts = given.at("cut").get<std::vector<double>>();
    if (axes.size() != cuts.size()) throw std::runtime_error("a tree has other cuts than axes");
    dynamics::Tree& tree = trees.emplace_back();
    tree.nodes.clear();
    for (std::size_t i = 0; i < axes.size(); ++i) tree.nodes.push_back({axes[i], cuts[i]});
    const auto seen = given.at("seen").get<std::vector<std::array<double, 2>>>();
    if (seen.size() != section.coordinates.size())
      throw std::runtime_error("a tree has other coordinates than an entry");
    std::copy(seen.begin(), seen.end(), tree.seen.begin());
  }
  std::vector<dynamics::Entry> points;
  if (json.at("points").size() > kMostPoints)
    throw std::runtime_error(fmt::format("more than {} points", kMostPoints));
  for (const Json& given : json.at("points")) {
    dynamics::Entry& point = points.emplace_back();
    point.face = number_in(given.at("face"), section.faces.size() - 1);
    const auto at = given.at("at").get<std::vector<double>>();
    if (at.size() != section.coordinates.size())
      throw std::runtime_error("a point has other coordinates than an entry");
    std::copy(at.begin(), at.end(), point.at.begin());
  }
  dynamics::StateSpace space(section, std::move(trees), std::move(points));
  const lattice::FieldParams& field = made_for.field;
  markov::Decisions decisions{
      .field = {field.columns, field.rows}, .inputs = space.size(), .max_cells = field.max_gates};
  const std::size_t actions = made_for.actions;
  if (json.contains("always")) {
    const int always = number_in(json.at("always"), actions - 1);
    if (always < 0) throw std::runtime_error("there is no action number -1");
    return {std::move(space), std::move(decisions), always};
  }
  const auto cells = static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows),
             draws = static_cast<std::size_t>(std::max(1, field.max_gates)),
             states = static_cast<std::size_t>(space.size());
  const Json& rows = json.at("action");
  if (rows.size() != draws * cells)
    throw std::runtime_error(
        fmt::format("has decisions for {} gates, not for {}", rows.size(), draws * cells));
  for (const Json& given : rows) {
    const auto& row = given.get_ref<const std::string&>();
    if (row.size() != states)
      throw std::runtime_error(
          fmt::format("a gate has decisions for {} ways to enter, not for {}", row.size(), states));
    for (const char letter : row) {
      const std::size_t action = kLetters.find(letter);
      if (action >= actions)
        throw std::runtime_error("there is no action " + lattice::printable({&letter, 1}));
      decisions.action.push_back(static_cast<std::uint16_t>(action));
    }
  }
  return {std::move(space), std::move(decisions)};
}

/// The field without the cell that bodies start in: a policy serves every start.
lattice::FieldParams for_any_start(lattice::FieldParams field) {
  field.own_start_column = {};
  field.start_row = 0;
  return field;
}

}  // namespace

PolicyField policy_field(const lattice::Scene& scene) {
  lattice::Scene own = scene;
  own.start = {};
  own.field = for_any_start(scene.field);
  return {"scene",     lattice::to_toml(own), dynamics::disc_section(scene.gate),
          scene.field, scene.actions.size(),  scene.source};
}

PolicyField policy_field(const lattice::CellFile& cells, const std::string& told) {
  lattice::CellFile own = cells;
  own.start.reset();
  own.field = for_any_start(cells.field);
  return {"cell",      lattice::to_toml(own) + told, cells.map.section,
          cells.field, cells.actions.size(),         cells.source};
}

void require_file_for(const PolicyField& made_for) {
  const lattice::FieldParams& field = made_for.field;
  const double gates =
      static_cast<double>(field.columns) * field.rows * std::max(1, field.max_gates);
  if (made_for.actions > kLetters.size() || gates > kMostGates)
    throw std::runtime_error(
        fmt::format("{}: a policy is a file for at most {} actions and {} gates (field.columns "
                    "times field.rows, and times field.max_gates if there is a limit)",
                    made_for.source, kLetters.size(), static_cast<int>(kMostGates)));
}

namespace {

void describe(Fields& out, const dynamics::Tree& tree, std::ptrdiff_t coordinates) {
  std::vector<std::int64_t> axes;
  std::vector<double> cuts;
  for (const dynamics::Tree::Node& node : tree.nodes) {
    axes.push_back(node.axis);
    cuts.push_back(node.cut);
  }
  out.counts({"axis", "1", "coordinate that each node cuts; -1: a leaf"}, axes);
  out.numbers({"cut", "its own", "where each node cuts"}, cuts);
  out.points({"seen", "its own", "from where to where each coordinate was seen"},
             {tree.seen.begin(), tree.seen.begin() + coordinates});
}

/// A text for each gate, with a letter for the action in each state.
std::vector<std::string> rows_of(const lattice::Policy& policy) {
  const std::vector<std::uint16_t>& action = policy.decisions.action;
  const auto states = static_cast<std::size_t>(policy.space.size());
  std::vector<std::string> rows;
  for (std::size_t at = 0; at < action.size(); at += states) {
    std::string& row = rows.emplace_back(states, ' ');
    for (std::size_t i = 0; i < states; ++i) row[i] = kLetters[action[at + i]];
  }
  return rows;
}

void describe(Fields& out, const lattice::Policy& policy, const PolicyField& made_for) {
  const auto coordinates = std::ssize(policy.space.section().coordinates);
  out.count({"policy_format", "1", "of such files"}, kPolicyFormat);
  out.text({made_for.kind, "what the policy was made for, as TOML"}, made_for.text);
  out.list({"trees", "states of the bodies that enter, by face"}, policy.space.trees(),
           [&](Fields& f, const dynamics::Tree& tree) { describe(f, tree, coordinates); });
  out.list({"points", "entries with a state of their own"}, policy.space.points(),
           [&](Fields& f, const dynamics::Entry& point) {
             f.count({"face", "1", "its number, from 0"}, point.face);
             f.numbers({"at", "its own", "its coordinates"},
                       {point.at.begin(), point.at.begin() + coordinates});
           });
  out.either(
      policy.always.has_value(),
      [&](Fields& f) {
        f.count({"always", "1", "number of the one action, from 0"}, policy.always.value_or(0));
      },
      [&](Fields& f) {
        f.texts({"action", "for each gate a letter for each state: its action"}, rows_of(policy));
      });
}

}  // namespace

std::string policy_text(const lattice::Policy& policy, const PolicyField& made_for) {
  require_file_for(made_for);
  return json_text([&](Fields& out) { describe(out, policy, made_for); }, 0) + "\n";
}

lattice::Policy read_policy(const std::string& path, const PolicyField& made_for) try {
  const Json json = parsed_json(bytes_of(path));
  if (!json.is_object() || !json.contains("policy_format") ||
      json["policy_format"] != kPolicyFormat)
    throw std::runtime_error("is no policy that gatewalk plan --policy wrote");
  if (!json.contains(made_for.kind) && (json.contains("scene") || json.contains("cell")))
    throw std::runtime_error("was made for cells of another kind");
  if (const auto own = json.at(made_for.kind).get<std::string>(); own != made_for.text)
    throw std::runtime_error(
        fmt::format("was made for another {}: {}", made_for.kind, difference(made_for.text, own)));
  return policy_of(json, made_for);
} catch (const std::runtime_error& e) {
  throw markov::BadFile(path + ": " + e.what());
} catch (const Json::exception& e) {
  throw markov::BadFile(path + ": is damaged: " + e.what());
} catch (const std::invalid_argument& e) {  // thrown by the state space
  throw markov::BadFile(path + ": is damaged: " + e.what());
}

}  // namespace gatewalk::cli
