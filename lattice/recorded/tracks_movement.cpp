// SPDX-License-Identifier: MIT
// Reads the NetCDF of movement (xarray): position(time, space, keypoints, individuals), with
// dimensions in any order and, since its version 0.17, in the singular; boxes have no key points.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "lattice/recorded/track_source.h"
#include "lattice/recorded/track_units.h"
#include "lattice/text/digits.h"
#include "lattice/text/toml_text.h"
#include "markov/formats/netcdf.h"

namespace gatewalk::lattice {
namespace {

using markov::netcdf::check;

/// A variable with the names and lengths of its dimensions.
struct LabelledArray {
  int id = -1;
  std::vector<std::string> dimensions;
  std::vector<std::size_t> lengths;

  /// Index of a dimension; npos if missing.
  [[nodiscard]] std::size_t along(const std::string& dimension) const {
    const auto found = std::find(dimensions.begin(), dimensions.end(), dimension);
    return found == dimensions.end() ? static_cast<std::size_t>(-1)
                                     : static_cast<std::size_t>(found - dimensions.begin());
  }
  [[nodiscard]] bool has(const std::string& dimension) const {
    return along(dimension) < dimensions.size();
  }
};

class MovementFile {
 public:
  MovementFile(const std::string& path, const TrackOptions& options) : options_(options) {
    file_.source = path;
    file_.kind = "movement";
  }

  TrackFile read() try {
    refuse_unused(!options_.columns.empty(), file_.source, "--columns",
                  "this is a NetCDF file, whose variables say what they are");
    std::ifstream in(file_.source, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(in), {});
    if (in.bad()) throw std::runtime_error("cannot be read");
    image_.open(bytes_);
    position_ = required("position");
    individual_ = position_.has("individual") ? "individual" : "individuals";
    key_point_ = position_.has("keypoint") ? "keypoint" : "keypoints";
    for (const std::string name : {"time", "space"})
      if (!position_.has(name)) throw std::runtime_error("position has no dimension " + name);
    for (const std::string& name : position_.dimensions)
      if (name != "time" && name != "space" && name != individual_ && name != key_point_)
        throw std::runtime_error("position has a dimension " + printable(name) +
                                 ", of which one has to be chosen before it is saved");
    if (position_.has(key_point_))
      point_ = key_point_in(words(key_point_), file_, options_);
    else
      refuse_unused(!options_.key_point.empty(), file_.source, "--key-point",
                    "position has no dimension of key points");
    const std::vector<double> sure = confidences();
    require_options(!sure.empty());
    const std::vector<double> times = times_of_frames();
    add_tracks(times, values_of(position_), sure);
    return std::move(file_);
  } catch (const std::runtime_error& e) {
    throw std::invalid_argument(file_.source + ": " + e.what());
  }

 private:
  std::optional<LabelledArray> find(const std::string& name) const {
    LabelledArray v;
    if (nc_inq_varid(image_, name.c_str(), &v.id) != NC_NOERR) return {};
    int count = 0;
    check(nc_inq_varndims(image_, v.id, &count), name);
    std::vector<int> ids(static_cast<std::size_t>(count));
    check(nc_inq_vardimid(image_, v.id, ids.data()), name);
    for (const int id : ids) {
      char dimension[NC_MAX_NAME + 1] = {};
      std::size_t length = 0;
      check(nc_inq_dim(image_, id, dimension, &length), name);
      v.dimensions.emplace_back(dimension);
      v.lengths.push_back(length);
    }
    return v;
  }
  LabelledArray required(const std::string& name) const {
    auto found = find(name);
    if (!found)
      throw std::runtime_error("there is no variable " + name +
                               ": movement writes position, time, space, keypoint and individual; "
                               "movement reads SLEAP's and DeepLabCut's .h5 and writes such files");
    return *found;
  }

  /// A text attribute of a variable, or of the file; empty if there is none.
  std::string text_of(const std::string& attribute, int of = NC_GLOBAL) const {
    nc_type type = NC_NAT;
    std::size_t length = 0;
    if (nc_inq_att(image_, of, attribute.c_str(), &type, &length) != NC_NOERR) return {};
    if (type == NC_CHAR) {
      std::string text(length, '\0');
      check(nc_get_att_text(image_, of, attribute.c_str(), text.data()), attribute);
      return text;
    }
    if (type != NC_STRING || length != 1) return {};
    char* raw = nullptr;
    check(nc_get_att_string(image_, of, attribute.c_str(), &raw), attribute);
    const std::string text = raw ? raw : "";
    check(nc_free_string(1, &raw), attribute);
    return text;
  }

  /// The labels along a dimension.
  std::vector<std::string> words(const std::string& name) const {
    const LabelledArray v = required(name);
    nc_type type = NC_NAT;
    check(nc_inq_vartype(image_, v.id, &type), name);
    const std::size_t count = v.lengths.empty() ? 0 : v.lengths[0];
    std::vector<std::string> all;
    if (type == NC_STRING && v.lengths.size() == 1) {
      std::vector<char*> raw(count, nullptr);
      if (count > 0) check(nc_get_var_string(image_, v.id, raw.data()), name);
      for (const char* text : raw) all.emplace_back(text ? text : "");
      if (count > 0) check(nc_free_string(count, raw.data()), name);
    } else if (type == NC_CHAR && v.lengths.size() == 2) {  // as NetCDF-3 stores them
      std::string raw(count * v.lengths[1], '\0');
      if (!raw.empty()) check(nc_get_var_text(image_, v.id, raw.data()), name);
      for (std::size_t i = 0; i < count; ++i) {
        const std::string word = raw.substr(i * v.lengths[1], v.lengths[1]);
        all.push_back(word.substr(0, word.find('\0')));
      }
    } else {
      throw std::runtime_error("the labels " + name + " are no words");
    }
    return all;
  }

  /// All numbers of a variable at the key point, if it has one, in the file's order of the other
  /// dimensions. Missing values are NaN.
  std::vector<double> values_of(const LabelledArray& v) const {
    for (const char* packed : {"scale_factor", "add_offset"})
      if (nc_inq_attid(image_, v.id, packed, nullptr) == NC_NOERR)
        throw std::runtime_error(std::string("a variable is packed (") + packed +
                                 "): save it as it is");
    std::vector<std::size_t> first(v.lengths.size(), 0), count = v.lengths;
    if (v.has(key_point_)) {
      first[v.along(key_point_)] = point_;
      count[v.along(key_point_)] = 1;
    }
    std::size_t size = 1;
    for (const std::size_t n : count) size *= n;
    std::vector<double> values(size);
    if (size > 0)
      check(nc_get_vara_double(image_, v.id, first.data(), count.data(), values.data()),
            "a variable");
    double none = 0.0;
    if (nc_get_att_double(image_, v.id, "_FillValue", &none) == NC_NOERR && !std::isnan(none))
      std::replace(values.begin(), values.end(), none, std::numeric_limits<double>::quiet_NaN());
    return values;
  }

  /// Index into the result of values_of; 0 along dimensions that the variable does not have.
  std::size_t index_of(const LabelledArray& v, std::size_t time, std::size_t space,
                       std::size_t individual) const {
    std::size_t index = 0;
    for (std::size_t k = 0; k < v.dimensions.size(); ++k) {
      const std::string& name = v.dimensions[k];
      if (name == key_point_) continue;
      index = index * v.lengths[k] + (name == "time" ? time : name == "space" ? space : individual);
    }
    return index;
  }

  /// Empty if there is no such variable, or not a single number in it.
  std::vector<double> confidences() {
    const auto v = find("confidence");
    if (!v) return {};
    if (!v->has("time") || v->has(individual_) != position_.has(individual_) ||
        v->has(key_point_) != position_.has(key_point_) ||
        v->dimensions.size() != position_.dimensions.size() - 1)
      throw std::runtime_error("confidence must have the dimensions of position but space");
    confidence_ = *v;
    auto values = values_of(*v);
    if (std::all_of(values.begin(), values.end(), [](double c) { return std::isnan(c); })) {
      if (!values.empty())
        file_.remarks.push_back("the confidences are NaN, all of them: not used");
      return {};
    }
    return values;
  }

  void require_options(bool has_confidence) {
    double given = 0.0;
    const bool has_fps = nc_get_att_double(image_, NC_GLOBAL, "fps", &given) == NC_NOERR;
    fps_ = has_fps ? given : options_.fps.value_or(0.0);
    if (has_fps && !(std::isfinite(given) && given > 0.0))
      throw std::runtime_error("its fps is " + shortest(given) + ": must be above 0");
    if (has_fps && options_.fps && *options_.fps != given)
      throw std::runtime_error("has an fps of " + shortest(given) + ", not that of --fps, " +
                               shortest(*options_.fps));
    read_time_unit();
    Lacking lacking(file_.source);
    if (fps_ == 0.0 && in_frames_) lacking.add("frames per second", "--fps N");
    if (has_confidence && !options_.confidence)
      lacking.add("from which confidence on a place counts", "--confidence X");
    lacking.refuse();
    refuse_unused(!has_confidence && options_.confidence, file_.source, "--confidence",
                  "there is no confidence in it");
    std::vector<StatedUnit> of_places;
    for (const char* attribute : {"units", "space_unit"})
      if (const std::string text = text_of(attribute, position_.id); !text.empty())
        of_places.push_back(
            {in_quotes(text), std::string("by its attribute ") + attribute, unit_called(text)});
    file_.metres_per_unit =
        metres_per_unit_of(of_places, of_places, "position", "position", file_, options_);
  }

  /// Reads the unit of times from movement's attribute of the file, and from the variable's units,
  /// which xarray gives to times that have some.
  void read_time_unit() {
    const std::string of_file = text_of("time_unit");
    std::string units = text_of("units", required("time").id);
    if (!of_file.empty() && of_file != "seconds" && of_file != "frames")
      throw std::runtime_error("its attribute time_unit is " + in_quotes(of_file) +
                               ": must be \"seconds\" or \"frames\", as movement writes it");
    if (of_file.empty() && units.empty())
      throw std::runtime_error(
          "its attribute time_unit is missing: must be \"seconds\" or \"frames\", as movement "
          "writes it; or time must have units");
    in_frames_ = of_file == "frames";
    if (units.empty()) return;
    const std::string stated = in_quotes(units);
    units.erase(std::min(units.find(" since "), units.size()));  // of a date
    const auto unit = unit_called(units);
    if (!unit || (unit->kind != UnitKind::time && unit->kind != UnitKind::frame))
      throw std::runtime_error("the units of time are " + stated +
                               ": must be seconds, milliseconds, ... or frames");
    if (!of_file.empty() && in_frames_ != (unit->kind == UnitKind::frame))
      throw std::runtime_error("its attribute time_unit is " + in_quotes(of_file) +
                               ", but the units of time are " + stated +
                               ": one of both has to be mended");
    in_frames_ = unit->kind == UnitKind::frame;
    if (in_frames_) return;
    time_unit_ = *unit;
    if (unit->in_si(1.0) != 1.0)
      file_.remarks.push_back("the units of time are " + stated + ": converted to s");
  }

  std::vector<double> times_of_frames() const {
    const LabelledArray v = required("time");
    if (v.dimensions != std::vector<std::string>{"time"})
      throw std::runtime_error("time must have the one dimension time");
    std::vector<double> times = values_of(v);
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (!std::isfinite(times[i]) || (i > 0 && times[i] <= times[i - 1]))
        throw std::runtime_error("time[" + std::to_string(i) + "] = " + shortest(times[i]) +
                                 ": times must rise");
      if (in_frames_ && times[i] != std::floor(times[i]))
        throw std::runtime_error("time[" + std::to_string(i) + "] = " + shortest(times[i]) +
                                 " is no whole frame");
    }
    for (double& t : times) t = in_frames_ ? t / fps_ : time_unit_.in_si(t);
    if (fps_ > 0.0 && !in_frames_ && times.size() > 1) {
      std::vector<double> steps(times.size());
      std::adjacent_difference(times.begin(), times.end(), steps.begin());
      steps.erase(steps.begin());
      require_steps(std::move(steps), file_.source, fps_,
                    (options_.fps ? "--fps " : "its fps of ") + shortest(fps_), "time");
    }
    return times;
  }

  /// Names of all bodies; a single one if one individual was chosen before the file was saved.
  std::vector<std::string> names_of_bodies() {
    if (position_.has(individual_)) return words(individual_);
    std::string name;
    for (const char* label : {"individuals", "individual"})
      if (const auto v = find(label); v && v->dimensions.empty()) {
        nc_type type = NC_NAT;
        char* raw = nullptr;
        check(nc_inq_vartype(image_, v->id, &type), label);
        if (type != NC_STRING) continue;
        check(nc_get_var_string(image_, v->id, &raw), label);
        name = raw ? raw : "";
        check(nc_free_string(1, &raw), label);
      }
    if (name.empty()) name = std::filesystem::path(file_.source).stem().string();
    file_.remarks.push_back("position has no dimension of individuals: one body, " +
                            printable(name));
    return {name};
  }

  void add_tracks(const std::vector<double>& times, const std::vector<double>& places,
                  const std::vector<double>& sure) {
    const auto space = words("space");
    const auto at = [&](const char* name) {
      const auto found = std::find(space.begin(), space.end(), name);
      if (found == space.end()) throw std::runtime_error(std::string("space has no ") + name);
      return static_cast<std::size_t>(found - space.begin());
    };
    const std::size_t x = at("x"), y = at("y");
    if (space.size() > 2) file_.remarks.push_back("places in space: only x and y are used");
    const auto names = names_of_bodies();
    TrackMaker maker(file_, options_);
    for (std::size_t body = 0; body < names.size(); ++body) {
      file_.tracks.push_back({names[body], {}, {}, {}});
      for (std::size_t t = 0; t < times.size(); ++t)
        maker.add(
            file_.tracks.back(), times[t], places[index_of(position_, t, x, body)],
            places[index_of(position_, t, y, body)],
            sure.empty() ? std::nullopt : std::optional(sure[index_of(confidence_, t, 0, body)]));
    }
    if (file_.places == 0) throw std::runtime_error("has no frame, or no body");
    file_.interval = fps_ > 0.0 ? 1.0 / fps_ : median_step(file_);
  }

  const TrackOptions& options_;
  TrackFile file_;
  std::vector<char> bytes_;  // the memory that image_ reads
  markov::netcdf::Image image_;
  LabelledArray position_, confidence_;
  std::string individual_, key_point_;
  bool in_frames_ = false;               // otherwise times are in time_unit_
  TrackUnit time_unit_{UnitKind::time};  // in this
  std::size_t point_ = 0;                // index of the key point, if there are any
  double fps_ = 0.0;
};

}  // namespace

TrackFile read_movement(const std::string& path, const TrackOptions& options) {
  return MovementFile(path, options).read();
}

}  // namespace gatewalk::lattice
