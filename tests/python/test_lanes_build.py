"""`WAKELINE_LANES=all`: a module for each instruction set, each compiled for its own processor."""

import json
import platform
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LANES = {"_lanes": 2, "_lanes_avx2": 4, "_lanes_avx512": 8}
KERNEL = """
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/simd/pack_math.hpp"
using namespace wakeline;
static_assert(kNativeLanes<double> == {lanes});
using Lanes = Pack<double, kNativeLanes<double>>;
bool step(Ekf<CoordinatedTurn, Lanes>& filter, const Vec<Lanes, 2>& z) {{
  return all(ok(filter.predict(Lanes(3.0)))) && all(ok(filter.update(RangeBearing{{}}, z).status));
}}
"""

pytestmark = pytest.mark.skipif(
    shutil.which("cmake") is None or platform.machine() not in ("x86_64", "AMD64"),
    reason="needs CMake and a processor of the x86-64 family",
)


def configure(build, lanes):
    definitions = {
        "WAKELINE_PYTHON": "ON",
        "WAKELINE_TESTS": "OFF",
        "WAKELINE_EXAMPLES": "OFF",
        "WAKELINE_LANES": lanes,
        "CMAKE_CXX_COMPILER_LAUNCHER": "",
        "CMAKE_EXPORT_COMPILE_COMMANDS": "ON",
        "Python_EXECUTABLE": sys.executable,
    }
    command = ["cmake", "-S", ROOT, "-B", build, *(f"-D{k}={v}" for k, v in definitions.items())]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def commands(tmp_path_factory):
    """By module, the command that compiles a unit of it."""
    build = tmp_path_factory.mktemp("all")
    done = configure(build, "all")
    assert done.returncode == 0, done.stderr
    found = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        if module := re.search(r"-DWAKELINE_LANES_MODULE=(\w+)", entry["command"]):
            found[module[1]] = shlex.split(entry["command"])
    return found


def test_there_is_a_module_for_each_instruction_set(commands):
    assert set(commands) == set(LANES)


@pytest.mark.parametrize("module", LANES)
def test_a_module_is_compiled_for_the_lanes_of_its_instruction_set(commands, module, tmp_path):
    unit = tmp_path / "step.cpp"
    unit.write_text(KERNEL.format(lanes=LANES[module]))
    command = commands[module]
    command = command[: command.index("-o")]
    done = subprocess.run(
        [*command, "-O0", "-c", unit, "-o", tmp_path / "step.o"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr


def test_other_values_are_rejected(tmp_path):
    done = configure(tmp_path, "some")
    assert done.returncode != 0
    assert "WAKELINE_LANES must be all or native, got some" in " ".join(done.stderr.split())
