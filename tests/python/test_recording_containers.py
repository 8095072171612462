"""Files in containers: compressed, in network captures, in ASTERIX final format, and others."""

import bz2
import gzip
import lzma
import random
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cases import blocks_of
from wakeline import recording
from wakeline.recording import RadarVideo, RecordingError, VideoReport, containers, read_nmea

BEGIN_S = 1786795200.0  # 2026-08-15 12:00:00


def video(turns=2, sweeps=32, cells=900):
    azimuth_rad = 2 * np.pi * (np.arange(turns * sweeps) + 0.5) / sweeps
    amplitude = np.random.default_rng(0).integers(0, 255, (turns * sweeps, cells), dtype=np.uint8)
    time_s = 100.0 + np.arange(turns * sweeps) / 16
    return RadarVideo(amplitude, azimuth_rad, time_s, 2 * np.pi / sweeps, 0.0, 6.0)


@pytest.fixture(scope="module")
def blocks(tmp_path_factory):
    path = tmp_path_factory.mktemp("video") / "radar.cat240"
    recording.write_video(path, video())
    return blocks_of(path.read_bytes())


def sentences(count=60):
    lines = []
    for k in range(count):
        body = (
            f"GPRMC,12{k // 60:02d}{k % 60:02d}.00,A,5430.{k:03d},N,01030.000,E,6.0,60.0,150826,,"
        )
        checksum = 0
        for letter in body:
            checksum ^= ord(letter)
        lines.append(f"${body}*{checksum:02X}\r\n".encode())
    return lines


# ------------------------------------------------------------------ captures, put together by hand


def udp(payload, port=8600):
    return struct.pack(">4H", 5000, port, 8 + len(payload), 0) + payload


def tcp(payload, sequence, flags=0x10):
    return struct.pack(">2HIIBBHHH", 5000, 10110, sequence, 0, 0x50, flags, 0, 0, 0) + payload


def ipv4(content, protocol=17, *, number=0, largest=65000):
    packets, step = [], largest // 8 * 8
    for at in range(0, max(len(content), 1), step):
        part, more = content[at : at + step], at + step < len(content)
        head = (0x45, 0, 20 + len(part), number, (0x2000 if more else 0) | at // 8, 64, protocol, 0)
        addresses = bytes([10, 0, 0, 1, 239, 1, 1, 1])
        packets.append(struct.pack(">2B3H2BH", *head) + addresses + part)
    return packets


def ipv6(content, protocol=17, *, number=0, largest=65000):
    packets, step = [], largest // 8 * 8
    for at in range(0, len(content), step):
        part, more = content[at : at + step], at + step < len(content)
        if len(content) > step:
            part = struct.pack(">BBHI", protocol, 0, at | more, number) + part
        next_head = 44 if len(content) > step else protocol
        head = struct.pack(">IHBB", 6 << 28, len(part), next_head, 64)
        packets.append(head + bytes(15) + b"\1" + bytes(15) + b"\2" + part)
    return packets


LINKS = {
    "Ethernet": (1, lambda p: bytes(12) + kind(p) + p + bytes(max(0, 46 - len(p)))),
    "VLAN": (1, lambda p: bytes(12) + b"\x81\0\0\7" + kind(p) + p),
    "two VLANs": (1, lambda p: bytes(12) + b"\x88\xa8\0\7\x81\0\0\7" + kind(p) + p),
    "Linux any": (113, lambda p: bytes(14) + kind(p) + p),
    "Linux any 2": (276, lambda p: kind(p) + bytes(18) + p),
    "loopback": (0, lambda p: b"\2\0\0\0" + p),
    "raw": (101, lambda p: p),
}


def kind(packet):
    return b"\x08\x00" if packet[0] >> 4 == 4 else b"\x86\xdd"


def pcap(frames, link=1, order="<", per_second=10**6, magic=None):
    magic = magic or {10**6: 0xA1B2C3D4, 10**9: 0xA1B23C4D}[per_second]
    octets = struct.pack(f"{order}IHHiIII", magic, 2, 4, 0, 0, 65535, link)
    for k, frame in enumerate(frames):
        moment = divmod(round((BEGIN_S + k) * per_second), per_second)
        octets += struct.pack(f"{order}4I", *moment, len(frame), len(frame)) + frame
    return octets


def pcapng(frames, link=1, order="<", resolution=6):
    def block(kind, body):
        body += bytes(-len(body) % 4)
        length = struct.pack(f"{order}I", 12 + len(body))
        return struct.pack(f"{order}I", kind) + length + body + length

    clock = struct.pack(f"{order}HHB3x2H", 9, 1, resolution, 0, 0)
    octets = block(0x0A0D0D0A, struct.pack(f"{order}IHHq", 0x1A2B3C4D, 1, 0, -1))
    octets += block(5, bytes(12)) + block(1, struct.pack(f"{order}HHI", link, 0, 0) + clock)
    for k, frame in enumerate(frames):
        moment = divmod(round((BEGIN_S + k) * 10**resolution), 1 << 32)
        head = struct.pack(f"{order}5I", 0, *moment, len(frame), len(frame))
        octets += block(6, head + frame)
    return octets


def final(blocks):
    return b"".join(
        struct.pack(">H", len(block) + 12) + b"\0\1\0\0\0\1" + block + b"\xa5\xa5\xa5\xa5"
        for block in blocks
    )


def sweeps_of(path, octets):
    path.write_bytes(octets)
    assert recording.is_video(path)
    report = VideoReport()
    videos = list(recording.read_video(path, report=report))
    return np.concatenate([v.amplitude for v in videos]), report


def assert_is_the_video(got):
    np.testing.assert_array_equal(got, video().amplitude)


# ------------------------------------------------------------------ radar video


@pytest.mark.parametrize("packed", [gzip.compress, bz2.compress, lzma.compress])
def test_compressed_video_and_text_are_read(tmp_path, blocks, packed):
    got, report = sweeps_of(tmp_path / "radar", packed(b"".join(blocks)))
    assert_is_the_video(got)
    assert report.notes == []
    half = len(blocks) // 2
    parts = [packed(b"".join(part)) for part in (blocks[:half], blocks[half:])]
    assert_is_the_video(sweeps_of(tmp_path / "radar", b"".join(parts))[0])
    path = tmp_path / "plots.csv"
    path.write_bytes(packed(b"time_s,north_m,east_m\n0,1,2\n"))
    assert recording.read_plots(path).episodes[0].plot_count == 1


def test_a_compressed_file_that_is_cut_is_read_until_there(tmp_path):
    path = tmp_path / "log.gz"
    packed = gzip.compress(b"".join(sentences(600)), compresslevel=0)
    path.write_bytes(packed[: len(packed) // 2])
    assert 250 < len(read_nmea(path).fixes) < 350
    path.write_bytes(packed[:5000] + b"x" + packed[5001:])
    with pytest.raises(RecordingError, match="gzip"):
        read_nmea(path)


@pytest.mark.parametrize("link", LINKS)
@pytest.mark.parametrize("written", [pcap, pcapng])
@pytest.mark.parametrize("ip", [ipv4, ipv6])
def test_video_in_a_capture_is_read(tmp_path, blocks, link, written, ip):
    number, framed = LINKS[link]
    frames = [
        framed(packet)
        for k in range(0, len(blocks), 3)
        for packet in ip(udp(b"".join(blocks[k : k + 3])), number=k, largest=1480)
    ]
    for order in "<>":
        got, report = sweeps_of(tmp_path / "radar", written(frames, number, order))
        assert_is_the_video(got)
        assert report.notes == [f"{report.contents.form} of {len(frames)} packets"]


@pytest.mark.parametrize("seed", range(3))
def test_other_traffic_and_the_order_of_fragments_do_not_matter(tmp_path, blocks, seed):
    frames, chance = [], random.Random(seed)
    for k, block in enumerate(blocks):
        parts = ipv4(udp(block), number=k, largest=400)
        chance.shuffle(parts)
        frames += parts
        frames.append(chance.choice(other_packets()))
    path = tmp_path / "radar"
    frames = [LINKS["Ethernet"][1](frame) for frame in frames]
    got, report = sweeps_of(path, pcap(frames, per_second=10**9))
    assert_is_the_video(got)
    assert report.problems == 0


def other_packets():
    return [
        *ipv4(udp(b"\xf0\x00\x08 by chance", 53)),
        *ipv4(udp(b"", 5353)),
        *ipv4(udp(sentences(1)[0], 10110)),
        *ipv4(tcp(b"GET / HTTP/1.1\r\n", 1), 6),
        *ipv4(b"\x16\0\0\0", 2),
        *ipv6(b"\x80" + bytes(30), 58),
        *ipv4(udp(b"\x30\x00\x06\xf0\x19\x0d")),
    ]


def test_a_damaged_capture_is_read_until_there(tmp_path, blocks):
    frames = [LINKS["Ethernet"][1](packet) for block in blocks for packet in ipv4(udp(block))]
    whole = pcap(frames)
    for octets in (whole[:-400], whole + b"\xff" * 16 + bytes(100)):
        got, _ = sweeps_of(tmp_path / "radar", octets)
        assert len(got) >= len(blocks) - 1
    cut = struct.pack("<4I", 0, 0, 100, 1500) + frames[0][:100]
    got, report = sweeps_of(tmp_path / "radar", whole + cut)
    assert_is_the_video(got)
    assert "1 packet recorded in part" in report.notes[1]


def test_video_in_final_format_is_read(tmp_path, blocks):
    got, report = sweeps_of(tmp_path / "radar.ff", final(blocks))
    assert_is_the_video(got)
    assert report.contents.form == "ASTERIX final format"
    damaged = final(blocks[:10]) + b"\0" + final(blocks[10:])
    got, report = sweeps_of(tmp_path / "radar.ff", damaged)
    assert len(got) >= len(blocks) - 1
    assert report.notes


# ------------------------------------------------------------------ NMEA 0183


@pytest.mark.parametrize("written", [pcap, pcapng])
def test_sentences_of_a_capture_are_those_of_the_log(tmp_path, blocks, written):
    plain, captured = tmp_path / "log.nmea", tmp_path / "log.pcap"
    plain.write_bytes(b"".join(sentences()))
    frames = []
    for k, line in enumerate(sentences()):
        line = line.rstrip() if k % 2 else b"UdPbC\0\\s:GP0001,n:1*00\\" + line
        frames += ipv4(udp(line, 10110))
        frames += ipv4(udp(blocks[k]))
    captured.write_bytes(written([LINKS["Ethernet"][1](frame) for frame in frames]))
    assert_same_fixes(read_nmea(captured), read_nmea(plain))


@pytest.mark.parametrize("seed", range(5))
def test_lines_over_tcp_are_whole_and_once(tmp_path, seed):
    chance = random.Random(seed)
    stream = b"".join(sentences())
    segments, at = [], 0
    while at < len(stream):
        size = chance.randint(1, 300)
        segments.append((at, stream[at : at + size]))
        at += size
    for k in range(0, len(segments) - 1, 3):
        segments[k : k + 2] = segments[k : k + 2][::-1]
    segments += chance.sample(segments, 3)
    begin = chance.choice([7, 2**32 - 100])
    packets = [ipv4(tcp(b"", begin - 1, 0x02), 6)]
    packets += [ipv4(tcp(part, (begin + at) % 2**32), 6) for at, part in segments]
    frames = [LINKS["raw"][1](packet) for (packet,) in packets]
    (tmp_path / "a.pcap").write_bytes(pcap(frames, 101))
    (tmp_path / "a.nmea").write_bytes(stream)
    assert_same_fixes(read_nmea(tmp_path / "a.pcap"), read_nmea(tmp_path / "a.nmea"))


def assert_same_fixes(one, other):
    assert one.report.problems == other.report.problems
    assert one.fixes.time_s.tolist() == other.fixes.time_s.tolist()
    assert one.fixes.latitude_deg.tolist() == other.fixes.latitude_deg.tolist()


# ------------------------------------------------------------------ what is not read is named


def test_other_categories_are_named(tmp_path):
    path = tmp_path / "radar.ast"
    block = b"\x30\x00\x0e\xf0\x19\x0d\x54\x60\x00\x20\x40\x00\x10\x00"
    other = b"\x22\x00\x0b\xf0\x19\x0d\x01\x54\x60\x00\x20"
    frames = [LINKS["Ethernet"][1](packet) for packet in ipv4(udp(block)) * 20]
    for octets, name in (
        (block * 20, "ASTERIX category 48"),
        (block, "ASTERIX category 48"),
        ((other + block) * 20, "ASTERIX categories 34, 48"),
        (final([block] * 20), "ASTERIX category 48"),
        (pcap(frames), "20 ASTERIX category 48"),
        (gzip.compress(block * 20), "ASTERIX category 48"),
    ):
        path.write_bytes(octets)
        for read in (recording.read_plots, lambda p: list(recording.read_video(p)), read_nmea):
            with pytest.raises(RecordingError, match=name) as caught:
                read(path)
            assert "CSV text" not in str(caught.value)
        assert not recording.is_video(path)


@pytest.mark.parametrize(
    ("octets", "name"),
    [
        (b"PK\x03\x04" + bytes(100), "zip"),
        (b"\x89HDF\r\n\x1a\n" + bytes(100), "HDF5"),
        (b"\x89PNG\r\n\x1a\n" + bytes(100), "PNG"),
        (b"%PDF-1.7\n" + bytes(100), "PDF"),
        (b"SQLite format 3\0" + bytes(100), "SQLite"),
        (b"PAR1" + bytes(100), "Parquet"),
        (random.Random(0).randbytes(5000), "binary data"),
        (pcap([LINKS["Ethernet"][1](p) for p in ipv4(udp(b"\1\2", 6678)) * 9]), "9 UDP .* 6678"),
        (pcap([]), "network capture"),
    ],
)
def test_other_binaries_are_named(tmp_path, octets, name):
    path = tmp_path / "file"
    path.write_bytes(octets)
    for read in (recording.read_plots, recording.read_ais, read_nmea):
        with pytest.raises(RecordingError, match=name):
            read(path)


@given(st.binary(max_size=300), st.integers(0, 5))
def test_any_capture_is_read_or_named(data, magic):
    begin = [
        b"\xd4\xc3\xb2\xa1",
        b"\xa1\xb2\x3c\x4d",
        b"\x0a\x0d\x0d\x0a",
        b"\x1f\x8b\x08",
        b"",
        b"BZh9",
    ]
    octets = begin[magic] + data
    contents = containers.Contents()
    for _ in containers._unpacked(iter([octets]), containers._video_in, contents):
        pass
    containers.instead_of_text(octets)
