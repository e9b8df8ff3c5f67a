// SPDX-License-Identifier: MIT
#include "cli/cells/program.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "cli/cells/hello.h"
#include "cli/cells/process.h"

namespace gatewalk::cli {
namespace {

using namespace dynamics;

constexpr std::size_t kMostInFlight = 4096;
constexpr std::size_t kMostOut = std::size_t{1} << 16;  // bytes that wait to be read
constexpr std::string_view kNoMemory = "-";

/// What a body carries: the program's own words.
struct Memory {
  std::uint16_t length;
  char text[480];
  [[nodiscard]] std::string_view words() const { return {text, length}; }
};
Memory memory_of(std::string_view words) {
  Memory memory{static_cast<std::uint16_t>(words.size()), {}};
  std::copy(words.begin(), words.end(), memory.text);
  return memory;
}

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

/// ID FACE COORDINATES... SEED NOISE... MEMORY
void append_passage(std::string& line, const Hello& hello, std::uint64_t id, Body& body) {
  std::array<char, 32> digits;
  line.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), id).ptr);
  line += ' ';
  line += hello.section.faces[body.entry.face].name;
  for (std::size_t k = 0; k < hello.section.coordinates.size(); ++k) append(line, body.entry.at[k]);
  append_noise(line, hello, body.random);
  line += ' ';
  line += body.carried.as<Memory>().words();
  line += '\n';
}

/// Which one is to be set. Throws std::invalid_argument for one that the program does not name, and
/// for a value that it does not permit.
std::size_t parameter_of(const Hello& hello, const Cell::Number& wanted) {
  std::string all;
  for (std::size_t k = 0; k < hello.parameters.size(); ++k) {
    const Hello::Parameter& p = hello.parameters[k];
    if (p.number.key == wanted.key) {
      if (p.permits(wanted.value)) return k;
      throw std::invalid_argument("cell program: parameter '" + wanted.key + "' must be " +
                                  p.range());
    }
    all += (k > 0 ? ", " : ", but ") + p.number.key;
  }
  throw std::invalid_argument("cell program: it has no parameter '" + wanted.key + "'" + all);
}

/// The words of a line, as far as an answer has any.
struct Words {
  static constexpr std::size_t kMost = 4 + kMostCoordinates + kMostCosts;
  std::array<std::string_view, kMost> word;
  std::size_t count = 0;  // of all
};
Words words_of(std::string_view line) {
  Words words;
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t", at)) != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    if (words.count < Words::kMost) words.word[words.count] = line.substr(at, end - at);
    ++words.count;
    at = end;
  }
  return words;
}

template <class Number>
bool read_number(std::string_view word, Number& x) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  return error == std::errc() && end == word.data() + word.size();
}

/// An answer that is none: what is wrong with it.
struct WrongAnswer {
  std::string what;
};

double finite(std::string_view word, const std::string& name) {
  double x = 0.0;
  if (!read_number(word, x) || !std::isfinite(x))
    throw WrongAnswer{name + " '" + excerpt(word, 40) + "' is not a finite number"};
  return x;
}

/// What words an answer has, for a message.
std::string form_of(const Section& section, std::string_view fate) {
  std::string form = "ID " + std::string(fate);
  if (fate == "left") {
    form += " FACE";
    for (const Coordinate& c : section.coordinates) form += ' ' + c.name;
  }
  for (const CostInfo& c : section.costs) form += ' ' + c.key;
  return fate == "left" ? form + " MEMORY" : form;
}

void require_count(const Words& words, std::size_t count, const Section& section,
                   std::string_view fate) {
  if (words.count == count) return;
  throw WrongAnswer{"it has " + std::to_string(words.count) + " words, not " +
                    std::to_string(count) + ": " + form_of(section, fate)};
}

Costs read_costs(const Words& words, std::size_t at, const Section& section) {
  Costs costs{};
  for (std::size_t c = 0; c < section.costs.size(); ++c)
    costs[c] = finite(words.word[at + c], section.costs[c].key);
  if (costs[0] < 0.0) throw WrongAnswer{section.costs[0].key + " is negative"};
  return costs;
}

/// Moves the body on. Throws WrongAnswer.
Passage read_answer(const Words& words, const Section& section, Body& body) {
  const std::string_view fate = words.word[1];
  const std::size_t coordinates = section.coordinates.size(), costs = section.costs.size();
  if (fate == "broken") {
    if (words.count != 2) throw WrongAnswer{"a broken passage has no more words: ID broken"};
    return {Fate::broken, {}, {}};
  }
  if (fate == "trapped") {
    require_count(words, 2 + costs, section, fate);
    return {Fate::trapped, {}, read_costs(words, 2, section)};
  }
  if (fate != "left") throw WrongAnswer{"its second word must be left, trapped or broken"};
  require_count(words, 4 + coordinates + costs, section, fate);
  Passage passage{Fate::left, {}, {}};
  const auto face = std::find_if(section.faces.begin(), section.faces.end(),
                                 [&](const Face& f) { return f.name == words.word[2]; });
  if (face == section.faces.end())
    throw WrongAnswer{"there is no face '" + excerpt(words.word[2], 40) +
                      "' to enter the next cell by, but " + names_of(section.faces)};
  passage.next.face = static_cast<int>(face - section.faces.begin());
  for (std::size_t k = 0; k < coordinates; ++k)
    passage.next.at[k] = finite(words.word[3 + k], section.coordinates[k].name);
  passage.costs = read_costs(words, 3 + coordinates, section);
  const std::string_view memory = words.word[3 + coordinates + costs];
  if (memory.size() > sizeof Memory::text)
    throw WrongAnswer{"its memory has " + std::to_string(memory.size()) + " bytes; at most " +
                      std::to_string(sizeof Memory::text) + " are carried"};
  body.entry = passage.next;
  body.carried.put(memory_of(memory));
  return passage;
}

}  // namespace

struct ProgramCell::Program {
  std::string command;
  ProgramOptions options;
  Hello hello;
  std::string first_line;
};

struct ProgramCell::Running {
  Running(const std::string& command, const ProgramOptions& options)
      : process(command, options.timeout_s) {}
  Process process;
  std::uint64_t sent = 0;  // lines: no two have the same id
};

ProgramCell::ProgramCell(std::string command, const ProgramOptions& options,
                         const std::vector<Number>& set) {
  if (!(options.timeout_s > 0.0))
    throw std::invalid_argument("cell program: the timeout must be > 0 s");
  if (options.in_flight < 1 || options.in_flight > std::int64_t{kMostInFlight})
    throw std::invalid_argument("cell program: passages in flight must be 1 to " +
                                std::to_string(kMostInFlight));
  Program program{std::move(command), options, {}, {}};
  auto running = std::make_unique<Running>(program.command, options);
  program.first_line = running->process.wait_for_line();
  try {
    program.hello = read_hello(program.first_line);
  } catch (const std::invalid_argument& e) {
    running->process.fail("its first line says no cell: " + std::string(e.what()) +
                          "; the line is '" + excerpt(program.first_line) + "'");
  }
  for (const Hello::Parameter& p : program.hello.parameters) values_.push_back(p.number.value);
  for (const Number& number : set) values_[parameter_of(program.hello, number)] = number.value;
  program_ = std::make_shared<const Program>(std::move(program));
  tell_values(*running);
  idle_.push_back(std::move(running));
}

ProgramCell::ProgramCell(std::shared_ptr<const Program> program, std::vector<double> values)
    : program_(std::move(program)), values_(std::move(values)) {}

ProgramCell::~ProgramCell() = default;

const Section& ProgramCell::section() const { return program_->hello.section; }

bool ProgramCell::is_symmetric() const { return program_->hello.symmetric; }

void ProgramCell::begin(Body& body) const { body.carried.put(memory_of(kNoMemory)); }

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
  auto running = std::make_unique<Running>(program_->command, program_->options);
  if (const std::string_view line = running->process.wait_for_line(); line != program_->first_line)
    running->process.fail("its first line is not the same at each start: '" + excerpt(line) + "'");
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
  struct Slot {
    Body body{.entry = {}, .random = Random(Purpose::gate, {})};
    std::optional<std::uint64_t> id{};  // of its line, until that is answered
  };
  const auto most = static_cast<std::size_t>(std::min(at_once, program_->options.in_flight));
  std::vector<Slot> slots;
  std::deque<std::size_t> waiting;  // whose lines are to be written
  for (Slot slot; slots.size() < most && next(slot.body, nullptr); slots.push_back(slot))
    waiting.push_back(slots.size());
  if (slots.empty()) return;

  // It answers one half while we write the lines of the other.
  const Hello& hello = program_->hello;
  std::unique_ptr<Running> running = take();
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
        const Words words = words_of(*line);
        std::uint64_t id = 0;
        const bool is_id = read_number(words.word[0], id);
        const std::size_t at = id % kMostInFlight;
        if (!is_id || at >= slots.size() || slots[at].id != id)
          throw WrongAnswer{"its first word is not the id of a passage that is under way"};
        slots[at].id.reset();
        const Passage passage = read_answer(words, hello.section, slots[at].body);
        ++health.runs;
        health.broken += passage.fate == Fate::broken;
        if (next(slots[at].body, &passage))
          waiting.push_back(at);
        else
          --under_way;
      } catch (const WrongAnswer& wrong) {
        process.fail("it wrote a line that is no answer: " + wrong.what + "; the line is '" +
                     excerpt(*line) + "'");
      }
    }
  }
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(running));  // one in whose way something came is not kept
}

}  // namespace gatewalk::cli
