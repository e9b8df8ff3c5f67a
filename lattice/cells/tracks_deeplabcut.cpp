// SPDX-License-Identifier: MIT
// DeepLabCut's CSV: rows scorer, (individuals,) bodyparts, coords, then a row a frame.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "lattice/cells/track_source.h"
#include "lattice/text/csv.h"
#include "lattice/text/digits.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {
namespace {

/// Where one individual's key point stands in a row; 0: nowhere.
struct KeyPointColumns {
  std::string individual;
  std::size_t x = 0, y = 0, likelihood = 0;
};

class WideTable {
 public:
  WideTable(const std::string& path, const TrackOptions& options)
      : options_(options), in_(path, std::ios::binary) {
    file_.source = path;
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
    for (std::vector<std::string> row; next(row);) {
      const auto frame = coordinate_in(row[0]);
      if (!frame || !is_frame(*frame))
        refuse("the frame " + in_quotes(row[0]) + " is no whole number of at most 10^12");
      if (*frame <= last)
        refuse("frame " + shortest(*frame) + " comes behind frame " + shortest(last));
      last = *frame;
      for (std::size_t i = 0; i < places.size(); ++i) {
        const KeyPointColumns& at = places[i];
        maker.add(file_.tracks[i], *frame / *options_.fps, number(row, at.x), number(row, at.y),
                  at.likelihood > 0 ? std::optional(number(row, at.likelihood)) : std::nullopt);
      }
    }
    if (file_.places == 0) throw std::invalid_argument(file_.source + ": has no frame");
    file_.interval = 1.0 / *options_.fps;
    return std::move(file_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::invalid_argument(file_.source + ":" + std::to_string(line_) + ": " + what);
  }

  bool next(std::vector<std::string>& row) {
    std::string text;
    do {
      if (!next_line_of(in_, file_.source, text)) return false;
      if (++line_ == 1 && text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
      if (text.ends_with('\r')) text.pop_back();
    } while (text.empty());
    auto fields = csv_fields(text);
    if (!fields) refuse("a quotation mark is not closed, or not at a field's end");
    if (columns_ > 0 && fields->size() != columns_)
      refuse("has " + std::to_string(fields->size()) + " fields, the first line " +
             std::to_string(columns_));
    columns_ = fields->size();
    row = std::move(*fields);
    return true;
  }

  void read_header() {
    const auto require = [&](bool there, const std::string& name) {
      if (!there)
        refuse("the row " + name +
               " is missing: a table of DeepLabCut begins with rows scorer, individuals (where "
               "there are several), bodyparts, coords");
    };
    std::vector<std::string> row;
    (void)next(row);  // scorer, which is known to be there
    require(next(row) && (row[0] == "individuals" || row[0] == "bodyparts"), "bodyparts");
    if (row[0] == "individuals") {
      individuals_ = row;
      require(next(row) && row[0] == "bodyparts", "bodyparts");
    }
    bodyparts_ = row;
    require(next(coords_) && coords_[0] == "coords", "coords");
  }

  /// Of every individual that has the key point.
  std::vector<KeyPointColumns> places_of_key_point() {
    std::vector<std::string> names;
    for (std::size_t c = 1; c < bodyparts_.size(); ++c)
      if (std::find(names.begin(), names.end(), bodyparts_[c]) == names.end())
        names.push_back(bodyparts_[c]);
    if (names.empty()) refuse("there are no columns of any body part");
    const std::string key_point = names[key_point_in(names, file_, options_)];
    std::vector<KeyPointColumns> places;
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
      if (!at) refuse("coords " + in_quotes(coords_[c]) + " is none of x, y, likelihood");
      if (*at > 0)
        refuse(coords_[c] + " of " + printable(key_point) + " of " + printable(who) +
               " stands there twice");
      *at = c;
    }
    for (const KeyPointColumns& place : places)
      if (place.x == 0 || place.y == 0)
        refuse("of " + printable(key_point) + " of " + printable(place.individual) +
               " there is no " + (place.x == 0 ? "x" : "y"));
    return places;
  }

  void require_options(const std::vector<KeyPointColumns>& places) const {
    bool any_likelihood = false;
    for (const KeyPointColumns& place : places) any_likelihood |= place.likelihood > 0;
    Lacking lacking(file_.source);
    if (!options_.fps) lacking.add("frames per second", "--fps N");
    if (!options_.metres_per_unit) lacking.add("what a pixel is", "--metres-per-unit X");
    if (any_likelihood && !options_.confidence)
      lacking.add("from which likelihood on a place counts", "--confidence X");
    lacking.refuse();
    refuse_unused(!any_likelihood && options_.confidence, file_.source, "--confidence",
                  "there is no likelihood of this key point");
  }

  double number(const std::vector<std::string>& row, std::size_t column) const {
    const auto value = coordinate_in(row[column]);
    if (!value)
      refuse("column " + std::to_string(column + 1) + " (" + printable(bodyparts_[column]) + " " +
             coords_[column] + "): " + in_quotes(row[column]) + " is no number");
    return *value;
  }

  const TrackOptions& options_;
  std::ifstream in_;
  TrackFile file_;
  std::size_t line_ = 0, columns_ = 0;
  std::vector<std::string> individuals_, bodyparts_, coords_;
};

}  // namespace

TrackFile read_deeplabcut(const std::string& path, const TrackOptions& options) {
  return WideTable(path, options).read();
}

}  // namespace gatewalk::lattice
