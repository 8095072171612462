"""Radar video to tracks by strobes: each vessel is measured where it is expected.

A pilot boat overtakes a ship 60 m abeam. The operator designates the boat; the ship is acquired
from a plot. Writes strobe_tracker.png: the echoes in the last revolution with both strobes.
"""

import numpy as np

import wakeline as wl
from wakeline import plot, scenario


def vessel(north_m, east_m, veast_mps, length_m):
    truth = scenario.Truth([north_m, 0.0, east_m, veast_mps])
    return scenario.VideoTarget(truth=truth, length_m=length_m, beam_m=5.0, rcs_m2=5.0, swerling=0)


radar = wl.Radar(range_std_m=4.0, bearing_std_rad=np.deg2rad(0.2), period_s=2.5, max_speed_mps=20.0)
simulator = scenario.RadarVideoSimulator(
    sweeps_per_turn=1440,
    cells=300,
    cell_m=6.0,
    period_s=radar.period_s,
    beam_width_rad=np.deg2rad(0.8),
    pulse_length_m=12.0,
    snr_db=20.0,
)
boat, ship = vessel(1200.0, -260.0, 9.0, 15.0), vessel(1260.0, -100.0, 5.0, 25.0)

config = wl.StrobeTrackerConfig(least_amplitude=60, radius_m=35.0)
tracker = wl.StrobeTracker(radar, config, wl.BayesianAlphaBeta())
extractor = wl.PlotExtractor(threshold_factor=5.0, min_cells=6)
tracker.designate(0.0, 1200.0, -260.0, position_std_m=10.0)
shared = 0
for turn in simulator.turns({"boat": boat, "ship": ship}, 32, seed=1):
    strobes = []
    for first in range(0, len(turn), 60):  # as the sweeps come
        sweeps = turn[first : first + 60]
        readings = tracker.process(sweeps)
        tracker.acquire(extractor.process(sweeps))
        shared += int(readings.shared.sum())
        for event in readings.events:
            if event.kind in ("confirmed", "lost"):
                print(f"{event.time_s:5.1f} s: track {event.track_id} {event.kind}")
        strobes += map(plot.circle_outline, readings.predicted_m, readings.radius_m)

tracks = tracker.tracks()
for track_id, (north_m, vn, east_m, ve) in zip(tracks.track_id, tracks.mean, strict=True):
    print(f"track {track_id}: {north_m:.0f} N {east_m:.0f} E, {np.hypot(vn, ve):.1f} m/s")
print(f"{shared} readings of shared echoes")
north_m, east_m = tracks.mean[:, [0, 2]].mean(axis=0)
axes = plot.ppi(
    turn,
    plots=tracks.mean[:, [0, 2]],
    strobes=strobes,
    extent_m=(east_m - 250.0, east_m + 250.0, north_m - 250.0, north_m + 250.0),
    rings=False,
    amplitude_range=(0.0, 255.0),
)
plot.save(axes.figure, "strobe_tracker.png")
