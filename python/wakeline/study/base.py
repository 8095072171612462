"""Common parts of the studies: runs, rows, a table with published figures, and pictures."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

import wakeline as wl
from wakeline import plot
from wakeline._brief import brief, many
from wakeline._checks import run_numbers
from wakeline._pool import thread_pool
from wakeline._progress import progress as reported

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from wakeline.scenario import RadarSimulator

Panel = Callable[["Axes"], "Axes"]
Rows = list[dict[str, Any]]
Key, Found = TypeVar("Key"), TypeVar("Found")
Done = dict[Any, Any]

_HEADS = {
    "mean_position_m": "mean m",
    "peak_position_m": "peak m",
    "mean_velocity_mps": "mean m/s",
    "peak_velocity_mps": "peak m/s",
    "position_rmse_m": "position m",
    "speed_rmse_mps": "speed m/s",
    "course_rms_deg": "course °",
    "after_turn_position_rmse_m": "after turn m",
    "after_turn_speed_rmse_mps": "after turn m/s",
    "after_turn_course_rms_deg": "after turn °",
    "north_mse_m2": "north m²",
    "east_mse_m2": "east m²",
    "heading_mse_deg2": "heading °²",
    "second_half_north_mse_m2": "2nd half north m²",
    "second_half_east_mse_m2": "2nd half east m²",
    "second_half_heading_mse_deg2": "2nd half heading °²",
    "nees": "NEES",
    "steady_nees": "steady NEES",
    "steady_mean_nees_inside_share": "scans in band",
    "ns_per_step": "ns a step",
}
_UNITS = {"mps": "m/s", "deg": "°", "arcmin": "′"}
_DIGITS = {"m": 1, "s": 0, "deg": 1, "deg2": 3, "step": 0, "arcmin": 4, "drift_rms_kn": 3}
_DIGITS |= {"pos_predicted": 3, "pos_found": 3, "found_runs": 0}


@dataclass(frozen=True)
class Picture:
    """A figure to draw: panels that draw into axes, one above the other or in columns.

    Attributes
    ----------
    name : str
        Stem of its file.
    title : str
        Title of the figure.
    panels : tuple of callables
        Each takes axes, draws into them and returns them.
    size_in : (float, float)
        Width and height.
    columns : int
    shared : bool
        Whether the panels share their horizontal axis; then it is labelled once.
    """

    name: str
    title: str
    panels: tuple[Panel, ...]
    size_in: tuple[float, float] = (7.2, 6.0)
    columns: int = 1
    shared: bool = True

    def draw(self) -> Figure:
        """Make the figure."""
        fig = plot.figure(*self.size_in)
        rows = -(-len(self.panels) // self.columns)
        axes = fig.subplots(rows, self.columns, squeeze=False, sharex=self.shared)
        for ax, panel in zip(axes.flat, self.panels, strict=False):
            panel(ax)
        for ax in axes.flat[len(self.panels) :]:
            ax.set_axis_off()
        if self.shared:
            for ax in axes[:-1].flat:
                ax.set_xlabel("")
        fig.suptitle(self.title, x=0.01, ha="left", fontsize=plot.TEXT_PT + 2, color=plot.INK)
        fig.align_ylabels(axes)
        return fig


@dataclass(frozen=True)
class Report:
    """Results of a study.

    Attributes
    ----------
    name : str
        Name of the study.
    seed : int or None
        Seed of the runs; None if nothing is random.
    runs : int
        Number of runs.
    rows : list of dict
        ``scenario``, ``estimator`` and metrics with their unit, None where missing.
    result : object
        The Monte Carlo results by scenario, if the study has them.
    pictures : tuple of Picture
        Not drawn yet.
    published : mapping of str to Published
        Published figures by source, such as ``paper``.
    notes : tuple of str
        Remarks on the table.
    """

    name: str
    seed: int | None
    runs: int
    rows: Rows
    result: Any = None
    pictures: tuple[Picture, ...] = ()
    published: Mapping[str, Published] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return brief(
            self,
            many(self.runs, "run"),
            "" if self.seed is None else f"seed {self.seed}",
            many(len(self.rows), "row"),
            many(len(self.pictures), "picture"),
            name=self.name,
        )

    def row(self, scenario: str, estimator: str) -> dict[str, Any]:
        """The row of an estimator on a scenario; raises KeyError if there is none."""
        for row in self.rows:
            if (row["scenario"], row["estimator"]) == (scenario, estimator):
                return row
        raise KeyError(f"no row of {estimator} on {scenario}")

    def save_pictures(self, folder: str | Path, *, progress: bool = False) -> list[Path]:
        """Draw every picture as ``NAME.png`` into `folder`; returns the files.

        With `progress` a bar is drawn if stderr is a terminal.
        """
        Path(folder).mkdir(parents=True, exist_ok=True)
        files = []
        count = len(self.pictures)
        for picture in reported(self.pictures, count, "drawing") if progress else self.pictures:
            files.append(Path(folder) / f"{picture.name}.png")
            plot.save(picture.draw(), files[-1])
        return files

    def table(self) -> list[list[str]]:
        """Cells: a header, then one row per estimator and scenario, published figures below."""
        metrics = list(dict.fromkeys(key for row in self.rows for key in list(row)[2:]))
        cells = [["scenario", "estimator", *map(label, metrics)]]
        before = ""
        for row in self.rows:
            key = (row["scenario"], row["estimator"])
            shown = key[0] if key[0] != before else ""
            before = key[0]
            cells.append([shown, key[1], *(figure_text(m, row.get(m)) for m in metrics)])
            for source, figures in self.published.items():
                if key in figures.figures:
                    values = (figures.get(*key, m) for m in metrics)
                    texts = map(figure_text, metrics, values)
                    cells.append(["", f"  {source}", *("" if t == "-" else t for t in texts)])
        return cells


@dataclass(frozen=True)
class Published:
    """Figures of a publication.

    Attributes
    ----------
    metrics : tuple of str
        Names of the metrics.
    figures : mapping of (scenario, estimator) to sequence of float
        In the order of `metrics`; NaN where not published.
    """

    metrics: tuple[str, ...]
    figures: Mapping[tuple[str, str], Sequence[float]]

    def get(self, scenario: str, estimator: str, metric: str) -> float | None:
        """The figure, None if not published."""
        row = self.figures.get((scenario, estimator))
        if row is None or metric not in self.metrics:
            return None
        value = row[self.metrics.index(metric)]
        return None if np.isnan(value) else value


@dataclass(frozen=True)
class Request:
    """The arguments of :meth:`Study.run`."""

    runs: int
    seed: int
    full: bool
    threads: int | None
    progress: bool


@dataclass(frozen=True)
class Plan:
    """The work of a study for a request, and its results.

    Attributes
    ----------
    jobs : mapping of key to callable
        Independent jobs; `done` has the result of each by its key.
    rows : callable
        Makes the rows from all or some of the results.
    result : callable, optional
        Makes `Report.result` from them; default: all results.
    pictures, notes : callable, optional
        Made from all results and their rows.
    in_turn : bool
        Whether the jobs run one after another, because each uses all threads. The exception of an
        interrupted job has its partial result as the attribute ``result``.
    runs : int, optional
        Number of runs, if it differs from the requested one.
    """

    jobs: Mapping[Any, Callable[[], Any]]
    rows: Callable[[Done], Rows]
    result: Callable[[Done], Any] = dict
    pictures: Callable[[Done, Rows], Iterable[Picture]] = lambda done, rows: ()
    notes: Callable[[Done, Rows], Iterable[str]] = lambda done, rows: ()
    in_turn: bool = False
    runs: int | None = None


@dataclass(frozen=True)
class Study:
    """A study by name.

    Attributes
    ----------
    name : str
    summary : str
        One line.
    plan : callable
        Takes a :class:`Request`, and options of the study, and returns its :class:`Plan`.
    published : mapping of str to Published
        Published figures by source.
    random : bool
        Whether the study is random.
    """

    name: str
    summary: str
    plan: Callable[..., Plan] = field(repr=False)
    published: Mapping[str, Published] = field(default_factory=dict, repr=False)
    random: bool = True

    def run(
        self,
        runs: int = 500,
        seed: int = 0,
        *,
        full: bool = False,
        threads: int | None = None,
        progress: bool = False,
        **options: Any,
    ) -> Report:
        """Run the study.

        Parameters
        ----------
        runs, seed : int
            Of the Monte Carlo runs.
        full : bool
            Also the sensitivity of the results, if the study has it.
        threads : int, optional
            Default: the number of processors.
        progress : bool
            Whether to draw a bar if stderr is a terminal.
        **options
            Options of the study; see its module.

        Returns
        -------
        Report
            An exception that ends the work early, also KeyboardInterrupt, has the attribute
            ``result``: a report of the completed rows, without pictures.

        Raises
        ------
        ValueError
            When a number is not an integer or too small.
        """
        run_numbers(runs, seed, threads)
        plan = self.plan(Request(runs, seed, full, threads, progress), **options)
        report = Report(
            self.name,
            seed if self.random else None,
            plan.runs or runs,
            rows=[],
            published=self.published,
        )

        def so_far(done: Done) -> Report:
            return replace(report, rows=plan.rows(done), result=plan.result(done))

        done: Done = {}
        try:
            done = in_turn(plan.jobs) if plan.in_turn else worked_off(plan.jobs, threads, progress)
            found = so_far(done)
            pictures, notes = plan.pictures(done, found.rows), plan.notes(done, found.rows)
            return replace(found, pictures=tuple(pictures), notes=tuple(notes))
        except BaseException as error:
            error.result = so_far(done or getattr(error, "result", {}))
            raise


def worked_off(
    jobs: Mapping[Key, Callable[[], Found]], threads: int | None, progress: bool
) -> dict[Key, Found]:
    """Results of all jobs, by default with the number of processors as threads.

    An exception cancels the jobs that have not begun, and has the attribute ``result``: the results
    of the completed ones.
    """
    done: dict[Key, Found] = {}

    def work_off(key: Key) -> None:
        done[key] = jobs[key]()

    try:
        with (
            thread_pool(threads) as pool,
            closing(pool.map(work_off, jobs)) as ends,
        ):
            for _ in reported(ends, len(jobs), "running") if progress else ends:
                pass
    except BaseException as error:
        error.result = {key: done[key] for key in jobs if key in done}
        raise
    return {key: done[key] for key in jobs}


def in_turn(jobs: Mapping[Key, Callable[[], Found]]) -> dict[Key, Found]:
    """Results of all jobs, run one after another.

    An exception has the attribute ``result``: the results of the completed jobs, and the partial
    result of the interrupted one.
    """
    done: dict[Key, Found] = {}
    for key, job in jobs.items():
        try:
            done[key] = job()
        except BaseException as error:
            partial = getattr(error, "result", None)
            error.result = done if partial is None else done | {key: partial}
            raise
    return done


def label(metric: str) -> str:
    """Header of a metric's column, such as "mean m/s" for ``mean_velocity_mps``."""
    if metric in _HEADS:
        return _HEADS[metric]
    name, _, unit = metric.rpartition("_")
    return f"{name.replace('_', ' ')} {_UNITS.get(unit, unit)}".strip()


def figure_text(metric: str, value: float | None) -> str:
    """A figure with its significant digits."""
    if value is None or not np.isfinite(value):
        return "-"
    digits = _DIGITS.get(metric, _DIGITS.get(metric.split("_")[-1], 2))
    return f"{value:.{digits}f}"


def means_of(runs: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """The mean of every figure over runs."""
    return {metric: float(np.mean([run[metric] for run in runs])) for metric in runs[0]}


def radar_of(simulator: RadarSimulator, **others: Any) -> wl.Radar:
    """A tracker's radar with the errors and the period of a simulated one."""
    return wl.Radar(
        range_std_m=simulator.range_std_m,
        bearing_std_rad=simulator.bearing_std_rad,
        period_s=simulator.period_s,
        **others,
    )


def arrivals(
    calls: Sequence[tuple[Any, ...]], times_s: Iterable[float]
) -> Iterator[tuple[float, Sequence[tuple[Any, ...]]]]:
    """Each time with the calls, sorted by arrival, that have come since the one before."""
    arrival_s = [call[0] for call in calls]
    done = 0
    for now_s in times_s:
        come = bisect_right(arrival_s, now_s, lo=done)
        yield now_s, calls[done:come]
        done = come


def finite(value: float | None) -> float | None:
    """The value for a file, None for one that is not finite."""
    return None if value is None or not np.isfinite(value) else float(value)
