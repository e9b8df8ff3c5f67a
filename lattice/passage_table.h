#pragma once
/// Passages through gates, many of them, in columns: as small as the section allows.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "dynamics/cells/section.h"
#include "dynamics/gate.h"

namespace gatewalk::lattice {

/// How a trial's run through one gate ended, that gate's type, with which entry into the next
/// gate, inside the field or outside (no entry where it did not leave its gate), and what it took.
struct GatePassage {
  dynamics::Ending ending = dynamics::Ending::trapped;
  std::uint8_t type = 0;  // of the field's types
  dynamics::Entry entry{};
  dynamics::Costs costs{};
};

class PassageTable {
 public:
  PassageTable() = default;
  explicit PassageTable(const dynamics::Section& section) { begin(section); }
  /// Says what an empty table is of; one that has passages stays as it is.
  void begin(const dynamics::Section& section) {
    if (!empty()) return;
    coordinates_ = section.coordinates.size();
    costs_ = section.costs.size();
  }

  [[nodiscard]] std::size_t size() const { return endings_.size(); }
  [[nodiscard]] bool empty() const { return endings_.empty(); }
  void push_back(const GatePassage& passage) {
    if (coordinates_ == 0) throw std::logic_error("passages of no section");
    endings_.push_back(passage.ending);
    types_.push_back(passage.type);
    faces_.push_back(static_cast<std::uint8_t>(passage.entry.face));
    at_.insert(at_.end(), passage.entry.at.begin(), passage.entry.at.begin() + coordinates_);
    took_.insert(took_.end(), passage.costs.begin(), passage.costs.begin() + costs_);
  }
  [[nodiscard]] GatePassage operator[](std::size_t i) const {
    GatePassage passage{endings_[i], types_[i], {faces_[i]}, {}};
    std::copy_n(at_.data() + i * coordinates_, coordinates_, passage.entry.at.begin());
    std::copy_n(took_.data() + i * costs_, costs_, passage.costs.begin());
    return passage;
  }
  /// Makes room for so many passages.
  void reserve(std::size_t passages) {
    endings_.reserve(passages);
    types_.reserve(passages);
    faces_.reserve(passages);
    at_.reserve(passages * coordinates_);
    took_.reserve(passages * costs_);
  }

  /// Some rows, one after the other, which are made as they are read.
  class Rows {
   public:
    struct Iterator {
      const PassageTable* table;
      std::size_t at;
      GatePassage operator*() const { return (*table)[at]; }
      Iterator& operator++() {
        ++at;
        return *this;
      }
      bool operator==(const Iterator&) const = default;
    };
    Rows(const PassageTable& table, std::size_t begin, std::size_t end)
        : table_(&table), begin_(begin), end_(end) {}
    [[nodiscard]] std::size_t size() const { return end_ - begin_; }
    [[nodiscard]] GatePassage operator[](std::size_t i) const { return (*table_)[begin_ + i]; }
    [[nodiscard]] GatePassage front() const { return (*this)[0]; }
    [[nodiscard]] GatePassage back() const { return (*this)[size() - 1]; }
    [[nodiscard]] Iterator begin() const { return {table_, begin_}; }
    [[nodiscard]] Iterator end() const { return {table_, end_}; }

   private:
    const PassageTable* table_;
    std::size_t begin_, end_;
  };
  [[nodiscard]] Rows rows() const { return {*this, 0, size()}; }
  [[nodiscard]] Rows rows(std::size_t begin, std::size_t end) const { return {*this, begin, end}; }

 private:
  std::size_t coordinates_ = 0, costs_ = 0;
  std::vector<dynamics::Ending> endings_;
  std::vector<std::uint8_t> types_, faces_;
  std::vector<double> at_;    // (passages x coordinates)
  std::vector<double> took_;  // (passages x costs)
};

}  // namespace gatewalk::lattice
