// SPDX-License-Identifier: MIT
// Reads DeepLabCut's CSV: rows scorer, (individuals,) bodyparts, coords, then one row per frame.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "lattice/recorded/track_source.h"
#include "lattice/text/digits.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {
namespace {

/// Columns of one individual's key point; 0: none.
struct KeyPointColumns {
  std::string individual;
  std::size_t x = 0, y = 0, likelihood = 0;
};

class WideTable {
 public:
  WideTable(Table& table, const TrackOptions& options) : options_(options), table_(table) {
    file_.source = table.lines().name();
    file_.kind = "DeepLabCut";
  }

  TrackFile read() {
    refuse_unused(!options_.columns.empty(), file_.source, "--columns",
                  "this is a table of DeepLabCut, whose columns say what they are");
    read_header();
    const std::vector<KeyPointColumns> places = places_of_key_point();
    require_options(places);
    file_.metres_per_unit = *options_.metres_per_unit;
    for (const KeyPointColumns& place : places)
      file_.tracks.push_back({place.individual, {}, {}, {}});
    TrackMaker maker(file_, options_);
    double last = -std::numeric_limits<double>::infinity();
    while (table_.next()) {
      const auto frame = table_.number(table_[0]);
      if (!frame || !is_frame(*frame))
        table_.refuse("the frame " + in_quotes(std::string(table_[0])) +
                      " is no whole number of at most 10^12");
      if (*frame <= last)
        table_.refuse("frame " + shortest(*frame) + " comes behind frame " + shortest(last));
      last = *frame;
      for (std::size_t i = 0; i < places.size(); ++i) {
        const KeyPointColumns& at = places[i];
        maker.add(file_.tracks[i], *frame / *options_.fps, number(at.x), number(at.y),
                  at.likelihood > 0 ? std::optional(number(at.likelihood)) : std::nullopt);
      }
    }
    if (file_.places == 0) throw std::invalid_argument(file_.source + ": has no frame");
    for (std::string& remark : table_.remarks()) file_.remarks.push_back(std::move(remark));
    file_.interval = 1.0 / *options_.fps;
    return std::move(file_);
  }

 private:
  void read_header() {
    const auto require = [&](bool there, const std::string& name) {
      if (!there)
        table_.refuse(
            "the row " + name +
            " is missing: a table of DeepLabCut begins with rows scorer, individuals (where "
            "there are several), bodyparts, coords");
    };
    const auto next = [&](Table::Names& row) {
      if (!table_.next()) return false;
      row.assign(table_.fields().begin(), table_.fields().end());
      return true;
    };
    Table::Names row;
    require(next(row) && (row[0] == "individuals" || row[0] == "bodyparts"), "bodyparts");
    if (row[0] == "individuals") {
      individuals_ = row;
      require(next(row) && row[0] == "bodyparts", "bodyparts");
    }
    bodyparts_ = row;
    require(next(coords_) && coords_[0] == "coords", "coords");
  }

  /// The columns of all individuals that have the key point.
  std::vector<KeyPointColumns> places_of_key_point() {
    std::vector<std::string> names;
    for (std::size_t c = 1; c < bodyparts_.size(); ++c)
      if (std::find(names.begin(), names.end(), bodyparts_[c]) == names.end())
        names.push_back(bodyparts_[c]);
    if (names.empty()) table_.refuse("there are no columns of any body part");
    const std::string key_point = names[key_point_in(names, file_, options_)];
    std::vector<KeyPointColumns> places;
    std::vector<std::string> left_out;
    for (std::size_t c = 1; c < bodyparts_.size(); ++c) {
      if (bodyparts_[c] != key_point) continue;
      const std::string who = individuals_.empty()
                                  ? std::filesystem::path(file_.source).stem().string()
                                  : individuals_[c];
      auto place = std::find_if(places.begin(), places.end(),
                                [&](const KeyPointColumns& p) { return p.individual == who; });
      if (place == places.end()) place = places.insert(place, {who});
      std::size_t* const at = coords_[c] == "x"            ? &place->x
                              : coords_[c] == "y"          ? &place->y
                              : coords_[c] == "likelihood" ? &place->likelihood
                                                           : nullptr;
      if (!at) {
        if (std::find(left_out.begin(), left_out.end(), coords_[c]) == left_out.end())
          left_out.push_back(coords_[c]);
        continue;
      }
      if (*at > 0)
        table_.refuse(coords_[c] + " of " + printable(key_point) + " of " + printable(who) +
                      " stands there twice");
      *at = c;
    }
    for (const KeyPointColumns& place : places)
      if (place.x == 0 || place.y == 0)
        table_.refuse("of " + printable(key_point) + " of " + printable(place.individual) +
                      " there is no " + (place.x == 0 ? "x" : "y"));
    std::string all;
    for (const std::string& name : left_out) all += (all.empty() ? "" : ", ") + printable(name);
    if (!all.empty()) file_.remarks.push_back("coords " + all + " left out");
    return places;
  }

  void require_options(const std::vector<KeyPointColumns>& places) {
    bool any_likelihood = false;
    for (const KeyPointColumns& place : places) any_likelihood |= place.likelihood > 0;
    Lacking lacking(file_.source);
    if (!options_.fps) lacking.add("frames per second", "--fps N");
    if (!options_.metres_per_unit)
      lacking.add("how long a pixel is", "--metres-per-unit X, 0.00005 for pixels of 0.05 mm");
    if (any_likelihood && !options_.confidence)
      lacking.add("from which likelihood on a place counts", "--confidence X");
    lacking.refuse();
    if (!any_likelihood && options_.confidence)
      file_.warnings.push_back(file_.source +
                               ": there is no likelihood of this key point: every place counts, "
                               "whatever --confidence says");
  }

  double number(std::size_t column) {
    const auto value = table_.number(table_[column]);
    if (!value)
      table_.refuse("column " + std::to_string(column + 1) + " (" + printable(bodyparts_[column]) +
                    " " + coords_[column] + "): " + in_quotes(std::string(table_[column])) +
                    " is no number");
    return *value;
  }

  const TrackOptions& options_;
  Table& table_;
  TrackFile file_;
  std::vector<std::string> individuals_, bodyparts_, coords_;
};

}  // namespace

bool is_of_deeplabcut(const Table::Names& line) { return line.size() > 1 && line[0] == "scorer"; }

TrackFile read_deeplabcut(Table& table, const TrackOptions& options) {
  return WideTable(table, options).read();
}

}  // namespace gatewalk::lattice
