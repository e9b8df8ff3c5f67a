// SPDX-License-Identifier: MIT
#include "cli/film/replay.h"

#include "cli/web/embedded.h"
#include "cli/web/html.h"

#include "cli/render/json.h"

namespace gatewalk::cli {
namespace {

using dynamics::kLeft;
using dynamics::kRight;
using Step = const FilmStep&;

struct Array {
  const char* name;
  double (*value)(Step);
};
constexpr Array kArrays[] = {
    {"t", [](Step s) { return s.time; }},
    {"gx", [](Step s) { return static_cast<double>(s.i_x); }},
    {"gy", [](Step s) { return static_cast<double>(s.i_y); }},
    {"x", [](Step s) { return s.body.x; }},
    {"y", [](Step s) { return s.body.y; }},
    {"vx", [](Step s) { return s.body.vx; }},
    {"vy", [](Step s) { return s.body.vy; }},
    {"left", [](Step s) { return s.angle[kLeft]; }},
    {"right", [](Step s) { return s.angle[kRight]; }},
    {"contact_left", [](Step s) { return static_cast<double>(s.contact[kLeft]); }},
    {"contact_right", [](Step s) { return static_cast<double>(s.contact[kRight]); }},
    {"random_N", [](Step s) { return s.random_force; }},
    {"body_J", [](Step s) { return s.body_energy; }},
    {"beams_J", [](Step s) { return s.beams_energy; }},
    {"elastic_J", [](Step s) { return s.elastic; }},
    {"work_J", [](Step s) { return s.work; }},
    {"lost_J", [](Step s) { return s.lost; }},
    {"lost_in_hits_J", [](Step s) { return s.lost_in_hits; }},
};

}  // namespace

Json to_json(const Film& film) {
  const dynamics::GateParams& p = film.gate;
  const dynamics::Scale scale = dynamics::scale_of(p);
  Json json{
      {"title", film.title},
      {"scale", {{"length_m", scale.length}, {"mass_kg", scale.mass}, {"time_s", scale.time}}},
      {"radius_m", p.body.radius},
      {"beam_m", p.beams.length},
      {"joint_x_m", p.beams.joint_x},
      {"joint_y_m", p.beams.joint_y},
      {"gate_m", {film.width(), film.depth()}},
      {"columns", film.field.columns},
      {"rows", film.field.rows},
      {"start_column", film.field.start_column()},
      {"runs", Json::array()}};
  if (film.types) {
    for (const dynamics::GateParams& type : film.types->types())
      json["types"].push_back(
          {{"beam_m", type.beams.length}, {"propulsion_N", type.forces.propulsion}});
    json["type_of_gate"] = film.types->type_of_cell();
  }
  if (!film.actions.empty()) json["actions"] = film.actions;
  for (const FilmRun& run : film.runs) {
    Json of{{"label", run.label}, {"ending", run.ending}, {"propulsion_N", p.forces.propulsion}};
    for (const auto& [name, value] : kArrays) {
      Json& values = of[name] = Json::array();
      for (const FilmStep& step : run.steps) values.push_back(value(step));
    }
    if (!film.actions.empty())
      for (const FilmStep& step : run.steps) of["type"].push_back(step.type);
    json["runs"].push_back(std::move(of));
  }
  return json;
}

std::string replay_page(const Json& film) {
  // Without scripts the page still says how the runs ended.
  std::string words;
  if (film.contains("runs"))
    for (const Json& run : film["runs"])
      words += "<p>" + escaped(run.value("label", "a run")) + "</p>";
  return filled(carried_file("replay.html"), {{"title", escaped(film.value("title", "Replay"))},
                                              {"words", words},
                                              {"script", std::string(carried_file("replay.js"))},
                                              {"film", script_json(film)}});
}

}  // namespace gatewalk::cli
