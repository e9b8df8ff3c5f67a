// SPDX-License-Identifier: MIT
// A file of kept pieces, as --resume and merge read it: as it is, and with all its checksums put
// right. Its pieces are read as those of every kind.
#include <zlib.h>

#include <cstdint>
#include <cstring>

#include "cli/fields/json_value.h"
#include "cli/kept/kept_run.h"
#include "cli/kept/piece_log.h"
#include "dynamics/base/kept_pieces.h"
#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/row_trials.h"
#include "lattice/field/field_trials.h"
#include "lattice/field/running_trial.h"
#include "lattice/text/toml_text.h"
#include "tests/fuzz/fuzz.h"

namespace gatewalk::fuzz {
namespace {

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// The places of the checksums are in piece_log.cpp.
std::string with_checksums(std::string_view bytes) {
  constexpr std::size_t kHead = 40, kBytesAt = 24, kCheckAt = 32, kOwnAt = 36;
  (void)take_line(bytes);
  const std::string_view head = take_line(bytes);
  char first[64];
  std::snprintf(first, sizeof first, "gatewalk pieces 1 l %zu %08x\n", head.size(), crc_of(head));
  std::string records(bytes);
  for (std::size_t at = 0; at + kHead <= records.size();) {
    char* const record = records.data() + at;
    std::memcpy(record, "PIEC", 4);
    std::uint64_t size = 0;
    std::memcpy(&size, record + kBytesAt, sizeof size);
    if (size > records.size() - at - kHead) {
      size = records.size() - at - kHead;
      std::memcpy(record + kBytesAt, &size, sizeof size);
    }
    const std::uint32_t check = crc_of({record + kHead, size});
    std::memcpy(record + kCheckAt, &check, sizeof check);
    const std::uint32_t own = crc_of({record, kOwnAt});
    std::memcpy(record + kOwnAt, &own, sizeof own);
    at += kHead + size;
  }
  return first + std::string(head) + "\n" + records;
}

template <class Piece>
void read_as(std::string_view bytes, Piece piece) {
  (void)accepted([&] {
    dynamics::read_bytes(bytes, piece);
    return true;
  });
}

void read_as_any(std::string_view bytes) {
  lattice::FieldParams field;
  field.columns = 3;
  field.rows = 2;
  read_as(bytes, dynamics::GateTally{});
  read_as(bytes, dynamics::RowTrials{});
  lattice::FieldTally whole(field);
  lattice::FieldTrials each;
  (void)accepted([&] {
    lattice::RunTrials piece{lattice::FieldTally(field), {}};
    dynamics::read_bytes(bytes, piece);
    require(piece.tally.final_cells.sum() == std::ssize(piece.each.final_gates),
            "every trial ends in a gate");
    whole += piece.tally;
    for (std::size_t i = 0; i < piece.each.passed.size(); ++i)
      for (const lattice::CellPassage passage : piece.each.of_trial(i))
        require(passage.entry.face < static_cast<int>(dynamics::kMostFaces), "a face");
    return true;
  });
}

/// The head that a run of this command would have written.
cli::Json usual_head() {
  return {{"version", "1"},
          {"commit", "x"},
          {"command", "gate"},
          {"words", cli::Json::array()},
          {"outputs", cli::Json::array()},
          {"main_output", "json"},
          {"scene", nullptr},
          {"inputs", cli::Json::array()},
          {"others", cli::Json::array()}};
}

void go_on(const std::string& path, const cli::PieceFile& file, const cli::Json& head, bool merge) {
  constexpr std::int64_t kItems = 100;
  constexpr int kMostPieces = 50;
  (void)accepted([&] {
    cli::KeptPlan plan;
    plan.head = head.dump();
    plan.goes_on = true;
    plan.writes = false;
    plan.divided = {"gate runs"};
    if (merge)
      plan.parts = {path};
    else
      plan.file = path;
    cli::KeptRun run(plan);
    for (const cli::PieceRecord& record : file.records()) {
      if (!cli::is_name(record) || record.stage == cli::kEndStage) continue;
      const std::string name = lattice::printable(file.bytes_of(record));  // as a command's own is
      run.begin({name, {0, kItems}});
      std::int64_t at = 0;
      for (int k = 0; k < kMostPieces && at < kItems; ++k) {
        const auto next = run.next(at);
        if (!next) break;
        require(next->items.first >= at && next->items.count > 0 &&
                    next->items.first + next->items.count <= kItems,
                "the next items are of the stage, and there are some");
        if (next->bytes) read_as_any(*next->bytes);
        at = next->items.first + next->items.count;
      }
    }
    run.done();
    return true;
  });
}

void use(const std::string& bytes) {
  const std::string path = file_of(bytes, ".pieces");
  const auto file = accepted([&] { return cli::PieceFile(path); });
  if (!file) return;
  require(file->end() <= bytes.size(), "records end with the file");
  for (const cli::PieceRecord& record : file->records())
    (void)accepted([&] { return file->bytes_of(record).size(); });
  (void)accepted([&] { return cli::part_names({path}).size(); });
  const auto own = accepted([&] { return cli::head_of(*file); });
  for (const bool merge : {false, true}) {
    go_on(path, *file, usual_head(), merge);
    if (own) go_on(path, *file, *own, merge);
  }
}

}  // namespace

void pieces(std::string_view bytes) {
  use(std::string(bytes));
  use(with_checksums(bytes));
}

}  // namespace gatewalk::fuzz
