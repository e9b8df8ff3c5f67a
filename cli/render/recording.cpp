#include "cli/render/recording.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <optional>
#include <stdexcept>

#include "cli/render/drawing.h"
#include "cli/render/quantity.h"
#include "dynamics/landscape.h"
#include "markov/formats/netcdf.h"

namespace gatewalk::cli {
namespace {

using dynamics::ContactMode;
using dynamics::GateParams;
using dynamics::kLeft;
using dynamics::kRight;
using dynamics::Side;

/// A moment with the scene it belongs to.
struct Line {
  const GateParams& p;
  const Moment& m;
  std::int64_t trial;
};

constexpr char kCount[] = "1";  // the unit of what is counted, not measured

/// One column. `word` stands for a code in CSV; in NetCDF codes have flag_meanings.
struct Column {
  const char* name;
  const char* unit;
  const char* meaning;
  std::function<double(const Line&)> value;
  std::vector<std::string> words = {};
};

double landscape(const Line& l, Side side) {
  return dynamics::beam_energy(l.p, l.m.sample.state.body.x, l.m.sample.state.body.y,
                               {side == kLeft, side == kRight});
}

double potential(const Line& l) {
  return dynamics::propulsion_energy(l.p, l.m.sample.state.body.y) + l.m.energy.elastic[kLeft] +
         l.m.energy.elastic[kRight];
}

const std::vector<std::string> kModes{"free", "hit", "held"};
const std::vector<std::string> kParts{"side", "tip", "joint"};

const std::vector<Column>& columns() {
  static const std::vector<Column> list = [] {
    const auto body = [](auto member) {
      return [=](const Line& l) { return l.m.sample.state.body.*member; };
    };
    const auto beam = [](Side side, auto member) {
      return [=](const Line& l) { return l.m.sample.state.beams[side].*member; };
    };
    const auto mode = [](Side side) {
      return [=](const Line& l) { return static_cast<double>(l.m.sample.contact[side]); };
    };
    const auto part = [](Side side) {
      return [=](const Line& l) { return static_cast<double>(l.m.sample.nearest[side]); };
    };
    const auto energy = [](auto member) {
      return [=](const Line& l) { return l.m.energy.*member; };
    };
    using dynamics::BeamState;
    using dynamics::BodyState;
    using dynamics::Energies;
    return std::vector<Column>{
        {"trial", kCount, "number of the trial",
         [](const Line& l) { return static_cast<double>(l.trial); }},
        {"time_s", "s", "time since the trial began", [](const Line& l) { return l.m.time; }},
        {"gate_x", kCount, "column i_x of the gate that the body is in",
         [](const Line& l) { return l.m.i_x; }},
        {"gate_y", kCount, "row i_y of the gate that the body is in",
         [](const Line& l) { return l.m.i_y; }},
        {"x_m", "m", "body, in its gate's frame", body(&BodyState::x)},
        {"y_m", "m", "body, in its gate's frame", body(&BodyState::y)},
        {"field_x_m", "m", "body, in the field's frame",
         [](const Line& l) { return l.m.sample.state.body.x + 2.0 * l.p.beams.joint_x * l.m.i_x; }},
        {"field_y_m", "m", "body, in the field's frame",
         [](const Line& l) { return l.m.sample.state.body.y + l.p.run.traverse_y * l.m.i_y; }},
        {"vx_m_per_s", "m s-1", "velocity of the body", body(&BodyState::vx)},
        {"vy_m_per_s", "m s-1", "velocity of the body", body(&BodyState::vy)},
        {"theta_left_rad", "rad", "left beam's angle, positive deflected forward",
         beam(kLeft, &BeamState::theta)},
        {"theta_right_rad", "rad", "right beam's angle, positive deflected forward",
         beam(kRight, &BeamState::theta)},
        {"omega_left_rad_per_s", "rad s-1", "left beam's angular velocity",
         beam(kLeft, &BeamState::omega)},
        {"omega_right_rad_per_s", "rad s-1", "right beam's angular velocity",
         beam(kRight, &BeamState::omega)},
        {"random_N", "N", "random force during the step that ends here",
         [](const Line& l) { return l.m.sample.random_force; }},
        {"beams_x_N", "N", "mean force of both beams on the body during the step, hits included",
         [](const Line& l) { return l.m.sample.beam_force[0]; }},
        {"beams_y_N", "N", "mean force of both beams on the body during the step, hits included",
         [](const Line& l) { return l.m.sample.beam_force[1]; }},
        {"hit_left_Ns", "N s", "impulse of the left beam's hits during the step",
         [](const Line& l) { return l.m.sample.impulse[kLeft]; }},
        {"hit_right_Ns", "N s", "impulse of the right beam's hits during the step",
         [](const Line& l) { return l.m.sample.impulse[kRight]; }},
        {"contact_left", kCount,
         "left beam: free, hit during the step, or held at its end; method penalty: always free",
         mode(kLeft), kModes},
        {"contact_right", kCount,
         "right beam: free, hit during the step, or held at its end; method penalty: always free",
         mode(kRight), kModes},
        {"nearest_left", kCount, "part of the left beam nearest to the body", part(kLeft), kParts},
        {"nearest_right", kCount, "part of the right beam nearest to the body", part(kRight),
         kParts},
        {"gap_left_m", "m", "distance of body and left beam",
         [](const Line& l) { return l.m.sample.gap[kLeft]; }},
        {"gap_right_m", "m", "distance of body and right beam",
         [](const Line& l) { return l.m.sample.gap[kRight]; }},
        {"kinetic_body_J", "J", "kinetic energy of the body", energy(&Energies::body)},
        {"kinetic_beams_J", "J", "kinetic energy of both beams",
         [](const Line& l) { return l.m.energy.beams[kLeft] + l.m.energy.beams[kRight]; }},
        {"elastic_left_J", "J", "elastic energy of the left beam, Eq. (14)",
         [](const Line& l) { return l.m.energy.elastic[kLeft]; }},
        {"elastic_right_J", "J", "elastic energy of the right beam, Eq. (14)",
         [](const Line& l) { return l.m.energy.elastic[kRight]; }},
        {"propulsion_work_J", "J", "work of the propulsion since the trial began",
         energy(&Energies::propulsion_work)},
        {"random_work_J", "J", "work of the random force since the trial began",
         energy(&Energies::random_work)},
        {"hit_loss_J", "J", "energy that hits took since the trial began",
         energy(&Energies::hit_loss)},
        {"lost_J", "J", "energy lost since the trial began: hits, dampers, drag, beams left behind",
         energy(&Energies::lost)},
        {"potential_J", "J",
         "elastic energy and that of the propulsion, Eq. (15), zero at run.traverse_y_m",
         potential},
        {"landscape_J", "J",
         "the landscape here, Eq. (15): both beams deflected forward, zero at run.traverse_y_m",
         [](const Line& l) {
           return dynamics::propulsion_energy(l.p, l.m.sample.state.body.y) + landscape(l, kLeft) +
                  landscape(l, kRight);
         }},
        {"landscape_left_J", "J", "the left beam's part of it",
         [](const Line& l) { return landscape(l, kLeft); }},
        {"landscape_right_J", "J", "the right beam's part of it",
         [](const Line& l) { return landscape(l, kRight); }},
    };
  }();
  return list;
}

const Column& column(std::string_view name) {
  const auto& list = columns();
  return *std::find_if(list.begin(), list.end(), [&](const Column& c) { return c.name == name; });
}

std::string ending_of(const GateParams& p, const dynamics::GateRun& run) {
  dynamics::GateTally t;
  t.add(p, run);
  if (t.traversed_left) return "traversed left";
  if (t.traversed_right) return "traversed right";
  if (t.traversed_even) return "traversed evenly";
  if (t.exited_left) return "exited left";
  if (t.exited_right) return "exited right";
  return t.trapped ? "trapped" : "not finite";
}

std::string field_ending(std::optional<markov::Ending> ending) {
  if (!ending) return "not finite";
  switch (*ending) {
    case markov::Ending::trapped:
      return "trapped";
    case markov::Ending::far_edge:
      return "crossed";
    case markov::Ending::left_edge:
      return "left field left side";
    case markov::Ending::right_edge:
      return "left field right side";
    case markov::Ending::near_edge:
      return "left field near side";
    case markov::Ending::cut_off:
      return "cut off";
    case markov::Ending::unsampled:
      break;  // of walks only
  }
  throw std::logic_error("the dynamics samples no matrix");
}

/// Energies of the trial when those of this gate are `now`, and what was done before it is
/// `before`.
dynamics::Energies together(const dynamics::Energies& before, dynamics::Energies now) {
  now.propulsion_work += before.propulsion_work;
  now.random_work += before.random_work;
  now.hit_loss += before.hit_loss;
  now.lost += before.lost;
  return now;
}

void append(Recording& r, const dynamics::GateTrace& trace, int i_x, int i_y) {
  dynamics::Energies before;
  double clock = 0.0;
  if (!r.moments.empty()) {
    const Moment& last = r.moments.back();
    before = last.energy;
    clock = last.time;
    // The old gate's beams stay behind with what they had; the new ones are at rest.
    before.lost += last.energy.mechanical() - trace.samples.front().energy.mechanical();
  }
  for (const dynamics::TraceSample& s : trace.samples)
    r.moments.push_back({i_x, i_y, clock + s.time, s, together(before, s.energy)});
}

/// The scene's own unit of what a column holds.
double own_unit(const dynamics::Scale& scale, std::string_view unit) {
  if (unit == "m") return scale.length;
  if (unit == "s") return scale.time;
  if (unit == "m s-1") return scale.speed();
  if (unit == "N") return scale.force();
  if (unit == "J") return scale.energy();
  return 1.0;  // codes and angles
}

/// The sum of some columns of one run, an entry for each moment. Seven digits of what it is in the
/// scene's own unit are more than a picture shows; rounded so, a scene in other units has the same
/// film.
Json values_of(const GateParams& p, const Recording& r, const std::vector<const char*>& names) {
  std::vector<const Column*> parts;
  for (const char* name : names) parts.push_back(&column(name));
  const double own = own_unit(dynamics::scale_of(p), parts.front()->unit);
  Json values = Json::array();
  for (const Moment& m : r.moments) {
    double sum = 0.0;
    for (const Column* part : parts) sum += part->value({p, m, r.trial});
    values.push_back(std::strtod(digits(sum / own).c_str(), nullptr) * own);
  }
  return values;
}

}  // namespace

Recording record(const lattice::Scene& scene, std::uint64_t seed, std::int64_t trial,
                 bool across_field, std::size_t most_moments) {
  Recording r;
  r.trial = trial;
  if (across_field) {
    const lattice::FieldTrace t =
        lattice::trace_field(scene.gate, scene.field, scene.start, seed, trial, most_moments);
    for (const auto& visit : t.visits) {
      append(r, visit.trace, visit.column - scene.field.start_column(), visit.row);
      r.health.add(scene.gate, visit.trace.run);
    }
    r.gates = static_cast<int>(t.visits.size());
    r.ending = field_ending(t.ending);
  } else {
    const auto method = dynamics::make_method(scene.gate);
    dynamics::RandomForce force = dynamics::gate_force(scene.gate, seed, trial);
    const auto t = dynamics::trace_gate(scene.gate, *method, scene.start, force, most_moments);
    append(r, t, 0, 0);
    r.health.add(scene.gate, t.run);
    r.ending = ending_of(scene.gate, t.run);
  }
  r.seconds = r.moments.back().time;
  return r;
}

std::vector<std::string> endings(bool across_field) {
  if (!across_field)
    return {"traversed left", "traversed right", "traversed evenly", "exited left",
            "exited right",   "trapped",         "not finite"};
  std::vector<std::string> names;
  for (std::size_t e = 0; e < markov::kEndings; ++e)
    if (const auto ending = static_cast<markov::Ending>(e); ending != markov::Ending::unsampled)
      names.push_back(field_ending(ending));
  names.push_back(field_ending({}));
  return names;
}

std::string csv_of(const lattice::Scene& scene, const std::vector<Recording>& runs) {
  std::string text;
  for (const Column& c : columns()) text += (text.empty() ? "" : ",") + std::string(c.name);
  text += '\n';
  for (const Recording& r : runs)
    for (const Moment& m : r.moments) {
      const Line line{scene.gate, m, r.trial};
      std::string row;
      for (const Column& c : columns()) {
        const double x = c.value(line);
        row += row.empty() ? "" : ",";
        row += !c.words.empty()   ? c.words[static_cast<std::size_t>(x)]
               : c.unit == kCount ? std::to_string(static_cast<std::int64_t>(x))
                                  : digits(x);
      }
      text += row + '\n';
    }
  return text;
}

std::string netcdf_of(const lattice::Scene& scene, const std::vector<Recording>& runs,
                      bool across_field,
                      const std::vector<std::pair<std::string, std::string>>& about) {
  using namespace markov::netcdf;
  const auto with_words = [](int nc, int variable, const std::vector<std::string>& words) {
    std::string meanings;
    std::vector<signed char> codes;
    for (std::string word : words) {
      std::replace(word.begin(), word.end(), ' ', '_');
      meanings += (meanings.empty() ? "" : " ") + word;
      codes.push_back(static_cast<signed char>(codes.size()));
    }
    put_text(nc, variable, "flag_meanings", meanings);
    check(nc_put_att_schar(nc, variable, "flag_values", NC_BYTE, codes.size(), codes.data()),
          "flag_values");
  };
  Image nc;
  nc.create();
  put_text(nc, NC_GLOBAL, "format", "gatewalk traces");
  for (const auto& [name, text] : about) put_text(nc, NC_GLOBAL, name, text);
  std::size_t samples = 0;
  std::vector<std::int64_t> trial;
  std::vector<std::int32_t> row_size;
  std::vector<std::int8_t> ending;
  const auto known = endings(across_field);
  for (const Recording& r : runs) {
    samples += r.moments.size();
    trial.push_back(r.trial);
    row_size.push_back(static_cast<std::int32_t>(r.moments.size()));
    ending.push_back(
        static_cast<std::int8_t>(std::find(known.begin(), known.end(), r.ending) - known.begin()));
  }
  const int sample = define_dimension(nc, "sample", samples),
            run = define_dimension(nc, "run", runs.size());
  put_variable(nc, "run_trial", run, trial, "1", "number of the trial");
  const int sizes =
      put_variable(nc, "row_size", run, row_size, "1", "samples of a run, which follow each other");
  put_text(nc, sizes, "sample_dimension", "sample");
  with_words(nc, put_variable(nc, "ending", run, ending, "1", "how a run ended"), known);
  for (const Column& c : columns()) {
    std::vector<double> values;
    std::vector<std::int64_t> counts;
    std::vector<std::int8_t> codes;
    for (const Recording& r : runs)
      for (const Moment& m : r.moments) {
        const double x = c.value({scene.gate, m, r.trial});
        if (!c.words.empty())
          codes.push_back(static_cast<std::int8_t>(x));
        else if (c.unit == kCount)
          counts.push_back(static_cast<std::int64_t>(x));
        else
          values.push_back(x);
      }
    if (!counts.empty())
      put_variable(nc, c.name, sample, counts, c.unit, c.meaning);
    else if (c.words.empty())
      put_variable(nc, c.name, sample, values, c.unit, c.meaning);
    else
      with_words(nc, put_variable(nc, c.name, sample, codes, c.unit, c.meaning), c.words);
  }
  const std::vector<char> bytes = nc.close_image();
  return {bytes.begin(), bytes.end()};
}

Json film_of(const lattice::Scene& scene, const std::vector<Recording>& runs, bool across_field) {
  const GateParams& p = scene.gate;
  Json film;
  film["title"] = scene.source + ": F " + quantity(p.forces.propulsion, "N", 7) + ", Rm " +
                  quantity(p.forces.random, "N", 7) + ", k " + digits(p.beams.stiffness_left) +
                  " / " + digits(p.beams.stiffness_right) + ", d " + digits(p.beams.damping) +
                  ", " + p.run.method;
  const dynamics::Scale scale = dynamics::scale_of(p);
  film["scale"] = {{"length_m", scale.length}, {"mass_kg", scale.mass}, {"time_s", scale.time}};
  film["radius_m"] = p.body.radius;
  film["beam_m"] = p.beams.length;
  film["joint_x_m"] = p.beams.joint_x;
  film["joint_y_m"] = p.beams.joint_y;
  film["gate_m"] = {2.0 * p.beams.joint_x, p.run.traverse_y};
  film["columns"] = across_field ? scene.field.columns : 1;
  film["rows"] = across_field ? scene.field.rows : 1;
  film["start_column"] = across_field ? scene.field.start_column() : 0;
  film["runs"] = Json::array();
  const std::vector<std::pair<const char*, std::vector<const char*>>> arrays{
      {"t", {"time_s"}},
      {"gx", {"gate_x"}},
      {"gy", {"gate_y"}},
      {"x", {"x_m"}},
      {"y", {"y_m"}},
      {"vx", {"vx_m_per_s"}},
      {"vy", {"vy_m_per_s"}},
      {"left", {"theta_left_rad"}},
      {"right", {"theta_right_rad"}},
      {"contact_left", {"contact_left"}},
      {"contact_right", {"contact_right"}},
      {"random_N", {"random_N"}},
      {"body_J", {"kinetic_body_J"}},
      {"beams_J", {"kinetic_beams_J"}},
      {"elastic_J", {"elastic_left_J", "elastic_right_J"}},
      {"work_J", {"propulsion_work_J", "random_work_J"}},
      {"lost_J", {"lost_J"}},
      {"lost_in_hits_J", {"hit_loss_J"}}};
  for (const Recording& r : runs) {
    Json run;
    run["label"] =
        "trial " + std::to_string(r.trial) + ": " + r.ending + " after " +
        reading(r.seconds, "s", 0.01 * scale.time) +
        (across_field ? ", " + std::to_string(r.gates) + (r.gates == 1 ? " gate" : " gates") : "");
    run["ending"] = r.ending;
    run["propulsion_N"] = p.forces.propulsion;
    for (const auto& [name, parts] : arrays) run[name] = values_of(p, r, parts);
    // A film's forces hold until its next entry, a sample's acted before it.
    Json& random = run["random_N"];
    random.erase(0);
    random.push_back(random.empty() ? Json(0.0) : random.back());
    film["runs"].push_back(std::move(run));
  }
  return film;
}

void add_details(Json& film, const lattice::Scene& scene, const std::vector<Recording>& runs) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Json& run = film["runs"][i];
    run["trial"] = runs[i].trial;
    run["hits"] = runs[i].health.impacts;
    for (const char* name : {"potential_J", "elastic_left_J", "elastic_right_J", "landscape_J",
                             "landscape_left_J", "landscape_right_J"})
      run[name] = values_of(scene.gate, runs[i], {name});
  }
}

}  // namespace gatewalk::cli
