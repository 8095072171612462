"""The reference of Python, from the docstrings.

A public name or field without a docstring is a warning, and warnings are errors where the site is
built.
"""

from __future__ import annotations

import ast
import inspect
import logging
import re
import sys
from collections.abc import Iterator
from importlib import import_module
from itertools import pairwise
from types import ModuleType
from typing import Any

log = logging.getLogger("mkdocs.plugins.wakeline")

# In the order of the site; the first ones are also at the top level of the package.
ENGINE = (
    "core",
    "motion",
    "measurement",
    "filter",
    "multimodel",
    "gating",
    "association",
    "track",
    "video",
    "navigation",
    "wire",
    "batch",
    "eval",
)
PACKAGES = (
    "tracking",
    "recording",
    "metrics",
    "montecarlo",
    "scenario",
    "plot",
    "forecast",
    "own_ship",
    "search",
    "extraction",
    "live",
)
MODULES = (*ENGINE, *PACKAGES)
_SECTION = re.compile(r"^([A-Z][A-Za-z ]+)\n-{3,}\n", re.MULTILINE)
_ROLE = re.compile(r":(?:class|func|meth|mod|attr):`~?([^`]+)`")
_LISTS = ("Parameters", "Attributes", "Returns", "Raises")


def pages() -> Iterator[tuple[str, str]]:
    """Name and text of each page."""
    lines = [
        "# Python\n\n`import wakeline as wl`. The names of the engine are also at the top level."
    ]
    for title, names in (("The engine", ENGINE), ("Recordings, studies, pictures", PACKAGES)):
        lines.append(f"\n## {title}\n\n| module | |\n|---|---|")
        for name in names:
            about = first_sentence(import_module(f"wakeline.{name}").__doc__)
            lines.append(f"| [`wakeline.{name}`]({name}.md) | {about} |")
    yield "index", "\n".join(lines) + "\n"
    for name in MODULES:
        yield name, "\n".join(page_of(import_module(f"wakeline.{name}"), name)) + "\n"


def page_of(module: ModuleType, name: str) -> Iterator[str]:
    """The lines of a module's page."""
    yield f"# `wakeline.{name}`\n\n{as_markdown(module.__doc__ or '')}\n"
    for public in public_names(module):
        value = getattr(module, public)
        if inspect.ismodule(value):
            continue
        yield f"\n## `{public}`\n"
        if not (inspect.isclass(value) or callable(value)):
            yield from constant(value, f"wakeline.{name}.{public}", public)
            continue
        yield from described(value, f"wakeline.{name}.{public}", public)
        if inspect.isclass(value):
            yield from members_of(value, f"wakeline.{name}.{public}")


def public_names(module: ModuleType) -> list[str]:
    """The public names of a module, in its order."""
    names = getattr(module, "__all__", None) or vars(module)
    return [name for name in names if not name.startswith("_")]


def constant(value: Any, place: str, name: str) -> Iterator[str]:
    """The string below the assignment of a constant, and its value or its keys."""
    about = next(filter(None, (string_below(name, value, source) for source in sources())), "")
    if not about:
        log.warning("%s has no docstring", place)
    yield f"{as_markdown(about)}\n"
    if isinstance(value, dict):
        yield "Keys: " + ", ".join(f"`{key}`" for key in value) + ".\n"
    elif len(repr(value)) < 200:
        yield f"`{value!r}`\n"


def sources() -> Iterator[ModuleType]:
    """The modules of the package that have a source."""
    modules = [module for name, module in sys.modules.items() if name.startswith("wakeline.")]
    return (module for module in modules if (module.__file__ or "").endswith(".py"))


def string_below(name: str, value: object, source: ModuleType) -> str:
    """The string below the assignment of a name to a value in a module."""
    if vars(source).get(name) is not value:
        return ""
    for assignment, below in pairwise(ast.parse(inspect.getsource(source)).body):
        match assignment, below:
            case ast.Assign([ast.Name(id)]), ast.Expr(ast.Constant(str(text))) if id == name:
                return inspect.cleandoc(text)
    return ""


def members_of(kind: type, place: str) -> Iterator[str]:
    """Fields that the docstring of a class does not list, then its methods; also of its bases."""
    listed = set(re.findall(r"^(\w+(?:, \w+)*) : ", inspect.getdoc(kind) or "", re.MULTILINE))
    listed = {name for names in listed for name in names.split(", ")}
    methods = []
    for name in sorted(dir(kind)):
        owner = next((base for base in kind.__mro__ if name in vars(base)), object)
        if name.startswith("_") or not owner.__module__.startswith("wakeline"):
            continue
        member = inspect.getattr_static(kind, name)
        if isinstance(member, property):
            about = as_markdown(inspect.getdoc(member) or "")
            if name in listed or _is_of_enum(kind, name):
                continue
            if not about and type(member) is property:  # of a static one pybind11 loses it
                log.warning("%s.%s has no docstring", place, name)
            yield f"\n- **`{name}`**: {about}" if about else f"\n- **`{name}`**"
        elif callable(getattr(kind, name)) and not inspect.isclass(getattr(kind, name)):
            methods.append(name)
    for name in methods:
        yield f"\n### `{kind.__name__}.{name}`\n"
        yield from described(getattr(kind, name), f"{place}.{name}", name)


def _is_of_enum(kind: type, name: str) -> bool:
    """Whether it is what every enumeration has."""
    return hasattr(kind, "__members__") and name in ("name", "value")


def described(value: Any, place: str, name: str) -> Iterator[str]:
    """Signature and docstring of a function or class."""
    text = inspect.getdoc(value) or ""
    signature, text = signature_of(value, text, name)
    if signature:
        yield f"```python\n{signature}\n```\n"
    if text.strip():
        yield as_markdown(text) + "\n"
    else:
        log.warning("%s has no docstring", place)


def signature_of(value: Any, text: str, name: str) -> tuple[str, str]:
    """The call with names and defaults, and the docstring without it."""
    if inspect.isclass(value):
        made = vars(value).get("__init__")
        first = (getattr(made, "__doc__", None) or "").partition("\n")[0]
        if first.startswith("__init__("):
            return f"{name}({', '.join(arguments_of(first))})", text
    elif text.startswith(f"{name}("):
        first, _, rest = text.partition("\n")
        return f"{name}({', '.join(arguments_of(first))})", rest.strip()
    try:
        plain = inspect.signature(value)
    except (ValueError, TypeError):
        return "", text
    arguments = [
        str(one.replace(annotation=inspect.Parameter.empty))
        for one in plain.parameters.values()
        if one.name != "self"
    ]
    return f"{name}({', '.join(arguments)})", text


def arguments_of(first: str) -> list[str]:
    """Names and defaults in the first line of a docstring of the engine."""
    inner = first[first.index("(") + 1 : _end_of_call(first) - 1]
    parts, depth, begin = [], 0, 0
    for k, sign in enumerate(inner + ","):
        depth += (sign in "([{<") - (sign in ")]}>")
        if sign == "," and depth <= 0:
            parts.append(inner[begin:k].strip())
            begin = k + 1
    arguments = []
    for part in filter(None, parts):
        head, _, annotated = part.partition(":")
        default = annotated.rpartition(" = ")[2] if " = " in annotated else ""
        arguments.append(f"{head}={default}" if default else head)
    return [one for one in arguments if one != "self"]


def _end_of_call(first: str) -> int:
    """Position after the parenthesis that ends the arguments."""
    depth = 0
    for k, sign in enumerate(first):
        depth += (sign == "(") - (sign == ")")
        if depth == 0 and sign == ")":
            return k + 1
    return len(first)


def first_sentence(text: str | None) -> str:
    """Of a docstring, for a table."""
    about = " ".join((text or "").partition("\n\n")[0].split())
    return _ROLE.sub(r"`\1`", about).replace("|", "\\|")


def as_markdown(text: str) -> str:
    """A docstring in the form of numpydoc as Markdown."""
    pieces = _SECTION.split(_ROLE.sub(r"`\1`", inspect.cleandoc(text)).replace("``", "`"))
    done = [with_code(pieces[0].strip())]
    for title, body in zip(pieces[1::2], pieces[2::2], strict=True):
        done.append(f"**{title}**\n")
        done.append(as_list(body) if title in _LISTS else with_code(body.strip()))
    return "\n\n".join(filter(None, done))


def as_list(body: str) -> str:
    """Names with what is indented below each."""
    entries: list[tuple[str, list[str]]] = []
    for line in body.strip().split("\n"):
        if not line.startswith(" ") and line.strip():
            entries.append((line.strip(), []))
        elif entries:
            entries[-1][1].append(line.strip())
    lines = []
    for head, about in entries:
        name, _, kind = head.partition(" : ")
        what = f"`{name}` ({kind})" if kind else f"`{name}`"
        words = " ".join(filter(None, about))
        lines.append(f"- {what}: {words}" if words else f"- {what}")
    return "\n".join(lines)


def with_code(text: str) -> str:
    """Examples as blocks of code, and lines that are indented as such, too."""
    blocks = []
    for block in re.split(r"\n\s*\n", text):
        if block.lstrip().startswith(">>>"):
            blocks.append(f"```python\n{inspect.cleandoc(block)}\n```")
        else:
            blocks.append(re.sub(r"(?<!`)<([A-Za-z])", r"&lt;\1", block))
    return "\n\n".join(blocks)
