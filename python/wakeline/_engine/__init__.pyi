"""The C++ engine of Wakeline."""

from . import association, batch, benchmark, core, eval, filter, gating, measurement, motion, multimodel, navigation, track, video, wire

__all__ = ['association', 'batch', 'benchmark', 'core', 'eval', 'filter', 'gating', 'measurement', 'motion', 'multimodel', 'navigation', 'track', 'video', 'wire']
