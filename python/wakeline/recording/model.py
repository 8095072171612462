"""A recording: episodes of scans of plots, with own ship and optional truth.

All positions are metres in one local plane, north and east; all times are seconds (UTC seconds
since 1970 in files); bearings are radians clockwise from north.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from wakeline._brief import brief, cut, many, quoted, span
from wakeline._checks import columns, in_a_row, real_numbers, shaped
from wakeline._engine.core import wrap_angle

from .truth import TargetTruth

_VELOCITY_SPAN_S = 20.0


@dataclass(frozen=True)
class Scan:
    """The plots of one antenna revolution; a scan may have no plots.

    Attributes
    ----------
    time_s : float
        Time of the scan as listed, else the time of its last plot.
    number : int
        Number of the scan as listed, else counted from 0.
    plot_time_s, north_m, east_m, range_m, bearing_rad : ndarray (n,)
        Time and position of each plot, sorted by time; range and bearing from own ship at the time
        of the plot, bearing in [-pi, pi].
    own_north_m, own_east_m : ndarray (n,)
        Own ship at the time of each plot.
    """

    time_s: float
    number: int
    plot_time_s: np.ndarray
    north_m: np.ndarray
    east_m: np.ndarray
    range_m: np.ndarray
    bearing_rad: np.ndarray
    own_north_m: np.ndarray
    own_east_m: np.ndarray

    def __post_init__(self) -> None:
        places = ("north_m", "east_m", "range_m", "bearing_rad", "own_north_m", "own_east_m")
        columns(self, "plot_time_s", *places)

    @classmethod
    def of_plots(
        cls,
        time_s: float,
        number: int,
        plot_time_s: np.ndarray,
        range_m: np.ndarray,
        bearing_rad: np.ndarray,
        own_position_m: Callable[[np.ndarray], np.ndarray],
    ) -> Scan:
        """From plots (n,) in any order; own ship is at `own_position_m(times)`, (n, 2)."""
        order = np.argsort(plot_time_s, kind="stable")
        plot_time_s, range_m, bearing_rad = plot_time_s[order], range_m[order], bearing_rad[order]
        own_north_m, own_east_m = own_position_m(plot_time_s).T
        return cls(
            time_s=time_s,
            number=number,
            plot_time_s=plot_time_s,
            north_m=own_north_m + range_m * np.cos(bearing_rad),
            east_m=own_east_m + range_m * np.sin(bearing_rad),
            range_m=range_m,
            bearing_rad=bearing_rad,
            own_north_m=own_north_m,
            own_east_m=own_east_m,
        )

    def without_offsets(self, range_m: float, bearing_rad: float, time_s: float) -> Scan:
        """The scan with offsets of its radar, measured minus true, removed from its plots.

        Own ship stays where it was at each plot; the time of the scan remains.
        """
        own_m = np.column_stack([self.own_north_m, self.own_east_m])
        return Scan.of_plots(
            self.time_s,
            self.number,
            self.plot_time_s - time_s,
            np.maximum(self.range_m - range_m, 0.0),
            wrap_angle(self.bearing_rad - bearing_rad),
            lambda _: own_m,
        )

    def __len__(self) -> int:
        return len(self.plot_time_s)

    def __repr__(self) -> str:
        return brief(
            self, f"number {self.number}", many(len(self), "plot"), f"at {self.time_s:.1f} s"
        )

    @property
    def position_m(self) -> np.ndarray:
        """Plots as (n, 2), north and east."""
        return np.column_stack([self.north_m, self.east_m])

    @property
    def range_bearing(self) -> np.ndarray:
        """Plots as (n, 2), range in metres and bearing in radians."""
        return np.column_stack([self.range_m, self.bearing_rad])


@dataclass(frozen=True)
class OwnShipMotion:
    """Positions of the radar, sorted by unique times; one row is a stationary radar.

    Attributes
    ----------
    time_s, north_m, east_m : ndarray (n,)
        Positions of the radar, at least one, finite.
    vnorth_mps, veast_mps : ndarray (n,) or None
        Velocity over ground, where recorded.
    heading_rad : ndarray (n,) or None
        Heading, clockwise from north, where recorded.
    velocity_m2s2 : ndarray (n, 2, 2) or None
        Covariance of the velocity, NaN where unknown.

    Raises
    ------
    ValueError
        When there is no time, a repeated time or one out of order, a position that is not finite,
        or a column of a different length.
    TypeError
        When a column holds text.
    """

    time_s: np.ndarray
    north_m: np.ndarray
    east_m: np.ndarray
    vnorth_mps: np.ndarray | None = None
    veast_mps: np.ndarray | None = None
    heading_rad: np.ndarray | None = None
    velocity_m2s2: np.ndarray | None = None

    def __post_init__(self) -> None:
        motion = ("vnorth_mps", "veast_mps", "heading_rad")
        columns(self, "time_s", "north_m", "east_m", optional=motion)
        if len(self) == 0 or (np.diff(self.time_s) == 0).any():
            raise ValueError(f"time_s must have at least one time, each once, got {self.time_s}")
        for name in ("north_m", "east_m"):
            if not np.isfinite(getattr(self, name)).all():
                raise ValueError(f"{name} must be finite, got {getattr(self, name)}")
        if self.velocity_m2s2 is not None:
            covariances = shaped("velocity_m2s2", self.velocity_m2s2, len(self), 2, 2)
            object.__setattr__(self, "velocity_m2s2", covariances)

    def __len__(self) -> int:
        return len(self.time_s)

    def __repr__(self) -> str:
        return brief(self, many(len(self), "position"), span(self.time_s))

    @classmethod
    def fixed(cls, north_m: float = 0.0, east_m: float = 0.0) -> OwnShipMotion:
        """A stationary radar."""
        return cls(np.zeros(1), np.array([north_m]), np.array([east_m]))

    def position_at(self, time_s: np.ndarray) -> np.ndarray:
        """Positions (T, 2), north and east, by linear interpolation.

        Before the first and after the last row the velocity is constant.
        """
        time_s = in_a_row("time_s", time_s)
        position_m = np.column_stack([self.north_m, self.east_m])
        if len(self) == 1:
            return np.repeat(position_m, len(time_s), axis=0)
        after = np.clip(np.searchsorted(self.time_s, time_s), 1, len(self) - 1)
        step_s = self.time_s[after] - self.time_s[after - 1]
        weight = ((time_s - self.time_s[after - 1]) / step_s)[:, np.newaxis]
        return (1 - weight) * position_m[after - 1] + weight * position_m[after]

    @property
    def knows_velocity(self) -> bool:
        """Whether a velocity was recorded or follows from more than one position."""
        return len(self) > 1 or self._recorded_velocity() is not None

    def velocity_at(self, time_s: np.ndarray) -> np.ndarray:
        """Velocities over ground (T, 2), north and east.

        As recorded, linearly interpolated and constant beyond the ends. Otherwise the mean over the
        last 20 s of `position_at`, with an error of a position's error over 14 s and a lag of 10 s
        in a turn.
        """
        time_s = in_a_row("time_s", time_s)
        recorded = self._recorded_velocity()
        if recorded is not None:
            known_s, *velocities_mps = recorded
            return np.column_stack([np.interp(time_s, known_s, v) for v in velocities_mps])
        moved_m = self.position_at(time_s) - self.position_at(time_s - _VELOCITY_SPAN_S)
        return moved_m / _VELOCITY_SPAN_S

    def velocity_m2s2_at(self, time_s: np.ndarray) -> np.ndarray | None:
        """Covariances (T, 2, 2) of recorded velocities, interpolated like them; None if unknown."""
        if self.velocity_m2s2 is None or self._recorded_velocity() is None:
            return None
        known = np.isfinite(self.velocity_m2s2).all(axis=(1, 2))
        if not known.any():
            return None
        time_s = in_a_row("time_s", time_s)
        entries = self.velocity_m2s2[known].reshape(-1, 4).T
        at = [np.interp(time_s, self.time_s[known], entry) for entry in entries]
        return np.column_stack(at).reshape(-1, 2, 2)

    def _recorded_velocity(self) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
        """Times and velocities where they are finite, None without any."""
        if self.vnorth_mps is None or self.veast_mps is None:
            return None
        known = np.isfinite(self.vnorth_mps) & np.isfinite(self.veast_mps)
        if not known.any():
            return None
        return self.time_s[known], self.vnorth_mps[known], self.veast_mps[known]


@dataclass(frozen=True)
class Episode:
    """One part of a recording that is tracked from a fresh start.

    Attributes
    ----------
    name : str
        Value of the ``scenario`` column, '' when the recording has none.
    scans : list of Scan
        In order of time.
    own : OwnShipMotion
        Own ship over the episode.
    truth : dict of str to TargetTruth, or None
        Truth of each target by name; None when no truth was given.
    """

    name: str
    scans: list[Scan]
    own: OwnShipMotion = field(default_factory=OwnShipMotion.fixed)
    truth: dict[str, TargetTruth] | None = None

    def __len__(self) -> int:
        return len(self.scans)

    def __repr__(self) -> str:
        return brief(self, *_facts([self]), name=self.name)

    @property
    def time_s(self) -> np.ndarray:
        """Times of the scans, (T,)."""
        return np.array([scan.time_s for scan in self.scans], dtype=float)

    @property
    def plot_count(self) -> int:
        """Number of plots in all scans."""
        return sum(len(scan) for scan in self.scans)


@dataclass(frozen=True)
class Recording:
    """A radar recording.

    Attributes
    ----------
    name : str
        Name of the bundled recording or stem of the plots file.
    episodes : list of Episode
        At least one.
    notes : list of str
        What the reader dropped or repaired, one counted note each; empty for a clean recording.
    radar : dict of str to float
        What is known of the radar that recorded it, by the keys of ``[radar]`` in a file of
        settings (:mod:`wakeline.tracking`), such as ``range_std_m``; empty where nothing is.
    """

    name: str
    episodes: list[Episode]
    notes: list[str] = field(default_factory=list)
    radar: dict[str, float] = field(default_factory=dict)

    def __iter__(self) -> Iterator[Episode]:
        return iter(self.episodes)

    def __len__(self) -> int:
        return len(self.episodes)

    def __repr__(self) -> str:
        return brief(self, many(len(self), "episode"), *_facts(self.episodes), name=self.name)

    def episode_of(self, scenario: np.ndarray, time_s: np.ndarray) -> np.ndarray:
        """Index of the episode that each row of another table belongs to.

        A row belongs to the episode that its ``scenario`` names; a row without a name belongs to
        the episode that contains its time or is nearest to it. A single episode takes every row.

        Parameters
        ----------
        scenario : array_like of str (n,)
            '' where a row names no scenario.
        time_s : array_like (n,)
            Time of each row.

        Returns
        -------
        ndarray of int (n,)

        Raises
        ------
        ValueError
            When a row names a scenario that the recording does not have.
        """
        scenario = np.asarray(scenario, dtype=str)
        if len(self.episodes) == 1:
            return np.zeros(len(scenario), dtype=int)
        known = {episode.name: k for k, episode in enumerate(self.episodes)}
        names, which = np.unique(scenario, return_inverse=True)
        lost = [name for name in names.tolist() if name and name not in known]
        if lost:
            raise ValueError(
                f"scenario {quoted(lost[0])} is not in recording {self.name!r}, "
                f"which has {cut(', '.join(map(repr, known)))}"
            )
        index = np.array([known.get(name, 0) for name in names.tolist()], dtype=int)[which]
        unnamed = scenario == ""
        time_s = real_numbers("time_s", time_s)
        if unnamed.any():
            index[unnamed] = self._episode_by_time(time_s[unnamed])
        return index

    def _episode_by_time(self, time_s: np.ndarray) -> np.ndarray:
        """Index (n,) of the episode nearest in time; of equals, the one that starts first."""
        never = (np.inf, np.inf)
        spans = [(e.time_s[0], e.time_s[-1]) if len(e) else never for e in self.episodes]
        order = sorted(range(len(spans)), key=lambda k: spans[k])
        outside_s = [np.maximum(spans[k][0] - time_s, time_s - spans[k][1]) for k in order]
        return np.array(order)[np.argmin(np.maximum(outside_s, 0.0), axis=0)]


def _facts(episodes: Sequence[Episode]) -> list[str]:
    """Numbers of scans, plots and targets with truth, and the time span."""
    targets = {name for episode in episodes for name in episode.truth or ()}
    return [
        many(sum(map(len, episodes)), "scan"),
        many(sum(episode.plot_count for episode in episodes), "plot"),
        many(len(targets), "target") if targets else "",
        span(*(episode.time_s for episode in episodes)),
    ]
