"""Antenna revolutions from blocks of radar video."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import chain, islice, pairwise

from wakeline.recording import RadarVideo
from wakeline.recording.video import Beam

_NEARLY = 0.7  # of its neighbor: a revolution then counts as complete
_PAUSE_S = 10.0


@dataclass
class Turn:
    """Blocks of video of one revolution."""

    blocks: list[RadarVideo]
    whole: bool = True

    @property
    def begin_s(self) -> float:
        """Time of its first sweep."""
        return float(self.blocks[0].time_s[0])

    @property
    def end_s(self) -> float:
        """Time of its last sweep."""
        return float(self.blocks[-1].time_s[-1])

    @property
    def longest(self) -> RadarVideo:
        """The block with the most sweeps."""
        return max(self.blocks, key=len)

    @property
    def covered_rad(self) -> float:
        """Angle that the beam has turned."""
        return sum(len(block) * block.azimuth_width_rad for block in self.blocks)


def turns(blocks: Iterable[RadarVideo]) -> Iterator[Turn]:
    beam = Beam()
    turn: Turn | None = None
    for block in blocks:
        begins = [beam.begins_turn(azimuth_rad) for azimuth_rad in block.azimuth_rad.tolist()]
        if turn is not None and (begins[0] or _pauses(turn.blocks[-1], block)):
            yield turn
            turn = None
        turn = turn or Turn([])
        turn.blocks.append(block)
    if turn is not None:
        yield turn


def _pauses(before: RadarVideo, block: RadarVideo) -> bool:
    return not 0.0 <= block.time_s[0] - before.time_s[-1] <= _PAUSE_S


def judged(turns: Iterable[Turn]) -> Iterator[Turn]:
    """The revolutions; those at either end are marked if they are incomplete.

    There may be two at the start, because a sector across north is split until its end is known.
    """
    turns = iter(turns)
    first = list(islice(turns, 3))
    most_rad = max((turn.covered_rad for turn in first), default=0.0)
    for turn in first[:-1]:
        turn.whole = turn.covered_rad > _NEARLY * most_rad
    for before, turn in pairwise(chain(first, turns)):
        yield before
        neighbour, last = before, turn
    if len(first) > 1:
        last.whole = last.covered_rad > _NEARLY * neighbour.covered_rad or not neighbour.whole
        yield last
    else:
        yield from first
