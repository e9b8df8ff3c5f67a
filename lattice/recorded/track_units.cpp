// SPDX-License-Identifier: MIT
#include "lattice/recorded/track_units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "lattice/recorded/track_source.h"
#include "lattice/text/digits.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {
namespace {

constexpr const char* kTimes = "h, min, s, ms, us, ns";

struct UnitWords {
  TrackUnit unit;
  std::array<std::string_view, 9> words;
};
constexpr std::array<UnitWords, 18> kUnits{{
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
    {{UnitKind::length, 1e3, 1.0}, {"km", "kilometre", "kilometres", "kilometer", "kilometers"}},
    {{UnitKind::length, 1.0, 10.0}, {"dm", "decimetre", "decimetres", "decimeter", "decimeters"}},
    {{UnitKind::length, 0.3048, 1.0}, {"ft", "foot", "feet"}},
    {{UnitKind::length, 0.0254, 1.0}, {"in", "inch", "inches"}},
    {{UnitKind::pixel}, {"px", "pix", "pixel", "pixels"}},
}};

// Units that count even in the middle of a name ("time_ms_rel"), because they have no other
// meaning.
constexpr std::array<std::string_view, 24> kUnmistakable{
    "ms",          "msec",        "msecs",        "millis",  "millisecond", "milliseconds",
    "us",          "µs",          "μs",           "usec",    "µsec",        "μsec",
    "micros",      "microsecond", "microseconds", "ns",      "nsec",        "nanosecond",
    "nanoseconds", "sec",         "secs",         "seconds", "minutes",     "hours"};

struct Word {
  std::string_view text, gap;  // gap: the text between this word and the one before
  std::size_t begin;
};

/// The words of a name: "timeMs_rel" gives time, Ms, rel. Letters beyond ASCII (µ) are letters.
std::vector<Word> words_in(std::string_view text) {
  const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto is_upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  const auto is_part = [&](char c) {
    return is_lower(c) || is_upper(c) || (c >= '0' && c <= '9') ||
           static_cast<unsigned char>(c) >= 0x80;
  };
  std::vector<Word> words;
  for (std::size_t at = 0;;) {
    std::size_t begin = at;
    while (begin < text.size() && !is_part(text[begin])) ++begin;
    if (begin == text.size()) return words;
    std::size_t end = begin + 1;
    while (end < text.size() && is_part(text[end]) &&
           !(is_lower(text[end - 1]) && is_upper(text[end])))
      ++end;
    words.push_back({text.substr(begin, end - begin), text.substr(at, begin - at), begin});
    at = end;
  }
}

bool is_time(const std::optional<TrackUnit>& unit) {
  return unit && (unit->kind == UnitKind::time || unit->kind == UnitKind::frame);
}

/// Where "mm/s", "mm per s" or "mm s-1" begins; npos if nothing is per time. In a name, a time
/// counts only after a length; in brackets "(1/s)" counts too.
std::size_t begin_of_speed(std::string_view text, bool is_name) {
  const std::vector<Word> words = words_in(text);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].text.find("⁻¹") != text.npos) return words[i].begin;
    if (!is_time(unit_called(words[i].text))) continue;
    const bool is_per = i > 0 && in_small_letters(words[i - 1].text) == "per";
    const bool is_inverse =
        i + 1 < words.size() && words[i + 1].text == "1" && words[i + 1].gap.find('-') != text.npos;
    if (!is_per && !is_inverse && words[i].gap.find('/') == text.npos) continue;
    const std::size_t behind = i < 1U + is_per ? text.npos : i - 1 - is_per;
    const auto unit = behind == text.npos ? std::nullopt : unit_called(words[behind].text);
    if (!is_name || (unit && !is_time(unit))) return words[behind == text.npos ? i : behind].begin;
  }
  return text.npos;
}

/// The word that stands for frame numbers, as in "FrameNumber", but not in "frame_time" or "time of
/// frame"; else null.
const Word* frames_in(const std::vector<Word>& words) {
  const Word* found = nullptr;
  bool has_time = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = in_small_letters(words[i].text);
    const bool is_of = has_time && (in_small_letters(words[i - 1].text) == "of" ||
                                    in_small_letters(words[i - 1].text) == "per");
    if (word.find("time") != word.npos || word == "t" || word == "clock" || word == "elapsed" ||
        word == "stamp") {
      has_time = true;
      found = nullptr;
    } else if (word.find("frame") != word.npos && !is_of) {
      found = &words[i];
    }
  }
  return found;
}

/// True for words that are units in brackets, but usually mean something else at the end of a name.
bool is_ambiguous(std::string_view word) {
  return word == "in" || word == "foot" || word == "feet";
}

[[noreturn]] void refuse_unit(const std::string& what) { throw std::invalid_argument(what); }

/// The unit stated with certainty, else the first one; throws if units disagree.
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
  const std::string word =
      in_small_letters(text.substr(first, text.find_last_not_of(kAround) - first + 1));
  for (const UnitWords& unit : kUnits)
    if (std::find(unit.words.begin(), unit.words.end(), word) != unit.words.end()) return unit.unit;
  return {};
}

StatedUnit unit_in_name(const std::string& name) {
  const std::string where = "by its name";
  if (const std::size_t close = name.find_last_of(")]}"); close != name.npos) {
    const std::size_t begin = name.find_last_of("([{", close);
    const bool is_end = name.find_last_not_of(" \t") == close;
    if (begin == name.npos && is_end) return {};
    if (begin != name.npos) {
      const std::string text = name.substr(begin, close - begin + 1);
      const auto unit = unit_called(text);
      if (is_end || unit || begin_of_speed(text, false) != text.npos)
        return {text, where, unit, true};
    }
  }
  const std::vector<Word> words = words_in(name);
  if (words.empty()) return {};
  if (const std::size_t begin = begin_of_speed(name, true); begin != name.npos)
    return {name.substr(begin), where, {}, true};
  const auto stated = [&](const Word& word, const std::optional<TrackUnit>& unit) {
    return StatedUnit{std::string(word.text), where, unit, false};
  };
  const Word* const frames = frames_in(words);
  for (std::size_t i = words.size(); i-- > 0;) {
    const Word& word = words[i];
    const auto unit = unit_called(word.text);
    if (!unit || unit->kind == UnitKind::frame) {
      if (&word == frames && i + 1 == words.size()) break;
      continue;
    }
    const bool is_last = i + 1 == words.size();
    // A single letter, as in xM.
    const bool is_letter = word.text.size() == 1 && i > 0 && word.gap.empty();
    const bool is_known = is_last ? !is_letter && !is_ambiguous(in_small_letters(word.text)) &&
                                        (words.size() > 1 || unit->kind == UnitKind::time)
                                  : std::find(kUnmistakable.begin(), kUnmistakable.end(),
                                              in_small_letters(word.text)) != kUnmistakable.end();
    if (is_known) return stated(word, unit);
  }
  return frames ? stated(*frames, TrackUnit{UnitKind::frame}) : StatedUnit{};
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
  const auto given = options.metres_per_unit;
  // A time at the end of a name of a place means something else: x_s is smoothed.
  const auto of_length = [](std::vector<StatedUnit> all) {
    std::erase_if(all, [](const StatedUnit& s) { return !s.is_sure && is_time(s.unit); });
    return all;
  };
  const std::vector<StatedUnit> all_of_x = of_length(of_x), all_of_y = of_length(of_y);
  const auto stated = [&](const std::vector<StatedUnit>& all,
                          const std::string& name) -> const StatedUnit* {
    const std::string what = file.source + ": " + name;
    const StatedUnit* const said = agreed(all, what);
    if (!said) return nullptr;
    if (is_time(said->unit) || (!said->unit && begin_of_speed(said->text, false) != name.npos))
      refuse_unit(what + " is " + said->words() + ", which is no length");
    if (said->unit) return said;
    if (given) {
      const std::string words = name + " is " + said->words() +
                                ", which is no length that is known; --metres-per-unit " +
                                shortest(*given) + " is used";
      if (std::find(file.remarks.begin(), file.remarks.end(), words) == file.remarks.end()) {
        file.remarks.push_back(words);
        file.warnings.push_back(file.source + ": " + words);
      }
    }
    return nullptr;
  };
  const StatedUnit *const x = stated(all_of_x, x_name), *const y = stated(all_of_y, y_name);
  if (x && y && !x->unit->same_as(*y->unit))
    refuse_unit(file.source + ": " + x_name + " is " + x->words() + ", " + y_name + " " +
                y->words() + ": both must be in the same unit");
  const StatedUnit* const said = x ? x : y;
  if (!said || said->unit->kind != UnitKind::length || (!(x && y) && !given)) {
    Lacking lacking(file.source);
    if (!given && said && said->unit->kind == UnitKind::pixel)
      lacking.add("how long a pixel is (places are " + said->words() + ")",
                  "--metres-per-unit X, 0.00005 for pixels of 0.05 mm");
    else if (!given)
      lacking.add("what " + (x   ? y_name + " is in"
                             : y ? x_name + " is in"
                                 : std::string("x and y are in")),
                  "--metres-per-unit X (1: metres)");
    lacking.refuse();
    if (!said || said->unit->kind != UnitKind::length) return *given;
  }
  const double metres = said->unit->in_si(1.0);
  if (given && std::abs(*given - metres) > 1e-9 * metres) {
    const std::string words = (x ? x_name : y_name) + " is " + said->words() + ", which is " +
                              shortest(metres) + " m; --metres-per-unit ";
    if (!said->gives_way)
      refuse_unit(file.source + ": " + words + "says " + shortest(*given) +
                  ": leave it out, or mend what the file says");
    file.remarks.push_back(words + shortest(*given) + " is used");
    file.warnings.push_back(file.source + ": " + file.remarks.back() +
                            ". Leave the option out to use the file's unit.");
    return *given;
  }
  file.remarks.push_back("places are " + said->words());
  return metres;
}

}  // namespace gatewalk::lattice
