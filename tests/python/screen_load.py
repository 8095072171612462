"""What the screen costs a browser: run it to print the processor time of a frame, by a trace.

A radar of 4096 sweeps of 2048 cells at 48 turns a minute, targets whose positions scatter by 3 m,
a page of 1920 x 1080. Not a test, because it depends on the machine.
"""

import math
import sys
import threading
import time
from collections import Counter

import numpy as np

import browser as chromium
from harbor import Harbor
from wakeline.live.web import WebServer

RANGE_M, PERIOD_S, SECONDS = 12_000.0, 1.25, 8.0
SWEEPS, CELLS, TOGETHER = 4096, 2048, 32


class Crowd(Harbor):
    """Targets on straight courses, which have been tracked for six minutes."""

    def __init__(self, count):
        super().__init__()
        self.rng = np.random.default_rng(0)
        self.place_m = self.rng.uniform(-8000.0, 8000.0, (count, 2))
        self.velocity_mps = self.rng.uniform(-6.0, 6.0, (count, 2))
        for k, (place, velocity) in enumerate(zip(self.place_m, self.velocity_mps, strict=True)):
            ago_s = 30.0 * np.arange(11, 0, -1)
            was_m = place - ago_s[:, np.newaxis] * velocity
            past = np.column_stack([self.time_s - ago_s, was_m]).tolist()
            self.add(k + 1, *place.tolist(), *velocity.tolist(), history=past)

    def watch(self):
        """Move the targets; alarms are another matter."""
        at_m = self.place_m + self.velocity_mps * (self.time_s - 1.7e9)
        at_m += self.rng.normal(0.0, 3.0, at_m.shape)
        for track, (north_m, east_m) in zip(self.tracks.values(), at_m.tolist(), strict=True):
            track["north_m"], track["east_m"] = north_m, east_m


def turn(harbor, ends):
    """Give sweeps of noise and echoes, as fast as the antenna turns."""
    rng = np.random.default_rng(0)
    cells = rng.rayleigh(14.0, (SWEEPS, CELLS)).clip(0, 120).astype(np.uint8)
    for sweep, cell in rng.integers(0, (SWEEPS - 14, CELLS - 8), (60, 2)):
        cells[sweep : sweep + 14, cell : cell + 8] = 250
    azimuth_rad = (np.arange(SWEEPS) + 0.5) * math.tau / SWEEPS
    begin_s, given = time.monotonic(), 0
    while not ends.wait(0.01):
        due = int((time.monotonic() - begin_s) / PERIOD_S * SWEEPS / TOGETHER)
        for k in range(given, due):
            first = k * TOGETHER % SWEEPS
            part = slice(first, first + TOGETHER)
            for take in list(harbor.sweeps):
                take("A", azimuth_rad[part], math.nan, RANGE_M, cells[part])
        given = due


def main(targets=1000):
    harbor, ends = Crowd(targets), threading.Event()
    driver = chromium.Driver()
    page = driver.browser(1920, 1080, traces=True)
    antenna = threading.Thread(target=turn, args=(harbor, ends))
    try:
        with WebServer(harbor, port=0) as server:
            antenna.start()
            page.open(f"{server.url}#range={RANGE_M}")
            page.wait_for("window.wakeline?.store.tracks.size > 0")
            time.sleep(4.0)
            events = list(page.traced(SECONDS))
    finally:
        ends.set()
        antenna.join()
        page.close()
        driver.close()
    main_thread = [(name, ms) for thread, name, ms in events if thread == "CrRendererMain"]
    frames = sum(name == "FireAnimationFrame" for name, _ in main_thread)
    spent = Counter()
    for name, ms in main_thread:
        spent[name] += ms / frames
    print(f"{frames / SECONDS:.1f} frames a second; processor time of the main thread a frame:")
    for name, about in (
        ("RunTask", "all"),
        ("FunctionCall", "scripts of the page"),
        ("Paint", "drawing and copying of the canvases"),
        ("Layout", "layout"),
    ):
        print(f"{spent[name]:8.1f} ms {about}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
