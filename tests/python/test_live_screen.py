"""The screen in a real browser: what is seen at which place, and what a mouse and keys do."""

import json
import math
import time

import numpy as np
import pytest

import browser as chromium
import wakeline as wl
from harbor import ECHOES, RANGE_M, Harbor, recorded_plots
from wakeline.live.web import WebServer, server

pytestmark = pytest.mark.skipif(not chromium.is_there(), reason="needs chromium and chromedriver")

BARE = "rings=0&labels=0&past=0&uncertainty=0&plots=0&vectors=off"


@pytest.fixture(scope="module")
def driver():
    driver = chromium.Driver()
    yield driver
    driver.close()


@pytest.fixture(scope="module")
def page(driver):
    """A browser with WebGL."""
    browser = driver.browser()
    yield browser
    browser.close()


@pytest.fixture(scope="module")
def plain(driver):
    """A browser without WebGL, of a tablet's size."""
    browser = driver.browser(820, 1180, gl=False)
    yield browser
    browser.close()


@pytest.fixture(scope="module")
def served():
    harbor = Harbor()
    with WebServer(harbor, port=0) as server:
        harbor.url = server.url
        yield harbor


@pytest.fixture
def harbor(served):
    served.clear()
    yield served
    served.clear()


def show(page, harbor, settings="", tracks=None, range_m=RANGE_M):
    """Open the page and wait until it has what the session has."""
    page.open(f"{harbor.url}#range={range_m}&{settings}")
    page.run("(() => { localStorage.clear(); return true; })()")
    count = len(harbor.tracks) if tracks is None else tracks
    page.wait_for("window.wakeline?.store.version > 0")
    page.wait_for("wakeline.store.tracks.size === arguments[0]", count)
    page.wait_for("wakeline.spent.frames > 3")
    page.errors()  # of the pages before


def with_echoes(page, harbor, echoes=ECHOES):
    harbor.sweep(echoes)
    page.wait_for("wakeline.echoes.radars === 1")
    settle(page)


def settle(page):
    """Wait for frames that know all messages."""
    page.wait_for("wakeline.spent.frames > arguments[0]", page.run("wakeline.spent.frames") + 4)


def place(page, north_m, east_m):
    """Pixel of a place, from the size of the picture and the settings alone."""
    view = page.run(
        "(() => { const b = document.getElementById('screen').getBoundingClientRect(),"
        " v = wakeline.view; return [b.left + v.middle[0], b.top + v.middle[1], v.radius,"
        " v.range_m]; })()"
    )
    up = page.run("wakeline.settings.up")
    rotation = {"north": 0.0, "head": math.pi / 2}[up]
    bearing, range_m = math.atan2(east_m, north_m) - rotation, math.hypot(north_m, east_m)
    pixels = range_m * view[2] / view[3]
    return view[0] + pixels * math.sin(bearing), view[1] - pixels * math.cos(bearing)


def polar(page, bearing, range_m):
    return place(page, range_m * math.cos(bearing), range_m * math.sin(bearing))


def color(pixels, at, radius=1):
    """Mean color about a place."""
    x, y = (round(v) for v in at)
    return pixels[y - radius : y + radius + 1, x - radius : x + radius + 1].reshape(-1, 3).mean(0)


def is_echo(rgb):
    return rgb[0] > 180 and rgb[1] > 150


def pixels_like(pixels, wanted, at, within):
    """Places [x, y] near a place that have a color."""
    x, y = (round(v) for v in at)
    part = pixels[y - within : y + within + 1, x - within : x + within + 1]
    rows, columns = np.nonzero(np.abs(part - wanted).max(axis=2) < 60)
    return np.column_stack([columns + x - within, rows + y - within])


def check_echoes(page):
    pixels = page.pixels()
    for bearing, range_m in ECHOES:
        assert is_echo(color(pixels, polar(page, bearing, range_m)))
        for other in (bearing + math.pi / 2, bearing + math.pi, -bearing):
            assert not is_echo(color(pixels, polar(page, other, range_m)))
        assert not is_echo(color(pixels, polar(page, bearing, range_m + 150.0)))
        assert not is_echo(color(pixels, polar(page, bearing, range_m - 150.0)))


# What is seen -------------------------------------------------------------------------------------


@pytest.mark.parametrize("up", ["north", "head"])
def test_echoes_are_at_their_places(page, harbor, up):
    show(page, harbor, f"{BARE}&up={up}")
    assert page.run("wakeline.echoes.usesGl")
    with_echoes(page, harbor)
    check_echoes(page)
    assert page.errors() == []


def test_echoes_and_symbols_without_webgl_on_a_tablet(plain, harbor):
    harbor.add(1, 900.0, -900.0)
    show(plain, harbor, BARE)
    assert not plain.run("wakeline.echoes.usesGl")
    with_echoes(plain, harbor)
    check_echoes(plain)
    at = place(plain, 900.0, -900.0)
    found = pixels_like(plain.pixels(), [141, 240, 255], at, 12)
    assert np.abs(found.mean(axis=0) - at).max() < 3.0
    assert plain.run("document.documentElement.scrollWidth") <= 820
    for selector in ("#bar", "#tools", "#alarms", "#targets", "#hint"):
        box = plain.run(
            "(() => { const b = document.querySelector(arguments[0]).getBoundingClientRect();"
            " return [b.left, b.top, b.right, b.bottom]; })()",
            selector,
        )
        assert box[0] >= 0
        assert box[1] >= 0
        assert box[2] <= 820
        assert box[3] <= 1180


@pytest.mark.parametrize("up", ["north", "head"])
def test_a_symbol_is_at_its_place(page, harbor, up):
    places = {1: (1500.0, 700.0), 2: (-1200.0, -400.0), 3: (300.0, -1900.0)}
    for track_id, (north_m, east_m) in places.items():
        harbor.add(track_id, north_m, east_m)
    show(page, harbor, f"{BARE}&up={up}")
    settle(page)
    pixels = page.pixels()
    for north_m, east_m in places.values():
        at = place(page, north_m, east_m)
        found = pixels_like(pixels, [141, 240, 255], at, 12)
        assert len(found) > 15
        assert np.abs(found.mean(axis=0) - at).max() < 3.0


def test_trails_are_true_and_relative(page, harbor):
    """Own ship goes 600 m north past an echo that is fixed to the ground."""
    show(page, harbor, BARE)
    with_echoes(page, harbor, [(math.pi / 2, 1200.0)])
    harbor.own["north_m"] = 600.0
    page.wait_for("wakeline.store.own.north_m === 600")
    bearing, range_m = math.atan2(1200.0, -600.0), math.hypot(1200.0, 600.0)
    with_echoes(page, harbor, [(bearing, range_m)])
    page.wait_for("wakeline.echoes.gap >= 0")
    settle(page)
    old = place(page, 0.0, 1200.0)  # relative to own ship, where the echo was
    now = place(page, -600.0, 1200.0)
    seen = {}
    for trails in ("true", "relative", "off"):
        page.choose("#trails", trails)
        settle(page)
        pixels = page.pixels()
        assert is_echo(color(pixels, now))
        seen[trails] = color(pixels, old)
    assert np.abs(seen["true"] - seen["off"]).max() < 8
    assert seen["relative"][2] > seen["off"][2] + 40


def test_true_motion_keeps_the_ground_and_relative_motion_keeps_own_ship(page, harbor):
    harbor.add(1, 500.0, 500.0)
    show(page, harbor, BARE)
    where = (
        "(() => { const v = wakeline.view, s = wakeline.store; const o = s.ownAt(s.time_s);"
        " return [...v.toScreen(o.north, o.east), ...v.toScreen(500, 500)]; })()"
    )
    for motion, still in (("relative", slice(0, 2)), ("true", slice(2, 4))):
        harbor.own["north_m"] = 0.0
        page.choose("#motion", motion)
        page.wait_for("wakeline.store.own.north_m === 0")
        settle(page)
        before = page.run(where)
        harbor.own["north_m"] = 400.0
        page.wait_for("wakeline.store.own.north_m === 400")
        settle(page)
        after = page.run(where)
        assert before[still] == pytest.approx(after[still], abs=0.5)
        moving = slice(2, 4) if still.start == 0 else slice(0, 2)
        assert abs(before[moving][1] - after[moving][1]) > 20


def test_labels_do_not_overlap(page, harbor):
    rng = np.random.default_rng(4)
    for k in range(1, 101):
        place_m = rng.uniform(-2600.0, 2600.0, 2)
        harbor.add(k, *map(float, place_m), name=f"Vessel {k}" if k % 3 == 0 else "")
    show(page, harbor, "range=3000")
    settle(page)
    boxes = page.run(
        "(() => { const c = document.createElement('canvas').getContext('2d');"
        " c.font = '12px system-ui, \"Segoe UI\", Roboto, sans-serif'; const s = wakeline.store;"
        " return [...wakeline.labels].map(([id, [dx, dy]]) => { const t = s.tracks.get(id);"
        " const [x, y] = wakeline.view.toScreen(t.north, t.east);"
        " const width = c.measureText(t.name || String(id)).width;"
        " return [x + dx, y + dy, x + dx + width, y + dy + 14]; }); })()"
    )
    inside = page.run(
        "[...wakeline.store.tracks.values()].filter((t) => { const v = wakeline.view;"
        " const [x, y] = v.toScreen(t.north, t.east); return x > 0 && y > v.top && x < v.width"
        " && y < v.height - v.bottom; }).length"
    )
    assert len(boxes) >= 0.95 * inside
    for k, a in enumerate(boxes):
        for b in boxes[:k]:
            assert a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]


CONTRASTS = """
(() => {
  const parse = (text) => {
    const v = text.match(/[\\d.]+/g)?.map(Number) ?? [0, 0, 0, 0];
    return [v[0], v[1], v[2], v[3] ?? 1];
  };
  const over = (a, b) => [0, 1, 2].map((k) => a[3] * a[k] + (1 - a[3]) * b[k]).concat(1);
  const ground = (node) => {
    const layers = [];
    for (let n = node; n; n = n.parentElement) {
      const color = parse(getComputedStyle(n).backgroundColor);
      if (color[3] > 0) layers.push(color);
      if (color[3] === 1) break;
    }
    return layers.reduceRight((below, color) => over(color, below), [0, 0, 0, 1]);
  };
  const light = (rgb) => rgb.slice(0, 3).map((v) => v / 255)
    .map((v) => (v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
    .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
  const poor = [];
  for (const node of document.querySelectorAll("body *")) {
    const own = [...node.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
    if (!own || !node.getClientRects().length || node.closest("option")) continue;
    const back = ground(node);
    const color = over(parse(getComputedStyle(node).color), back);
    const [a, b] = [light(color), light(back)].sort((x, y) => y - x);
    const ratio = (a + 0.05) / (b + 0.05);
    if (ratio < 4.5) poor.push([node.className, node.textContent.slice(0, 30), ratio]);
  }
  return poor;
})()
"""


def test_text_has_contrast_by_day_dusk_and_night(page, harbor):
    harbor.add(1, 800.0, 0.0, -6.0, 0.0)
    harbor.add(2, -800.0, 900.0)
    harbor.board.alarms.set_zone({"name": "gate", "far_m": 1000.0})
    show(page, harbor)
    page.wait_for("document.querySelectorAll('#alarm-list li').length > 0")
    page.run("(document.querySelector('#settings-open').click(), true)")
    for palette in ("day", "dusk", "night"):
        page.choose("#palette", palette)
        settle(page)
        assert page.run(CONTRASTS) == []
        colors = page.run(
            "(async () => Object.values((await import('/static/palette.js')).PALETTES).map((p) =>"
            " [p.background, p.label, p.target, p.danger, p.ais, p.muted, p.lost, p.zone,"
            " p.exclusion, p.measure]))()"
        )
    for background, *inks in colors:
        for ink in inks:
            assert contrast(ink, background) >= 4.5, (ink, background)


def contrast(a, b):
    def light(color):
        v = np.array([int(color[k : k + 2], 16) for k in (1, 3, 5)]) / 255
        return np.where(v <= 0.03928, v / 12.92, ((v + 0.055) / 1.055) ** 2.4) @ [
            0.2126, 0.7152, 0.0722,
        ]  # fmt: skip

    high, low = sorted([light(a), light(b)], reverse=True)
    return (high + 0.05) / (low + 0.05)


# What a hand does ---------------------------------------------------------------------------------


def test_a_click_acquires_names_and_cancels(page, harbor):
    show(page, harbor)
    with_echoes(page, harbor)
    at = polar(page, *ECHOES[1])
    page.click(*at)
    page.press("#card .acquire")
    page.wait_for("wakeline.store.tracks.size === 1 && wakeline.selected === 1")
    (command,) = harbor.commands
    bearing, range_m = ECHOES[1]
    assert command["north_m"] == pytest.approx(range_m * math.cos(bearing), abs=12.0)
    assert command["east_m"] == pytest.approx(range_m * math.sin(bearing), abs=12.0)
    page.wait_for("!document.querySelector('#card').hidden")
    page.type("#card input", "Nordic Star")
    page.press("#card form button")
    page.wait_for("document.querySelector('#target-rows th')?.textContent === 'Nordic Star'")
    assert harbor.tracks[1]["name"] == "Nordic Star"
    page.press("#card .drop")
    page.wait_for("wakeline.store.tracks.size === 0")
    assert harbor.tracks == {}


def test_keys_acquire_and_select(page, harbor):
    harbor.add(1, 0.0, 0.0)
    show(page, harbor)
    page.run("(document.querySelector('#overlay').focus(), true)")
    page.keys("Right", "Right", "a")
    page.wait_for("wakeline.store.tracks.size === 2")
    assert harbor.commands[-1]["east_m"] > 10.0
    page.keys("Escape", "h")
    page.wait_for("wakeline.settings.up === 'head' && wakeline.selected === null")
    page.keys("+")
    page.wait_for("wakeline.view.range_m < arguments[0]", RANGE_M)


@pytest.mark.parametrize("kind", ["mouse", "touch"])
def test_a_zone_that_is_drawn_alarms(page, harbor, kind):
    harbor.add(5, 1000.0, 1000.0)
    show(page, harbor)
    page.press("[data-tool=guard]")
    page.drag(place(page, 1300.0, 700.0), place(page, 700.0, 1300.0), kind=kind)
    page.wait_for("document.querySelectorAll('#alarm-list .alarm.active').length === 1")
    (zone,) = harbor.board.alarms.zones
    low, high = zone.outline_m.min(axis=0), zone.outline_m.max(axis=0)
    assert low == pytest.approx([700.0, 700.0], abs=12.0)
    assert high == pytest.approx([1300.0, 1300.0], abs=12.0)
    page.press("#alarm-list .acknowledge")
    page.wait_for("document.querySelectorAll('#alarm-list .acknowledged').length === 1")
    assert harbor.board.alarms.active[0].acknowledged
    harbor.tracks[5]["north_m"] = -1000.0
    page.wait_for("document.querySelectorAll('#alarm-list .ended').length === 1")
    harbor.tracks[5]["north_m"] = 1000.0
    page.wait_for("document.querySelectorAll('#alarm-list .alarm.active').length === 1")
    page.press("#zone-list button:last-child")
    page.wait_for("wakeline.store.zones.length === 0")


def test_a_sector_is_drawn_about_own_ship(page, harbor):
    show(page, harbor)
    page.press("[data-tool=sector]")
    page.drag(polar(page, 0.2, 800.0), polar(page, 1.1, 1900.0))
    page.wait_for("wakeline.store.zones.length === 1")
    (zone,) = harbor.board.alarms.zones
    assert zone.from_bow
    heading = harbor.own["heading_rad"]
    assert zone.near_m == pytest.approx(800.0, abs=12.0)
    assert zone.far_m == pytest.approx(1900.0, abs=12.0)
    assert zone.from_rad + heading == pytest.approx(0.2, abs=0.02)
    assert zone.to_rad + heading == pytest.approx(1.1, abs=0.02)


def test_a_drag_moves_the_picture_and_measures(page, harbor):
    show(page, harbor)
    page.drag(polar(page, 1.0, 500.0), polar(page, 1.0, 1500.0))
    settle(page)
    shown = page.run("wakeline.view.toScreen(0, 0)")
    box = page.run("wakeline.view.middle")
    moved_m = math.hypot(shown[0] - box[0], shown[1] - box[1]) / page.run("wakeline.view.scale")
    assert moved_m == pytest.approx(1000.0, abs=15.0)
    page.press("#center")
    page.wait_for("Math.hypot(...wakeline.view.offset) === 0")
    settle(page)
    page.press("[data-tool=measure]")
    page.drag(polar(page, 0.0, 0.0), polar(page, 2.0, 1400.0))
    (line,) = page.run("wakeline.tools.measures")
    assert line["bearing"] == pytest.approx(2.0, abs=0.02)
    assert line["range_m"] == pytest.approx(1400.0, abs=15.0)


def test_the_table_is_sorted_by_danger(page, harbor):
    danger = {"cpa_m": 100.0, "tcpa_s": 300.0, "probability": 0.9}
    near = {"cpa_m": 2000.0, "tcpa_s": 100.0, "probability": 0.05}
    past = {"cpa_m": 10.0, "tcpa_s": -50.0, "probability": 0.0}
    far = {"cpa_m": 5000.0, "tcpa_s": 100.0, "probability": 0.0}
    harbor.add(1, 300.0, 100.0, cpa=past)
    harbor.add(2, 9000.0, 5000.0, cpa=far)
    harbor.add(3, 2100.0, 100.0, -6.0, 0.0, cpa=danger)  # on its way to own ship
    harbor.add(4, 2000.0, 1000.0, cpa=near)
    show(page, harbor)
    page.wait_for("document.querySelectorAll('#target-rows tr').length === 4")
    order = page.wait_for(
        "((rows) => rows[0] === '3' && rows)"
        "([...document.querySelectorAll('#target-rows tr')].map((row) => row.dataset.id))"
    )
    assert order == ["3", "4", "2", "1"]
    first = page.run("document.querySelector('#target-rows tr').className")
    assert "danger" in first
    page.press("#target-rows tr")
    page.wait_for("wakeline.selected === 3")


def test_names_are_texts(page, harbor):
    evil = "<img src=x onerror='window.hacked=1'>"
    harbor.add(1, 500.0, 0.0, name=evil[:31])
    harbor.ais.append(
        {"mmsi": 1, "name": evil, "north_m": 900.0, "east_m": 0.0, "age_s": 0.0}
    )  # fmt: skip
    harbor.board.alarms.set_zone({"name": evil, "far_m": 1000.0})
    show(page, harbor)
    page.wait_for("document.querySelectorAll('#alarm-list li').length === 1")
    page.press("#target-rows tr")
    page.wait_for("!document.querySelector('#card').hidden")
    assert page.run("document.querySelectorAll('img, svg, script:not([src])').length") == 0
    assert page.run("window.hacked === undefined")
    assert page.run("document.querySelector('#zone-list strong').textContent") == evil


def test_two_pages_see_the_same(page, plain, harbor):
    harbor.add(1, 800.0, 300.0)
    show(page, harbor)
    show(plain, harbor)
    page.press("#target-rows tr")
    page.wait_for("!document.querySelector('#card').hidden")
    page.type("#card input", "Two")
    page.press("#card form button")
    for one in (page, plain):
        one.wait_for("document.querySelector('#target-rows th')?.textContent === 'Two'")


def test_a_page_is_back_when_the_server_is(page):
    harbor = Harbor()
    harbor.add(1, 800.0, 300.0)
    with WebServer(harbor, port=0) as server:
        harbor.url, port = server.url, server.app.port
        show(page, harbor)
    page.wait_for("!document.querySelector('#link').hidden")
    assert "old" in page.run("document.querySelector('#link').textContent")
    harbor.add(2, -800.0, 300.0)
    time.sleep(2.0)  # in which a page that waits longer after each failure would lose its patience
    with WebServer(harbor, port=port):
        began_s = time.monotonic()
        page.wait_for("wakeline.store.tracks.size === 2")
        assert time.monotonic() - began_s < 1.5  # with what asking the browser takes
        page.wait_for("document.querySelector('#link').hidden")


@pytest.mark.parametrize(("busy_s", "words"), [(0.5, "busy"), (1e9, "No connection")])
def test_a_page_says_that_its_picture_is_old(page, monkeypatch, busy_s, words):
    """The server waits for the session, and says so or says nothing."""
    monkeypatch.setattr(server, "_BUSY_S", busy_s)
    harbor = Harbor()
    harbor.add(1, 800.0, 300.0)
    with WebServer(harbor, port=0) as serving:
        harbor.url = serving.url
        show(page, harbor)
        with harbor.lock:
            page.wait_for("!document.querySelector('#link').hidden")
            assert words in page.run("document.querySelector('#link').textContent")
        page.wait_for("document.querySelector('#link').hidden")
        monkeypatch.setattr(server, "_LATE_S", -1.0)  # now every command is too late
        page.click(*place(page, 800.0, 300.0))
        page.press("#card .drop")
        page.wait_for("document.querySelector('#hint').textContent.includes('too late')")
        assert harbor.commands == []


def test_a_limit_that_is_none_is_answered_and_put_back(page, harbor):
    harbor.add(1, 800.0, 300.0)
    show(page, harbor)
    before = harbor.board.alarms.limits
    page.press("#settings-open")
    change = "((i) => { i.value = arguments[0]; i.dispatchEvent(new Event('change')); })"
    for text in ("", "0", "-1"):
        page.run(f"{change}(document.querySelector('#cpa-limit'))", text)
        page.wait_for("document.querySelector('#limit-answer').textContent.includes('cpa_limit_m')")
        page.wait_for("Number(document.querySelector('#cpa-limit').value) > 0")
    page.run("document.querySelector('#settings').close()")
    assert harbor.board.alarms.limits == before


# A replay -----------------------------------------------------------------------------------------


def test_a_replay_is_set_and_stopped(page):
    episode = wl.recording.load("joyride").episodes[0]
    playback = recorded_plots()
    with WebServer(playback, port=0) as server:
        playback.start()
        try:
            page.open(server.url)
            page.errors()
            page.wait_for("!document.querySelector('#replay')?.hidden")
            page.press("#play")
            page.wait_for("wakeline.store.replay.paused")
            wanted_s = episode.time_s[60]
            page.choose("#scrub", wanted_s)
            page.wait_for("Math.abs(wakeline.store.time_s - arguments[0]) < 0.01", wanted_s)
            (track,) = playback.picture()["tracks"]
            page.wait_for("wakeline.store.tracks.size === 1")
            north_m = page.run("[...wakeline.store.tracks.values()][0].north")
            assert north_m == pytest.approx(track["north_m"], abs=0.1)
            settle(page)
            drawn = page.run(
                "(() => { const c = document.querySelector('#overlay');"
                " const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
                " let n = 0; for (let k = 3; k < d.length; k += 4) n += d[k] > 0; return n; })()"
            )
            assert drawn > 2000
            page.choose("#scrub", episode.time_s[10])
            page.wait_for("wakeline.store.time_s < arguments[0]", wanted_s - 60.0)
            assert json.loads(json.dumps(page.errors())) == []
        finally:
            playback.close()
