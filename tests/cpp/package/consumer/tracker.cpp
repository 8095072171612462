// A console that links the compiled tracker, and does not read what it is made of.
#include <wakeline/track/compiled.hpp>

int main() {
  using namespace wakeline;
  const Radar radar;
  Tracker<VesselImm> tracker(radar, TrackerConfig{}, vessel_imm(radar));
  for (int scan = 0; scan < 10; ++scan) {
    const double time_s = scan * radar.period_s;
    const Plot plot{.time_s = time_s, .range_m = 3000.0, .bearing_rad = 0.5};
    if (tracker.process(time_s, std::span(&plot, 1)).status != Status::kOk) return 1;
  }
  for (int report = 0; report < 3; ++report)
    (void)tracker.report({.identity = "636013927",
                          .time_s = tracker.time_s() + report,
                          .position_m = {2633.0, 1438.0}});
  if (tracker.find("ais", "636013927") == nullptr) return 2;
  const double bearing_rad = 0.5;
  if (tracker.partial({.time_s = tracker.time_s(), .values = std::span(&bearing_rad, 1)}).status !=
      Status::kOk)
    return 3;
  const auto saved = tracker.save();
  Tracker<VesselImm> restored(radar, TrackerConfig{}, vessel_imm(radar));
  if (!restored.restore(saved) || restored.size() != tracker.size()) return 4;
  int shown = 0;
  restored.for_each([&](const Track& track) { shown += track.shown(); });
  return shown > 0 ? 0 : 5;
}
