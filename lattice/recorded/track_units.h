// SPDX-License-Identifier: MIT
#pragma once
/// Units that files of tracks state: each one is used or refused, never ignored. Not part of the
/// installed headers.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/recorded/tracks.h"

namespace gatewalk::lattice {

enum class UnitKind : std::uint8_t { time, frame, length, pixel };

/// A unit of time, frames, length or pixels.
struct TrackUnit {
  UnitKind kind;
  double above = 1.0, below = 1.0;  // a value x in this unit is x * above / below in s, or in m

  [[nodiscard]] double in_si(double x) const { return x * above / below; }
  [[nodiscard]] bool same_as(const TrackUnit& other) const {
    return kind == other.kind && in_si(1.0) == other.in_si(1.0);
  }
};

/// The unit of this name, such as "ms", "sec", "micron", "px", "frame", whatever brackets and
/// capitals; nullopt for any other text.
[[nodiscard]] std::optional<TrackUnit> unit_called(std::string_view text);

/// The unit that a file states for a column or a variable.
struct StatedUnit {
  std::string text;               // "(ms)"; empty: none
  std::string where;              // "in the row of units"
  std::optional<TrackUnit> unit;  // nullopt: an unknown unit
  bool is_sure = true;            // false: the end of a name, which may mean something else
  /// true: the user's unit goes first, because programs write this one whether it was set or not
  bool gives_way = false;

  [[nodiscard]] std::string words() const { return "in " + text + ", " + where; }
};

/// The unit in the name of a column: "Time [ms]", "t_ms", "x (cm)", "timeMs"; "mm/s" of "x_mm/s",
/// which is no unit here. Unmistakable units of time count anywhere in the name ("time_ms_rel"),
/// and so do frames ("frame_idx", but not "frame_time").
[[nodiscard]] StatedUnit unit_in_name(const std::string& name);

/// The unit of times; nullopt if none is stated. Throws std::invalid_argument, with a message that
/// begins with `what`, for anything but a unit of time, and for frames.
[[nodiscard]] std::optional<TrackUnit> time_unit_of(const std::vector<StatedUnit>& stated,
                                                    const std::string& what,
                                                    const std::string& instead_of_frames);

/// Metres per unit of places, stated by the file for x and y, or by the user. Throws
/// std::invalid_argument if both state it and differ, if neither does, and for units that are no
/// length. A stated unit that is unknown or gives way (StatedUnit) then causes a warning.
[[nodiscard]] double metres_per_unit_of(const std::vector<StatedUnit>& of_x,
                                        const std::vector<StatedUnit>& of_y,
                                        const std::string& x_name, const std::string& y_name,
                                        TrackFile& file, const TrackOptions& options);

}  // namespace gatewalk::lattice
