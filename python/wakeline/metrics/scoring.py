"""The score of tracks against truth; ``cpp/docs/scoring.md`` has the definitions."""

from __future__ import annotations

import itertools

import numpy as np

from wakeline import association
from wakeline._checks import not_negative, plain_numbers
from wakeline._engine.eval import SetDistance, set_distance
from wakeline.recording import Episode, Recording, Tracks
from wakeline.recording.scans import nearest

from .results import EpisodeScore, Score, TargetScore, ratio, summary_of
from .states import errors_of

_NEAR_GATES = 4.0
_LOST_SCANS = 3


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
    if not 1 <= warmup_scans < np.inf:
        raise ValueError(f"warmup_scans must be finite and at least 1, got {warmup_scans}")
    if isinstance(recording, Episode):
        recording = Recording(recording.name, [recording])
    named = tracks.scenario if tracks.scenario is not None else np.full(len(tracks), "")
    home = recording.episode_of(named, tracks.time_s)
    episodes = [
        _EpisodeScorer(episode, tracks.where(home == k), gate_m, bonus_m, warmup_scans).score()
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
        self.truth = {name: truth[name].state_at(self.time_s) for name in self.targets}
        self.present = {name: np.isfinite(s).all(axis=1) for name, s in self.truth.items()}
        self.match: dict[str, list[str | None]] = {
            name: [None] * len(self.time_s) for name in self.targets
        }
        self.last_id: dict[str, str] = {}
        self.near_ids: set[str] = set()
        self.duplicates = 0
        self.gospa: list[SetDistance] = []
        self.gospa_near: list[SetDistance] = []

    def score(self) -> EpisodeScore:
        for scan in range(len(self.time_s)):
            self._score_scan(scan)
        every = {track_id for states in self.states for track_id in states}
        false = every - self.near_ids
        return EpisodeScore(
            name=self.episode.name,
            scans=len(self.time_s),
            targets=[self._target_score(name) for name in self.targets],
            track_ids=len(every),
            false_tracks=len(false),
            false_track_scans=sum(i in false for states in self.states for i in states),
            duplicate_track_scans=self.duplicates,
            unmatched_rows=self.unmatched_rows,
            gospa=self.gospa,
            gospa_near=self.gospa_near,
        )

    def _score_scan(self, scan: int) -> None:
        here = [name for name in self.targets if self.present[name][scan]]
        if not here:
            return
        ids = list(self.states[scan])
        truth_m = np.array([self.truth[name][scan, 0::2] for name in here])
        track_m = np.array([s[0::2] for s in self.states[scan].values()]).reshape(-1, 2)
        distance_m = _distances(truth_m, track_m)
        nearest_m = distance_m.min(axis=0)
        near = [i for i, d in zip(ids, nearest_m, strict=True) if d < self.gate_m]
        self.near_ids.update(near)
        self.gospa.append(set_distance(truth_m, track_m, self.gate_m))
        kept = nearest_m < _NEAR_GATES * self.gate_m
        self.gospa_near.append(set_distance(truth_m, track_m[kept], self.gate_m))
        taken = self._match_scan(scan, here, ids, distance_m)
        self.duplicates += len(set(near) - taken)

    def _match_scan(
        self, scan: int, here: list[str], ids: list[str], distance_m: np.ndarray
    ) -> set[str]:
        """Match targets to tracks: most pairs, then least cost; returns the matched ids."""
        other = np.array([[self.last_id.get(name) != i for i in ids] for name in here])
        cost = np.where(distance_m < self.gate_m, distance_m + self.bonus_m * other, np.inf)
        matched = [(here[target], ids[track]) for target, track in association.assign(cost)]
        for name, track_id in matched:
            self.match[name][scan] = self.last_id[name] = track_id
        return {track_id for _, track_id in matched}

    def _target_score(self, name: str) -> TargetScore:
        present, truth, match = self.present[name], self.truth[name], self.match[name]
        supported = present & self._has_plot_near(truth)
        eligible = present & (np.cumsum(supported) - supported >= self.warmup_scans)
        is_matched = np.array([track_id is not None for track_id in match], dtype=bool)
        hit = np.flatnonzero(is_matched & eligible)
        ids = [match[k] for k in np.flatnonzero(is_matched)]
        estimate = np.array([self.states[k][match[k]] for k in hit]).reshape(-1, 4)
        seen = is_matched[present]
        lost = np.flatnonzero(seen[:-1] & ~seen[1:]) + 1
        first_hit, first_supported = _first(is_matched), _first(supported)
        initiated = first_hit is not None and first_supported is not None
        return TargetScore(
            target=name,
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

    def _has_plot_near(self, truth: np.ndarray) -> np.ndarray:
        """Scans (T,) with a plot within the gate of the target; all of them without any plot."""
        scans = self.episode.scans
        if self.episode.plot_count == 0:
            return np.ones(len(scans), dtype=bool)
        return np.array(
            [
                bool((_distances(state[np.newaxis, 0::2], scan.position_m) < self.gate_m).any())
                for scan, state in zip(scans, truth, strict=True)
            ]
        )


def _distances(a_m: np.ndarray, b_m: np.ndarray) -> np.ndarray:
    """Distances (n, m) between points (n, 2) and (m, 2)."""
    return np.hypot(a_m[:, np.newaxis, 0] - b_m[:, 0], a_m[:, np.newaxis, 1] - b_m[:, 1])


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
