"""Content of files: compressed, in network captures, or in the final format of ASTERIX."""

from __future__ import annotations

import bz2
import ipaddress
import lzma
import re
import struct
import zlib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from wakeline._brief import many

from .errors import RecordingError

_READ = 1 << 18  # octets
_MOST_BINARY = 1 << 24
_LARGEST_PACKET = 1 << 18
_MOST_FRAGMENTS = 4096

_COMPRESSED: dict[bytes, tuple[str, Callable[[], Any]]] = {
    b"\x1f\x8b": ("gzip", lambda: zlib.decompressobj(31)),
    b"BZh": ("bzip2", bz2.BZ2Decompressor),
    b"\xfd7zXZ\0": ("xz", lzma.LZMADecompressor),
}
_BINARY = {
    b"PK\x03\x04": "a file compressed by zip, decompress it first",
    b"(\xb5/": "a file compressed by zstd, decompress it first",
    b"7z\xbc\xaf": "a file compressed by 7z, decompress it first",
    b"Rar!": "a file compressed by rar, decompress it first",
    b"%PDF": "a PDF document",
    b"\x89PNG": "a PNG picture",
    b"\xff\xd8\xff": "a JPEG picture",
    b"\x89HDF": "an HDF5 file (or NetCDF 4 or MATLAB), export it as CSV",
    b"CDF": "a NetCDF file, export it as CSV",
    b"MATLAB": "a MATLAB file, export it as CSV",
    b"PAR1": "a Parquet file, export it as CSV",
    b"ARROW1": "an Arrow file, export it as CSV",
    b"SQLite": "an SQLite database, export it as CSV",
    b"#ROSBAG": "a ROS bag, export it as CSV",
    b"\xd0\xcf\x11\xe0": "a spreadsheet or document of Microsoft Office, export it as CSV",
    b"\x93NUMPY": "a numpy array, export it as CSV",
    b"\x7fELF": "a program",
}
_UNKNOWN = "binary data of an unknown format"
_CONTROLS = re.compile(rb"[\x00-\x08\x0e-\x1a\x1c-\x1f]")

_CAPTURES = {b"\xa1\xb2\xc3\xd4": 1e-6, b"\xa1\xb2\x3c\x4d": 1e-9, b"\xa1\xb2\xcd\x34": 1e-6}
_SECTION = b"\x0a\x0d\x0d\x0a"
_FINAL_HEAD, _FINAL_END = 8, b"\xa5\xa5\xa5\xa5"

_IPV4, _IPV6, _VLANS = 0x0800, 0x86DD, (0x8100, 0x88A8, 0x9100)
_LINK_OCTETS = {1: (14, 12), 113: (16, 14), 276: (20, 0)}  # Ethernet, Linux "any": head, EtherType
_BARE_LINKS = {0: 4, 108: 4, 12: 0, 14: 0, 101: 0, 228: 0, 229: 0}  # octets before the IP packet
_TCP, _UDP, _FRAGMENT = 6, 17, 44
_EXTENSIONS = (0, 43, 60)  # of IPv6: hop by hop, routing, destination

_MOST_AHEAD = 64  # segments

_SENTENCE = re.compile(rb"[$!][A-Z][A-Z0-9]{2,}[,*]")
_TAGGED = re.compile(rb"\\[^\\]*\bc:\d")
_LONGEST_LINE = 1024


@dataclass
class Contents:
    """What a file is and what it holds beside what was asked for; filled while it is read.

    Attributes
    ----------
    form : str
        A container such as "a network capture (pcap)"; empty for a plain file.
    packets, used, cut : int
        Packets of the container, those with the content asked for, and those recorded in part.
    others : Counter
        Packets by protocol and receiver that hold something else.
    """

    form: str = ""
    packets: int = 0
    used: int = 0
    cut: int = 0
    others: Counter[str] = field(default_factory=Counter)

    @property
    def notes(self) -> list[str]:
        """Notes for the user, one sentence each."""
        if not self.form:
            return []
        notes = [f"{self.form} of {many(self.packets, 'packet')}"]
        if self.others:
            notes[0] += f", {self.others.total()} of them with other content"
        if self.cut:
            notes.append(f"{many(self.cut, 'packet')} recorded in part left out")
        return notes

    def __str__(self) -> str:
        most = ", ".join(f"{count} {what}" for what, count in self.others.most_common(4))
        return f"{self.form} of {many(self.packets, 'packet')} ({most or 'nothing of use'})"


def octets_of(path: str | Path, wanted: str | None = None) -> bytes:
    """Contents of a file of text, decompressed; of binary data at most the first 16 MiB.

    RecordingError, with what was expected, on failure.
    """
    return b"".join(_until_binary(_decompressed(Path(path), wanted)))


def sentences_of(path: str | Path, wanted: str) -> bytes:
    """Lines of NMEA 0183 of a file or of the datagrams of a network capture.

    Lines of a capture get the time of their packet in a TAG block, unless they have one.

    Raises
    ------
    RecordingError
        When the file cannot be read, or is a capture without such lines.
    """
    contents = Contents()
    pieces = _unpacked(_decompressed(Path(path), wanted), _sentences_in, contents)
    octets = b"".join(_until_binary(pieces))
    if contents.form and not contents.used:
        raise RecordingError(path, "no sentence in any packet", wanted=wanted, got=str(contents))
    return octets


def video_of(path: str | Path, contents: Contents) -> Iterator[bytes]:
    """Blocks of ASTERIX with category 240 among them, of a file, capture or final format."""
    return _unpacked(_decompressed(Path(path), None), _video_in, contents)


class Datagram(NamedTuple):
    """What a packet of a capture carries: when, to whom, and the octets.

    Octets of a connection, which is named, continue those before.
    """

    time_s: float | None
    address: str
    port: int
    octets: bytes
    connection: str = ""


def datagrams_of(path: str | Path) -> Iterator[Datagram]:
    """The datagrams of a network capture, and the octets of its TCP connections, in order.

    RecordingError, at once, when the file cannot be read or is not a capture.
    """
    contents = Contents()
    packets = _packets_of(_Stream(_decompressed(Path(path), None)), contents)
    if packets is None:
        raise RecordingError(path, "not a network capture", wanted="pcap or pcapng")
    return _datagrams_in(packets)


def _datagrams_in(packets: Iterable[_Packet]) -> Iterator[Datagram]:
    fragments, connections = _Fragments(), _Connections()
    flows: dict[tuple, Datagram] = {}
    for packet in packets:
        payload = _payload_of(packet, fragments) if packet.whole else None
        if payload is not None:
            _, _, address, _, port = payload.receiver.split()
            form = Datagram(packet.time_s, address, int(port), b"", _connection(payload))
            flows[payload.flow or ()] = form
            for octets in connections.in_order(payload):
                yield form._replace(octets=octets)
    for flow, octets in connections.rest():
        yield flows[flow]._replace(octets=octets)


def _connection(payload: _Payload) -> str:
    """The peers of a segment; empty for a datagram."""
    if payload.flow is None:
        return ""
    source, from_port, receiver, to_port = payload.flow
    ends = (source, from_port), (receiver, to_port)
    return " to ".join(f"{ipaddress.ip_address(address)}:{port}" for address, port in ends)


def instead_of_text(octets: bytes) -> str | None:
    """What a file is by its octets, and what to do; None if it may be text."""
    named = next((name for magic, name in _BINARY.items() if octets.startswith(magic)), None)
    if named is None and _controls(octets):
        named = _capture_in(octets) or _asterix_in(octets) or _UNKNOWN
        marked = octets.startswith((b"\xff\xfe", b"\xfe\xff"))
        zeros = [octets[k:4:2] == b"\0\0" for k in (0, 1)]
        if named is _UNKNOWN and (marked or zeros[0] != zeros[1]):
            named = "text in UTF-16, save it as UTF-8 first"
    return named


def _until_binary(pieces: Iterable[bytes]) -> Iterator[bytes]:
    """The pieces of a text; of binary data, which may be without end, enough to name it."""
    size, binary = 0, False
    for piece in pieces:
        binary = binary or (size == 0 and _controls(piece))
        size += len(piece)
        yield piece
        if binary and size >= _MOST_BINARY:
            return


def _controls(octets: bytes) -> bool:
    """Whether the file begins with more control characters than a damaged line of text has."""
    head = octets[:4096]
    return len(_CONTROLS.findall(head)) > 0.02 * len(head)


def _capture_in(octets: bytes) -> str | None:
    """A network capture with a count of its packets."""
    contents = Contents()
    for _ in _unpacked(iter([octets]), _video_in, contents):
        pass
    return str(contents) if contents.form and not _is_final(octets) else None


def _asterix_in(octets: bytes) -> str | None:
    """The categories of a file of ASTERIX."""
    form = ""
    if _is_final(octets):
        octets, form = octets[_FINAL_HEAD : _u16(octets, 0) - len(_FINAL_END)], " in final format"
    categories, rest = _categories(octets)
    if not categories or (len(rest) == len(octets)) or (rest and sum(categories.values()) < 3):
        return None
    return f"{_category_text(categories)}{form}"


def _category_text(categories: Counter[int]) -> str:
    plural = "categories" if len(categories) > 1 else "category"
    return f"ASTERIX {plural} {', '.join(map(str, sorted(categories)))}"


# ------------------------------------------------------------------ compression


def _decompressed(path: Path, wanted: str | None) -> Iterator[bytes]:
    """The octets of a file in pieces, decompressed by what its first octets say."""
    program = None
    try:
        with path.open("rb") as file:
            pieces = iter(lambda: file.read(_READ), b"")
            first = next(pieces, b"")
            for magic, (name, begin) in _COMPRESSED.items():
                if first.startswith(magic):
                    program, first, pieces = name, b"", _inflated(_chain(first, pieces), begin)
            yield from _chain(first, pieces)
    except (zlib.error, lzma.LZMAError, EOFError) as error:
        raise RecordingError(path, f"damaged by {program} ({error})", wanted=wanted) from error
    except OSError as error:
        reason = f"damaged {program} data" if program and not error.errno else error.strerror
        problem = f"the file cannot be read ({reason})"
        raise RecordingError(path, problem, wanted=wanted) from error


def _chain(first: bytes, pieces: Iterable[bytes]) -> Iterator[bytes]:
    yield first
    yield from pieces


def _inflated(pieces: Iterable[bytes], begin: Callable[[], Any]) -> Iterator[bytes]:
    """Decompressed octets; a file may be cut, or several compressed files one after another."""
    decoder = begin()
    for piece in pieces:
        while piece:
            if decoder.eof:
                decoder, piece = begin(), piece.lstrip(b"\0")  # padding between files
            yield decoder.decompress(piece)
            piece = decoder.unused_data


# ------------------------------------------------------------------ captures and final format


class _Stream:
    """Octets in pieces, taken in any lengths."""

    def __init__(self, pieces: Iterable[bytes]) -> None:
        self._pieces = iter(pieces)
        self._buffer = b""
        self._at = 0

    def peek(self, count: int) -> bytes:
        """The next octets, fewer at the end."""
        while len(self._buffer) - self._at < count:
            piece = next(self._pieces, None)
            if piece is None:
                break
            self._buffer, self._at = self._buffer[self._at :] + piece, 0
        return self._buffer[self._at : self._at + count]

    def take(self, count: int) -> bytes:
        """The next octets, fewer at the end, which are then gone."""
        octets = self.peek(count)
        self._at += len(octets)
        return octets

    def rest(self) -> Iterator[bytes]:
        yield self._buffer[self._at :]
        yield from self._pieces


class _Packet(NamedTuple):
    """A packet of a capture."""

    time_s: float | None
    link: int
    octets: bytes
    whole: bool


class _Payload(NamedTuple):
    """What a datagram or a segment of TCP carries; `flow` is None for a datagram."""

    receiver: str
    octets: bytes
    flow: tuple | None = None
    sequence: int = 0
    begins: bool = False


_Chosen = Callable[[bytes], tuple[bytes, bytes]]


def _unpacked(pieces: Iterable[bytes], chosen: _Chosen, contents: Contents) -> Iterator[bytes]:
    """What is wanted of a container, or the octets of a plain file.

    Of the octets of a datagram, or of a connection until now, `chosen` returns those wanted and the
    rest that may continue.
    """
    stream = _Stream(pieces)
    head = stream.peek(1 << 16)
    packets = _packets_of(stream, contents)
    if packets is not None:
        yield from _payloads(packets, chosen, contents)
    elif _is_final(head):
        contents.form = "ASTERIX final format"
        yield from _final_blocks(stream, contents)
    else:
        yield from stream.rest()


def _payloads(packets: Iterable[_Packet], chosen: _Chosen, contents: Contents) -> Iterator[bytes]:
    fragments, connections = _Fragments(), _Connections()
    rest: dict[tuple, bytes] = {}
    lines = chosen is _sentences_in
    for packet in packets:
        contents.packets += 1
        if not packet.whole:
            contents.cut += 1
            continue
        payload = _payload_of(packet, fragments)
        if payload is None:
            continue
        used = False
        for octets in connections.in_order(payload):
            if payload.flow is None:
                taken, left = chosen(octets + b"\n" if lines else octets)
                taken = b"" if left else taken
            else:
                taken, rest[payload.flow] = chosen(rest.get(payload.flow, b"") + octets)
            if taken:
                used = True
                yield _stamped(taken, packet.time_s) if lines else taken
        contents.used += used
        if payload.octets and not used:
            contents.others[_label(payload)] += 1


def _label(payload: _Payload) -> str:
    categories, rest = _categories(payload.octets)
    if categories and not rest:
        return _category_text(categories)
    return payload.receiver


def _video_in(octets: bytes) -> tuple[bytes, bytes]:
    """Blocks of ASTERIX with category 240 among them, and the rest of an incomplete block."""
    categories, rest = _categories(octets)
    taken = octets[: len(octets) - len(rest)] if 240 in categories else b""
    return taken, rest if taken or octets[:1] == b"\xf0" else b""


def _sentences_in(octets: bytes) -> tuple[bytes, bytes]:
    """Lines of NMEA 0183, and the rest of an incomplete line."""
    end = octets.rfind(b"\n") + 1
    taken = octets[:end] if _SENTENCE.search(octets, 0, end) else b""
    return taken, octets[end:][-_LONGEST_LINE:]


def _stamped(lines: bytes, time_s: float | None) -> bytes:
    """Lines with a TAG block of their time, unless they have one."""
    if time_s is None:
        return lines
    tag = b"c:%d" % round(1e3 * time_s)
    checksum = 0
    for octet in tag:
        checksum ^= octet
    return b"".join(
        line if _TAGGED.match(line) else b"\\%s*%02X\\%s" % (tag, checksum, line)
        for line in lines.removeprefix(b"UdPbC\0").splitlines(keepends=True)
        if line.strip()
    )


def _categories(octets: bytes) -> tuple[Counter[int], bytes]:
    """Blocks of each category, and the octets that make no whole block."""
    found: Counter[int] = Counter()
    at, end = 0, len(octets)
    while at + 3 <= end:
        length = _u16(octets, at + 1)
        if octets[at] == 0 or length < 4 or at + length > end:
            break
        found[octets[at]] += 1
        at += length
    return found, octets[at:]


def _u16(octets: bytes, at: int) -> int:
    return int.from_bytes(octets[at : at + 2], "big")


# ------------------------------------------------------------------ final format


def _is_final(head: bytes) -> bool:
    """Whether blocks have a header and an end, two of them or one that is the file."""
    if len(head) < _FINAL_HEAD + 3:
        return False
    end = _u16(head, 0)
    first = _categories(head[_FINAL_HEAD : end - len(_FINAL_END)])
    return head[end - len(_FINAL_END) : end] == _FINAL_END and bool(first[0]) and not first[1]


def _final_blocks(stream: _Stream, contents: Contents) -> Iterator[bytes]:
    """Blocks without what is around them; from a damaged one on as they are."""
    while head := stream.peek(2):
        record = stream.peek(max(_u16(head, 0), 1))
        if len(record) < _FINAL_HEAD or not record.endswith(_FINAL_END):
            contents.cut += 1
            yield from stream.rest()
            return
        contents.packets += 1
        contents.used += 1
        stream.take(len(record))
        yield record[_FINAL_HEAD : -len(_FINAL_END)]


# ------------------------------------------------------------------ pcap and pcapng


def _packets_of(stream: _Stream, contents: Contents) -> Iterator[_Packet] | None:
    """The packets of a capture, None if it is not one."""
    magic = stream.peek(4)
    for order in (">", "<"):
        tick_s = _CAPTURES.get(magic if order == ">" else magic[::-1])
        if tick_s is not None:
            contents.form = "a network capture (pcap)"
            return _pcap(stream, order, tick_s)
    if magic == _SECTION:
        contents.form = "a network capture (pcapng)"
        return _pcapng(stream)
    return None


def _pcap(stream: _Stream, order: str, tick_s: float) -> Iterator[_Packet]:
    head = stream.take(24)
    modified = head[:4] in (b"\xa1\xb2\xcd\x34", b"\x34\xcd\xb2\xa1")
    link = struct.unpack(f"{order}I", head[20:])[0] & 0x0FFFFFFF if len(head) == 24 else 0
    while len(record := stream.take(24 if modified else 16)) >= 16:
        second, tick, kept, sent = struct.unpack(f"{order}4I", record[:16])
        if kept > _LARGEST_PACKET:
            return
        octets = stream.take(kept)
        yield _Packet(second + tick * tick_s, link, octets, len(octets) >= sent)


def _pcapng(stream: _Stream) -> Iterator[_Packet]:
    order, links = "<", []
    while len(head := stream.peek(12)) == 12:
        if head[:4] == _SECTION:
            order, links = ("<" if head[8:] == b"\x4d\x3c\x2b\x1a" else ">"), []
        kind, length = struct.unpack(f"{order}2I", head[:8])
        if length < 12:
            return
        body = stream.take(length)[8:-4]
        if kind == 1:
            links.append((struct.unpack(f"{order}H", body[:2])[0], *_clock(body[8:], order)))
        elif kind in (2, 6) and len(body) >= 20:
            number, high, low, kept, sent = struct.unpack(
                f"{order}{'I' if kind == 6 else 'H2x'}4I", body[:20]
            )
            if number < len(links):
                link, tick_s, offset_s = links[number]
                time_s = offset_s + ((high << 32) + low) * tick_s
                octets = body[20 : 20 + kept]
                yield _Packet(time_s, link, octets, len(octets) >= sent)
        elif kind == 3 and links and len(body) >= 4:
            sent = struct.unpack(f"{order}I", body[:4])[0]
            octets = body[4 : 4 + sent]
            yield _Packet(None, links[0][0], octets, len(octets) >= sent)


def _clock(options: bytes, order: str) -> tuple[float, int]:
    """Seconds of a tick, and of the start, from the options of an interface."""
    tick_s, offset_s = 1e-6, 0
    while len(options) >= 4:
        code, length = struct.unpack(f"{order}2H", options[:4])
        value = options[4 : 4 + length]
        if code == 9 and value:
            tick_s = 2.0 ** -(value[0] & 127) if value[0] & 128 else 10.0 ** -value[0]
        elif code == 14 and len(value) == 8:
            offset_s = struct.unpack(f"{order}q", value)[0]
        options = options[4 + (length + 3) // 4 * 4 :]
    return tick_s, offset_s


# ------------------------------------------------------------------ IP, UDP and TCP


def _payload_of(packet: _Packet, fragments: _Fragments) -> _Payload | None:
    """What a packet carries over UDP or TCP; None for others and for fragments until the last."""
    network = _network_of(packet.link, packet.octets)
    parts = _ip(network, fragments) if network else None
    if parts is None:
        return None
    protocol, source, receiver, octets = parts
    if len(octets) < 8 or protocol not in (_TCP, _UDP):
        return None
    from_port, to_port = struct.unpack(">2H", octets[:4])
    to = f"to {ipaddress.ip_address(receiver)} port {to_port}"
    if protocol == _UDP:
        length = _u16(octets, 4) or len(octets)
        return _Payload(f"UDP {to}", octets[8:length])
    if len(octets) < 20:
        return None
    sequence = int.from_bytes(octets[4:8], "big")
    flow = (source, from_port, receiver, to_port)
    payload = octets[4 * (octets[12] >> 4) :]
    return _Payload(f"TCP {to}", payload, flow, sequence, bool(octets[13] & 2))


def _network_of(link: int, octets: bytes) -> bytes | None:
    """The IP packet of a frame."""
    if link in _BARE_LINKS:
        return octets[_BARE_LINKS[link] :]
    if link not in _LINK_OCTETS:
        return None
    head, at = _LINK_OCTETS[link]
    kind = _u16(octets, at)
    while kind in _VLANS:
        kind, head = _u16(octets, head + 2), head + 4
    return octets[head:] if kind in (_IPV4, _IPV6) else None


def _ip(octets: bytes, fragments: _Fragments) -> tuple[int, bytes, bytes, bytes] | None:
    """Protocol, sender, receiver and content of an IP packet."""
    if octets[0] >> 4 == 4 and len(octets) >= 20:
        total = _u16(octets, 2) or len(octets)
        place = _u16(octets, 6)
        addresses = octets[12:16], octets[16:20]
        content = octets[4 * (octets[0] & 15) : total]
        key = (*addresses, octets[4:6], octets[9])
        whole = fragments.joined(key, 8 * (place & 0x1FFF), bool(place & 0x2000), content)
        return None if whole is None else (octets[9], *addresses, whole)
    if octets[0] >> 4 != 6 or len(octets) < 40:
        return None
    protocol, addresses = octets[6], (octets[8:24], octets[24:40])
    content = octets[40 : 40 + (_u16(octets, 4) or len(octets))]
    while protocol in _EXTENSIONS and len(content) >= 8:
        protocol, content = content[0], content[8 * (1 + content[1]) :]
    if protocol == _FRAGMENT and len(content) >= 8:
        protocol, place, key = content[0], _u16(content, 2), (*addresses, content[4:8])
        content = fragments.joined(key, place & 0xFFF8, bool(place & 1), content[8:])
    return None if content is None else (protocol, *addresses, content)


class _Fragments:
    """Parts of IP packets until they are whole."""

    def __init__(self) -> None:
        self._parts: dict[tuple, dict[int, bytes]] = {}
        self._ends: dict[tuple, int] = {}

    def joined(self, key: tuple, at: int, more: bool, octets: bytes) -> bytes | None:
        """The whole content, None until its last part is there."""
        if at == 0 and not more:
            return octets
        parts = self._parts.setdefault(key, {})
        parts[at] = octets
        if not more:
            self._ends[key] = at + len(octets)
        whole = b""
        while len(whole) in parts and parts[len(whole)]:
            whole += parts[len(whole)]
        if self._ends.get(key) == len(whole):
            del self._parts[key], self._ends[key]
            return whole
        if len(self._parts) > _MOST_FRAGMENTS:
            oldest = next(iter(self._parts))
            del self._parts[oldest]
            self._ends.pop(oldest, None)
        return None


class _Connections:
    """Segments of TCP in order, each octet once."""

    def __init__(self) -> None:
        self._next: dict[tuple, int] = {}
        self._ahead: dict[tuple, dict[int, bytes]] = {}

    def in_order(self, payload: _Payload) -> Iterator[bytes]:
        """The octets that continue; those of a datagram at once."""
        flow, octets = payload.flow, payload.octets
        if flow is None:
            yield octets
            return
        if payload.begins:
            self._next[flow] = payload.sequence + 1
            self._ahead.pop(flow, None)
        if not octets:
            return
        ahead = self._ahead.setdefault(flow, {})
        ahead[payload.sequence] = octets
        if len(ahead) > _MOST_AHEAD:  # what is missing was not recorded
            self._skip(flow)
        yield from self._ready(flow)

    def rest(self) -> Iterator[tuple[tuple, bytes]]:
        """Flows, and their octets after what is missing at the end of a capture."""
        for flow, ahead in self._ahead.items():
            while ahead:
                self._skip(flow)
                for octets in self._ready(flow):
                    yield flow, octets

    def _skip(self, flow: tuple) -> None:
        ahead = self._ahead[flow]
        self._next[flow] = min(ahead, key=lambda sequence: self._after(flow, sequence))

    def _ready(self, flow: tuple) -> Iterator[bytes]:
        ahead = self._ahead[flow]
        while True:
            ready = [sequence for sequence in ahead if self._after(flow, sequence) <= 0]
            if not ready:
                return
            for sequence in ready:
                known, octets = -self._after(flow, sequence), ahead.pop(sequence)
                if known < len(octets):
                    self._next[flow] = sequence + len(octets)
                    yield octets[known:]

    def _after(self, flow: tuple, sequence: int) -> int:
        """Octets from the next expected to a segment, negative where it repeats."""
        half = 1 << 31
        return (sequence - self._next.setdefault(flow, sequence) + half) % (2 * half) - half
