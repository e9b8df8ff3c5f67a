// SPDX-License-Identifier: MIT
// Every key of a scene, from the reader's own table: what the reader refuses, and that the message
// names file, line, key and what is allowed. A new key is tested automatically.

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/scene/scene.h"
#include "lattice/scene/units.h"
#include "lattice/text/digits.h"
#include "tests/support/refusal.h"

namespace gatewalk::lattice {

static void PrintTo(const KeyInfo& key, std::ostream* out) { *out << key.key; }

namespace {

using test::scene_refusal;

class SceneKeys : public testing::TestWithParam<KeyInfo> {
 protected:
  [[nodiscard]] static const std::string& key() { return GetParam().key; }
  [[nodiscard]] static std::string table() { return key().substr(0, key().find('.')); }
  [[nodiscard]] static std::string leaf() { return key().substr(key().find('.') + 1); }
  [[nodiscard]] static bool is_text() { return GetParam().value.starts_with('"'); }
  [[nodiscard]] static bool is_whole() {
    return !is_text() && GetParam().value.find_first_of(".e") == std::string::npos;
  }
  /// "[0, 1e+100] N"; empty for a key of text.
  [[nodiscard]] static std::string allowed() {
    return GetParam().range + (GetParam().unit.empty() ? "" : " " + GetParam().unit);
  }
  /// The lowest and the highest number, and whether they are permitted.
  struct Range {
    double low, high;
    bool low_open, high_open;
  };
  [[nodiscard]] static Range range() {
    const std::string& text = GetParam().range;
    return {std::stod(text.substr(1)), std::stod(text.substr(text.find(", ") + 2)), text[0] == '(',
            text.back() == ')'};
  }
};

std::string test_name_of(const testing::TestParamInfo<KeyInfo>& k) {
  std::string name = k.param.key;
  for (char& c : name)
    if (c == '.') c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Of, SceneKeys, testing::ValuesIn(describe(Scene{})), test_name_of);

/// A value in TOML, and as messages show it.
struct GivenValue {
  std::string toml, shown;
};

// In a file, in a file by its full name, and by --set.
void expect_refused_value(const std::string& table, const std::string& leaf,
                          const GivenValue& value, const std::string& reason) {
  const std::string key = table + "." + leaf;
  const std::string message = ": " + key + value.shown + " is not permitted: must " + reason;
  EXPECT_EQ(scene_refusal("# a scene\n[" + table + "]\n\n" + leaf + " = " + value.toml + "\n"),
            "bad.toml:4" + message);
  EXPECT_EQ(scene_refusal(key + " = " + value.toml), "bad.toml:1" + message);
  EXPECT_EQ(scene_refusal("", {key + "=" + value.toml}),
            "--set " + key + "=" + value.toml + message);
}

TEST_P(SceneKeys, RefusesNumbersBeyondItsRange) {
  if (is_text()) return;
  const auto [low, high, low_open, high_open] = range();
  const auto number = [](double x) { return GivenValue{toml_float(x), " = " + toml_float(x)}; };
  const auto whole = [](double x) {
    const std::string digits = std::to_string(static_cast<std::int64_t>(x));
    return GivenValue{digits, " = " + digits};
  };
  std::vector<GivenValue> beyond;
  if (is_whole()) {
    beyond = {whole(low - 1), whole(high + 1), whole(-5e9), whole(4294967297.0 + low)};
  } else {
    beyond = {number(low - std::max(1e-3, 1e-3 * std::abs(low))),
              number(high + std::abs(high)),
              number(1.01 * high),
              number(-1e300),
              number(1e300),
              {"nan", " = nan"},
              {"inf", " = inf"},
              {"+inf", " = inf"},
              {"-inf", " = -inf"}};
    if (low_open) beyond.push_back(number(low));
    if (high_open) beyond.push_back(number(high));
  }
  for (const GivenValue& value : beyond)
    expect_refused_value(table(), leaf(), value, "lie in " + allowed());
}

TEST_P(SceneKeys, RefusesOtherTypes) {
  std::vector<GivenValue> other{{"true", " = true"},
                                {"[20]", " (an array)"},
                                {"{ a = 20 }", " (a table)"},
                                {"2020-01-01", " (a date or time)"}};
  std::string reason = "be a number in " + allowed();
  if (is_whole()) {
    reason = "be a whole number in " + allowed();
    other.push_back({"9.0", " = 9.0"});
  }
  if (is_text()) {
    reason = key() == "run.method" ? "be text, such as \"stable\""
                                   : "be one of \"active\", \"remember\", \"all\"";
    other.push_back({"3", " = 3"});
  } else {
    other.push_back({"\"20\"", " = \"20\""});
  }
  for (const GivenValue& value : other) {
    // On the command line, text may stand without quotes.
    if (is_text() && value.toml.find('"') == std::string::npos) {
      EXPECT_EQ(scene_refusal("[" + table() + "]\n" + leaf() + " = " + value.toml),
                "bad.toml:2: " + key() + value.shown + " is not permitted: must " + reason);
      continue;
    }
    expect_refused_value(table(), leaf(), value, reason);
  }
}

TEST_P(SceneKeys, RefusesTextThatItDoesNotKnow) {
  if (!is_text()) return;
  for (const std::string name : {"nosuch", "", "Stable"}) {
    const std::string begin = key() + " = \"" + name + "\" is not permitted: must be one of \"";
    EXPECT_TRUE(scene_refusal(key() + " = '" + name + "'").starts_with("bad.toml:1: " + begin))
        << name;
    EXPECT_TRUE(scene_refusal("", {key() + "=" + name})
                    .starts_with("--set " + key() + "=" + name + ": " + begin))
        << name;
  }
}

TEST_P(SceneKeys, RefusesToBeGivenTwice) {
  const std::string line = leaf() + " = " + GetParam().value;
  EXPECT_EQ(scene_refusal("[" + table() + "]\n" + line + "\n" + line + "\n"),
            "bad.toml:3: " + line + ": is given in line 2 already");
  EXPECT_EQ(scene_refusal("", {key() + "=" + GetParam().value, key() + "=" + GetParam().value}),
            "(accepted)");
}

TEST_P(SceneKeys, IsNamedWhereItIsMisspelled) {
  const auto expect_named = [](const std::string& wrong) {
    const std::string what = scene_refusal("\n" + wrong + " = 1\n");
    // Either the closest key, or, of a key with another unit, the units that it may have.
    const std::string begin = "bad.toml:2: unknown key " + wrong;
    EXPECT_TRUE(what.starts_with(begin + "; the closest known key") ||
                what.starts_with(begin + ": " + key() + " may end in _"))
        << what;
    EXPECT_NE(what.find(key()), what.npos) << what;
  };
  expect_named(table() + "." + leaf()[0] + leaf());
  expect_named(key() + "x");
  std::string upper = key();
  upper[table().size() + 1] = static_cast<char>(std::toupper(upper[table().size() + 1]));
  expect_named(upper);
}

// Types of gates, and actions, also have some of these keys.
TEST_P(SceneKeys, MayBelongToATypeOfGateOrAnAction) {
  const auto expect = [](const std::string& of, const std::string& begin, bool has) {
    const std::string what = scene_refusal(begin + "\n[" + of + "]\n" + key() + " = nan\n");
    const std::string named = "bad.toml:3: " + of + "." + key();
    if (has)
      EXPECT_EQ(what, named + " = nan is not permitted: must lie in " + allowed());
    else
      EXPECT_TRUE(what.starts_with(named + " is not permitted: ")) << what;
  };
  const bool beams = table() == "beams" && !leaf().starts_with("joint"),
             forces = table() == "forces";
  expect("actions.s", "", beams || forces);
  expect("terrain.types.s", "terrain.random = { s = 0.5 }",
         beams || forces || table() == "contact");
}

// A key's unit may have another prefix, c only for lengths and speeds; messages then give the range
// in that unit. Other units are refused.
TEST_P(SceneKeys, TakesUnitsWithAPrefixAndNoOthers) {
  const std::string& own_unit = GetParam().unit;
  if (own_unit.empty()) return;
  const bool kilogram = own_unit == "kg";
  std::string stem;
  int taken = 0;
  for (const std::string prefix : {"k", "c", "m", "u", "n", ""}) {
    // The prefix stands before the unit, which is everything after the name.
    for (std::size_t at = leaf().find('_'); at != std::string::npos;
         at = leaf().find('_', at + 1)) {
      std::string other = leaf();
      other.replace(at + 1, kilogram ? 1 : 0, prefix);
      const auto unit = unit_of(table() + "." + other, key());
      if (!unit || other == leaf()) continue;
      ++taken;
      stem = leaf().substr(0, at + 1);
      const double own = in_own_unit(3.0, *unit);
      EXPECT_NEAR(own, 3.0 * std::pow(10.0, unit->power), 1e-12 * own);
      const std::string what = scene_refusal("[" + table() + "]\n" + other + " = nan\n");
      EXPECT_TRUE(what.starts_with("bad.toml:2: " + table() + "." + other +
                                   " = nan is not permitted: must lie in "))
          << what;
      EXPECT_TRUE(what.ends_with(" " + unit->shown)) << what;
      const std::string twice =
          scene_refusal("[" + table() + "]\n" + leaf() + " = 1\n" + other + " = 1\n");
      EXPECT_EQ(twice, "bad.toml:3: " + table() + "." + other + " = 1 is the same quantity as " +
                           key() + " = 1 (bad.toml:2): give one of them");
    }
  }
  const bool centi = own_unit == "m" || own_unit == "m/s";
  EXPECT_EQ(taken, centi ? 5 : 4);
  std::vector<std::string> others{"ft", own_unit == "s" ? "m" : "s",
                                  "M" + leaf().substr(stem.size())};
  if (!centi) others.push_back("c" + leaf().substr(stem.size()));
  for (const std::string& other : others) {
    const std::string wrong = stem + other;
    const std::string what = scene_refusal("[" + table() + "]\n" + wrong + " = 1\n");
    EXPECT_TRUE(what.starts_with("bad.toml:2: unknown key " + table() + "." + wrong)) << what;
    EXPECT_NE(what.find(key()), what.npos) << what;
  }
}

}  // namespace
}  // namespace gatewalk::lattice
