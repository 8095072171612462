// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "wakeline/batch/run.hpp"

namespace wakeline::test {

/// What runs give whose readings are of two numbers, and the memory of it. The rates are zeros
/// where no model changes its own.
struct RunResults {
  std::size_t states, models;
  std::vector<double> mean, covariance, modes, rates, innovation, nis, log_likelihood;
  std::vector<std::uint8_t> status;

  RunResults(const RunInput& in, std::size_t of_states, std::size_t of_models)
      : states(of_states),
        models(of_models),
        mean(in.runs * in.scans * states),
        covariance(in.runs * in.scans * states * states),
        modes(in.runs * in.scans * models),
        rates(in.runs * in.scans * models),
        innovation(in.runs * in.scans * 2),
        nis(in.runs * in.scans),
        log_likelihood(in.runs * in.scans),
        status(in.runs * in.scans) {}

  [[nodiscard]] RunOutput out() {
    return {states,
            models,
            mean.data(),
            covariance.data(),
            modes.data(),
            rates.data(),
            innovation.data(),
            nis.data(),
            log_likelihood.data(),
            status.data()};
  }

  [[nodiscard]] std::array<const std::vector<double>*, 7> numbers() const {
    return {&mean, &covariance, &modes, &rates, &innovation, &nis, &log_likelihood};
  }
};

}  // namespace wakeline::test
