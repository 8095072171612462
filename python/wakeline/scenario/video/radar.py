"""Simulated radar video: vessels, sea, land and noise in every cell of every sweep."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wakeline._checks import (
    finite,
    not_negative,
    number_fields,
    positive,
    real_numbers,
    whole_number,
)
from wakeline.recording import RadarVideo

from ..radar import start_of
from .clutter import Land, SeaClutter, amplitude_of_db
from .fields import GammaTexture, PatchyField, PolarGrid, Speckle, complex_normal
from .target import AnyMotion, VideoTarget

_TURN_RAD = 2.0 * np.pi
_RESPONSE_STDS = 4.5
_PIECES_IN_HILL = 4.0
_PASSES = np.array([-1, 0, 1, 2])
_PASS_STEPS = 20
_WINDOW_STEPS = 3
_PASS_TOLERANCE_S = 1e-9
RECEIVERS = ("linear", "logarithmic")

Targets = Sequence[VideoTarget] | Mapping[str, VideoTarget]


@dataclass(frozen=True, kw_only=True)
class RadarVideoSimulator:
    """A radar at north 0, east 0; its antenna turns clockwise, each revolution starting at north.

    All powers are relative to the receiver's noise, in a complex field whose amplitude is
    detected: noise, clutter and echoes interfere. A point target of one square metre has the mean
    power

        ``snr_db - 40 log10(range / reference_range_m)``  in dB

    at the center of beam and pulse. Both are Gaussian: at an angle ``t`` off the beam's center the
    two-way power is ``exp(-8 ln 2 (t / beam_width_rad)^2)``, at a distance ``d`` off the pulse's
    center ``exp(-4 ln 2 (d / pulse_length_m)^2)``. Noise is independent in each cell and sweep.

    An amplitude ``a`` relative to the noise's root mean square becomes ``noise_rms a`` (linear) or
    ``noise_rms + (full scale - noise_rms) 20 log10(a) / dynamic_range_db`` (logarithmic), rounded
    and clipped to 0 and full scale, ``2^bits - 1``.

    Attributes
    ----------
    sweeps_per_turn, cells : int
        The center of sweep k is at ``(k + 1/2) / sweeps_per_turn`` of a revolution.
    cell_m, start_range_m : float
        Length of a range cell, and near edge of the first cell.
    period_s : float
        Duration of a revolution.
    beam_width_rad : float
        One-way half-power width of the antenna; at least one sweep.
    pulse_length_m : float
        Half-power length of an echo in range (half the speed of light times the duration); at least
        one cell.
    snr_db, reference_range_m : float
        Signal-to-noise ratio of one square metre at that range; clutter refers to the same range.
    noise_rms : float
        Root mean square of the noise amplitude, in counts; above 0 and below full scale.
    bits : int
        8 or 16.
    receiver : str
        "linear" or "logarithmic".
    dynamic_range_db : float
        From noise to full scale, of the logarithmic receiver.
    sea : SeaClutter, optional
    land : Land, optional
        Land replaces sea; both are smoothed across the beam where they meet.
    sector_rad : (float, float), optional
        Only sweeps with centers from the first to the second azimuth, clockwise, at their times
        within a full revolution. A sector across north, such as ``(-0.1, 0.1)`` or ``(6.2, 0.1)``,
        is contiguous: with ``(-0.1, 0.1)`` the first sweeps are before the start of the revolution,
        with ``(6.2, 0.1)`` the last ones are after its end.

    Raises
    ------
    ValueError
        When a value is invalid.

    Examples
    --------
    >>> from wakeline.scenario import RadarVideoSimulator, Truth, VideoTarget
    >>> radar = RadarVideoSimulator(sweeps_per_turn=1024, cells=256)
    >>> boat = VideoTarget(truth=Truth([500.0, 5.0, 800.0, 0.0]), length_m=12.0, beam_m=4.0)
    >>> radar.turn([boat], rng=1).amplitude.shape
    (1024, 256)
    """

    sweeps_per_turn: int = 4096
    cells: int = 2048
    cell_m: float = 6.0
    start_range_m: float = 0.0
    period_s: float = 3.0
    beam_width_rad: float = 0.0125
    pulse_length_m: float = 12.0
    snr_db: float = 15.0
    reference_range_m: float = 10_000.0
    noise_rms: float = 8.0
    bits: int = 8
    receiver: str = "linear"
    dynamic_range_db: float = 60.0
    sea: SeaClutter | None = None
    land: Land | None = None
    sector_rad: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        whole_number("sweeps_per_turn", self.sweeps_per_turn, 8)
        whole_number("cells", self.cells, 1)
        positive(
            **number_fields(
                self, "cell_m", "period_s", "beam_width_rad", "pulse_length_m", "noise_rms"
            )
        )
        positive(**number_fields(self, "reference_range_m", "dynamic_range_db"))
        not_negative(**number_fields(self, "start_range_m"))
        finite(**number_fields(self, "snr_db"))
        if self.beam_width_rad < _TURN_RAD / self.sweeps_per_turn:
            raise ValueError(
                f"beam_width_rad must be at least a sweep of "
                f"{_TURN_RAD / self.sweeps_per_turn:.6g} rad, got {self.beam_width_rad}"
            )
        if self.pulse_length_m < self.cell_m:
            raise ValueError(
                f"pulse_length_m must be at least a cell of {self.cell_m} m, "
                f"got {self.pulse_length_m}"
            )
        if self.bits not in (8, 16):
            raise ValueError(f"bits must be 8 or 16, got {self.bits!r}")
        if self.receiver not in RECEIVERS:
            raise ValueError(f"receiver must be one of {RECEIVERS}, got {self.receiver!r}")
        if self.noise_rms >= self.full_scale:
            raise ValueError(
                f"noise_rms must be below full scale, {self.full_scale}, got {self.noise_rms}"
            )
        for name, kind in (("sea", SeaClutter), ("land", Land)):
            value = getattr(self, name)
            if value is not None and not isinstance(value, kind):
                raise TypeError(f"{name} must be a {kind.__name__}, got {value!r}")
        if self.sector_rad is not None:
            object.__setattr__(self, "sector_rad", _sector(self.sector_rad))
            if len(self.grid.azimuth_rad) == 0:
                raise ValueError(f"sector_rad must contain a sweep, got {self.sector_rad}")

    @property
    def full_scale(self) -> int:
        """Maximum amplitude."""
        return 2**self.bits - 1

    @property
    def azimuth_step_rad(self) -> float:
        """Angle between the centers of consecutive sweeps."""
        return _TURN_RAD / self.sweeps_per_turn

    @cached_property
    def grid(self) -> PolarGrid:
        """Its sweeps and cells."""
        first, last = 0, self.sweeps_per_turn
        if self.sector_rad is not None:
            edges = np.array(self.sector_rad) / self.azimuth_step_rad - 0.5
            first, last = np.ceil(edges - 1e-9).astype(int)
        number = np.arange(first, min(last, first + self.sweeps_per_turn))
        range_m = self.start_range_m + (np.arange(self.cells) + 0.5) * self.cell_m
        return PolarGrid(
            (number + 0.5) * self.azimuth_step_rad, range_m, self.sweeps_per_turn, self.cell_m
        )

    def around(self, places_m: ArrayLike, margin_m: float) -> RadarVideoSimulator:
        """The same radar, simulated only around some positions.

        Parameters
        ----------
        places_m : array_like (n, 2)
            North and east, such as the path of a target; not around the antenna.
        margin_m : float
            Margin of sector and cells around all positions.

        Returns
        -------
        RadarVideoSimulator
            Its cells are a subset of the full picture's.

        Raises
        ------
        ValueError
            When the shape is different, the margin is negative or the antenna is within it.
        """
        places = real_numbers("places_m", places_m)
        if places.ndim != 2 or places.shape[1] != 2 or not len(places):
            raise ValueError(f"places_m must have shape (n, 2), got {places.shape}")
        if not (np.isfinite(places).all() and 0 <= margin_m < np.inf):
            raise ValueError(
                f"places_m must be finite and margin_m finite and not negative, got {margin_m}"
            )
        place = places @ [1.0, 1j]
        near_m, far_m = np.abs(place).min() - margin_m, np.abs(place).max() + margin_m
        middle = np.mean(place)
        if near_m <= 0 or abs(middle) == 0:
            raise ValueError(f"places_m must be more than margin_m {margin_m} from the antenna")
        off_rad = np.angle(place / middle)
        reach_rad = margin_m / np.abs(place)
        low_rad, high_rad = np.min(off_rad - reach_rad), np.max(off_rad + reach_rad)
        first = max(0, int((near_m - self.start_range_m) // self.cell_m))
        last = int(np.ceil((far_m - self.start_range_m) / self.cell_m))
        return replace(
            self,
            sector_rad=(float(np.angle(middle) + low_rad), float(np.angle(middle) + high_rad)),
            start_range_m=self.start_range_m + first * self.cell_m,
            cells=max(1, last - first),
        )

    def turn(
        self,
        targets: Targets = (),
        start_time_s: float | None = None,
        rng: np.random.Generator | int = 0,
    ) -> RadarVideo:
        """One revolution of the antenna, or a sector of it.

        Parameters
        ----------
        targets : sequence of VideoTarget, or mapping of names to them
        start_time_s : float, optional
            Time at which the antenna points north; default the latest start of the targets'
            truths.
        rng : numpy.random.Generator or int
            Random generator, or its seed.

        Returns
        -------
        RadarVideo
            Reproducible for a seed; targets do not change noise and clutter.

        Raises
        ------
        ValueError
            When the time is not finite.
        TypeError
            When a target is not a VideoTarget.
        """
        targets = _listed(targets)
        start_time_s = _start_s(targets, start_time_s)
        return _Antenna(self, np.random.default_rng(rng)).turn(targets, start_time_s)

    def turns(
        self,
        targets: Targets = (),
        scans: int = 1,
        seed: np.random.Generator | int = 0,
        *,
        start_time_s: float | None = None,
    ) -> Iterator[RadarVideo]:
        """Consecutive revolutions; sea patches evolve, and land is constant.

        Parameters
        ----------
        targets : sequence of VideoTarget, or mapping of names to them
        scans : int
            Number of revolutions.
        seed : int or numpy.random.Generator
            Seed, or a random generator.
        start_time_s : float, optional
            Time at which the first revolution begins; default as for :meth:`turn`.

        Returns
        -------
        iterator of RadarVideo
            The first is that of :meth:`turn`.

        Raises
        ------
        ValueError
            When the number of scans is negative or the time is not finite.
        TypeError
            When a target is not a VideoTarget.
        """
        targets = _listed(targets)
        whole_number("scans", scans, 0)
        start_time_s = _start_s(targets, start_time_s)
        antenna = _Antenna(self, np.random.default_rng(seed))
        return (antenna.turn(targets, start_time_s + k * self.period_s) for k in range(scans))

    def windows(
        self,
        cases: Mapping[Hashable, Targets],
        scans: int,
        seed: np.random.Generator | int = 0,
        *,
        around: AnyMotion,
        margin_m: float,
        start_time_s: float | None = None,
    ) -> Iterator[dict[Hashable, RadarVideo]]:
        """Consecutive revolutions in a window that moves with a vessel, by set of targets.

        Only the cells of the window are simulated, with the statistics of the full picture: noise
        and speckle, which are independent in each revolution, are drawn in the window only; the
        patches of the sea, which persist, and the land are drawn for the entire picture. All cases
        have the same noise and clutter, and a target has the same echo in each case in which it has
        the same position in the list.

        Parameters
        ----------
        cases : mapping of key to targets
        scans : int
            Number of revolutions.
        seed : int or numpy.random.Generator
        around : Truth, or any object with ``state_at``
            The center of the window; near the edge of the picture the window stays inside.
        margin_m : float
            Half the length of the window in range, and half its width across the beam at the
            picture's nearest range; wider farther out.
        start_time_s : float, optional
            Time at which the first revolution begins; default the latest start of the truths.

        Returns
        -------
        iterator of dict
            The window of each revolution by case.

        Raises
        ------
        ValueError
            When the number of scans is negative, the margin is not positive, or the vessel is
            unknown or outside of the picture.
        """
        listed = {key: _listed(targets) for key, targets in cases.items()}
        whole_number("scans", scans, 0)
        positive(margin_m=margin_m)
        everyone = [target for targets in listed.values() for target in targets]
        start_time_s = _start_s(everyone, start_time_s)
        antenna = _Antenna(self, np.random.default_rng(seed))
        follower = _Follower(self, around, margin_m)

        def window(begin_s: float) -> dict[Hashable, RadarVideo]:
            looks = antenna.looks(list(listed.values()), begin_s, follower.window(begin_s))
            return dict(zip(listed, looks, strict=True))

        return (window(start_time_s + k * self.period_s) for k in range(scans))

    def received(self, amplitude: NDArray[np.float32]) -> NDArray[np.uint8] | NDArray[np.uint16]:
        """Receiver output for amplitudes relative to the noise's root mean square."""
        if self.receiver == "linear":
            counts = amplitude * np.float32(self.noise_rms)
        else:
            per_decade = 20.0 * (self.full_scale - self.noise_rms) / self.dynamic_range_db
            counts = np.log10(np.maximum(amplitude, np.float32(1e-20)))
            counts *= np.float32(per_decade)
            counts += np.float32(self.noise_rms)
        np.clip(counts, 0, self.full_scale, out=counts)
        return np.rint(counts, out=counts).astype(np.uint8 if self.bits == 8 else np.uint16)

    @property
    def beam_std_rad(self) -> float:
        """Standard deviation of the two-way Gaussian response of the amplitude."""
        return self.beam_width_rad / np.sqrt(8.0 * np.log(2.0))

    @property
    def pulse_std_m(self) -> float:
        """Standard deviation of the Gaussian response of the amplitude in range."""
        return self.pulse_length_m / np.sqrt(4.0 * np.log(2.0))

    @cached_property
    def _speckle(self) -> Speckle:
        return Speckle(self.grid, self.beam_std_rad, self.pulse_std_m)

    @cached_property
    def _cover(self) -> NDArray[np.float32] | None:
        """Part of land in each cell; None without land."""
        if self.land is None:
            return None
        return self.land.cover(self.grid, self.beam_std_rad / np.sqrt(2.0))

    @cached_property
    def _shade(self) -> NDArray[np.float32] | None:
        if self._cover is None or np.isinf(self.land.penetration_m):
            return None
        return self.land.shade(self._cover, self.cell_m)

    @cached_property
    def _sea_patches(self) -> tuple[GammaTexture, PatchyField]:
        return _patches(self.sea.shape, self.sea.correlation_m, self.grid)

    @cached_property
    def _sea_amplitude(self) -> NDArray[np.float32]:
        """Root of the mean power of sea clutter in each cell."""
        mean = self.sea.mean_amplitude(self.grid, self.reference_range_m)
        if self._cover is not None:
            mean *= np.sqrt(1.0 - np.minimum(self._cover, 1.0))
        return mean if self._shade is None else mean * self._shade


class _Echo(NamedTuple):
    """What a target adds to a part of the picture."""

    sweeps: slice
    cells: slice
    field: NDArray[np.complex64]


class _Window(NamedTuple):
    """A part of the picture, and the speckle of that size."""

    sweeps: slice
    cells: slice
    grid: PolarGrid
    speckle: Speckle

    @classmethod
    def whole(cls, radar: RadarVideoSimulator) -> _Window:
        return cls(slice(None), slice(None), radar.grid, radar._speckle)


class _Follower:
    """A window of constant size around a vessel."""

    def __init__(self, radar: RadarVideoSimulator, around: AnyMotion, margin_m: float) -> None:
        grid = radar.grid
        self._radar, self._around = radar, around
        reach = margin_m / np.array([grid.range_m[0] * grid.step_rad, grid.cell_m])
        self._size = np.minimum(2 * np.ceil(reach).astype(int) + 1, grid.shape)
        sweeps, cells = self._size
        self._speckle = Speckle(
            replace(grid, azimuth_rad=grid.azimuth_rad[:sweeps], range_m=grid.range_m[:cells]),
            radar.beam_std_rad,
            radar.pulse_std_m,
        )

    def window(self, begin_s: float) -> _Window:
        """That of the revolution that begins at a time."""
        grid = self._radar.grid
        azimuth_rad = middle_rad = 0.5 * (grid.azimuth_rad[0] + grid.azimuth_rad[-1])
        for _ in range(_WINDOW_STEPS):
            seen_s = begin_s + self._radar.period_s * azimuth_rad / _TURN_RAD
            north_m, _, east_m, _ = self._around.state_at(seen_s)[0]
            off_rad = np.arctan2(east_m, north_m) - middle_rad
            azimuth_rad = middle_rad + (off_rad + np.pi) % _TURN_RAD - np.pi
        sweep = (azimuth_rad - grid.azimuth_rad[0]) / grid.step_rad
        place = np.array([sweep, (np.hypot(north_m, east_m) - grid.range_m[0]) / grid.cell_m])
        if not ((place > -0.5) & (place < np.array(grid.shape) - 0.5)).all():
            raise ValueError(
                f"around must be a vessel inside the simulated picture, and is not in the "
                f"revolution from {begin_s} s"
            )
        middle = np.rint(place).astype(int)
        first = np.clip(middle - self._size // 2, 0, np.array(grid.shape) - self._size)
        sweeps, cells = (slice(f, f + n) for f, n in zip(first, self._size, strict=True))
        part = replace(grid, azimuth_rad=grid.azimuth_rad[sweeps], range_m=grid.range_m[cells])
        return _Window(sweeps, cells, part, self._speckle)


class _Antenna:
    """The clutter's state from one revolution to the next."""

    def __init__(self, radar: RadarVideoSimulator, rng: np.random.Generator) -> None:
        self._radar, self._rng = radar, rng
        self._turn = 0
        self._passes_seed = int(rng.integers(2**63))
        self._sea_field: NDArray[np.float32] | None = None
        if radar.land is not None:
            self._raise_land()

    def turn(self, targets: Sequence[VideoTarget], start_time_s: float) -> RadarVideo:
        (video,) = self.looks([targets], start_time_s, _Window.whole(self._radar))
        return video

    def looks(
        self, cases: Sequence[Sequence[VideoTarget]], start_time_s: float, window: _Window
    ) -> list[RadarVideo]:
        """The window in one revolution, with the targets of each case."""
        radar = self._radar
        background = complex_normal(self._rng, window.grid.shape)
        if radar.sea is not None or radar.land is not None:
            self._add_clutter(background, window)
        azimuth_rad = np.mod(window.grid.azimuth_rad, _TURN_RAD)
        time_s = start_time_s + radar.period_s * window.grid.azimuth_rad / _TURN_RAD
        start_range_m = radar.start_range_m + (window.cells.start or 0) * radar.cell_m
        echoes: dict[tuple[int, int], list[_Echo]] = {}
        videos = []
        for targets in cases:
            field = background if len(cases) == 1 else background.copy()
            for number, target in enumerate(targets):
                key = (number, id(target))
                if key not in echoes:
                    echoes[key] = list(self._echoes(window, number, target, start_time_s))
                for echo in echoes[key]:
                    field[echo.sweeps, echo.cells] += echo.field
            videos.append(
                RadarVideo(
                    radar.received(np.abs(field)),
                    azimuth_rad,
                    time_s,
                    window.grid.step_rad,
                    start_range_m,
                    radar.cell_m,
                )
            )
        self._turn += 1
        return videos

    def _add_clutter(self, field: NDArray[np.complex64], window: _Window) -> None:
        """This revolution's speckle times the textures of sea and land, and the constant land."""
        part = window.sweeps, window.cells
        speckle = window.speckle.draw(self._rng)
        strength = self._sea_strength(part) if self._radar.sea is not None else None
        if self._radar.land is not None:
            field += self._steady_land[part]
            moving = self._moving_land[part]
            strength = moving if strength is None else np.hypot(strength, moving)
        speckle *= strength
        field += speckle

    def _sea_strength(self, part: tuple[slice, slice]) -> NDArray[np.float32]:
        """Root of the sea's power in each cell of a part, the patches one period older.

        The Gaussian field behind the texture is a first-order autoregression, so that the
        correlation of the texture falls to 1 / e in the correlation time.
        """
        sea, radar = self._radar.sea, self._radar
        texture, patches = radar._sea_patches
        fresh = patches.draw(self._rng)
        if self._sea_field is None:
            self._sea_field = fresh
        else:
            keep = texture.gaussian_correlation ** (radar.period_s / sea.correlation_s)
            self._sea_field *= np.float32(keep)
            fresh *= np.float32(np.sqrt(1.0 - keep**2))
            self._sea_field += fresh
        return texture.amplitude(self._sea_field[part]) * radar._sea_amplitude[part]

    def _raise_land(self) -> None:
        """Draw the land: the constant part of its echo, and the power of the rest."""
        radar, land, grid = self._radar, self._radar.land, self._radar.grid
        texture, patches = _patches(land.shape, land.correlation_m, grid)
        hills = np.float32(np.sqrt(0.5)) * patches.draw(self._rng)
        _, pieces = _patches(land.shape, land.correlation_m / _PIECES_IN_HILL, grid)
        hills += np.float32(np.sqrt(0.5)) * pieces.draw(self._rng)
        strength = texture.amplitude(hills) * np.sqrt(radar._cover)
        strength *= land.mean_amplitude(grid, radar.reference_range_m)
        if radar._shade is not None:
            strength *= radar._shade
        self._steady_land = radar._speckle.draw(self._rng) * strength
        self._steady_land *= np.float32(np.sqrt(1.0 - land.fluctuation))
        self._moving_land = strength * np.float32(np.sqrt(land.fluctuation))

    def _echoes(
        self, window: _Window, number: int, target: VideoTarget, start_time_s: float
    ) -> Iterator[_Echo]:
        """The echo of every pass of the beam over the target within this revolution.

        Passes are numbered from the first revolution, and the number seeds the phases: an echo
        across north has its parts in two revolutions.
        """
        period_s = self._radar.period_s
        state, azimuth_rad = _at_passes(target.truth, start_time_s + period_s * _PASSES, period_s)
        for k in np.flatnonzero(np.isfinite(state).all(axis=1)):
            offset = int(_PASSES[k])
            echo = self._echo(window, number, target, state[k], float(azimuth_rad[k]), offset)
            if echo is not None:
                yield echo

    def _echo(
        self,
        window: _Window,
        number: int,
        target: VideoTarget,
        state: NDArray[np.float64],
        azimuth_rad: float,
        offset: int,
    ) -> _Echo | None:
        """Response of the scatterers in beam and pulse: the product (sweeps, S) (S, cells)."""
        radar, grid = self._radar, window.grid
        place = target.scatterers_at(state)
        range_m = np.abs(place)
        off_rad = np.angle(place * np.exp(-1j * azimuth_rad))
        centre_rad = azimuth_rad + offset * _TURN_RAD + off_rad
        sweeps = _within(grid.azimuth_rad, centre_rad, _RESPONSE_STDS * radar.beam_std_rad)
        cells = _within(grid.range_m, range_m, _RESPONSE_STDS * radar.pulse_std_m)
        if sweeps.start == sweeps.stop or cells.start == cells.stop:
            return None
        turn_key = self._turn if target.swerling in (2, 4) else 0
        rng = np.random.default_rng([self._passes_seed, number, self._turn + offset + 1, turn_key])
        amplitude = target.fluctuations(rng, sweeps.stop - sweeps.start)
        amplitude = amplitude * np.sqrt(self._power(target, state) / len(place))
        beam = _gaussian(grid.azimuth_rad[sweeps, None] - centre_rad, radar.beam_std_rad)
        pulse = _gaussian(grid.range_m[cells] - range_m[:, None], radar.pulse_std_m)
        field = (amplitude * beam) @ pulse
        if radar._shade is not None:
            field *= radar._shade[window.sweeps, window.cells][sweeps, cells]
        return _Echo(sweeps, cells, field.astype(np.complex64))

    def _power(self, target: VideoTarget, state: NDArray[np.float64]) -> float:
        """Mean signal-to-noise ratio; a range below one cell counts as one cell."""
        radar = self._radar
        range_m = max(float(np.hypot(state[0], state[2])), radar.cell_m)
        gain = amplitude_of_db(radar.snr_db) ** 2
        fall = (radar.reference_range_m / range_m) ** 4
        return float(gain * fall) * target.cross_section_at(state)


def _at_passes(
    motion: AnyMotion, begin_s: NDArray[np.float64], period_s: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """States (n, 4) and azimuths at which the beam passes a vessel, by start of revolution.

    Solves ``time = begin + period * azimuth(time) / turn`` by fixed-point iteration, from an
    azimuth between 0 and 2 pi; it contracts if the target's azimuth changes slower than the
    antenna's.
    """
    state = motion.state_at(begin_s)
    azimuth_rad = np.arctan2(state[:, 2], state[:, 0]) % _TURN_RAD
    time_s = begin_s
    for _ in range(_PASS_STEPS):
        before_s, time_s = time_s, begin_s + period_s * azimuth_rad / _TURN_RAD
        if not (abs(time_s - before_s) > _PASS_TOLERANCE_S).any():
            break
        state = motion.state_at(time_s)
        fresh_rad = np.arctan2(state[:, 2], state[:, 0])
        azimuth_rad = azimuth_rad + (fresh_rad - azimuth_rad + np.pi) % _TURN_RAD - np.pi
    return state, azimuth_rad


def _within(centres: NDArray, places: NDArray, reach: float) -> slice:
    """The ascending centers that are within reach of any of the positions."""
    first = np.searchsorted(centres, np.min(places) - reach)
    return slice(int(first), int(np.searchsorted(centres, np.max(places) + reach)))


def _gaussian(distance: NDArray, std: float) -> NDArray[np.float64]:
    return np.exp(-0.5 * (distance / std) ** 2)


def _patches(
    shape: float, correlation_m: float, grid: PolarGrid
) -> tuple[GammaTexture, PatchyField]:
    """A texture, and the field behind it that gives the requested correlation."""
    texture = GammaTexture(shape)
    gaussian_m = correlation_m / np.sqrt(-np.log(texture.gaussian_correlation))
    return texture, PatchyField(grid, float(gaussian_m))


def _start_s(targets: Sequence[VideoTarget], start_time_s: float | None) -> float:
    """The given time, by default the latest start of the truths."""
    if start_time_s is None:
        return max((start_of(target.truth) for target in targets), default=0.0)
    finite(start_time_s=start_time_s)
    return start_time_s


def _listed(targets: Targets) -> list[VideoTarget]:
    if isinstance(targets, VideoTarget):
        raise TypeError("targets must be a sequence of VideoTarget, got a single one")
    listed = list(targets.values() if isinstance(targets, Mapping) else targets)
    for k, target in enumerate(listed):
        if not isinstance(target, VideoTarget):
            raise TypeError(f"target {k} must be a VideoTarget, got {target!r}")
    return listed


def _sector(sector_rad: ArrayLike) -> tuple[float, float]:
    """Start as given; end after it by at most a revolution."""
    edges = real_numbers("sector_rad", sector_rad)
    if edges.shape != (2,) or not np.isfinite(edges).all():
        raise ValueError(f"sector_rad must be two finite azimuths, got {sector_rad}")
    begin, end = (float(edge) for edge in edges)
    if end <= begin:
        end += _TURN_RAD
    if not (-_TURN_RAD <= begin <= _TURN_RAD and begin < end <= begin + _TURN_RAD + 1e-9):
        raise ValueError(
            f"sector_rad must begin within -2 pi to 2 pi and span at most 2 pi, got {sector_rad}"
        )
    return begin, end
