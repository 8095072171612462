// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Saving and restoring, independence, determinism, and a heap that is left alone.
#include <bit>

#include "support/malloc_fence.hpp"
#include "support/matrix_assert.hpp"
#include "track/scene.hpp"

namespace wakeline::state_test {
namespace {

using namespace test;

struct Scan {
  double time_s;
  std::vector<Plot> plots;
};

/// Boats that come and go among clutter.
std::vector<Scan> busy_scans(std::uint64_t seed, int count) {
  Sea sea(seed);
  std::vector<Boat> boats;
  for (int k = 0; k < 10; ++k)
    boats.push_back({{sea.draw.uniform(-2500, 2500), sea.draw.uniform(-2500, 2500)},
                     6.0 * sea.draw.normals<2>()});
  std::vector<Scan> scans;
  for (int k = 0; k < count; ++k) {
    Scan scan{2.5 * k, {}};
    for (const Boat& boat : boats)
      if (sea.draw.uniform(0, 1) < 0.8)
        scan.plots.push_back(sea.plot(boat.at(scan.time_s), scan.time_s));
    for (int n = 0; n < 10; ++n) scan.plots.push_back(sea.clutter(scan.time_s, 3000.0));
    scans.push_back(scan);
  }
  return scans;
}

/// What comes of a scan, copied.
struct Outcome {
  std::vector<std::int64_t> plot_track_id;
  std::vector<Event> events;
  std::vector<Track> tracks;
  std::vector<VesselImm::Probability> mode_probability;
};

Outcome process(VesselTracker& tracker, const Scan& scan) {
  const ScanReport report = tracker.process(scan.time_s, scan.plots);
  EXPECT_EQ(report.status, Status::kOk);
  Outcome outcome{{report.plot_track_id.begin(), report.plot_track_id.end()},
                  {report.events.begin(), report.events.end()},
                  {},
                  {}};
  tracker.for_each([&](const Track& track) {
    outcome.tracks.push_back(track);
    outcome.mode_probability.push_back(tracker.estimator_of(track).mode_probability());
  });
  return outcome;
}

void expect_same(const Outcome& a, const Outcome& b) {
  EXPECT_EQ(a.plot_track_id, b.plot_track_id);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t k = 0; k < a.events.size(); ++k) {
    EXPECT_EQ(a.events[k].kind, b.events[k].kind);
    EXPECT_EQ(a.events[k].track_id, b.events[k].track_id);
    EXPECT_EQ(a.events[k].tentative_id, b.events[k].tentative_id);
    EXPECT_EQ(a.events[k].time_s, b.events[k].time_s);
  }
  ASSERT_EQ(a.tracks.size(), b.tracks.size());
  for (std::size_t k = 0; k < a.tracks.size(); ++k) {
    const Track &x = a.tracks[k], &y = b.tracks[k];
    EXPECT_EQ(x.id, y.id);
    EXPECT_EQ(x.tentative_id, y.tentative_id);
    EXPECT_EQ(x.label(), y.label());
    EXPECT_EQ(x.status, y.status);
    EXPECT_EQ(x.time_s, y.time_s);
    EXPECT_TRUE(matrices_identical(x.kinematics.mean, y.kinematics.mean));
    EXPECT_TRUE(matrices_identical(x.kinematics.covariance, y.kinematics.covariance));
    EXPECT_TRUE(matrices_identical(a.mode_probability[k], b.mode_probability[k]));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(x.existence), std::bit_cast<std::uint64_t>(y.existence));
    EXPECT_TRUE(std::isnan(x.nis) ? std::isnan(y.nis) : x.nis == y.nis);
    EXPECT_EQ(x.scans, y.scans);
    EXPECT_EQ(x.hits, y.hits);
    EXPECT_EQ(x.misses, y.misses);
    EXPECT_EQ(x.history, y.history);
    EXPECT_EQ(x.duplicate_scans, y.duplicate_scans);
  }
}

TEST(Saving, ARestoredTrackerGoesOnBitForBit) {
  const std::vector<Scan> scans = busy_scans(1, 120);
  for (const std::size_t cut : {0u, 1u, 2u, 13u, 60u}) {
    VesselTracker tracker = make_tracker(), restored = make_tracker();
    // What the other tracker has seen before must not matter.
    for (const Scan& scan : busy_scans(2, 40)) (void)process(restored, scan);
    for (std::size_t k = 0; k < cut; ++k) (void)process(tracker, scans[k]);
    (void)tracker.rename(1, "first");
    const std::vector<std::byte> state = tracker.save();
    ASSERT_TRUE(restored.restore(state));
    EXPECT_EQ(restored.save(), state);
    EXPECT_EQ(restored.time_s(), tracker.time_s());
    for (std::size_t k = cut; k < cut + 55; ++k) {
      expect_same(process(restored, scans[k]), process(tracker, scans[k]));
      if (k % 9 == 0) {
        ASSERT_EQ(restored.save(), tracker.save()) << "scan " << k;
      }
    }
    ASSERT_EQ(restored.save(), tracker.save());
  }
}

TEST(Saving, RejectsWhatIsNoStateOfItsOwn) {
  VesselTracker tracker = make_tracker(), victim = make_tracker();
  for (const Scan& scan : busy_scans(1, 30)) (void)process(tracker, scan);
  for (const Scan& scan : busy_scans(2, 20)) (void)process(victim, scan);
  const std::vector<std::byte> state = tracker.save(), before = victim.save();
  const auto expect_rejected = [&](const std::vector<std::byte>& bytes, const char* what) {
    EXPECT_FALSE(victim.restore(bytes)) << what;
    EXPECT_EQ(victim.save(), before) << what;
  };
  expect_rejected({}, "nothing");
  Draw draw(3);
  for (int k = 0; k < 40; ++k) {
    const auto size = static_cast<std::size_t>(draw.uniform(0, static_cast<double>(state.size())));
    expect_rejected({state.begin(), state.begin() + static_cast<std::ptrdiff_t>(size)},
                    "cut short");
    std::vector<std::byte> flipped = state;
    // Half of the spoiled bytes lie before the clutter map, where numbers of tracks are.
    flipped[k % 2 == 0 ? size : size % 4096] ^= std::byte{static_cast<unsigned char>(1 << (k % 8))};
    expect_rejected(flipped, "one bit turned");
  }
  std::vector<std::byte> longer = state;
  longer.push_back(std::byte{0});
  expect_rejected(longer, "a byte too many");
  expect_rejected(std::vector<std::byte>(state.size(), std::byte{0}), "zeros");
  expect_rejected(std::vector<std::byte>(state.size(), std::byte{0xFF}), "ones");

  TrackerConfig config;
  config.coast_scans = 4.0;
  expect_rejected(make_tracker(config).save(), "another configuration");
  Radar radar = kTestRadar;
  radar.max_speed_mps += 1.0;
  expect_rejected(VesselTracker(kTestRadar, {}, vessel_imm(radar)).save(), "other models");
  expect_rejected(make_tracker({}, radar).save(), "another radar");
  for (double VesselModels::*const field :
       {&VesselModels::cruising_psd_m2s3, &VesselModels::turning_sojourn_s,
        &VesselModels::weaving_psd_m2s3, &VesselModels::agile_turn_psd_m2s3,
        &VesselModels::agile_turn_rate_rad_s, &VesselModels::agile_probability,
        &VesselModels::agile_time_s, &VesselModels::weaving_sojourn_s}) {
    VesselModels models;
    models.*field *= 1.5;
    expect_rejected(VesselTracker(kTestRadar, {}, vessel_imm(kTestRadar, models)).save(),
                    "another model");
  }
  EXPECT_TRUE(victim.restore(state));
}

TEST(Saving, TheOtherAssociationsToo) {
  for (const Association association : {Association::kGlobalNearest, Association::kNearest}) {
    TrackerConfig config;
    config.association = association;
    VesselTracker tracker = make_tracker(config), restored = make_tracker(config);
    const std::vector<Scan> scans = busy_scans(4, 60);
    for (std::size_t k = 0; k < 30; ++k) (void)process(tracker, scans[k]);
    ASSERT_TRUE(restored.restore(tracker.save()));
    for (std::size_t k = 30; k < 60; ++k)
      expect_same(process(restored, scans[k]), process(tracker, scans[k]));
  }
}

TEST(Independence, InterleavedTrackersDoAsTheyDoAlone) {
  const std::vector<Scan> a = busy_scans(5, 60), b = busy_scans(6, 60);
  VesselTracker alone_a = make_tracker(), alone_b = make_tracker();
  std::vector<Outcome> outcome_a, outcome_b;
  for (const Scan& scan : a) outcome_a.push_back(process(alone_a, scan));
  for (const Scan& scan : b) outcome_b.push_back(process(alone_b, scan));
  VesselTracker together_a = make_tracker(), together_b = make_tracker();
  for (std::size_t k = 0; k < a.size(); ++k) {
    expect_same(process(together_a, a[k]), outcome_a[k]);
    expect_same(process(together_b, b[k]), outcome_b[k]);
  }
}

TEST(Independence, AMovedTrackerGoesOn) {
  const std::vector<Scan> scans = busy_scans(7, 60);
  VesselTracker stays = make_tracker(), moves = make_tracker();
  for (std::size_t k = 0; k < 60; ++k) {
    if (k == 30) {
      VesselTracker other = std::move(moves);
      moves = std::move(other);
    }
    expect_same(process(moves, scans[k]), process(stays, scans[k]));
  }
}

TEST(TrackerHeap, IsNotTouchedAfterStart) {
  std::vector<Scan> scans = busy_scans(8, 80);
  Sea sea(9);
  for (const std::size_t k : {40u, 41u})  // more than there is room for
    while (scans[k].plots.size() < 3000)
      scans[k].plots.push_back(sea.clutter(scans[k].time_s, 5000.0));
  scans[50].plots[0].range_m = std::nan("");
  for (const Association association :
       {Association::kProbabilistic, Association::kGlobalNearest, Association::kNearest}) {
    TrackerConfig config;
    config.association = association;
    config.max_tracks = 50;
    config.max_plots = 2000;
    VesselTracker restored = make_tracker(config);
    for (VesselTracker tracker = make_tracker(config);
         VesselTracker * each : {&tracker, &restored}) {
      if (each == &restored) {
        ASSERT_TRUE(restored.restore(make_tracker(config).save()));
      }
      int good = 0;
      const NoHeap fence;
      for (const Scan& scan : scans) {
        good += each->process(scan.time_s, scan.plots).status == Status::kOk;
        good -= each->process(-1.0, scan.plots).status == Status::kOk;
        (void)each->rename(each->designate(scan.time_s, 5.0, 5.0, 10.0),
                           "a name longer than any small string buffer");
        (void)each->drop(each->size() % 7);
      }
      EXPECT_EQ(fence.allocations(), 0);
      EXPECT_EQ(good, 80);
    }
  }
}

}  // namespace
}  // namespace wakeline::state_test
