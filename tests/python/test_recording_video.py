"""Recorded radar video: what is written comes back, and what is said about each bad file."""

import gzip
import pickle
import re
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cases import blocks_of
from wakeline import recording
from wakeline.recording import RadarVideo, RecordingError, VideoReport

STEP = 2 * np.pi / 65536
CORPUS = sorted((Path(__file__).parents[1] / "fuzz" / "cat240_corpus").iterdir())


def video(
    sweeps=8, cells=20, *, dtype=np.uint8, start_s=100.0, azimuth_rad=None, cell_m=6.0, first=0
):
    """A few sweeps of a radar of 512 sweeps a turn, all amplitudes different."""
    azimuth = np.arange(first, first + sweeps) * 2 * np.pi / 512 if azimuth_rad is None else None
    amplitude = (np.arange(sweeps * cells).reshape(sweeps, cells) * 7 + first).astype(dtype)
    return RadarVideo(
        amplitude,
        np.asarray(azimuth_rad, dtype=float) if azimuth is None else azimuth,
        start_s + np.arange(first, first + sweeps) / 128,
        2 * np.pi / 512,
        0.0,
        cell_m,
    )


@pytest.fixture
def path(tmp_path):
    return tmp_path / "radar.cat240"


def octets_of(path, videos, **settings):
    recording.write_video(path, videos, **settings)
    return path.read_bytes()


def read(path, octets=None, **settings):
    if octets is not None:
        path.write_bytes(octets)
    report = VideoReport()
    videos = list(recording.read_video(path, report=report, **settings))
    assert report.sweeps == sum(len(v) for v in videos)
    return videos, report


def amplitudes(videos):
    return np.concatenate([v.amplitude for v in videos])


# ------------------------------------------------------------------ what is written comes back


@st.composite
def videos_of_any_radar(draw):
    sweeps, cells = draw(st.integers(1, 12)), draw(st.integers(1, 1500))
    dtype = draw(st.sampled_from([np.uint8, np.uint16]))
    random = np.random.default_rng(draw(st.integers(0, 1000)))
    width = draw(st.floats(1e-3, 0.3))
    first = draw(st.floats(0, 6))
    return RadarVideo(
        random.integers(0, np.iinfo(dtype).max, (sweeps, cells), dtype, endpoint=True),
        np.mod(first + width * np.arange(sweeps), 2 * np.pi),
        draw(st.floats(0, 86399)) + 0.01 * np.arange(sweeps),
        width,
        draw(st.floats(0, 20000)),
        draw(st.floats(0.1, 2000)),
    )


@given(written=videos_of_any_radar())
def test_what_is_written_comes_back(tmp_path_factory, written):
    path = tmp_path_factory.mktemp("video") / "radar.cat240"
    recording.write_video(path, written)
    videos, report = read(path)
    assert report.notes == []
    assert np.array_equal(amplitudes(videos), written.amplitude)
    assert amplitudes(videos).dtype == written.amplitude.dtype
    azimuth = np.concatenate([v.azimuth_rad for v in videos])
    off = np.mod(azimuth - written.azimuth_rad + np.pi, 2 * np.pi) - np.pi
    assert np.abs(off).max() <= STEP / 2 + 1e-12
    time_s = np.concatenate([v.time_s for v in videos])
    assert np.abs(time_s - written.time_s).max() <= 1 / 256 + 1e-9
    for block in videos:
        assert abs(block.azimuth_width_rad - written.azimuth_width_rad) <= STEP + 1e-12
        error_m = 7.5e-8 if written.cell_m < 643 else 0.075
        assert abs(block.cell_m - written.cell_m) <= error_m
        assert abs(block.start_range_m - written.start_range_m) <= 0.501 * block.cell_m


def test_turns_are_cut_at_north_and_times_continue_over_midnight(path):
    written = [video(512, dtype=np.uint16, start_s=86398.0, first=k) for k in (0, 513)]
    recording.write_video(path, iter(written), source=(25, 7), summary="harbour radar")
    videos, report = read(path, midnight_s=1e9)
    assert [len(v) for v in videos] == [512, 511, 1]
    assert np.array_equal(amplitudes(videos), amplitudes(written))
    expected = 1e9 + np.concatenate([w.time_s for w in written])
    assert np.concatenate([v.time_s for v in videos]) == pytest.approx(expected, abs=1 / 128)
    assert (report.source, report.summaries, report.notes) == ((25, 7), ["harbour radar"], [])


def test_a_change_of_the_radar_begins_a_block(path):
    parts = [
        video(3),
        video(3, cell_m=12.0, first=3),  # cells grow in mid-scan
        video(3, cell_m=12.0, cells=30, first=6),
        video(3, cell_m=12.0, cells=30, first=9, dtype=np.uint16),
        video(3, start_s=500.0, cells=30, cell_m=12.0, first=12, dtype=np.uint16),
    ]
    recording.write_video(path, parts)
    videos, report = read(path)
    assert [v.amplitude.shape for v in videos] == [p.amplitude.shape for p in parts]
    assert [v.cell_m for v in videos] == pytest.approx([p.cell_m for p in parts], abs=1e-7)
    assert report.notes == ["1 jump of time"]


def test_a_file_of_many_pieces_is_the_same(path, monkeypatch):
    whole = [video(512, 300, first=512 * k, start_s=100.0) for k in range(12)]
    octets = octets_of(path, whole)
    monkeypatch.setattr("wakeline.recording.asterix_video._PIECE", 1 << 19)
    videos, _ = read(path)
    assert len(octets) > 3 * (1 << 19)
    assert [len(v) for v in videos] == [512] * 12
    assert np.array_equal(amplitudes(videos), amplitudes(whole))


def test_a_turn_beyond_all_measure_is_cut(path, monkeypatch):
    monkeypatch.setattr("wakeline.recording.asterix_video._MOST", 100)
    recording.write_video(path, video(20, 20))
    videos, _ = read(path)
    assert [len(v) for v in videos] == [6, 6, 6, 2]


def test_an_antenna_that_scans_a_sector_gives_a_turn_at_most(path):
    there = np.deg2rad(np.linspace(10, 100, 91))
    azimuth = np.concatenate([there, there[::-1]] * 6)
    videos, report = read(path, octets_of(path, video(len(azimuth), azimuth_rad=azimuth)))
    assert len(videos) > 1
    assert all(np.abs(np.diff(v.azimuth_rad)).sum() < 2 * np.pi for v in videos)
    assert report.reversals == 11
    assert report.notes == ["11 reversals of the antenna"]


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("sector_deg", [(10, 80), (-40, 50), (20, 320), (0, 359)])
def test_a_sector_is_cut_where_the_beam_goes_back(path, sector_deg, sense):
    """A radar that turns on behind what it shows: every turn but the first is one block."""
    sector = np.deg2rad(np.arange(*sector_deg))[::sense]
    turns = 6
    videos, report = read(
        path, octets_of(path, video(len(sector) * turns, azimuth_rad=np.tile(sector, turns)))
    )
    assert sum(len(v) for v in videos) == len(sector) * turns
    assert [len(v) for v in videos[-(turns - 2) :]] == [len(sector)] * (turns - 2)
    assert report.notes == []
    whole = recording.RadarVideo(
        amplitudes(videos),
        np.concatenate([v.azimuth_rad for v in videos]),
        np.concatenate([v.time_s for v in videos]),
        np.deg2rad(1.0),
        0.0,
        6.0,
    )
    assert [len(v) for v in whole.turns()] == [len(v) for v in videos]


def test_an_antenna_that_jitters_about_north_begins_one_turn(path):
    steps = np.arange(2000) + np.tile([0, 2.5, 0, -2.5], 500)
    videos, _ = read(path, octets_of(path, video(2000, azimuth_rad=steps * 2 * np.pi / 500 + 3.0)))
    assert len(videos) == 5
    assert all(abs(len(v) - 500) <= 6 for v in videos[1:-1])


@pytest.mark.parametrize("away", [1.0, -1.0, 0.5, -0.5])
def test_a_few_false_sweeps_begin_no_turn(path, away):
    azimuth = np.arange(6 * 512) * 2 * np.pi / 512
    azimuth[1300:1303] += away
    videos, _ = read(path, octets_of(path, video(len(azimuth), azimuth_rad=azimuth)))
    assert [len(v) for v in videos] == [512] * 6


def test_an_antenna_that_begins_to_show_a_sector_is_followed(path):
    whole = np.arange(3 * 512) * 2 * np.pi / 512
    sector = np.tile(np.arange(100, 200), 6) * 2 * np.pi / 512
    azimuth = np.concatenate([whole, sector])
    videos, _ = read(path, octets_of(path, video(len(azimuth), azimuth_rad=azimuth)))
    assert [len(v) for v in videos[:3]] == [512] * 3
    assert [len(v) for v in videos[-4:]] == [100] * 4


@pytest.mark.parametrize("sector_deg", [(350, 371), (100, 141)])
def test_a_period_stands_in_for_times_of_a_sector(path, sector_deg):
    steps = np.deg2rad(np.tile(np.arange(*sector_deg), 6)) / STEP
    octets = b"".join(record(azimuth=(int(k), int(k) + 180)) for k in steps)
    videos, report = read(path, octets, period_s=2.0)
    begins_s = [v.time_s[0] for v in videos[-4:]]
    assert np.diff(begins_s) == pytest.approx(2.0, abs=0.01)
    assert report.held == 0


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("before_end", [1, 2, 10, 11, 30])
def test_a_period_stands_in_wherever_in_a_sector_the_file_begins(path, before_end, sense):
    sector_deg = np.arange(100, 141)[::sense]
    azimuth_deg = np.tile(sector_deg, 4)[41 - before_end :]
    turn = np.cumsum(np.diff(azimuth_deg, prepend=azimuth_deg[0]) * sense < 0)
    octets = b"".join(
        record(azimuth=(int(k), int(k) + 182)) for k in np.deg2rad(azimuth_deg) / STEP
    )
    videos, report = read(path, octets, period_s=24.0)
    time_s = np.concatenate([v.time_s for v in videos])
    way = turn + sense * (azimuth_deg - azimuth_deg[0]) / 360.0
    assert time_s[2:] == pytest.approx(24.0 * way[2:], abs=0.01)
    assert np.diff(time_s).min() >= 0.0
    assert report.notes == []


def test_a_turn_that_begins_with_a_sweep_without_a_time_is_a_turn(path):
    octets = b"".join(
        record(azimuth=(256 * k, 256 * k + 256), sequence=k, ticks=None if k % 256 == 0 else k)
        for k in range(1, 4 * 256)
    )
    videos, report = read(path, octets)
    assert [len(v) for v in videos] == [255] * 4
    assert report.untimed == 3


def test_a_lone_sweep_far_from_its_neighbours_is_left_out(path):
    azimuth = np.arange(200) * 2 * np.pi / 512
    azimuth[50] += 2.0
    shown = video(200, azimuth_rad=azimuth)
    shown.time_s[120] += 300.0
    videos, report = read(path, octets_of(path, shown))
    kept = np.delete(np.arange(200), [50, 120])
    assert len(videos) == 1
    assert np.array_equal(videos[0].amplitude, shown.amplitude[kept])
    assert report.notes == ["2 sweeps far from their neighbours in azimuth, time or count left out"]


def test_sweeps_are_as_wide_as_they_come_apart(path):
    octets = b"".join(record(azimuth=(64 * k, 64 * k + 1), sequence=k, ticks=k) for k in range(10))
    (block,), _ = read(path, octets)
    assert block.azimuth_width_rad == pytest.approx(64 * STEP)


# ------------------------------------------------------------------ what other senders write


def record(
    *,
    cells=b"\1\2\3\4",
    resolution=4,
    count=None,
    azimuth=(0, 128),
    duration_ns=100,
    sequence=0,
    ticks=None,
    sac_sic=(0, 0),
    compressed=0,
    first_cell=0,
):
    """One data block, put together by hand."""
    parts = -(-len(cells) // 4)
    body = bytes([0xEB, 0xC0 if ticks is None else 0xC8, *sac_sic, 2])
    body += struct.pack(">IHHII", sequence, *(a % 65536 for a in azimuth), first_cell, duration_ns)
    body += bytes([compressed, resolution])
    body += struct.pack(">H", len(cells))
    body += (len(cells) if count is None else count).to_bytes(3, "big")
    body += bytes([parts]) + cells.ljust(4 * parts, b"\0")
    body += b"" if ticks is None else ticks.to_bytes(3, "big")
    return b"\xf0" + struct.pack(">H", len(body) + 3) + body


@pytest.mark.parametrize("compress", [zlib.compress, gzip.compress, lambda o: zlib.compress(o)[2:]])
@pytest.mark.parametrize("cells", [bytes(range(200)), bytes(200), b"\1\2"])
def test_compressed_video_is_read_as_what_was_compressed(path, cells, compress):
    for resolution, count in ((1, 8 * len(cells)), (4, len(cells)), (5, len(cells) // 2)):
        plain = record(cells=cells, resolution=resolution, count=count, ticks=0)
        packed = record(
            cells=compress(cells), resolution=resolution, count=count, ticks=0, compressed=128
        )
        (wanted,), _ = read(path, plain)
        (got,), report = read(path, packed)
        assert got.amplitude.tolist() == wanted.amplitude.tolist()
        assert report.notes == []


def test_small_cells_are_scaled_to_full_scale(path):
    octets = b"".join(
        record(cells=b"\xb1", resolution=r, count=8 >> (r - 1), ticks=0, sequence=r)
        for r in (1, 2, 3)
    )
    videos, _ = read(path, octets)
    assert [v.amplitude.tolist() for v in videos] == [
        [[255, 0, 255, 255, 0, 0, 0, 255]],
        [[170, 255, 0, 85]],
        [[187, 17]],
    ]


def test_a_sender_that_reports_no_width_is_given_the_step(path):
    octets = b"".join(
        record(azimuth=(64 * k, 64 * k), sequence=k, ticks=k) for k in range(10) if k != 4
    )
    (block,), report = read(path, octets)
    assert block.azimuth_width_rad == pytest.approx(64 * STEP)
    assert report.missing == 1


def test_a_sender_that_does_not_count_or_report_the_time_is_read(path):
    octets = b"".join(record(azimuth=(16 * k, 16 * k + 16)) for k in range(4096 + 1024))
    with pytest.raises(RecordingError, match=r"no sweep has a time of day; wanted .* got 5120"):
        read(path, octets)
    videos, report = read(path, period_s=2.5)
    assert [len(v) for v in videos] == [4096, 1024]
    assert videos[1].time_s[[0, -1]] == pytest.approx([2.5, 2.5 * 5119 / 4096])
    assert report.notes == []


def test_an_antenna_that_turns_anticlockwise_is_read(path):
    octets = b"".join(
        record(azimuth=(-k * 128, -k * 128 - 128), sequence=k, ticks=k) for k in range(1024)
    )
    videos, report = read(path, octets)
    assert [len(v) for v in videos] == [512, 512]
    assert report.notes == []
    assert all((np.diff(v.azimuth_rad) < 0).all() for v in videos)


def test_one_radar_is_read_of_several(path):
    octets = b"".join(
        record(azimuth=(128 * k, 128 * k + 128), sequence=k // 2, ticks=k, sac_sic=(1, k % 2))
        for k in range(10)
    )
    (first,), report = read(path, octets)
    assert (len(first), report.source, report.other_source) == (5, (1, 0), 5)
    (second,), report = read(path, source=(1, 1))
    assert (len(second), report.source, report.other_source) == (5, (1, 1), 5)
    assert second.azimuth_rad[0] > first.azimuth_rad[0]
    (second,), report = read(path, source=[1, 1])
    assert (len(second), report.other_source) == (5, 5)


def test_a_radar_that_is_not_in_the_file_is_an_error_that_names_those_that_are(path):
    octets_of(path, video(6), source=(25, 7))
    with pytest.raises(RecordingError) as caught:
        read(path, source=(25, 8))
    assert caught.value.wanted == "sweeps of source (25, 8)"
    assert caught.value.got == "6 of others, first of (25, 7)"


def test_other_categories_are_passed_over(path):
    blocks = blocks_of(octets_of(path, video(6)))
    octets = b"".join(b"\x30\x00\x07\xf0\x00\x01\x02" + block for block in blocks)
    (block,), report = read(path, octets)
    assert (len(block), report.other_blocks, report.notes) == (6, 6, [])


# ------------------------------------------------------------------ bad files


def test_missing_repeated_and_late_sweeps(path):
    blocks = blocks_of(octets_of(path, video(12)))
    order = [0, 1, 1, 2, 5, 6, 6, 6, 4, 9, 10, 11]
    (block,), report = read(path, b"".join(blocks[k] for k in order))
    assert np.array_equal(block.amplitude, video(12).amplitude[[0, 1, 2, 5, 6, 9, 10, 11]])
    assert (report.missing, report.repeated, report.late) == (4, 3, 1)
    assert report.notes == [
        "4 sweeps missing",
        "3 sweeps that repeat the one before left out",
        "1 sweep that comes late left out",
    ]


@given(bit=st.integers(0, 31), hit=st.integers(1, 198))
def test_a_damaged_count_costs_no_other_sweep(tmp_path_factory, bit, hit):
    path = tmp_path_factory.mktemp("video") / "radar.cat240"
    whole = video(200, 1)
    blocks = [bytearray(block) for block in blocks_of(octets_of(path, whole))]
    blocks[hit][11 - bit // 8] ^= 1 << bit % 8
    videos, _ = read(path, b"".join(blocks))
    left = np.delete(np.arange(200), hit)
    azimuth = np.concatenate([v.azimuth_rad for v in videos])
    sweeps = np.round(azimuth / whole.azimuth_width_rad)
    assert np.isin(left, sweeps).all()
    assert (np.diff(sweeps) > 0).all()


def test_a_sender_that_begins_anew_is_followed(path):
    octets = octets_of(path, video(200))
    videos, report = read(path, octets + octets)
    assert [len(v) for v in videos] == [200, 200]
    assert (report.late, report.missing, report.time_jumps) == (0, 0, 1)


def sweeps_in_parts(turns, parts, *, order=range, without=()):
    """Sweeps of 24 cells, 64 a turn, each in some records; and the same in one record each."""
    whole, apart = [], []
    for k in range(64 * turns):
        cells = bytes((3 * k + c) % 251 for c in range(24))
        azimuth = (1024 * k, 1024 * k + 1024)
        whole.append(record(cells=cells, azimuth=azimuth, sequence=k, ticks=10 * k))
        size = 24 // parts
        for p in order(parts):
            if (k, p) in without:
                cells = cells[: p * size] + bytes(size) + cells[(p + 1) * size :]
                whole[-1] = record(cells=cells, azimuth=azimuth, sequence=k, ticks=10 * k)
                continue
            part = cells[p * size : (p + 1) * size]
            given = {"azimuth": azimuth, "ticks": 10 * k, "first_cell": p * size}
            apart.append(record(cells=part, sequence=len(apart), **given))
    return b"".join(whole), b"".join(apart)


def assert_same_video(got, wanted):
    assert [len(v) for v in got] == [len(v) for v in wanted]
    for one, other in zip(got, wanted, strict=True):
        assert one.amplitude.tolist() == other.amplitude.tolist()
        assert one.time_s.tolist() == other.time_s.tolist()
        assert one.azimuth_rad.tolist() == other.azimuth_rad.tolist()
        assert (one.start_range_m, one.cell_m) == (other.start_range_m, other.cell_m)


@pytest.mark.parametrize("parts", [2, 3, 4, 8])
@pytest.mark.parametrize("order", [range, lambda n: reversed(range(n))])
def test_a_sweep_in_parts_is_one_sweep(path, parts, order):
    whole, apart = sweeps_in_parts(2, parts, order=order)
    wanted, _ = read(path, whole)
    got, report = read(path, apart)
    assert_same_video(got, wanted)
    assert report.notes == []


def test_a_part_that_is_lost_is_zero_and_said(path):
    whole, apart = sweeps_in_parts(2, 4, without={(20, 0), (31, 2), (70, 3)})
    wanted, _ = read(path, whole)
    got, report = read(path, apart)
    assert_same_video(got, wanted)
    assert report.notes == ["3 sweeps lack one of their parts"]


@pytest.mark.parametrize("burst", [1, 2, 16])
def test_of_two_range_scales_in_turn_one_is_read_and_said(path, burst):
    def sweeps(scales):
        octets = []
        for k in range(0, 256, burst):
            for duration_ns in scales:
                for j in range(k, k + burst):
                    azimuth = (1024 * j, 1024 * j + 1024)
                    octets.append(
                        record(
                            cells=bytes([j, duration_ns, 7]),
                            azimuth=azimuth,
                            sequence=len(octets),
                            ticks=10 * j,
                            duration_ns=duration_ns,
                        )
                    )
        return b"".join(octets)

    def amplitudes(videos):
        return [row for video in videos for row in video.amplitude.tolist()]

    for scales in ((100, 200), (200, 100)):
        for chosen, range_scale_m in ((200, None), (200, 1e9), (100, 1.0)):
            (*wanted,), _ = read(path, sweeps([chosen]))
            (*got,), report = read(path, sweeps(scales), range_scale_m=range_scale_m)
            assert amplitudes(got) == amplitudes(wanted)
            (note,) = report.notes
            assert "256 sweeps" in note
            assert f"{3 * (300 - chosen) * 0.149896:.0f} m" in note


def test_a_change_of_range_scale_is_no_other_scale(path):
    octets = b"".join(
        record(
            azimuth=(1024 * k, 1024 * k + 1024),
            sequence=k,
            ticks=10 * k,
            duration_ns=100 if k // 200 % 2 else 200,
        )
        for k in range(800)
    )
    _, report = read(path, octets)
    assert (report.sweeps, report.notes) == (800, [])


@pytest.mark.parametrize("begin", [0, 40, 100])
def test_a_time_of_day_that_stands_is_said_and_the_period_used(path, begin):
    def sweeps(ticks):
        return b"".join(
            record(azimuth=(1024 * k, 1024 * k + 1024), sequence=k, ticks=ticks(k))
            for k in range(256)
        )

    def moves(k):
        return 10 * k

    standing = sweeps(lambda k: moves(min(k, begin)))
    wanted, _ = read(path, sweeps(moves))
    got, report = read(path, standing, period_s=64 * 10 / 128)
    time_s, wanted_s = (np.concatenate([v.time_s for v in videos]) for videos in (got, wanted))
    np.testing.assert_allclose(time_s, wanted_s, atol=10 / 128)
    assert len(time_s) == 256
    (note,) = report.notes
    assert "a time of day that stands" in note
    if begin == 0:
        with pytest.raises(RecordingError, match=r"period_s.*stands in 256 sweeps"):
            read(path, standing)


def test_times_that_step_back_a_little_are_held(path):
    octets = b"".join(
        record(azimuth=(128 * k, 128 * k + 128), sequence=k, ticks=ticks)
        for k, ticks in enumerate([100, 101, 99, 102])
    )
    (block,), report = read(path, octets)
    assert (block.time_s * 128).tolist() == [100, 101, 101, 102]
    assert report.notes == ["1 sweep whose time goes back, set to the previous time"]


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        ({"compressed": 128}, "compressed video .* wanted zlib data of 4 cells of 8 bits, got"),
        ({"resolution": 6}, "cannot be read; wanted 1 to 5 .*, got 6"),
        ({"count": 0}, "without cells; wanted at least 1 cell, got 0"),
        ({"count": 5}, "more cells than it holds; wanted 5 octets, got 4"),
        ({"duration_ns": 0}, "no length; wanted at least 1 femtosecond, got 0"),
        ({"azimuth": (0, 32768)}, "half a turn; wanted fewer than 32768 steps .*, got 32768"),
    ],
)
def test_what_cannot_be_read_is_named_and_the_rest_is_read(path, bad, words):
    good = [record(sequence=k, ticks=k, azimuth=(128 * k, 128 * k + 128)) for k in range(3)]
    octets = good[0] + record(**{"sequence": 1, "ticks": 1} | bad) + good[2]
    (block,), report = read(path, octets)
    assert (len(block), report.problems) == (2, 1)
    assert report.notes[0].startswith("1 record cannot be read (first: ")
    with pytest.raises(RecordingError, match=words) as caught:
        read(path, strict=True)
    assert caught.value.offset == len(good[0]) + 3
    assert f"radar.cat240, octet {len(good[0]) + 3}: " in str(caught.value)
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


def test_a_file_cut_anywhere_gives_the_whole_sweeps(path):
    octets = octets_of(path, video(3))
    length = len(octets) // 3
    for size in range(length, len(octets)):
        videos, report = read(path, octets[:size])
        assert report.sweeps == size // length
        assert np.array_equal(amplitudes(videos), video(3).amplitude[: size // length])
        assert report.problems == (size % length > 0)
    with pytest.raises(RecordingError, match=r"octet 110: .* inside .*; wanted 55 .*, got 54"):
        read(path, octets[:-1], strict=True)


def test_damage_costs_the_sweeps_it_hits_only(path):
    random = np.random.default_rng(3)
    blocks = blocks_of(octets_of(path, video(40)))
    for _ in range(30):
        garbage = random.integers(0, 256, random.integers(1, 400), np.uint8).tobytes()
        _, report = read(path, b"".join(blocks[:15]) + garbage + b"".join(blocks[15:]))
        assert report.sweeps == 40
        assert report.problems >= 1
        assert 0 < report.skipped_octets <= len(garbage)
        assert any(note.endswith("octets skipped because of damage") for note in report.notes)


@given(data=st.data(), file=st.sampled_from(CORPUS))
def test_no_octets_upset_the_reader(tmp_path_factory, data, file):
    octets = bytearray(file.read_bytes())
    for _ in range(data.draw(st.integers(0, 6))):
        at = data.draw(st.integers(0, max(len(octets) - 1, 0)))
        octets[at : at + data.draw(st.integers(0, 3))] = data.draw(st.binary(max_size=4))
    path = tmp_path_factory.mktemp("video") / "radar.cat240"
    path.write_bytes(octets)
    report = VideoReport()
    videos = recording.read_video(path, period_s=2.5, report=report)
    try:
        assert sum(len(v) for v in videos) == report.sweeps > 0
    except RecordingError:  # for want of a sweep, and for nothing else
        assert report.sweeps == 0


@pytest.mark.parametrize(
    ("octets", "got"),
    [
        (b"", "got nothing"),
        (b"time_s,north_m\n1,2\n", "got this"),
        (bytes(1000), "got binary data"),
    ],
)
def test_a_file_without_video_is_an_error(path, octets, got):
    with pytest.raises(RecordingError, match="no radar video; wanted sweeps of ASTERIX") as caught:
        read(path, octets)
    assert got in str(caught.value)


def test_a_damaged_file_of_gzip_is_named_and_no_video(path):
    like_a_summary = b"\xf0\x00\x11\xd0\x01\x02\x01\tby chance"
    packed = b"\x1f\x8b" + bytes(9) + like_a_summary + bytes(50)
    with pytest.raises(RecordingError, match="damaged by gzip"):
        read(path, packed)
    packed = gzip.compress(bytes(50) + like_a_summary)
    with pytest.raises(RecordingError, match="no radar video"):
        read(path, packed[:-9])


def test_a_file_that_is_not_there_is_an_error(path):
    with pytest.raises(RecordingError, match="cannot be read"):
        read(path)
    with pytest.raises(FileNotFoundError):
        recording.is_video(path)


def test_what_a_reader_and_a_writer_are_reported_must_make_sense(path):
    with pytest.raises(ValueError, match="period_s must be finite and positive, got 0"):
        recording.read_video(path, period_s=0)
    with pytest.raises(ValueError, match="midnight_s must be finite, got nan"):
        recording.read_video(path, midnight_s=float("nan"))
    with pytest.raises(ValueError, match="summary must be ASCII"):
        recording.write_video(path, [], summary="Ærø")
    with pytest.raises(ValueError, match="source must be two numbers from 0 to 255"):
        recording.write_video(path, [], source=(0, 256))
    with pytest.raises(ValueError, match="source must be two numbers from 0 to 255"):
        recording.write_video(path, [], source=(0,))
    with pytest.raises(ValueError, match="source must be two numbers from 0 to 255"):
        recording.read_video(path, source=(0, 1, 2))
    with pytest.raises(ValueError, match="too many cells"):
        recording.write_video(path, video(1, 65025))
    azimuth_rad = np.arange(400) * 2 * np.pi / 512
    azimuth_rad[399] = np.nan
    with pytest.raises(ValueError, match=r"sweep 399 cannot .* azimuth_rad .* got nan"):
        recording.write_video(path, video(400, azimuth_rad=azimuth_rad))
    with pytest.raises(ValueError, match=r"cell_m must be finite and below 1e\+06, got 2"):
        recording.write_video(path, [video(1), video(1, cell_m=2e6)])
    assert not path.exists()  # what could not be written leaves no file
    assert list(path.parent.iterdir()) == []


# ------------------------------------------------------------------ telling video from tables


def test_video_is_reported_from_tables(path):
    octets = octets_of(path, video(3))
    reported = [octets, octets[:30], b"\x30\x00\x03" + octets, bytes(99) + octets]
    other = [b"", b"\xf0", b"time_s,north_m\n1,2\n", "🚢 time_s\n".encode(), bytes(5000)]
    for wanted, files in ((True, reported), (False, other)):
        for content in files:
            path.write_bytes(content)
            assert recording.is_video(path) is wanted


# ------------------------------------------------------------------ beside another implementation


@pytest.fixture(scope="module")
def oracle():
    """Category 240 of libasterix, made from a specification written down by others."""
    generated = pytest.importorskip("asterix.generated")
    return pytest.importorskip("asterix.base"), generated.Cat_240_1_3


def uint(record, item, part=None):
    value = record.get_item(item)
    return value.as_uint() if part is None else value.variation.get_item(part).as_uint()


@pytest.mark.parametrize(
    ("cells", "dtype", "item", "octets"),
    [(20, np.uint8, "050", 4), (600, np.uint16, "051", 64), (20000, np.uint8, "052", 256)],
)
def test_another_implementation_reads_what_we_write(path, oracle, cells, dtype, item, octets):
    base, spec = oracle
    written = video(3, cells, dtype=dtype, start_s=50.0, first=100)
    octets_of(path, written, source=(25, 7))
    blocks = base.RawDatablock.parse(base.Bits.from_bytes(path.read_bytes()))
    assert [block.get_category() for block in blocks] == [240] * 3
    for k, block in enumerate(blocks):
        (record,) = spec.cv_uap.parse(block.get_raw_records())
        assert (uint(record, "010", "SAC"), uint(record, "010", "SIC")) == (25, 7)
        assert (uint(record, "000"), uint(record, "020")) == (2, k)
        assert uint(record, "041", "STARTAZ") == (100 + k) * 128 - 64
        assert uint(record, "041", "ENDAZ") == (100 + k) * 128 + 64
        assert uint(record, "041", "CELLDUR") == round(2 * 6.0 / 299792458 * 1e15)
        assert uint(record, "048", "RES") == (4 if dtype == np.uint8 else 5)
        assert uint(record, "049", "NBCELLS") == cells
        assert uint(record, "140") == 50 * 128 + 100 + k
        parts = record.get_item(item).variation.get_list()
        video_octets = b"".join(part.as_uint().to_bytes(octets, "big") for part in parts)
        assert video_octets.startswith(
            written.amplitude[k].astype(f">u{dtype().itemsize}").tobytes()
        )


def test_we_read_what_another_implementation_writes(path, oracle):
    _, spec = oracle
    said = spec.cv_record.create(
        {"010": (("SAC", 25), ("SIC", 7)), "000": 1, "030": list(b"harbour radar")}
    )
    sweeps = [
        spec.cv_record.create(
            {
                "010": (("SAC", 25), ("SIC", 7)),
                "000": 2,
                "020": k,
                "040": (
                    ("STARTAZ", 65536 - 64 + 128 * k & 0xFFFF),
                    ("ENDAZ", 64 + 128 * k),
                    ("STARTRG", 10),
                    ("CELLDUR", 100),
                ),
                "048": (("C", 0), 0, ("RES", 5)),
                "049": (("NBVB", 6), ("NBCELLS", 3)),
                "050": [0x00010203 + k, 0x04050000],
                "140": 128 + k,
            }
        )
        for k in range(4)
    ]
    octets = b"".join(
        spec.create(records).unparse().to_bytes() for records in ([said], sweeps[:1], sweeps[1:])
    )
    (block,), report = read(path, octets)
    assert (report.notes, report.summaries) == ([], ["harbour radar"])
    assert block.amplitude.tolist() == [[1, 0x203 + k, 0x405] for k in range(4)]
    assert block.azimuth_rad == pytest.approx(128 * STEP * np.arange(4), abs=1e-12)
    assert block.time_s.tolist() == [1 + k / 128 for k in range(4)]
    assert block.cell_m == pytest.approx(14.9896229, abs=1e-9)
    assert block.start_range_m == pytest.approx(149.896229, abs=1e-8)


def test_what_happened_once_is_reported_in_the_singular():
    counts = ("skipped_octets", "other_source", "missing", "repeated", "late", "untimed", "held")
    counts += ("time_jumps", "reversals", "astray")
    once = VideoReport(**dict.fromkeys(counts, 1)).notes
    twice = VideoReport(**dict.fromkeys(counts, 2)).notes
    assert once[0] == "1 octet skipped because of damage"
    assert once[-1] == "1 sweep far from its neighbours in azimuth, time or count left out"
    assert not [note for note in once if re.match(r"1 \w+s\b", note)]
    assert all(re.match(r"2 \w+s\b", note) for note in twice)
