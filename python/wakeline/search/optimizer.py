"""Search plans that maximize the probability of success (POS)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from wakeline._checks import entropy
from wakeline._progress import progress as reported

from .drift import Cloud
from .patterns import PATTERNS, Pattern, is_regular, leg_count
from .plan import Plan, Sortie, Unit, naive_plan, naive_sortie, on_scene, success

_TRIED_PARTICLES = 800
_FIRST_TRIES = 70
_BEST_KEPT = 3
_STEPS_EACH = 60
_FIRST_STEP = 0.3
_LEAST_STEP = 0.01
_STEP_GROWS = 1.5
_STEP_SHRINKS = 0.95
_ROUNDS = 2
_PUSHES = 12
_PUSH = 0.25
_FINEST_SPACING = 0.25
_REJECTED = -1.0


Tried = Callable[[Pattern], tuple[Sortie | None, float]]


def optimized_plan(
    units: Sequence[Unit],
    cloud: Cloud,
    law: str = "inverse_cube",
    kinds: Iterable[str] = tuple(PATTERNS),
    seed: int = 0,
    *,
    progress: bool = False,
) -> Plan:
    """Patterns whose place, orientation, size and track spacing maximize POS for a drifting cloud.

    Units that search at the same time are planned for a share of the cloud each, then all units in
    turn for what the others have searched without success (Bayes). Areas that are searched at the
    same time do not overlap. If the naive plan of one of the kinds has a higher POS, it is the
    result.

    Parameters
    ----------
    units : sequence of Unit
    cloud : Cloud
        Its first particles are used to try plans.
    law : str
        One of `DETECTION_LAWS`.
    kinds : iterable of str
        Patterns to choose from.
    seed : int
        Of the random tries.
    progress : bool
        Whether to draw a bar if stderr is a terminal.

    Raises
    ------
    ValueError
        When a unit cannot reach the datum.
    """
    kinds = tuple(kinds)
    rng = np.random.default_rng(entropy(seed, "search plan"))
    tried = cloud.part(slice(_TRIED_PARTICLES))
    splits = list(_regions(units, tried))
    sorties: list[dict[int, Sortie]] = [{} for _ in splits]
    order = sorted(range(len(units)), key=lambda k: units[k].start_s)
    turns = order * (_ROUNDS if len(units) > 1 else 1)
    steps = [(*split, k) for split in zip(splits, sorties, strict=True) for k in turns]
    for regions, planned, k in reported(steps, len(steps), "planning") if progress else steps:
        others = [sortie for j, sortie in planned.items() if j != k]
        share = tried if k in planned else regions[k]
        rest = share.searched(Plan(tuple(others), law).potential(tried))
        if not rest.weight.any():  # a share of no particle, or all are found
            rest = tried
        known = [planned[k].pattern.kind] if k in planned else kinds
        found = [
            _best_sortie(units[k], rest, law, kind, others, planned.get(k), rng) for kind in known
        ]
        planned[k] = max(found, key=lambda one: one[1])[0]
    plans = [Plan(tuple(one[k] for k in range(len(units))), law) for one in sorties]
    plans += [naive_plan(units, cloud, law, kind) for kind in kinds]
    return max(plans, key=lambda one: one.pos(cloud))


def _regions(units: Sequence[Unit], cloud: Cloud) -> Iterator[list[Cloud]]:
    """The part of the cloud that each unit is first planned for.

    For units that search at the same time it is split across its long axis in proportion to their
    effort, in either order; else each unit has the whole.
    """
    spans = sorted((unit.start_s, unit.end_s) for unit in units)
    if not any(later[0] < earlier[1] for earlier, later in pairwise(spans)):
        yield [cloud] * len(units)
        return
    middle_s = np.mean([(unit.start_s + unit.end_s) / 2 for unit in units])
    axis_rad = _long_axis_rad(cloud, middle_s)
    along_m = cloud.at(middle_s) @ np.array([np.cos(axis_rad), np.sin(axis_rad)])
    efforts_m2 = np.array([u.sweep_width_m * u.search_mps * u.endurance_s for u in units])
    for turn in (1.0, -1.0):
        order = np.argsort(turn * along_m)
        below = np.empty(len(cloud))
        below[order] = np.cumsum(cloud.weight[order]) / cloud.weight.sum()
        whose = np.searchsorted(np.cumsum(efforts_m2) / efforts_m2.sum(), below - 1e-9)
        yield [replace(cloud, weight=cloud.weight * (whose == k)) for k in range(len(units))]


def _best_sortie(
    unit: Unit,
    cloud: Cloud,
    law: str,
    kind: str,
    others: Sequence[Sortie],
    before: Sortie | None,
    rng: np.random.Generator,
) -> tuple[Sortie, float]:
    """The best sortie of a kind and its POS: random tries, the best improved step by step.

    The sortie of an earlier round is only improved.
    """

    def tried(pattern: Pattern) -> tuple[Sortie | None, float]:
        sortie = Sortie.on(unit, pattern) if _is_possible(unit, pattern) else None
        if sortie is None or not is_regular(sortie.pattern):
            return None, _REJECTED
        if any(_overlap(sortie, other) for other in others):
            return None, _REJECTED
        return sortie, success(cloud, sortie.potential(cloud, law))

    if before is None:
        datum_m, length_m = on_scene(unit, cloud)
        drawn = _first_patterns(unit, cloud, kind, datum_m, length_m, rng)
        first = [naive_sortie(unit, cloud, kind).pattern, *drawn]
        first = [_set_apart(unit, pattern, others) for pattern in first]
    else:
        first = [before.pattern]
    results = sorted(map(tried, first), key=lambda one: -one[1])[:_BEST_KEPT]
    size_m = _spread_m(unit, cloud, unit.start_s)
    best, pos = max(
        (_improved(*one, tried, size_m, rng) for one in results if one[0] is not None),
        key=lambda one: one[1],
        default=(None, _REJECTED),
    )
    if best is None:
        raise ValueError(
            f"unit {unit.name!r} must have an area within its reach that no other unit searches at "
            "the same time, got none"
        )
    return best, pos


def _set_apart(unit: Unit, pattern: Pattern, others: Sequence[Sortie]) -> Pattern:
    """A pattern moved away from the areas of others until it overlaps none of them."""
    sortie = Sortie.on(unit, pattern)
    for _ in range(_PUSHES if sortie is not None else 0):
        hit = next((other for other in others if _overlap(sortie, other)), None)
        if hit is None:
            break
        away_m = pattern.center_m - hit.pattern.center_m
        if np.hypot(*away_m) < 1.0:
            away_m = np.array([np.cos(pattern.orientation_rad), np.sin(pattern.orientation_rad)])
        step_m = _PUSH * max(min(sortie.pattern.sides_m), min(hit.pattern.sides_m))
        push_m = step_m * away_m / np.hypot(*away_m)
        pattern = replace(pattern, center_m=pattern.center_m + push_m)
        sortie = Sortie.on(unit, pattern)
        if sortie is None:
            break
    return pattern


def _first_patterns(
    unit: Unit,
    cloud: Cloud,
    kind: str,
    datum_m: np.ndarray,
    length_m: float,
    rng: np.random.Generator,
) -> Iterable[Pattern]:
    """Random patterns about the datum and about likely places, along the axes of the cloud."""
    middle_s = 0.5 * (unit.start_s + unit.end_s)
    chosen = rng.choice(len(cloud), _FIRST_TRIES, p=cloud.weight / cloud.weight.sum())
    places_m = cloud.at(middle_s)[chosen]
    axis_rad = _long_axis_rad(cloud, middle_s)
    spread_m = _spread_m(unit, cloud, middle_s)
    for k, place_m in enumerate(places_m):
        yield Pattern(
            kind,
            place_m if k % 3 else datum_m + rng.uniform(0.0, 0.5) * (place_m - datum_m),
            axis_rad + np.pi / 2 * (k % 4),
            spread_m * rng.uniform(0.5, 1.5)
            if kind == "sector"
            else unit.sweep_width_m * rng.uniform(0.6, 2.5),
            length_m,
            leg_count(length_m, unit.sweep_width_m, _aspect(kind, rng)),
            mirrored=bool(rng.random() < 0.5),
        )


def _spread_m(unit: Unit, cloud: Cloud, time_s: float) -> float:
    """Size of what a unit searches: the cloud at a time, blurred by the sweep width."""
    return np.sqrt(np.trace(cloud.covariance_m2(time_s)) + unit.sweep_width_m**2)


def _long_axis_rad(cloud: Cloud, time_s: float) -> float:
    """Direction of the long axis of the cloud at a time."""
    p_m2 = cloud.covariance_m2(time_s)
    return 0.5 * np.arctan2(2 * p_m2[0, 1], p_m2[0, 0] - p_m2[1, 1])


def _aspect(kind: str, rng: np.random.Generator) -> float:
    aspect = np.exp(rng.uniform(0.0, np.log(6.0)))
    return 1.0 / aspect if kind == "creeping_line" else aspect


def _improved(
    sortie: Sortie, pos: float, tried: Tried, size_m: float, rng: np.random.Generator
) -> tuple[Sortie, float]:
    """A sortie after random steps, kept when better; steps grow on success, else shrink."""
    scale = _FIRST_STEP
    for _ in range(_STEPS_EACH):
        old = sortie.pattern
        turned, stretched, more = rng.standard_normal(3) * scale
        new = replace(
            old,
            center_m=old.center_m + scale * size_m * rng.standard_normal(2),
            orientation_rad=old.orientation_rad + turned,
            spacing_m=old.spacing_m * np.exp(stretched),
            legs=max(2, round(old.legs * np.exp(more))),
            mirrored=old.mirrored ^ bool(rng.random() < 0.1),
        )
        other, other_pos = tried(new)
        if other is not None and other_pos > pos:
            sortie, pos, scale = other, other_pos, scale * _STEP_GROWS
        else:
            scale = max(scale * _STEP_SHRINKS, _LEAST_STEP)
    return sortie, pos


def _is_possible(unit: Unit, pattern: Pattern) -> bool:
    """Whether a sweep has legs of positive length, and no pattern is finer than is of use."""
    finest_m = unit.sweep_width_m * (1.0 if pattern.kind == "sector" else _FINEST_SPACING)
    if pattern.spacing_m < finest_m:
        return False
    if pattern.kind in ("parallel_sweep", "creeping_line"):
        return pattern.length_m > (2 * pattern.legs - 1) * pattern.spacing_m
    return True


def _overlap(a: Sortie, b: Sortie) -> bool:
    """Whether two areas that are searched at the same time overlap (separating axes)."""
    if a.time_s[-1] <= b.time_s[0] or b.time_s[-1] <= a.time_s[0]:
        return False
    corners = a.pattern.outline_m(), b.pattern.outline_m()
    for outline_m in corners:
        for north_m, east_m in np.diff(outline_m, axis=0):
            one, other = (each @ [-east_m, north_m] for each in corners)
            if one.max() <= other.min() or other.max() <= one.min():
                return False
    return True
