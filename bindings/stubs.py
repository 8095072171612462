"""Writes the stubs of a built engine: ``python stubs.py MODULES_FOLDER STUBS_FOLDER``.

A step of the build. What pybind11-stubgen finds out is put into the words of the documentation:
arrays are `ArrayLike`, numbers `float` and `int`; sensors, estimators and parameters have their
types.
"""

import importlib
import re
import sys
import tempfile
from pathlib import Path
from types import ModuleType

import pybind11_stubgen

SENSOR = (
    "RangeBearing | ConvertedRangeBearing | RangeBearingDoppler | Position"
    " | Bearing | Range | CustomSensor"
)
ESTIMATOR = (
    "Imm | AdaptiveGridImm | SwitchingGridImm | LikelyModelSetImm | ModeHistory"
    " | FuzzyAlphaBeta | BayesianAlphaBeta"
)
NOISE = "ProcessNoise | WhiteAcceleration | PiecewiseAcceleration | WhiteJerk"
WORDS = [
    (r"typing\.SupportsFloat \| typing\.SupportsIndex", "float"),
    (r"typing\.SupportsInt \| typing\.SupportsIndex", "int"),
    (r"typing\.Annotated\[numpy\.typing\.ArrayLike, [\w.]+\]", "ArrayLike"),
    (r"numpy\.typing\.NDArray\[numpy\.(\w+)\]", r"NDArray[np.\1]"),
    (r"\bsensor: typing\.Any", f"sensor: {SENSOR}"),
    (r"\bestimator: typing\.Any", f"estimator: {ESTIMATOR} | None"),
    (r"\bnoise: ProcessNoise\b", f"noise: {NOISE}"),
    (r"\bstart: typing\.Any", "start: Gaussian | Sequence[Gaussian]"),
    (r"\bdt_s: typing\.Any", "dt_s: ArrayLike"),
    (r"\b(own_\w+|bearing_rad): (typing\.Any|ArrayLike) = 0\.0", r"\1: ArrayLike = 0.0"),
    (r"\bplot_time_s: typing\.Any", "plot_time_s: ArrayLike | None"),
    (r"\bestimate_time_s: typing\.Any", "estimate_time_s: ArrayLike"),
    (r"\b(turn_rate_rad_s|age_s): typing\.Any = None", r"\1: ArrayLike | None = None"),
    (r"(def numbers\(self\)) -> dict:", r"\1 -> dict[int, int]:"),
    (r"NDArray\[np\.bool\]", "NDArray[np.bool_]"),
    (r"\bvideo: typing\.Any", "video: RadarVideo"),
    (r"(def strobe_echo\(video: RadarVideo)", r"\1 | ScanImage"),
    (r"\bamplitude: typing\.Any", "amplitude: NDArray[np.uint8] | NDArray[np.uint16]"),
    (
        r"(def (?:amplitude\(self|cfar_threshold\(.*)\)) -> numpy\.ndarray",
        r"\1 -> NDArray[np.uint8] | NDArray[np.uint16]",
    ),
    (r"filters: collections\.abc\.Sequence", "filters: Sequence[Filter]"),
    (r"collections\.abc\.(Callable|Mapping|Sequence)\b", r"\1"),
    (r"\bplots: typing\.Any", "plots: VideoPlots"),
    (
        r"(def (?:mode_probability|turn_rate_rad_s)\(self\)) -> typing\.Any",
        r"\1 -> NDArray[np.float64] | None",
    ),
    (r"-> typing\.Any:", "-> NDArray[np.float64]:"),
    (r"(def conversion_bias_matters\(.*\)) -> NDArray\[np\.float64\]", r"\1 -> NDArray[np.bool_]"),
    (r"(def smooth\(.*\)) -> tuple:", r"\1 -> tuple[NDArray[np.float64], NDArray[np.float64]]:"),
    (r"(def fields\(\)) -> tuple:", r"\1 -> tuple[tuple[str, type, object, str, str, str], ...]:"),
    (r"    def _arguments\(self\) -> tuple:\n        (?:\.\.\.|\"\"\"(?:.|\n)*?\"\"\")\n", ""),
    (r"-> tuple:", "-> tuple[float, float]:"),
    (r"-> list:", "-> list[str]:"),
    (r"-> dict:", "-> dict[str, typing.Any]:"),
    (r"def __eq__\(self, \w+: typing\.Any\)", "def __eq__(self, other: object)"),
    (r"def __ne__\(self, \w+: typing\.Any\)", "def __ne__(self, other: object)"),
    (r"\barg0: (WhiteAcceleration|PiecewiseAcceleration|WhiteJerk)", r"policy: \1, /"),
    (r"wakeline\._engine\.\w+\.", ""),
    (r"(__hash__: typing\.ClassVar\[None\]) = None", r"\1  # type: ignore[assignment]"),
    (r"    @classmethod\n    def __new__\(cls, value\):\n        \.\.\.\n", ""),
    (r"    def __format__\(self, format_spec\):\n        \.\.\.\n", ""),
    (r"    def __reduce_ex__\(.*\) -> .*:\n        \.\.\.\n", ""),
    (r"    def __(repr|str)__\(self\) -> str:\n        \.\.\.\n", ""),
]
# A property that can be set is an attribute.
ATTRIBUTE = re.compile(
    r"    @property\n    def (\w+)\(self\) -> ([^\n]+):\n((?:        [^\n]*\n|\n)*)"
    r"    @\1\.setter\n    def \1\(self, [^\n]*\) -> None:\n        \.\.\.\n"
)
HOMES = {
    "core": ["Gaussian", "Status", "Step"],
    "navigation": ["LocalPlane"],
    "measurement": [
        "Bearing",
        "ConvertedRangeBearing",
        "CustomSensor",
        "OwnShip",
        "Position",
        "Range",
        "RangeBearing",
        "RangeBearingDoppler",
    ],
    "filter": ["Estimator", "Filter", "RunResult"],
    "gating": ["ChiSquareGate", "RadiusGate"],
    "video": ["ScanImage", "VideoPlots"],
    "motion": [
        "ConstantAcceleration",
        "ConstantVelocity",
        "CoordinatedTurn",
        "CoordinatedTurnRate",
        "CustomMotion",
        "PiecewiseAcceleration",
        "ProcessNoise",
        "Singer",
        "WanderingCourse",
        "WhiteAcceleration",
        "WhiteJerk",
    ],
    "multimodel": [
        "AdaptiveGridImm",
        "BayesianAlphaBeta",
        "FuzzyAlphaBeta",
        "Imm",
        "LikelyModelSetImm",
        "ModeHistory",
        "SwitchingGridImm",
    ],
}


def as_attribute(match: re.Match) -> str:
    name, kind, body = match.groups()
    told = re.sub(r"^    ", "", body, flags=re.MULTILINE) if '"""' in body else ""
    return f"    {name}: {kind}\n{told}"


def imports(noun: str, text: str) -> str:
    """The imports that the stub of a noun needs."""
    lines = []
    code = re.sub(r'""".*?"""', "", text, flags=re.DOTALL)
    generic = [
        name for name in ("Callable", "Mapping", "Sequence") if re.search(rf"\b{name}\b", code)
    ]
    if generic:
        lines.append(f"from collections.abc import {', '.join(generic)}")
    if "enum." in text:
        lines.append("import enum")
    if "typing." in text:
        lines.append("import typing")
    if "np." in text:
        lines.append("import numpy as np")
    arrays = [name for name in ("ArrayLike", "NDArray") if re.search(rf"\b{name}\b", text)]
    if arrays:
        lines.append(f"from numpy.typing import {', '.join(arrays)}")
    if re.search(r"\bRadarVideo\b", code):
        lines.append("from ..recording.video import RadarVideo")
    for home, names in HOMES.items():
        used = [name for name in names if re.search(rf"\b{name}\b", code)]
        if home != noun and used:
            lines.append(f"from .{home} import {', '.join(used)}")
    return "\n".join(lines)


def tidy(noun: str, text: str) -> str:
    """The stub of a noun in our words."""
    for pattern, word in WORDS:
        text = re.sub(pattern, word, text)
    text = re.sub(r"^(import|from) [^\n]*\n", "", text, flags=re.MULTILINE)
    text = re.sub(r"^__all__: list\[str\]", "__all__", text, flags=re.MULTILINE)
    text = ATTRIBUTE.sub(as_attribute, text)
    end = text.index('"""', 3) + 4
    return text[:end] + imports(noun, text[end:]) + "\n" + text[end:]


def engine_in(folder: Path) -> ModuleType:
    """The engine of a build, without the package around it."""
    package = ModuleType("wakeline")
    package.__path__ = [str(folder)]
    sys.modules["wakeline"] = package
    return importlib.import_module("wakeline._engine")


def main() -> None:
    modules, stubs = map(Path, sys.argv[1:])
    engine = engine_in(modules)
    stubs.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        pybind11_stubgen.main(["wakeline._engine", "-o", folder])
        for path in Path(folder).rglob("*.pyi"):
            text = path.read_text(encoding="utf-8")
            if path.stem == "__init__":
                nouns = sorted(re.findall(r"^from \. import (\w+)", text, flags=re.MULTILINE))
                text = f'"""{engine.__doc__}"""\n\nfrom . import {", ".join(nouns)}\n'
                text += f"\n__all__ = {nouns}\n"
            else:
                text = tidy(path.stem, text)
            (stubs / path.name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
