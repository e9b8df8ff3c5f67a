// SPDX-License-Identifier: MIT
#include "cli/python/python_cell.h"

#include <fmt/core.h>

#include <pybind11/numpy.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace gatewalk::python {

namespace py = pybind11;
using namespace dynamics;

namespace {

struct Memory {
  static constexpr int kMost = 60;
  std::array<double, kMost> numbers;
};

template <class T>
py::array_t<T> table(std::size_t rows, std::size_t columns) {
  return py::array_t<T>({static_cast<py::ssize_t>(rows), static_cast<py::ssize_t>(columns)});
}

/// The value that the cell returned as `name`, checked to be an array of this shape.
template <class T>
py::array_t<T, py::array::c_style | py::array::forcecast> given(const py::handle& value,
                                                                const char* name, std::size_t rows,
                                                                std::size_t columns) {
  auto array = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(value);
  if (!array) throw py::error_already_set();
  if (static_cast<std::size_t>(array.size()) != rows * columns)
    throw std::invalid_argument(
        fmt::format("cell: pass_ must give {} {} for each of {} bodies, it gave {} numbers",
                    columns, name, rows, array.size()));
  return array;
}

thread_local bool in_cell = false;

}  // namespace

bool is_in_cell() { return in_cell; }

struct PythonCell::Slot {
  Body body{.entry = {}, .random = Random(Purpose::gate, {})};
  Passage passage{};
};

PythonCell::PythonCell(py::object cell)
    : cell_(std::move(cell)),
      hello_(cli::read_hello(cell_.attr("_hello")().cast<std::string>())),
      memory_(cell_.attr("memory").cast<int>()) {
  if (memory_ < 0 || memory_ > Memory::kMost)
    throw std::invalid_argument(fmt::format("cell: memory must be 0 to {} numbers", Memory::kMost));
}

PythonCell::~PythonCell() {
  const py::gil_scoped_acquire gil;
  cell_ = {};
}

void PythonCell::begin(Body& body) const { body.carried.put(Memory{}); }

std::vector<Cell::Number> PythonCell::numbers() const {
  std::vector<Number> all;
  for (const cli::Hello::Parameter& p : hello_.parameters) all.push_back(p.number);
  return all;
}

std::unique_ptr<Cell> PythonCell::with(std::size_t number, double times) const {
  const cli::Hello::Parameter& p = hello_.parameters[number];
  const double value = p.number.value * times;
  if (!p.permits(value)) return nullptr;
  const py::gil_scoped_acquire gil;
  return std::make_unique<PythonCell>(cell_.attr("_with")(p.number.key, value));
}

Passage PythonCell::pass(Body& body) const {
  std::vector<Slot> one(1);
  one.front().body = body;
  run_batch(one);
  body = one.front().body;
  return one.front().passage;
}

void PythonCell::carry_out(const NextPassage& next, Health& health, std::int64_t at_once) const {
  constexpr std::int64_t kMost = 4096;
  std::vector<Slot> slots;
  for (Slot slot; std::ssize(slots) < std::min(at_once, kMost) && next(slot.body, nullptr);)
    slots.push_back(slot);
  while (!slots.empty()) {
    run_batch(slots);
    std::size_t kept = 0;
    for (std::size_t k = 0; k < slots.size(); ++k) {
      ++health.runs;
      health.broken += slots[k].passage.fate == Fate::broken;
      if (!next(slots[k].body, &slots[k].passage)) continue;
      if (kept != k) slots[kept] = slots[k];
      ++kept;
    }
    slots.resize(kept);
  }
}

void PythonCell::run_batch(std::vector<Slot>& slots) const {
  const std::size_t n = slots.size(), coordinates = hello_.section.coordinates.size(),
                    costs = hello_.section.costs.size(),
                    noise = static_cast<std::size_t>(hello_.normals + hello_.uniforms),
                    memory = static_cast<std::size_t>(memory_);
  const py::gil_scoped_acquire gil;
  py::array_t<std::int32_t> face(static_cast<py::ssize_t>(n));
  py::array_t<std::uint64_t> seed(static_cast<py::ssize_t>(n));
  auto at = table<double>(n, coordinates), numbers = table<double>(n, noise),
       carried = table<double>(n, memory);
  for (std::size_t k = 0; k < n; ++k) {
    Body& body = slots[k].body;
    face.mutable_data()[k] = body.entry.face;
    std::copy_n(body.entry.at.data(), coordinates, at.mutable_data() + k * coordinates);
    double* next = numbers.mutable_data() + k * noise;
    seed.mutable_data()[k] = cli::draw_noise(hello_, body.random, [&](double x) { *next++ = x; });
    std::copy_n(body.carried.as<Memory>().numbers.data(), memory,
                carried.mutable_data() + k * memory);
  }
  struct InCell {
    InCell() { in_cell = true; }
    ~InCell() { in_cell = false; }
  };
  const py::tuple answer = [&] {
    const InCell here;
    return cell_.attr("_passes")(face, at, seed, numbers, carried);
  }();
  const auto out = given<std::int64_t>(answer[0], "faces", n, 1);
  const auto to = given<double>(answer[1], "coordinates", n, coordinates);
  const auto took = given<double>(answer[2], "costs", n, costs);
  const auto kept = given<double>(answer[3], "numbers of memory", n, memory);
  for (std::size_t k = 0; k < n; ++k) {
    const auto wrong = [&](const std::string& what) {
      return std::invalid_argument(
          fmt::format("cell: pass_ gave body {} (counted from 0) {}", k, what));
    };
    const std::int64_t fate = out.data()[k];
    if (fate < -2 || fate >= std::ssize(hello_.section.faces))
      throw wrong(fmt::format("the face {}; faces are 0 to {}, -1 is trapped, -2 broken", fate,
                              hello_.section.faces.size() - 1));
    Passage& passage = slots[k].passage;
    passage = {fate == -1 ? Fate::trapped : fate == -2 ? Fate::broken : Fate::left, {}, {}};
    if (fate == -2) continue;
    for (std::size_t c = 0; c < costs; ++c) {
      passage.costs[c] = took.data()[k * costs + c];
      if (!std::isfinite(passage.costs[c]) || (c == 0 && passage.costs[c] < 0.0))
        throw wrong(fmt::format("a {} that is not finite, or a time that is negative",
                                hello_.section.costs[c].key));
    }
    if (fate == -1) continue;
    passage.next.face = static_cast<int>(fate);
    for (std::size_t c = 0; c < coordinates; ++c) {
      passage.next.at[c] = to.data()[k * coordinates + c];
      if (!std::isfinite(passage.next.at[c]))
        throw wrong(fmt::format("a {} that is not finite", hello_.section.coordinates[c].name));
    }
    Body& body = slots[k].body;
    body.entry = passage.next;
    std::copy_n(kept.data() + k * memory, memory, body.carried.as<Memory>().numbers.data());
  }
}

}  // namespace gatewalk::python
