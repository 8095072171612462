"""Identifies files that are neither text nor radar video."""

from __future__ import annotations

_PACKED = {
    b"\x1f\x8b": "gzip",
    b"PK\x03\x04": "zip",
    b"BZh91AY&SY": "bzip2",
    b"\xfd7zX": "xz",
    b"(\xb5/": "zstd",
}
_UTF_16_MARKS = (b"\xff\xfe", b"\xfe\xff")


def instead_of_text(octets: bytes) -> str | None:
    """What a file is by its octets, and what to do; None if it may be text."""
    if octets.startswith(_UTF_16_MARKS) or b"\0\0" in (octets[0:4:2], octets[1:4:2]):
        return "text in UTF-16, save it as UTF-8 first"
    return packed(octets)


def packed(octets: bytes) -> str | None:
    """The compression of a file by its octets, and what to do; None if uncompressed."""
    for magic, program in _PACKED.items():
        if octets.startswith(magic):
            return f"a file compressed by {program}, decompress it first"
    return None
