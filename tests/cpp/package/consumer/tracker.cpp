// A console that links the compiled tracker.
#include <wakeline/wakeline.hpp>

int main() {
  using namespace wakeline;
  const Radar radar;
  Tracker<VesselImm> tracker(radar, TrackerConfig{}, vessel_imm(radar));
  for (int scan = 0; scan < 10; ++scan) {
    const double time_s = scan * radar.period_s;
    const Plot plot{.time_s = time_s, .range_m = 3000.0, .bearing_rad = 0.5};
    if (tracker.process(time_s, std::span(&plot, 1)).status != Status::kOk) return 1;
  }
  return tracker.size() > 0 ? 0 : 1;
}
