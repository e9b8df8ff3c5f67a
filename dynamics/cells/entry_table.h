// SPDX-License-Identifier: MIT
#pragma once
/// A compact table of many entries, stored in columns with only the section's coordinates.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamics/cells/section.h"

namespace gatewalk::dynamics {

class EntryTable {
 public:
  EntryTable(const Section& section, const std::vector<Entry>& entries = {})  // NOLINT
      : coordinates_(section.coordinates.size()) {
    for (const Entry& entry : entries) push_back(entry);
  }

  [[nodiscard]] std::size_t size() const { return faces_.size(); }
  [[nodiscard]] std::size_t coordinates() const { return coordinates_; }
  /// Reserves memory for this number of entries.
  void reserve(std::size_t entries) {
    faces_.reserve(entries);
    at_.reserve(entries * coordinates_);
  }
  void push_back(const Entry& entry) {
    faces_.push_back(static_cast<std::uint16_t>(entry.face));
    at_.insert(at_.end(), entry.at.data(), entry.at.data() + coordinates_);
  }
  [[nodiscard]] int face(std::size_t i) const { return faces_[i]; }
  /// The coordinates of entry i: an array of coordinates() numbers.
  [[nodiscard]] const double* at(std::size_t i) const { return at_.data() + i * coordinates_; }
  [[nodiscard]] Entry operator[](std::size_t i) const {
    Entry entry{face(i)};
    std::copy_n(at(i), coordinates_, entry.at.begin());
    return entry;
  }

 private:
  std::size_t coordinates_;
  std::vector<std::uint16_t> faces_;
  std::vector<double> at_;  // (entries x coordinates)
};

}  // namespace gatewalk::dynamics
