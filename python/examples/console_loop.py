"""The loop of a radar console: plots in, scan by scan, tracks out.

wl.track_recording does this for a whole recording; a console takes each scan as it comes.
"""

import wakeline as wl

recording = wl.recording.load("joyride")
settings = wl.tracking.read_settings(radar="joyride")
tracker = settings.make_tracker()

for scan in recording.episodes[0].scans:
    report = tracker.process(
        max(scan.time_s, scan.plot_time_s.max(initial=scan.time_s)),
        range_m=scan.range_m,
        bearing_rad=scan.bearing_rad,
        plot_time_s=scan.plot_time_s,
        own_north_m=scan.own_north_m,
        own_east_m=scan.own_east_m,
    )
    for event in report.events:
        print(f"{event.time_s:14.1f} s  track {event.track_id} {event.kind}")

tracks = tracker.tracks()
for track_id, (north_m, _, east_m, _) in zip(tracks.track_id, tracks.mean, strict=True):
    print(f"track {track_id} at {north_m:8.1f} N {east_m:8.1f} E")
