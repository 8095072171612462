// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/existence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wakeline::existence_test {
namespace {

/// A track as one radar sees it.
struct Seen : Track {
  double visibility;

  Seen(double existence_, double visibility_) : visibility(visibility_) { existence = existence_; }

  void predict(const TrackerConfig& config, double dt_s) {
    const ExistencePrediction prediction(config, dt_s);
    existence = prediction.existence(existence);
    visibility = prediction.visibility(visibility);
  }
  void update(const TrackerConfig& config, const Detection& detection, const ScanLikelihood& scan) {
    update_existence(config, detection, scan, *this, visibility);
  }
};

TEST(Existence, FadesByTheMeanTimeToLeave) {
  const TrackerConfig config{.survival_time_s = 200.0};
  Seen track(0.8, 1.0);
  track.predict(config, 50.0);
  EXPECT_DOUBLE_EQ(track.existence, 0.8 * std::exp(-0.25));
}

TEST(Existence, OneStepIsAsManySmallOnes) {
  const TrackerConfig config;
  Seen once(0.8, 0.9), often = once;
  once.predict(config, 30.0);
  for (int k = 0; k < 12; ++k) often.predict(config, 2.5);
  EXPECT_NEAR(once.existence, often.existence, 1e-12);
  EXPECT_NEAR(once.visibility, often.visibility, 1e-12);
}

TEST(Existence, VisibilityTendsToItsLongRun) {
  const TrackerConfig config{.visible_time_s = 60.0, .hidden_time_s = 40.0};
  for (const double visibility : {0.0, 1.0}) {
    Seen track(0.5, visibility);
    track.predict(config, 1e4);
    EXPECT_NEAR(track.visibility, 0.6, 1e-12);
  }
}

TEST(Existence, FallsByTheMissFactor) {
  const TrackerConfig config;
  Seen track(0.8, 1.0);
  const double missed = DetectionProbability(config).of(1.0).missed;
  EXPECT_DOUBLE_EQ(missed, 1.0 - config.detection_probability * config.in_gate());
  track.update(config, DetectionProbability(config).of(track.visibility), {missed, missed, false});
  const double odds = track.existence / (1.0 - track.existence);
  EXPECT_NEAR(odds, 0.8 / 0.2 * missed, 1e-12);
}

TEST(Existence, RisesByTheLikelihoodRatioOfTheScan) {
  const TrackerConfig config;
  Seen track(0.2, 1.0);
  const double missed = DetectionProbability(config).of(1.0).missed;
  track.update(config, DetectionProbability(config).of(track.visibility), {50.0, missed, false});
  EXPECT_NEAR(track.existence / (1.0 - track.existence), 0.2 / 0.8 * 50.0, 1e-9);
}

TEST(Existence, AMissSpeaksAgainstVisibilityAndAPlotForIt) {
  const TrackerConfig config;
  Seen missed(0.9, 0.7), seen = missed, assigned = missed;
  const double none = DetectionProbability(config).of(0.7).missed;
  missed.update(config, DetectionProbability(config).of(0.7), {none, none, false});
  EXPECT_NEAR(missed.visibility,
              0.7 * (1.0 - config.detection_probability * config.in_gate()) / none, 1e-12)
      << "Bayes' rule";
  seen.update(config, DetectionProbability(config).of(0.7), {none + 10.0, none, false});
  EXPECT_GT(seen.visibility, 0.95);
  assigned.update(config, DetectionProbability(config).of(0.7), {10.0, 0.0, true});
  EXPECT_EQ(assigned.visibility, 1.0);
}

TEST(Existence, VisibilityStaysAProbabilityHoweverSureTheRadarIs) {
  TrackerConfig config;
  config.detection_probability = 1.0;
  config.gate_probability = 1.0 - 1e-15;
  for (const double visibility : {1e-20, 0.0})
    for (const bool assigned : {false, true})
      for (const double total : {1.0 - 1e-16, 1.0, 0.0}) {
        Seen track(0.5, visibility);
        track.update(config, DetectionProbability(config).of(track.visibility),
                     {total, assigned ? 0.0 : 1.0, assigned});
        EXPECT_TRUE(track.visibility >= 0.0 && track.visibility <= 1.0) << track.visibility;
      }
}

TEST(Existence, IsNeverCertain) {
  const TrackerConfig config;
  Seen track(0.5, 1.0);
  for (int k = 0; k < 100; ++k)
    track.update(config, DetectionProbability(config).of(track.visibility), {1e9, 0.1, false});
  EXPECT_LT(track.existence, 1.0);
  EXPECT_GT(track.existence, 0.9999);
}

TEST(Detection, OfATargetThatIsNeverVisibleIsNone) {
  const Detection detection = DetectionProbability(TrackerConfig{}).of(0.0);
  EXPECT_EQ(detection.detected, 0.0);
  EXPECT_EQ(detection.missed, 1.0);
}

TEST(DetectionProbability, BeginsWithTheConfiguredOneAndIsThatOfTheLastLooks) {
  const TrackerConfig config{.detection_probability = 0.7};
  DetectionProbability learned(config);
  EXPECT_DOUBLE_EQ(learned.value(), 0.7);
  for (const double share : {0.5, 0.9}) {
    for (int look = 0; look < 5000; ++look) learned.learn(look % 10 < 10.0 * share ? 1.0 : 0.0);
    learned.evaluate();
    EXPECT_NEAR(learned.value(), share, 0.01);
  }
}

TEST(DetectionProbability, StaysUntilItIsEvaluated) {
  DetectionProbability learned{TrackerConfig{}};
  const double before = learned.value();
  for (int look = 0; look < 100; ++look) learned.learn(0.0);
  EXPECT_EQ(learned.value(), before);
  learned.evaluate();
  EXPECT_LT(learned.value(), before);
}

TEST(DetectionProbability, AsManyMissesAreLikelyAsItAllows) {
  const DetectionProbability half{TrackerConfig{.detection_probability = 0.5}};
  EXPECT_NEAR(half.likely_misses(0.125), 3.0, 1e-12);
  EXPECT_EQ(half.likely_misses(1.0), 0.0);
  EXPECT_EQ(half.likely_misses(0.0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace wakeline::existence_test
