"""Figures: what is drawn is where and when it is, and the house rules of the axes hold."""

import pickle
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from wakeline import metrics, recording
from wakeline.recording import Episode, OwnShipMotion, Recording, TargetTruth, Tracks
from wakeline.scenario import RadarSimulator, RadarVideoSimulator, Truth

pytest.importorskip("matplotlib")

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex, to_rgb
from matplotlib.quiver import Quiver, QuiverKey

from wakeline import plot
from wakeline._units import KNOT_MPS


@pytest.fixture(scope="module")
def episode():
    return recording.load("autoferry").episodes[0]


@pytest.fixture(scope="module")
def tracks(episode):
    """The truth itself as tracks, with what a multiple-model tracker adds."""
    parts = []
    for name, truth in episode.truth.items():
        state = truth.state_at(episode.time_s)
        known = np.isfinite(state).all(axis=1)
        n = np.count_nonzero(known)
        rng = np.random.default_rng(n)
        parts.append(
            Tracks(
                [f"T{name}"] * n,
                episode.time_s[known],
                state[known],
                covariance=np.broadcast_to(np.diag([9.0, 1.0, 4.0, 1.0]), (n, 4, 4)),
                mode_probability=rng.dirichlet(np.ones(3), n),
                nis=np.where(np.arange(n) == 3, 99.0, rng.chisquare(2, n)),
            )
        )
    return Tracks.joined(parts)


def texts(ax):
    return [text.get_text() for text in ax.texts]


def test_the_map_has_north_up_and_equal_axes(episode, tracks):
    ax = plot.figure().add_subplot()
    assert plot.map_view(ax, episode, tracks) is ax
    assert ax.get_aspect() == 1.0
    assert ax.get_xlabel() == "east (m)"
    assert ax.get_ylabel() == "north (m)"
    np.testing.assert_allclose(np.diff(ax.get_xticks())[0], np.diff(ax.get_yticks())[0])


def test_tracks_lie_where_they_are_and_carry_their_ids(episode, tracks):
    ax = plot.map(tracks, episode).axes[0]
    one = tracks.where(tracks.track_id == "T1")
    drawn = [line.get_xydata() for line in ax.lines]
    assert any(np.array_equal(d, np.column_stack([one.east_m, one.north_m])) for d in drawn)
    assert {"T1", "T2"} <= set(texts(ax))
    for end in ax.texts[:2]:
        low, high = np.array([ax.get_xlim(), ax.get_ylim()]).T
        assert (low <= end.xy).all()
        assert (end.xy <= high).all()


def test_rows_that_are_not_known_are_not_in_the_window_of_the_map():
    state = np.array([[0.0, 1.0, 0.0, 1.0], [np.nan] * 4, [100.0, 1.0, 50.0, 1.0]])
    (ax,) = plot.map(Tracks(["1"] * 3, np.arange(3.0), state)).axes
    low, high = ax.get_ylim()
    assert low < 0.0
    assert high > 100.0
    plot.map(Tracks(["1"], [0.0], state[1:2]))


def test_the_map_shows_records_of_own_ship_and_truth_for_the_time_of_the_scans(episode):
    start_s, end_s = episode.time_s[[0, -1]]
    time_s = np.arange(start_s - 36000.0, end_s + 36000.0)
    way_m = (5.0 * (time_s - start_s), 0.0 * time_s)
    unknown = np.full(len(time_s), np.nan)
    longer = replace(
        episode,
        own=OwnShipMotion(time_s, *way_m),
        truth={"1": TargetTruth(time_s, *way_m, unknown, unknown)},
    )
    ax = plot.map(None, longer).axes[0]
    shown = {line.get_label(): line.get_ydata() for line in ax.lines}
    assert np.ptp(shown["truth"]) == pytest.approx(5.0 * (end_s - start_s), abs=10.0)
    np.testing.assert_allclose(shown["own ship"], [5.0 * (end_s - start_s)])
    assert ax.get_ylim()[1] - ax.get_ylim()[0] < 2.0 * 5.0 * (end_s - start_s)


def test_a_vessel_at_rest_is_seen_with_her_ellipse():
    states = np.column_stack([np.linspace(500.0, 502.0, 10), *np.zeros((3, 10))])
    covariance = np.broadcast_to(np.diag([100.0, 1.0, 400.0, 1.0]), (10, 4, 4))
    for rows in (10, 1):
        track = Tracks(["1"] * rows, np.arange(rows), states[:rows], covariance=covariance[:rows])
        ax = plot.map(track).axes[0]
        (west, east), (south, north) = ax.get_xlim(), ax.get_ylim()
        for ellipse in ax.collections[0].get_paths():
            assert (ellipse.vertices > [west, south]).all()
            assert (ellipse.vertices < [east, north]).all()


def test_every_kind_of_mark_is_explained_once(episode, tracks):
    legend = plot.map(tracks, episode).axes[0].get_legend()
    names = sorted(text.get_text() for text in legend.get_texts())
    assert names == ["95 % ellipse", "own ship", "plot", "track", "truth"]


def test_plots_out_of_sight_are_counted_and_shown_on_request(episode, tracks):
    ax = plot.map(tracks, episode).axes[0]
    (note,) = [text for text in texts(ax) if "outside" in text]
    (west, east), (south, north) = ax.get_xlim(), ax.get_ylim()
    places = np.concatenate([scan.position_m for scan in episode.scans])
    inside = (places >= [south, west]).all(axis=1) & (places <= [north, east]).all(axis=1)
    assert note == f"{np.count_nonzero(~inside)} of {len(places)} plots outside"
    whole = plot.map(tracks, episode, whole=True).axes[0]
    assert not [text for text in texts(whole) if "outside" in text]


@pytest.mark.parametrize("whole", [True, False])
def test_own_ship_is_in_sight_whatever_else_is(episode, tracks, whole):
    away = replace(episode, own=OwnShipMotion.fixed(-20_000.0, 3_000.0), truth=None)
    for shown in (tracks, None):
        ax = plot.map(shown, away, whole=whole).axes[0]
        assert ax.get_ylim()[0] < -20_000.0 < ax.get_ylim()[1]
        assert ax.get_xlim()[0] < 3_000.0 < ax.get_xlim()[1]


def crowd(count, side_m, seed):
    """Tracks of five scans in a square, of which the first comes closest to own ship."""
    rng = np.random.default_rng(seed)
    state = np.zeros((count, 5, 4))
    velocity_mps = rng.normal(size=(count, 1, 2))
    steps = velocity_mps * np.arange(5.0)[:, None]
    state[..., ::2] = rng.uniform(0.0, side_m, (count, 1, 2)) + steps
    state[..., 1::2] = velocity_mps
    ids = np.repeat(np.arange(1, count + 1), 5).astype(str)
    cpa_m = np.repeat(np.arange(1.0, count + 1.0), 5)
    when_s = np.tile(np.arange(5.0), count)
    return Tracks(ids, when_s, state.reshape(-1, 4), cpa_m=cpa_m, tcpa_s=np.full(5 * count, 90.0))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("count", [1, 2, 15])
@pytest.mark.parametrize("side_m", [0.0, 100.0, 1000.0])
def test_labels_of_danger_cover_no_other_text_and_stay_within_the_axes(count, side_m, seed):
    tracks = crowd(count, side_m, seed)
    fig = plot.map(replace(tracks, alarmed=np.ones(len(tracks), dtype=bool)))
    fig.draw_without_rendering()
    (ax,) = fig.axes
    ids = [text.get_window_extent() for text in ax.texts if "CPA" not in text.get_text()]
    shown = [text for text in ax.texts if "CPA" in text.get_text() and text.get_visible()]
    boxes = [text.get_window_extent() for text in shown]
    window = ax.get_window_extent()
    for k, box in enumerate(boxes):
        assert not box.count_overlaps(boxes[:k] + ids)
        assert window.x0 <= box.x0 < box.x1 <= window.x1
        assert window.y0 <= box.y0 < box.y1 <= window.y1
    assert "1: CPA 1 m in 1.5 min" in [text.get_text() for text in shown]


@pytest.mark.parametrize("count", [1, 15, 60])
@pytest.mark.parametrize("side_m", [0.0, 1000.0, 1e5])
def test_ids_of_tracks_cover_none_of_longer_ones(count, side_m):
    tracks = crowd(count, side_m, seed=1)
    last = tracks.track_id == str(count)
    tracks = tracks.where(last | (tracks.time_s > 0.0))  # the last is the longest
    turn = RadarVideoSimulator(sweeps_per_turn=600, cells=100, cell_m=10.0).turn()
    ppi = plot.figure().subplots()
    plot.ppi(turn, ppi, tracks=tracks)
    for ax in (plot.map(tracks).axes[0], ppi):
        ax.figure.draw_without_rendering()
        ids = [text for text in ax.texts if text.get_text() in tracks.ids()]
        assert len(ids) == count
        shown = [text for text in ids if text.get_visible()]
        boxes = [text.get_window_extent() for text in shown]
        assert not any(box.count_overlaps(boxes[:k]) for k, box in enumerate(boxes))
        assert str(count) in [text.get_text() for text in shown]
        assert len(shown) == 1 if side_m == 0.0 and ax is ppi else len(shown) >= 1


def test_a_dangerous_track_is_red_and_has_its_own_colour(monkeypatch):
    monkeypatch.setattr("wakeline.plot.style._DOTS_PER_IN", 160)  # a line of a dot is blurred
    state = np.column_stack([np.zeros(9), np.zeros(9), 10.0 * np.arange(9), np.full(9, 10.0)])
    tracks = Tracks(["1"] * 9, np.arange(9.0), state)
    fig = plot.map(replace(tracks, alarmed=np.ones(9, dtype=bool)))
    canvas = FigureCanvasAgg(fig)
    canvas.draw()
    image = np.asarray(canvas.buffer_rgba())[::-1, :, :3] / 255.0
    column, row = fig.axes[0].transData.transform((45.0, 0.0)).round().astype(int)
    across = image[row - 20 : row + 20, column]
    for color in (plot.PALETTE[0], "#E00000"):
        assert np.isclose(across, to_rgb(color), atol=0.02).all(axis=1).any()


def test_danger_is_cut_where_its_track_is():
    when_s = np.array([0.0, 1.0, 2.0, 30.0, 31.0])
    tracks = Tracks(["1"] * 5, when_s, np.ones((5, 4)))
    ax = plot.map(replace(tracks, alarmed=np.ones(5, dtype=bool))).axes[0]
    cuts = [np.isnan(line.get_xdata()).tolist() for line in ax.lines if len(line.get_xdata()) > 1]
    assert cuts == [[False, False, False, True, False, False]] * 2


def test_an_ellipse_holds_what_it_says():
    rng = np.random.default_rng(1)
    root = np.array([[30.0, 0.0], [20.0, 5.0]])
    covariance, mean = root @ root.T, np.array([5.0, -7.0])
    outline = plot.ellipse_outline(mean, covariance)
    bound = metrics.nees(outline - mean, np.broadcast_to(covariance, (len(outline), 2, 2)))
    np.testing.assert_allclose(bound, 5.991464547107979)
    error = rng.standard_normal((40_000, 2)) @ root.T
    inside = metrics.nees(error, np.broadcast_to(covariance, (40_000, 2, 2))) < bound[0]
    assert inside.mean() == pytest.approx(0.95, abs=0.005)


def test_panels_share_the_time_from_the_first_scan(episode, tracks):
    fig = plot.figure()
    axes = plot.time_view(fig, episode, tracks, mode_names=["straight", "port", "starboard"])
    labels = [ax.get_ylabel().split("\n")[0] for ax in axes]
    assert labels == ["speed (m/s)", "course (°)", "NIS", "mode probability"]
    assert axes[-1].get_xlabel() == "time from start (s)"
    assert len({ax.get_xlim() for ax in axes}) == 1
    low, high = axes[0].get_xlim()
    assert low <= 0.0
    assert high >= episode.time_s[-1] - episode.time_s[0]


def test_of_many_tracks_the_longest_are_drawn(episode):
    rows = [str(k) for k in range(1, 13) for _ in range(k)]
    when = np.concatenate([episode.time_s[:k] for k in range(1, 13)])
    speed, course = plot.time_view(
        plot.figure(), episode, Tracks(rows, when, np.ones((len(rows), 4)))
    )
    named = {line.get_label() for line in speed.lines} - {"truth"}
    assert {f"track {k}" for k in range(3, 13)} == {n for n in named if n.startswith("track")}
    assert course.get_xlabel() == "time from start (s), the 10 longest of 12 tracks"


def test_many_tracks_have_over_time_the_colours_of_the_map_and_can_be_distinguished():
    rows = [str(k) for k in (5, 1, 12, 11, 2, 9, 3, 10, 4, 8, 6, 7) for _ in range(k)]
    tracks = Tracks(rows, np.arange(float(len(rows))), np.ones((len(rows), 4)))
    speed, course = plot.time_view(plot.figure(), None, tracks)
    colors = {line.get_label().removeprefix("track "): line.get_color() for line in speed.lines}
    assert len(set(colors.values())) == 10
    assert [line.get_color() for line in course.lines] == list(colors.values())
    (ax,) = plot.map(tracks).axes
    on_map = {text.get_text(): text.get_color() for text in ax.texts}
    assert colors.items() <= on_map.items()


@pytest.mark.parametrize("number", ["1", "1234", "23500747"])
def test_names_of_tracks_leave_the_panels_their_room(number):
    rows = [f"{number}{k}" for k in range(10) for _ in range(3)]
    tracks = Tracks(rows, np.tile(np.arange(3.0), 10), np.ones((30, 4)))
    fig = plot.time_figure(None, tracks)
    FigureCanvasAgg(fig).draw()
    assert fig.axes[0].get_position().width > 0.8


def test_panels_follow_what_the_tracks_have(episode):
    plain = Tracks(["1", "1"], episode.time_s[:2], np.ones((2, 4)))
    assert len(plot.time_view(plot.figure(), episode, plain)) == 2
    assert len(plot.time_view(plot.figure(), episode)) == 2


def test_course_lines_are_cut_at_north():
    course = np.radians([350.0, 358.0, 4.0, 10.0, 355.0])
    state = np.column_stack([course * 0, np.cos(course), course * 0, np.sin(course)])
    ax = plot.figure().add_subplot()
    plot.course_panel(ax, Tracks(["1"] * 5, np.arange(5.0), state))
    (line,) = ax.lines
    drawn = line.get_ydata()
    steps = np.abs(np.diff(drawn))
    assert np.isnan(drawn).sum() == 2
    assert (steps[np.isfinite(steps)] < 180.0).all()


def northerly(drawn):
    """Whether a line shows all of a course that goes from 2 degrees one side of north to 2 the
    other in every step, as far as 10."""
    x, y = drawn.get_xdata(), drawn.get_ydata()
    step = np.isfinite(np.diff(y))
    return np.diff(x)[step].sum() == pytest.approx(9.0) and np.abs(np.diff(y)[step]).max() < 4.0


def test_a_course_about_north_is_drawn_all_along():
    course_deg = np.tile([358.0, 2.0], 5)
    course = np.radians(course_deg)
    state = np.column_stack([course * 0, np.cos(course), course * 0, np.sin(course)])
    ax, own = plot.figure().subplots(2, 1)
    plot.course_panel(ax, Tracks(["1"] * 10, np.arange(10.0), state))
    plot.course_over_time(own, 60.0 * np.arange(10.0), course, -course)
    assert [northerly(line) for line in (*ax.lines, *own.lines)] == [True] * 3
    assert np.nanmin(ax.lines[0].get_ydata()) == 0.0
    assert np.nanmax(ax.lines[0].get_ydata()) == 360.0


def test_a_course_a_hair_west_of_north_is_north():
    ax = plot.figure().add_subplot()
    plot.course_over_time(ax, np.arange(3.0), np.array([0.0, -1e-20, 0.0]), np.zeros(3))
    assert ax.lines[0].get_ydata().tolist() == [0.0, 0.0, 0.0]


def dots(line):
    assert line.get_marker() == "."
    return line.get_xydata()[line.get_markevery()].tolist()


def test_rows_alone_between_gaps_are_seen():
    when_s = np.array([0.0, 3.0, 6.0, 100.0, 200.0, 203.0])
    states = np.column_stack([5.0 * when_s, np.full(6, 3.0), np.zeros(6), np.full(6, 4.0)])
    for rows in (slice(None), slice(3, 4)):
        track = Tracks(["1"] * len(when_s[rows]), when_s[rows], states[rows])
        speed, course, place = plot.figure().subplots(3, 1)
        assert dots(plot.speed_panel(speed, track).lines[0]) == [[100.0, 5.0]]
        assert dots(plot.course_panel(course, track).lines[0])[0][0] == 100.0
        assert dots(plot.map_view(place, None, track).lines[0]) == [[0.0, 500.0]]


def test_nis_has_its_bound_and_hides_nothing(tracks):
    ax = plot.figure().add_subplot()
    plot.nis_panel(ax, tracks)
    assert "95 %: 5.99" in texts(ax)
    shown = np.concatenate([group.get_offsets() for group in ax.collections])
    assert len(shown) == len(tracks)
    assert shown[:, 1].max() <= ax.get_ylim()[1]


def test_mode_probabilities_are_cut_where_a_track_has_a_gap():
    when_s = np.concatenate([np.arange(5.0), 50.0 + np.arange(5.0)])
    modes = np.tile([0.2, 0.5, 0.3], (10, 1))
    ax = plot.figure().add_subplot()
    plot.mode_panel(ax, Tracks(["1"] * 10, when_s, np.ones((10, 4)), mode_probability=modes), "1")
    spans = [
        path.get_extents().intervalx.tolist() for b in ax.collections for path in b.get_paths()
    ]
    assert spans == [[0.0, 4.0]] * 3 + [[50.0, 54.0]] * 3
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert names == ["mode 1", "mode 2", "mode 3"]


def test_mode_names_must_be_as_many_as_modes(tracks):
    with pytest.raises(ValueError, match="3 names, got 1"):
        plot.mode_panel(plot.figure().add_subplot(), tracks, "T1", mode_names=["one"])


def test_arrows_of_current_are_whole_and_have_a_scale():
    ax = plot.figure().add_subplot()
    way_m = np.column_stack([np.zeros(50), np.linspace(0.0, 5000.0, 50)])
    plot.own_map(ax, way_m, way_m, np.tile([0.6 * KNOT_MPS, 0.8 * KNOT_MPS], (50, 1)))
    ax.figure.draw_without_rendering()
    (arrows,) = [one for one in ax.collections if isinstance(one, Quiver)]
    length_km = np.hypot(arrows.U, arrows.V) / arrows.scale
    np.testing.assert_allclose(length_km, 0.5)
    tips = arrows.get_offsets() + np.column_stack([arrows.U, arrows.V]) / arrows.scale
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    assert tips[:, 0].min() > left
    assert tips[:, 0].max() < right
    assert tips[:, 1].min() > bottom
    assert tips[:, 1].max() < top
    (key,) = [one for one in ax.artists if isinstance(one, QuiverKey)]
    assert (key.U, key.text.get_text()) == (1.0, "current of 1 kn")


def test_a_row_without_a_place_takes_no_arrows_from_the_others():
    way_m = np.column_stack([np.zeros(50), np.linspace(0.0, 5000.0, 50)])
    current_mps = np.full((50, 2), 0.3)
    way_m[7], current_mps[9, 1] = np.nan, np.nan
    ax = plot.figure().add_subplot()
    plot.own_map(ax, way_m, way_m, current_mps)
    (arrows,) = [one for one in ax.collections if isinstance(one, Quiver)]
    assert np.isfinite(arrows.get_offsets()).all()
    assert np.isfinite(arrows.scale)


def test_no_line_over_time_is_drawn_across_a_gap_and_what_stands_alone_is_seen():
    when_s = np.array([0.0, 60.0, 120.0, 6000.0, 12000.0, 12060.0])
    ones = np.ones(6)
    panels = plot.figure().subplots(3, 1)
    plot.speed_over_time(panels[0], when_s, ones, ones)
    plot.course_over_time(panels[1], when_s, ones, ones)
    plot.drift_over_time(panels[2], when_s, np.ones((6, 2)), when_s[:0])
    for line in [*panels[0].lines, *panels[1].lines, panels[2].lines[0]]:
        minutes, values = line.get_xydata().T
        steps_min = np.diff(minutes)[np.isfinite(np.diff(values))]
        np.testing.assert_allclose(steps_min, 1.0)
        ((alone_min, _),) = dots(line)
        assert alone_min == 100.0


@pytest.mark.parametrize("current_mps", [None, np.full((3, 2), np.nan), np.zeros((3, 2))])
def test_a_map_without_a_current_has_no_arrows(current_mps):
    ax = plot.figure().add_subplot()
    plot.own_map(ax, np.eye(3)[:, :2], np.eye(3)[:, :2], current_mps)
    assert not any(isinstance(one, Quiver) for one in ax.collections)


def test_parts_of_own_ships_way_that_are_in_doubt_are_drawn_and_named():
    way_m = np.column_stack([np.arange(6.0), np.zeros(6)])
    coasting = np.array([False, True, True, False, False, False])
    ax = plot.figure().add_subplot()
    plot.own_map(ax, way_m, way_m, coasting=coasting, jumped=coasting[::-1])
    drawn = {line.get_label(): np.isfinite(line.get_xdata()) for line in ax.lines}
    np.testing.assert_array_equal(drawn["without fixes"], coasting)
    np.testing.assert_array_equal(drawn["after a jump"], coasting[::-1])
    ax = plot.figure().add_subplot()
    plot.own_map(ax, way_m, way_m, coasting=np.zeros(6, bool), jumped=np.zeros(6, bool))
    assert [line.get_label() for line in ax.lines] == ["fixes", "own ship"]


def test_a_single_row_in_doubt_is_seen():
    ax = plot.figure().add_subplot()
    plot.own_map(ax, 1e3 * np.eye(3)[:, :2], np.eye(3)[:, :2], coasting=np.arange(3) == 1)
    assert dots(ax.lines[-1]) == [[1.0, 0.0]]


def test_a_steady_speed_lies_clear_of_the_edge():
    when_s = np.arange(60.0)
    wobble = 1e-4 * np.sin(when_s)
    states = np.column_stack([6.0 * when_s, 6.0 + wobble, np.zeros(60), np.zeros(60)])
    panel, own = plot.figure().subplots(2, 1)
    plot.speed_panel(panel, Tracks(["1"] * 60, when_s, states))
    plot.speed_over_time(own, when_s, (6.0 + wobble) * KNOT_MPS, np.full(60, np.nan))
    for ax in (panel, own):
        assert ax.get_ylim()[0] == 0.0
        assert 6.3 < ax.get_ylim()[1] < 7.0


def test_lines_of_what_is_not_known_are_not_named():
    speed, course, drift = plot.figure().subplots(3, 1)
    when_s, unknown = np.arange(3.0), np.full(3, np.nan)
    plot.speed_over_time(speed, when_s, np.ones(3), unknown)
    plot.course_over_time(course, when_s, np.ones(3), unknown)
    plot.drift_over_time(drift, when_s, np.full((3, 2), np.nan), when_s)
    named = [[text.get_text() for text in ax.get_legend().get_texts()] for ax in drift.figure.axes]
    assert named == [["over ground"], ["course over ground"], ["fixes"]]


def test_panels_of_own_ship_are_drawn_even_of_nothing():
    none, pairs = np.zeros(0), np.zeros((0, 2))
    speed, course, drift, way = plot.figure().subplots(4, 1)
    plot.speed_over_time(speed, none, none, none)
    plot.course_over_time(course, none, none, none)
    plot.drift_over_time(drift, none, pairs, none)
    plot.own_map(way, pairs, pairs, pairs)
    assert [ax.get_ylim()[0] for ax in (speed, course, drift)] == [0.0, 0.0, 0.0]


def test_times_with_fixes_are_named():
    ax = plot.figure().add_subplot()
    plot.drift_over_time(ax, np.arange(9.0), np.ones((9, 2)), np.arange(5.0))
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["drift", "fixes"]


def test_ids_are_shown_as_they_are(tmp_path, tracks):
    odd = replace(tracks, track_id=np.full(len(tracks), r"$5 \frac$"))
    first = np.arange(len(odd)) == 0
    for k, fig in enumerate([plot.map(replace(odd, alarmed=first)), plot.time_figure(None, odd)]):
        plot.save(fig, tmp_path / f"{k}.svg")


@pytest.mark.parametrize(
    "make", [lambda episode=None, tracks=None: plot.map(tracks, episode), plot.time_figure]
)
def test_figures_are_written_even_of_nothing(tmp_path, make, episode, tracks):
    nothing = Tracks([], [], np.zeros((0, 4)))
    for k, arguments in enumerate([(episode, tracks), (episode,), (Episode("", []), nothing), ()]):
        path = tmp_path / f"{k}.png"
        plot.save(make(*arguments), path)
        assert path.read_bytes().startswith(b"\x89PNG")
    assert len(list(tmp_path.iterdir())) == 4


@pytest.mark.parametrize("name", ["abc", "abc.", ".png", "abc.txt"])
def test_a_figure_is_written_only_where_the_suffix_names_a_format(tmp_path, name):
    with pytest.raises(ValueError, match=r"path must end in .*\.pdf, .*\.png, .*got '.*'"):
        plot.save(plot.figure(), tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_wakeline_plot_is_imported_without_matplotlib():
    code = "import sys, wakeline.plot; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


# Comparisons of estimators ------------------------------------------------------------------------


@pytest.fixture
def ax():
    return plot.figure().add_subplot()


TIME_S = np.arange(3.0, 33.0, 3.0)
TRUE_RATE = np.deg2rad([0.0] * 4 + [2.0] * 3 + [-1.0] * 3)


def test_every_comparison_draws_into_the_axes_it_was_given(ax):
    state = np.column_stack([TIME_S, TIME_S, 2 * TIME_S, TIME_S])
    curve = {"one": np.ones(10), "two": np.full(10, 2.0)}
    assert plot.error_panel(ax, TIME_S, curve, bound=np.full(10, 0.5)) is ax
    assert plot.turn_rate_panel(ax, TIME_S, TRUE_RATE, curve) is ax
    assert plot.probability_panel(ax, TIME_S, np.full((10, 2), 0.5), [0.0, 0.1]) is ax
    assert plot.paths_view(ax, state, {"one": state}) is ax
    assert plot.ranking_panel(ax, ["one"], {"here": [1.0]}, xlabel="error (m)") is ax
    assert plot.steps_panel(ax, ["low"], {"one": [1.0]}, xlabel="noise", ylabel="error") is ax
    assert plot.mark_switches(ax, [5.0]) is ax


def test_paths_are_in_kilometres_with_north_up_and_equal_axes(ax):
    state = np.array([[1000.0, 1.0, 5000.0, 0.0], [2000.0, 1.0, 5000.0, 0.0]])
    plot.paths_view(ax, state, {"one": state + 1.0}, plots_m=state[:, 0::2], switch=[1])
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("east (km)", "north (km)")
    assert ax.get_aspect() == 1.0
    drawn = [line.get_xydata().tolist() for line in ax.lines]
    assert [[5.0, 1.0], [5.0, 2.0]] in drawn


def test_errors_start_at_nothing_and_their_lines_are_named(ax):
    plot.error_panel(ax, TIME_S, {"one": np.linspace(1, 9, 10)}, bound=np.ones(10), switch_s=[12.0])
    low, high = ax.get_ylim()
    assert low == 0.0
    assert 9.0 < high < 11.0
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["bound", "one"]


NINE = np.zeros(9)


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda ax: plot.paths_view(ax, np.zeros((3, 2))), r"truth .* \(n, 4\), got \(3, 2\)"),
        (
            lambda ax: plot.paths_view(ax, np.zeros((3, 4)), {"imm": np.zeros((3, 6))}),
            r"tracks of 'imm' .* \(n, 4\), got \(3, 6\)",
        ),
        (
            lambda ax: plot.paths_view(ax, np.zeros((3, 4)), plots_m=np.zeros(2)),
            r"plots_m .* \(n, 2\), got \(2,\)",
        ),
        (
            lambda ax: plot.error_panel(ax, TIME_S, {"imm": NINE}),
            r"errors of 'imm' .* \(10,\), got \(9,\)",
        ),
        (
            lambda ax: plot.error_panel(ax, TIME_S, {}, bound=NINE),
            r"bound .* \(10,\), got \(9,\)",
        ),
        (lambda ax: plot.error_panel(ax, [], {}), "time_s must have"),
        (
            lambda ax: plot.turn_rate_panel(ax, TIME_S, NINE, {}),
            r"true_rate_rad_s .* \(10,\), got \(9,\)",
        ),
        (
            lambda ax: plot.turn_rate_panel(ax, TIME_S, TIME_S, {"imm": NINE}),
            r"rates_rad_s of 'imm' .* \(10,\), got \(9,\)",
        ),
        (
            lambda ax: plot.probability_panel(
                ax, TIME_S, np.ones((10, 1)), [0.0], true_rate_rad_s=NINE
            ),
            r"true_rate_rad_s .* \(10,\), got \(9,\)",
        ),
        (
            lambda ax: plot.ranking_panel(ax, ["a", "b"], {"easy": [1.0]}, xlabel="m"),
            r"values of 'easy' .* \(2,\), got \(1,\)",
        ),
        (
            lambda ax: plot.ranking_panel(ax, ["a"], {"easy": [1.0]}, xlabel="", best_first="hard"),
            r"values must have hard, got \['easy'\]",
        ),
        (lambda ax: plot.ranking_panel(ax, [], {}, xlabel=""), "values must have"),
        (
            lambda ax: plot.steps_panel(ax, ["a", "b"], {"imm": [1.0]}, xlabel="", ylabel=""),
            r"values of 'imm' .* \(2,\), got \(1,\)",
        ),
    ],
)
def test_what_does_not_fit_is_rejected_by_name(ax, draw, message):
    with pytest.raises(ValueError, match=message):
        draw(ax)


@pytest.mark.parametrize("names", [["failed", "one"], ["one", "failed"], ["failed"], []])
def test_the_axis_of_errors_reaches_to_the_highest_that_is_known(ax, names):
    curves = {"one": np.linspace(1, 9, 10), "failed": np.array([np.nan] * 9 + [np.inf])}
    plot.error_panel(ax, TIME_S, {name: curves[name] for name in names}, bound=np.ones(10))
    highest = 9.0 if "one" in names else 1.0
    assert highest < ax.get_ylim()[1] < 1.2 * highest


def test_a_bound_above_all_errors_is_seen_whole(ax):
    bound = np.linspace(7.0, 2.0, 10)
    plot.error_panel(ax, TIME_S, {"one": np.linspace(1.0, 3.0, 10)}, bound=bound)
    assert ax.get_ylim()[1] > bound.max()


def test_bands_stand_in_order_of_turn_rate_under_the_true_turn(ax):
    probability = np.tile([0.5, 0.2, 0.3], (10, 1))
    plot.probability_panel(
        ax, TIME_S, probability, np.deg2rad([0, 2, -1]), true_rate_rad_s=TRUE_RATE
    )
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert names == ["-1 °/s", "0 °/s", "+2 °/s"]
    *bands, strip = ax.collections
    first = bands[0].get_paths()[0].get_extents()
    assert (first.y0, first.y1) == (0.0, pytest.approx(0.3))
    edges_s = [path.get_extents().x0 for path in strip.get_paths()]
    assert edges_s == [3.0, 12.0, 21.0]
    colors = [band.get_facecolor()[0].tolist() for band in bands]
    assert strip.get_facecolor().tolist() == [colors[1], colors[2], colors[0]]


@pytest.mark.parametrize("shape", [(10, 3), (9, 2), (20,)])
def test_every_rate_has_its_probability_at_every_time(ax, shape):
    with pytest.raises(ValueError, match=r"probability must have shape \(10, 2\), got"):
        plot.probability_panel(ax, TIME_S, np.zeros(shape), [0.0, 0.1])


def test_turns_to_either_side_have_colours_of_their_own():
    colors = plot.turn_colors([-4, -2, 0, 2, 4])
    assert len(set(colors)) == 5
    assert plot.turn_colors([0.0]) == [colors[2]]
    with pytest.raises(TypeError, match="turn_rate_deg_s must hold real numbers: got text"):
        plot.turn_colors(["-4", "2"])


def test_the_best_estimator_stands_on_top(ax):
    plot.ranking_panel(ax, ["a", "b", "c"], {"m": [3.0, 1.0, 2.0]}, xlabel="error (m)")
    assert [label.get_text() for label in ax.get_yticklabels()] == ["a", "c", "b"]
    assert ax.get_xlim()[0] == 0.0


def test_a_ranking_may_be_logarithmic(ax):
    plot.ranking_panel(ax, ["a", "b"], {"m": [1.0, 50.0]}, xlabel="error (m)", log=True)
    assert ax.get_xscale() == "log"
    assert {1.0, 2.0, 5.0, 10.0, 20.0, 50.0} <= set(ax.get_xticks().round(6))


@pytest.mark.parametrize("count", [1, 10, 11, 25])
def test_every_circumstance_of_a_ranking_is_drawn_with_a_separate_mark(ax, count):
    values = {f"case {k}": [k, k + 1.0] for k in range(count)}
    plot.ranking_panel(ax, ["a", "b"], values, xlabel="error (m)")
    marks = [one for one in ax.collections if one.get_label() in values]
    assert [one.get_offsets()[:, 0].min() for one in marks] == list(range(count))
    looks = {
        (to_hex(one.get_facecolor()[0]), one.get_paths()[0].vertices.tobytes()) for one in marks
    }
    assert len(looks) == count


def test_no_two_curves_look_alike_and_those_of_a_given_colour_are_not_dashed(ax):
    curves = {f"estimator {k}": TIME_S for k in range(20)}
    plot.error_panel(ax, TIME_S, curves, colors={"estimator 19": "black"}, legend=False)
    assert len({(line.get_color(), line.is_dashed()) for line in ax.lines}) == 20
    assert [line.is_dashed() for line in ax.lines] == [False] * 10 + [True] * 9 + [False]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("columns", [1, 2, 3])
@pytest.mark.parametrize("count", [1, 3, 8, 14, 20])
def test_names_take_as_few_rows_as_leave_the_panels_their_width(count, columns):
    fig = plot.figure(7.2, 6.0)
    axes = fig.subplots(1, columns, squeeze=False)[0]
    curves = {f"estimator {k}": TIME_S for k in range(count)}
    modes = np.full((10, count), 1.0 / count)
    for k, ax in enumerate(axes):
        if k == 1:
            plot.probability_panel(ax, TIME_S, modes, np.linspace(-0.1, 0.1, count))
        else:
            plot.error_panel(ax, TIME_S, curves)
    FigureCanvasAgg(fig).draw()
    for ax in axes:
        room, legend = ax.get_window_extent(), ax.get_legend().get_window_extent()
        assert room.width > 0.65 * fig.bbox.width / columns
        assert legend.width < 1.1 * room.width
        assert not legend.overlaps(room.translated(0.0, -1.0))
        assert legend.width > 0.4 * room.width or count < 3


@pytest.mark.parametrize("names", [["a", "b"], ["bayesian_alpha_beta", "wandering_course"]])
@pytest.mark.parametrize("columns", [1, 2])
@pytest.mark.parametrize("count", [4, 5])
def test_names_take_nothing_of_the_width_of_panels(names, columns, count):
    values = {f"circumstance {k}": [1.0, 2.0] for k in range(count)}
    widths, legends = [], []
    for named in (False, True):
        fig = plot.figure(6.0 * columns, 4.0)
        axes = fig.subplots(1, columns, squeeze=False)[0]
        for ax in axes:
            plot.ranking_panel(ax, names, values, xlabel="error (m)")
            if not named:
                ax.get_legend().remove()
        FigureCanvasAgg(fig).draw()
        widths.append([ax.get_window_extent().width for ax in axes])
        legends = [ax.get_legend().get_window_extent().width for ax in axes] if named else []
    assert widths[1] == pytest.approx(widths[0], abs=1.0)
    assert (np.array(legends) < np.array(widths[1]) + 5.0).all()
    pickle.loads(pickle.dumps(fig))


@pytest.mark.parametrize("name", ["1", "a vessel of a long name, " * 2])
@pytest.mark.parametrize("way", [(1.0, 0.02), (0.02, 1.0)])
def test_every_name_is_in_the_picture(name, way):
    north, east = 1000.0 * np.outer(way, np.arange(9.0))
    state = np.column_stack([north, np.full(9, 10.0 * way[0]), east, np.full(9, 10.0 * way[1])])
    lone = Tracks(np.full(9, name), TIME_S[:9], state, np.array([np.eye(4)] * 9))
    truth = TargetTruth(TIME_S[:9], north, east, *state[:, 1::2].T)
    scans = RadarSimulator(5.0, 0.01, 1.0).record({"a": Truth(state[0])}, 9, rng=1).episodes[0]
    reported = replace(scans, truth={"a": truth})
    for fig in (plot.map(lone, reported), plot.time_figure(reported, lone)):
        FigureCanvasAgg(fig).draw()
        picture = fig.get_tightbbox().padded(0.1)
        for legend in filter(None, (ax.get_legend() for ax in fig.axes)):
            box = legend.get_window_extent()
            assert picture.x0 * fig.dpi <= box.x0
            assert box.x1 <= picture.x1 * fig.dpi


def test_steps_are_named_and_their_ratios_are_alike_at_any_height(ax):
    plot.steps_panel(
        ax, ["low", "high"], {"a": [1.0, 2.0], "b": [10.0, 20.0]}, xlabel="noise", ylabel="error"
    )
    assert [label.get_text() for label in ax.get_xticklabels()] == ["low", "high"]
    to_screen = ax.transData.transform
    rise = [to_screen((1, high))[1] - to_screen((0, low))[1] for low, high in ((1, 2), (10, 20))]
    assert rise[0] == pytest.approx(rise[1])


def own_ship_panel(name):
    """Draws a panel of own ship's, with changes of what it draws."""
    rows, vectors = [0.0, 1.0, 2.0], [[0.0, 1.0], [1.0, 2.0], [2.0, 3.0]]
    reported = {
        "own_map": {"position_m": vectors, "fix_m": vectors[:2], "current_mps": vectors},
        "speed_over_time": {"time_s": rows, "over_ground_mps": rows, "through_water_mps": rows},
        "course_over_time": {"time_s": rows, "course_rad": rows, "heading_rad": rows},
        "drift_over_time": {"time_s": rows, "current_mps": vectors, "fix_time_s": rows[:2]},
    }[name]

    def draw(**change):
        return getattr(plot, name)(plot.figure().subplots(), **reported | change)

    return reported, draw


@pytest.mark.parametrize(
    "name", ["own_map", "speed_over_time", "course_over_time", "drift_over_time"]
)
def test_panels_of_own_ship_take_lists_and_reject_what_does_not_fit_by_name(name):
    reported, draw = own_ship_panel(name)
    assert draw().lines
    for argument in reported:
        with pytest.raises(ValueError, match=rf"{argument} must have shape \(.*\), got \(3, 3\)"):
            draw(**{argument: np.zeros((3, 3))})
        with pytest.raises(TypeError, match=f"{argument} must hold real numbers: got text"):
            draw(**{argument: ["1", "2", "3"]})
    if name == "own_map":
        for argument in ("coasting", "jumped"):
            with pytest.raises(ValueError, match=rf"{argument} must have shape \(3,\), got \(2,\)"):
                draw(**{argument: np.ones(2, bool)})


def test_tracks_have_a_mark_of_alarm_for_each_row():
    with pytest.raises(ValueError, match=r"alarmed must have shape \(2,\), got \(3,\)"):
        Tracks(["1", "1"], [0.0, 1.0], np.zeros((2, 4)), alarmed=np.ones(3, bool))


def test_each_episode_of_a_recording_has_a_map(episode, tracks):
    later = replace(
        episode,
        name="later",
        scans=[replace(s, time_s=s.time_s + 1e4) for s in episode.scans],
    )
    both = Recording("two", [replace(episode, name="first"), later])
    named = replace(tracks, scenario=np.full(len(tracks), "first"))
    first, second = plot.map(named, both).axes
    assert [ax.get_title("right") for ax in (first, second)] == ["first", "later"]
    ids = set(tracks.ids())
    assert {text.get_text() for text in first.texts} & ids == ids
    assert not {text.get_text() for text in second.texts} & ids


def test_an_ellipse_is_of_two_axes():
    with pytest.raises(ValueError, match=r"covariance must have shape \(2, 2\), got \(3, 3\)"):
        plot.ellipse_outline([0.0, 0.0], np.eye(3))
    with pytest.raises(ValueError, match=r"mean must have shape \(2,\), got \(3,\)"):
        plot.ellipse_outline([0.0, 0.0, 0.0], np.eye(2))


def test_curves_that_have_no_names_are_rejected():
    with pytest.raises(TypeError, match="errors must be a mapping by name, got list"):
        plot.error_panel(plot.figure().subplots(), [0.0, 1.0], [1.0, 2.0])
