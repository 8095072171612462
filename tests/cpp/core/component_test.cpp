// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/core/component.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "wakeline/core/status.hpp"

namespace wakeline::component_test {
namespace {

constexpr Component kDrag{static_cast<int>(Component::kUser) + 1};
constexpr std::array kState{Component::kVeast, kDrag, Component::kNorth, Component::kEast};

static_assert(index_of(kState, Component::kNorth) == 2);
static_assert(index_of(kState, kDrag) == 1);
static_assert(index_of(kState, Component::kTurnRate) == -1);
static_assert(holds(kState, std::array{Component::kNorth, Component::kVeast}));
static_assert(!holds(kState, kKinematics));

TEST(Component, RowsOfWhatIsWanted) {
  constexpr auto kRows = rows_of(kState, kKinematics);
  EXPECT_EQ(kRows[0], 2);
  EXPECT_EQ(kRows[1], -1);
  EXPECT_EQ(kRows[2], 3);
  EXPECT_EQ(kRows[3], 0);
}

TEST(StatusText, EveryStatusHasItsOwnWords) {
  std::set<std::string> texts;
  for (int k = 0; k <= 7; ++k) texts.insert(to_string(static_cast<Status>(k)));
  EXPECT_EQ(texts.size(), 8u) << "seven statuses and \"unknown\"";
  EXPECT_TRUE(texts.contains("unknown"));
}

TEST(StepResult, IsTrueOnlyWhenItSucceeded) {
  Step<2> step;
  EXPECT_FALSE(step) << "a step that was never made";
  step.status = Status::kOk;
  EXPECT_TRUE(step);
  step = failed_step<2, double>(Status::kMissed);
  EXPECT_FALSE(step);
  EXPECT_EQ(step.status, Status::kMissed);
}

}  // namespace
}  // namespace wakeline::component_test
