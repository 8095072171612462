"""Other people's decoders, each in a separate environment: two of them install a module of the
same name."""

import fcntl
import json
import shutil
import struct
import subprocess
import sys
import venv
from functools import cache
from pathlib import Path

import pytest

ENVIRONMENTS = Path(__file__).resolve().parents[2] / "build" / "judges"

ASTERIX_DECODER = """
import asterix, json, sys
def plain(item):
    if not isinstance(item, dict):
        return item
    return item["val"] if "val" in item else {key: plain(one) for key, one in item.items()}
blocks = [bytes.fromhex(line) for line in sys.stdin]
print(json.dumps([[plain(r) for r in asterix.parse(b, verbose=False)] for b in blocks]))
"""

AVICONV = """
import aviconv_asterix, json, sys
blocks = [bytes.fromhex(line) for line in sys.stdin]
print(json.dumps([[json.loads(r.model_dump_json(exclude_none=True))
                   for r in aviconv_asterix.iter_records(b)] for b in blocks]))
"""


@cache
def why_missing(package):
    """Makes an environment with this package; "" or why that cannot be done."""
    folder = ENVIRONMENTS / package
    done = folder / "installed"
    ENVIRONMENTS.mkdir(parents=True, exist_ok=True)
    with (ENVIRONMENTS / f"{package}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # other processes of these tests wait
        if done.exists():
            return ""
        shutil.rmtree(folder, ignore_errors=True)
        venv.create(folder, with_pip=True)
        install = [folder / "bin" / "python", "-m", "pip", "install", "-q", package]
        said = subprocess.run(install, capture_output=True, text=True, timeout=300, check=False)
        if said.returncode == 0:
            done.touch()
        return "" if said.returncode == 0 else said.stderr.strip()[-200:] or "pip failed"


def records_by(package, program, datagrams):
    """What a package of the index makes of datagrams: a list of records for each."""
    lines = "\n".join(datagram.hex() for datagram in datagrams)
    if why := why_missing(package):
        pytest.skip(f"{package} cannot be installed: {why}")
    python = ENVIRONMENTS / package / "bin" / "python"
    said = subprocess.run(
        [python, "-c", program],
        input=lines,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert said.returncode == 0, said.stderr
    return json.loads(said.stdout)


def by_asterix_decoder(datagrams):
    return records_by("asterix_decoder", ASTERIX_DECODER, datagrams)


def by_aviconv(datagrams):
    return records_by("aviconv-asterix", AVICONV, datagrams)


def capture(path, datagrams, port):
    """A capture of UDP datagrams on the loopback, one a second."""
    octets = struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, 101)
    loopback = bytes([127, 0, 0, 1])
    for k, datagram in enumerate(datagrams):
        udp = struct.pack(">HHHH", port, port, 8 + len(datagram), 0) + datagram
        head = struct.pack(">BBHHHBBH", 0x45, 0, 20 + len(udp), 0, 0, 64, 17, 0)
        packet = head + loopback + loopback + udp
        octets += struct.pack("<IIII", k, 0, len(packet), len(packet)) + packet
    path.write_bytes(octets)
    return path


def by_tshark(path, datagrams, port=8600):
    """The records that Wireshark sees, as dicts of texts without their prefixes."""
    if shutil.which("tshark") is None:
        pytest.skip("tshark is not installed")
    capture(path, datagrams, port)
    command = ["tshark", "-r", str(path), "-d", f"udp.port=={port},asterix", "-T", "json"]
    said = subprocess.run(
        [*command, "--no-duplicate-keys"], capture_output=True, text=True, timeout=120, check=False
    )
    assert said.returncode == 0, said.stderr
    packets = json.loads(said.stdout)
    blocks = [packet["_source"]["layers"]["asterix"] for packet in packets]
    listed = [block["asterix.message"] for block in blocks]
    return [one if isinstance(one, list) else [one] for one in listed]


if __name__ == "__main__":  # installs them
    for name in sys.argv[1:]:
        print(why_missing(name) or f"{name} is installed")
