// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "catalog.hpp"

#include <functional>
#include <span>

#include "wakeline/multimodel/uniform_bank.hpp"

namespace wakeline {

template class Imm<AnyFilterBank>;
template Step<2> AnyImm::update(const AnySensorOf<2>&, const Vec<double, 2>&) noexcept;
template Step<3> AnyImm::update(const AnySensorOf<3>&, const Vec<double, 3>&) noexcept;
template class AnyEstimatorOf<Estimators>;
template AnyStep<2> AnyEstimator::update(const AnySensorOf<2>&, const Vec<double, 2>&) noexcept;
template AnyStep<3> AnyEstimator::update(const AnySensorOf<3>&, const Vec<double, 3>&) noexcept;

namespace python {
namespace {

template <class Estimator, class BeliefOf = std::identity>
void run_all(const Estimator& prototype, const Recordings& recordings, int threads,
             const BeliefOf& belief_of = {}) {
  const auto begin = [&](std::size_t run) {
    Estimator estimator = prototype;
    (void)estimator.start(belief_of(recordings.start(run)));
    return estimator;
  };
  visit_numbers(std::get<AnySensor>(recordings.sensor), [&](const auto& sensor) {
    run_batch(begin, sensor, recordings.in, recordings.out, Threads{threads});
  });
}

/// An Imm of extended Kalman filters of known turns, the usual one, over a bank of one kind: the
/// same bits, sooner. False, and nothing done, for any other.
bool run_turns(const AnyEstimator& any, const Recordings& recordings, int threads) {
  using Turn = Ekf<CoordinatedTurn>;
  const auto* imm = std::get_if<AnyImm>(&any.variant());
  if (imm == nullptr) return false;
  const std::vector<Turn> filters = filters_as<Turn>(imm->bank());
  if (filters.empty()) return false;
  const UniformBank<Turn> bank{std::span<const Turn>(filters)};
  run_all(imm_over(bank, *imm), recordings, threads,
          [](const AnyBelief& belief) { return belief.fixed<4>(); });
  return true;
}

}  // namespace

void run_one_by_one(const AnyFilter& prototype, const Recordings& recordings, int threads) {
  if (std::holds_alternative<RuntimeSensor>(recordings.sensor))
    run_readings(prototype, recordings, threads);
  else
    run_all(prototype, recordings, threads);
}

void run_one_by_one(const AnyEstimator& prototype, const Recordings& recordings, int threads) {
  if (std::holds_alternative<RuntimeSensor>(recordings.sensor))
    run_readings(std::get<AnyImm>(prototype.variant()), recordings, threads);
  else if (!run_turns(prototype, recordings, threads))
    run_all(prototype, recordings, threads);
}

}  // namespace python
}  // namespace wakeline
