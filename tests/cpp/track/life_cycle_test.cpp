// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/life_cycle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace wakeline::life_cycle_test {
namespace {

const Radar kRadar{.period_s = 2.5, .max_speed_mps = 25.0};

/// A track that was seen as in the pattern, one letter a scan.
Track seen(const std::string& pattern, TrackStatus status = TrackStatus::kTentative) {
  Track track;
  track.existence = 0.9999;
  track.status = status;
  track.kinematics.covariance.setIdentity();
  track.kinematics.mean.setZero();
  for (const char letter : pattern) track.count(letter == '1');
  return track;
}

TEST(LifeCycle, ConfirmsMOfTheLastNWithThisScanAmongThem) {
  const TrackerConfig config{.confirm_hits = 3, .confirm_window = 5};
  EXPECT_TRUE(is_confirmable(config, kRadar, seen("111")));
  EXPECT_TRUE(is_confirmable(config, kRadar, seen("11001")));
  EXPECT_FALSE(is_confirmable(config, kRadar, seen("110001"))) << "the first has left the window";
  EXPECT_FALSE(is_confirmable(config, kRadar, seen("1110"))) << "not seen in this scan";
  Track doubtful = seen("11111");
  doubtful.existence = 0.5;
  EXPECT_FALSE(is_confirmable(config, kRadar, doubtful));
}

TEST(LifeCycle, AConfirmedTrackCoastsThenIsHeldAndComesBack) {
  const TrackerConfig config;
  Track track = seen("111");
  EXPECT_FALSE(confirm_or_coast(config, kRadar, 2.0, track));
  EXPECT_EQ(track.status, TrackStatus::kConfirmed);
  const TrackStatus expected[] = {TrackStatus::kCoasting, TrackStatus::kCoasting,
                                  TrackStatus::kHeld, TrackStatus::kHeld};
  for (int missed = 1; missed <= 4; ++missed) {
    track.count(false);
    EXPECT_EQ(confirm_or_coast(config, kRadar, 2.0, track), missed == 1) << "begins to coast once";
    EXPECT_EQ(track.status, expected[missed - 1]) << missed;
  }
  track.count(true);
  EXPECT_FALSE(confirm_or_coast(config, kRadar, 2.0, track));
  EXPECT_EQ(track.status, TrackStatus::kConfirmed);
}

TEST(LifeCycle, ATrackWhosePlotAnotherTrackHasIsShown) {
  Track track = seen("111", TrackStatus::kConfirmed);
  for (int missed = 1; missed <= 10; ++missed) {
    track.count(false, true);
    (void)confirm_or_coast({}, kRadar, 2.0, track);
    EXPECT_EQ(track.status, TrackStatus::kCoasting) << missed;
  }
}

TEST(LifeCycle, ATrackFarAboveTheSpeedLimitIsHeldUntilItIsSlower) {
  Track track = seen("111", TrackStatus::kConfirmed);
  const auto status_at = [&](double speed_mps) {
    track.kinematics.mean[1] = speed_mps;
    (void)confirm_or_coast({}, kRadar, 2.0, track);
    return track.status;
  };
  EXPECT_EQ(status_at(1.1 * kRadar.max_speed_mps), TrackStatus::kConfirmed);
  EXPECT_EQ(status_at(1.3 * kRadar.max_speed_mps), TrackStatus::kHeld);
  EXPECT_EQ(status_at(0.9 * kRadar.max_speed_mps), TrackStatus::kConfirmed);
}

TEST(LifeCycle, ATentativeTrackThatIsNotConfirmableStaysTentative) {
  Track track = seen("10");
  EXPECT_FALSE(confirm_or_coast(TrackerConfig{}, kRadar, 2.0, track));
  EXPECT_EQ(track.status, TrackStatus::kTentative);
}

TEST(LifeCycle, AllowsMoreMissesToATrackThatWasSeenMore) {
  const TrackerConfig config{
      .tentative_misses = 2, .coast_scans = 3.0, .coast_scans_per_hit = 0.5, .coast_scans_max = 6};
  EXPECT_EQ(allowed_misses(config, seen("1111")), 2.0);
  EXPECT_EQ(allowed_misses(config, seen("11", TrackStatus::kConfirmed)), 4.0);
  EXPECT_EQ(allowed_misses(config, seen(std::string(50, '1'), TrackStatus::kConfirmed)), 6.0);
  const auto reason = [&](const Track& track) { return reason_to_delete(config, kRadar, track); };
  EXPECT_EQ(reason(seen("1100")), LossReason::kNone);
  EXPECT_EQ(reason(seen("11000")), LossReason::kMissed);
  EXPECT_EQ(reason(seen("110000", TrackStatus::kCoasting)), LossReason::kNone);
  EXPECT_EQ(reason(seen("1100000", TrackStatus::kCoasting)), LossReason::kMissed);
}

TEST(LifeCycle, MissesInWhichAnotherTrackHadThePlotCountHalf) {
  const TrackerConfig config{.coast_scans = 4.0, .coast_scans_per_hit = 0.0};
  const auto reason_after = [&](int shared, int alone) {
    Track track = seen("111", TrackStatus::kCoasting);
    for (int k = 0; k < shared; ++k) track.count(false, true);
    for (int k = 0; k < alone; ++k) track.count(false);
    return reason_to_delete(config, kRadar, track);
  };
  EXPECT_EQ(reason_after(8, 0), LossReason::kNone);
  EXPECT_EQ(reason_after(9, 0), LossReason::kMissed);
  EXPECT_EQ(reason_after(4, 2), LossReason::kNone);
  EXPECT_EQ(reason_after(4, 3), LossReason::kMissed);
}

TEST(LifeCycle, AStartInDenseClutterIsNotDeletedBeforeItIsMoreDoubtful) {
  const TrackerConfig config;
  Track track = seen("11");
  track.existence = track.start_existence = 0.1 * config.drop_existence;
  EXPECT_EQ(reason_to_delete(config, kRadar, track), LossReason::kNone);
  track.existence *= 0.2;
  EXPECT_EQ(reason_to_delete(config, kRadar, track), LossReason::kDoubtful);
}

TEST(LifeCycle, DeletesWhatIsDoubtfulTooFastOrLostInPosition) {
  const TrackerConfig config;
  const auto reason = [&](const Track& track) { return reason_to_delete(config, kRadar, track); };
  EXPECT_EQ(reason(seen("11")), LossReason::kNone);
  Track doubtful = seen("11"), sure = seen("11", TrackStatus::kConfirmed);
  doubtful.existence = sure.existence = 0.5 * config.drop_existence;
  EXPECT_EQ(reason(doubtful), LossReason::kDoubtful);
  EXPECT_EQ(reason(sure), LossReason::kNone) << "a confirmed one ends by misses alone";
  Track fast = seen("11");
  fast.kinematics.mean[1] = 25.1;
  EXPECT_EQ(reason(fast), LossReason::kTooFast);
  fast.kinematics.mean[1] = 24.9;
  EXPECT_EQ(reason(fast), LossReason::kNone);
  Track wide = seen("11");
  wide.kinematics.covariance *= std::pow(1.01 * config.drop_position_std_m, 2);
  EXPECT_EQ(reason(wide), LossReason::kUncertain);
  wide.plot_m2 = std::pow(config.drop_position_std_m, 2);
  EXPECT_EQ(reason(wide), LossReason::kNone) << "its plots are as wide";
  wide.kinematics.covariance *= std::nan("");
  EXPECT_EQ(reason(wide), LossReason::kUncertain);
}

TEST(LifeCycle, TheSpeedLimitGovernsStartsAndEndsATrackThatIsCertainlyAboveIt) {
  const TrackerConfig config;
  const auto reason = [&](const Track& track) { return reason_to_delete(config, kRadar, track); };
  Track track = seen("11111", TrackStatus::kConfirmed);
  track.kinematics.mean << 0.0, 16.0, 0.0, -22.0;  // 27.2 m/s
  const Vec<double, 2> along = track.velocity().normalized();
  for (const double std_mps : {0.5, 0.7, 0.76, 2.0}) {
    // Wide across the course, which says nothing about the speed.
    Mat<double, 2, 2> covariance = 100.0 * Mat<double, 2, 2>::Identity();
    covariance += (std_mps * std_mps - 100.0) * along * along.transpose();
    const auto rows = Eigen::seqN(1, Eigen::fix<2>, Eigen::fix<2>);
    track.kinematics.covariance(rows, rows) = covariance;
    const bool certain = track.speed_mps() - 25.0 > 3.0 * std_mps;
    EXPECT_EQ(reason(track), certain ? LossReason::kTooFast : LossReason::kNone) << std_mps;
  }
  Track start = seen("111");
  EXPECT_TRUE(is_confirmable(config, kRadar, start));
  start.kinematics.mean[3] = 25.1;
  EXPECT_FALSE(is_confirmable(config, kRadar, start)) << "however uncertain";
}

}  // namespace
}  // namespace wakeline::life_cycle_test
