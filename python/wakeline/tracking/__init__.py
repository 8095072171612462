"""Tracking of whole recordings: settings, tracks, dangerous encounters.

:func:`track_recording` is all that most programs need:

>>> import wakeline as wl
>>> len(wl.track_recording("joyride").ids())
1

:func:`track_episode` tracks one episode, :func:`smooth_episode` smooths its tracks,
:func:`tune` finds settings from plots alone,
:func:`open_recording` opens a recording, and :class:`Settings` are the contents of a settings file.
:func:`watch_tracks` finds the vessels that come dangerously close to each other or to own ship.
:func:`wakeline.recording.scan_numbers` groups plots into scans.
"""

from __future__ import annotations

from .calibrated import RadarTrack, calibrate, read_reports, reports_of
from .encounters import (
    DangerLimits,
    DangerZone,
    Encounter,
    Watched,
    watch_tracks,
    with_closest_approach,
)
from .opening import open_recording
from .settings import VESSELS, Settings, SettingsError, read_settings
from .smoothing import smooth_episode
from .strobes import Designation, follow_video, read_designations
from .tables import write_tables
from .tracked import (
    MODE_NAMES,
    TrackedEpisode,
    TrackedRecording,
    has_names,
    median_step_s,
    track_episode,
    track_recording,
)
from .tuning import TunedParameter, Tuning, tune

__all__ = [
    "MODE_NAMES",
    "VESSELS",
    "DangerLimits",
    "DangerZone",
    "Designation",
    "Encounter",
    "RadarTrack",
    "Settings",
    "SettingsError",
    "TrackedEpisode",
    "TrackedRecording",
    "TunedParameter",
    "Tuning",
    "Watched",
    "calibrate",
    "follow_video",
    "has_names",
    "median_step_s",
    "open_recording",
    "read_designations",
    "read_reports",
    "read_settings",
    "reports_of",
    "smooth_episode",
    "track_episode",
    "track_recording",
    "tune",
    "watch_tracks",
    "with_closest_approach",
    "write_tables",
]
