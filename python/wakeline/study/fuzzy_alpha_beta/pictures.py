"""The figures of the study."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import wakeline as wl
from wakeline import plot, scenario
from wakeline.scenario import HardTurn, HardTurnRuns
from wakeline.study import curves
from wakeline.study.base import Picture

from . import dense
from .dense import Ending, Frame, Shares
from .estimators import LABELS, estimators

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from . import Outcome
    from .on_video import VideoRun

Of = tuple[str, str]  # scenario and estimator

TITLES = {
    "10mps_r300": "10 m/s, 300 m",
    "20mps_r300": "20 m/s, 300 m",
    "20mps_r600": "20 m/s, 600 m",
}
_ECHO_SCANS, _ECHO_STROBE_M = 12, 22.0
FILM_REACH_M = 300.0
_ARGUED = ("abreast", 30)
_MEETING_S = (30.0, 110.0, 141.0)
_MEETING_REACH_M = 100.0
_MEETING_AMPLITUDES = (0.0, 160.0)
_STROBE_COLORS = {"fuzzy": "#FF9F40", "imm": "#40E0FF"}
_COLORS = dict(zip(LABELS, plot.PALETTE, strict=False))


def pictures(
    scenarios: Mapping[str, HardTurn],
    drawn: Mapping[str, HardTurnRuns],
    outcomes: Mapping[Of, Outcome],
    gates_m: np.ndarray,
    losses: Mapping[Of, np.ndarray],
    films: Mapping[str, Sequence[VideoRun]],
    shares: Shares,
) -> tuple[Picture, ...]:
    """The paper's figures, the required gates, the losses, and the dense traffic."""
    traced = {case: _trace(scenarios[case], runs) for case, runs in drawn.items()}
    return (
        Picture(
            "fuzzy-memberships",
            "Quality of tracking: residual over the usual one",
            (_draw_memberships,),
            size_in=(6.0, 3.4),
        ),
        Picture(
            "fuzzy-echo",
            "The echo of a craft of 15 m in sea clutter, 20 km away",
            (_draw_echo,),
            size_in=(6.4, 4.6),
        ),
        Picture(
            "fuzzy-path",
            "One run at 10 m/s: plots, the fuzzy estimate and the Bayesian bank",
            (partial(_draw_path, situation=scenarios["10mps_r300"], runs=drawn["10mps_r300"]),),
            size_in=(6.4, 5.6),
            shared=False,
        ),
        *(
            Picture(
                f"fuzzy-run-{case}",
                f"One run at {TITLES[case]}: distance to the plot, lines chosen, usual residual",
                tuple(
                    partial(panel, trace=traced[case], situation=scenarios[case])
                    for panel in (_draw_innovation, _draw_chosen, _draw_sigma)
                ),
                size_in=(7.2, 5.8),
            )
            for case in scenarios
        ),
        Picture(
            "fuzzy-gates",
            "Gate radius with every plot inside: median and 95 % of the runs",
            tuple(partial(_draw_gates, case=case, outcomes=outcomes) for case in scenarios),
            size_in=(11.0, 3.2),
            columns=3,
            shared=False,
        ),
        Picture(
            "fuzzy-losses",
            "Closed loop: share of lost runs over the gate radius",
            tuple(
                partial(_draw_losses, case=case, gates_m=gates_m, losses=losses)
                for case in scenarios
            ),
            size_in=(7.2, 7.4),
        ),
        *(
            Picture(
                f"fuzzy-video-{case}",
                f"From video: strobes on the echo, {TITLES[case]}",
                (partial(_draw_film, film=runs[0]),),
                size_in=(7.2, 7.2),
            )
            for case, runs in films.items()
            if runs
        ),
        *(_of_dense_traffic(shares) if shares else ()),
    )


def _of_dense_traffic(shares: Shares) -> Iterator[Picture]:
    """The paper's argument, the captures of every case, and one of them on the picture."""
    case = dense.case_of(*_ARGUED)
    yield Picture(
        "fuzzy-dense",
        "A gate must be wide enough for the turn and too narrow for the neighbor",
        (
            partial(_draw_ends, shares=shares, case=dense.ALONE, how=Ending.LOST),
            partial(_draw_ends, shares=shares, case=case, how=Ending.CAPTURED),
            partial(_draw_ends, shares=shares, case=case, how=Ending.HELD),
        ),
        size_in=(7.2, 7.6),
    )
    yield Picture(
        "fuzzy-dense-captures",
        "Share of strobes captured by the neighbor over the gate radius",
        tuple(
            partial(_draw_captures, shares=shares, kind=kind, distance_m=distance_m)
            for distance_m in dense.DISTANCES_M
            for kind in dense.KINDS
        ),
        size_in=(9.6, 9.0),
        columns=len(dense.KINDS),
    )
    needed_m = {"fuzzy": shares.needed_gate_m("fuzzy"), "imm": shares.needed_gate_m("imm")}
    wanted = {"fuzzy": Ending.CAPTURED, "imm": Ending.HELD}
    for number, run in zip(shares.seeds, shares.runs, strict=True):
        if all(run[case, name, needed_m[name]] == wanted[name] for name in needed_m):
            frames = dense.film(number, *_ARGUED, needed_m)
            yield Picture(
                "fuzzy-dense-video",
                "A neighbor abreast at 30 m: the wide strobe goes with it, the narrow one stays",
                tuple(
                    partial(_draw_meeting, frames=frames, at_s=at_s, gates_m=needed_m)
                    for at_s in _MEETING_S
                ),
                size_in=(10.4, 4.4),
                columns=len(_MEETING_S),
                shared=False,
            )
            break


class _Trace(NamedTuple):
    """One run: scans from the first predicted one."""

    time_s: np.ndarray
    innovation_m: dict[str, np.ndarray]
    window: dict[str, np.ndarray]
    sigma_hat_m: np.ndarray


def _trace(situation: HardTurn, runs: HardTurnRuns) -> _Trace:
    """The first of the runs, step by step."""
    sensor, period_s = situation.sensor, situation.period_s
    z = runs.z[0]
    tried = {name: estimators()[name] for name in ("fuzzy", "fuzzy_improved")}
    innovation_m: dict[str, list] = {name: [] for name in tried}
    window: dict[str, list] = {name: [] for name in tried}
    sigma_hat_m = []
    for estimator in tried.values():
        estimator.start(wl.two_point(sensor, *z[:2], period_s))
    for reading in z[2:]:
        for name, estimator in tried.items():
            estimator.predict(period_s)
            step = estimator.update(sensor, reading)
            innovation_m[name].append(np.linalg.norm(step.innovation))
            window[name].append(estimator.mode_probability() @ estimator.plots_of_mode)
        sigma_hat_m.append(tried["fuzzy"].sigma_hat_m)
    return _Trace(
        runs.time_s[2:],
        {name: np.array(values) for name, values in innovation_m.items()},
        {name: np.array(values) for name, values in window.items()},
        np.array(sigma_hat_m),
    )


def _draw_memberships(ax: Axes) -> Axes:
    ratio = np.linspace(0.0, 3.0, 301)
    bad = 1.0 / (1.0 + np.exp(-5.0 * (ratio - 1.5)))
    ax.plot(ratio, 1.0 - bad, color=plot.PALETTE[2], linewidth=1.8, label="good")
    ax.plot(ratio, bad, color=plot.PALETTE[1], linewidth=1.8, label="bad")
    ax.set(xlabel="residual over its mean", ylabel="membership", xlim=(0.0, 3.0))
    return plot.name_lines(plot.dress(ax))


def _draw_echo(ax: Axes) -> Axes:
    """The strongest of a few echoes, as it fluctuates from scan to scan."""
    scene = scenario.small_craft_scene(seed=1)
    truth = scene.targets["craft"].truth
    looks = []
    for turn in scene.turns(_ECHO_SCANS, seed=1):
        place_m = truth.state_at(turn.time_s.mean())[0, ::2]
        echo = wl.strobe_echo(turn, wl.RadiusGate(radius_m=_ECHO_STROBE_M), place_m)
        looks.append((echo.peak_amplitude, turn, place_m))
    _, turn, place_m = max(looks, key=lambda look: look[0])
    return plot.echo(
        turn,
        ax,
        around_m=tuple(place_m),
        half_range_m=150.0,
        strobes=[plot.circle_outline(place_m, _ECHO_STROBE_M)],
    )


def _draw_path(ax: Axes, situation: HardTurn, runs: HardTurnRuns) -> Axes:
    truth, z = runs.truth[0], runs.z[0]
    period_s, sensor = situation.period_s, situation.sensor
    begin_s, end_s = situation.turn_s
    part = slice(int((begin_s - 45.0) / period_s), int((end_s + 45.0) / period_s))
    tracks = {}
    for name in ("fuzzy", "fuzzy_improved"):
        start = wl.two_point(sensor, *z[:2], period_s)
        done = estimators()[name].run(z[2:], dt_s=period_s, sensor=sensor, start=start)
        tracks[LABELS[name]] = done.mean[part.start - 2 : part.stop - 2]
    middle = np.append(truth[part][:, ::2].mean(axis=0), 0.0)
    shift = np.array([middle[0], 0.0, middle[1], 0.0])
    return plot.paths_view(
        ax,
        truth[part] - shift,
        {name: states - shift for name, states in tracks.items()},
        plots_m=curves.place_m(z[part]) - middle[:2],
        radar=False,
    )


def _mark_turn(ax: Axes, situation: HardTurn) -> Axes:
    ax.axvspan(*situation.turn_s, color=plot.MUTED, alpha=0.15, linewidth=0)
    ax.set_xlabel("time (s)")
    return plot.dress(ax)


def _draw_innovation(ax: Axes, trace: _Trace, situation: HardTurn) -> Axes:
    for name, distance_m in trace.innovation_m.items():
        ax.plot(trace.time_s, distance_m, color=_COLORS[name], label=LABELS[name])
    ax.set_ylabel("plot to prediction (m)")
    ax.set_ylim(bottom=0.0)
    return plot.name_lines(_mark_turn(ax, situation))


def _draw_chosen(ax: Axes, trace: _Trace, situation: HardTurn) -> Axes:
    for name, plots in trace.window.items():
        ax.plot(trace.time_s, plots, color=_COLORS[name], drawstyle="steps-post")
    ax.set_ylabel("plots in the line")
    ax.set_ylim(1.5, 10.5)
    return _mark_turn(ax, situation)


def _draw_sigma(ax: Axes, trace: _Trace, situation: HardTurn) -> Axes:
    ax.plot(trace.time_s, trace.sigma_hat_m, color=_COLORS["fuzzy"])
    ax.set_ylabel("usual residual (m)")
    ax.set_ylim(bottom=0.0)
    return _mark_turn(ax, situation)


def _draw_gates(ax: Axes, case: str, outcomes: Mapping[Of, Outcome]) -> Axes:
    gates = [outcomes[case, name].gate_m() for name in LABELS]
    values = {
        "half": [float(np.median(gate)) for gate in gates],
        "95 %": [float(np.percentile(gate, 95)) for gate in gates],
    }
    return plot.ranking_panel(
        ax, list(LABELS.values()), values, xlabel=f"gate radius (m), {TITLES[case]}"
    )


def _draw_losses(ax: Axes, case: str, gates_m: np.ndarray, losses: Mapping[Of, np.ndarray]) -> Axes:
    for name, label in LABELS.items():
        ax.plot(gates_m, losses[case, name], color=_COLORS[name], linewidth=1.6, label=label)
    ax.set(xlabel="gate radius (m)", ylabel=f"lost\n{TITLES[case]}", ylim=(-0.03, 1.03))
    plot.dress(ax)
    return plot.name_lines(ax) if case == next(iter(TITLES)) else ax


def _draw_film(ax: Axes, film: VideoRun) -> Axes:
    """The last revolution around the craft, with the strobes of the last scans."""
    loop = film.loops["fuzzy_improved"]
    north_m, east_m = film.truth[-1, ::2]
    measured_m = loop.measured_m
    known = [place_m for place_m in loop.predicted_m if np.isfinite(place_m).all()]
    return plot.ppi(
        film.last,
        ax,
        plots=measured_m[np.isfinite(measured_m[:, 0])],
        strobes=[plot.circle_outline(place_m, loop.gate_m) for place_m in known],
        extent_m=(
            east_m - FILM_REACH_M,
            east_m + FILM_REACH_M,
            north_m - FILM_REACH_M,
            north_m + FILM_REACH_M,
        ),
        rings=False,
    )


def _draw_shares(ax: Axes, shares: Shares, case: str, how: Ending) -> Axes:
    """Curves over the gate, with a dot at the gate that each estimator needs."""
    for name, label in LABELS.items():
        curve = shares.curve(case, name, how)
        ax.plot(dense.GATES_M, curve, color=_COLORS[name], linewidth=1.6, label=label)
        needed_m = shares.needed_gate_m(name)
        ax.plot(
            needed_m,
            shares.share(case, name, needed_m, how),
            "o",
            color=_COLORS[name],
            markersize=7,
            markeredgecolor="white",
            clip_on=False,
            zorder=4,
        )
    ax.set(xlabel="gate radius (m)", xlim=(dense.GATES_M[0] - 1, dense.GATES_M[-1] + 1))
    ax.set_ylim(-0.03, 1.03)
    return plot.dress(ax)


def _draw_ends(ax: Axes, shares: Shares, case: str, how: Ending) -> Axes:
    _draw_shares(ax, shares, case, how)
    if case == dense.ALONE:
        ax.axhline(dense.ALLOWED_LOSS, color=plot.MUTED, linewidth=1.0, linestyle="--")
        ax.set_ylabel("lost\nalone, with a hard turn")
        return plot.name_lines(ax)
    kind, distance_m = _ARGUED
    ax.set_ylabel(f"{how.name.lower()}\n{kind}, {distance_m:g} m")
    return ax


def _draw_captures(ax: Axes, shares: Shares, kind: str, distance_m: float) -> Axes:
    _draw_shares(ax, shares, dense.case_of(kind, distance_m), Ending.CAPTURED)
    if kind == dense.KINDS[0]:
        ax.set_ylabel(f"captured, {distance_m:g} m")
    if distance_m == dense.DISTANCES_M[0]:
        ax.set_title(kind, fontsize=plot.TEXT_PT + 1, color=plot.INK)
        if kind == dense.KINDS[0]:
            ax.legend(fontsize=plot.TEXT_PT - 1, frameon=False, labelcolor=plot.INK)
    return ax


def _draw_meeting(
    ax: Axes, frames: Sequence[Frame], at_s: float, gates_m: Mapping[str, float]
) -> Axes:
    """The picture around both craft, with their true positions and the strobes."""
    frame = min(frames, key=lambda frame: abs(frame.turn.time_s.mean() - at_s))
    north_m, east_m = 0.5 * (frame.craft_m + frame.other_m)
    reach_m = _MEETING_REACH_M
    plot.ppi(
        frame.turn,
        ax,
        extent_m=(east_m - reach_m, east_m + reach_m, north_m - reach_m, north_m + reach_m),
        amplitude_range=_MEETING_AMPLITUDES,
        rings=False,
    )
    for place_m, mark, label in ((frame.craft_m, "+", "craft"), (frame.other_m, "x", "neighbor")):
        for color, width in (("black", 4.0), ("white", 1.8)):
            shown = {"color": color, "markersize": 9, "markeredgewidth": width}
            ax.plot(*place_m[::-1], mark, label=label if color == "white" else None, **shown)
    for name, color in _STROBE_COLORS.items():
        outline_m = plot.circle_outline(frame.strobes_m[name], gates_m[name])
        label = f"{LABELS[name]}, {gates_m[name]:g} m"
        ax.plot(outline_m[:, 1], outline_m[:, 0], color=color, linewidth=2.0, label=label)
    ax.set(xticks=[], yticks=[], xlabel="", ylabel="")
    ax.set_title(f"{frame.turn.time_s.mean():.0f} s", fontsize=plot.TEXT_PT + 1, color=plot.INK)
    if frame.turn.time_s.mean() < _MEETING_S[0] + 5.0:
        legend = ax.legend(loc="lower left", fontsize=plot.TEXT_PT - 1, labelcolor="white")
        legend.get_frame().set(facecolor="black", alpha=0.6, linewidth=0)
    return ax
