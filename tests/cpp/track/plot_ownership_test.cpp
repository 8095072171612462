// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/plot_ownership.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "track/stages.hpp"

namespace wakeline::plot_ownership_test {
namespace {

using namespace test;

Track track_in(int slot, double existence) {
  Track track = track_at(slot, Vec<double, 4>::Zero(), Vec<double, 4>::Ones());
  track.existence = existence;
  return track;
}

AssociationProbabilities probabilities_of(std::initializer_list<double> of_candidate) {
  AssociationProbabilities probabilities;
  for (const double probability : of_candidate) {
    const auto k = static_cast<std::size_t>(probabilities.best + 1);
    probabilities.of_candidate[k] = probability;
    ++probabilities.best;
  }
  const auto& all = probabilities.of_candidate;
  probabilities.best = int(std::max_element(all.begin(), all.end()) - all.begin());
  return probabilities;
}

TEST(PlotOwnership, APlotOutsideEveryGateHasNoOwner) {
  PlotOwnership ownership(TrackerConfig{});
  ownership.clear(3);
  ownership.add(track_in(0, 0.9), candidates_of({candidate(1, 1e-3, 1e-6)}), {},
                probabilities_of({0.95}));
  for (const int plot : {0, 2}) {
    EXPECT_EQ(ownership.owner(plot).slot, -1);
    EXPECT_EQ(ownership.free_probability()[std::size_t(plot)], 1.0);
    EXPECT_EQ(ownership.clutter_probability()[std::size_t(plot)], 1.0);
  }
  EXPECT_EQ(ownership.owner(1).slot, 0);
  EXPECT_EQ(ownership.plot_of(0), 1);
  EXPECT_DOUBLE_EQ(ownership.free_probability()[1], 1.0 - 0.95 * 0.9);
  EXPECT_DOUBLE_EQ(ownership.clutter_probability()[1], 1.0 - 0.95);
}

TEST(PlotOwnership, TheMoreProbableTrackOwnsAPlotIfMoreProbablyThanNot) {
  PlotOwnership ownership(TrackerConfig{});
  const CandidatePlots shared = candidates_of({candidate(0, 1e-3, 1e-6)});
  ownership.clear(1);
  ownership.add(track_in(0, 0.9), shared, {}, probabilities_of({0.4}));
  EXPECT_EQ(ownership.owner(0).slot, -1);
  ownership.add(track_in(1, 0.9), shared, {}, probabilities_of({0.8}));
  ownership.add(track_in(2, 0.9), shared, {}, probabilities_of({0.7}));
  EXPECT_EQ(ownership.owner(0).slot, 1);
  EXPECT_DOUBLE_EQ(ownership.clutter_probability()[0], 0.6 * (1.0 - 0.8) * (1.0 - 0.7));
}

// Two plots that one track owns by halves are of two vessels; one of a track that has hardly been
// seen is its own.
TEST(PlotOwnership, APlotThatIsHalfATracksMayStartOneIfTheTrackHasSeenItsTargetAllTheSame) {
  constexpr double kFree = 0.75;
  const auto ownership_of = [](const AssociationProbabilities& probabilities) {
    PlotOwnership ownership(TrackerConfig{});
    ownership.clear(2);
    AssociationProbabilities of = probabilities;
    of.any = std::accumulate(of.of_candidate.begin(), of.of_candidate.end(), 0.0);
    ownership.add(track_in(0, 1.0),
                  candidates_of({candidate(0, 1e-3, 1e-6), candidate(1, 1e-3, 1e-6)}), {}, of);
    return ownership;
  };
  EXPECT_FALSE(ownership_of(probabilities_of({0.6, 0.4})).may_start(0, kFree)) << "mostly owned";
  EXPECT_TRUE(ownership_of(probabilities_of({0.6, 0.4})).may_start(1, kFree));
  EXPECT_FALSE(ownership_of(probabilities_of({0.0, 0.4})).may_start(1, kFree)) << "missed by 0.6";
  EXPECT_TRUE(ownership_of(probabilities_of({0.0, 0.2})).may_start(1, kFree)) << "free with 0.8";
  EXPECT_TRUE(ownership_of(probabilities_of({0.0, 0.0})).may_start(1, kFree));
}

TEST(PlotOwnership, APlotThatWasAssignedIsNotFreeHoweverDoubtfulTheTrack) {
  PlotOwnership ownership(TrackerConfig{});
  AssociationWeights weights{.none = 0.0, .assigned = true};
  weights.plot[0] = 1.0;
  ownership.clear(1);
  ownership.add(track_in(0, 0.01), candidates_of({candidate(0, 1e-3, 1e-6)}), weights,
                probabilities_of({1.0}));
  EXPECT_EQ(ownership.free_probability()[0], 0.0);
}

TEST(PlotOwnership, ATrackWithoutPlotsOwnsNone) {
  PlotOwnership ownership(TrackerConfig{});
  ownership.clear(1);
  const CandidatePlots one = candidates_of({candidate(0, 1e-3, 1e-6)});
  ownership.add(track_in(4, 0.9), one, {}, probabilities_of({0.9}));
  EXPECT_EQ(ownership.plot_of(4), 0);
  ownership.clear(1);
  ownership.add(track_in(4, 0.9), {}, {}, AssociationProbabilities{});
  EXPECT_EQ(ownership.plot_of(4), -1);
}

}  // namespace
}  // namespace wakeline::plot_ownership_test
