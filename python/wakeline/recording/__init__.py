"""Radar plots, own ship, truth and tracks in files, and the recordings that ship with Wakeline.

>>> from wakeline import recording
>>> joyride = recording.load("joyride")
>>> len(joyride.episodes[0].scans)
115
"""

from __future__ import annotations

from importlib import resources

from .errors import RecordingError
from .files import replacing
from .model import Episode, OwnShip, Recording, Scan
from .plots_csv import read_plots
from .tracks_csv import Tracks, read_tracks, write_tracks
from .truth import TargetTruth

__all__ = [
    "Episode",
    "OwnShip",
    "Recording",
    "RecordingError",
    "Scan",
    "TargetTruth",
    "Tracks",
    "load",
    "names",
    "read_plots",
    "read_tracks",
    "replacing",
    "write_tracks",
]


def names() -> list[str]:
    """Names of the recordings that ship with the package."""
    return sorted(folder.name for folder in _data().iterdir() if folder.is_dir())


def load(name: str) -> Recording:
    """Open a recording that ships with the package.

    Parameters
    ----------
    name : str
        One of ``names()``: "joyride", a fast boat that keeps turning, from a moving own ship;
        "autoferry", two boats near a slow ferry, five scenarios. Source and licence lie beside the
        data.

    Returns
    -------
    Recording
        With own ship and truth.

    Raises
    ------
    ValueError
        When there is no recording of that name.
    """
    if name not in names():
        raise ValueError(f"no recording {name!r}; there are {', '.join(names())}")
    with resources.as_file(_data() / name) as folder:
        plots, scans, truth = (folder / f"{kind}.csv" for kind in ("plots", "scans", "truth"))
        return read_plots(plots, scans, truth, name=name)


def _data():
    return resources.files(__name__) / "data"
