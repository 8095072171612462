// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/association.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/draw.hpp"
#include "track/stages.hpp"

namespace wakeline::association_test {
namespace {

using namespace test;

const Detection kDetection(TrackerConfig{}, 1.0);

/// A track in that slot which exists with that probability.
Track track_in(int slot, double existence = 0.9) {
  Track track = track_at(slot, Vec<double, 4>::Zero(), Vec<double, 4>::Ones());
  track.existence = existence;
  return track;
}

TEST(LinearMultitarget, OneTrackAloneHasTheWeightsOfPda) {
  LinearMultitarget multitarget(TrackerConfig{});
  const CandidatePlots candidates =
      candidates_of({candidate(0, 3e-3, 1e-6), candidate(2, 1e-3, 2e-6)});
  const Track track = track_in(5);
  multitarget.clear(3);
  multitarget.claim(track, kDetection, candidates);
  const AssociationWeights weights = multitarget.weights(track, kDetection, candidates);
  EXPECT_EQ(weights.none, kDetection.missed);
  EXPECT_FALSE(weights.assigned);
  EXPECT_DOUBLE_EQ(weights.plot[0], kDetection.detected / 1e-6);
  EXPECT_DOUBLE_EQ(weights.plot[1], kDetection.detected / 2e-6);
}

TEST(LinearMultitarget, WhatAnotherTrackClaimsIsDenserClutter) {
  LinearMultitarget multitarget(TrackerConfig{});
  const CandidatePlots shared = candidates_of({candidate(0, 3e-3, 1e-6)});
  double before = 0.0;
  for (const double existence : {0.99, 0.5, 0.1, 0.0}) {
    const Track track = track_in(0), other = track_in(1, existence);
    multitarget.clear(1);
    multitarget.claim(track, kDetection, shared);
    multitarget.claim(other, kDetection, shared);
    const double weight = multitarget.weights(track, kDetection, shared).plot[0];
    EXPECT_GT(weight, before) << "the less probable the other, the less it claims";
    before = weight;
  }
  EXPECT_DOUBLE_EQ(before, kDetection.detected / 1e-6) << "a track that is not there claims none";
}

TEST(LinearMultitarget, TheOrderOfTracksDoesNotMatter) {
  LinearMultitarget forwards(TrackerConfig{}), backwards(TrackerConfig{});
  const CandidatePlots both = candidates_of({candidate(0, 3e-3, 1e-6), candidate(1, 2e-3, 1e-6)});
  forwards.clear(2);
  backwards.clear(2);
  for (const int slot : {0, 1, 2}) {
    forwards.claim(track_in(slot, 0.3 + 0.2 * slot), kDetection, both);
    backwards.claim(track_in(2 - slot, 0.3 + 0.2 * (2 - slot)), kDetection, both);
  }
  for (const int slot : {0, 1, 2})
    for (const std::size_t k : {0u, 1u}) {
      const Track track = track_in(slot);
      EXPECT_NEAR(forwards.weights(track, kDetection, both).plot[k] /
                      backwards.weights(track, kDetection, both).plot[k],
                  1.0, 1e-9);
    }
}

/// What an assignment of plots to tracks costs: its negative log-likelihood ratio.
double cost_of(const std::vector<CandidatePlots>& candidates, const std::vector<int>& plot_of) {
  double cost = 0.0;
  for (std::size_t track = 0; track < candidates.size(); ++track)
    for (const CandidatePlot& plot : candidates[track])
      if (plot.plot == plot_of[track])
        cost -= std::log(likelihood_ratio(kDetection, plot) / kDetection.missed);
  return cost;
}

/// The least cost over all assignments, by trying every one.
double least_cost(const std::vector<CandidatePlots>& candidates, std::vector<int>& plot_of,
                  std::size_t track) {
  if (track == candidates.size()) return cost_of(candidates, plot_of);
  plot_of[track] = PlotAssignment::kNone;
  double least = least_cost(candidates, plot_of, track + 1);
  for (const CandidatePlot& plot : candidates[track]) {
    if (std::find(plot_of.begin(), plot_of.begin() + std::ptrdiff_t(track), plot.plot) !=
        plot_of.begin() + std::ptrdiff_t(track))
      continue;
    plot_of[track] = plot.plot;
    least = std::min(least, least_cost(candidates, plot_of, track + 1));
  }
  plot_of[track] = PlotAssignment::kNone;
  return least;
}

TEST(PlotAssignment, GlobalNearestIsTheBestOfAllAssignmentsAndNearestIsNotBetter) {
  Draw draw(7);
  for (int trial = 0; trial < 200; ++trial) {
    constexpr int kTracks = 4, kPlots = 5;
    TrackList tracks(kTracks);
    std::vector<CandidatePlots> candidates(kTracks);
    for (CandidatePlots& of_track : candidates) {
      tracks.open().status = TrackStatus::kConfirmed;
      for (int plot = 0; plot < kPlots; ++plot)
        if (draw.uniform(0.0, 1.0) < 0.6)
          of_track.add(candidate(plot, std::exp(draw.uniform(-16.0, -5.0)), 1e-5));
    }
    std::vector<int> none(kTracks, PlotAssignment::kNone);
    const double least = least_cost(candidates, none, 0);
    for (const Association association : {Association::kGlobalNearest, Association::kNearest}) {
      const TrackerConfig config{.association = association, .max_tracks = kTracks};
      PlotAssignment assignment(config);
      assignment.assign(config, tracks, tracks.slots(), candidates, kPlots);
      std::vector<int> plot_of, used;
      for (int slot = 0; slot < kTracks; ++slot) {
        const int plot = assignment.plot_of(slot);
        plot_of.push_back(plot);
        if (plot == PlotAssignment::kNone) continue;
        EXPECT_EQ(std::count(used.begin(), used.end(), plot), 0) << "one track to each plot";
        used.push_back(plot);
      }
      if (association == Association::kGlobalNearest) {
        EXPECT_NEAR(cost_of(candidates, plot_of), least, 1e-9);
      } else {
        EXPECT_GE(cost_of(candidates, plot_of), least - 1e-9);
      }
    }
  }
}

TEST(PlotAssignment, ConfirmedTracksChooseFirst) {
  const TrackerConfig config{.association = Association::kGlobalNearest, .max_tracks = 2};
  TrackList tracks(2);
  const int tentative = tracks.open().slot;
  Track& confirmed = tracks.open();
  confirmed.status = TrackStatus::kConfirmed;
  std::vector<CandidatePlots> candidates(2);
  candidates[std::size_t(tentative)].add(candidate(0, 1e-2, 1e-6));
  candidates[std::size_t(confirmed.slot)].add(candidate(0, 1e-3, 1e-6));
  PlotAssignment assignment(config);
  assignment.assign(config, tracks, tracks.slots(), candidates, 1);
  EXPECT_EQ(assignment.plot_of(confirmed.slot), 0);
  EXPECT_EQ(assignment.plot_of(tentative), PlotAssignment::kNone);

  const AssociationWeights has = assignment.weights(confirmed, kDetection, candidates[1]);
  EXPECT_TRUE(has.assigned);
  EXPECT_EQ(has.none, 0.0);
  EXPECT_GT(has.plot[0], 0.0);
  const AssociationWeights has_none =
      assignment.weights(tracks.at(tentative), kDetection, candidates[0]);
  EXPECT_FALSE(has_none.assigned);
  EXPECT_EQ(has_none.none, kDetection.missed);
  EXPECT_EQ(has_none.plot[0], 0.0);
}

}  // namespace
}  // namespace wakeline::association_test
