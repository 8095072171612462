"""Results of a score: figures of targets, of episodes, and overall."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field

import numpy as np

from wakeline._engine.eval import SetDistance

from .states import Errors, errors_of


@dataclass(frozen=True)
class TargetScore:
    """Score of one target in one episode.

    Attributes
    ----------
    target : str
        Name of the target.
    present_scans, supported_scans, eligible_scans : int
        Scans with truth; those with a plot near it; those after the warm-up.
    coverage : float or None
        Share of the eligible scans that are matched, 0..1; None if no scan is eligible.
    ids, switches, breaks : int
        Distinct track ids, changes of id, interruptions.
    lost_at_end : bool
        Whether the last three present scans are unmatched.
    lost_at_time_s : list of float
        Start of each interruption, including one at the end, in seconds from the first scan.
    initiation_scans : int or None
        Scans from the first supported to the first matched one.
    errors : Errors
        Over the matched eligible scans.
    estimate, truth : ndarray (errors.matched, 4)
        The states of the errors.
    """

    target: str
    present_scans: int
    supported_scans: int
    eligible_scans: int
    coverage: float | None
    ids: int
    switches: int
    breaks: int
    lost_at_end: bool
    lost_at_time_s: list[float]
    initiation_scans: int | None
    errors: Errors
    estimate: np.ndarray = field(repr=False)
    truth: np.ndarray = field(repr=False)


@dataclass(frozen=True)
class Summary:
    """Combined scores of one or more episodes.

    Attributes
    ----------
    scans, targets, eligible_scans : int
        Sums.
    coverage : float or None
        Matched eligible scans / eligible scans, 0..1.
    ids, switches, breaks, lost_at_end, never_tracked : int
        Sums over targets.
    errors : Errors
        Of all matched eligible scans; debiased target by target.
    false_tracks : int
        Tracks that are never within the gate of any truth.
    false_track_scans_per_scan, duplicate_track_scans_per_scan : float
        Rows of false tracks, and rows within the gate of a truth matched to another track.
    gospa_m, gospa_near_m : float or None
        Mean over the scans with truth, of all tracks and of those within four gates of a truth.
    """

    scans: int
    targets: int
    eligible_scans: int
    coverage: float | None
    ids: int
    switches: int
    breaks: int
    lost_at_end: int
    never_tracked: int
    errors: Errors
    false_tracks: int
    false_track_scans_per_scan: float
    duplicate_track_scans_per_scan: float
    gospa_m: float | None
    gospa_near_m: float | None

    def as_dict(self) -> dict[str, float | int | None]:
        """All figures in one flat dictionary, including those of `errors`."""
        flat = asdict(self)
        return flat | flat.pop("errors")


@dataclass(frozen=True)
class EpisodeScore:
    """Score of one episode.

    Attributes
    ----------
    name : str
        Name of the episode.
    scans : int
        Number of scans.
    targets : list of TargetScore
    track_ids, false_tracks : int
        Distinct ids, and those of tracks never within the gate of any truth.
    false_track_scans, duplicate_track_scans : int
        Rows of false tracks; rows near a truth matched to another track.
    unmatched_rows : int
        Ignored track rows: not at a scan's time, or not finite.
    gospa, gospa_near : list of SetDistance
        One per scan with truth: of all tracks, and of those within four gates of a truth.
    """

    name: str
    scans: int
    targets: list[TargetScore]
    track_ids: int
    false_tracks: int
    false_track_scans: int
    duplicate_track_scans: int
    unmatched_rows: int
    gospa: list[SetDistance] = field(repr=False)
    gospa_near: list[SetDistance] = field(repr=False)

    @property
    def summary(self) -> Summary:
        """The episode's figures over all its targets."""
        return summary_of([self])


@dataclass(frozen=True)
class Score:
    """Score of a recording.

    Attributes
    ----------
    overall : Summary
    episodes : list of EpisodeScore
    gate_m, bonus_m : float
    warmup_scans : int
        Parameters of the score.
    """

    overall: Summary
    episodes: list[EpisodeScore]
    gate_m: float
    bonus_m: float
    warmup_scans: int


def summary_of(episodes: Sequence[EpisodeScore]) -> Summary:
    targets = [target for episode in episodes for target in episode.targets]
    errors = errors_of([t.estimate for t in targets], [t.truth for t in targets])
    scans = sum(episode.scans for episode in episodes)
    eligible = sum(target.eligible_scans for target in targets)
    false_rows = sum(episode.false_track_scans for episode in episodes)
    duplicate_rows = sum(episode.duplicate_track_scans for episode in episodes)
    return Summary(
        scans=scans,
        targets=len(targets),
        eligible_scans=eligible,
        coverage=ratio(errors.matched, eligible),
        ids=sum(target.ids for target in targets),
        switches=sum(target.switches for target in targets),
        breaks=sum(target.breaks for target in targets),
        lost_at_end=sum(target.lost_at_end for target in targets),
        never_tracked=sum(target.ids == 0 for target in targets),
        errors=errors,
        false_tracks=sum(episode.false_tracks for episode in episodes),
        false_track_scans_per_scan=ratio(false_rows, scans) or 0.0,
        duplicate_track_scans_per_scan=ratio(duplicate_rows, scans) or 0.0,
        gospa_m=_mean([g.gospa_m for episode in episodes for g in episode.gospa]),
        gospa_near_m=_mean([g.gospa_m for episode in episodes for g in episode.gospa_near]),
    )


def ratio(part: int, whole: int) -> float | None:
    return part / whole if whole else None


def _mean(values: Sequence[float]) -> float | None:
    return float(np.mean(values)) if values else None
