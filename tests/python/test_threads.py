"""Threads share an object: its calls are made one after the other. Without a lock this crashes."""

import subprocess
import sys

import pytest

COMMON = """
import sys, threading, time
import numpy as np
import wakeline as wl
from wakeline.recording import RadarVideo

END_S = time.monotonic() + 1.5
failures = []

def run(*loops):
    def until_the_end(loop):
        try:
            count = 0
            while time.monotonic() < END_S:
                loop()
                count += 1
            assert count > 3
        except BaseException as error:
            failures.append(error)
    threads = [threading.Thread(target=until_the_end, args=(loop,)) for loop in loops]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if failures:
        raise failures[0]

def video(turn):
    rng = np.random.default_rng(turn)
    azimuth_rad = np.linspace(0.0, 2 * np.pi, 360, endpoint=False)
    amplitude = rng.integers(0, 60, (360, 256), dtype=np.uint8)
    amplitude[100:104, 80:90] = amplitude[300:303, 200:205] = 250
    return RadarVideo(
        amplitude=amplitude, azimuth_rad=azimuth_rad, azimuth_width_rad=np.pi / 180,
        time_s=2.5 * (turn + azimuth_rad / (2 * np.pi)), start_range_m=0.0, cell_m=10.0,
    )
"""

# Vessels side by side, all with one velocity: in a table of one moment they are in one line.
TRACKER = """
tracker = wl.Tracker(wl.Radar(period_s=2.5, range_std_m=1.0, bearing_std_rad=1e-3))
east_m = np.linspace(-9000.0, 9000.0, 61)
clock = iter(range(10**9))
tables = []

def feed():
    k = next(clock)
    north_m = 5000.0 + 20.0 * 2.5 * k
    range_m = np.hypot(north_m, east_m)
    try:
        report = tracker.process(2.5 * k, range_m=range_m, bearing_rad=np.arctan2(east_m, north_m))
    except wl.FilterError:  # the other feed was faster
        return
    assert len(report.plot_track_id) == len(east_m)

def look():
    table = tracker.tracks()
    if len(table) > 10:
        tables.append(table)
    copy = tracker.save()
    assert len(copy) > 1000

def operate():
    tracker.rename(1, "Anna")
    tracker.rename(1, "Berta")
    names = {name for name in tracker.tracks(tentative=True).name if name}
    assert names <= {"Anna", "Berta"}, names
    assert tracker.config.max_tracks == 500

run(feed, feed, look, operate)
assert len(tables) > 3
for table in tables:
    north_m = table.mean[table.hits > 10, 0]
    assert len(north_m) == 0 or np.ptp(north_m) < 25.0, "half of a scan's way"
    assert np.isfinite(table.mean).all()
"""

EXTRACTOR = """
extractor = wl.PlotExtractor()
videos = [video(k) for k in range(3)]
turns = iter(range(10**9))
run(
    lambda: extractor.process(videos[next(turns) % 3]),
    lambda: extractor.process(videos[next(turns) % 3]),
    lambda: extractor.finish(),
    lambda: (extractor.counts, extractor.open_echoes, extractor.clutter),
)
assert extractor.counts.sweeps % 360 == 0
"""

STROBES = """
radar = wl.Radar(period_s=2.5)
tracker = wl.StrobeTracker(radar, wl.StrobeTrackerConfig(least_amplitude=200))
turns = iter(range(10**9))

def look():
    table = tracker.tracks(tentative=True)
    assert len(table.status) == len(table.track_id) == len(table.strobe_m)

run(
    lambda: tracker.process(video(next(turns))),
    lambda: tracker.process(video(next(turns))),
    lambda: tracker.designate(2.5 * next(turns), 800.0, 100.0),
    look,
    lambda: (tracker.save(), len(tracker)),
)
"""

DECODER = """
from wakeline._engine.video import Cat240Decoder, Cat240Encoder
one = video(0)
blocks = Cat240Encoder().encode(
    one.amplitude, one.azimuth_rad, one.time_s, one.azimuth_width_rad, one.start_range_m, one.cell_m
)
data = b"".join(blocks) if isinstance(blocks, list) else blocks
decoder = Cat240Decoder()

def decode():
    sweeps = decoder.decode(data, True)
    assert len(sweeps.offset) == 360 and sweeps.problem_count == 0

run(decode, decode, lambda: (decoder.other_blocks, decoder.skipped_octets))
assert decoder.skipped_octets == 0
"""

WATCH = """
watch = wl.EncounterWatch()
n = 60
vessel_id = np.arange(1, n + 1)
rng = np.random.default_rng(0)
mean = np.column_stack([rng.uniform(-3e3, 3e3, n), rng.normal(0, 8, n)] * 2)
covariance = np.tile(np.diag([25.0, 0.04, 25.0, 0.04]), (n, 1, 1))
clock = iter(range(10**9))

def feed():
    try:
        report = watch.update(next(clock), vessel_id=vessel_id, mean=mean, covariance=covariance)
    except wl.FilterError:
        return
    assert len(report.approaches) >= len(report.began)

run(feed, feed, lambda: watch.encounters, lambda: watch.acknowledge(1), lambda: watch.save())
"""


@pytest.mark.parametrize("kind", ["TRACKER", "EXTRACTOR", "STROBES", "DECODER", "WATCH"])
def test_threads_share_an_object(kind):
    program = COMMON + globals()[kind]
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
