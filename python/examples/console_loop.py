"""The loop of a radar console: plots in, scan by scan, tracks and dangerous encounters out.

wl.track_recording does this for a whole recording; a console takes each scan as it comes.
"""

import math

import wakeline as wl

recording = wl.recording.load("autoferry")
settings = wl.tracking.read_settings(radar="autoferry")
tracker = settings.make_tracker()
watch = wl.EncounterWatch(wl.DangerLimits(cpa_limit_m=50.0, tcpa_limit_s=120.0))

for scan in recording.episodes[0].scans:
    time_s = max(scan.time_s, scan.plot_time_s.max(initial=scan.time_s))
    report = tracker.process(
        time_s,
        range_m=scan.range_m,
        bearing_rad=scan.bearing_rad,
        plot_time_s=scan.plot_time_s,
        own_north_m=scan.own_north_m,
        own_east_m=scan.own_east_m,
    )
    for event in report.events:
        if event.kind == "confirmed":
            print(f"{event.time_s:14.1f} s  track {event.track_id} confirmed")
    tracks = tracker.tracks(time_s)
    began = watch.update(
        time_s, vessel_id=tracks.track_id, mean=tracks.mean, covariance=tracks.covariance
    ).began
    for first, second, cpa_m in zip(began.first, began.second, began.cpa_m, strict=True):
        print(f"{time_s:14.1f} s  tracks {first} and {second} will be {cpa_m:.0f} m apart")

tracks = tracker.tracks()
print("track   north m   east m  speed m/s  existence")
for k, (north_m, vnorth_mps, east_m, veast_mps) in enumerate(tracks.mean):
    speed_mps = math.hypot(vnorth_mps, veast_mps)
    row = f"{tracks.track_id[k]:5d}  {north_m:8.1f} {east_m:8.1f}  {speed_mps:9.1f}"
    print(f"{row}  {tracks.existence[k]:9.3f}")
