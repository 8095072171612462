"""Two radars, AIS reports, data that come late, and an operator: one picture of five boats.

The data are simulated; the second radar is a turn late, AIS 4 s. The window puts them in their
place, so that the tracks are those of data in time. Writes several_sensors.png.
"""

import numpy as np

import wakeline as wl

SECTORS, WIDTH_RAD = 16, 2.0 * np.pi / 16
START_M = np.array([[1500.0, 200], [-900, 1400], [400, -2100], [-1800, -600], [900, 1100]])
VELOCITY_MPS = np.array([[-4.0, 5], [6, -1], [-2, 7], [5, 3], [1, -6]])
RADARS = [
    wl.Radar(range_std_m=8.0, bearing_std_rad=np.deg2rad(0.5), period_s=2.5),
    wl.Radar(range_std_m=20.0, bearing_std_rad=np.deg2rad(1.0), period_s=3.0),
]
SITES = [wl.OwnShip(), wl.OwnShip(north_m=2500.0, east_m=-1500.0)]
rng = np.random.default_rng(1)


def sector(radar, time_s, from_rad):
    """What a radar sees in a sector that ends at a time."""
    own, errors = SITES[radar], RADARS[radar]
    place_m = START_M + time_s * VELOCITY_MPS - [own.north_m, own.east_m]
    bearing_rad = np.arctan2(place_m[:, 1], place_m[:, 0]) % (2.0 * np.pi)
    seen = (bearing_rad >= from_rad) & (bearing_rad < from_rad + WIDTH_RAD) & (rng.random(5) < 0.9)
    range_m = np.hypot(*place_m[seen].T) + errors.range_std_m * rng.standard_normal(seen.sum())
    bearing_rad = bearing_rad[seen] + errors.bearing_std_rad * rng.standard_normal(seen.sum())
    beam = {"from_rad": from_rad, "to_rad": from_rad + WIDTH_RAD, "own": own}
    return beam | {"radar": radar, "time_s": time_s, "range_m": range_m, "bearing_rad": bearing_rad}


inputs = []  # (time of arrival, call, arguments)
for radar, delay_s in enumerate((0.1, 3.0)):
    for k in range(int(120.0 / RADARS[radar].period_s) * SECTORS):
        end_s = (k + 1) * RADARS[radar].period_s / SECTORS
        inputs.append((end_s + delay_s, "sector", sector(radar, end_s, WIDTH_RAD * (k % SECTORS))))
for boat in range(3):
    for time_s in np.arange(5.0 + boat, 120.0, 10.0):
        north_m, east_m = START_M[boat] + time_s * VELOCITY_MPS[boat] + rng.normal(0.0, 5.0, 2)
        report = {"time_s": time_s, "north_m": north_m, "east_m": east_m, "position_std_m": 5.0}
        inputs.append((time_s + 4.0, "report", report | {"identity": f"25737850{boat}"}))
inputs.sort(key=lambda one: one[0])

window, axes = wl.LateWindow(RADARS, window_s=8.0), wl.plot.figure(6.4, 6.0).add_subplot()
for k, (_, call, arguments) in enumerate(inputs):
    getattr(window, call)(**arguments)
    if k % 40 == 0:
        axes.scatter(*window.tracks().mean[:, [2, 0]].T / 1e3, s=5, color=wl.plot.PALETTE[0])
pilot = window.designate(120.0, *(START_M[4] + 120.0 * VELOCITY_MPS[4]))
window.rename(pilot, "Pilot")

tracks = window.tracks()
print(f"{window.late_inputs} late, {window.too_late_inputs} too late")
for k, (north_m, _, east_m, _) in enumerate(tracks.mean):
    name = tracks.identity[k] or tracks.name[k]
    print(f"track {tracks.track_id[k]} at {north_m:8.1f} N {east_m:8.1f} E  {name}")
    label, place_km = f"{tracks.track_id[k]} {name}", (east_m / 1e3, north_m / 1e3)
    axes.annotate(label, place_km, (5.0, 6.0), textcoords="offset points", fontsize=8)
for site in SITES:
    axes.plot(site.east_m / 1e3, site.north_m / 1e3, color=wl.plot.INK, marker="^")
wl.plot.save(wl.plot.dress_map(axes).figure, "several_sensors.png")
