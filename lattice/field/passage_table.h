// SPDX-License-Identifier: MIT
#pragma once
/// A table of passages through cells that stores only the coordinates and costs that the section
/// has.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "dynamics/cells/cell.h"

namespace gatewalk::lattice {

/// A trial's passage through one cell: how the passage ended, the cell's type, the entry into the
/// next cell (inside or outside the field; none if the body did not leave the cell), and the costs.
struct CellPassage {
  dynamics::Fate fate = dynamics::Fate::trapped;
  std::uint8_t type = 0;  // index into the field's types
  dynamics::Entry entry{};
  dynamics::Costs costs{};
};

/// A passage, and the entry by which the body came into the cell.
struct EnteredPassage {
  dynamics::Entry from{};
  CellPassage passage{};
};

/// Passages through cells of one section, in compact form.
class PassageTable {
 public:
  PassageTable() = default;
  explicit PassageTable(const dynamics::Section& section) { begin(section); }
  /// Sets the section of an empty table; a table that has passages stays as it is.
  void begin(const dynamics::Section& section) {
    if (!empty()) return;
    coordinates_ = section.coordinates.size();
    costs_ = section.costs.size();
  }

  [[nodiscard]] std::size_t size() const { return kinds_.size(); }
  [[nodiscard]] bool empty() const { return kinds_.empty(); }
  void push_back(const CellPassage& passage) {
    if (coordinates_ == 0) throw std::logic_error("passages of no section");
    kinds_.push_back({passage.fate, passage.type, static_cast<std::uint16_t>(passage.entry.face)});
    const double *const at = passage.entry.at.data(), *const costs = passage.costs.data();
    numbers_.insert(numbers_.end(), at, at + coordinates_);
    numbers_.insert(numbers_.end(), costs, costs + costs_);
  }
  /// Appends all passages of another table of the same section.
  void append(const PassageTable& other) { append(other, 0, other.size()); }
  /// Appends rows `begin` to `end` (not included) of a table of the same section; throws
  /// std::logic_error for another section.
  void append(const PassageTable& other, std::size_t begin, std::size_t end) {
    if (begin == end) return;
    if (empty()) {
      coordinates_ = other.coordinates_;
      costs_ = other.costs_;
    }
    if (coordinates_ != other.coordinates_ || costs_ != other.costs_)
      throw std::logic_error("passages of another section");
    const auto at = [](const auto& from, std::size_t i) {
      return from.begin() + static_cast<std::ptrdiff_t>(i);
    };
    const std::size_t each = coordinates_ + costs_;
    kinds_.insert(kinds_.end(), at(other.kinds_, begin), at(other.kinds_, end));
    numbers_.insert(numbers_.end(), at(other.numbers_, each * begin),
                    at(other.numbers_, each * end));
  }
  [[nodiscard]] CellPassage operator[](std::size_t i) const {
    CellPassage passage{kinds_[i].fate, kinds_[i].type, {kinds_[i].face}, {}};
    const double* const numbers = numbers_.data() + i * (coordinates_ + costs_);
    std::copy_n(numbers, coordinates_, passage.entry.at.begin());
    std::copy_n(numbers + coordinates_, costs_, passage.costs.begin());
    return passage;
  }
  /// Reserves memory for this number of passages.
  void reserve(std::size_t passages) {
    kinds_.reserve(passages);
    numbers_.reserve(passages * (coordinates_ + costs_));
  }

  /// Consecutive rows of the table; each CellPassage is built when it is read.
  class Rows {
   public:
    struct Iterator {
      const PassageTable* table;
      std::size_t at;
      CellPassage operator*() const { return (*table)[at]; }
      Iterator& operator++() {
        ++at;
        return *this;
      }
      bool operator==(const Iterator&) const = default;
    };
    Rows(const PassageTable& table, std::size_t begin, std::size_t end)
        : table_(&table), begin_(begin), end_(end) {}
    [[nodiscard]] std::size_t size() const { return end_ - begin_; }
    [[nodiscard]] CellPassage operator[](std::size_t i) const { return (*table_)[begin_ + i]; }
    [[nodiscard]] CellPassage front() const { return (*this)[0]; }
    [[nodiscard]] CellPassage back() const { return (*this)[size() - 1]; }
    [[nodiscard]] Iterator begin() const { return {table_, begin_}; }
    [[nodiscard]] Iterator end() const { return {table_, end_}; }

   private:
    const PassageTable* table_;
    std::size_t begin_, end_;
  };
  /// Writes or reads the table as part of a kept piece of work.
  template <class Archive>
  friend void each_part(Archive& archive, PassageTable& table) {
    archive(table.coordinates_, table.costs_, table.kinds_, table.numbers_);
    if constexpr (Archive::reads) table.require_whole();
  }

  [[nodiscard]] Rows rows() const { return {*this, 0, size()}; }
  [[nodiscard]] Rows rows(std::size_t begin, std::size_t end) const { return {*this, begin, end}; }

 private:
  /// Throws std::runtime_error if the numbers that were read do not form a table of passages.
  void require_whole() const {
    const bool is_sized = coordinates_ <= dynamics::kMostCoordinates &&
                          costs_ <= dynamics::kMostCosts &&
                          numbers_.size() == kinds_.size() * (coordinates_ + costs_);
    if (!is_sized || std::any_of(kinds_.begin(), kinds_.end(), [](const Kind& kind) {
          return kind.fate > dynamics::Fate::broken || kind.face >= dynamics::kMostFaces;
        }))
      throw std::runtime_error("a kept piece has passages that there are not");
  }

  std::size_t coordinates_ = 0, costs_ = 0;
  struct Kind {
    dynamics::Fate fate;
    std::uint8_t type;
    std::uint16_t face;
  };
  std::vector<Kind> kinds_;
  std::vector<double> numbers_;  // (passages x (coordinates, then costs))
};

}  // namespace gatewalk::lattice
