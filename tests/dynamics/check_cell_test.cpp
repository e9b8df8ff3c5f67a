// SPDX-License-Identifier: MIT
#include "dynamics/cells/check_cell.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace gatewalk::dynamics {
namespace {

using Complaints = std::vector<std::string>;

Section upright() {
  return {.faces = {{"S", 0, 1, 0, 0b1, "from below"}, {"N", 0, -1, 1, 0b1, "from above"}},
          .coordinates = {{"s", "s_m", "m", "place"}},
          .costs = {{"time_s", "s", "duration"}}};
}
/// A valid passage: the body gets a random place on a face, and sometimes the other face.
Passage fine(Body& body) {
  Passage passage{Fate::left, {}, {1.0 + body.random.uniform()}};
  passage.next.face = body.random.uniform() < 0.25 ? 1 - body.entry.face : body.entry.face;
  passage.next.at[0] = 0.5 * body.entry.at[0] + body.random.uniform() - 0.5;
  if (body.random.uniform() < 0.1) return {Fate::trapped, {}, {9.0}};
  body.entry = passage.next;
  return passage;
}
const std::vector<Entry> kTwoStarts{{0, {0.25}}, {1, {-0.1}}};

Complaints checked(FunctionCell::Pass pass, bool symmetric = false) {
  return check_cell(FunctionCell(upright(), std::move(pass), symmetric), kTwoStarts);
}
/// The complaints about a cell whose passages are right except for one change.
Complaints spoilt(const std::function<void(Body&, Passage&)>& spoil) {
  return checked([=](Body& body) {
    Passage passage = fine(body);
    spoil(body, passage);
    return passage;
  });
}
void expect_complaint(const Complaints& complaints, const std::string& words) {
  for (const std::string& complaint : complaints)
    if (complaint.find(words) != complaint.npos) return;
  ADD_FAILURE() << "no '" << words << "' in: " << testing::PrintToString(complaints);
}

TEST(CheckCell, FindsNothingWrongWithAFineOne) { EXPECT_EQ(checked(fine, true), Complaints{}); }

TEST(CheckCell, FindsMemoryOfTheCellsOwn) {
  auto passed = std::make_shared<std::atomic<int>>(0);
  const Complaints complaints =
      spoilt([=](Body&, Passage& passage) { passage.costs[0] += 1e-12 * (*passed)++; });
  expect_complaint(complaints, "passage 0 of trial 0 is another one carried out once more");
  expect_complaint(complaints, "is another one on four threads");
  expect_complaint(complaints, "is another one one by one in reverse order");
}

TEST(CheckCell, FindsCostsThatAreNone) {
  const auto with_time = [](double time) {
    return spoilt([=](Body&, Passage& passage) { passage.costs[0] = time; });
  };
  expect_complaint(with_time(std::nan("")), "time_s is not finite");
  expect_complaint(with_time(std::numeric_limits<double>::infinity()), "time_s is not finite");
  expect_complaint(with_time(0.0), "time_s is not > 0");
  expect_complaint(spoilt([](Body&, Passage& p) { p.costs[1] = 1.0; }),
                   "a cost that the section lacks");
}

TEST(CheckCell, FindsEntriesThatAreNone) {
  const auto with_next = [](const std::function<void(Entry&)>& spoil) {
    return spoilt([=](Body& body, Passage& passage) {
      if (passage.fate != Fate::left) return;
      spoil(passage.next);
      body.entry = passage.next;
    });
  };
  expect_complaint(with_next([](Entry& e) { e.face = 2; }),
                   "it left by face number 2, there are 2");
  expect_complaint(with_next([](Entry& e) { e.at[0] = std::nan(""); }), "s is not finite");
  expect_complaint(with_next([](Entry& e) { e.at[1] = 1.0; }),
                   "a coordinate that the section lacks");
  expect_complaint(spoilt([](Body& body, Passage&) { body.entry.at[0] += 1.0; }),
                   "the body is not where the passage says that it left");
}

TEST(CheckCell, FindsBreaksAndExceptions) {
  expect_complaint(spoilt([](Body& body, Passage& passage) {
                     if (body.trial == 3) passage.fate = Fate::broken;
                   }),
                   "passages broke");
  expect_complaint(checked([](Body&) -> Passage { throw std::runtime_error("no such luck"); }),
                   "it threw: no such luck");
}

TEST(CheckCell, FindsASymmetryThatIsNone) {
  const auto to_the_left = [](Body& body) {
    const int face = body.entry.at[0] < 0.2;
    Passage passage = fine(body);
    if (passage.fate == Fate::left) passage.next.face = body.entry.face = face;
    return passage;
  };
  EXPECT_EQ(checked(to_the_left, false), Complaints{});
  expect_complaint(checked(to_the_left, true), "it says that it is symmetric");
}

TEST(CheckCell, FindsSectionsAndStartsThatAreNone) {
  Section section = upright();
  section.faces[1].mirror = 0;
  expect_complaint(check_cell(FunctionCell(section, fine), kTwoStarts),
                   "it threw: section: face N is not");
  expect_complaint(check_cell(FunctionCell(upright(), fine), {{2, {}}}),
                   "a start is on face number 2, there are 2");
  EXPECT_THROW((void)check_cell(FunctionCell(upright(), fine), {}), std::invalid_argument);
}

/// A cell that takes more bodies at once than permitted, and counts none of them.
class Greedy : public FunctionCell {
 public:
  Greedy() : FunctionCell(upright(), fine) {}
  void carry_out(const NextPassage& next, Health&, std::int64_t at_once) const override {
    std::vector<Body> bodies;
    Body body{.entry = {}, .random = Random(Purpose::gate, {})};
    while (std::ssize(bodies) <= at_once && next(body, nullptr)) bodies.push_back(body);
    for (Body& one : bodies)
      for (Passage passage = pass(one); next(one, &passage);) passage = pass(one);
  }
};

TEST(CheckCell, FindsBatchesThatAreTooLarge) {
  const Complaints complaints = check_cell(Greedy(), kTwoStarts);
  expect_complaint(complaints, "carry_out had 8 bodies at once, allowed were 7");
  expect_complaint(complaints, "carry_out counted 0 passages of");
}

/// A cell with a number that cannot be changed, or is changed wrongly.
class Numbered : public FunctionCell {
 public:
  explicit Numbered(bool changes) : FunctionCell(upright(), fine), changes_(changes) {}
  [[nodiscard]] std::vector<Number> numbers() const override { return {{"mass_kg", 2.0}}; }
  [[nodiscard]] std::unique_ptr<Cell> with(std::size_t, double) const override {
    if (!changes_) return nullptr;
    return std::make_unique<FunctionCell>(upright(), [](Body& body) {
      (void)body.random.word();
      return fine(body);
    });
  }

 private:
  bool changes_;
};

TEST(CheckCell, FindsNumbersThatDoNotKeepTheCell) {
  expect_complaint(check_cell(Numbered(false), kTwoStarts),
                   "it cannot be had with once its own mass_kg");
  expect_complaint(check_cell(Numbered(true), kTwoStarts),
                   "is another one by a copy with the same mass_kg");
}

using CarryOut = void (*)(const Cell&, std::int64_t, const BeginBody&, const TakePassage&, Health&);

/// Runs trials of up to `most` passages; returns their outcomes, by trial.
std::vector<std::vector<Passage>> carried_out(const Cell& cell, std::int64_t trials, int threads,
                                              CarryOut carry_out = carry_out_trials,
                                              std::size_t most = 5) {
  std::vector<std::vector<Passage>> all(static_cast<std::size_t>(trials));
  tbb::task_arena(threads).execute([&] {
    Health health;
    carry_out(
        cell, trials,
        [&](Body& body) {
          body.entry = kTwoStarts[static_cast<std::size_t>(body.trial % 2)];
          body.random = Random(Purpose::field, {.trial = static_cast<std::uint64_t>(body.trial)});
          cell.begin(body);
        },
        [&](Body& body, const Passage& passage) {
          auto& trial = all[static_cast<std::size_t>(body.trial)];
          trial.push_back(passage);
          return passage.fate == Fate::left && trial.size() < most;
        },
        health);
    std::int64_t passages = 0;
    for (const auto& trial : all) passages += std::ssize(trial);
    EXPECT_EQ(health.runs, passages);
  });
  return all;
}

// Of n passages at most n / 20 + 4 are repeated; in a long run far fewer.
TEST(OnceMore, CostsLittleAndChangesNothing) {
  for (const std::int64_t trials : {1, 3, 40, 2000, 40'000})
    for (const int threads : {1, 4}) {
      auto calls = std::make_shared<std::atomic<std::int64_t>>(0);
      const FunctionCell cell(upright(), [=](Body& body) {
        ++*calls;
        return fine(body);
      });
      const auto once = carried_out(cell, trials, threads, carry_out_trials_once);
      const std::int64_t passages = calls->exchange(0);
      const auto some_twice = carried_out(cell, trials, threads);
      const std::int64_t more = *calls - passages;
      EXPECT_GT(more, 0) << trials;
      EXPECT_LE(more, passages / 20 + 4) << trials;
      if (trials == 40'000) {
        EXPECT_LT(more, passages / 100);
      }
      for (std::size_t t = 0; t < once.size(); ++t) {
        ASSERT_EQ(once[t].size(), some_twice[t].size());
        for (std::size_t k = 0; k < once[t].size(); ++k) {
          EXPECT_EQ(once[t][k].next, some_twice[t][k].next);
          EXPECT_EQ(once[t][k].costs, some_twice[t][k].costs);
        }
      }
    }
}

TEST(OnceMore, FindsCellsThatDependOnMoreThanTheBody) {
  const auto refusal = [](const FunctionCell& cell, std::int64_t trials, int threads) {
    try {
      (void)carried_out(cell, trials, threads);
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string("nothing refused");
  };
  for (const std::int64_t trials : {1, 100, 5000})
    for (const int threads : {1, 4}) {
      auto passed = std::make_shared<std::atomic<int>>(0);
      const FunctionCell counts(upright(), [=](Body& body) {
        body.entry = {0, {0.5}};
        return Passage{Fate::left, {0, {0.5}}, {1.0 + (*passed)++}};
      });
      const std::string said = refusal(counts, trials, threads);
      EXPECT_NE(said.find("in two ways: a body that entered by "), said.npos) << said;
      EXPECT_NE(said.find("left by S (s = 0.5), time_s = "), said.npos) << said;
      EXPECT_NE(said.find(", in another order, it left by S (s = 0.5), time_s = "), said.npos)
          << said;
    }
  // The cell turns wrong late: a long run is checked repeatedly.
  auto passed = std::make_shared<std::atomic<int>>(0);
  const FunctionCell late(upright(), [=](Body& body) {
    const int n = (*passed)++;
    Passage passage = fine(body);
    if (n > 20'000) passage.costs[0] += n;
    return passage;
  });
  EXPECT_NE(refusal(late, 40'000, 1).find("answers the same passage in two ways"),
            std::string::npos);
}

}  // namespace
}  // namespace gatewalk::dynamics
