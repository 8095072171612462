"""``wakeline track``: tracks and pictures of a recording."""

from __future__ import annotations

import argparse
import math
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from wakeline import FilterError, metrics
from wakeline._brief import many
from wakeline.extraction import VideoRecording
from wakeline.recording import Recording
from wakeline.recording.files import replacing_together
from wakeline.tracking import (
    VESSELS,
    DangerLimits,
    Encounter,
    Settings,
    TrackedEpisode,
    TrackedRecording,
    follow_video,
    has_names,
    median_step_s,
    read_settings,
    smooth_episode,
    track_episode,
    write_tables,
)

from . import options, outputs, report

_MOST_ALARMS, _MOST_ENCOUNTERS = 20, 10

_ABOUT = """\
Tracks the plots of a recording and writes tracks.csv, events.csv,
plots_tracks.csv, encounters.csv (vessels that come dangerously close to each
other) and pictures; with --own also the closest approach of each track, and
alarms.csv, the encounters with own ship. Plots are extracted from radar video first, with
thresholds and plot errors estimated from it, and its last revolution is drawn
as ppi.png. Video has the time of day only; its date is that of --own. Where its
clock is set back a scenario begins: part-2 and so on.

With --method strobe, each vessel of radar video is measured in a strobe around
its predicted position; plots are then what was measured in the strobes. Vessels
are acquired from extracted plots, or where --acquire points.

Plots without a scan number are grouped by antenna revolution (period_s of
--radar, else estimated).

Each value of a scenario column is tracked from a fresh start; the first 20 are
drawn. If one of several scenarios fails, the files of the previous ones are
written with -partial in their names, and files of an earlier run are kept;
otherwise files of an earlier run that this run does not write are removed.
"""
_COLUMNS = """\
columns, separated by commas, recognized by name in any order:
  RECORDING  time_s (UTC seconds or ISO 8601); range_m or range_nm and
             bearing_deg or bearing_rad from true north (or from the bow with
             --azimuth bow), or north_m and east_m;
             optional scan, scenario, own_north_m, own_east_m
  --own      time_s, north_m, east_m; optional scan, scenario, vnorth_mps,
             veast_mps, heading_deg, vnorth_var_m2s2, vnorth_veast_cov_m2s2,
             veast_var_m2s2, status; own.csv of wakeline navigate has this form
  --acquire  time_s, north_m, east_m; optional position_std_m
  --truth    time_s, target, north_m, east_m; optional vnorth_mps, veast_mps,
             scenario
  --radar    keys of a TOML file: range_std_m, bearing_std_deg, extent_std_m,
             period_s, max_speed_mps, bearing_offset_deg, range_offset_m,
             time_offset_s (wakeline calibrate writes such a file), min_range_m, max_range_m,
             blind_from_deg, blind_to_deg, correlation_time_s
"""


def add_to(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command to its parser."""
    parser.description = _ABOUT
    parser.epilog = _COLUMNS
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument(
        "plots",
        nargs="?",
        type=Path,
        metavar="RECORDING",
        help="radar plots as CSV, or radar video: ASTERIX category 240, also in a network capture "
        "(pcap) or compressed (gzip)",
    )
    options.add_own(parser)
    parser.add_argument("--truth", type=Path, metavar="TRUTH.csv", help="truth, drawn and scored")
    options.add_columns(parser)
    parser.add_argument(
        "--range-scale",
        type=float,
        metavar="M",
        help="of radar video with several range scales in turn, the one to track, by its range in "
        "metres (default the longest)",
    )
    options.add_radar(parser)
    parser.add_argument(
        "--vessels",
        choices=VESSELS,
        help="motion models: any (default; ships and small craft) or ships (merchant ships under "
        "way); overrides [models] of --config",
    )
    parser.add_argument(
        "--method",
        choices=("plots", "strobe"),
        default="plots",
        help="of tracking radar video: extracted plots (default), or a strobe on each vessel",
    )
    parser.add_argument(
        "--acquire",
        type=Path,
        metavar="FILE",
        help="CSV of vessels to be acquired, with --method strobe; default: from extracted plots",
    )
    parser.add_argument(
        "--smooth",
        action="store_true",
        help="smooth the tracks after the recording: each row also uses the plots after it",
    )
    parser.add_argument(
        "--config", type=Path, metavar="F.toml", help="settings, in the form of --print-config"
    )
    options.add_results(parser, "counts, and scores with --truth")
    parser.add_argument(
        "--print-config", action="store_true", help="print every setting with its explanation"
    )
    parser.set_defaults(run=run, inputs=inputs)


def run(arguments: argparse.Namespace) -> None:
    """Do what the command line asks for."""
    settings = read_settings(arguments.config, arguments.radar, arguments.vessels)
    if arguments.print_config:
        print(settings.toml(), end="")
        return
    if arguments.plots is None:
        raise ValueError("track needs a recording (see wakeline track --help)")
    outputs.check_no_input("--out", outputs.of_tracking(arguments.out), inputs(arguments))
    recording, track = _opened(arguments, settings)
    options.columns_of(arguments).require_found()
    known = settings.knowing(recording.radar)
    recording.notes.extend(known.memory_notes(arguments.method))
    radar = _radar_text(arguments, settings, known, recording)
    danger = arguments.own is not None
    tracks = track_into(
        arguments.out,
        recording,
        known,
        radar,
        danger=danger,
        smooth=arguments.smooth,
        track=track,
    )
    rows = _rows(tracks.episodes, arguments.plots.name)
    if arguments.truth is not None:
        score = metrics.score(tracks, tracks.recording)
        print(f"\n{report.score_table(score)}")
        scores = report.score_rows(score, arguments.plots.name)
        rows = [scored | row for scored, row in zip(scores, rows, strict=True)]
    if arguments.json is not None:
        outputs.write_json(arguments.json, "track", rows)
    draw_into(arguments.out, tracks)


def _opened(
    arguments: argparse.Namespace, settings: Settings
) -> tuple[Recording, Callable[..., TrackedEpisode]]:
    """The recording, and what tracks an episode of it."""
    if arguments.method == "plots":
        if arguments.acquire is not None:
            raise ValueError("--acquire goes with --method strobe")
        opened = options.opened(
            arguments, settings, truth=arguments.truth, range_scale_m=arguments.range_scale
        )
        return opened, track_episode
    if arguments.truth is not None:
        raise ValueError("--truth goes with plots, not with --method strobe")
    return follow_video(
        arguments.plots,
        settings,
        own=arguments.own,
        acquire=arguments.acquire,
        azimuth=arguments.azimuth,
        range_scale_m=arguments.range_scale,
        columns=options.columns_of(arguments),
    )


def inputs(arguments: argparse.Namespace) -> list[Path]:
    """The input files of the command line."""
    return options.files(arguments, "plots", "own", "truth", "config", "acquire")


def _radar_text(
    arguments: argparse.Namespace, given: Settings, used: Settings, recording: Recording
) -> str:
    """Source of the radar parameters."""
    if used != given:
        if not isinstance(recording, VideoRecording):
            return f"radar {recording.name}"
        range_std_m, bearing_std_rad = recording.plot_std
        errors = f"{range_std_m:.1f} m, {math.degrees(bearing_std_rad):.2f}°"
        return f"radar errors estimated from its echoes: {errors}"
    if arguments.radar:
        return f"radar {arguments.radar}"
    default = used.radar == Settings.default().radar
    return "radar by default" if default else f"radar of {arguments.config.name}"


def track_into(
    folder: Path,
    recording: Recording,
    settings: Settings,
    radar: str,
    *,
    danger: bool = False,
    smooth: bool = False,
    track: Callable[..., TrackedEpisode] = track_episode,
) -> TrackedRecording:
    """Track every episode, write tables into `folder`, and print a report.

    The files of an earlier run are replaced together. With `danger`, own ship is watched, too.
    With `smooth`, the tracks are smoothed.
    """
    outputs.make_folder(folder)
    print(_input_lines(recording, settings, radar), flush=True)
    parts: list[TrackedEpisode] = []
    try:
        for episode in recording:
            own, named = episode.own if danger else None, has_names(recording)
            part = track(episode, settings, own=own, named=named)
            parts.append(smooth_episode(part, settings) if smooth else part)
    except (ValueError, FilterError, MemoryError, KeyboardInterrupt):
        if parts:
            with replacing_together(folder, outputs.partial_tables(folder)) as fresh:
                files = write_tables(fresh, parts, outputs.PARTIAL)
            print(f"of the previous scenarios: {_listed(files)}", file=sys.stderr)
        raise
    with replacing_together(folder, outputs.of_tracking(folder)) as fresh:
        files = write_tables(fresh, parts)
    print(_track_lines(parts))
    if danger:
        print(_alarm_lines(parts, settings.danger_limits))
    for line in _encounter_lines(parts, settings.danger_limits):
        print(line)
    print(f"written to {folder}: {_listed(files)}", flush=True)
    return TrackedRecording.of(recording, parts, settings)


def draw_into(folder: Path, tracks: TrackedRecording) -> None:
    """Draw the first episodes and print the files; last, because it takes longest."""
    if not outputs.can_draw():
        print(outputs.HOW_TO_GET_PICTURES)
        return
    if len(tracks.episodes) > outputs.MOST_DRAWN:
        which = f"the first {outputs.MOST_DRAWN} of {len(tracks.episodes)} scenarios"
        print(f"note: {which} are drawn", flush=True)
    print(f"drawn in {folder}: {_listed(outputs.write_pictures(folder, tracks))}")


def _input_lines(recording: Recording, settings: Settings, radar: str) -> str:
    scans = sum(map(len, recording.episodes))
    plots = sum(episode.plot_count for episode in recording)
    scenarios = f", {len(recording)} scenarios" if len(recording) > 1 else ""
    counts = f"{many(scans, 'scan')}, {many(plots, 'plot')}{scenarios}"
    lines = [f"{recording.name}: {counts}"]
    lines += [f"note: {note}" for note in recording.notes]
    lines.append(f"{radar}, period {_period(recording, settings)}; vessels: {settings.vessels}")
    return "\n".join(lines)


def _period(recording: Recording, settings: Settings) -> str:
    if settings.period_s:
        return f"{settings.period_s:g} s"
    steps_s = [step for step in map(median_step_s, recording) if step]
    if not steps_s:
        return "by default"
    low, high = (f"{step:.3g}" for step in (min(steps_s), max(steps_s)))
    return f"{low if low == high else f'{low} to {high}'} s as between the scans"


def _track_lines(parts: Sequence[TrackedEpisode]) -> str:
    tracks = sum(len(part.tracks.ids()) for part in parts)
    rows = sum(len(part.tracks) for part in parts)
    coasting = sum(Counter(part.tracks.status.tolist())["coasting"] for part in parts)
    lines = [f"{many(tracks, 'track')} in {many(rows, 'row')}, {coasting} of them coasting"]
    rejected = sum(part.rejected_plots for part in parts)
    if rejected:
        lines.append(f"note: {many(rejected, 'plot')} rejected by the tracker")
    return "\n".join(lines)


def _alarm_lines(parts: Sequence[TrackedEpisode], limits: DangerLimits) -> str:
    known = [part for part in parts if part.alarms is not None]
    if not known:
        return "note: no closest approaches, because own ship's velocity is unknown"
    alarms = [(part.episode.name, alarm) for part in known for alarm in part.alarms]
    plural = "" if len(alarms) == 1 else "s"
    head = f"{len(alarms) or 'no'} alarm{plural} of tracks {_closer(limits)}"
    return "\n".join([head, *_listed_encounters(alarms, _MOST_ALARMS, "alarms.csv")])


def _encounter_lines(parts: Sequence[TrackedEpisode], limits: DangerLimits) -> list[str]:
    """The encounters of tracks with each other, if there are any."""
    encounters = [(p.episode.name, one) for p in parts for one in p.encounters]
    encounters = [(name, one) for name, one in encounters if not one.with_own_ship]
    if not encounters:
        return []
    head = f"{many(len(encounters), 'encounter')} of tracks with each other, {_closer(limits)}"
    return [head, *_listed_encounters(encounters, _MOST_ENCOUNTERS, "encounters.csv")]


def _closer(limits: DangerLimits) -> str:
    return f"closer than {limits.cpa_limit_m:.0f} m within {limits.tcpa_limit_s / 60.0:g} min"


def _listed_encounters(
    encounters: Sequence[tuple[str, Encounter]], most: int, file: str
) -> Iterator[str]:
    for name, one in encounters[:most]:
        yield f"  {f'{name}, ' if name else ''}{one}"
    if len(encounters) > most:
        yield f"  and {len(encounters) - most} more in {file}"


def _listed(files: Sequence[Path]) -> str:
    return ", ".join(file.name for file in files)


def _rows(parts: Sequence[TrackedEpisode], file: str) -> list[dict[str, Any]]:
    rows = [_row(part.episode.name or file, [part]) for part in parts]
    return [*rows, _row(report.ALL, parts)]


def _row(scenario: str, parts: Sequence[TrackedEpisode]) -> dict[str, Any]:
    scans = sum(len(part.episode) for part in parts)
    elapsed_ms = 1e3 * sum(part.elapsed_s for part in parts)
    return {
        "scenario": scenario,
        "estimator": "tracks",
        "scans": scans,
        "plots": sum(part.episode.plot_count for part in parts),
        "tracks": sum(len(part.tracks.ids()) for part in parts),
        "track_scans": sum(len(part.tracks) for part in parts),
        "rejected_plots": sum(part.rejected_plots for part in parts),
        "ms_per_scan": elapsed_ms / scans if scans else None,
    }
