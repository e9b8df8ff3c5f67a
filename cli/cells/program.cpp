// SPDX-License-Identifier: MIT
#include "cli/cells/program.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstring>
#include <deque>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "cli/cells/answer.h"
#include "cli/cells/hello.h"
#include "cli/cells/process.h"

namespace gatewalk::cli {
namespace {

using namespace dynamics;

constexpr std::size_t kMostInFlight = 4096;
constexpr std::size_t kMostOut = std::size_t{1} << 16;  // bytes that wait to be read
constexpr std::string_view kNoMemory = "-";
// How many new processes repeat passages for the check that outcomes are the same. A few passages
// may agree by chance, so each new process after the first repeats at least kEnough.
constexpr int kMostStarts = 4;
constexpr std::int64_t kEnough = 4;

template <class Number>
void append(std::string& line, Number x) {
  std::array<char, 32> digits;
  line += ' ';
  line.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr);
}

void append_noise(std::string& line, const Hello& hello, Random& random) {
  std::string noise;
  append(line, draw_noise(hello, random, [&](double x) { append(noise, x); }));
  line += noise;
}

/// Appends the line ID FACE COORDINATES... SEED NOISE... MEMORY.
void append_passage(std::string& line, const Hello& hello, std::uint64_t id, Body& body) {
  std::array<char, 32> digits;
  line.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), id).ptr);
  line += ' ';
  line += hello.section.faces[body.entry.face].name;
  for (std::size_t k = 0; k < hello.section.coordinates.size(); ++k) append(line, body.entry.at[k]);
  append_noise(line, hello, body.random);
  line += ' ';
  line += body.carried.as<CarriedWords>().words();
  line += '\n';
}

/// The index of a parameter. Throws std::invalid_argument if the program does not have the
/// parameter or does not permit the value.
std::size_t parameter_of(const Hello& hello, const Cell::Number& wanted) {
  std::string all;
  for (std::size_t k = 0; k < hello.parameters.size(); ++k) {
    const Hello::Parameter& p = hello.parameters[k];
    if (p.number.key == wanted.key) {
      if (p.permits(wanted.value)) return k;
      throw std::invalid_argument(
          fmt::format("cell program: parameter '{}' must be {}", wanted.key, p.range()));
    }
    all += (k > 0 ? ", " : ", but ") + p.number.key;
  }
  throw std::invalid_argument(
      fmt::format("cell program: it has no parameter '{}'{}", wanted.key, all));
}

/// Puts the values of some parameters into `values`, the values of all.
void put(std::vector<double>& values, const Hello& hello, const std::vector<Cell::Number>& set) {
  for (const Cell::Number& number : set) values[parameter_of(hello, number)] = number.value;
}

}  // namespace

struct ProgramCell::Program {
  Program(std::string command_, const ProgramOptions& options_)
      : command(std::move(command_)), options(options_) {}
  std::string command;
  ProgramOptions options;
  Hello hello;
  std::string first_line;
  // How many new processes may still repeat passages.
  mutable std::atomic<int> starts_again{kMostStarts};
};

struct ProgramCell::Running {
  Running(const std::string& command, const ProgramOptions& options)
      : process(command, options.timeout_s) {}
  Process process;
  std::uint64_t sent = 0;  // lines sent, so that each passage gets its own id
};

ProgramCell::ProgramCell(std::string command, const ProgramOptions& options,
                         const std::vector<Number>& set) {
  if (!(options.timeout_s > 0.0))
    throw std::invalid_argument("cell program: the timeout must be > 0 s");
  if (options.in_flight < 1 || options.in_flight > std::int64_t{kMostInFlight})
    throw std::invalid_argument(
        fmt::format("cell program: passages in flight must be 1 to {}", kMostInFlight));
  auto shared = std::make_shared<Program>(std::move(command), options);
  Program& program = *shared;
  auto running = std::make_unique<Running>(program.command, options);
  program.first_line = running->process.wait_for_line();
  try {
    program.hello = read_hello(program.first_line);
  } catch (const std::invalid_argument& e) {
    running->process.fail(fmt::format("its first line says no cell: {}; the line is '{}'", e.what(),
                                      excerpt(program.first_line)));
  }
  for (const Hello::Parameter& p : program.hello.parameters) values_.push_back(p.number.value);
  put(values_, program.hello, set);
  program_ = std::move(shared);
  tell_values(*running);
  idle_.push_back(std::move(running));
}

ProgramCell::ProgramCell(std::shared_ptr<const Program> program, std::vector<double> values)
    : program_(std::move(program)), values_(std::move(values)) {}

ProgramCell::~ProgramCell() = default;

const Section& ProgramCell::section() const { return program_->hello.section; }

bool ProgramCell::is_symmetric() const { return program_->hello.symmetric; }

void ProgramCell::begin(Body& body) const { body.carried.put(carried_words(kNoMemory)); }

std::vector<Cell::Remembered> ProgramCell::remembered(const Body& body) const {
  const std::string_view memory = body.carried.as<CarriedWords>().words();
  std::vector<Remembered> numbers = program_->hello.remembered;
  if (memory != kNoMemory) return numbers_in_memory(memory, std::move(numbers));
  for (Remembered& number : numbers) number.value = std::numeric_limits<double>::quiet_NaN();
  return numbers;
}

std::vector<Cell::Number> ProgramCell::numbers() const {
  std::vector<Number> all;
  for (std::size_t k = 0; k < values_.size(); ++k)
    all.push_back({program_->hello.parameters[k].number.key, values_[k]});
  return all;
}

std::unique_ptr<Cell> ProgramCell::with(std::size_t number, double times) const {
  std::vector<double> values = values_;
  values[number] *= times;
  if (!program_->hello.parameters[number].permits(values[number])) return nullptr;
  return std::unique_ptr<Cell>(new ProgramCell(program_, std::move(values)));
}

std::unique_ptr<ProgramCell> ProgramCell::with(const std::vector<Number>& set) const {
  std::vector<double> values = values_;
  put(values, program_->hello, set);
  return std::unique_ptr<ProgramCell>(new ProgramCell(program_, std::move(values)));
}

void ProgramCell::tell_values(Running& running) const {
  for (std::size_t k = 0; k < values_.size(); ++k) {
    const Number& own = program_->hello.parameters[k].number;
    if (values_[k] == own.value) continue;
    running.process.out() += "set " + own.key;
    append(running.process.out(), values_[k]);
    running.process.out() += '\n';
  }
}

std::unique_ptr<ProgramCell::Running> ProgramCell::take() const {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      auto running = std::move(idle_.back());
      idle_.pop_back();
      return running;
    }
  }
  return started();
}

std::unique_ptr<ProgramCell::Running> ProgramCell::started() const {
  auto running = std::make_unique<Running>(program_->command, program_->options);
  if (const std::string_view line = running->process.wait_for_line(); line != program_->first_line)
    running->process.fail(
        fmt::format("its first line is not the same at each start: '{}'", excerpt(line)));
  tell_values(*running);
  return running;
}

Passage ProgramCell::pass(Body& body) const {
  Passage passage;
  Health unused;
  carry_out(
      [&](Body& slot, const Passage* ended) {
        if (ended == nullptr) {
          slot = body;
          return true;
        }
        body = slot;
        passage = *ended;
        return false;
      },
      unused, 1);
  return passage;
}

void ProgramCell::carry_out(const NextPassage& next, Health& health, std::int64_t at_once) const {
  carry_out_by(nullptr, next, health, at_once);
}

void ProgramCell::carry_out_once_more(const NextPassage& next, Health& health,
                                      std::int64_t at_once) const {
  const bool is_wasted = at_once < kEnough && program_->starts_again < kMostStarts;
  if (is_wasted || program_->starts_again <= 0 || program_->starts_again-- <= 0)
    return carry_out(next, health, at_once);
  take().reset();  // one process less, so that there are no more processes than threads
  carry_out_by(started(), next, health, at_once);
}

void ProgramCell::carry_out_by(std::unique_ptr<Running> running, const NextPassage& next,
                               Health& health, std::int64_t at_once) const {
  struct Slot {
    Body body{.entry = {}, .random = Random(Purpose::gate, {})};
    std::optional<std::uint64_t> id{};  // id of the line that awaits an answer
  };
  const auto most = static_cast<std::size_t>(std::min(at_once, program_->options.in_flight));
  std::vector<Slot> slots;
  std::deque<std::size_t> waiting;  // slots whose lines are still to be written
  for (Slot slot; slots.size() < most && next(slot.body, nullptr); slots.push_back(slot))
    waiting.push_back(slots.size());
  if (slots.empty()) return;

  // The program answers one half of the passages while we write the lines of the other half.
  const Hello& hello = program_->hello;
  if (!running) running = take();
  Process& process = running->process;
  std::size_t under_way = slots.size(), left_in_batch = 0;
  while (under_way > 0) {
    while (process.out().size() < kMostOut) {
      if (left_in_batch == 0) {
        if (waiting.empty() || 2 * waiting.size() < under_way) break;
        left_in_batch = std::min(waiting.size(), (under_way + 1) / 2);
        process.begin_to_wait();
      }
      Slot& slot = slots[waiting.front()];
      slot.id = running->sent++ * kMostInFlight + waiting.front();
      waiting.pop_front();
      append_passage(process.out(), hello, *slot.id, slot.body);
      if (--left_in_batch == 0) process.out() += '\n';
    }
    process.exchange();
    while (const auto line = process.line()) {
      try {
        const AnswerWords words = answer_words(*line);
        std::uint64_t id = 0;
        const bool is_id = number_in(words.word[0], id);
        const std::size_t at = id % kMostInFlight;
        if (!is_id || at >= slots.size() || slots[at].id != id)
          throw WrongAnswer{"its first word is not the id of a passage that is under way"};
        slots[at].id.reset();
        const Passage passage = read_answer(words, hello.section, slots[at].body);
        if (passage.fate == Fate::left)
          static_cast<void>(numbers_in_memory(slots[at].body.carried.as<CarriedWords>().words(),
                                              hello.remembered));
        ++health.runs;
        health.broken += passage.fate == Fate::broken;
        if (next(slots[at].body, &passage))
          waiting.push_back(at);
        else
          --under_way;
      } catch (const WrongAnswer& wrong) {
        process.fail(fmt::format("it wrote a line that is no answer: {}; the line is '{}'",
                                 wrong.what, excerpt(*line)));
      }
    }
  }
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(running));  // after an exception the process is not kept
}

}  // namespace gatewalk::cli
