"""Two radars, AIS reports, data that come late, and an operator: one picture of five boats.

The data are simulated; the second radar is a turn late, AIS 4 s. The window puts them in their
place, so that the tracks are those of data in time.
"""

import numpy as np

import wakeline as wl

SECTORS, TURN = 16, 2.0 * np.pi
START_M = np.array([[1500.0, 200], [-900, 1400], [400, -2100], [-1800, -600], [900, 1100]])
VELOCITY_MPS = np.array([[-4.0, 5], [6, -1], [-2, 7], [5, 3], [1, -6]])
RADARS = [
    wl.Radar(range_std_m=8.0, bearing_std_rad=np.deg2rad(0.5), period_s=2.5),
    wl.Radar(range_std_m=20.0, bearing_std_rad=np.deg2rad(1.0), period_s=3.0),
]
SITES = [wl.OwnShip(), wl.OwnShip(north_m=2500.0, east_m=-1500.0)]
DELAYS_S = [0.1, 3.0]
rng = np.random.default_rng(1)


def sector(number, radar, site, end_s, from_rad):
    """What a radar sees in a sector that ends at a time."""
    place_m = START_M + end_s * VELOCITY_MPS - [site.north_m, site.east_m]
    bearing_rad = np.arctan2(place_m[:, 1], place_m[:, 0]) % TURN
    range_m = np.hypot(*place_m.T) + radar.range_std_m * rng.standard_normal(5)
    seen = (bearing_rad >= from_rad) & (bearing_rad < from_rad + TURN / SECTORS)
    seen &= rng.random(5) < 0.9
    bearing_rad += radar.bearing_std_rad * rng.standard_normal(5)
    beam = {"radar": number, "from_rad": from_rad, "to_rad": from_rad + TURN / SECTORS}
    return beam | {
        "time_s": end_s,
        "range_m": range_m[seen],
        "bearing_rad": bearing_rad[seen],
        "own": site,
    }


inputs = []  # (time of arrival, call, arguments)
for number, (radar, site, delay_s) in enumerate(zip(RADARS, SITES, DELAYS_S, strict=True)):
    for k in range(int(120.0 / radar.period_s) * SECTORS):
        end_s = (k + 1) * radar.period_s / SECTORS
        from_rad = TURN * (k % SECTORS) / SECTORS
        inputs.append((end_s + delay_s, "sector", sector(number, radar, site, end_s, from_rad)))
for boat in range(3):
    for time_s in np.arange(5.0 + boat, 120.0, 10.0):
        north_m, east_m = START_M[boat] + time_s * VELOCITY_MPS[boat] + rng.normal(0.0, 5.0, 2)
        report = {"time_s": time_s, "north_m": north_m, "east_m": east_m, "position_std_m": 5.0}
        velocity = dict(zip(("vnorth_mps", "veast_mps"), VELOCITY_MPS[boat], strict=True))
        report |= velocity | {"velocity_std_mps": 0.3, "identity": f"25737850{boat}"}
        inputs.append((time_s + 4.0, "report", report))
pointed_m = START_M[4] + 60.0 * VELOCITY_MPS[4]
inputs.append(
    (61.0, "designate", {"time_s": 60.0, "north_m": pointed_m[0], "east_m": pointed_m[1]})
)
inputs.sort(key=lambda one: one[0])

window = wl.LateWindow(RADARS, window_s=8.0)
for _, call, arguments in inputs:
    result = getattr(window, call)(**arguments)
    if call == "designate":
        window.rename(result, "Pilot")
    for event in getattr(result, "events", []):
        if event.kind in ("confirmed", "identified", "lost") and event.track_id > 0:
            print(f"{event.time_s:7.2f} s  track {event.track_id} {event.kind} {event.identity}")

tracks = window.tracks()
print(f"{window.late_inputs} late, {window.too_late_inputs} too late")
for k, (north_m, _, east_m, _) in enumerate(tracks.mean):
    names = f"{tracks.identity[k]} {tracks.name[k]}"
    print(f"track {tracks.track_id[k]} at {north_m:8.1f} N {east_m:8.1f} E  {names}")
