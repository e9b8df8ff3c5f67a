// SPDX-License-Identifier: MIT
#pragma once
/// Keeps a command's finished pieces of work in a file while it runs, finds them there when the run
/// is resumed, and joins the files of several machines.

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/fields/json_fwd.h"
#include "cli/kept/piece_log.h"
#include "dynamics/base/kept_pieces.h"

namespace gatewalk::cli {

/// Part `number` of `of`, counted from 1.
struct Shard {
  std::int64_t number = 1, of = 1;
};
/// Reads "3/8". Throws UsageError.
[[nodiscard]] Shard shard_of(const std::string& text);

/// What a run keeps and where.
struct KeptPlan {
  std::string head;                  // JSON: the command, the same for all its runs
  std::string file;                  // empty: pieces are only read
  bool at_once = true;               // makes the file with the first piece; else after a minute
  bool goes_on = false;              // with the pieces in the file
  bool is_part = false;              // ends when its own items are done
  std::optional<Shard> shard{};      // the part of the divided stages
  std::set<std::string> divided{};   // names of the divided stages
  std::vector<std::string> parts{};  // files with all pieces, of merge
  bool writes = true;                // this process writes the file; else another does
  /// Longest time of work (s); the run stops between two pieces.
  double most_seconds = std::numeric_limits<double>::infinity();
  std::function<void(const std::string&)> warn;
};

/// Thrown when all items of a part are done.
struct PartDone {
  std::string file;
};

class KeptRun : public dynamics::KeptPieces {
 public:
  /// Reads the files of the plan. Throws UsageError, naming the difference, if they belong to
  /// another command, scene or version, and if their pieces overlap or are incomplete.
  explicit KeptRun(KeptPlan plan);
  ~KeptRun() override = default;
  KeptRun(const KeptRun&) = delete;
  KeptRun& operator=(const KeptRun&) = delete;

  void begin(const dynamics::Stage& stage) override;
  [[nodiscard]] std::optional<Next> next(std::int64_t at) override;
  void keep(dynamics::TrialRange items, std::string bytes) override;
  [[nodiscard]] bool is_part() const override { return plan_.is_part; }
  [[nodiscard]] bool has_share(const dynamics::Stage& stage) const override;
  void end_part() override;

  /// Removes the file, because the result is written. A file that another run has put in its place
  /// stays.
  void done();

 private:
  struct Found {
    std::size_t file;
    PieceRecord record;
  };
  using Stages = std::map<std::uint32_t, std::map<std::int64_t, Found>>;

  void read(std::size_t number);
  void check_parts() const;
  [[nodiscard]] dynamics::TrialRange own_share(const dynamics::Stage& stage) const;
  [[nodiscard]] bool divides(const dynamics::Stage& stage) const {
    return plan_.shard && plan_.divided.contains(std::string(stage.what));
  }
  void write(std::uint32_t stage, dynamics::TrialRange items, std::string_view bytes);
  void open();
  void give_up(const std::exception& e);

  KeptPlan plan_;
  std::vector<PieceFile> files_;
  Stages found_;
  std::map<std::uint32_t, std::string> names_;  // names of the stages found

  std::uint32_t stage_ = 0;  // the current stage
  std::string what_;
  dynamics::TrialRange own_;  // its items in this part
  bool is_named_ = false;     // whether its name is in the file
  // Whether this run has done a piece. A time limit takes effect only then: otherwise runs with a
  // short limit would never finish.
  bool goes_ahead_ = false;

  std::optional<PieceWriter> writer_;
  struct Waiting {
    std::uint32_t stage;
    dynamics::TrialRange items;
    std::string bytes;
  };
  std::vector<Waiting> waiting_;  // pieces until there is a file
  std::size_t waiting_bytes_ = 0;
  dynamics::Stopwatch since_start_;
};

/// The head of a file of pieces, which says what the command was. Throws markov::BadFile if a key
/// is missing or of another kind.
[[nodiscard]] Json head_of(const PieceFile& file);
/// The head of a file of pieces, read from its first lines alone. Throws as head_of().
[[nodiscard]] Json head_in(const std::string& path);

/// Each file with the part that it holds, in words.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> part_names(
    const std::vector<std::string>& parts);

}  // namespace gatewalk::cli
