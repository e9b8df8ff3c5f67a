// SPDX-License-Identifier: MIT
#pragma once
/// A cell that another program simulates, a line per passage. What the program reads and writes:
/// cli/site/reference/cell_program.md.

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "dynamics/cells/cell.h"

namespace gatewalk::cli {

struct ProgramOptions {
  double timeout_s = 60.0;       // longest wait for a line, including the first (s)
  std::int64_t in_flight = 256;  // passages that one process gets before it has answered
};

/// A cell that another program simulates, with one process per thread that uses the cell at the
/// same time. The processes run until the cell is destroyed. A body's passage must depend on its
/// line alone. carry_out and pass throw std::runtime_error, with the program's last words on
/// standard error, if the program ends, exceeds the timeout or writes a line that is not an answer.
/// Other processes go on.
class ProgramCell : public dynamics::Cell {
 public:
  /// Starts `/bin/sh -c COMMAND` and reads its first line; `set` are values of the program's
  /// parameters. Throws std::runtime_error if the program does not start or its first line
  /// describes no cell, and std::invalid_argument for options and values that are not permitted.
  explicit ProgramCell(std::string command, const ProgramOptions& options = {},
                       const std::vector<Number>& set = {});
  ~ProgramCell() override;

  [[nodiscard]] const dynamics::Section& section() const override;
  [[nodiscard]] bool is_symmetric() const override;
  [[nodiscard]] dynamics::Passage pass(dynamics::Body& body) const override;
  void carry_out(const dynamics::NextPassage& next, dynamics::Health& health,
                 std::int64_t at_once) const override;
  /// Repeats passages for a check, the first few times in a new process, so that outcomes which
  /// depend on a process's history are found.
  void carry_out_once_more(const dynamics::NextPassage& next, dynamics::Health& health,
                           std::int64_t at_once) const override;
  /// Gives the body an empty memory.
  void begin(dynamics::Body& body) const override;

  /// The numbers with which the body's memory begins.
  [[nodiscard]] std::vector<Remembered> remembered(const dynamics::Body& body) const override;

  /// The program's parameters with their values.
  [[nodiscard]] std::vector<Number> numbers() const override;
  /// The cell with parameter `number` multiplied by `times`, in processes of its own; null if the
  /// program does not permit the value.
  [[nodiscard]] std::unique_ptr<Cell> with(std::size_t number, double times) const override;
  /// The cell with these parameters, in processes of its own. Throws std::invalid_argument for
  /// parameters and values that are not permitted.
  [[nodiscard]] std::unique_ptr<ProgramCell> with(const std::vector<Number>& set) const;

 private:
  struct Program;  // what all cells of one command share
  struct Running;  // a process
  ProgramCell(std::shared_ptr<const Program> program, std::vector<double> values);
  /// A process that no thread uses, or a new one.
  [[nodiscard]] std::unique_ptr<Running> take() const;
  [[nodiscard]] std::unique_ptr<Running> started() const;
  void carry_out_by(std::unique_ptr<Running> running, const dynamics::NextPassage& next,
                    dynamics::Health& health, std::int64_t at_once) const;
  void tell_values(Running& running) const;

  std::shared_ptr<const Program> program_;
  std::vector<double> values_;  // values of the parameters
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Running>> idle_;
};

}  // namespace gatewalk::cli
