// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "wakeline/core/fields.hpp"
#include "wakeline/filter/smoother.hpp"

namespace wakeline {

/// Parameters of a window bank.
struct WindowBankSettings {
  int max_readings = 32;
  double memory = 0.92;

  static constexpr auto fields() noexcept {
    using W = WindowBankSettings;
    return field_table(field("max_readings", &W::max_readings, at_least(2), "readings",
                             "Readings of the longest window."),
                       field("memory", &W::memory, between(0, 1), "1",
                             "Share of its energy that a window keeps at each reading."));
  }
};

/// Least-squares lines through the last 2, 3, ... readings. The result is the line with the best
/// predictions so far, i.e. the least energy of its innovations,
///     E_n = memory E_n + (x - x~_n)².
/// Short windows win in a maneuver, long ones on a straight; noise and maneuvers need no tuning. A
/// window that is not full yet uses the readings there are. One pass over the longest window per
/// reading, storage in place, no heap.
template <class Residual = Linear, int Capacity = 32, class ScalarType = double>
class WindowBank {
 public:
  static_assert(Capacity >= 2, "wakeline: a line needs two readings");
  using Scalar = ScalarType;

  /// Throws `std::invalid_argument` when a setting is invalid. The default is limited to the
  /// capacity.
  explicit WindowBank(const WindowBankSettings& settings =
                          {.max_readings = std::min(WindowBankSettings{}.max_readings, Capacity)})
      : settings_(settings) {
    validate_fields(settings);
    require(settings.max_readings <= Capacity, "max_readings",
            ("at most " + std::to_string(Capacity)).c_str(), settings.max_readings);
  }

  /// Adds a reading. Two readings of the same time (dt_s = 0) are replaced by their mean, and the
  /// energies are not updated, because they may be the same reading.
  Status update(Scalar dt_s, Scalar reading) noexcept {
    const bool judges = readings_.size() > 0 && !readings_.is_of_newest_time(dt_s);
    const Scalar before = readings_.newest();
    const Status status = readings_.take(dt_s, reading);
    if (status != Status::kOk) return status;
    if (judges) weigh(dt_s, Residual::difference(reading, before));
    fit();
    return status;
  }

  [[nodiscard]] Scalar value() const noexcept { return forecast(Scalar(0)); }
  [[nodiscard]] Scalar rate() const noexcept { return line(chosen_).rate; }
  [[nodiscard]] Scalar forecast(Scalar ahead_s) const noexcept {
    return Residual::normal(readings_.newest() + line(chosen_).value + rate() * ahead_s);
  }
  /// Number of readings in the selected window.
  [[nodiscard]] int window() const noexcept { return std::min(chosen_, readings_.size()); }

  /// Saves or restores the state; invalid bytes change nothing.
  void archive(Archive& fields) {
    WindowBank read = *this;
    read.readings_.archive(fields);
    fields(read.lines_);
    fields(read.energy_);
    fields(read.chosen_);
    if (read.chosen_ < 2 || read.chosen_ > settings_.max_readings) fields.fail();
    if (fields.ok()) *this = read;
  }

 private:
  using Line = AlphaBetaLine<Scalar>;  // relative to the newest reading, at its time

  Line& line(int n) noexcept { return lines_[std::size_t(n - 2)]; }
  [[nodiscard]] const Line& line(int n) const noexcept { return lines_[std::size_t(n - 2)]; }

  /// Updates the energies with the prediction errors of a reading that is `rise` above the one
  /// before, and selects a window.
  void weigh(Scalar dt_s, Scalar rise) noexcept {
    chosen_ = 2;
    for (int n = 2; n <= settings_.max_readings; ++n) {
      Scalar& energy = energy_[std::size_t(n - 2)];
      const Scalar innovation = Residual::difference(rise, line(n).value + line(n).rate * dt_s);
      energy = Scalar(settings_.memory) * energy + innovation * innovation;
      if (energy < energy_[std::size_t(chosen_ - 2)]) chosen_ = n;
    }
  }

  /// The lines through the last 2, 3, ... readings, by sums accumulated backwards in time.
  void fit() noexcept {
    const int size = readings_.size();
    Scalar age = Scalar(0), mean_age = Scalar(0), mean = Scalar(0);
    Scalar age_age = Scalar(0), age_value = Scalar(0);
    Line last{};
    for (int n = 1; n <= std::min(size, settings_.max_readings); ++n) {
      const int k = size - n;
      if (n > 1) age += readings_.gap_s(k + 1);
      const Scalar away = age - mean_age;
      mean_age += away / Scalar(n);
      age_age += away * (age - mean_age);
      age_value += (age - mean_age) * (readings_.offset(k) - mean);
      mean += (readings_.offset(k) - mean) / Scalar(n);
      last.rate = age_age > Scalar(0) ? -age_value / age_age : Scalar(0);
      last.value = mean + mean_age * last.rate;
      if (n > 1) line(n) = last;
    }
    for (int n = std::max(size + 1, 2); n <= settings_.max_readings; ++n) line(n) = last;
  }

  WindowBankSettings settings_;
  ReadingWindow<Residual, Capacity, Scalar> readings_;
  std::array<Line, std::size_t(Capacity - 1)> lines_{};
  std::array<Scalar, std::size_t(Capacity - 1)> energy_{};
  int chosen_ = 2;
};

}  // namespace wakeline
