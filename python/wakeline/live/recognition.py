"""The format of what a source sends, by its octets."""

from __future__ import annotations

import re

from .asterix_feed import CATEGORIES, VIDEO, are_blocks, chain_in

# A sentence of NMEA 0183 to its checksum or line end, and a line that is one JSON object.
_SENTENCE = re.compile(rb'[$!][A-Z][A-Z0-9]{2,}[,*][ "#%-~]*?(?:\*[0-9A-Fa-f]{2}|[\r\n])')
_OBJECT = re.compile(rb'(?:^|[\r\n])[ \t]*\{[ \t]*"[^\r\n]*\}[ \t]*[\r\n]')
_HEADS = {b"$": "nmea", b"!": "nmea", b"\\": "nmea", b"{": "json"}


def format_of_datagram(octets: bytes) -> str:
    """The format of a whole message; empty if it is unknown."""
    if octets.startswith(b"UdPbC"):
        return "nmea"
    head = _HEADS.get(octets[:64].lstrip()[:1], "")
    return head or format_in_stream(octets) or _category(octets[:1])


def format_in_stream(octets: bytes) -> str:
    """The format of octets that may begin and end anywhere; empty until it is sure."""
    texts = ("nmea", _SENTENCE.search(octets)), ("json", _OBJECT.search(octets))
    found = [(match.start(), kind) for kind, match in texts if match is not None]
    if found:
        return min(found)[1]
    begin = 0 if are_blocks(octets) else chain_in(octets)
    return "" if begin is None else _category(octets[begin : begin + 1])


def _category(octet: bytes) -> str:
    if octet and octet[0] == VIDEO:
        return "cat240"
    return "cat048" if octet and octet[0] in CATEGORIES else ""
