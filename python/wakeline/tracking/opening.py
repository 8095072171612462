"""Open a recording: an object, a bundled one by name, or a file of plots or radar video."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from wakeline.extraction import read_plots_of_video
from wakeline.recording import (
    OwnShipMotion,
    Recording,
    is_video,
    load,
    names,
    read_own_ship,
    read_plots,
)


def open_recording(
    recording: Recording | str | Path,
    own: OwnShipMotion | str | Path | None = None,
    truth: str | Path | None = None,
    *,
    period_s: float | None = None,
    azimuth: str = "north",
    range_scale_m: float | None = None,
    min_range_m: float = 0.0,
    columns: Mapping[str, str] | None = None,
) -> Recording:
    """Open a recording.

    Parameters
    ----------
    recording : Recording, str or Path
        A recording, the name of a bundled one, or a file of plots (CSV) or radar video (ASTERIX
        category 240, also in a network capture or in ASTERIX final format), which may be compressed
        (gzip, bzip2, xz). A file takes precedence over a bundled recording of the same name.
    own : OwnShipMotion, str or Path, optional
        Own ship, or its file. For plots and video in a file it must be a file, and the radar is
        there; in a recording that is open it replaces own ship, and plots stay where they are.
    truth : str or Path, optional
        Truth; for plots in a file.
    period_s : float, optional
        Time of an antenna revolution. Groups plots without a scan number, and replaces missing
        times of video.
    range_scale_m : float, optional
        The range scale to read of video with several in turn; default the longest.
    min_range_m : float
        Nearer cells of video give no plots; 0: 40 m, or a tenth of a shorter range scale.
    columns : dict of str to str, optional
        Names of columns in files of plots, own ship and truth and what they are, as for
        :func:`wakeline.recording.read_plots`.
    azimuth : str
        Origin of the azimuths in a file: "north", or "bow" with own ship's heading.

    Raises
    ------
    RecordingError
        When a file cannot be read.
    ValueError
        When `truth` is given for anything but plots in a file, or `azimuth` is invalid, or "bow"
        for a recording that is open.
    TypeError
        When `own` is not a file where it must be one.
    """
    path = None if isinstance(recording, Recording) else Path(recording)
    if path is not None and str(path) in names() and not path.exists():
        recording, path = load(str(path)), None
    from_video = path is not None and path.is_file() and is_video(path)
    if truth is not None and (path is None or from_video):
        raise ValueError(f"truth goes with a file of plots, got {recording} with {truth}")
    if path is None:
        if azimuth != "north":
            raise ValueError(f"azimuth {azimuth!r} is for recordings in a file")
        return recording if own is None else _with_own(recording, own)
    if isinstance(own, OwnShipMotion):
        raise TypeError(f"own must be a file for the recording in {path}, got {own!r}")
    if from_video:
        return read_plots_of_video(
            path,
            own,
            period_s=period_s,
            azimuth=azimuth,
            range_scale_m=range_scale_m,
            min_range_m=min_range_m,
            columns=columns,
        )
    return read_plots(path, own, truth, period_s=period_s, azimuth=azimuth, columns=columns)


def _with_own(recording: Recording, own: OwnShipMotion | str | Path) -> Recording:
    ship = own if isinstance(own, OwnShipMotion) else read_own_ship(own)
    return replace(recording, episodes=[replace(episode, own=ship) for episode in recording])
