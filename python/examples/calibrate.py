"""Find the offsets of a radar from position reports of a vessel, and track with them.

Reports of one vessel every 10 s, as AIS or a friend's GNSS gives them. Writes calibrate.png: the
errors of the plots before and after.
"""

import math

import wakeline as wl

recording = wl.recording.load("joyride")
episode = recording.episodes[0]
settings = wl.tracking.read_settings(radar="joyride")
calibration = wl.Calibration(settings.make_radar())

vessel = episode.truth["1"]
next_report_s = -math.inf
for scan in episode.scans:
    for k in range(len(vessel)):
        if next_report_s <= vessel.time_s[k] <= scan.time_s:
            calibration.add_reports(
                1,
                vessel.time_s[k],
                north_m=vessel.north_m[k],
                east_m=vessel.east_m[k],
                vnorth_mps=vessel.vnorth_mps[k],
                veast_mps=vessel.veast_mps[k],
                position_std_m=3.0,
            )
            next_report_s = vessel.time_s[k] + 9.9
    velocity_mps = episode.own.velocity_at(scan.plot_time_s)
    calibration.add_plots(
        scan.plot_time_s,
        range_m=scan.range_m,
        bearing_rad=scan.bearing_rad,
        own_north_m=scan.own_north_m,
        own_east_m=scan.own_east_m,
        own_vnorth_mps=velocity_mps[:, 0],
        own_veast_mps=velocity_mps[:, 1],
    )

found = calibration.solve()
wl.plot.save(wl.plot.calibration_figure(found, ["", "boat"]), "calibrate.png")
print(f"{found.matches:.0f} plots of the vessel")
for name, offset, scale, unit in (
    ("range", found.range_m, 1.0, "m"),
    ("bearing", found.bearing_rad, math.degrees(1.0), "degrees"),
    ("time", found.time_s, 1.0, "s"),
):
    value, std = scale * offset.value, scale * offset.std
    print(f"{name}: {value:+.2f} +- {std:.2f} {unit}, {offset.verdict}")

for radar in (settings.make_radar(), found.applied_to(settings.make_radar())):
    score = wl.metrics.score(wl.track_recording(recording, radar=radar), recording).overall
    print(
        f"with {math.degrees(radar.bearing_offset_rad):+.2f} degrees: "
        f"position {score.errors.position_rmse_m:.1f} m, coverage {100 * score.coverage:.0f} %"
    )
