"""Simulated radar video: the amplitude in every cell of every sweep."""

from .clutter import Land, SeaClutter
from .examples import VideoScene, radar_screen, small_craft_scene, strait_scene
from .radar import RadarVideoSimulator
from .target import AnyMotion, VideoTarget

__all__ = [
    "AnyMotion",
    "Land",
    "RadarVideoSimulator",
    "SeaClutter",
    "VideoScene",
    "VideoTarget",
    "radar_screen",
    "small_craft_scene",
    "strait_scene",
]
