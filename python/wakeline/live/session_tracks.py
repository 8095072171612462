"""Tracks of a recorded session."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from wakeline.recording import Tracks

from .config import config_of
from .record import read_session
from .service import feed_record
from .session import Session


def session_tracks(path: str | Path) -> tuple[Tracks, tuple[float, float] | None]:
    """The tracks of a session file (``wakeline live --record``), one row per reported update.

    The session is replayed as fast as it goes. The id of a track is its number, followed by the
    name that operators gave it or, without one, by the identity that it reported.

    Returns
    -------
    Tracks
    (float, float) or None
        Latitude and longitude, degrees, of north 0, east 0; None where the session has no position.

    Raises
    ------
    RecordingError
        When the file is no session.
    """
    rows: list[dict[str, Any]] = []
    session = Session()
    for record in read_session(path):
        if "settings" in (record.values or {}) and not rows and session.time_s == -np.inf:
            config = config_of(record.values["settings"], path)
            session = Session(replace(config, inputs=(), outputs=()))
            session.listeners.append(
                lambda kind, values: rows.append(values) if kind == "track" else None
            )
        feed_record(session, record)
    plane = session.plane
    origin_deg = None
    if plane is not None:
        origin_deg = tuple(np.degrees([plane.latitude_rad, plane.longitude_rad]).tolist())
    if not rows:
        return Tracks([], [], np.zeros((0, 4))), origin_deg
    labels = {row["track_id"]: row["name"] or row["identity"] for row in rows}
    ids = [f"{row['track_id']} {labels[row['track_id']]}".rstrip() for row in rows]
    state = [[row[key] for key in ("north_m", "vnorth_mps", "east_m", "veast_mps")] for row in rows]
    tracks = Tracks(
        track_id=ids,
        time_s=[row["time_s"] for row in rows],
        state=state,
        covariance=[row["covariance"] for row in rows],
        status=[row["status"] for row in rows],
    )
    return tracks, origin_deg
