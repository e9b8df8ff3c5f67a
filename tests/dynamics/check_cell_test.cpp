#include "dynamics/cells/check_cell.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

namespace gatewalk::dynamics {
namespace {

Section two_ways() {
  Section section;
  section.faces = {{"S", 0, 1, 0, 1, "from below", {}},
                   {"W", 1, 0, 2, 0, "from the left", {}},
                   {"E", -1, 0, 1, 0, "from the right", {}}};
  section.coordinates = {{"s", "s", "1", "place", 1.0}};
  section.costs = {{"time_s", "s", "duration"}};
  return section;
}

/// Goes on to where it is headed: to the right where s > 0.
Passage straight(Body& body) {
  const double s = body.entry.at[0];
  if (body.entry.face == 0)
    body.entry = s > 0.0 ? Entry{1, {s}} : Entry{2, {-s}};
  else
    body.entry = {0, {body.entry.face == 1 ? s - 0.6 : 0.6 - s}};
  return {Fate::left, body.entry, {1.0}};
}

std::vector<Entry> some_starts() {
  std::vector<Entry> starts;
  for (int i = 0; i < 40; ++i) starts.push_back({0, {-0.975 + 0.05 * i}});
  return starts;
}

void expect_fault(const Cell& cell, const std::string& words) try {
  check_cell(cell, some_starts());
  ADD_FAILURE() << "not found: " << words;
} catch (const std::logic_error& e) {
  EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
}
/// The passage as it should be, changed.
FunctionCell changed(std::function<void(Body&, Passage&)> change, bool symmetric = false) {
  return {two_ways(),
          [=](Body& body) {
            Passage passage = straight(body);
            change(body, passage);
            return passage;
          },
          symmetric};
}

TEST(CheckCell, FindsNothingWrongWithWhatIsRight) {
  EXPECT_NO_THROW(check_cell(FunctionCell(two_ways(), straight, true), some_starts()));
  EXPECT_NO_THROW(check_cell(changed([](Body& body, Passage& passage) {
                               passage.costs[0] = body.random.uniform();
                               if (body.random.uniform() < 0.1) passage.fate = Fate::trapped;
                               if (body.random.uniform() < 0.1) passage.fate = Fate::broken;
                             }),
                             some_starts()));
}

TEST(CheckCell, FindsEntriesThatAreNone) {
  expect_fault(changed([](Body& body, Passage& p) { body.entry.face = p.next.face = 3; }),
               "face 3, which is none");
  expect_fault(changed([](Body& body, Passage& p) {
                 body.entry.at[0] = p.next.at[0] = std::numeric_limits<double>::infinity();
               }),
               "s is not finite");
  expect_fault(changed([](Body& body, Passage& p) { body.entry.at[2] = p.next.at[2] = 1.0; }),
               "a coordinate that the section does not have");
  expect_fault(changed([](Body&, Passage& p) { p.next.at[0] += 0.1; }),
               "the body's entry is not the passage's next one");
}

TEST(CheckCell, FindsCostsThatAreNone) {
  expect_fault(changed([](Body&, Passage& p) { p.costs[0] = -1.0; }), "less than no time");
  expect_fault(changed([](Body&, Passage& p) { p.costs[1] = 1.0; }),
               "a cost that the section does not have");
}

TEST(CheckCell, FindsMemoryOfTheCellsOwn) {
  std::atomic<int> calls{0};
  expect_fault(changed([&](Body&, Passage& p) { p.costs[0] = ++calls; }), "not the same bits");
}

TEST(CheckCell, FindsAMirrorThatIsNone) {
  const auto to_one_side = [](Body& body, Passage& p) {
    if (p.next.face == 1) body.entry.at[0] = p.next.at[0] += 0.01;
  };
  expect_fault(changed(to_one_side, true), "the mirror image is no passage");
}

TEST(CheckCell, FindsSectionsThatAreNotValid) {
  Section section = two_ways();
  section.faces[1].mirror = 1;
  expect_fault(FunctionCell(section, straight), "section: face W");
}

/// Many at once: `wrong` says what goes wrong then.
class Batches : public FunctionCell {
 public:
  explicit Batches(int wrong) : FunctionCell(two_ways(), straight), wrong_(wrong) {}
  void carry_out(const NextPassage& next, Health& health, std::int64_t) const override {
    Body body{.entry = {}, .random = Random(Purpose::gate, {})};
    for (bool more = next(body, nullptr); more;) {
      Passage passage = pass(body);
      if (wrong_ == 1) passage.costs[0] += 1.0;
      if (wrong_ != 2) ++health.runs;
      more = next(body, &passage);
    }
  }

 private:
  int wrong_;
};

TEST(CheckCell, FindsBatchesThatDiffer) {
  EXPECT_NO_THROW(check_cell(Batches(0), some_starts()));
  expect_fault(Batches(1), "by pass() alone");
  expect_fault(Batches(2), "are counted as 0");
}

class Numbered : public FunctionCell {
 public:
  explicit Numbered(double off) : FunctionCell(two_ways(), straight), off_(off) {}
  [[nodiscard]] std::vector<Number> numbers() const override { return {{"length_m", 1.0}}; }
  [[nodiscard]] std::unique_ptr<Cell> with(std::size_t, double value) const override {
    if (off_ < 0.0) return nullptr;
    return std::make_unique<FunctionCell>(two_ways(), [time = value + off_](Body& body) {
      Passage passage = straight(body);
      passage.costs[0] = time;
      return passage;
    });
  }

 private:
  double off_;
};

TEST(CheckCell, FindsNumbersThatAreNotTheCells) {
  EXPECT_NO_THROW(check_cell(Numbered(0.0), some_starts()));
  expect_fault(Numbered(0.5), "with length_m as it is");
  expect_fault(Numbered(-1.0), "length_m may not be what it is");
}

}  // namespace
}  // namespace gatewalk::dynamics
