// SPDX-License-Identifier: MIT
#include "cli/fields/fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

#include "cli/fields/csv.h"
#include "cli/fields/json_value.h"
#include "cli/fields/schema.h"

namespace gatewalk::cli {
namespace {

/// A result with one number, one interval and one map, and all the code that a new result needs.
struct TrialResult {
  double speed = 0.0;
  Interval limits{};
  markov::CellProbabilities map;
};
void describe(Fields& out, const TrialResult& r) {
  out.estimate({"speed_m_per_s", "m/s", "mean speed of the bodies"}, r.speed, r.limits);
  out.grid({"visits", "1", "mean visits of each gate"}, r.map);
}
const TrialResult kTrial{
    1.5, {1.25, 1.75}, (markov::CellProbabilities(1, 2) << 0.5, 2.0).finished()};
const ResultOf kTrialResult{"trial", [](Fields& out) { describe(out, TrialResult()); }};

std::string json_text_of(const Description& describe) { return json_of(describe).dump(); }

TEST(Fields, OneDescriptionIsJson) {
  EXPECT_EQ(json_text_of([](Fields& out) { describe(out, kTrial); }),
            R"({"speed_m_per_s":1.5,"speed_m_per_s_95":[1.25,1.75],"visits":[[0.5,2.0]]})");
}

TEST(Fields, TheSameDescriptionIsATableOfNumbers) {
  EXPECT_EQ(table_of_numbers([](Fields& out) { describe(out, kTrial); }),
            "quantity,i,j,value,low_95,high_95\n"
            "speed_m_per_s,,,1.5,1.25,1.75\n"
            "visits,0,0,0.5,,\n"
            "visits,0,1,2.0,,\n");
}

TEST(Fields, TheSameDescriptionIsTheSchemaWithUnitsAndMeanings) {
  const Json schema = parsed_json(schema_of(kTrialResult));
  ASSERT_FALSE(schema.is_discarded());
  EXPECT_EQ(schema["required"].dump(),
            R"(["format_version","speed_m_per_s","speed_m_per_s_95","visits"])");
  EXPECT_EQ(schema["additionalProperties"], false);
  const Json& speed = schema["properties"]["speed_m_per_s"];
  EXPECT_EQ(speed["unit"], "m/s");
  EXPECT_EQ(speed["description"], "mean speed of the bodies");
  EXPECT_EQ(speed["type"].dump(), R"(["number","null"])");
  EXPECT_EQ(schema["properties"]["speed_m_per_s_95"]["$ref"], "#/$defs/interval");
}

TEST(Fields, AndThePageOfHelp) {
  const std::string page = result_page(kTrialResult);
  EXPECT_NE(page.find("  speed_m_per_s (number, m/s): mean speed of the bodies\n"), page.npos);
  EXPECT_NE(page.find("  visits (grid): mean visits of each gate\n"), page.npos);
}

TEST(Fields, WhatIsNoNumberIsNull) {
  EXPECT_EQ(json_text_of([](Fields& out) {
              out.number({"a", "1", "not a number"}, kUnknown);
              out.number({"b", "1", "infinite"}, std::numeric_limits<double>::infinity());
              out.estimate({"c", "1", "without interval"}, 1.0, std::nullopt);
              out.count({"d", "1", "unknown"}, std::optional<int>());
              out.text({"e", "unknown"}, std::optional<std::string>());
              out.flag({"f", "unknown"}, std::optional<bool>());
            }),
            R"({"a":null,"b":null,"c":1.0,"c_95":null,"d":null,"e":null,"f":null})");
}

/// Describes each kind of object and list; with `is_full`, all optional parts too.
Description all_parts(bool is_full) {
  return [is_full](Fields& out) {
    const std::vector<int> items = is_full ? std::vector{1, 2} : std::vector<int>();
    out.list({"items", "some"}, items, [](Fields& f, int i) {
      f.count({"n", "1", "its number"}, i);
    });
    out.list(Label("more", "some, or none").shared("things"),
             is_full ? std::optional(items) : std::nullopt, [](Fields& f, int i) {
               f.count({"n", "1", "its number"}, i);
             });
    out.optional(is_full, [](Fields& f) { f.flag({"extra", "only there"}, true); });
    out.maybe({"part", "or none"}, is_full ? std::optional(3) : std::nullopt, [](Fields& f, int i) {
      f.count({"n", "1", "its number"}, i);
    });
    out.number_or_object({"or", "1", "a number, or how small it is"},
                         is_full ? std::nullopt : std::optional(2.0), [](Fields& f) {
                           f.number({"below", "1", "more than the number"}, 5.0);
                         });
    out.either(
        is_full,
        [](Fields& f) {
          f.count({"one", "1", "of two"}, 1);
          f.object({"both", "of either"}, [](Fields& b) {
            b.count({"first", "1", "of one"}, 1);
            b.count({"last", "1", "of both"}, 2);
          });
        },
        [](Fields& f) {
          f.count({"other", "1", "of two"}, 2);
          f.object({"both", "of either"}, [](Fields& b) {
            b.count({"last", "1", "of both"}, 2);
            b.count({"new", "1", "of the other"}, 3);
          });
        });
    out.object({"by", "of each cost"},
               [](Fields& f) { f.number(Field("work_J", "J", "of it").varying("<cost>"), 4.0); });
    out.counted({"seen", "1", "that were seen"}, 7, 10.0, Interval{0.25, 0.75});
  };
}

TEST(Fields, PartsThatMayBeMissing) {
  EXPECT_EQ(json_text_of(all_parts(true)),
            R"({"items":[{"n":1},{"n":2}],"more":[{"n":1},{"n":2}],"extra":true,"part":{"n":3},)"
            R"("or":{"below":5.0},"one":1,"both":{"first":1,"last":2},)"
            R"("by":{"work_J":4.0},"seen":7,"seen_95":[2.5,7.5]})");
  EXPECT_EQ(json_text_of(all_parts(false)),
            R"({"items":[],"more":null,"part":null,"or":2.0,"other":2,"both":{"last":2,"new":3},)"
            R"("by":{"work_J":4.0},"seen":7,"seen_95":[2.5,7.5]})");
}

TEST(Fields, TheSchemaIsThatOfAllResultsWhateverTheExampleHas) {
  const std::string full = schema_of({"x", all_parts(true)});
  EXPECT_EQ(full, schema_of({"x", all_parts(false)}));
  const Json schema = parsed_json(full), &keys = schema["properties"];
  EXPECT_EQ(schema["required"].dump(),
            R"(["format_version","items","more","part","or","both","by","seen","seen_95"])");
  EXPECT_EQ(schema["oneOf"].dump(), R"([{"required":["one"]},{"required":["other"]}])");
  EXPECT_EQ(keys["items"]["items"]["required"].dump(), R"(["n"])");
  EXPECT_EQ(keys["more"]["anyOf"].dump(), R"([{"type":"null"},{"$ref":"#/$defs/things"}])");
  EXPECT_EQ(schema["$defs"]["things"]["items"]["required"].dump(), R"(["n"])");
  EXPECT_EQ(keys["both"]["required"].dump(), R"(["last"])");
  EXPECT_EQ(keys["both"]["properties"].size(), 3);
  EXPECT_EQ(keys["part"]["type"].dump(), R"(["object","null"])");
  EXPECT_EQ(keys["or"]["type"].dump(), R"(["object","number","null"])");
  EXPECT_EQ(keys["by"]["additionalProperties"]["unit"], "J");
}

/// Describes values that are neither numbers nor lists of numbers.
void describe_others(Fields& out) {
  out.text_rows({"best", "in each gate"}, {{"a", std::nullopt}, {"b", "a"}});
  out.given({"step", "its own", "as it was given"}, "0.5");
  out.givens({"values", "its own", "as they were given"}, {"6", "6.0", "1e400", "auto"});
  out.points({"way_m", "m", "places"}, {{0.0, 1.5}, {kUnknown, 2.0}});
}

TEST(Fields, TextsOfGatesWhatAUserGaveAndPlaces) {
  EXPECT_EQ(json_text_of(describe_others),
            R"({"best":[["a",null],["b","a"]],"step":0.5,"values":[6,6.0,"1e400","auto"],)"
            R"("way_m":[[0.0,1.5],[null,2.0]]})");
  const Json schema = parsed_json(schema_of({"x", describe_others})), &keys = schema["properties"];
  EXPECT_EQ(keys["best"]["items"]["items"]["type"].dump(), R"(["string","null"])");
  EXPECT_EQ(keys["values"]["items"]["type"].dump(), R"(["number","string"])");
  EXPECT_EQ(keys["way_m"]["items"]["maxItems"], 2);
}

/// Describes the intervals of an object, which holds another object, and of a map.
void describe_estimates(Fields& out) {
  static const markov::CellProbabilities map{{0.5, 1.0}};
  static const GateLimits limits{map - 0.25, map + 0.25};
  out.estimates({"ends", "by ending"}, [](Fields& f) {
    f.counted({"left", "1", "that left"}, 7, 10.0, Interval{0.25, 0.75});
    f.optional(true, [](Fields& o) {
      o.estimate({"back", "1", "that went back"}, 0.5, Interval{kUnknown, kUnknown});
    });
    f.object({"inner", "of its own"}, [](Fields& o) {
      o.estimate({"x", "1", "a number"}, 2.0, Interval{1.0, kUnknown});
    });
  });
  out.grid({"map", "1", "by gate"}, map, limits);
}

TEST(Fields, IntervalsHaveTheFormOfWhatTheyAreOf) {
  EXPECT_EQ(json_text_of(describe_estimates),
            R"({"ends":{"left":7,"back":0.5,"inner":{"x":2.0,"x_95":[1.0,null]}},)"
            R"("ends_95":{"left":[2.5,7.5],"back":null},)"
            R"("map":[[0.5,1.0]],"map_95":[[[0.25,0.75],[0.75,1.25]]]})");
  const Json schema = parsed_json(schema_of({"x", describe_estimates})),
             &keys = schema["properties"];
  EXPECT_EQ(keys["ends_95"]["required"].dump(), R"(["left"])");
  EXPECT_EQ(keys["ends_95"]["properties"]["back"]["$ref"], "#/$defs/interval");
  EXPECT_EQ(keys["map_95"]["items"]["items"]["$ref"], "#/$defs/interval");
}

TEST(Fields, TheTableOfNumbersHasLimitsBesideTheirNumbers) {
  EXPECT_EQ(table_of_numbers(describe_estimates),
            "quantity,i,j,value,low_95,high_95\n"
            "ends.left,,,7,2.5,7.5\n"
            "ends.back,,,0.5,,\n"
            "ends.inner.x,,,2.0,1.0,\n"
            "map,0,0,0.5,0.25,0.75\n"
            "map,0,1,1.0,0.75,1.25\n");
  EXPECT_EQ(table_of_numbers(describe_others),
            "quantity,i,j,value,low_95,high_95\n"
            "step,,,0.5,,\n"
            "values,0,,6,,\n"
            "values,1,,6.0,,\n"
            "way_m,0,0,0.0,,\n"
            "way_m,0,1,1.5,,\n"
            "way_m,1,0,,,\n"
            "way_m,1,1,2.0,,\n");
}

TEST(Fields, TheTableOfNumbersCallsItemsByTheirNamesAndLeavesOutWordsAndOrigin) {
  struct Item {
    std::string name;
    std::vector<double> x;
  };
  const std::vector<Item> items{{"a,b", {1.0}}, {"", {2.0, kUnknown}}};
  EXPECT_EQ(table_of_numbers([&](Fields& out) {
              out.list({"items", "some"}, items, [](Fields& f, const Item& item) {
                f.numbers({"x", "1", "numbers"}, item.x);
                if (!item.name.empty()) f.text({"name", "its name"}, item.name);
                f.flag({"ok", "whether"}, true);
              });
              out.text({"about", "words"}, "words");
              out.count({"none", "1", "unknown"}, std::optional<int>());
              out.gate_numbers({"by_gate", "1", "lists"}, GateNumbers{1, 2, {1, 2, 3, 4}});
              out.object({"made_by", "origin"}, [](Fields& f) { f.count({"seed", "1", "s"}, 1); });
            }),
            "quantity,i,j,value,low_95,high_95\n"
            "\"items.a,b.x\",0,,1.0,,\n"
            "\"items.a,b.ok\",,,1,,\n"
            "items.1.x,0,,2.0,,\n"
            "items.1.x,1,,,,\n"
            "items.1.ok,,,1,,\n"
            "none,,,,,\n"
            "by_gate.0.0,0,,1.0,,\n"
            "by_gate.0.0,1,,2.0,,\n"
            "by_gate.0.1,0,,3.0,,\n"
            "by_gate.0.1,1,,4.0,,\n");
}

/// The path without the first "_95" at the end of a key.
std::string without_95(std::string path) {
  for (std::size_t at = path.find("_95"); at != path.npos; at = path.find("_95", at + 1))
    if (const char next = path.size() > at + 3 ? path[at + 3] : '.'; next == '.' || next == '[')
      return path.erase(at, 3);
  return "";
}

/// The last key of a path.
std::string last_key(const std::string& path) { return path.substr(path.rfind('.') + 1); }

TEST(Fields, EveryResultHasItsIntervalsBesideTheirNumbers) {
  // Intervals whose number is not in the result: observed minus predicted, and a null model's
  // range.
  const std::set<std::string> alone{"excess_95", "excess_95.<way>", "time_scales_chance_95"};
  // Keys ending in _95 that are upper bounds, not intervals.
  const std::set<std::string> bounds{"error_95", "kernel_error_95", "worst_kernel_error_95",
                                     "corrcoef_95", "rmse_per_100_95"};
  int intervals = 0;
  for (const ResultOf& of : results())
    for (const KeyList& list : keys_of(of))
      for (const KeyLine& line : list.keys) {
        const std::string number = without_95(line.path), about = of.command + (": " + line.path);
        const bool has_number =
            !number.empty() &&
            std::ranges::find(list.keys, number, &KeyLine::path) != list.keys.end();
        if (line.type.find("interval") != std::string::npos) {
          const bool is_alone = std::ranges::any_of(alone, [&](const std::string& key) {
            return line.path.ends_with("." + key) ||
                   line.path.find("." + key + ".") != line.path.npos;
          });
          EXPECT_NE(has_number, is_alone) << about << " is of no number beside it";
          ++intervals;
        } else if (last_key(line.path).ends_with("_95") && !line.type.starts_with("object")) {
          EXPECT_TRUE(bounds.contains(last_key(line.path))) << about << " is no interval";
        }
      }
  EXPECT_GT(intervals, 100);
}

TEST(Fields, AKeyWithoutMeaningOrAListWithoutItemIsAMistakeOfTheProgram) {
  EXPECT_THROW((void)schema_of({"x",
                                [](Fields& out) {
                                  out.flag({"a", ""}, true);
                                }}),
               std::logic_error);
  EXPECT_THROW((void)schema_of({"x",
                                [](Fields& out) {
                                  out.list_of({"a", "some"}, 0, [](Fields&, std::size_t) {});
                                }}),
               std::logic_error);
}

}  // namespace
}  // namespace gatewalk::cli
