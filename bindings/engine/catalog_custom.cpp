// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "catalog.hpp"

namespace wakeline {

template Step<kMostNumbers> AnyFilter::update(const RuntimeSensor&,
                                              const Vec<double, kMostNumbers>&) noexcept;
template Step<kMostNumbers> AnyImm::update(const RuntimeSensor&,
                                           const Vec<double, kMostNumbers>&) noexcept;

namespace python {
namespace {

template <class Estimator>
void run_all(const Estimator& prototype, const Recordings& recordings, int threads) {
  const auto begin = [&](std::size_t run) {
    Estimator estimator = prototype;
    (void)estimator.start(recordings.start(run));
    return estimator;
  };
  run_batch(begin, std::get<RuntimeSensor>(recordings.sensor), recordings.in, recordings.out,
            Threads{threads});
}

}  // namespace

void run_readings(const AnyFilter& prototype, const Recordings& recordings, int threads) {
  run_all(prototype, recordings, threads);
}

void run_readings(const AnyImm& prototype, const Recordings& recordings, int threads) {
  run_all(prototype, recordings, threads);
}

}  // namespace python
}  // namespace wakeline
