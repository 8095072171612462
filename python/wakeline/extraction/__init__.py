"""Plots from radar video, as a recording that can be tracked.

>>> from wakeline import extraction
>>> film = extraction.read_plots_of_video("radar.cat240")  # doctest: +SKIP
>>> film.recording.episodes[0].scans[0].range_bearing  # doctest: +SKIP
"""

from __future__ import annotations

from .film import VideoRecording, read_plots_of_video
from .noise import Noise, noise_of

__all__ = ["Noise", "VideoRecording", "noise_of", "read_plots_of_video"]
