"""The reference of C++: what Doxygen reads in the headers, a page for each noun.

A public class, concept or function without a comment is a warning, and warnings are errors where
the site is built; those that have none today are listed. Fields of a parameter struct have the
words of its field table, which Python's docstrings have too.
"""

from __future__ import annotations

import hashlib
import inspect
import logging
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import wakeline as wl

log = logging.getLogger("mkdocs.plugins.wakeline")
ROOT = Path(__file__).parents[3]
HEADERS = ROOT / "cpp/include/wakeline"
CACHE = ROOT / "build/site-cache"
# In the order of CONTRIBUTING.md: a noun uses only those before it.
NOUNS = {
    "core": "beliefs, status, angles, the checked Cholesky factor, field tables",
    "simd": "packs: several numbers in one register as a scalar",
    "motion": "motion models and process noise",
    "measurement": "sensors and own ship",
    "filter": "Kalman, extended and unscented filters, alpha-beta filters, starts and smoothers",
    "multimodel": "estimators with several models",
    "gating": "gates and strobes",
    "association": "which plot is whose",
    "video": "plots from radar video; ASTERIX category 240",
    "track": "the tracker and its stages, strobe tracker, calibration, late data",
    "navigation": "geodesy, dead reckoning, drift, search, close passings, own ship",
    "wire": "ASTERIX and NMEA 0183",
    "catalog": "models chosen at run time",
    "batch": "many recordings in lanes and on threads",
    "eval": "NEES, NIS, GOSPA, the Cramér-Rao bound",
}
_SETTINGS = {
    "INPUT": HEADERS,
    "RECURSIVE": "YES",
    "FILE_PATTERNS": "*.hpp",
    "STRIP_FROM_PATH": ROOT / "cpp/include",
    "GENERATE_HTML": "NO",
    "GENERATE_LATEX": "NO",
    "GENERATE_XML": "YES",
    "XML_PROGRAMLISTING": "NO",
    "EXTRACT_ALL": "YES",
    "JAVADOC_AUTOBRIEF": "YES",
    "ENABLE_PREPROCESSING": "YES",
    "MACRO_EXPANSION": "YES",
    "PREDEFINED": "WAKELINE_FLATTEN=",
    "INCLUDE_GRAPH": "NO",
    "INCLUDED_BY_GRAPH": "NO",
    "QUIET": "YES",
    "WARN_LOGFILE": "/dev/null",
}
_KINDS = {"function", "variable", "typedef", "enum"}
_OPERATOR = re.compile(r"^operator\W")
# Names whose comment is missing in the headers; a test makes sure that the list only gets shorter.
WITHOUT_COMMENT = {
    *("keep_lower", "complete", "zero_like", "add_mean", "add_spread", "set_turn_rate"),
    *("smooth_pair", "IsLinear", "StateLayouts", "rows_of", "states_of", "at_least", "field"),
    *("require_not_negative", "require_positive", "require_finite", "require_probability"),
    *("ok", "lane", "first_failure_of_lanes", "assign_where", "scatter_lanes", "Gospa::Options"),
    *("check_sensor", "words_of", "MotionModel", "reject_pattern", "memory_of", "recall"),
    *("ModeHistory::Hypotheses::Iterator", "EncounterChange", "shuffled", "sin", "cos", "atan"),
    *("inverse_sqrt", "least_of_lanes", "greatest_of_lanes", "sum_to", "least_to", "any", "none"),
    *("InputLog::Entry", "TrackEvent", "to_string", "CfarSettings", "PlotExtractorSettings"),
    *("rejected", "asterix::signed_steps", "asterix::unsigned_steps", "asterix::cat010::Item"),
    *("asterix::cat034::Item", "asterix::cat048::Item", "asterix::cat062::Item"),
    *("AsterixEvent", "AsterixFault", "TtmFeed::Config"),
}
_PUBLIC = re.compile(r"wakeline(::asterix(::cat\d+)?)?")


@dataclass
class Entity:
    """A class, concept, function, constant or type as Doxygen has read it."""

    name: str
    kind: str
    header: str
    line: int
    code: str
    about: str
    members: list[Entity] = field(default_factory=list)

    @property
    def noun(self) -> str:
        return self.header.split("/")[1] if self.header.count("/") > 1 else ""


def pages() -> Iterator[tuple[str, str]]:
    """Name and text of each page."""
    lines = [
        "# C++\n\nAll names are in namespace `wakeline`.\n",
        "[Concepts](../concepts.md) has what a model, sensor or filter must have.\n",
        "| folder | |\n|---|---|",
        *(f"| [`wakeline/{noun}/`]({noun}.md) | {about} |" for noun, about in NOUNS.items()),
    ]
    yield "index", "\n".join(lines) + "\n"
    everything = entities()
    for one in without_comment(everything):
        if one.name not in WITHOUT_COMMENT:
            log.warning("%s:%d: %s has no comment", one.header, one.line, one.name)
    for noun in NOUNS:
        mine = [one for one in everything if one.noun == noun]
        yield noun, "\n".join(_page(noun, mine)) + "\n"


def entities() -> list[Entity]:
    """All public entities, in the order of headers and lines."""
    found = sorted(_read(_xml()), key=lambda one: (one.header, one.line))
    classes = {one.name for one in found if one.kind in ("class", "struct")}
    return [one for one in found if one.kind != "function" or one.name not in classes]


@cache
def _xml() -> Path:
    """The folder of what Doxygen writes, kept under a hash of the headers."""
    digest = hashlib.sha256(repr(_SETTINGS).encode())
    for header in sorted(HEADERS.rglob("*.hpp")):
        digest.update(header.read_bytes())
    folder = CACHE / f"doxygen-{digest.hexdigest()[:24]}"
    if not folder.is_dir():
        CACHE.mkdir(parents=True, exist_ok=True)
        for old in CACHE.glob("doxygen-*"):
            shutil.rmtree(old, ignore_errors=True)
        with tempfile.TemporaryDirectory(dir=CACHE) as fresh:
            settings = _SETTINGS | {"OUTPUT_DIRECTORY": fresh}
            text = "".join(f'{key} = "{value}"\n' for key, value in settings.items())
            subprocess.run(["doxygen", "-"], input=text, text=True, check=True)
            shutil.copytree(Path(fresh, "xml"), folder)
    return folder


def _read(folder: Path) -> Iterator[Entity]:
    for file in folder.glob("*.xml"):
        if file.name.startswith(("class", "struct", "concept", "namespace")):
            compound = ElementTree.parse(file).getroot().find("compounddef")
            if compound is not None and "detail" not in compound.findtext("compoundname", ""):
                yield from _compound(compound)


def _compound(compound: Element) -> Iterator[Entity]:
    kind, full = compound.get("kind", ""), compound.findtext("compoundname", "")
    members = [
        _member(one)
        for one in compound.iter("memberdef")
        if one.get("kind") in _KINDS and one.get("prot") == "public"
    ]
    if kind == "namespace":
        if not _PUBLIC.fullmatch(full):
            return
        prefix = full.removeprefix("wakeline").removeprefix("::")
        for member in members:
            member.name = f"{prefix}::{member.name}" if prefix else member.name
            if not _OPERATOR.match(member.name):
                yield member
        return
    if compound.get("prot", "public") != "public" or "<" in full:
        return  # a private class, or a specialization
    name = full.removeprefix("wakeline::")
    header, line = _place(compound)
    if kind == "concept":
        code = _text(compound.find("initializer"))
    else:
        code = f"{_template(compound)}{kind} {name.rpartition('::')[2]}"
    members = [] if kind == "concept" else members
    yield Entity(name, kind, header, line, code, _about(compound), members)


def _member(member: Element) -> Entity:
    kind, name = member.get("kind", ""), member.findtext("name", "")
    if kind == "enum":
        values = [_enumerator(one) for one in member.iter("enumvalue")]
        scoped = "enum class" if member.get("strong") == "yes" else "enum"
        code = f"{scoped} {name} {{\n" + "".join(values) + "}"
    elif kind == "typedef":
        code = _template(member) + _tidy(member.findtext("definition", ""))
    else:
        static = "static " if member.get("static") == "yes" and kind != "function" else ""
        value = _text(member.find("initializer")) if kind == "variable" else ""
        value = f" {value}" if value and len(value) < 60 and "\n" not in value else ""
        arguments = member.findtext("argsstring", "") if kind == "function" else ""
        code = f"{_template(member)}{static}{_text(member.find('type'))} {name}{arguments}{value}"
    header, line = _place(member)
    return Entity(name, kind, header, line, _tidy(code), _about(member))


def _enumerator(value: Element) -> str:
    about = " ".join(_about(value).split())
    return f"  {value.findtext('name')},{f'  // {about}' if about else ''}\n"


def _place(element: Element) -> tuple[str, int]:
    location = element.find("location")
    if location is None:
        return "", 0
    header = location.get("declfile") or location.get("file", "")
    return header, int(location.get("line", 0))


def _template(element: Element) -> str:
    found = element.find("templateparamlist")
    if found is None:
        return ""
    params = []
    for param in found.findall("param"):
        name, default = param.findtext("declname", ""), _text(param.find("defval"))
        text = " ".join(filter(None, [_text(param.find("type")), name]))
        params.append(f"{text} = {default}" if default else text)
    return f"template <{', '.join(params)}>\n"


def _text(element: Element | None) -> str:
    return "" if element is None else "".join(element.itertext()).strip()


def _tidy(code: str) -> str:
    code = code.replace("wakeline::", "").replace("< ", "<").replace(" >", ">")
    code = re.sub(r" (&+|\*+)", r"\1", code).replace("noexcept override", "noexcept")
    return re.sub(r"[ \t]+", " ", code) if "\n  " not in code else code


def _about(element: Element) -> str:
    parts = [
        _markdown(para)
        for name in ("briefdescription", "detaileddescription", "inbodydescription")
        for para in element.findall(f"{name}/*")
    ]
    return "\n\n".join(filter(None, parts))


def _markdown(element: Element) -> str:
    """A piece of Doxygen's XML as Markdown."""
    inner = (element.text or "").replace("<", "&lt;").replace("*", r"\*")
    for child in element:
        inner += _markdown(child) + (child.tail or "").replace("<", "&lt;").replace("*", r"\*")
    match element.tag:
        case "computeroutput":
            return f"`{_text(element)}`"
        case "verbatim" | "programlisting" | "preformatted":
            lines = [_code_line(one) for one in element.iter("codeline")] or [element.text or ""]
            return "\n\n```cpp\n" + "\n".join(lines).strip("\n") + "\n```\n\n"
        case "itemizedlist" | "orderedlist":
            return "\n\n" + "\n".join(f"- {_markdown(one).strip()}" for one in element) + "\n\n"
        case "bold":
            return f"**{inner}**"
        case "emphasis":
            return f"*{inner}*"
        case "ndash":
            return "-"
        case "nonbreakablespace":
            return " "
        case "para" | "listitem":
            return inner.strip()
        case _:
            return inner


def _code_line(line: Element) -> str:
    for space in line.iter("sp"):
        space.text = " "
    return "".join(line.itertext())


def without_comment(everything: list[Entity]) -> list[Entity]:
    """Classes, concepts, types with names and functions of which no overload has a comment."""
    described = {one.name for one in everything if one.about}
    kinds = ("variable", "typedef")
    return [one for one in everything if one.kind not in kinds and one.name not in described]


def _page(noun: str, mine: list[Entity]) -> Iterator[str]:
    yield f"# `wakeline/{noun}/`\n\n{NOUNS[noun][0].upper()}{NOUNS[noun][1:]}.\n"
    header = ""
    for one in mine:
        if one.header != header:
            header = one.header
            yield f"\n## `{header.rpartition('/')[2]}`\n\n`#include <{header}>`\n"
        yield from _entity(one)


def _entity(one: Entity) -> Iterator[str]:
    yield f"\n### `{one.name}`\n\n```cpp\n{one.code}\n```\n"
    words = one.about
    if words:
        yield words + "\n"
    last = one.name.rpartition("::")[2]
    pieces: list[tuple[str, str]] = []  # code, words; members without words share a block
    for member in one.members:
        if member.name in (f"~{last}", "kName", "kSummary") or _OPERATOR.match(member.name):
            continue
        about = member.about or _field(last, member.name)
        code = member.code.replace(f"{one.name}::", "")
        if pieces and not about and not pieces[-1][1]:
            pieces[-1] = (f"{pieces[-1][0]}\n{code}", "")
        else:
            pieces.append((code, about))
    if pieces:
        members = "\n".join(f"```cpp\n{code}\n```\n{words}\n" for code, words in pieces)
        yield f'<div class="members" markdown>\n\n{members}\n</div>\n'


@cache
def _field(struct: str, name: str) -> str:
    """The words of a field table, which the property of the class in Python has."""
    for module in (wl, wl.track, wl.navigation, wl.multimodel, wl.video, wl.filter, wl.measurement):
        found = inspect.getattr_static(getattr(module, struct, None), name, None)
        if isinstance(found, property):
            return inspect.getdoc(found) or ""
    return ""
