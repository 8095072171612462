"""Scenarios: truth as a function of time, and a simulated radar that looks at it."""

from .radar import RadarSimulator
from .truth import Segment, Truth

__all__ = ["RadarSimulator", "Segment", "Truth"]
