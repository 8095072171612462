// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Settings that make no sense are rejected by a sentence that names them.
#include <functional>
#include <limits>
#include <string>
#include <tuple>

#include "track/scene.hpp"

namespace wakeline::settings_test {
namespace {

using test::kTestRadar;
using test::make_tracker;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

/// What rejecting says, or nothing.
std::string rejection(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expect_rejected(const char* name, const std::function<void(TrackerConfig&)>& spoil) {
  TrackerConfig config;
  spoil(config);
  const std::string message = rejection([&] { config.validate(); });
  EXPECT_EQ(message.rfind(std::string(name) + " must be ", 0), 0u)
      << name << ": '" << message << "'";
  EXPECT_EQ(rejection([&] { (void)make_tracker(config); }), message) << "the tracker says the same";
}

TEST(TrackerConfig, TheDefaultsAreValid) {
  EXPECT_EQ(rejection([] { TrackerConfig{}.validate(); }), "");
  EXPECT_EQ(rejection([] { Radar{}.validate(); }), "");
}

TEST(TrackerConfig, NamesWhatItRejects) {
#define WAKELINE_EXPECT_REFUSED(field, ...) \
  for (const double value : {__VA_ARGS__})  \
  expect_rejected(#field, [value](TrackerConfig& config) { config.field = value; })
#define WAKELINE_EXPECT_REFUSED_COUNT(field, ...) \
  for (const int value : {__VA_ARGS__})           \
  expect_rejected(#field, [value](TrackerConfig& config) { config.field = value; })
  WAKELINE_EXPECT_REFUSED(detection_probability, -0.1, 1.1, kNan);
  WAKELINE_EXPECT_REFUSED(gate_probability, 0.0, 1.0, kNan);
  WAKELINE_EXPECT_REFUSED(clutter_density_per_m2, 0.0, -1.0, kNan, kInf);
  WAKELINE_EXPECT_REFUSED(outlier_probability, -0.1, 1.0, kNan);
  WAKELINE_EXPECT_REFUSED(outlier_scale, 0.9, kNan, kInf);
  WAKELINE_EXPECT_REFUSED(clutter_cell_m, -1.0, kNan, kInf);
  WAKELINE_EXPECT_REFUSED(clutter_memory_s, 0.0, 1e-310, kNan);
  WAKELINE_EXPECT_REFUSED(clutter_weight, -1.0, kNan);
  WAKELINE_EXPECT_REFUSED(visible_time_s, -1.0, 1e-310, kNan);
  WAKELINE_EXPECT_REFUSED(hidden_time_s, 0.0, 1e-310, kNan);
  WAKELINE_EXPECT_REFUSED(birth_density_per_m2, -1e-9, kNan, kInf);
  WAKELINE_EXPECT_REFUSED(free_plot, -0.1, 1.1, kNan);
  WAKELINE_EXPECT_REFUSED(start_gate_sigma, -1.0, kNan);
  WAKELINE_EXPECT_REFUSED(start_speed_factor, -1.0, kNan);
  WAKELINE_EXPECT_REFUSED(confirm_existence, -0.1, 1.1, kNan);
  WAKELINE_EXPECT_REFUSED_COUNT(confirm_hits, 0, -3);
  WAKELINE_EXPECT_REFUSED_COUNT(confirm_window, 2, 33);
  WAKELINE_EXPECT_REFUSED(survival_time_s, 0.0, kNan);
  WAKELINE_EXPECT_REFUSED(drop_existence, -0.1, 1.1, kNan);
  WAKELINE_EXPECT_REFUSED_COUNT(tentative_misses, -1);
  WAKELINE_EXPECT_REFUSED(coast_scans, -1.0, kNan, kInf);
  WAKELINE_EXPECT_REFUSED(coast_scans_per_hit, -1.0, kNan);
  WAKELINE_EXPECT_REFUSED_COUNT(coast_scans_max, -1);
  WAKELINE_EXPECT_REFUSED(shown_probability, -0.1, 1.1, kNan);
  WAKELINE_EXPECT_REFUSED(drop_position_std_m, 0.0, kNan);
  WAKELINE_EXPECT_REFUSED(drop_speed_factor, 0.0, kNan);
  WAKELINE_EXPECT_REFUSED(duplicate_distance, -1.0, kNan);
  WAKELINE_EXPECT_REFUSED(vessel_length_m, -1.0, kNan, kInf);
  WAKELINE_EXPECT_REFUSED_COUNT(duplicate_scans, 0);
  WAKELINE_EXPECT_REFUSED_COUNT(max_tracks, 0, -1, 1'000'000'000);
  WAKELINE_EXPECT_REFUSED_COUNT(max_plots, 0, -1, 1'000'000'000);
}

TEST(TrackerConfig, FieldsListEveryMember) {
  const TrackerConfig config;
  std::size_t bytes = 0;
  for_each_field(config, [&](const auto&, const auto& value) { bytes += sizeof(value); });
  EXPECT_LE(sizeof(TrackerConfig) - bytes, 2 * alignof(TrackerConfig) + sizeof(int))
      << "a member is missing from fields()";
}

TEST(RadarSettings, NamesWhatItRejects) {
  const auto expect = [](const char* name, const std::function<void(Radar&)>& spoil) {
    Radar radar = kTestRadar;
    spoil(radar);
    const std::string message = rejection([&] { radar.validate(); });
    EXPECT_EQ(message.rfind(std::string(name) + " must be ", 0), 0u)
        << name << ": '" << message << "'";
    EXPECT_EQ(rejection([&] { (void)test::VesselTracker(radar, {}, vessel_imm(kTestRadar)); }),
              message);
  };
  for (const double value : {0.0, -1.0, kNan, kInf}) {
    expect("range_std_m", [=](Radar& radar) { radar.range_std_m = value; });
    expect("bearing_std_rad", [=](Radar& radar) { radar.bearing_std_rad = value; });
    expect("period_s", [=](Radar& radar) { radar.period_s = value; });
    expect("max_speed_mps", [=](Radar& radar) { radar.max_speed_mps = value; });
  }
  for (const double value : {-1.0, kNan, kInf})
    expect("extent_std_m", [=](Radar& radar) { radar.extent_std_m = value; });
  for (const double value : {kNan, kInf})
    expect("bearing_offset_rad", [=](Radar& radar) { radar.bearing_offset_rad = value; });
}

TEST(VesselModelSettings, TakesAnyProbability) {
  for (const double cruising : {0.0, 0.5, 1.0}) {
    for (const double agile : {0.0, 0.5, 1.0}) {
      const VesselModels models{.cruising_probability = cruising, .agile_probability = agile};
      VesselImm imm = vessel_imm(kTestRadar, models);
      EXPECT_NEAR(imm.core().initial_mode_probability().sum(), 1.0, 1e-12);
      ASSERT_EQ(imm.start(Gaussian<4>{Vec<double, 4>(100.0, 5.0, 200.0, 1.0),
                                      Mat<double, 4, 4>::Identity()}),
                Status::kOk);
      for (int k = 0; k < 20; ++k) {
        ASSERT_EQ(imm.predict(2.5), Status::kOk);
        EXPECT_NEAR(imm.mode_probability().sum(), 1.0, 1e-12);
      }
      EXPECT_EQ(imm.joined(), agile > 0.0) << cruising << ", " << agile;
    }
  }
}

TEST(VesselModelSettings, NamesWhatItRejects) {
  const auto expect = [](const char* name, const std::function<void(VesselModels&)>& spoil) {
    VesselModels models;
    spoil(models);
    const std::string message = rejection([&] { (void)vessel_imm(kTestRadar, models); });
    EXPECT_EQ(message.rfind(std::string(name) + " must be ", 0), 0u)
        << name << ": '" << message << "'";
  };
  const std::pair<const char*, double VesselModels::*> noises[] = {
      {"cruising_psd_m2s3", &VesselModels::cruising_psd_m2s3},
      {"cruising_course_psd_rad2s", &VesselModels::cruising_course_psd_rad2s},
      {"steady_psd_m2s3", &VesselModels::steady_psd_m2s3},
      {"steady_course_psd_rad2s", &VesselModels::steady_course_psd_rad2s},
      {"restless_psd_m2s3", &VesselModels::restless_psd_m2s3},
      {"restless_course_psd_rad2s", &VesselModels::restless_course_psd_rad2s},
      {"turning_psd_m2s3", &VesselModels::turning_psd_m2s3},
      {"turning_course_psd_rad2s", &VesselModels::turning_course_psd_rad2s},
      {"turn_rate_psd_rad2s3", &VesselModels::turn_rate_psd_rad2s3},
      {"weaving_psd_m2s3", &VesselModels::weaving_psd_m2s3},
      {"agile_turn_psd_m2s3", &VesselModels::agile_turn_psd_m2s3},
      {"agile_turn_rate_rad_s", &VesselModels::agile_turn_rate_rad_s}};
  for (const auto& [name, field] : noises)
    for (const double value : {-1.0, kNan, kInf})
      expect(name, [field = field, value](VesselModels& models) { models.*field = value; });
  for (const double value : {0.0, -1.0, kNan, kInf})
    expect("prior_turn_rate_std_rad_s",
           [=](VesselModels& models) { models.prior_turn_rate_std_rad_s = value; });
  const std::pair<const char*, double VesselModels::*> times[] = {
      {"cruising_sojourn_s", &VesselModels::cruising_sojourn_s},
      {"settling_s", &VesselModels::settling_s},
      {"steady_sojourn_s", &VesselModels::steady_sojourn_s},
      {"restless_sojourn_s", &VesselModels::restless_sojourn_s},
      {"turning_sojourn_s", &VesselModels::turning_sojourn_s},
      {"agile_time_s", &VesselModels::agile_time_s},
      {"weaving_sojourn_s", &VesselModels::weaving_sojourn_s},
      {"agile_turn_sojourn_s", &VesselModels::agile_turn_sojourn_s}};
  for (const auto& [name, field] : times)
    for (const double value : {0.0, -1.0, 1e-300, 1e300, kNan, kInf})
      expect(name, [field = field, value](VesselModels& models) { models.*field = value; });
  for (const double value : {-0.1, 1.1, kNan}) {
    expect("cruising_probability",
           [=](VesselModels& models) { models.cruising_probability = value; });
    expect("agile_probability", [=](VesselModels& models) { models.agile_probability = value; });
  }
}

}  // namespace
}  // namespace wakeline::settings_test
