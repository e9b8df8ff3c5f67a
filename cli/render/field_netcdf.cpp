// SPDX-License-Identifier: MIT
#include "cli/render/field_netcdf.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "markov/formats/netcdf.h"

namespace gatewalk::cli {
namespace {

using markov::CellProbabilities;

/// Writes a map for each start.
template <class MapOf>
void put_maps(int nc, const std::array<int, 3>& dimensions, const char* name, const char* meaning,
              const std::vector<FieldPicture>& fields, const MapOf& map_of) {
  using namespace markov::netcdf;
  constexpr int kShuffle = 1, kDeflate = 1, kLevel = 4;
  int variable = -1;
  check(nc_def_var(nc, name, NC_DOUBLE, 3, dimensions.data(), &variable), name);
  check(nc_def_var_deflate(nc, variable, kShuffle, kDeflate, kLevel), name);
  check(nc_def_var_fletcher32(nc, variable, NC_FLETCHER32), name);
  put_text(nc, variable, "units", "1");
  put_text(nc, variable, "long_name", meaning);
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const CellProbabilities& map = map_of(fields[k]);
    const std::array<std::size_t, 3> first{k, 0, 0};
    const std::array<std::size_t, 3> count{1, static_cast<std::size_t>(map.rows()),
                                           static_cast<std::size_t>(map.cols())};
    check(nc_put_vara_double(nc, variable, first.data(), count.data(), map.data()), name);
  }
}

std::vector<std::int32_t> numbers_from(int first, Eigen::Index count) {
  std::vector<std::int32_t> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

}  // namespace

std::string netcdf_of(const std::vector<FieldPicture>& fields, const ShownField& shown,
                      const Provenance& made_by) {
  const dynamics::Section& section = shown.map.section;
  const Eigen::Index rows = fields.front().final_gates.rows(),
                     columns = fields.front().final_gates.cols();
  using namespace markov::netcdf;
  Image nc;
  nc.create();
  put_text(nc, NC_GLOBAL, "format", "gatewalk final gates");
  put_conventions(nc);
  put_text(nc, NC_GLOBAL, "title", "Where bodies end in a field of gates, by start");
  for (const auto& [key, text] : attributes_of(made_by)) put_text(nc, NC_GLOBAL, key, text);
  const int start = define_dimension(nc, "start", fields.size()),
            i_y = define_dimension(nc, "i_y", static_cast<std::size_t>(rows)),
            i_x = define_dimension(nc, "i_x", static_cast<std::size_t>(columns));
  put_variable(nc, "i_y", i_y, numbers_from(0, rows), "1", "row of gates, the near one is 0");
  put_variable(nc, "i_x", i_x, numbers_from(-shown.field.start_column(), columns), "1",
               "column of gates, that of the start is 0");
  const auto of_starts = [&](const std::string& name, const char* unit, const std::string& meaning,
                             const auto& value) {
    std::vector<double> values;
    for (const FieldPicture& f : fields) values.push_back(value(f));
    put_variable(nc, name, start, values, unit, meaning);
  };
  if (std::any_of(fields.begin(), fields.end(),
                  [](const auto& f) { return f.start && f.start->face != 0; }))
    of_starts("start_face", "1", "face by which it entered: " + numbers_of(section.faces),
              [](const auto& f) { return f.start ? f.start->face : std::nan(""); });
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    const dynamics::Coordinate& c = section.coordinates[axis];
    of_starts("start_" + c.name, c.unit.c_str(), "where it began: " + c.words,
              [axis](const auto& f) { return f.start ? f.start->at[axis] : std::nan(""); });
  }
  for (const EndingName& e : kEndingNames)
    of_starts(e.key, "1", std::string("share of all: ") + e.name, [&](const FieldPicture& f) {
      return f.endings.share[static_cast<std::size_t>(e.ending)];
    });
  const std::array<int, 3> dimensions{start, i_y, i_x};
  const auto maps = [&](const char* name, const char* meaning, const auto& map_of) {
    put_maps(nc, dimensions, name, meaning, fields, map_of);
  };
  maps(
      "final_gates", "share of all that ended in this gate, however",
      [](const FieldPicture& f) -> const auto& { return f.final_gates; });
  maps(
      "trapped_gates", "share of all that was trapped in this gate",
      [](const FieldPicture& f) -> const auto& { return f.trapped; });
  maps(
      "departed_gates", "share of all that departed from this gate",
      [](const FieldPicture& f) -> const auto& { return f.departed; });
  if (std::all_of(fields.begin(), fields.end(),
                  [](const FieldPicture& f) { return !!f.gates_95; })) {
    maps(
        "final_gates_low", "95 % interval of final_gates, lower end",
        [](const FieldPicture& f) -> const auto& { return (*f.gates_95)[0]; });
    maps(
        "final_gates_high", "95 % interval of final_gates, upper end",
        [](const FieldPicture& f) -> const auto& { return (*f.gates_95)[1]; });
  }
  const std::vector<char> bytes = nc.close_image();
  return {bytes.begin(), bytes.end()};
}

}  // namespace gatewalk::cli
