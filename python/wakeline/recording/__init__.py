"""Files of radar plots, own ship, truth, tracks, AIS and NMEA 0183; bundled recordings.

>>> from wakeline import recording
>>> joyride = recording.load("joyride")
>>> len(joyride.episodes[0].scans)
115
"""

from __future__ import annotations

from dataclasses import replace
from importlib import resources

from .ais_csv import AisRecording, AisTrack, read_ais
from .asterix_video import VideoReport, is_video, read_video, write_video
from .errors import RecordingError
from .files import replacing
from .imu_csv import read_imu, write_imu
from .model import Episode, OwnShipMotion, Recording, Scan
from .nmea import NavigationLog, NmeaProblem, NmeaReport, read_nmea
from .own_csv import read_own_ship
from .plots_csv import read_plots
from .plots_writer import write_plots
from .radars import load_radar, radar_names
from .scans import revolution_s, scan_numbers
from .tracks_csv import Tracks, read_tracks, write_tracks
from .tracks_export import export_tracks
from .truth import TargetTruth
from .video import RadarVideo

__all__ = [
    "AisRecording",
    "AisTrack",
    "Episode",
    "NavigationLog",
    "NmeaProblem",
    "NmeaReport",
    "OwnShipMotion",
    "RadarVideo",
    "Recording",
    "RecordingError",
    "Scan",
    "TargetTruth",
    "Tracks",
    "VideoReport",
    "export_tracks",
    "is_video",
    "load",
    "load_ais",
    "load_imu",
    "load_lidar",
    "load_navigation",
    "load_radar",
    "names",
    "radar_names",
    "read_ais",
    "read_imu",
    "read_nmea",
    "read_own_ship",
    "read_plots",
    "read_tracks",
    "read_video",
    "replacing",
    "revolution_s",
    "scan_numbers",
    "write_imu",
    "write_plots",
    "write_tracks",
    "write_video",
]


def names() -> list[str]:
    """Names of the bundled radar recordings."""
    return sorted(f.name for f in _data().iterdir() if f.is_dir() and (f / "plots.csv").is_file())


def load(name: str) -> Recording:
    """Open a bundled recording.

    Parameters
    ----------
    name : str
        One of ``names()``: "joyride", a fast boat that keeps turning, from a moving own ship;
        "autoferry", two boats near a slow ferry, five scenarios. Source and license are in the
        folder of the data.

    Returns
    -------
    Recording
        With own ship, truth and the description of its radar.

    Raises
    ------
    ValueError
        When no recording has that name.
    """
    if name not in names():
        raise ValueError(f"name must be one of {', '.join(names())}, got {name!r}")
    with resources.as_file(_data() / name) as folder:
        plots, scans, truth = (folder / f"{kind}.csv" for kind in ("plots", "scans", "truth"))
        return replace(read_plots(plots, scans, truth, name=name), radar=load_radar(name))


def load_ais() -> AisRecording:
    """The bundled AIS tracks: 14 vessels that maneuver in the Solent in 2016.

    Source and license are in the folder of the data.
    """
    with resources.as_file(_data() / "solent") as folder:
        return read_ais(folder / "ais.csv")


def load_lidar() -> Recording:
    """The lidar of the bundled recording "autoferry": its points in the same five scenarios.

    The scenarios, own ship and truth are those of ``load("autoferry")``.
    """
    with resources.as_file(_data() / "autoferry") as folder:
        plots, scans, truth = (
            folder / f"{kind}.csv" for kind in ("lidar_plots", "lidar_scans", "truth")
        )
        return read_plots(plots, scans, truth, name="autoferry lidar")


def load_navigation(*, variation_deg: float | None = None) -> NavigationLog:
    """The bundled log of own ship's instruments: a yacht in a race, 77 minutes.

    Position, speed and course over ground, magnetic heading and speed through the water. Source and
    license are in the folder of the data.

    Parameters
    ----------
    variation_deg : float, optional
        Magnetic variation, positive east, which the log does not contain.
    """
    with resources.as_file(_data() / "irene") as folder:
        return read_nmea(folder / "irene.nmea", variation_deg=variation_deg)


def load_imu() -> NavigationLog:
    """The bundled log of an IMU with GNSS and compass: a simulated mission of 6 minutes.

    ``scenario.USV_EXAMPLE.write_log`` makes it; one minute of it is without GNSS.
    """
    with resources.as_file(_data() / "usv") as folder:
        return read_imu(folder / "usv.csv")


def _data():
    return resources.files(__name__) / "data"
