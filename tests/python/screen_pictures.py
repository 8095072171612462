"""Make the pictures of the screen: python tests/python/screen_pictures.py FOLDER [SCENE ...].

Six scenes, each a generator that plays a session and yields when Chromium is to take the picture.
Look at them before they go into cpp/docs/images.
"""

import contextlib
import itertools
import math
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import browser as chromium
import wakeline as wl
from wakeline._engine.video import Cat240Encoder
from wakeline.live import demo
from wakeline.live.config import InputConfig, LiveConfig, RadarConfig
from wakeline.live.playback import Playback, RecordedPlots, SessionPlayback
from wakeline.live.record import Recorder
from wakeline.live.web import WebServer
from wakeline.live.zones import Zone
from wakeline.recording import OwnShipMotion
from wakeline.scenario import RadarSimulator, Truth
from wakeline.scenario.video.examples import strait_scene
from wakeline.tracking import Settings

SIZE = 1280, 800
RADAR = {"range_std_m": 8.0, "bearing_std_deg": 0.3, "period_s": 2.5}  # of the simulated ones
START_S = 1.75e9 - 1.75e9 % 86400.0 + 12_000.0


@contextlib.contextmanager
def shown(player, page, address, time_s, wait_s=3.0):
    """A page that shows a player which has played up to a time."""
    with WebServer(player, port=0) as server:
        player.start()
        try:
            player.command({"command": "replay", "time_s": time_s, "paused": True})
            page.open(f"{server.url}#{address}")
            page.wait_for("wakeline?.store.time_s >= arguments[0] - 0.01", time_s, within_s=60.0)
            time.sleep(wait_s)
            yield
        finally:
            player.close()


def played(episode, radar, page, address, at_s, *, limits=None, **options):
    """The same of the plots of an episode, with limits of danger."""
    settings = Settings.default().knowing(radar)
    player = Playback(RecordedPlots(episode, settings), settings=settings, **options)
    player.command({"command": "limits"} | (limits or {}))
    return shown(player, page, address, player.start_s + at_s)


@contextlib.contextmanager
def recorded(config, messages):
    """A player of a session that has recorded messages: time, name of the input and octets."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "session.pcap"
        recorder = Recorder(path, config.as_document())
        recorder.begin(START_S)
        for time_s, name, octets in messages:
            recorder.data(time_s, name, "udp://127.0.0.1:8600", octets)
        recorder.close()
        yield SessionPlayback(path)


def bundled(name, page, address, at_s):
    """The first episode of a bundled recording."""
    recording = wl.recording.load(name)
    episode = recording.episodes[0]
    with played(episode, recording.radar, page, address, at_s, own=episode.own):
        yield


def joyride(page):
    address = "palette=day&range=926&trailMinutes=3&vectorMinutes=1"
    return bundled("joyride", page, address, 90.0)


def autoferry(page):
    address = "palette=dusk&units=metric&range=200&trailMinutes=1&vectorMinutes=1"
    return bundled("autoferry", page, address, 75.0)


def strait(page):
    """Video of a radar ashore."""
    scene, turns = strait_scene(3), 14
    config = LiveConfig(
        inputs=(InputConfig("udp://127.0.0.1:8600?name=radar video", format="cat240"),),
        radars=(
            RadarConfig(
                "strait",
                position_deg=(55.9, 12.7),
                settings={"period_s": 3.0, "range_std_m": 15.0, "bearing_std_deg": 0.5},
            ),
        ),
    )
    encoder = Cat240Encoder(1, 1)
    parts = (
        turn[first : first + 4]
        for turn in scene.turns(turns, 3)
        for first in range(0, len(turn), 4)
    )
    messages = (
        (START_S + float(part.time_s[-1]), "radar video", demo._encoded(encoder, part, START_S))
        for part in parts
    )
    with recorded(config, messages) as player:
        player.command({"command": "limits", "cpa_limit_m": 40.0, "tcpa_limit_s": 240.0})
        corners = wl.plot.circle_outline([0.0, 0.0], 700.0, 13)[:-1].tolist()
        near = {"name": "", "kind": "exclusion", "outline_m": corners}
        player.command({"command": "zone", "zone": near})
        end_s = START_S + 3.0 * turns
        with shown(player, page, "range=11112&trailMinutes=3&gain=7", end_s, wait_s=10.0):
            yield


def dense(page):
    """An anchorage with a fairway that is watched."""
    rng = np.random.default_rng(2)
    anchored = rng.uniform(-4200.0, 4200.0, (90, 2))
    fairway = np.array([[3300.0, 250.0], [3300.0, 750.0], [-3300.0, -150.0], [-3300.0, -650.0]])
    anchored = anchored[np.abs(anchored[:, 1] - 0.14 * anchored[:, 0] - 50.0) > 500.0]
    truths = {str(k): Truth([n, 0.0, e, 0.0]) for k, (n, e) in enumerate(anchored.tolist())}
    for k, north_m in enumerate((-3000.0, -1200.0, 600.0, 2600.0)):
        speed = 5.0 if k % 2 == 0 else -6.0
        truths[f"lane {k}"] = Truth([north_m, speed, 0.14 * north_m + 50.0, 0.14 * speed])
    for k in range(7):
        place, course = rng.uniform(-3500.0, 3500.0, 2), rng.uniform(0.0, math.tau)
        speed = rng.uniform(3.0, 8.0)
        state = [place[0], speed * math.cos(course), place[1], speed * math.sin(course)]
        truths[f"boat {k}"] = Truth(state)
    radar = RadarSimulator(8.0, math.radians(0.3), 2.5, 0.95, 20.0, 6000.0, rotating=True)
    zone = Zone(name="fairway", kind="guard", outline_m=fairway.tolist(), triggers=("entry",))
    (episode,) = radar.record(truths, 60, 1, name="anchorage").episodes
    limits = {"cpa_limit_m": 100.0, "tcpa_limit_s": 240.0}
    address = "range=5556&vectorMinutes=3"
    with played(episode, RADAR, page, address, 140.0, limits=limits, zones=[zone]):
        yield


def encounter(page):
    """Own ship and vessels that come close, head up; the one that overtakes is named."""
    own = Truth([0.0, 7.0, 0.0, 0.0])
    truths = {
        "overtakes": Truth([-1500.0, 10.5, 900.0, -0.35]),
        "meets": Truth([7200.0, -5.5, 700.0, 0.0]),
        "crosses": Truth([4500.0, 3.0, -4700.0, 6.0]),
        "passes": Truth([6600.0, 0.2, -3600.0, 7.4]),
        "rests": Truth([5200.0, 0.0, 3600.0, 0.0]),
    }
    radar = RadarSimulator(8.0, math.radians(0.3), 2.5, 0.95, 4.0, 12_000.0, rotating=True)
    (episode,) = radar.record(truths, 120, 3, own=own, name="encounter").episodes
    times = np.arange(0.0, 301.0)
    state = own.state_at(times)
    moving = OwnShipMotion(
        time_s=times,
        north_m=state[:, 0],
        east_m=state[:, 2],
        vnorth_mps=state[:, 1],
        veast_mps=state[:, 3],
        heading_rad=np.zeros(len(times)),
    )

    address = "up=head&range=11112&trailMinutes=6"
    with played(episode, RADAR, page, address, 200.0, own=moving):
        south = "[...wakeline.store.tracks.values()].sort((a, b) => a.north - b.north)[0].id"
        page.press(f'#target-rows tr[data-id="{page.run(south)}"]')
        page.type("#card input", "Nordic Star")
        page.press("#card form button")
        page.run("document.activeElement.blur()")
        time.sleep(8.0)  # in which the answer to the name is shown
        yield


def replay(page):
    """The demonstration, recorded and played at night."""
    sent = itertools.takewhile(lambda one: one.at_s <= 110.0, demo.demo_messages(START_S))
    messages = ((START_S + one.at_s, one.input, one.octets) for one in sent)
    with recorded(demo.demo_config("tracks.jsonl"), messages) as player:
        address = "palette=night&range=5556&trailMinutes=3"
        with shown(player, page, address, START_S + 100.0, wait_s=8.0):
            named = "[...wakeline.store.tracks.values()].find((one) => one.identity).id"
            page.press(f'#target-rows tr[data-id="{page.run(named)}"]')
            time.sleep(2.0)
            yield


SCENES = {one.__name__: one for one in (joyride, autoferry, strait, dense, encounter, replay)}


def main(folder, *names):
    driver = chromium.Driver()
    try:
        for name in names or SCENES:
            page = driver.browser(*SIZE)
            try:
                for _ in SCENES[name](page):
                    page.wait_for("performance.now() % 1000 < 200")  # symbols that flash are bold
                    page.save(Path(folder) / f"screen-{name}.png")
            finally:
                page.close()
    finally:
        driver.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
