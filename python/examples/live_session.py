"""A live session without a network: what a radar sends in, tracks and TTM sentences out.

The same octets at the same times give the same tracks, bit for bit: so does a session that is
replayed. Writes live_session.png, the tracks as they were sent.
"""

import json

import numpy as np

import wakeline as wl

recording = wl.recording.load("joyride")
episode = recording.episodes[0]
radar = {key: value for key, value in recording.radar.items() if value}
origin_m = episode.own.position_at(episode.time_s[:1])[0]


def octets(scan):
    """Own ship, plots and the end of a turn as JSON lines."""
    north_m, east_m = episode.own.position_at(np.array([scan.time_s]))[0] - origin_m
    yield {"own": {"time_s": scan.time_s, "north_m": north_m, "east_m": east_m, "heading_rad": 0.0}}
    plots = zip(scan.plot_time_s, scan.range_m, scan.bearing_rad, strict=True)
    for time_s, range_m, bearing_rad in sorted(plots):
        yield {"radar": "A", "time_s": time_s, "range_m": range_m, "bearing_rad": bearing_rad}
    yield {"radar": "A", "sector": {"from_rad": 0.0, "to_rad": 2 * np.pi, "time_s": scan.time_s}}


def play():
    """The session; updates of its tracks and TTM sentences."""
    session = wl.live.Session(
        {"radar": [{"name": "A", **radar}], "session": {"origin_deg": [63.4, 10.4]}}
    )
    updates, sentences = [], []
    session.listeners.append(
        lambda kind, values: updates.append(values) if kind == "track" else None
    )
    session.add_output("udp://127.0.0.1:10111?format=ttm").send = sentences.append
    for scan in episode.scans:
        lines = "".join(f"{json.dumps(line)}\n" for line in octets(scan))
        session.feed(scan.time_s, "radar", lines.encode())
    return session, updates, sentences


session, updates, sentences = play()
print(b"".join(sentences[-2:]).decode().strip())
print(f"{len(updates)} updates of tracks, {len(sentences)} sentences")
print("again the same:", play()[1:] == (updates, sentences))

picture = wl.plot.figure(6.4, 5.0)
axes = wl.plot.dress_map(picture.add_subplot())
for track_id in sorted({one["track_id"] for one in updates}):
    track = [one for one in updates if one["track_id"] == track_id]
    north_km, east_km = (np.array([one[k] for one in track]) / 1e3 for k in ("north_m", "east_m"))
    axes.plot(east_km, north_km, marker=".", linewidth=0.8, label=f"track {track_id}")
wl.plot.save(wl.plot.name_lines(axes).figure, "live_session.png")
