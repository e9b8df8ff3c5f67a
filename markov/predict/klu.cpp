// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <klu.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>

#include "markov/predict/end_sums.h"
#include "markov/predict/plan.h"
#include "markov/predict/transient.h"
#include "markov/solvers.h"

namespace gatewalk::markov {
namespace {

static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));

// A factorisation by KLU, freed with the object.
class Klu {
 public:
  Klu(Transient& t, double most_numbers)
      : t_(t), n_(static_cast<SuiteSparse_long>(t.states.size())) {
    klu_l_defaults(&common_);
    symbolic_ = klu_l_analyze(n_, t_.begin.data(), t_.index.data(), &common_);
    if (symbolic_ && symbolic_->lnz + symbolic_->unz > most_numbers) {
      common_.status = KLU_TOO_LARGE;
      return;
    }
    if (symbolic_) {
      numeric_ =
          klu_l_factor(t_.begin.data(), t_.index.data(), t_.value.data(), symbolic_, &common_);
    }
    if (numeric_) {
      klu_l_condest(t_.begin.data(), t_.value.data(), symbolic_, numeric_, &common_);
    }
  }
  ~Klu() {
    klu_l_free_numeric(&numeric_, &common_);
    klu_l_free_symbolic(&symbolic_, &common_);
  }
  Klu(const Klu&) = delete;
  Klu& operator=(const Klu&) = delete;

  [[nodiscard]] int status() const { return static_cast<int>(common_.status); }
  [[nodiscard]] double condition() const { return common_.condest; }

  // Replaces x by A \ x.
  [[nodiscard]] bool solve(std::vector<double>& x) {
    return klu_l_solve(symbolic_, numeric_, n_, 1, x.data(), &common_) != 0;
  }

 private:
  Transient& t_;
  SuiteSparse_long n_;
  klu_l_common common_{};
  klu_l_symbolic* symbolic_ = nullptr;
  klu_l_numeric* numeric_ = nullptr;
};

// The expected number of draws in each transient state.
std::vector<double> visits(Transient& t, double most_numbers) {
  constexpr double kWorstCondition = 1e-6 / std::numeric_limits<double>::epsilon();
  Klu klu(t, most_numbers);
  if (klu.status() == KLU_OUT_OF_MEMORY) throw std::bad_alloc();
  if (klu.status() == KLU_TOO_LARGE)
    throw std::runtime_error("absorption: the factors of I - Q of " +
                             std::to_string(t.states.size()) +
                             " states have too many numbers; propagate instead");
  if (klu.status() == KLU_SINGULAR) {
    throw std::runtime_error(
        "absorption: I - Q is singular: from the start a walk can get into a "
        "closed loop and never end");
  }
  if (klu.status() != KLU_OK) {
    throw std::runtime_error("absorption: KLU fails with status " + std::to_string(klu.status()));
  }
  if (!(klu.condition() <= kWorstCondition)) {
    throw std::runtime_error(
        fmt::format("absorption: I - Q is singular or nearly so (condition about {:.6g}): a walk "
                    "can circle (almost) for ever, fewer than 6 digits hold",
                    klu.condition()));
  }
  std::vector<double> x(t.states.size(), 0.0);
  x.front() = 1.0;
  if (!klu.solve(x)) throw std::runtime_error("absorption: KLU cannot solve");
  return x;
}

// The sum of magnitudes of start - (I - Q)^T draws: the mass that the draws do not account for.
double missing(const Transient& t, const std::vector<double>& draws) {
  std::vector<double> left(draws.size(), 0.0);
  left.front() = 1.0;
  for (std::size_t s = 0; s < draws.size(); ++s)
    for (auto k = static_cast<std::size_t>(t.begin[s]);
         k < static_cast<std::size_t>(t.begin[s + 1]); ++k)
      left[static_cast<std::size_t>(t.index[k])] -= t.value[k] * draws[s];
  CompensatedSum sum;
  for (const double mass : left) sum += std::abs(mass);
  return sum.value();
}

}  // namespace

FinalDistribution solve_absorption(const FieldChain& chain, const Field& field,
                                   const Start& start) {
  return solve_by_klu(chain, field, start, std::numeric_limits<double>::infinity());
}

FinalDistribution solve_by_klu(const FieldChain& field_chain, const Field& field,
                               const Start& start, double most_numbers) {
  validate(field_chain, field, start, 0);
  if (!field_chain.at(start.column, start.row).is_sampled(start.input)) {
    EndSums ends(field);
    ends.add(Ending::unsampled, std::int64_t{start.row} * field.columns + start.column, 1.0);
    return ends.result();
  }
  Transient t(field_chain, field, start);
  const std::vector<double> draws = visits(t, most_numbers);

  FinalDistribution result = t.ended(draws, field_chain, field);
  result.remainder = missing(t, draws);
  int n_out = 0;
  for (const Chain& chain : field_chain.chains()) n_out = std::max(n_out, chain.outputs());
  result.rounding = rounding_bound(
      result.mean_steps, 2.0 * static_cast<double>(field_chain.inputs() + n_out + 4), n_out + 8);
  // The condition estimate does not detect a closed loop of one state.
  const double total =
      result.trapped() + result.left_field() + result.unsampled() + result.remainder;
  if (!(std::abs(total - 1.0) <= 1e-6) || !(result.rounding >= 0.0))
    throw std::runtime_error(
        "absorption: I - Q is singular or nearly so: a walk can circle (almost) for ever, "
        "fewer than 6 digits hold");
  return result;
}

}  // namespace gatewalk::markov
