"""What a file is that should be text, or radar video, and is not."""

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
    """What the octets of a file show it to be, with what to do; None where they may be text."""
    if octets.startswith(_UTF_16_MARKS) or b"\0\0" in (octets[0:4:2], octets[1:4:2]):
        return "text in UTF-16, save it as UTF-8 first"
    return packed(octets)


def packed(octets: bytes) -> str | None:
    """That the octets of a file show it to be packed, with what to do; None where they do not."""
    for magic, program in _PACKED.items():
        if octets.startswith(magic):
            return f"a file packed by {program}, unpack it first"
    return None
