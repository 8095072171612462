// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The loop of a radar console: plots in, scan by scan, tracks and dangerous encounters out.
//
//   console_loop SCANS.csv PLOTS.csv
//
// reads columns `scan, time_s, own_north_m, own_east_m` and `scan, north_m, east_m`; without
// arguments it makes up a scene of its own. After start no scan allocates memory, which the program
// counts and says.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <map>
#include <new>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "wakeline/navigation/encounter_watch.hpp"
#include "wakeline/track/tracker.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace {
long allocations = 0;
}

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

using namespace wakeline;

struct Scan {
  double time_s;
  std::vector<Plot> plots;
};

/// The numbers of the named columns, row by row.
std::vector<std::vector<double>> read_columns(const std::string& path,
                                              const std::vector<std::string>& names) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + " cannot be read");
  std::string line, field;
  const auto next_line = [&] {
    if (!std::getline(file, line)) return false;
    if (line.ends_with('\r')) line.pop_back();
    return true;
  };
  next_line();
  std::map<std::string, std::size_t> place;
  for (std::istringstream header(line); std::getline(header, field, ',');)
    place.emplace(field, place.size());
  for (const std::string& name : names)
    if (!place.contains(name)) throw std::runtime_error(path + " has no column " + name);
  std::vector<std::vector<double>> rows;
  while (next_line()) {
    std::vector<std::string> fields;
    for (std::istringstream row(line); std::getline(row, field, ',');) fields.push_back(field);
    std::vector<double> numbers;
    for (const std::string& name : names) numbers.push_back(std::stod(fields.at(place.at(name))));
    rows.push_back(numbers);
  }
  return rows;
}

std::vector<Scan> read_scans(const std::string& scans_path, const std::string& plots_path) {
  std::vector<Scan> scans;
  std::map<double, std::size_t> index;
  std::vector<OwnShip> own;
  for (const auto& row :
       read_columns(scans_path, {"scan", "time_s", "own_north_m", "own_east_m"})) {
    index[row[0]] = scans.size();
    scans.push_back({row[1], {}});
    own.push_back({.north_m = row[2], .east_m = row[3]});
  }
  for (const auto& row : read_columns(plots_path, {"scan", "north_m", "east_m"})) {
    const std::size_t k = index.at(row[0]);
    const double north = row[1] - own[k].north_m, east = row[2] - own[k].east_m;
    scans[k].plots.push_back(
        {scans[k].time_s, std::hypot(north, east), std::atan2(east, north), own[k]});
  }
  return scans;
}

/// Eight boats on straight courses among false plots; one comes back past another.
std::vector<Scan> made_up_scans() {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<Scan> scans;
  for (int k = 0; k < 100; ++k) {
    Scan scan{2.5 * k, {}};
    for (int boat = 0; boat < 8; ++boat) {
      if (uniform(random) > 0.9) continue;
      const bool returns = boat == 7;
      const double course = returns ? 3 * 0.8 + 0.03 : boat * 0.8;
      const double distance = returns ? 1800.0 - 6.0 * scan.time_s : 500.0 + 6.0 * scan.time_s;
      const double north = distance * std::cos(course), east = distance * std::sin(course);
      scan.plots.push_back({scan.time_s, std::hypot(north, east) + 8 * normal(random),
                            std::atan2(east, north) + deg(0.5) * normal(random)});
    }
    for (int k2 = 0; k2 < 5; ++k2)
      scan.plots.push_back({scan.time_s, 3000 * uniform(random), 6.28 * uniform(random)});
    scans.push_back(scan);
  }
  return scans;
}

}  // namespace

int main(int argc, char** argv) try {
  const Radar radar{
      .range_std_m = 8.0, .bearing_std_rad = deg(0.6), .period_s = 2.5, .max_speed_mps = 25.0};
  const std::vector<Scan> scans = argc > 2 ? read_scans(argv[1], argv[2]) : made_up_scans();
  Tracker tracker(radar, TrackerConfig{}, vessel_imm(radar));
  EncounterWatch watch(DangerLimits{.cpa_limit_m = 200.0, .tcpa_limit_s = 300.0});
  std::vector<WatchedVessel> vessels;
  vessels.reserve(static_cast<std::size_t>(watch.max_vessels()));

  const long before = allocations;
  double worst_us = 0.0, total_us = 0.0;
  for (const Scan& scan : scans) {
    const auto start = std::chrono::steady_clock::now();
    const ScanReport report = tracker.process(scan.time_s, scan.plots);
    vessels.clear();
    tracker.for_each([&](const auto& track) {
      if (track.shown() && vessels.size() < vessels.capacity())
        vessels.push_back({track.id, tracker.kinematics_at(track, scan.time_s)});
    });
    const EncounterReport danger = watch.update(scan.time_s, vessels);
    const double us =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
    worst_us = std::max(worst_us, us);
    total_us += us;
    for (const Event& event : report.events)
      if (event.kind == TrackEvent::kConfirmed)
        std::printf("%10.1f s  track %lld confirmed\n", event.time_s,
                    static_cast<long long>(event.track_id));
    for (const EncounterEvent& event : danger.events) {
      const Encounter& one = event.encounter;
      const auto first = static_cast<long long>(one.approach.first);
      const auto second = static_cast<long long>(one.approach.second);
      if (event.change == EncounterChange::kBegan)
        std::printf("%10.1f s  tracks %lld and %lld: %.0f m in %.0f s, %.0f %%\n", scan.time_s,
                    first, second, one.approach.cpa_m(), one.approach.tcpa_s,
                    100.0 * one.approach.probability);
      else
        std::printf("%10.1f s  tracks %lld and %lld: over, closest %.0f m\n", scan.time_s, first,
                    second, one.least_range_m);
    }
  }
  tracker.for_each([](const auto& track) {
    if (!track.shown()) return;
    std::printf("track %lld at %8.1f N %8.1f E, %4.1f m/s\n", static_cast<long long>(track.id),
                track.kinematics.mean[0], track.kinematics.mean[2], track.speed_mps());
  });
  std::printf("%zu scans, %.1f us a scan, at worst %.1f us, %ld allocations\n", scans.size(),
              total_us / static_cast<double>(scans.size()), worst_us, allocations - before);
  return allocations == before ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "console_loop: %s\n", error.what());
  return 2;
}
