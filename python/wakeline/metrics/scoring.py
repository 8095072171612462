"""The score of tracks against truth; ``cpp/docs/scoring.md`` has the definitions."""

from __future__ import annotations

import itertools

import numpy as np

from wakeline import association
from wakeline._checks import not_negative, plain_numbers
from wakeline._engine.eval import SetDistance, set_distance
from wakeline.recording import Episode, Recording, Tracks
from wakeline.recording.scans import grouped, nearest

from .results import EpisodeScore, Score, TargetScore, ratio, summary_of
from .states import errors_of

_NEAR_GATES = 4.0
_LOST_SCANS = 3
_NONE = -1
_FEW_PAIRS = 10_000


def score(
    tracks: Tracks,
    recording: Recording | Episode,
    *,
    gate_m: float = 50.0,
    bonus_m: float = 15.0,
    warmup_scans: int = 5,
) -> Score:
    """Score confirmed tracks against the truth of a recording.

    Parameters
    ----------
    tracks : Tracks
        One row per confirmed track and scan; of several rows of a track near a scan (a quarter of
        the period, at most 0.5 s) the nearest in time counts.
    recording : Recording or Episode
        Scans, plots and truth. In an episode without plots every scan with truth counts as
        supported by plots.
    gate_m : float
        Maximum distance of a track from its target; also the cut-off of GOSPA. From 1e-9 to 1e9.
    bonus_m : float
        Distance by which another track must be nearer before a target changes its track.
    warmup_scans : int
        A target counts after this many scans with a plot near it.

    Returns
    -------
    Score

    Raises
    ------
    ValueError
        When tracks name a scenario that the recording does not have, or a parameter is not
        positive and finite (the bonus may be zero) or the gate is out of range.
    """
    if not isinstance(tracks, Tracks):
        raise TypeError(f"tracks must be of type Tracks, got {type(tracks).__name__}")
    if not isinstance(recording, (Recording, Episode)):
        raise TypeError(f"recording must be a Recording or Episode, got {type(recording).__name__}")
    plain_numbers(gate_m=gate_m, warmup_scans=warmup_scans)
    if not 1e-9 <= gate_m <= 1e9:
        raise ValueError(f"gate_m must be positive and finite, from 1e-9 to 1e9, got {gate_m}")
    not_negative(bonus_m=bonus_m)
    if not bonus_m <= 1e9:
        raise ValueError(f"bonus_m must be at most 1e9, got {bonus_m}")
    if not 1 <= warmup_scans < np.inf:
        raise ValueError(f"warmup_scans must be finite and at least 1, got {warmup_scans}")
    if isinstance(recording, Episode):
        recording = Recording(recording.name, [recording])
    named = tracks.scenario if tracks.scenario is not None else np.full(len(tracks), "")
    home = recording.episode_of(named, tracks.time_s)
    rows, none = dict(grouped(home)), np.zeros(0, dtype=int)
    episodes = [
        _EpisodeScorer(
            episode, tracks.where(rows.get(k, none)), gate_m, bonus_m, warmup_scans
        ).score()
        for k, episode in enumerate(recording)
    ]
    return Score(summary_of(episodes), episodes, gate_m, bonus_m, warmup_scans)


class _EpisodeScorer:
    """The tracks and truths of one episode by scan, and the counts over them."""

    def __init__(
        self, episode: Episode, tracks: Tracks, gate_m: float, bonus_m: float, warmup_scans: int
    ) -> None:
        self.episode = episode
        self.gate_m, self.bonus_m, self.warmup_scans = gate_m, bonus_m, warmup_scans
        self.time_s = episode.time_s
        self.states, self.unmatched_rows = _states_by_scan(tracks, self.time_s)
        truth = episode.truth or {}
        self.targets = sorted(truth, key=lambda name: (len(name), name))
        scans = len(self.time_s)
        states = [truth[name].state_at(self.time_s) for name in self.targets]
        self.truth = np.array(states).reshape(-1, scans, 4)
        self.present = np.isfinite(self.truth).all(axis=2)
        self.supported = self.present & self._has_plot_near()
        self.ids = sorted({track_id for states in self.states for track_id in states})
        self.number = {track_id: k for k, track_id in enumerate(self.ids)}
        self.match = np.full((len(self.targets), scans), _NONE)
        self.last = np.full(len(self.targets), _NONE)
        self.is_near = np.zeros(len(self.ids), dtype=bool)
        self.duplicates = 0
        self.gospa: list[SetDistance] = []
        self.gospa_near: list[SetDistance] = []

    def score(self) -> EpisodeScore:
        for scan in range(len(self.time_s)):
            self._score_scan(scan)
        false = {track_id for track_id, k in self.number.items() if not self.is_near[k]}
        return EpisodeScore(
            name=self.episode.name,
            scans=len(self.time_s),
            targets=[self._target_score(k) for k in range(len(self.targets))],
            track_ids=len(self.ids),
            false_tracks=len(false),
            false_track_scans=sum(i in false for states in self.states for i in states),
            duplicate_track_scans=self.duplicates,
            unmatched_rows=self.unmatched_rows,
            gospa=self.gospa,
            gospa_near=self.gospa_near,
        )

    def _score_scan(self, scan: int) -> None:
        here = np.flatnonzero(self.present[:, scan])
        if len(here) == 0:
            return
        numbers = np.array([self.number[track_id] for track_id in self.states[scan]], dtype=int)
        truth_m = self.truth[here, scan, 0::2]
        track_m = np.array(list(self.states[scan].values())).reshape(-1, 4)[:, 0::2]
        target, track, distance_m = _pairs_within(self.gate_m, truth_m, track_m)
        is_near = np.zeros(len(numbers), dtype=bool)
        is_near[track] = True
        far = np.flatnonzero(~is_near)
        kept = is_near.copy()
        kept[far[_pairs_within(_NEAR_GATES * self.gate_m, truth_m, track_m[far])[1]]] = True
        gospa = set_distance(truth_m, track_m, self.gate_m)
        self.gospa.append(gospa)
        self.gospa_near.append(
            gospa if kept.all() else set_distance(truth_m, track_m[kept], self.gate_m)
        )
        other = self.last[here[target]] != numbers[track]
        cost_m = distance_m + self.bonus_m * other
        pairs = association.assign_sparse(
            np.searchsorted(target, np.arange(len(here) + 1)),
            track,
            cost_m,
            unassigned_cost=(len(here) + 1) * (self.gate_m + self.bonus_m),  # most pairs come first
            columns=len(numbers),
        )
        matched, by = here[pairs[:, 0]], numbers[pairs[:, 1]]
        self.match[matched, scan] = self.last[matched] = by
        self.is_near[numbers[is_near]] = True
        self.duplicates += int(is_near.sum()) - len(by)

    def _target_score(self, target: int) -> TargetScore:
        present, truth, match = self.present[target], self.truth[target], self.match[target]
        supported = self.supported[target]
        eligible = present & (np.cumsum(supported) - supported >= self.warmup_scans)
        is_matched = match != _NONE
        hit = np.flatnonzero(is_matched & eligible)
        ids = match[is_matched].tolist()
        estimate = np.array([self.states[k][self.ids[match[k]]] for k in hit]).reshape(-1, 4)
        seen = is_matched[present]
        lost = np.flatnonzero(seen[:-1] & ~seen[1:]) + 1
        first_hit, first_supported = _first(is_matched), _first(supported)
        initiated = first_hit is not None and first_supported is not None
        return TargetScore(
            target=self.targets[target],
            present_scans=int(present.sum()),
            supported_scans=int(supported.sum()),
            eligible_scans=int(eligible.sum()),
            coverage=ratio(len(hit), int(eligible.sum())),
            ids=len(set(ids)),
            switches=sum(a != b for a, b in itertools.pairwise(ids)),
            breaks=sum(bool(seen[k:].any()) for k in lost),
            lost_at_end=len(seen) >= _LOST_SCANS and not bool(seen[-_LOST_SCANS:].any()),
            lost_at_time_s=(self.time_s[present][lost] - self.time_s[:1]).tolist(),
            initiation_scans=first_hit - first_supported if initiated else None,
            errors=errors_of([estimate], [truth[hit]]),
            estimate=estimate,
            truth=truth[hit],
        )

    def _has_plot_near(self) -> np.ndarray:
        """Targets and scans (n, T) with a plot within the gate; all of them without any plot."""
        if self.episode.plot_count == 0:
            return np.ones(self.present.shape, dtype=bool)
        near = np.zeros(self.present.shape, dtype=bool)
        for k, scan in enumerate(self.episode.scans):
            here = np.flatnonzero(self.present[:, k])
            target, _, _ = _pairs_within(self.gate_m, self.truth[here, k, 0::2], scan.position_m)
            near[here[target], k] = True
        return near


def _pairs_within(
    radius_m: float, a_m: np.ndarray, b_m: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pairs (p,) of points (n, 2) and (m, 2) closer than a radius, by the first, and distances.

    Many points are compared with those in the cells of a grid around them alone.
    """
    if len(a_m) * len(b_m) <= _FEW_PAIRS:
        distance_m = np.hypot(a_m[:, None, 0] - b_m[:, 0], a_m[:, None, 1] - b_m[:, 1])
        a, b = np.nonzero(distance_m < radius_m)
        return a, b, distance_m[a, b]
    b_index = np.flatnonzero(np.isfinite(b_m).all(axis=1))
    cell_a, cell_b = np.floor(a_m / radius_m), np.floor(b_m[b_index] / radius_m)
    rows, row_b = np.unique(cell_b[:, 0], return_inverse=True)
    columns, column_b = np.unique(cell_b[:, 1], return_inverse=True)
    key_b = row_b * len(columns) + column_b
    order = np.argsort(key_b, kind="stable")
    key_b, b_index = key_b[order], b_index[order]
    first = np.searchsorted(columns, cell_a[:, 1] - 1.0)
    last = np.searchsorted(columns, cell_a[:, 1] + 1.0, side="right")
    found_a, found_b = [], []
    for step in (-1.0, 0.0, 1.0):
        row = np.searchsorted(rows, cell_a[:, 0] + step)
        is_there = row < len(rows)
        is_there[is_there] = rows[row[is_there]] == cell_a[is_there, 0] + step
        begin, end = (np.searchsorted(key_b, row * len(columns) + k) for k in (first, last))
        count = np.where(is_there, end - begin, 0)
        found_a.append(np.repeat(np.arange(len(a_m)), count))
        place = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        found_b.append(b_index[np.repeat(begin, count) + place])
    a, b = np.concatenate(found_a), np.concatenate(found_b)
    distance_m = np.hypot(*(a_m[a] - b_m[b]).T)
    near = np.flatnonzero(distance_m < radius_m)
    near = near[np.lexsort((b[near], a[near]))]
    return a[near], b[near], distance_m[near]


def _states_by_scan(
    tracks: Tracks, scan_time_s: np.ndarray
) -> tuple[list[dict[str, np.ndarray]], int]:
    """State by track id for each scan, and the number of rows without a scan.

    Of several rows of a track near a scan the nearest in time counts, of equals the earlier. The
    tracks of a scan are in order of their ids, so that the order of rows does not matter.
    """
    states: list[dict[str, np.ndarray]] = [{} for _ in scan_time_s]
    if len(scan_time_s) == 0:
        return states, len(tracks)
    period_s = float(np.median(np.diff(scan_time_s))) if len(scan_time_s) > 1 else 1.0
    scan = nearest(scan_time_s, tracks.time_s)
    away_s = np.abs(scan_time_s[scan] - tracks.time_s)
    taken = (away_s <= min(0.25 * period_s, 0.5)) & np.isfinite(tracks.state).all(axis=1)
    for k in np.lexsort((tracks.time_s, away_s, tracks.track_id)):
        if taken[k]:
            states[scan[k]].setdefault(str(tracks.track_id[k]), tracks.state[k])
    return states, int(np.count_nonzero(~taken))


def _first(mask: np.ndarray) -> int | None:
    """Index of the first True, None if there is none."""
    return int(np.argmax(mask)) if mask.any() else None
