// SPDX-License-Identifier: MIT
#include "cli/render/fields.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "cli/render/json.h"
#include "cli/render/schema.h"

namespace gatewalk::cli {
namespace {

/// A result with one number, one interval and one map: all that a new result needs is below.
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

/// Every kind of thing that may hold others; `is_full`: with all that is optional.
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
    out.with_intervals_in({"intervals_95", "of the shares"}, [](Fields& f) {
      f.counted({"seen", "1", "that were seen"}, 7, Interval{0.25, 0.75});
    });
  };
}

TEST(Fields, PartsThatMayBeMissing) {
  EXPECT_EQ(json_text_of(all_parts(true)),
            R"({"items":[{"n":1},{"n":2}],"more":[{"n":1},{"n":2}],"extra":true,"part":{"n":3},)"
            R"("or":{"below":5.0},"one":1,"both":{"first":1,"last":2},)"
            R"("by":{"work_J":4.0},"seen":7,"intervals_95":{"seen":[0.25,0.75]}})");
  EXPECT_EQ(json_text_of(all_parts(false)),
            R"({"items":[],"more":null,"part":null,"or":2.0,"other":2,"both":{"last":2,"new":3},)"
            R"("by":{"work_J":4.0},"seen":7,"intervals_95":{"seen":[0.25,0.75]}})");
}

TEST(Fields, TheSchemaIsThatOfAllResultsWhateverTheExampleHas) {
  const std::string full = schema_of({"x", all_parts(true)});
  EXPECT_EQ(full, schema_of({"x", all_parts(false)}));
  const Json schema = parsed_json(full), &keys = schema["properties"];
  EXPECT_EQ(schema["required"].dump(),
            R"(["format_version","items","more","part","or","both","by","seen","intervals_95"])");
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

/// What is no number, or a list of lists.
void describe_others(Fields& out) {
  out.text_rows({"best", "in each gate"}, {{"a", std::nullopt}, {"b", "a"}});
  out.given({"step", "its own", "as it was given"}, "0.5");
  out.givens({"values", "its own", "as they were given"}, {"6", "6.0", "1e400", "auto"});
  out.points({"way_m", "m", "places"}, {{0.0, 1.5}, {kUnknown, 2.0}});
  out.with_intervals_in(
      {"intervals_95", "of these"},
      [](Fields& f) {
        f.counted({"seen", "1", "that were seen"}, 7, Interval{0.25, 0.75});
      },
      [](Fields& f) {
        f.interval({"right", "1", "of what has no count"}, Interval{0.5, kUnknown});
      });
}

TEST(Fields, TextsOfGatesWhatAUserGavePlacesAndMoreIntervals) {
  EXPECT_EQ(json_text_of(describe_others),
            R"({"best":[["a",null],["b","a"]],"step":0.5,"values":[6,6.0,"1e400","auto"],)"
            R"("way_m":[[0.0,1.5],[null,2.0]],"seen":7,)"
            R"("intervals_95":{"seen":[0.25,0.75],"right":[0.5,null]}})");
  const Json schema = parsed_json(schema_of({"x", describe_others})), &keys = schema["properties"];
  EXPECT_EQ(keys["best"]["items"]["items"]["type"].dump(), R"(["string","null"])");
  EXPECT_EQ(keys["values"]["items"]["type"].dump(), R"(["number","string"])");
  EXPECT_EQ(keys["way_m"]["items"]["maxItems"], 2);
  EXPECT_EQ(keys["intervals_95"]["required"].dump(), R"(["seen","right"])");
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
