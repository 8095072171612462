// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Inputs that come late.
#include "wakeline/track/late_window.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <tuple>

#include "support/malloc_fence.hpp"
#include "track/scene.hpp"

namespace wakeline::late_window_test {
namespace {

using namespace test;

using VesselWindow = LateWindow<VesselTracker>;

const double kPeriod_s = kTestRadar.period_s;

struct Input {
  double time_s;
  TrackerInput what;
  std::vector<Plot> plots = {};
};

/// The radar at the origin, and a coarser one elsewhere that turns slower.
std::vector<Radar> radars(int count) {
  std::vector<Radar> list{kTestRadar, kTestRadar};
  list[1].range_std_m = 20.0;
  list[1].bearing_std_rad = deg(1.0);
  list[1].period_s = 3.0;
  list[1].time_offset_s = 0.25;
  list.resize(static_cast<std::size_t>(count));
  return list;
}
const OwnShip kElsewhere{.north_m = 2000.0, .east_m = -1000.0};

VesselWindow make_window(const LateWindowConfig& window = {}, const TrackerConfig& config = {},
                         int count = 1) {
  return VesselWindow(window, std::span<const Radar>(radars(count)), config,
                      vessel_imm(kTestRadar));
}

/// Of one time by kind and radar.
bool is_before(const Input& a, const Input& b) {
  const auto radar_of = [](const Input& input) {
    const auto* sector = std::get_if<SectorInput>(&input.what);
    return sector == nullptr ? 0 : sector->radar;
  };
  return std::tuple(a.time_s, a.what.index(), radar_of(a)) <
         std::tuple(b.time_s, b.what.index(), radar_of(b));
}

/// What an operator does at a time.
TrackerInput any_action(Draw& draw, double time_s) {
  const double kind = draw.uniform(0, 1);
  if (kind < 0.5) {
    Designation action;
    action.time_s = time_s;
    action.north_m = draw.uniform(-3000, 3000);
    action.east_m = draw.uniform(-3000, 3000);
    action.position_std_m = 50.0;
    if (kind < 0.2) action.velocity = {{3.0, -4.0}, 4.0 * Mat<double, 2, 2>::Identity()};
    return action;
  }
  if (kind < 0.7) {
    Removal action;
    action.id = int(draw.uniform(1, 15));
    action.hush = kind < 0.6;
    return action;
  }
  if (kind < 0.75) {
    Merger action;
    action.id = int(draw.uniform(1, 15));
    action.other_id = int(draw.uniform(1, 15));
    return action;
  }
  if (kind < 0.8) {
    RadarChange action;
    action.radar = kTestRadar;
    action.radar.range_std_m = draw.uniform(6, 12);
    return action;
  }
  Naming action;
  action.id = int(draw.uniform(1, 15));
  action.name = {'M', 'a', 'r', 'y'};
  action.length = 4;
  return action;
}

/// Boats among clutter, seen in sectors by one radar or two for so long, and an operator.
std::vector<Input> scene(std::uint64_t seed, int sectors, double last_s, int count = 1) {
  Draw draw(seed);
  std::vector<Boat> boats;
  for (int k = 0; k < 12; ++k)
    boats.push_back(
        {{draw.uniform(-3000, 3000), draw.uniform(-3000, 3000)}, 5.0 * draw.normals<2>()});
  std::vector<Input> inputs;
  for (int number = 0; number < count; ++number) {
    const Radar radar = radars(count)[static_cast<std::size_t>(number)];
    const OwnShip own = number == 0 ? OwnShip{} : kElsewhere;
    Sea sea(seed + 100, radar);
    for (int turn = 0; turn * radar.period_s < last_s; ++turn) {
      const double turn_s = turn * radar.period_s;
      std::vector<Plot> plots;
      for (const Boat& boat : boats)
        if (draw.uniform(0, 1) < 0.85)
          plots.push_back(
              sea.swept({boat.start_m - own.position<double>(), boat.velocity_mps}, turn_s));
      for (int k = 0; k < 10; ++k) {
        plots.push_back(sea.clutter(0.0, 3500.0));
        plots.back().time_s =
            turn_s + compass_angle(plots.back().bearing_rad) / Beam::kTurn * radar.period_s;
      }
      for (int k = 0; k < sectors; ++k) {
        const double time_s = turn_s + (k + 1.0) / sectors * radar.period_s;
        SectorInput sector{number, Beam::kTurn * k / sectors, Beam::kTurn * (k + 1) / sectors,
                           time_s + radar.time_offset_s};
        if (number > 0 || k % 3 == 0) sector.own = own;
        Input input{time_s, sector};
        for (Plot plot : plots) {
          const double angle_rad = compass_angle(plot.bearing_rad);
          if (!(angle_rad >= sector.from_rad && angle_rad < sector.to_rad)) continue;
          plot.time_s += radar.time_offset_s;
          plot.own = own;
          input.plots.push_back(plot);
        }
        inputs.push_back(input);
        const double after_s = time_s + 0.3 * radar.period_s / sectors;
        if (draw.uniform(0, 1) < 3.0 / sectors)
          inputs.push_back({after_s, any_action(draw, after_s)});
      }
    }
  }
  for (double time_s = 2.0; time_s < last_s; time_s += 0.7) {
    const auto number = static_cast<std::size_t>(draw.uniform(0, 5));
    const Boat& boat = boats[number];
    const std::string identity(1, char('a' + number));
    const Vec<double, 2> position = boat.at(time_s) + 5.0 * draw.normals<2>();
    inputs.push_back({time_s, ReportInput({.source = "ais",
                                           .identity = identity,
                                           .time_s = time_s,
                                           .position_m = position,
                                           .position_std_m = 5.0,
                                           .velocity_mps = boat.velocity_mps,
                                           .velocity_std_mps = 0.3})});
    Input bearings{time_s + 0.1, PartialInput{.time_s = time_s + 0.1, .std = deg(0.5)}};
    for (const Boat& each : boats) {
      const Vec<double, 2> d = each.at(time_s + 0.1);
      bearings.plots.push_back({.range_m = std::atan2(d[1], d[0]) + deg(0.5) * draw.normal()});
    }
    inputs.push_back(bearings);
  }
  std::stable_sort(inputs.begin(), inputs.end(), is_before);
  return inputs;
}

std::vector<Input> sectors_of(std::vector<Input> inputs) {
  std::erase_if(inputs, [](const Input& input) { return input.what.index() != 0; });
  return inputs;
}

/// The inputs as they come when each is late by up to so much.
std::vector<Input> shuffled(const std::vector<Input>& inputs, double latest_s, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> delay_s(0.0, latest_s);
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < inputs.size(); ++k)
    order.emplace_back(inputs[k].time_s + delay_s(random), k);
  std::sort(order.begin(), order.end());
  std::vector<Input> result;
  for (const auto& [time_s, k] : order) result.push_back(inputs[k]);
  return result;
}

ScanReport give(VesselWindow& window, const Input& input) {
  ScanReport report;
  std::visit(
      [&]<class What>(const What& what) {
        if constexpr (std::is_same_v<What, SectorInput>)
          report = what.give_to(window, input.plots);
        else if constexpr (std::is_same_v<What, Removal>)
          (void)window.drop(what.id, what.hush, input.time_s);
        else if constexpr (std::is_same_v<What, Merger>)
          (void)window.merge(what.id, what.other_id, input.time_s);
        else if constexpr (std::is_same_v<What, RadarChange>)
          window.set_radar(what.number, what.radar, input.time_s);
        else if constexpr (std::is_same_v<What, Naming>)
          (void)window.rename(what.id, {what.name.data(), what.length}, input.time_s);
        else
          (void)what.give_to(window, input.plots);
      },
      input.what);
  return report;
}

/// A tracker that has had the inputs in order.
VesselTracker in_order(std::vector<Input> inputs, const TrackerConfig& config = {}, int count = 1) {
  std::stable_sort(inputs.begin(), inputs.end(), is_before);
  VesselTracker tracker(std::span<const Radar>(radars(count)), config, vessel_imm(kTestRadar));
  for (const Input& input : inputs)
    std::visit([&](const auto& what) { (void)what.give_to(tracker, input.plots); }, input.what);
  return tracker;
}

TEST(LateWindow, ShuffledInputsGiveTheTracksOfThoseInOrderBitForBit) {
  for (const int count : {1, 2})
    for (const int sectors : {1, 16})
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        SCOPED_TRACE(std::to_string(count) + " radars, " + std::to_string(sectors) +
                     " sectors, seed " + std::to_string(seed));
        const std::vector<Input> come = shuffled(
            scene(seed, sectors, sectors == 1 ? 150.0 : 60.0, count), 2.0 * kPeriod_s, seed);
        VesselWindow window = make_window({}, {}, count);
        for (std::size_t k = 0; k < come.size(); ++k) {
          (void)give(window, come[k]);
          if (k % (come.size() / 8) != 0 && k + 1 != come.size()) continue;
          (void)window.correct();
          ASSERT_TRUE(
              window.tracker().save() ==
              in_order({come.begin(), come.begin() + std::ptrdiff_t(k) + 1}, {}, count).save())
              << k;
        }
        EXPECT_EQ(window.counts().too_late, 0);
        EXPECT_GT(window.counts().late, std::ssize(come) / 12);
        EXPECT_GT(window.tracker().size(), 8);
      }
}

TEST(LateWindow, NeedsNoMoreRoomTheLongerInputsComeAtRandom) {
  constexpr int kRoom = 200;  // for three windows of this scene
  const std::vector<Input> come = shuffled(scene(3, 16, 120.0), kPeriod_s, 3);
  VesselWindow window = make_window({.max_inputs = kRoom});
  for (const Input& input : come) (void)give(window, input);
  (void)window.correct();
  EXPECT_GT(std::ssize(come), 5 * kRoom);
  EXPECT_EQ(window.counts().too_late, 0);
  EXPECT_TRUE(window.tracker().save() == in_order(come).save());
}

TEST(LateWindow, InputsInTimeAreThoseOfATracker) {
  const std::vector<Input> inputs = scene(4, 8, 75.0);
  VesselWindow window = make_window();
  VesselTracker tracker = make_tracker();
  for (const Input& input : inputs) {
    const ScanReport report = give(window, input);
    if (const auto* sector = std::get_if<SectorInput>(&input.what)) {
      const ScanReport wanted = sector->give_to(tracker, input.plots);
      EXPECT_TRUE(std::ranges::equal(report.plot_track_id, wanted.plot_track_id));
      EXPECT_EQ(report.events.size(), wanted.events.size());
      EXPECT_EQ(report.rejected_plots, wanted.rejected_plots);
    } else {
      std::visit([&](const auto& what) { (void)what.give_to(tracker, input.plots); }, input.what);
    }
    ASSERT_TRUE(window.is_correct());
    ASSERT_TRUE(window.tracker().save() == tracker.save());
  }
  EXPECT_EQ(window.counts().corrections, 0);
}

TEST(LateWindow, TheOrderOfInputsOfOneTimeIsThatOfWhatTheyAre) {
  std::vector<Input> inputs;
  for (int turn = 0; turn < 12; ++turn)
    for (int k = 0; k < 4; ++k) {
      const double from_rad = Beam::kTurn * k / 4;
      Input input{turn * kPeriod_s,
                  SectorInput{0, from_rad, from_rad + Beam::kTurn / 4, turn * kPeriod_s}};
      input.plots = {
          exact_plot({1000.0 * std::cos(from_rad + 0.5) + turn, 1000.0 * std::sin(from_rad + 0.5)},
                     turn * kPeriod_s)};
      inputs.push_back(input);
      input.plots[0].range_m += 500.0;  // the same sector once more
      inputs.push_back(input);
    }
  std::vector<std::byte> wanted;
  std::mt19937_64 random(1);
  for (int round = 0; round < 8; ++round) {
    VesselWindow window = make_window();
    for (std::size_t turn = 0; turn < inputs.size(); turn += 8) {
      const auto first = inputs.begin() + std::ptrdiff_t(turn);
      if (round > 0) std::shuffle(first, first + 8, random);
      for (auto input = first; input != first + 8; ++input) (void)give(window, *input);
    }
    (void)window.correct();
    if (round == 0) wanted = window.tracker().save();
    EXPECT_TRUE(window.tracker().save() == wanted) << round;
  }
  EXPECT_GT(in_order(inputs).size(), 3);
}

TEST(LateWindow, WhatIsTooLateIsCountedAndChangesNothing) {
  VesselWindow window = make_window({.window_s = 3.0});
  for (int turn = 1; turn < 20; ++turn) (void)window.process(kPeriod_s * turn, {});
  const double newest_s = kPeriod_s * 19;
  EXPECT_EQ(window.earliest_time_s(), newest_s - 3.0);
  const auto before = window.tracker().save();
  const Plot plot = exact_plot({1000.0, 0.0}, newest_s - 3.1);
  const ScanReport report = window.process(newest_s - 3.1, {&plot, 1});
  EXPECT_EQ(report.status, Status::kNegativeTimeStep);
  EXPECT_EQ(report.rejected_plots, 1);
  EXPECT_EQ(window.counts().too_late, 1);
  EXPECT_EQ(window.counts().late, 0);
  (void)window.correct();
  EXPECT_TRUE(window.tracker().save() == before);
  EXPECT_EQ(window.process(newest_s - 3.0, {&plot, 1}).status, Status::kOk) << "at the edge";
  EXPECT_EQ(window.counts().late, 1);

  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(window.process(kNan, {}).status, Status::kNotFinite);
  EXPECT_EQ(window.sector({.radar = 7, .to_rad = 1.0, .time_s = newest_s}).status,
            Status::kNotFinite);
  EXPECT_EQ(window.sector({.from_rad = kNan, .to_rad = 1.0, .time_s = newest_s - 1.0}).status,
            Status::kNotFinite);
  EXPECT_EQ(window.designate(kNan, 0.0, 0.0, 10.0), 0);
  EXPECT_EQ(window.counts().late, 1);
}

TEST(LateWindow, AnActionIsNeverTooLateAndNeverAhead) {
  VesselWindow window = make_window();
  for (int turn = 1; turn < 20; ++turn) (void)window.process(kPeriod_s * turn, {});
  EXPECT_EQ(window.designate(window.earliest_time_s() - 5.0, 500.0, 0.0, 20.0), 1);
  EXPECT_EQ(window.designate(20 * kPeriod_s + 1000.0, 0.0, 500.0, 20.0), 2);
  for (int turn = 20; turn < 22; ++turn) (void)window.process(kPeriod_s * turn, {});
  EXPECT_TRUE(window.is_correct());
  EXPECT_NE(window.tracker().find(2), nullptr);
  EXPECT_TRUE(window.drop(2));
  EXPECT_TRUE(window.rename(1, "Mary"));
  EXPECT_FALSE(window.rename(1, "\xff"));
  (void)window.correct();
  EXPECT_EQ(window.tracker().find(2), nullptr);
  EXPECT_EQ(window.tracker().find(1)->label(), "Mary");

  VesselWindow early = make_window();
  EXPECT_EQ(early.designate(1.7e9, 500.0, 500.0, 20.0), 1) << "no clock yet";
  for (int turn = 1; turn < 30; ++turn) (void)early.process(kPeriod_s * turn, {});
  EXPECT_EQ(early.tracker().size(), 0) << "it was of another clock";
  EXPECT_EQ(early.counts().too_late, 0);
}

TEST(LateWindow, WithLittleRoomIsShorterAndStillExact) {
  for (const LateWindowConfig& config :
       {LateWindowConfig{.max_inputs = 16}, LateWindowConfig{.max_plots = 1}}) {
    const TrackerConfig small{.max_plots = 20};
    const std::vector<Input> come = shuffled(sectors_of(scene(5, 16, 40.0)), 2.0 * kPeriod_s, 5);
    VesselWindow window = make_window(config, small);
    std::vector<Input> taken;
    for (const Input& input : come) {
      const std::int64_t before = window.counts().too_late;
      (void)give(window, input);
      if (window.counts().too_late == before) taken.push_back(input);
    }
    (void)window.correct();
    EXPECT_TRUE(window.tracker().save() == in_order(taken, small).save());
    EXPECT_GT(window.counts().too_late, 0);
    EXPECT_GT(taken.size(), come.size() / 4);
  }
}

TEST(LateWindow, EventsSayWhichNumbersThereAre) {
  const std::vector<Input> inputs = sectors_of(scene(6, 16, 60.0));
  VesselWindow window = make_window();
  std::set<std::int64_t> numbers;
  const auto note = [&](std::span<const Event> events) {
    for (const Event& event : events) {
      if (event.track_id <= 0) continue;
      if (event.kind == TrackEvent::kConfirmed) {
        EXPECT_TRUE(numbers.insert(event.track_id).second) << event.track_id;
      } else if (event.kind == TrackEvent::kLost) {
        EXPECT_EQ(numbers.erase(event.track_id), 1u) << event.track_id;
      }
    }
  };
  for (const Input& input : shuffled(inputs, 2.0 * kPeriod_s, 6)) {
    note(give(window, input).events);
    std::set<std::int64_t> there = ids_of(window.tracker());
    std::erase_if(there, [](std::int64_t id) { return id <= 0; });
    ASSERT_EQ(numbers, there);
  }
  note(window.correct());
  std::set<std::int64_t> there = ids_of(in_order(inputs));
  std::erase_if(there, [](std::int64_t id) { return id <= 0; });
  EXPECT_EQ(numbers, there);
}

/// Counts what it processes.
struct Counted : VesselTracker {
  using VesselTracker::VesselTracker;
  ScanReport sector(const Sector& part) noexcept {
    ++calls;
    return VesselTracker::sector(part);
  }
  static inline int calls = 0;
};

TEST(LateWindow, CorrectionsOfWhatIsAlwaysLateAreBounded) {
  // Every other sector is a turn late.
  const std::vector<Input> inputs = sectors_of(scene(7, 32, 100.0));
  std::vector<Input> come;
  for (std::size_t k = 0; k < inputs.size() + 32; ++k) {
    if (k % 2 == 0 && k < inputs.size()) come.push_back(inputs[k]);
    if (k % 2 == 1 && k >= 32) come.push_back(inputs[k - 32]);
  }
  LateWindow<Counted> window({}, kTestRadar, TrackerConfig{}, vessel_imm(kTestRadar));
  Counted::calls = 0;
  double last_correct_s = 0.0;
  for (const Input& input : come) {
    (void)std::get<SectorInput>(input.what).give_to(window, input.plots);
    if (window.is_correct()) last_correct_s = window.tracker().time_s();
    EXPECT_LE(window.tracker().time_s() - last_correct_s, 2.0 * kPeriod_s);
  }
  EXPECT_LE(Counted::calls, 3 * std::ssize(come));
  EXPECT_GT(window.counts().corrections, 20);
  (void)window.correct();
  EXPECT_TRUE(window.tracker().save() == in_order(inputs).save());
}

TEST(LateWindow, ARestoredOneGoesOnBitForBit) {
  const std::vector<Input> come = shuffled(scene(8, 16, 50.0), 2.0 * kPeriod_s, 8);
  VesselWindow window = make_window(), restored = make_window();
  for (const Input& input : shuffled(sectors_of(scene(9, 4, 25.0)), kPeriod_s, 9))
    (void)give(restored, input);
  const std::size_t half = come.size() / 2;
  for (std::size_t k = 0; k < half; ++k) (void)give(window, come[k]);
  const std::vector<std::byte> state = window.save();
  EXPECT_FALSE(restored.restore(state)) << "a radar has changed";
  restored.set_radar(0, window.tracker().radar());
  ASSERT_TRUE(restored.restore(state));
  EXPECT_TRUE(restored.save() == state);
  for (std::size_t k = half; k < come.size(); ++k) {
    (void)give(window, come[k]);
    (void)give(restored, come[k]);
  }
  (void)window.correct();
  (void)restored.correct();
  EXPECT_TRUE(restored.tracker().save() == window.tracker().save());
  EXPECT_TRUE(restored.tracker().save() == in_order(come).save());

  const std::vector<std::byte> before = restored.save();
  Draw draw(3);
  for (int k = 0; k < 20; ++k) {
    std::vector<std::byte> spoiled = state;
    const auto at = static_cast<std::size_t>(draw.uniform(0, double(state.size())));
    if (k % 2 == 0)
      spoiled.resize(at);
    else
      spoiled[at] ^= std::byte{1};
    EXPECT_FALSE(restored.restore(spoiled));
  }
  EXPECT_FALSE(restored.restore(make_window({.window_s = 7.0}).save()));
  EXPECT_FALSE(restored.restore(make_window({}, {.coast_scans = 4.0}).save()));
  EXPECT_FALSE(restored.restore(make_tracker().save()));
  EXPECT_TRUE(restored.save() == before);
}

TEST(LateWindow, TakesNoMemoryAfterItsConstruction) {
  const std::vector<Input> come = shuffled(scene(10, 16, 50.0), 2.4 * kPeriod_s, 10);
  const TrackerConfig config{.max_tracks = 50, .max_plots = 100};
  for (const LateWindowConfig& room : {LateWindowConfig{}, LateWindowConfig{.max_inputs = 20}}) {
    VesselWindow window = make_window(room, config);
    const NoHeap fence;
    for (const Input& input : come) (void)give(window, input);
    (void)window.correct();
    EXPECT_EQ(fence.allocations(), 0);
    EXPECT_GT(window.counts().late, 0);
    EXPECT_GT(window.counts().too_late, 0);
  }
}

TEST(LateWindow, ClosesWhereRadarsComeAndGo) {
  const std::vector<Input> inputs = sectors_of(scene(11, 8, 40.0, 2));
  VesselWindow window = make_window();
  EXPECT_FALSE(window.remove_radar(0)) << "the last one";
  for (const double part_s : {20.0, 40.0}) {
    for (const Input& input : shuffled(inputs, 2.0, 11))
      if (input.time_s > part_s - 20.0 && input.time_s <= part_s) (void)give(window, input);
    (void)window.correct();
    if (part_s > 20.0) break;
    EXPECT_EQ(window.add_radar(radars(2)[1]), 1);
    EXPECT_EQ(window.earliest_time_s(), window.tracker().time_s());
  }
  EXPECT_EQ(window.tracker().radar_numbers(), 2);
  EXPECT_GT(window.tracker().size(), 8);
  EXPECT_TRUE(window.remove_radar(0));
  EXPECT_EQ(window.process(50.0, {}).status, Status::kNotFinite);
  EXPECT_EQ(window.sector({.radar = 1, .to_rad = 1.0, .time_s = 50.0}).status, Status::kOk);
  EXPECT_THROW(window.set_radar(0, kTestRadar), std::invalid_argument);
}

TEST(LateWindow, RejectsSettingsThatMakeNoSense) {
  for (const LateWindowConfig& bad :
       {LateWindowConfig{.window_s = -1.0}, LateWindowConfig{.max_inputs = 0},
        LateWindowConfig{.max_plots = 0}})
    EXPECT_THROW(make_window(bad), std::invalid_argument);
  EXPECT_EQ(make_window().config().window_s, 2.0 * kPeriod_s);
}

}  // namespace
}  // namespace wakeline::late_window_test
