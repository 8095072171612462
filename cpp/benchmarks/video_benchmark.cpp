// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT

// A scan of 4096 sweeps of 2048 cells of 8 bits from amplitudes to plots: cell averaging over 16
// cells on each side behind 4 guard cells, connected echoes, centroids with covariance. The same
// work is done by a loop written by hand for this one case, which is what the extractor is measured
// against; both must find the same.
//
// Pictures: Rayleigh noise with a threshold that lets few cells through and 200 ships ("sparse"),
// or with one that lets about one cell in 60 through and 20000 echoes ("dense").

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <random>
#include <vector>

#include "wakeline/video/plot_extractor.hpp"

namespace {

using namespace wakeline;

constexpr int kSweeps = 4096;
constexpr int kCells = 2048;
constexpr int kTrain = 16;
constexpr int kGuard = 4;
constexpr double kStep = 2 * kPi<double> / kSweeps;
constexpr double kCell = 7.5;

struct Picture {
  std::vector<std::uint8_t> amplitude;
  double factor;
};

Picture draw(bool dense) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> amplitude(std::size_t{kSweeps} * kCells);
  std::exponential_distribution<float> power(1.0f);
  for (auto& a : amplitude)
    a = static_cast<std::uint8_t>(std::min(255.0f, 20.0f * std::sqrt(power(random))));
  std::uniform_int_distribution<int> any_sweep(0, kSweeps - 40);
  std::uniform_int_distribution<int> any_cell(0, kCells - 10);
  for (int ship = dense ? 20000 : 200; ship > 0; --ship) {
    const int first = any_sweep(random);
    const int near = any_cell(random);
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 5; ++i)
        amplitude[static_cast<std::size_t>(first + j) * kCells +
                  static_cast<std::size_t>(near + i)] =
            static_cast<std::uint8_t>(255 - 5 * std::abs(j - 10) - 10 * std::abs(i - 2));
  }
  return {std::move(amplitude), dense ? 2.4 : 4.4};
}

const Picture& picture(bool dense) {
  static const Picture sparse_picture = draw(false);
  static const Picture dense_picture = draw(true);
  return dense ? dense_picture : sparse_picture;
}

struct Found {
  long plots = 0;
  double range_m = 0.0;  // sums over plots, to be compared
  double bearing_rad = 0.0;
  double variance = 0.0;
};

// By hand
// ------------------------------------------------------------------------------------------

struct HandEcho {
  double w, wr, wrr, wj, wjj, wrj, ww;
  int cells, first_cell, last_cell, first_sweep, last_sweep, peak;
};
struct HandRun {
  int first, last, echo;
};

class HandLoop {
 public:
  explicit HandLoop(double factor)
      : sums_(kCells + 1),
        above_(kCells),
        before_(kCells),
        now_(kCells),
        echo_(4 * kCells),
        set_(4 * kCells),
        free_(4 * kCells) {
    for (int count = 1; count <= 2 * kTrain; ++count)
      weight_[count] = static_cast<std::uint32_t>(std::ceil(65536 * factor / count - 1e-9));
  }

  Found scan(const std::uint8_t* picture) {
    Found found;
    int free_count = 0;
    for (int k = 4 * kCells; k-- > 0;) free_[free_count++] = k;
    int before_count = 0;
    for (int j = 0; j < kSweeps; ++j) {
      const std::uint8_t* a = picture + static_cast<std::size_t>(j) * kCells;
      detect(a);
      int now_count = 0, at = 0, merged = 0;
      for (int i = 0; i < kCells;) {
        std::uint64_t eight = 0;  // cells at a time where nothing is
        if (i + 8 <= kCells) std::memcpy(&eight, &above_[i], 8);
        if (i + 8 <= kCells && eight == 0) {
          i += 8;
          continue;
        }
        if (!above_[i]) {
          ++i;
          continue;
        }
        const int first = i;
        std::uint32_t w = 0, peak = 0;
        std::uint64_t wk = 0, wkk = 0, ww = 0;
        for (; i < kCells && above_[i]; ++i) {
          const std::uint32_t k = static_cast<std::uint32_t>(i - first), v = a[i];
          w += v, wk += v * k, wkk += std::uint64_t{v} * k * k, ww += v * v;
          peak = std::max(peak, v);
        }
        const int last = i - 1;
        int echo = -1;
        while (at < before_count && before_[at].last + 1 < first) ++at;
        for (int k = at; k < before_count && before_[k].first - 1 <= last; ++k) {
          const int other = root(before_[k].echo);
          if (echo < 0) {
            echo = other;
          } else if (echo != other) {
            merge(echo_[echo], echo_[other]);
            set_[other] = echo;
            gone_[merged++] = other;
          }
        }
        if (echo < 0) {
          echo = free_[--free_count];
          set_[echo] = echo;
          echo_[echo] = {0, 0, 0, 0, 0, 0, 0, 0, kCells, -1, j, j, 0};
        }
        HandEcho& e = echo_[echo];
        const double dw = w, r = first, d = j - e.first_sweep;
        const double wr = static_cast<double>(wk) + r * dw;
        e.w += dw, e.wr += wr,
            e.wrr += static_cast<double>(wkk) + r * (static_cast<double>(wk) + wr);
        e.wj += dw * d, e.wjj += dw * d * d, e.wrj += wr * d, e.ww += static_cast<double>(ww);
        e.cells += last - first + 1;
        e.first_cell = std::min(e.first_cell, first), e.last_cell = std::max(e.last_cell, last);
        e.peak = std::max(e.peak, static_cast<int>(peak));
        e.last_sweep = j;
        now_[now_count++] = {first, last, echo};
      }
      if (merged > 0) {
        for (int k = 0; k < before_count; ++k) before_[k].echo = root(before_[k].echo);
        for (int k = 0; k < now_count; ++k) now_[k].echo = root(now_[k].echo);
        while (merged > 0) free_[free_count++] = gone_[--merged];
      }
      for (int k = 0; k < before_count; ++k) {
        HandEcho& e = echo_[before_[k].echo];
        if (e.last_sweep != j - 1) continue;
        close(e, found);
        e.last_sweep = -1;
        free_[free_count++] = before_[k].echo;
      }
      before_.swap(now_);
      before_count = now_count;
    }
    for (int k = 0; k < before_count; ++k) {
      HandEcho& e = echo_[before_[k].echo];
      if (e.last_sweep < 0) continue;
      close(e, found);
      e.last_sweep = -1;
    }
    return found;
  }

 private:
  void detect(const std::uint8_t* __restrict a) {
    constexpr int kFar = kTrain + kGuard;
    std::uint16_t* __restrict sums = sums_.data();
    std::uint8_t* __restrict above = above_.data();
    std::uint16_t sum = 0;
    for (int i = 0; i < kCells; ++i) sums[i] = sum, sum = static_cast<std::uint16_t>(sum + a[i]);
    sums[kCells] = sum;
    const auto edge = [&](int i) {
      const int l0 = std::max(i - kFar, 0), l1 = std::max(i - kGuard, 0);
      const int r0 = std::min(i + kGuard + 1, kCells), r1 = std::min(i + kFar + 1, kCells);
      const auto s = static_cast<std::uint16_t>(sums[l1] - sums[l0] + sums[r1] - sums[r0]);
      above[i] = a[i] > s * weight_[l1 - l0 + r1 - r0] >> 16;
    };
    for (int i = 0; i < kFar; ++i) edge(i), edge(kCells - 1 - i);
    const std::uint32_t weight = weight_[2 * kTrain];
    for (int i = kFar; i < kCells - kFar; ++i) {
      const auto s = static_cast<std::uint16_t>(sums[i - kGuard] - sums[i - kFar] +
                                                sums[i + kFar + 1] - sums[i + kGuard + 1]);
      const auto level = static_cast<std::uint16_t>(s * weight >> 16);
      above[i] = a[i] > level;
    }
  }

  int root(int echo) {
    while (set_[echo] != echo) echo = set_[echo] = set_[set_[echo]];
    return echo;
  }

  static void merge(HandEcho& e, const HandEcho& p) {
    const double d = p.first_sweep - e.first_sweep;
    e.w += p.w, e.wr += p.wr, e.wrr += p.wrr;
    e.wj += p.wj + d * p.w, e.wjj += p.wjj + d * (2 * p.wj + d * p.w), e.wrj += p.wrj + d * p.wr;
    e.ww += p.ww, e.cells += p.cells;
    e.first_cell = std::min(e.first_cell, p.first_cell);
    e.last_cell = std::max(e.last_cell, p.last_cell);
    e.last_sweep = std::max(e.last_sweep, p.last_sweep);
    e.peak = std::max(e.peak, p.peak);
  }

  static void close(const HandEcho& e, Found& found) {
    if (e.cells < 2) return;
    const double r = e.wr / e.w, b = e.wj / e.w, n = e.w * e.w / e.ww;
    ++found.plots;
    found.range_m += (r + 0.5) * kCell;
    found.bearing_rad += (e.first_sweep + b) * kStep;
    found.variance += (std::max(e.wrr / e.w - r * r, 0.0) / n + 1.0 / 12) * kCell * kCell;
    found.variance += (std::max(e.wjj / e.w - b * b, 0.0) / n + 1.0 / 12) * kStep * kStep;
    found.variance += (e.wrj / e.w - r * b) / n * kCell * kStep;
  }

  std::uint32_t weight_[2 * kTrain + 1] = {};
  std::vector<std::uint16_t> sums_;
  std::vector<std::uint8_t> above_;
  std::vector<HandRun> before_, now_;
  std::vector<HandEcho> echo_;
  std::vector<int> set_, free_;
  int gone_[4 * kCells];
};

// With the library
// ---------------------------------------------------------------------------------

PlotExtractor<> extractor_for(double factor) {
  return PlotExtractor<>(
      {.cfar = {.train_cells = kTrain, .guard_cells = kGuard, .threshold_factor = factor},
       .max_sweep_cells = kCells,
       .max_sweeps = 1 << 20});
}

void add(Found& found, std::span<const VideoPlot> plots) {
  for (const VideoPlot& plot : plots) {
    ++found.plots;
    found.range_m += plot.range_m;
    found.bearing_rad += plot.bearing_rad;
    found.variance += plot.covariance(0, 0) + plot.covariance(1, 1) + plot.covariance(1, 0);
  }
}

Found scan(PlotExtractor<>& extractor, const std::uint8_t* picture) {
  Found found;
  for (int j = 0; j < kSweeps; ++j) {
    const std::uint8_t* row = picture + static_cast<std::size_t>(j) * kCells;
    add(found, extractor.process({.azimuth_rad = j * kStep,
                                  .azimuth_width_rad = kStep,
                                  .cell_m = kCell,
                                  .amplitude = {row, std::size_t{kCells}}}));
  }
  add(found, extractor.finish());
  return found;
}

void hand_loop(benchmark::State& state) {
  const Picture& video = picture(state.range(0) != 0);
  HandLoop loop(video.factor);
  for (auto _ : state) benchmark::DoNotOptimize(loop.scan(video.amplitude.data()));
  state.counters["plots"] = static_cast<double>(loop.scan(video.amplitude.data()).plots);
}

void plot_extractor(benchmark::State& state) {
  const Picture& video = picture(state.range(0) != 0);
  PlotExtractor<> extractor = extractor_for(video.factor);
  HandLoop loop(video.factor);
  const Found ours = scan(extractor, video.amplitude.data());
  const Found theirs = loop.scan(video.amplitude.data());
  const auto near = [](double a, double b) { return std::fabs(a - b) <= 1e-9 * std::fabs(b); };
  if (ours.plots != theirs.plots || !near(ours.range_m, theirs.range_m) ||
      !near(ours.bearing_rad, theirs.bearing_rad) || !near(ours.variance, theirs.variance)) {
    state.SkipWithError("does not find what the loop by hand finds");
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(scan(extractor, video.amplitude.data()));
  state.counters["plots"] = static_cast<double>(ours.plots);
}

}  // namespace

BENCHMARK(hand_loop)->ArgName("dense")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(plot_extractor)->ArgName("dense")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
