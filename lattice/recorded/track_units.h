// SPDX-License-Identifier: MIT
#pragma once
/// Units that files of tracks state: believed, or refused, never passed over. Not part of the
/// installed headers.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/recorded/tracks.h"

namespace gatewalk::lattice {

enum class UnitKind : std::uint8_t { time, frame, length, pixel };

struct TrackUnit {
  UnitKind kind;
  double above = 1.0, below = 1.0;  // x of it is x * above / below in s, or in m

  [[nodiscard]] double in_si(double x) const { return x * above / below; }
  [[nodiscard]] bool same_as(const TrackUnit& other) const {
    return kind == other.kind && in_si(1.0) == other.in_si(1.0);
  }
};

/// The unit that is called so, "ms", "sec", "micron", "px", "frame"; brackets and capitals are no
/// matter. None for any other text.
[[nodiscard]] std::optional<TrackUnit> unit_called(std::string_view text);

/// What a file says that a column, or a variable, is in.
struct StatedUnit {
  std::string text;               // "(ms)"; empty: nothing
  std::string where;              // "in the row of units"
  std::optional<TrackUnit> unit;  // none: nothing that is known
  bool is_sure = true;            // false: the end of a name, which may mean something else
  bool gives_way = false;         // to the user: programs write it whether it was set or not

  [[nodiscard]] std::string words() const { return "in " + text + ", " + where; }
};

/// What the name of a column says: "Time [ms]", "t_ms", "x (cm)", "timeMs"; "mm/s" of "x_mm/s",
/// which is no unit. Units of time that cannot be anything else count anywhere in it
/// ("time_ms_rel"), and so do frames ("frame_idx", but not "frame_time").
[[nodiscard]] StatedUnit unit_in_name(const std::string& name);

/// The unit of times; none: nothing is stated. Throws std::invalid_argument, beginning with `what`,
/// for what is no unit of time, and for frames.
[[nodiscard]] std::optional<TrackUnit> time_unit_of(const std::vector<StatedUnit>& stated,
                                                    const std::string& what,
                                                    const std::string& instead_of_frames);

/// Metres of a unit of places, as the file states it of x and of y, or as the user does. Throws
/// std::invalid_argument where both do and differ, where nobody does, and for what is no length. A
/// unit that gives way, or that nobody knows, is a warning then.
[[nodiscard]] double metres_per_unit_of(const std::vector<StatedUnit>& of_x,
                                        const std::vector<StatedUnit>& of_y,
                                        const std::string& x_name, const std::string& y_name,
                                        TrackFile& file, const TrackOptions& options);

}  // namespace gatewalk::lattice
