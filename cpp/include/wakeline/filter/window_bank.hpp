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

/// What a bank of windows remembers.
struct WindowBankSettings {
  int max_readings = 32;
  double memory = 0.92;

  static constexpr auto fields() noexcept {
    using W = WindowBankSettings;
    return std::tuple{
        field("max_readings", &W::max_readings, at_least(2), "readings",
              "Readings of the longest window."),
        field("memory", &W::memory, between(0, 1), "1",
              "Share of its energy that a window keeps at each reading."),
    };
  }
};

/// The least-squares lines through the last 2, 3, ... readings, of which that one speaks that has
/// foretold the readings best: the one with the least energy of its innovations,
///     E_n = memory E_n + (x - x~_n)².
/// Short windows follow a maneuver, long ones rest in between; nothing has to be tuned to the noise
/// or to the maneuvers. A window that is not full yet holds what there is. Cost is one pass over
/// the longest window, storage in place, no heap.
template <class Residual = Linear, int Capacity = 32, class ScalarType = double>
class WindowBank {
 public:
  static_assert(Capacity >= 2, "wakeline: a line needs two readings");
  using Scalar = ScalarType;

  /// Throws `std::invalid_argument` when a setting makes no sense. By default windows are no longer
  /// than there is room for.
  explicit WindowBank(const WindowBankSettings& settings =
                          {.max_readings = std::min(WindowBankSettings{}.max_readings, Capacity)})
      : settings_(settings) {
    validate_fields(settings);
    require(settings.max_readings <= Capacity, "max_readings",
            ("at most " + std::to_string(Capacity)).c_str(), settings.max_readings);
  }

  /// Takes a reading; one of the time of the reading before joins it: both become their mean, and
  /// no line is judged by it, which may be the same reading told twice.
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
  /// Readings of the window that speaks.
  [[nodiscard]] int window() const noexcept { return std::min(chosen_, readings_.size()); }

  /// Saves or restores what the readings have left; bytes that do not fit change nothing.
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
  using Line = AlphaBetaLine<Scalar>;  // less the newest reading, at its time

  Line& line(int n) noexcept { return lines_[std::size_t(n - 2)]; }
  [[nodiscard]] const Line& line(int n) const noexcept { return lines_[std::size_t(n - 2)]; }

  /// Adds how the lines have foretold a reading that lies `rise` above the one before, and chooses.
  void weigh(Scalar dt_s, Scalar rise) noexcept {
    chosen_ = 2;
    for (int n = 2; n <= settings_.max_readings; ++n) {
      Scalar& energy = energy_[std::size_t(n - 2)];
      const Scalar innovation = Residual::difference(rise, line(n).value + line(n).rate * dt_s);
      energy = Scalar(settings_.memory) * energy + innovation * innovation;
      if (energy < energy_[std::size_t(chosen_ - 2)]) chosen_ = n;
    }
  }

  /// The lines through the last 2, 3, ... readings, by sums that grow backwards in time.
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
