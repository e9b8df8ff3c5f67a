// SPDX-License-Identifier: MIT
#include "lattice/cells/track_units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "lattice/cells/track_source.h"
#include "lattice/text/digits.h"

namespace gatewalk::lattice {
namespace {

constexpr const char* kTimes = "h, min, s, ms, us, ns";

struct UnitWords {
  TrackUnit unit;
  std::array<std::string_view, 9> words;
};
constexpr std::array<UnitWords, 15> kUnits{{
    {{UnitKind::time, 1.0, 1.0}, {"s", "sec", "secs", "second", "seconds"}},
    {{UnitKind::time, 1.0, 1e3}, {"ms", "msec", "msecs", "millis", "millisecond", "milliseconds"}},
    {{UnitKind::time, 1.0, 1e6},
     {"us", "µs", "μs", "usec", "µsec", "μsec", "micros", "microsecond", "microseconds"}},
    {{UnitKind::time, 1.0, 1e9}, {"ns", "nsec", "nanosecond", "nanoseconds"}},
    {{UnitKind::time, 60.0, 1.0}, {"min", "mins", "minute", "minutes"}},
    {{UnitKind::time, 3600.0, 1.0}, {"h", "hr", "hrs", "hour", "hours"}},
    {{UnitKind::time, 86400.0, 1.0}, {"day", "days"}},
    {{UnitKind::frame}, {"frame", "frames"}},
    {{UnitKind::length, 1.0, 1.0}, {"m", "metre", "metres", "meter", "meters"}},
    {{UnitKind::length, 1.0, 1e2},
     {"cm", "centimetre", "centimetres", "centimeter", "centimeters"}},
    {{UnitKind::length, 1.0, 1e3},
     {"mm", "millimetre", "millimetres", "millimeter", "millimeters"}},
    {{UnitKind::length, 1.0, 1e6},
     {"um", "µm", "μm", "micron", "microns", "micrometre", "micrometres", "micrometer",
      "micrometers"}},
    {{UnitKind::length, 1.0, 1e9}, {"nm", "nanometre", "nanometres", "nanometer", "nanometers"}},
    {{UnitKind::length, 0.0254, 1.0}, {"inch", "inches"}},
    {{UnitKind::pixel}, {"px", "pix", "pixel", "pixels"}},
}};

[[noreturn]] void refuse_unit(const std::string& what) { throw std::invalid_argument(what); }

/// The one that is stated surely, else the first; they agree.
const StatedUnit* agreed(const std::vector<StatedUnit>& stated, const std::string& what) {
  const StatedUnit* found = nullptr;
  for (const StatedUnit& s : stated) {
    if (s.text.empty()) continue;
    if (found && found->unit && s.unit && !found->unit->same_as(*s.unit))
      refuse_unit(what + " is " + found->words() + ", and " + s.words());
    if (!found || (!found->unit && s.unit)) found = &s;
  }
  return found;
}

}  // namespace

std::optional<TrackUnit> unit_called(std::string_view text) {
  constexpr std::string_view kAround = " \t()[]{}";
  const std::size_t first = text.find_first_not_of(kAround);
  if (first == text.npos) return {};
  std::string word(text.substr(first, text.find_last_not_of(kAround) - first + 1));
  for (char& c : word)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  for (const UnitWords& unit : kUnits)
    if (std::find(unit.words.begin(), unit.words.end(), word) != unit.words.end()) return unit.unit;
  return {};
}

StatedUnit unit_in_name(const std::string& name) {
  const std::size_t end = name.find_last_not_of(" \t");
  if (end == name.npos) return {};
  const std::string where = "by its name";
  if (name[end] == ')' || name[end] == ']') {
    const std::size_t begin = name.find_last_of("([", end);
    if (begin == name.npos) return {};
    const std::string text = name.substr(begin, end - begin + 1);
    return {text, where, unit_called(text), true};
  }
  const std::size_t before = name.find_last_of("_ .-/", end);
  const std::string text = name.substr(before + 1, end - before);
  const auto unit = unit_called(text);
  const bool is_whole = before == name.npos;
  if (!unit || (is_whole && unit->kind != UnitKind::time && unit->kind != UnitKind::frame))
    return {};
  return {text, where, unit, false};
}

std::optional<TrackUnit> time_unit_of(const std::vector<StatedUnit>& stated,
                                      const std::string& what,
                                      const std::string& instead_of_frames) {
  const StatedUnit* const said = agreed(stated, what);
  if (!said) return {};
  if (said->unit && said->unit->kind == UnitKind::time) return said->unit;
  if (said->unit && said->unit->kind == UnitKind::frame)
    refuse_unit(what + " is " + said->words() + ": " + instead_of_frames);
  refuse_unit(what + " is " + said->words() + ", which is no unit of time: " + kTimes +
              " are; what means something else has to be called otherwise");
}

double metres_per_unit_of(const std::vector<StatedUnit>& of_x, const std::vector<StatedUnit>& of_y,
                          const std::string& x_name, const std::string& y_name, TrackFile& file,
                          const TrackOptions& options) {
  const auto stated = [&](const std::vector<StatedUnit>& all, const std::string& name) {
    const std::string what = file.source + ": " + name;
    const StatedUnit* const said = agreed(all, what);
    const bool is_other = said && said->unit && said->unit->kind != UnitKind::length &&
                          said->unit->kind != UnitKind::pixel;
    if (is_other && said->is_sure)
      refuse_unit(what + " is " + said->words() + ", which is no length");
    return said && said->unit && !is_other ? said : nullptr;
  };
  const StatedUnit *const x = stated(of_x, x_name), *const y = stated(of_y, y_name);
  if (x && y && !x->unit->same_as(*y->unit))
    refuse_unit(file.source + ": " + x_name + " is " + x->words() + ", " + y_name + " " +
                y->words() + ": both must be in the same unit");
  const StatedUnit* const said = x ? x : y;
  const auto given = options.metres_per_unit;
  if (!said || said->unit->kind != UnitKind::length || (!(x && y) && !given)) {
    Lacking lacking(file.source);
    if (!given && said && said->unit->kind == UnitKind::pixel)
      lacking.add("what a unit of places is, which are " + said->words(), "--metres-per-unit X");
    else if (!given)
      lacking.add("what " +
                      (x   ? y_name
                       : y ? x_name
                           : std::string("x and y")) +
                      " are in",
                  "--metres-per-unit X (1: metres)");
    lacking.refuse();
    if (!said || said->unit->kind != UnitKind::length) return *given;
  }
  const double metres = said->unit->in_si(1.0);
  if (given && std::abs(*given - metres) > 1e-9 * metres) {
    const std::string words = (x ? x_name : y_name) + " is " + said->words() + ", which is " +
                              shortest(metres) + " m; --metres-per-unit says " + shortest(*given);
    if (!said->gives_way)
      refuse_unit(file.source + ": " + words + ": leave it out, or mend what the file says");
    file.remarks.push_back(words + ", which is taken");
    file.warnings.push_back(file.source + ": " + file.remarks.back() +
                            "; without the option the file's unit is");
    return *given;
  }
  file.remarks.push_back("places are " + said->words());
  return metres;
}

}  // namespace gatewalk::lattice
