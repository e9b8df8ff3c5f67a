// SPDX-License-Identifier: MIT
#include "markov/chain.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "markov/sum.h"

namespace gatewalk::markov {
namespace {

// Accepts decimal input with 13 digits, but not a missing output or a rounded table.
constexpr double kRowSumTolerance = 1e-12;

std::string row_name(std::int64_t row) {
  return "row " + std::to_string(row) + " (counted from 0)";
}

std::string printed(double value) { return fmt::format("{:.17g}", value); }

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

}  // namespace

void validate(const std::vector<Exit>& exits, std::int64_t inputs, std::int64_t outputs) {
  if (inputs < 1 || outputs < 1) {
    refuse("a chain needs at least one input and one output, not " + std::to_string(inputs) +
           " x " + std::to_string(outputs));
  }
  if (static_cast<std::int64_t>(exits.size()) != outputs) {
    refuse(std::to_string(exits.size()) + " exits for " + std::to_string(outputs) + " outputs");
  }
  for (std::size_t j = 0; j < exits.size(); ++j) {
    const Exit& exit = exits[j];
    const std::string name = "exit of output " + std::to_string(j) + " (counted from 0): ";
    if (exit.next_input == Exit::kTrapped) {
      if (exit.di_x != 0 || exit.di_y != 0) refuse(name + "trapped, and yet it moves");
    } else if (exit.next_input < 0 || exit.next_input >= inputs) {
      refuse(name + "next_input " + std::to_string(exit.next_input) + " is not in [0, " +
             std::to_string(inputs) + ")");
    }
  }
}

Chain::Chain(Probabilities p, std::vector<Exit> exits)
    : p_(std::move(p)), exits_(std::move(exits)) {}

Chain Chain::from_counts(const Counts& counts, std::vector<Exit> exits, const Counts& start_rows) {
  if (start_rows.rows() > 0 && start_rows.cols() != counts.cols())
    refuse("rows of " + std::to_string(start_rows.cols()) +
           " outputs cannot stand behind rows of " + std::to_string(counts.cols()));
  const Eigen::Index rows = counts.rows() + start_rows.rows();
  validate(exits, rows, counts.cols());
  Probabilities p(rows, counts.cols());
  p.reserve(counts.nonZeros() + start_rows.nonZeros());
  for (Eigen::Index row = 0; row < rows; ++row) {
    const bool is_start = row >= counts.rows();
    const Counts& from = is_start ? start_rows : counts;
    const Eigen::Index at = is_start ? row - counts.rows() : row;
    std::int64_t total = 0;
    for (Counts::InnerIterator it(from, at); it; ++it) {
      if (it.value() < 0) {
        refuse(row_name(row) + ": count " + std::to_string(it.value()) + " of output " +
               std::to_string(it.col()) + " is negative");
      }
      if (__builtin_add_overflow(total, it.value(), &total)) {
        refuse(row_name(row) + ": the sum of counts overflows");
      }
    }
    p.startVec(row);
    for (Counts::InnerIterator it(from, at); it; ++it) {
      if (it.value() == 0) continue;
      p.insertBack(row, it.col()) = static_cast<double>(it.value()) / static_cast<double>(total);
    }
  }
  p.finalize();
  return {std::move(p), std::move(exits)};
}

Chain Chain::from_probabilities(Probabilities matrix, std::vector<Exit> exits) {
  validate(exits, matrix.rows(), matrix.cols());
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    CompensatedSum sum;
    bool empty = true;
    for (Probabilities::InnerIterator it(matrix, row); it; ++it) {
      if (!(std::isfinite(it.value()) && it.value() >= 0.0)) {
        refuse(row_name(row) + ": " + printed(it.value()) + " of output " +
               std::to_string(it.col()) + " is not a probability");
      }
      empty = empty && it.value() == 0.0;
      sum += it.value();
    }
    if (!empty && !(std::abs(sum.value() - 1.0) <= kRowSumTolerance)) {
      refuse(row_name(row) + ": probabilities sum to " + printed(sum.value()) + ", not 1");
    }
  }
  matrix.prune([](Eigen::Index, Eigen::Index, double p) { return p != 0.0; });
  return {std::move(matrix), std::move(exits)};
}

int Chain::unsampled_rows() const {
  int count = 0;
  for (int row = 0; row < inputs(); ++row) count += is_sampled(row) ? 0 : 1;
  return count;
}

FieldChain::FieldChain(Chain everywhere) : types_{0} { chains_.push_back(std::move(everywhere)); }

FieldChain::FieldChain(std::vector<Chain> chains, std::vector<int> types, std::int64_t row_stride,
                       std::int64_t column_stride)
    : chains_(std::move(chains)),
      types_(std::move(types)),
      row_stride_(row_stride),
      column_stride_(column_stride) {
  const std::string what = column_stride == 0 ? "row " : "cell ";
  if (chains_.empty()) refuse("field: no chain is given");
  if (types_.empty()) refuse("field: no " + what + "is given a chain");
  for (const Chain& chain : chains_)
    if (chain.inputs() != inputs())
      refuse("field: chains of " + std::to_string(inputs()) + " and of " +
             std::to_string(chain.inputs()) + " inputs cannot share a field");
  for (std::size_t k = 0; k < types_.size(); ++k)
    if (types_[k] < 0 || types_[k] >= std::ssize(chains_))
      refuse("field: " + what + std::to_string(k) + " is given chain " + std::to_string(types_[k]) +
             " of " + std::to_string(chains_.size()));
}

FieldChain FieldChain::by_row(std::vector<Chain> chains, std::vector<int> type_of_row) {
  return {std::move(chains), std::move(type_of_row), 1, 0};
}

FieldChain FieldChain::by_cell(std::vector<Chain> chains, int columns,
                               std::vector<int> type_of_cell) {
  if (columns < 1 || std::ssize(type_of_cell) % columns != 0)
    refuse("field: types of " + std::to_string(type_of_cell.size()) +
           " cells do not fill rows of " + std::to_string(columns));
  return {std::move(chains), std::move(type_of_cell), columns, 1};
}

FieldChain FieldChain::with(std::vector<Chain> chains) const {
  if (chains.size() != chains_.size() || chains.front().inputs() != inputs())
    refuse("field: " + std::to_string(chains.size()) + " chains cannot take the place of " +
           std::to_string(chains_.size()) + " others, or have other inputs");
  return {std::move(chains), types_, row_stride_, column_stride_};
}

bool FieldChain::has_uniform_rows() const {
  for (std::int64_t row = 0; row < rows(); ++row)
    for (std::int64_t column = 1; column < columns(); ++column)
      if (type_of(column, row) != type_of(0, row)) return false;
  return true;
}

std::int64_t FieldChain::columns() const { return column_stride_ == 0 ? 0 : row_stride_; }

std::int64_t FieldChain::rows() const {
  return row_stride_ == 0 ? 0 : std::ssize(types_) / row_stride_;
}

void validate(const Chain& chain, const Field& field, const Start& start, int max_cells) {
  if (field.columns < 1 || field.rows < 1 ||
      std::int64_t{field.columns} * field.rows > std::numeric_limits<std::int32_t>::max()) {
    refuse("field: " + std::to_string(field.columns) + " columns x " + std::to_string(field.rows) +
           " rows is not between 1 and 2^31 - 1 cells");
  }
  if (start.column < 0 || start.column >= field.columns || start.row < 0 ||
      start.row >= field.rows) {
    refuse("start: cell (" + std::to_string(start.column) + ", " + std::to_string(start.row) +
           ") lies outside the field");
  }
  if (start.input < 0 || start.input >= chain.inputs()) {
    refuse("start: input " + std::to_string(start.input) + " is not in [0, " +
           std::to_string(chain.inputs()) + ")");
  }
  if (max_cells < 0) refuse("max_cells: " + std::to_string(max_cells) + " is negative");
}

void validate(const FieldChain& chain, const Field& field, const Start& start, int max_cells) {
  validate(chain.chains().front(), field, start, max_cells);
  const auto fits = [](std::int64_t given, int in_field, const char* what) {
    if (given != 0 && given != in_field)
      refuse("field: chains for " + std::to_string(given) + what + ", the field has " +
             std::to_string(in_field));
  };
  fits(chain.rows(), field.rows, " rows");
  fits(chain.columns(), field.columns, " columns");
}

}  // namespace gatewalk::markov
