// SPDX-License-Identifier: MIT
#include "cli/film/replay.h"

#include <fmt/core.h>

#include "cli/fields/json.h"
#include "cli/render/health.h"
#include "cli/render/recording.h"
#include "cli/web/embedded.h"
#include "cli/web/html.h"

namespace gatewalk::cli {
namespace {

using dynamics::kLeft;
using dynamics::kRight;
using Step = const FilmStep&;

/// An array of a run, with an entry for each step.
struct Array {
  const char *name, *unit, *meaning;
  double (*value)(Step);
};
constexpr Array kArrays[] = {
    {"t", "s", "time since the run began, at the end of each step", [](Step s) { return s.time; }},
    {"gx", "1", "column i_x of the gate that the body is in; 0: the start's column",
     [](Step s) { return static_cast<double>(s.i_x); }},
    {"gy", "1", "row i_y of the gate that the body is in; 0: the near row",
     [](Step s) { return static_cast<double>(s.i_y); }},
    {"x", "m", "sideways place of the body in its gate; 0: the middle line",
     [](Step s) { return s.body.x; }},
    {"y", "m", "forward place of the body in its gate", [](Step s) { return s.body.y; }},
    {"vx", "m/s", "sideways velocity of the body", [](Step s) { return s.body.vx; }},
    {"vy", "m/s", "forward velocity of the body", [](Step s) { return s.body.vy; }},
    {"left", "rad", "angle of the left beam; above 0: deflected forward",
     [](Step s) { return s.angle[kLeft]; }},
    {"right", "rad", "angle of the right beam; above 0: deflected forward",
     [](Step s) { return s.angle[kRight]; }},
    {"contact_left", "1", "contact with the left beam: 0 free, 1 hit, 2 held",
     [](Step s) { return static_cast<double>(s.contact[kLeft]); }},
    {"contact_right", "1", "contact with the right beam: 0 free, 1 hit, 2 held",
     [](Step s) { return static_cast<double>(s.contact[kRight]); }},
    {"random_N", "N", "random force from this moment until the next step",
     [](Step s) { return s.random_force; }},
    {"body_J", "J", "kinetic energy of the body", [](Step s) { return s.body_energy; }},
    {"beams_J", "J", "kinetic energy of both beams", [](Step s) { return s.beams_energy; }},
    {"elastic_J", "J", "elastic energy of both beams", [](Step s) { return s.elastic; }},
    {"work_J", "J", "work of propulsion and random force since the run began",
     [](Step s) { return s.work; }},
    {"lost_J", "J", "energy lost since the run began", [](Step s) { return s.lost; }},
    {"lost_in_hits_J", "J", "energy lost in hits since the run began",
     [](Step s) { return s.lost_in_hits; }},
};

/// Describes a film. `more` adds keys to a run; it is called with the run's fields and number, from
/// 0.
template <class More>
void describe(Fields& out, const Film& film, More more) {
  const dynamics::GateParams& p = film.gate;
  out.text({"title", "one line about the scene"}, film.title);
  out.object({"scale", "the scene's natural units, in which pictures are drawn"},
             [scale = dynamics::scale_of(p)](Fields& own) {
               own.number({"length_m", "m", "unit of length"}, scale.length);
               own.number({"mass_kg", "kg", "unit of mass"}, scale.mass);
               own.number({"time_s", "s", "unit of time"}, scale.time);
             });
  out.number({"radius_m", "m", "radius of the body"}, p.body.radius);
  out.number({"beam_m", "m", "length of a beam"}, p.beams.length);
  out.number({"joint_x_m", "m", "x of the right joint in its gate; the left joint is at -x"},
             p.beams.joint_x);
  out.number({"joint_y_m", "m", "y of both joints in their gate"}, p.beams.joint_y);
  out.numbers({"gate_m", "m", "width and depth of a gate"}, {film.width(), film.depth()});
  out.count({"columns", "1", "number of columns of gates"}, film.field.columns);
  out.count({"rows", "1", "number of rows of gates"}, film.field.rows);
  out.count({"start_column", "1", "column in which bodies start, counted from 0 at the left"},
            film.field.start_column());
  out.list_of(
      {"runs", "the recorded runs: arrays have one entry for each step"}, film.runs.size(),
      [&](Fields& f, std::size_t i) {
        const FilmRun& run = film.runs[i];
        f.text({"label", "one line about the run"}, run.label);
        f.text(Label("ending", "how the run ended: outcome of a gate alone, or ending in the field")
                   .one_of({"traversed left", "traversed right", "traversed evenly", "exited left",
                            "exited right", "crossed", "left side", "right side", "trapped",
                            "cut off", "not finite"}),
               run.ending);
        f.number({"propulsion_N", "N", "propulsion of the scene; in mixed fields see types"},
                 p.forces.propulsion);
        for (const auto& [name, unit, meaning, value] : kArrays) {
          std::vector<double> values;
          for (const FilmStep& step : run.steps) values.push_back(value(step));
          f.numbers({name, unit, meaning}, values);
        }
        f.optional(!film.actions.empty(), [&](Fields& policy) {
          std::vector<std::int64_t> types;
          for (const FilmStep& step : run.steps) types.push_back(step.type);
          policy.counts({"type", "1",
                         "index in types of gate and action, counted from 0: gate type x "
                         "number of actions + action"},
                        types);
        });
        more(f, i);
      });
  out.optional(film.types.has_value(), [&](Fields& f) {
    const lattice::FieldGates gates = film.types.value_or(p);
    f.list(
        {"types", "gate types of a mixed field; under a policy one for each gate type and action"},
        gates.types(), [](Fields& type, const dynamics::GateParams& of) {
          type.number({"beam_m", "m", "length of a beam in gates of this type"}, of.beams.length);
          type.number({"propulsion_N", "N", "propulsion in gates of this type"},
                      of.forces.propulsion);
        });
    f.counts(
        {"type_of_gate", "1",
         "index in types of each gate, row by row from the near one; under a policy: its first "
         "action"},
        {gates.type_of_cell().begin(), gates.type_of_cell().end()});
  });
  out.optional(!film.actions.empty(), [&](Fields& f) {
    f.texts({"actions", "under a policy: names of the actions"}, film.actions);
  });
}

}  // namespace

void describe(Fields& out, const TraceResult& result) {
  const lattice::Recordings& recordings = result.recordings;
  const double joule = dynamics::scale_of(result.film.gate).energy();
  describe(out, result.film, [&](Fields& run, std::size_t i) {
    describe_details(run, recordings, recordings.runs[i], joule);
  });
  out.if_any({"video_speed", "1",
              "with --video: seconds of the run for each second of film; 1: real time"},
             result.film_speed);
  out.count({"recorded", "1", "number of recorded runs"}, recordings.runs.size());
  out.count({"trials", "1", "number of trials that were run"}, recordings.trials);
  describe_method(out, result.method);
  out.optional(!result.may_do.actions.empty(),
               [&](Fields& f) { describe_methods(f, result.may_do); });
  describe_status(out, recordings.health);
  describe_made_by(out, result.made_by);
}

void describe(Fields& out, const Film& film) {
  describe(out, film, [](Fields&, std::size_t) {});
}

std::string replay_page(const Film& film) {
  // Without scripts the page still says how the runs ended.
  std::string words;
  for (const FilmRun& run : film.runs) words += fmt::format("<p>{}</p>", escaped(run.label));
  return filled(carried_file("replay.html"),
                {{"title", escaped(film.title)},
                 {"words", words},
                 {"script", std::string(carried_file("replay.js"))},
                 {"film", script_json(json_text([&](Fields& out) { describe(out, film); }, -1))}});
}

}  // namespace gatewalk::cli
