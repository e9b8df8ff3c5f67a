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
  double timeout_s = 60.0;       // for a line, while one is awaited: the first one too
  std::int64_t in_flight = 256;  // passages that one process is given before it has answered
};

/// One process per thread that uses the cell at the same time, kept until the cell's end. What
/// becomes of a body depends on its line alone. carry_out and pass throw std::runtime_error, with
/// the program's last words on standard error, when it ends, is silent for too long or writes what
/// is not an answer; other processes are not harmed.
class ProgramCell : public dynamics::Cell {
 public:
  /// Starts `/bin/sh -c COMMAND` for its first line; `set`: values of parameters that it names.
  /// Throws std::runtime_error for one that does not start or names a cell that is none, and
  /// std::invalid_argument for options and values that are not permitted.
  explicit ProgramCell(std::string command, const ProgramOptions& options = {},
                       const std::vector<Number>& set = {});
  ~ProgramCell() override;

  [[nodiscard]] const dynamics::Section& section() const override;
  [[nodiscard]] bool is_symmetric() const override;
  [[nodiscard]] dynamics::Passage pass(dynamics::Body& body) const override;
  void carry_out(const dynamics::NextPassage& next, dynamics::Health& health,
                 std::int64_t at_once) const override;
  /// The first times by a new process, in place of one that was used.
  void carry_out_once_more(const dynamics::NextPassage& next, dynamics::Health& health,
                           std::int64_t at_once) const override;
  /// Without memory.
  void begin(dynamics::Body& body) const override;

  /// The program's parameters.
  [[nodiscard]] std::vector<Number> numbers() const override;
  /// In processes of its own.
  [[nodiscard]] std::unique_ptr<Cell> with(std::size_t number, double times) const override;
  /// The same with these values. Throws std::invalid_argument for what is not permitted.
  [[nodiscard]] std::unique_ptr<ProgramCell> with(const std::vector<Number>& set) const;

 private:
  struct Program;  // what all cells of one command share
  struct Running;  // a process
  ProgramCell(std::shared_ptr<const Program> program, std::vector<double> values);
  /// One that nobody uses, or a new one.
  [[nodiscard]] std::unique_ptr<Running> take() const;
  [[nodiscard]] std::unique_ptr<Running> started() const;
  void carry_out_by(std::unique_ptr<Running> running, const dynamics::NextPassage& next,
                    dynamics::Health& health, std::int64_t at_once) const;
  void tell_values(Running& running) const;

  std::shared_ptr<const Program> program_;
  std::vector<double> values_;  // of its parameters
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Running>> idle_;
};

}  // namespace gatewalk::cli
