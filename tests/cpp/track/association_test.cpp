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

const DetectionProbability kProbability{TrackerConfig{}};
const Detection kDetection = kProbability.of(1.0);

/// A track in that slot which exists with that probability.
Track track_in(int slot, double existence = 0.9) {
  Track track = track_at(slot, Vec<double, 4>::Zero(), Vec<double, 4>::Ones());
  track.existence = existence;
  return track;
}

/// The weights of tracks, which are all that there are, with slots from 0 on.
std::vector<AssociationWeights> weights_of(const std::vector<Track>& tracks,
                                           const std::vector<CandidatePlots>& candidates,
                                           int plots) {
  BeliefPropagation propagation(TrackerConfig{});
  propagation.clear(plots);
  std::vector<int> slots;
  for (const Track& track : tracks) {
    propagation.claim(track, kDetection, candidates[std::size_t(track.slot)]);
    slots.push_back(track.slot);
  }
  propagation.propagate(slots);
  std::vector<AssociationWeights> weights;
  for (const Track& track : tracks)
    weights.push_back(propagation.weights(track, kDetection, candidates[std::size_t(track.slot)]));
  return weights;
}

/// The probability that a candidate is the target's, and so that the target exists.
double owned(const AssociationWeights& weights, const Track& track,
             const CandidatePlots& candidates, std::size_t k) {
  double sum = 1.0 - track.existence + track.existence * weights.none;
  for (std::size_t j = 0; j < candidates.size(); ++j)
    sum += track.existence * weights.plot[j] * candidates[j].likelihood;
  return track.existence * weights.plot[k] * candidates[k].likelihood / sum;
}

/// The same by enumeration of all joint events, of which each plot is in one claim at most.
std::vector<std::vector<double>> exactly_owned(const std::vector<Track>& tracks,
                                               const std::vector<CandidatePlots>& candidates) {
  std::vector<std::vector<double>> owned(tracks.size(),
                                         std::vector<double>(CandidatePlots::kMost, 0.0));
  std::vector<int> chosen(tracks.size(), -1);
  double total = 0.0;
  const auto enumerate = [&](const auto& self, std::size_t track, double weight) -> void {
    if (track == tracks.size()) {
      total += weight;
      for (std::size_t t = 0; t < tracks.size(); ++t)
        if (chosen[t] >= 0) owned[t][std::size_t(chosen[t])] += weight;
      return;
    }
    const double e = tracks[track].existence;
    chosen[track] = -1;
    self(self, track + 1, weight * (1.0 - e + e * kDetection.missed));
    for (std::size_t k = 0; k < candidates[track].size(); ++k) {
      const CandidatePlot& plot = candidates[track][k];
      bool taken = false;
      for (std::size_t t = 0; t < track; ++t)
        taken =
            taken || (chosen[t] >= 0 && candidates[t][std::size_t(chosen[t])].plot == plot.plot);
      if (taken) continue;
      chosen[track] = int(k);
      self(self, track + 1, weight * e * likelihood_ratio(kDetection, plot));
    }
    chosen[track] = -1;
  };
  enumerate(enumerate, 0, 1.0);
  for (std::vector<double>& of_track : owned)
    for (double& probability : of_track) probability /= total;
  return owned;
}

TEST(BeliefPropagation, OneTrackAloneHasTheWeightsOfPda) {
  const CandidatePlots candidates =
      candidates_of({candidate(0, 3e-3, 1e-6), candidate(2, 1e-3, 2e-6)});
  const AssociationWeights weights = weights_of({track_in(0)}, {candidates}, 3)[0];
  EXPECT_EQ(weights.none, kDetection.missed);
  EXPECT_FALSE(weights.assigned);
  EXPECT_DOUBLE_EQ(weights.plot[0], kDetection.detected / 1e-6);
  EXPECT_DOUBLE_EQ(weights.plot[1], kDetection.detected / 2e-6);
}

TEST(BeliefPropagation, OnePlotIsSharedExactly) {
  const CandidatePlots shared = candidates_of({candidate(0, 3e-3, 1e-6)});
  for (const double existence : {0.99, 0.5, 0.1, 0.0}) {
    const std::vector<Track> tracks{track_in(0), track_in(1, existence), track_in(2, 0.3)};
    const std::vector<CandidatePlots> candidates{shared, shared, shared};
    const auto weights = weights_of(tracks, candidates, 1);
    const auto exact = exactly_owned(tracks, candidates);
    for (const std::size_t t : {0u, 1u, 2u})
      EXPECT_NEAR(owned(weights[t], tracks[t], shared, 0), exact[t][0], 1e-3) << existence;
  }
}

TEST(BeliefPropagation, IsCloseToTheJointProbabilitiesOfAllEvents) {
  Draw draw(11);
  double squared = 0.0;
  int count = 0;
  for (int trial = 0; trial < 300; ++trial) {
    constexpr int kTracks = 4, kPlots = 4;
    std::vector<Track> tracks;
    std::vector<CandidatePlots> candidates(kTracks);
    for (int slot = 0; slot < kTracks; ++slot) {
      tracks.push_back(track_in(slot, draw.uniform(0.01, 0.99)));
      for (int plot = 0; plot < kPlots; ++plot)
        if (draw.uniform(0.0, 1.0) < 0.7)
          candidates[std::size_t(slot)].add(
              candidate(plot, std::exp(draw.uniform(-14.0, -6.0)), 1e-5));
    }
    const auto weights = weights_of(tracks, candidates, kPlots);
    const auto exact = exactly_owned(tracks, candidates);
    for (std::size_t t = 0; t < kTracks; ++t)
      for (std::size_t k = 0; k < candidates[t].size(); ++k, ++count)
        squared += std::pow(owned(weights[t], tracks[t], candidates[t], k) - exact[t][k], 2);
  }
  EXPECT_LT(std::sqrt(squared / count), 0.06);
}

TEST(BeliefPropagation, TwoTentativeTracksShareTwoPlotsAndNeitherLosesExistence) {
  // Each is a little nearer to its own plot.
  const std::vector<Track> tracks{track_in(0, 0.08), track_in(1, 0.08)};
  const std::vector<CandidatePlots> candidates{
      candidates_of({candidate(0, 1.1e-3, 1e-7), candidate(1, 1e-3, 1e-7)}),
      candidates_of({candidate(0, 1e-3, 1e-7), candidate(1, 1.1e-3, 1e-7)})};
  const auto weights = weights_of(tracks, candidates, 2);
  for (const std::size_t t : {0u, 1u})
    EXPECT_GT(owned(weights[t], tracks[t], candidates[t], 0) +
                  owned(weights[t], tracks[t], candidates[t], 1),
              0.9);
}

TEST(BeliefPropagation, TheOrderOfTracksDoesNotMatter) {
  const CandidatePlots both = candidates_of({candidate(0, 3e-3, 1e-6), candidate(1, 2e-3, 1e-6)});
  const std::vector<CandidatePlots> candidates{both, both, both};
  const std::vector<Track> tracks{track_in(0, 0.3), track_in(1, 0.5), track_in(2, 0.7)};
  const auto forwards = weights_of(tracks, candidates, 2);
  const auto backwards = weights_of({tracks[2], tracks[1], tracks[0]}, candidates, 2);
  for (const std::size_t t : {0u, 1u, 2u})
    for (const std::size_t k : {0u, 1u})
      EXPECT_NEAR(forwards[t].plot[k] / backwards[2 - t].plot[k], 1.0, 1e-9);
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
    const std::vector<Look> looks(kTracks);
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
      assignment.assign(kProbability, looks, tracks, tracks.slots(), candidates, kPlots);
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
  const std::vector<Look> looks(2);
  std::vector<CandidatePlots> candidates(2);
  candidates[std::size_t(tentative)].add(candidate(0, 1e-2, 1e-6));
  candidates[std::size_t(confirmed.slot)].add(candidate(0, 1e-3, 1e-6));
  PlotAssignment assignment(config);
  assignment.assign(kProbability, looks, tracks, tracks.slots(), candidates, 1);
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
