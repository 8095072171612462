// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/track_gate.hpp"

#include <gtest/gtest.h>

#include <set>

#include "support/draw.hpp"
#include "track/stages.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace wakeline::track_gate_test {
namespace {

using namespace test;

/// An estimator that was started and predicted, and a track with its estimate.
struct Followed {
  VesselImm imm = vessel_imm(kStageRadar);
  Track track;
  ModePositions modes;

  explicit Followed(const Gaussian<4>& belief, double dt_s) {
    EXPECT_EQ(imm.start(belief), Status::kOk);
    EXPECT_EQ(imm.predict(dt_s), Status::kOk);
    track.kinematics = kinematics_of(imm.estimate());
    track.time_s = dt_s;
    modes.read(imm);
  }
};

Followed followed() {
  const Track at = track_at(0, {1000.0, 8.0, 200.0, -3.0}, {8.0, 3.0, 8.0, 3.0});
  return Followed(at.kinematics, 2.5);
}

// No plot is missed by the search that comes before the gate.
TEST(TrackGate, HoldsEveryPlotWithinTheThresholdOfAModeAndNoOther) {
  for (const double outlier_probability : {0.0, 0.2}) {
    const TrackerConfig config{.outlier_probability = outlier_probability};
    TrackGate gate(config);
    const Followed of = followed();
    Draw draw(3);
    std::vector<Plot> input;
    for (int k = 0; k < 100; ++k)
      input.push_back(plot_at(1020.0 + 50.0 * draw.normal(), 190.0 + 50.0 * draw.normal(),
                              2.5 - draw.uniform(0.0, 2.0)));
    const ScanPlots plots = scan_of(input, 2.5);
    const TimeAlignment alignment(of.track, 2.5, 0.0);
    std::set<int> found, expected;
    for (const ValidatedPlot& plot : gate.validate(of.track, of.modes, alignment, plots)) {
      found.insert(plot.plot);
      EXPECT_EQ(plot.z, alignment.at_prediction(plots[plot.plot]).mean);
    }
    for (int k = 0; k < plots.size(); ++k) {
      const Gaussian<2> there = alignment.at_prediction(plots[k]);
      const Mat<double, 2, 2> r =
          config.outlier_variance() * there.covariance + alignment.added_m2(plots[k]);
      if (of.modes.evidence(there.mean, r).least_nis <= gate.threshold())
        expected.insert(k);
    }
    EXPECT_EQ(found, expected);
    EXPECT_GT(expected.size(), 5u);
    EXPECT_LT(expected.size(), 95u);
  }
}

TEST(TrackGate, HoldsAPlotOfTheTargetWithItsProbability) {
  const TrackerConfig config{.gate_probability = 0.9, .outlier_probability = 0.0};
  TrackGate gate(config);
  Draw draw(4);
  int inside = 0;
  constexpr int kTrials = 4000;
  // One model, so that the belief is one Gaussian.
  Imm single(ModeChain<1>::from_sojourn_s({60.0}), Ekf(VesselModels{}.steady(25.0)));
  const Track at = track_at(0, {0.0, 8.0, 1500.0, -3.0}, {8.0, 3.0, 8.0, 3.0});
  ASSERT_EQ(single.start(at.kinematics), Status::kOk);
  ASSERT_EQ(single.predict(2.5), Status::kOk);
  Track track;
  track.kinematics = kinematics_of(single.estimate());
  track.time_s = 2.5;
  ModePositions modes;
  modes.read(single);
  for (int k = 0; k < kTrials; ++k) {
    const Vec<double, 4> truth = draw.of<4>(track.kinematics);
    Plot plot = plot_at(truth[0] + 2.0 * draw.normal(), truth[2] + 2.0 * draw.normal(), 2.5);
    plot.range_m += 8.0 * draw.normal();
    plot.bearing_rad += deg(0.5) * draw.normal();
    const ScanPlots plots = scan_of({plot}, 2.5);
    inside += !gate.validate(track, modes, TimeAlignment(track, 2.5, 0.0), plots).empty();
  }
  EXPECT_NEAR(double(inside) / kTrials, 0.9, 0.015);
}

TEST(TrackGate, IsEmptyWithoutPlotsNear) {
  TrackGate gate(TrackerConfig{});
  const Followed of = followed();
  const TimeAlignment alignment(of.track, 2.5, 0.0);
  EXPECT_TRUE(gate.validate(of.track, of.modes, alignment, scan_of({}, 2.5)).empty());
  EXPECT_TRUE(
      gate.validate(of.track, of.modes, alignment, scan_of({plot_at(-5000.0, 0.0, 2.5)}, 2.5))
          .empty());
}

}  // namespace
}  // namespace wakeline::track_gate_test
