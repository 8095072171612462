"""Descriptions of the radars of the bundled recordings."""

from __future__ import annotations

import sys
from importlib import resources

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def radar_names() -> list[str]:
    """Names of the radars that ship with the package, each that of its recording."""
    folders = (folder for folder in _data().iterdir() if folder.is_dir())
    return sorted(folder.name for folder in folders if (folder / "radar.toml").is_file())


def load_radar(name: str) -> dict[str, float]:
    """The description of a radar that ships with the package, by the keys of ``[radar]``.

    Raises
    ------
    ValueError
        When no radar has that name.
    """
    if name not in radar_names():
        raise ValueError(f"no radar {name!r}; there are {', '.join(radar_names())}")
    return tomllib.loads((_data() / name / "radar.toml").read_text(encoding="utf-8"))


def _data():
    return resources.files(__package__) / "data"
