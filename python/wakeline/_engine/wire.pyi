"""
Datagrams and sentences of radar networks.
"""
from collections.abc import Sequence
import numpy as np
from numpy.typing import ArrayLike, NDArray
from .navigation import LocalPlane
from .measurement import OwnShip
__all__: list = ['AsterixRecords', 'AsterixDecoder', 'SensorClock', 'TtmFeed', 'Cat062Feed', 'Cat010Feed']
class AsterixRecords:
    """
    Plots and marks of a datagram, one per row, in its order.
    
    Numbers that a record does not have are NaN. `problems` has (offset, problem, item) of what cannot be read.
    """
    def __len__(self) -> int:
        ...
    @property
    def bearing_rad(self) -> NDArray[np.float64]:
        """
        (n,) clockwise from the radar's north; of a sector mark the start of the sector
        """
    @property
    def category(self) -> NDArray[np.uint8]:
        """
        (n,) 10, 34 or 48
        """
    @property
    def course_rad(self) -> NDArray[np.float64]:
        """
        (n,) NaN when absent
        """
    @property
    def kind(self) -> NDArray[np.uint8]:
        """
        (n,) 0 plot, 1 north mark (or start of an update cycle, category 010), 2 sector mark
        """
    @property
    def latitude_rad(self) -> NDArray[np.float64]:
        """
        (n,) of the target; of a mark of the radar; NaN when absent
        """
    @property
    def longitude_rad(self) -> NDArray[np.float64]:
        """
        (n,) likewise
        """
    @property
    def period_s(self) -> NDArray[np.float64]:
        """
        (n,) of the antenna, in marks; NaN when absent
        """
    @property
    def problems(self) -> list[tuple[int, str, str]]:
        ...
    @property
    def range_m(self) -> NDArray[np.float64]:
        """
        (n,) NaN when absent
        """
    @property
    def source(self) -> NDArray[np.int64]:
        """
        (n,) 256 SAC + SIC
        """
    @property
    def speed_mps(self) -> NDArray[np.float64]:
        """
        (n,) NaN when absent
        """
    @property
    def test(self) -> NDArray[np.bool_]:
        """
        (n,) whether it is a simulated or test target
        """
    @property
    def time_s(self) -> NDArray[np.float64]:
        """
        (n,) time of day, on the day nearest to that of reception; NaN when absent
        """
    @property
    def track_number(self) -> NDArray[np.int64]:
        """
        (n,) of the radar's own tracker; -1 when absent
        """
class AsterixDecoder:
    """
    Datagrams of ASTERIX categories 010, 034 and 048 to plots and marks of rotating radars.
    
    Source: EUROCONTROL-SPEC-0149, parts 7 (010, edition 1.1), 2b (034, 1.29) and 4 (048, 1.32). Blocks of other
    categories are skipped and counted, as are records that are neither plots with a position nor marks: status messages,
    tracks without detection. After a record that cannot be read, the rest of its block is skipped.
    """
    def __init__(self) -> None:
        ...
    def decode(self, datagram: bytes, received_s: float) -> AsterixRecords:
        """
        The records of a datagram.
        
        Parameters
        ----------
        datagram : bytes
        received_s : float
            Time of reception, UTC in seconds since any midnight: the day of the times of day.
        
        Returns
        -------
        AsterixRecords
        """
    @property
    def other_blocks(self) -> int:
        """
        Blocks of other categories so far.
        """
    @property
    def other_records(self) -> int:
        """
        Records so far that are neither plots nor marks.
        """
class SensorClock:
    """
    Times of a sensor on the receiver's clock.
    
    Clocks of sensors are often wrong and seldom drift. A time at most `limit_s` from that of reception is right. Otherwise the
    difference is held as the offset of the sensor's clock, until a time is again more than `limit_s` from where the offset puts it.
    
    Parameters
    ----------
    limit_s : float
    
    Raises
    ------
    ValueError
        When the limit is not between 0 and half a day.
    """
    def __call__(self, time_s: float, received_s: float) -> float:
        """
        The time on the receiver's clock, on the day nearest to that of reception; that of reception for NaN.
        """
    def __init__(self, limit_s: float = 5.0) -> None:
        ...
    @property
    def changes(self) -> int:
        """
        How often the offset has changed.
        """
    @property
    def offset_s(self) -> float:
        """
        What is added to the sensor's times; 0 where its clock is right.
        """
class TtmFeed:
    """
    Tracks as NMEA 0183 sentences: OSD, then a TTM for each target that is due.
    
    Targets are predicted to the time of sending and referred to own ship; all directions are true. A target keeps its number, 0 to
    99; the sentence with status L is sent once, and the number then rests for `hold_off_s`. A target has at most one sentence in
    `interval_s`, and only with a new estimate. The source of these rules are the receivers: OpenCPN places a target by its own latest fix, and keeps
    no trail of targets that come faster than every 2 s.
    
    Parameters
    ----------
    plane : LocalPlane
        The plane of the tracks.
    talker : str
        Two letters before the formatter: RA for radar.
    interval_s : float
        Give the antenna's period where it is longer than 3 s.
    hold_off_s : float
        Rest of a number.
    tll : bool
        Send TLL (latitude and longitude) in place of TTM, for receivers that cannot use range and bearing.
    
    Raises
    ------
    ValueError
        When the talker is not two capital letters or digits, or a time is negative or not finite.
    """
    def __copy__(self) -> TtmFeed:
        ...
    def __deepcopy__(self, memo: dict) -> TtmFeed:
        ...
    def __init__(self, plane: LocalPlane, *, talker: str = 'RA', interval_s: float = 3.0, hold_off_s: float = 60.0, tll: bool = False) -> None:
        ...
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def update(self, time_s: float, track_id: ArrayLike, estimate_time_s: ArrayLike, mean: ArrayLike, *, name: Sequence[str] | None = None, own: OwnShip | None = None, heading_rad: float = ...) -> list[bytes]:
        """
        The sentences that are due, each with carriage return and line feed.
        
        Parameters
        ----------
        time_s : float
            Now, UTC in seconds since any midnight.
        track_id : (k,) array of int
            All tracks that are shown: one that is missing has its last report now.
        estimate_time_s : float or (k,) array
            Time of each estimate. A track is due when it is newer than the one sent last.
        mean : (k, 4) array
            [x, vx, y, vy], as of `TrackTable.mean`.
        name : sequence of str, optional
            Cut to the room in the sentence, at most 20 characters.
        own : OwnShip, optional
            Own ship in the plane, at the origin if not given. Its position should be the fix that the receiver has.
        heading_rad : float
            Of own ship, true; NaN when it is unknown or old (OSD then says V).
        """
    @property
    def numbers(self) -> dict[int, int]:
        """
        The number of each track that is being sent, by track_id.
        """
    @property
    def waiting(self) -> int:
        """
        Tracks of the last update without a free number.
        """
class Cat062Feed:
    """
    Tracks as ASTERIX category 062 (system tracks).
    
    Items: I062/010, 015, 070, 105, 100, 185, 245 (of a named track), 040, 080, 290 (where `age_s` is given), 200 and 500 (with a covariance).
    Estimates have their own time. TSB marks the first report of a track, TSE the last one, which is sent once; its number, 0 to 65535, then rests
    for `hold_off_s`. Cartesian positions and velocities are in the plane, x east. Source: EUROCONTROL-SPEC-0149, part 9, edition 1.21.
    
    Parameters
    ----------
    plane : LocalPlane
        The plane of the tracks, whose reference is that of I062/100.
    area, system, service : int
        SAC, SIC (I062/010) and I062/015.
    several_radars : bool
        Whether tracks are of several radars: MON is 0.
    interval_s : float
        Least time between reports of a track.
    hold_off_s : float
        Rest of a number.
    datagram_octets : int
        Longest datagram.
    
    Raises
    ------
    ValueError
        When a time is negative or not finite, or a datagram is not 128 to 8192 octets.
    """
    def __copy__(self) -> Cat062Feed:
        ...
    def __deepcopy__(self, memo: dict) -> Cat062Feed:
        ...
    def __init__(self, plane: LocalPlane, *, area: int = 0, system: int = 0, service: int = 1, several_radars: bool = False, interval_s: float = 0.0, hold_off_s: float = 60.0, datagram_octets: int = 1400) -> None:
        ...
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def update(self, time_s: float, track_id: ArrayLike, estimate_time_s: ArrayLike, mean: ArrayLike, *, covariance: ArrayLike | None = None, coasting: ArrayLike | None = None, turn_rate_rad_s: ArrayLike | None = None, age_s: ArrayLike | None = None, name: Sequence[str] | None = None) -> list[bytes]:
        """
        The datagrams that are due.
        
        Parameters
        ----------
        time_s : float
            Now, UTC in seconds since any midnight.
        track_id : (k,) array of int
            All tracks that are shown: one that is missing has its last report now.
        estimate_time_s : float or (k,) array
            Time of each estimate. A track is due when it is newer than the one sent last.
        mean : (k, 4) array
            [x, vx, y, vy], as of `TrackTable.mean`.
        covariance : (k, 4, 4) array, optional
        coasting : (k,) array of bool, optional
            Whether the radar did not see the target when it looked last.
        turn_rate_rad_s : float or (k,) array, optional
            To starboard.
        age_s : float or (k,) array, optional
            Time since the last plot.
        name : sequence of str, optional
        """
    @property
    def numbers(self) -> dict[int, int]:
        """
        The number of each track that is being sent, by track_id.
        """
    @property
    def waiting(self) -> int:
        """
        Tracks of the last update without a free number.
        """
class Cat010Feed:
    """
    Tracks as ASTERIX category 010, the usual output of coastal radars.
    
    Items: I010/010, 000, 020 (primary radar), 140, 041, 042 (within 32 km), 200, 161, 170 and 500 (with a covariance). The velocity is I010/200, as
    readers disagree on the unit of I010/202. TRE marks the last report of a track, which is sent once; its number, 0 to 4095, then rests for
    `hold_off_s`. Source: EUROCONTROL-SPEC-0149, part 7, edition 1.1. Parameters as those of
    `Cat062Feed` with the same names.
    """
    def __copy__(self) -> Cat010Feed:
        ...
    def __deepcopy__(self, memo: dict) -> Cat010Feed:
        ...
    def __init__(self, plane: LocalPlane, *, area: int = 0, system: int = 0, interval_s: float = 0.0, hold_off_s: float = 60.0, datagram_octets: int = 1400) -> None:
        ...
    def restore(self, state: bytes) -> None:
        """
        Continues bit for bit where the saved one was. Raises ValueError, and changes nothing, when the state was saved with different parameters or is damaged.
        """
    def save(self) -> bytes:
        """
        Its state as bytes, for `restore` of one with the same parameters on the same kind of machine.
        """
    def update(self, time_s: float, track_id: ArrayLike, estimate_time_s: ArrayLike, mean: ArrayLike, *, covariance: ArrayLike | None = None, coasting: ArrayLike | None = None, turn_rate_rad_s: ArrayLike | None = None, age_s: ArrayLike | None = None, name: Sequence[str] | None = None) -> list[bytes]:
        """
        The datagrams that are due.
        
        Parameters
        ----------
        time_s : float
            Now, UTC in seconds since any midnight.
        track_id : (k,) array of int
            All tracks that are shown: one that is missing has its last report now.
        estimate_time_s : float or (k,) array
            Time of each estimate. A track is due when it is newer than the one sent last.
        mean : (k, 4) array
            [x, vx, y, vy], as of `TrackTable.mean`.
        covariance : (k, 4, 4) array, optional
        coasting : (k,) array of bool, optional
            Whether the radar did not see the target when it looked last.
        turn_rate_rad_s : float or (k,) array, optional
            To starboard.
        age_s : float or (k,) array, optional
            Time since the last plot.
        name : sequence of str, optional
        """
    @property
    def numbers(self) -> dict[int, int]:
        """
        The number of each track that is being sent, by track_id.
        """
    @property
    def waiting(self) -> int:
        """
        Tracks of the last update without a free number.
        """
