"""Radar video to tracks: sweeps in, plots of their echoes, tracks out.

A simulated radar sends two ships in the noise of the receiver, as ASTERIX category 240. Writes
screen.png: the last revolution of the antenna with plots, strobes and tracks.
"""

import tempfile
from pathlib import Path

import numpy as np

import wakeline as wl
from wakeline import scenario


def ship(north_m, vnorth_mps, east_m, veast_mps):
    truth = scenario.Truth([north_m, vnorth_mps, east_m, veast_mps])
    return scenario.VideoTarget(truth=truth, length_m=40.0, beam_m=10.0, rcs_m2=10.0, swerling=0)


radar = scenario.RadarVideoSimulator(
    sweeps_per_turn=720,
    cells=400,
    cell_m=10.0,
    period_s=2.5,
    beam_width_rad=np.deg2rad(1.5),
    pulse_length_m=20.0,
    snr_db=12.0,
)
ships = {"one": ship(2500.0, 0.0, -60.0, 8.0), "two": ship(-1500.0, 6.0, 2200.0, 5.0)}

with tempfile.TemporaryDirectory() as folder:
    video = Path(folder, "harbour.cat240")
    wl.recording.write_video(video, radar.turns(ships, 14, seed=1))
    tracks = wl.track_recording(video)

last = tracks.where(tracks.time_s == tracks.time_s.max())
for track_id, (north_m, _, east_m, _) in zip(last.track_id, last.state, strict=True):
    print(f"track {track_id} at {north_m:6.0f} N {east_m:6.0f} E")
wl.plot.save(wl.plot.screen(tracks), "screen.png")
