"""Scenes: a strait with ships, and a small craft that turns hard far out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from wakeline._checks import whole_number
from wakeline.recording import RadarVideo

from ..hard_turn import HardTurn
from ..truth import Truth
from .clutter import Land, SeaClutter
from .radar import RadarVideoSimulator
from .target import VideoTarget

_FULL_CIRCLE = 2.0 * np.pi
_STRAIT_STREAM = 0x57A1
_CRAFT_STREAM = 0xC2AF


@dataclass(frozen=True)
class VideoScene:
    """A radar and its targets.

    Attributes
    ----------
    radar : RadarVideoSimulator
    targets : mapping of str to VideoTarget
        By name.
    """

    radar: RadarVideoSimulator
    targets: Mapping[str, VideoTarget] = field(default_factory=dict)

    def turns(self, scans: int, seed: int = 0) -> Iterator[RadarVideo]:
        """Consecutive revolutions: :meth:`RadarVideoSimulator.turns`."""
        return self.radar.turns(self.targets, scans, seed)


def radar_screen(seed: int = 0) -> RadarVideo:
    """One revolution of a radar on the shore of a strait: coast, islands, sea, ships, noise.

    Parameters
    ----------
    seed : int
        Not negative; of the scene, :func:`strait_scene`, and of its noise.

    Returns
    -------
    RadarVideo
        4096 sweeps of 2048 cells, out to 12 km.

    Examples
    --------
    >>> from wakeline import scenario
    >>> scenario.radar_screen(seed=3).amplitude.shape
    (4096, 2048)
    """
    return next(strait_scene(seed).turns(1, seed))


def strait_scene(seed: int = 0) -> VideoScene:
    """A strait: two coasts, islands, two lanes with ships, craft, buoys, and wind.

    Parameters
    ----------
    seed : int
        Not negative. The radar has 4096 sweeps of 2048 cells of 6 m, a period of 3 s and a
        logarithmic receiver of 8 bits.
    """
    whole_number("seed", seed, 0)
    rng = np.random.default_rng([seed, _STRAIT_STREAM])
    along_rad = rng.uniform(0.0, _FULL_CIRCLE)
    radar = RadarVideoSimulator(
        beam_width_rad=np.deg2rad(1.2),
        pulse_length_m=30.0,
        snr_db=20.0,
        receiver="logarithmic",
        noise_rms=40.0,
        dynamic_range_db=70.0,
        sea=SeaClutter(
            clutter_to_noise_db=-6.0,
            decay=3.5,
            shape=0.8,
            correlation_m=90.0,
            wind_from_rad=rng.uniform(0.0, _FULL_CIRCLE),
            upwind_downwind_db=8.0,
        ),
        land=Land(
            where=_strait(rng, along_rad),
            shape=0.4,
            correlation_m=300.0,
            clutter_to_noise_db=36.0,
            penetration_m=1300.0,
        ),
    )
    return VideoScene(radar, _traffic(rng, along_rad))


def small_craft_scene(
    seed: int = 0,
    *,
    situation: HardTurn | None = None,
    beam_cells: float = 4.0,
    margin_m: float = 300.0,
) -> VideoScene:
    """A craft of 15 m far out in sea clutter: a straight, a hard turn, a straight.

    The scenario of V. M. Grinyak and M. V. Trofimov, "Multi-model tracking of moving vessels with
    a fuzzy criterion of maneuver detection": cells of 0.03 degrees and 6 m, a period of 3 s, a turn
    of 300 m radius at 10 or 20 m/s. Our choices: range and legs (see :class:`HardTurn`), beam,
    pulse, and the power of echo and clutter.

    Parameters
    ----------
    seed : int
        Not negative; of position, course and side of the turn.
    situation : HardTurn, optional
        Speed, radius, range, legs, cells and period; default 10 m/s and 300 m.
    beam_cells : float
        Width of the beam in azimuth cells. At 4 of them an echo 20 km away is 42 m wide, near the
        paper's gates of 22 and 27 m radius; coastal antennas in service have 10 and more.
    margin_m : float
        Margin around the craft's path within which the radar is simulated.

    Returns
    -------
    VideoScene
        The target is called "craft"; its truth is a :class:`Truth`.

    Raises
    ------
    ValueError
        When the seed is negative or not an integer, the beam is narrower than a cell, or the
        path and its margin reach the antenna.
    """
    whole_number("seed", seed, 0)
    situation = HardTurn(10.0, 300.0) if situation is None else situation
    truth = situation.truth(np.random.default_rng([seed, _CRAFT_STREAM]))
    radar = RadarVideoSimulator(
        sweeps_per_turn=round(_FULL_CIRCLE / situation.azimuth_cell_rad),
        cell_m=situation.range_cell_m,
        period_s=situation.period_s,
        beam_width_rad=beam_cells * situation.azimuth_cell_rad,
        pulse_length_m=2.0 * situation.range_cell_m,
        snr_db=22.0,
        sea=SeaClutter(clutter_to_noise_db=19.0, shape=1.0, correlation_m=40.0, correlation_s=6.0),
    )
    way_m = truth.state_at(np.append(situation.time_s, truth.end_time_s))[:, 0::2]
    return VideoScene(
        radar.around(way_m, margin_m),
        {"craft": VideoTarget(truth=truth, length_m=15.0, beam_m=4.0, rcs_m2=30.0)},
    )


def _strait(rng: np.random.Generator, along_rad: float) -> list[NDArray[np.float64]]:
    """Outlines of both coasts and of some islands; the antenna is off the near one."""
    islands = [
        _island(rng, place, radius_m)
        for place, radius_m in (
            (-7600.0 + 900.0j, 300.0),
            (3900.0 + 6400.0j, 600.0),
            (1500.0 + 5900.0j, 170.0),
            (-1600.0 + 6900.0j, 330.0),
        )
    ]
    near = _coast(rng, shore_m=-150.0, inland_m=-16_000.0, roughness_m=1100.0, calm_m=900.0)
    far = _coast(rng, shore_m=8200.0, inland_m=16_000.0, roughness_m=1700.0)
    turned = np.exp(1j * along_rad)
    return [_corners(outline * turned) for outline in (near, far, *islands)]


def _coast(
    rng: np.random.Generator,
    *,
    shore_m: float,
    inland_m: float,
    roughness_m: float,
    calm_m: float = 0.0,
) -> NDArray[np.complex128]:
    """A coast along the real axis, from -16 to 16 km, as a closed outline.

    The shore is a curve of self-similar roughness that only removes land, smooth within `calm_m`
    of the origin.
    """
    along_m = np.linspace(-16_000.0, 16_000.0, 513)
    rough_m = roughness_m * _self_similar(rng, len(along_m))
    if calm_m:
        rough_m *= 1.0 - np.exp(-((along_m / calm_m) ** 2))
    shore = along_m + 1j * (shore_m + np.copysign(rough_m, inland_m))
    return np.concatenate([shore, [16_000.0 + 1j * inland_m, -16_000.0 + 1j * inland_m]])


def _island(rng: np.random.Generator, place: complex, radius_m: float) -> NDArray[np.complex128]:
    around_rad = np.linspace(0.0, _FULL_CIRCLE, 96, endpoint=False)
    swell = sum(
        rng.normal(0.0, 0.35 / k) * np.cos(k * around_rad + rng.uniform(0.0, _FULL_CIRCLE))
        for k in range(1, 12)
    )
    return place + radius_m * np.exp(0.8 * swell + 1j * around_rad)


def _self_similar(rng: np.random.Generator, count: int) -> NDArray[np.float64]:
    """A rough curve of unit variance: waves of all lengths, the long ones higher."""
    number = np.arange(1, count // 2)
    phase = rng.uniform(0.0, _FULL_CIRCLE, len(number))
    at = np.linspace(0.0, 1.0, count)[:, None]
    curve = np.cos(_FULL_CIRCLE * number * at + phase) @ (number**-1.3)
    return (curve - curve.mean()) / curve.std()


def _traffic(rng: np.random.Generator, along_rad: float) -> dict[str, VideoTarget]:
    """Ships in two lanes along the strait, craft that cross it, and buoys between the lanes."""
    turned = np.exp(1j * along_rad)
    targets = {}

    def add(name: str, place: complex, velocity: complex, **hull: float) -> None:
        place, velocity = place * turned, velocity * turned
        truth = Truth([place.real, velocity.real, place.imag, velocity.imag])
        targets[name] = VideoTarget(truth=truth, **hull)

    for lane, (aside_m, way) in enumerate(((2500.0, 1.0), (4100.0, -1.0))):
        for k, along_m in enumerate((-8200.0, -4300.0, 900.0, 5400.0)):
            place = along_m + rng.normal(0.0, 900.0) + 1j * (aside_m + rng.normal(0.0, 180.0))
            length_m = rng.choice([70.0, 110.0, 160.0, 230.0])
            add(
                f"ship {4 * lane + k + 1}",
                place,
                way * rng.uniform(5.0, 9.0),
                length_m=length_m,
                beam_m=length_m / 6.5,
                rcs_m2=0.12 * length_m**2,
                broadside_db=10.0,
            )
    for k in range(6):
        place = rng.uniform(-6500.0, 6500.0) + 1j * rng.uniform(900.0, 5000.0)
        course = np.exp(1j * rng.uniform(0.0, _FULL_CIRCLE))
        add(
            f"craft {k + 1}",
            place,
            rng.uniform(4.0, 14.0) * course,
            length_m=15.0,
            beam_m=4.0,
            rcs_m2=25.0,
        )
    for k, along_m in enumerate(np.arange(-7500.0, 7501.0, 2500.0)):
        add(f"buoy {k + 1}", along_m + 3300.0j, 0.0, rcs_m2=8.0, swerling=3)
    return targets


def _corners(outline: NDArray[np.complex128]) -> NDArray[np.float64]:
    return np.column_stack([outline.real, outline.imag])
