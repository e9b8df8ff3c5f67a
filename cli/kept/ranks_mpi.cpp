// SPDX-License-Identifier: MIT
// Linked in place of ranks.cpp in builds with -DGATEWALK_MPI=ON.
#include <mpi.h>

#include <cstdlib>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/kept/ranks.h"
#include "cli/terminal/interrupt.h"
#include "dynamics/base/kept_pieces.h"

namespace gatewalk::cli {
namespace {

class MpiRanks : public dynamics::Ranks {
 public:
  MpiRanks() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return size_; }
  [[nodiscard]] std::int64_t of_first(std::int64_t number) override {
    MPI_Bcast(&number, 1, MPI_INT64_T, 0, MPI_COMM_WORLD);
    return number;
  }
  [[nodiscard]] std::vector<std::string> all(const std::string& own) override {
    if (own.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) / size_)
      throw std::runtime_error("a piece of work is too large for MPI");
    const int bytes = static_cast<int>(own.size());
    std::vector<int> sizes(static_cast<std::size_t>(size_)), starts;
    MPI_Allgather(&bytes, 1, MPI_INT, sizes.data(), 1, MPI_INT, MPI_COMM_WORLD);
    std::int64_t sum = 0;
    for (const int n : sizes) {
      starts.push_back(static_cast<int>(sum));
      sum += n;
    }
    if (sum > std::numeric_limits<int>::max())
      throw std::runtime_error("pieces of work are too large for MPI");
    std::string together(static_cast<std::size_t>(sum), '\0');
    MPI_Allgatherv(own.data(), bytes, MPI_CHAR, together.data(), sizes.data(), starts.data(),
                   MPI_CHAR, MPI_COMM_WORLD);
    std::vector<std::string> each;
    for (std::size_t i = 0; i < sizes.size(); ++i)
      each.push_back(
          together.substr(static_cast<std::size_t>(starts[i]), static_cast<std::size_t>(sizes[i])));
    return each;
  }
  void stop_if_asked() override {
    int stop = asked && asked() ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &stop, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    if (stop) throw Interrupted{};
  }

  std::function<bool()> asked;

 private:
  int rank_ = 0, size_ = 1;
};

std::unique_ptr<MpiRanks> mpi;

}  // namespace

RanksScope::RanksScope() {
  // A single process does not start MPI, which takes time.
  bool is_started = false;
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    is_started = is_started || std::getenv(name) != nullptr;
  if (!is_started) return;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  mpi = std::make_unique<MpiRanks>();
}

RanksScope::~RanksScope() {
  if (!mpi) return;
  mpi.reset();
  MPI_Finalize();
}

dynamics::Ranks* ranks() { return mpi && mpi->size() > 1 ? mpi.get() : nullptr; }
bool is_first_rank() { return !mpi || mpi->rank() == 0; }
void set_ranks_stop(std::function<bool()> asked) {
  if (mpi) mpi->asked = std::move(asked);
}
void abort_ranks(int status) {
  if (ranks()) MPI_Abort(MPI_COMM_WORLD, status);
}

}  // namespace gatewalk::cli
