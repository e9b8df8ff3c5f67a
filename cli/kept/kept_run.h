// SPDX-License-Identifier: MIT
#pragma once
/// A command's finished pieces: kept in a file while it runs, found there when it goes on, put
/// together from the files of several machines.

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

/// Part number `number` of `of`, from 1.
struct Shard {
  std::int64_t number = 1, of = 1;
};
/// "3/8". Throws UsageError.
[[nodiscard]] Shard shard_of(const std::string& text);

/// What a run keeps and where.
struct KeptPlan {
  std::string head;              // JSON: what command this is, the same for all its runs
  std::string file;              // empty: pieces are only read
  bool at_once = true;           // the file is made with the first piece, or once it is a minute's
  bool goes_on = false;          // with what the file holds
  bool is_part = false;          // ends when its own items are done
  std::optional<Shard> shard{};  // of the stages that are divided ...
  std::set<std::string> divided{};   // ... these
  std::vector<std::string> parts{};  // files that hold all pieces: none is done
  bool writes = true;                // the file; else another process does
  /// It stops, between two pieces, after so many.
  double most_seconds = std::numeric_limits<double>::infinity();
  std::function<void(const std::string&)> warn;
};

/// Thrown when all items of a part are done.
struct PartDone {
  std::string file;
};

class KeptRun : public dynamics::KeptPieces {
 public:
  /// Reads what files there are. Throws UsageError where they are of another command, scene or
  /// version, which it names, overlap, or are not all there.
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

  /// The result is there: the file goes, unless another run has put its own there.
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
  std::map<std::uint32_t, std::string> names_;  // of the stages found

  std::uint32_t stage_ = 0;  // at hand
  std::string what_;
  dynamics::TrialRange own_;  // items of it
  bool is_named_ = false;     // in the file
  // A piece is done: a time limit ends no run before, or no number of runs would come to an end.
  bool goes_ahead_ = false;

  std::optional<PieceWriter> writer_;
  struct Waiting {
    std::uint32_t stage;
    dynamics::TrialRange items;
    std::string bytes;
  };
  std::vector<Waiting> waiting_;  // until there is a file
  std::size_t waiting_bytes_ = 0;
  dynamics::Stopwatch since_start_;
};

/// What the command was whose pieces a file holds: all that a run writes there. Throws
/// markov::BadFile where anything is missing or of another kind.
[[nodiscard]] Json head_of(const PieceFile& file);
/// The same, of its first lines alone.
[[nodiscard]] Json head_in(const std::string& path);

/// Which part each of these files holds.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> part_names(
    const std::vector<std::string>& parts);

}  // namespace gatewalk::cli
