"""Scores as text for the screen and as rows for a file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from wakeline._brief import many
from wakeline.metrics import Score, Summary, TargetScore

ALL = "all"

_METRICS = (
    "coverage",
    "ids",
    "switches",
    "breaks",
    "position_rmse_m",
    "position_rmse_debiased_m",
    "velocity_rmse_mps",
    "course_rms_deg",
    "speed_rmse_mps",
    "false_tracks",
    "false_track_scans_per_scan",
    "gospa_m",
)
_HEAD = (
    "coverage %",
    "ids",
    "switches",
    "breaks",
    "position m",
    "debiased m",
    "velocity m/s",
    "speed m/s",
    "course °",
)


def score_rows(score: Score, file: str) -> list[dict[str, Any]]:
    """One row of metrics per scenario, and one of all together, scenario ``all``.

    Parameters
    ----------
    score : Score
    file : str
        Name of a scenario without a name.
    """
    rows = [_row(episode.name or file, episode.summary) for episode in score.episodes]
    return [*rows, _row(ALL, score.overall)]


def score_table(score: Score) -> str:
    """Accuracy and continuity of each target and overall, then false tracks and GOSPA."""
    named = any(episode.name for episode in score.episodes)
    rows = [["scenario"] * named + ["target", *_HEAD]]
    for episode in score.episodes:
        for target in episode.targets:
            rows.append([episode.name] * named + [target.target, *_figures(target)])
    rows.append([ALL] + [""] * named + _figures(score.overall))
    return f"{aligned(rows, left=1 + named)}\n\n{_tail(score)}"


def explained(summary: Summary) -> str:
    """Every figure of a score with a short explanation."""
    errors = summary.errors
    rows = [
        ["coverage", percent(summary.coverage), "share of scans in which a target has a track"],
        ["track ids", f"{summary.ids} for {summary.targets}", "tracks and the targets they follow"],
        ["switches", str(summary.switches), "changes of a target to another track"],
        ["breaks", str(summary.breaks), "gaps in the tracks of a target"],
        ["position", metres(errors.position_rmse_m), "RMS distance from the true position"],
        [
            "  debiased",
            metres(errors.position_rmse_debiased_m),
            "the same without its mean (e.g. from a bearing offset)",
        ],
        ["velocity", f"{number(errors.velocity_rmse_mps, 2)} m/s", "RMS error of the vector"],
        ["course", f"{number(errors.course_rms_deg)}°", "RMS error, true speed above 2 m/s"],
        [
            "false tracks",
            str(summary.false_tracks),
            f"away from all known targets, {summary.false_track_scans_per_scan:.2f} per scan",
        ],
        ["GOSPA", metres(summary.gospa_m), "errors, missed targets and false tracks combined"],
    ]
    return aligned(rows, left=1, text=(2,))


def aligned(rows: Sequence[Sequence[str]], left: int = 1, text: Sequence[int] = ()) -> str:
    """Rows of cells as columns, the first `left` and those in `text` flush left, others right."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]

    def place(k: int, cell: str) -> str:
        return cell.ljust(widths[k]) if k < left or k in text else cell.rjust(widths[k])

    return "\n".join("  ".join(place(k, c) for k, c in enumerate(row)).rstrip() for row in rows)


def number(value: float | None, digits: int = 1) -> str:
    """A figure, or a dash if missing."""
    return "-" if value is None else f"{value:.{digits}f}"


def percent(share: float | None) -> str:
    """A share of 1 in per cent."""
    return "-" if share is None else f"{100.0 * share:.1f} %"


def metres(value: float | None) -> str:
    """A length."""
    return f"{number(value)} m"


def _row(scenario: str, summary: Summary) -> dict[str, Any]:
    figures = summary.as_dict()
    return {"scenario": scenario, "estimator": "tracks"} | {key: figures[key] for key in _METRICS}


def _figures(part: TargetScore | Summary) -> list[str]:
    errors = part.errors
    return [
        number(None if part.coverage is None else 100.0 * part.coverage),
        str(part.ids),
        str(part.switches),
        str(part.breaks),
        number(errors.position_rmse_m),
        number(errors.position_rmse_debiased_m),
        number(errors.velocity_rmse_mps, 2),
        number(errors.speed_rmse_mps, 2),
        number(errors.course_rms_deg),
    ]


def _tail(score: Score) -> str:
    total = score.overall
    tail = (
        f"false tracks {total.false_tracks} ({total.false_track_scans_per_scan:.2f} per scan), "
        f"GOSPA {metres(total.gospa_m)}, gate {score.gate_m:g} m"
    )
    targets = [target for episode in score.episodes for target in episode.targets]
    if targets and not total.eligible_scans:
        known = max(target.present_scans for target in targets)
        near = max(target.supported_scans for target in targets)
        tail += (
            f"\nno scan counts: of {total.scans} scans at most {known} have the truth of a target, "
            f"{near} of these with plots near it, and the first {score.warmup_scans} do not count"
        )
    left_out = sum(episode.unmatched_rows for episode in score.episodes)
    if left_out:
        tail += f"\n{many(left_out, 'row')} of tracks not at a scan's time, or not finite, left out"
    return tail
