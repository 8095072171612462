"""Hypothesis without deadlines: a busy machine is no defect."""

from hypothesis import settings

settings.register_profile("wakeline", deadline=None)
settings.load_profile("wakeline")
