// SPDX-License-Identifier: MIT
#include "cli/render/matrix.h"

#include <algorithm>
#include <array>

#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/states.h"
#include "cli/render/text.h"
#include "lattice/cells/cell_matrix.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/text/text_stream.h"
#include "markov/formats/counts.h"

namespace gatewalk::cli {

namespace {

using namespace dynamics;

/// Gate runs behind the counts: of a tree, those that its record says (mirror images count twice,
/// and first runs of trials are rows of their own).
std::int64_t gate_runs_of(const lattice::MatrixFile& file, const std::string& path) {
  const Json states = recorded(file, path, "state_space");
  if (file.transitions.space.has_trees() && states.contains("gate_runs"))
    return states.at("gate_runs").get<std::int64_t>();
  return file.transitions.totals().runs;
}

/// Share of a row's trials that came out at each boundary of the next gate, and trapped.
std::vector<double> outcome_shares(const Transitions& t, int row) {
  const auto faces = std::ssize(t.space.section().faces);
  std::vector<double> share(static_cast<std::size_t>(faces) + 1, 0.0);
  if (t.trials[row] == 0) return share;
  for (const auto& [column, n] : t.rows[row]) {
    const int b = column == t.space.trapped() ? static_cast<int>(faces) : t.space.face(column);
    share[static_cast<std::size_t>(b)] +=
        static_cast<double>(n) / static_cast<double>(t.trials[row]);
  }
  return share;
}

std::string row_table(const Transitions& t) {
  lattice::TextStream out;
  const Section& section = t.space.section();
  std::size_t width = 0;  // of names, if states have some
  for (const NamedEntries& named : section.named) width = std::max(width, named.name.size() + 2);
  out << "\n  in  " << padded(width > 0 ? "name" : "", -static_cast<int>(width)) << "from";
  for (const Coordinate& c : section.coordinates) {
    const std::string unit = behind_number(c.unit);
    const std::string head = c.name + (unit.empty() ? "" : " (" + unit.substr(1) + ")");
    out << (&c == &section.coordinates.front() ? " " + padded(head, -13) : padded(head, -12));
  }
  out << "trials clamped |";
  for (const Face& face : section.faces) out << padded(face.name, 5) << " ";
  out << " trap (%)\n";
  for (const int row : lattice::shown_order(t.space)) {
    const StateRange range = t.space.range(row);
    const auto share = outcome_shares(t, row);
    out << padded(std::to_string(lattice::shown_number(t.space, row) + 1), 4) << "  "
        << padded(name_of(section, range.middle()), -static_cast<int>(width))
        << section.faces[range.face].name << " ";
    for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
      out << padded(dynamics::text_of(range.at[axis]) + " ", -12);
    out << padded(std::to_string(t.trials[row]), 7) << padded(std::to_string(t.clamped[row]), 8)
        << " |";
    for (const double s : share) out << padded(fixed(100.0 * s, 1), 6);
    out << "\n";
  }
  return out.str();
}

/// The outputs of a row, in the order in which states are shown: state here, count.
std::map<int, std::pair<int, std::int64_t>> outputs_of(const Transitions& t, int row) {
  std::map<int, std::pair<int, std::int64_t>> outputs;
  for (const auto& [column, count] : t.rows[row])
    outputs[lattice::shown_number(t.space, column)] = {column, count};
  return outputs;
}

std::string outputs_table(const Transitions& t, int shown) {
  lattice::TextStream out;
  out << "\n  outputs of input " << shown + 1 << "\n";
  const int row = lattice::shown_order(t.space)[static_cast<std::size_t>(shown)];
  for (const auto& [number, output] : outputs_of(t, row)) {
    const auto& [column, count] = output;
    out << padded(std::to_string(number + 1), 6) << padded(std::to_string(count), 9) << "  ";
    if (column == t.space.trapped()) {
      out << "trapped\n";
      continue;
    }
    out << text_of(t.space.section(), t.space.range(column)) << "\n";
  }
  return out.str();
}

/// Matrices of other gates in the field.
Json types_json(const lattice::MatrixFile& file) {
  Json json;
  for (const auto& [name, t] : file.types) {
    const auto total = t.totals();
    json[name] = {{"counts", total.runs},
                  {"nonzeros", total.nonzeros},
                  {"clamped_share", total.clamped_share()},
                  {"rows_never_sampled", total.empty_rows}};
  }
  return json;
}

std::string types_table(const lattice::MatrixFile& file, const std::string& indent) {
  std::string table;
  for (const auto& [name, t] : file.types) {
    const auto total = t.totals();
    table += indent + padded("type " + name, -20) + std::to_string(total.runs) + " counts, " +
             std::to_string(total.nonzeros) + " nonzeros, " + std::to_string(total.empty_rows) +
             " rows never sampled\n";
  }
  return table;
}

}  // namespace

Json recorded(const lattice::MatrixFile& file, const std::string& path, const std::string& key) {
  const auto text = file.text.find(key);
  if (text == file.text.end()) return {};
  Json json = parsed_json(text->second);
  if (json.is_discarded())
    throw markov::BadFile(path + ": its record of the " +
                          (key == "method"   ? "chosen method"
                           : key == "status" ? "status"
                                             : "state space") +
                          " is damaged");
  return json;
}

Json recorded_status(const lattice::MatrixFile& file) {
  const auto text = file.text.find("status");
  return text == file.text.end() ? Json() : parsed_json(text->second);
}

std::string faults_recorded(const Json& status) {
  try {
    return complaint(health_from(status));
  } catch (const Json::exception&) {
    return "the record of numerical faults is missing or damaged.";
  }
}

Json bins_json(const lattice::BinsChoice& choice) {
  return choice.kind == lattice::BinsChoice::Kind::paper ? Json(choice.factor)
                                                         : Json(choice.name());
}

void require_keepable(const lattice::Scene& scene) {
  if (const auto bytes = lattice::to_toml(scene).size(); bytes > markov::kMostTextBytes)
    throw std::invalid_argument(scene.source + ": the scene with its map has " +
                                std::to_string(bytes) + " bytes, a matrix file keeps " +
                                std::to_string(markov::kMostTextBytes) +
                                ": take a random map, or a smaller one of the same types");
}

std::map<std::string, std::string> record_of(const MadeMatrix& made, const lattice::Scene& scene,
                                             const Provenance& provenance) {
  const Json made_by = to_json(provenance);
  std::map<std::string, std::string> text = {
      {"title", "gatewalk input-output matrix of one gate, Eq. (16), as counts"},
      {"scene", lattice::to_toml(scene)},
      {"seed", made_by.at("seed").dump()},
      {"bins", made.bins.is_string()
                   ? made.bins.get<std::string>()
                   : made.bins.dump()},  // the shortest digits that read back the same
      {"state_space", made.states.dump()},
      {"program", "gatewalk " + made_by.at("version").get<std::string>()},
      {"commit", made_by.at("commit")},
      {"command", provenance.command},
      {"status", to_json(made.matrices.front().health).dump()}};
  if (made.trials_per_row) text["trials_per_row"] = std::to_string(*made.trials_per_row);
  if (made.settled) text["method"] = to_json(*made.settled).dump();
  return text;
}

Json summary_json(const MadeMatrix& made, const lattice::MatrixFile& file,
                  const std::string& path) {
  const Transitions& t = made.matrices.front();
  const auto total = t.totals();
  Json json;
  json["matrix"] = path;
  json["inputs"] = t.space.size();
  json["outputs"] = t.space.size() + 1;
  if (made.trials_per_row) json["trials_per_row"] = *made.trials_per_row;
  json["bins"] = made.bins;
  json["nonzeros"] = total.nonzeros;
  json["clamped_share"] = total.clamped_share();
  json["state_space"] = made.states;
  if (!file.types.empty()) json["types"] = types_json(file);
  if (made.settled) json["method"] = to_json(*made.settled);
  json["status"] = to_json(t.health);
  return json;
}

std::string summary_table(const lattice::MatrixFile& file, const std::string& path) {
  const Transitions& t = file.transitions;
  const auto total = t.totals();
  const std::string size = path + ": " + std::to_string(t.space.size()) + " x " +
                           std::to_string(t.space.size() + 1) + " matrix, ";
  if (t.space.has_trees())
    return size + std::to_string(total.nonzeros) + " nonzeros\n" + types_table(file, "");
  if (const Json states = recorded(file, path, "state_space");
      states.is_object() && states.value("bins", Json()) == "imported")
    return size +
           (states.value("probabilities", Json()) == true
                ? std::string("probabilities, ")
                : std::to_string(total.runs) + " counted steps, ") +
           std::to_string(total.nonzeros) + " nonzeros\n";
  return size + std::to_string(total.runs) + " gate runs, " + std::to_string(total.nonzeros) +
         " nonzeros, " + percent(total.clamped_share(), 1.0) +
         " of the crossings clamped into the nearest bin\n" + types_table(file, "");
}

Json to_json(const lattice::MatrixFile& file, const std::string& path) {
  const Transitions& t = file.transitions;
  const int n = t.space.size();
  const auto total = t.totals();
  const double cells = static_cast<double>(n) * (n + 1);

  Json json;
  json["inputs"] = n;
  json["outputs"] = n + 1;
  json["gate_runs"] = gate_runs_of(file, path);
  json["counts"] = total.runs;
  json["nonzeros"] = total.nonzeros;
  json["density"] = static_cast<double>(total.nonzeros) / cells;
  json["clamped_share"] = total.clamped_share();
  json["rows_never_sampled"] = total.empty_rows;
  if (!file.types.empty()) json["types"] = types_json(file);
  json["counted_from"] = 1;  // inputs and outputs below
  json["rows"] = Json::array();
  for (const int row : lattice::shown_order(t.space)) {
    const StateRange range = t.space.range(row);
    Json outputs = Json::array();
    for (const auto& [number, output] : outputs_of(t, row))
      outputs.push_back({{"output", number + 1}, {"count", output.second}});
    const Section& section = t.space.section();
    Json shown = {{"input", lattice::shown_number(t.space, row) + 1},
                  {"boundary", section.faces[range.face].name}};
    if (const std::string name = name_of(section, range.middle()); !name.empty())
      shown["name"] = name;
    for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
      shown[section.coordinates[axis].key] = range.at[axis];
    shown["trials"] = t.trials[row];
    shown["clamped"] = t.clamped[row];
    shown["outputs"] = std::move(outputs);
    json["rows"].push_back(std::move(shown));
  }
  if (Json states = recorded(file, path, "state_space"); !states.is_null())
    json["state_space"] = std::move(states);
  json["text"] = Json::object();
  for (const auto& [key, value] : file.text) json["text"][key] = value;
  return json;
}

std::string table_of(const lattice::MatrixFile& file, const std::string& path,
                     const ShownRows& shown) {
  const Transitions& t = file.transitions;
  const int n = t.space.size();
  const auto total = t.totals();
  const double cells = static_cast<double>(n) * (n + 1);
  lattice::TextStream out;
  out << path << "\n"
      << "  size                " << n << " inputs x " << n + 1 << " outputs (the last: trapped)\n"
      << "  gate runs           " << gate_runs_of(file, path)
      << (t.space.has_trees() ? ", counts " + std::to_string(total.runs) : "") << "\n"
      << "  nonzeros            " << total.nonzeros << " of " << std::int64_t{n} * (n + 1) << " ("
      << percent(static_cast<double>(total.nonzeros), cells) << ")\n"
      << (t.space.has_trees()
              ? ""
              : "  clamped crossings   " + percent(total.clamped_share(), 1.0) + "\n")
      << "  rows never sampled  " << total.empty_rows << "\n"
      << types_table(file, "  ");
  for (const char* key : {"program", "commit", "command", "seed", "trials_per_row", "bins"})
    if (const auto it = file.text.find(key); it != file.text.end())
      out << "  " << padded(key, -20) << it->second << "\n";
  const Json status = recorded_status(file);
  const std::string faults =
      status.is_null() && file.text.contains(lattice::kCellText)
          ? std::string("none on record") + (lattice::has_runs(file) ? ": runs were recorded" : "")
          : faults_recorded(status);
  const Json states = recorded(file, path, "state_space");
  if (!states.is_null()) out << "  " << states_line(states);
  out << "  numerical faults    " << (faults.empty() ? "none seen" : faults) << "\n";
  if (shown.all) out << row_table(t);
  if (shown.one) out << outputs_table(t, *shown.one);
  if (file.text.count("scene") > 0) out << "\n" << file.text.at("scene");
  return out.str();
}

}  // namespace gatewalk::cli
