"""One sentence for a call of the engine whose arguments do not fit, in place of its signatures."""

from __future__ import annotations

import datetime
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from wakeline._brief import quoted

_OPEN, _CLOSE = "([{", ")]}"


@dataclass
class _Parameter:
    name: str
    annotation: str
    required: bool
    by_name: bool  # only


def sentence(message: str, positional: list[Any], named: dict[str, Any]) -> str:
    """What does not fit in such a call.

    Parameters
    ----------
    message : str
        pybind11's, which lists the signatures.
    positional, named
        The arguments given, with ``self``.
    """
    signatures = re.findall(r"^    \d+\. (.*)$", message, re.MULTILINE)
    constructor = ": incompatible constructor arguments" in message
    name = message[: message.index("(): incompatible")]
    if constructor:
        name = signatures[0][: signatures[0].index("(")].rpartition(".")[2]
        positional = positional[1:]
    troubles = []
    for signature in signatures:
        parameters = list(_parameters(signature))
        if not constructor and parameters and parameters[0].name == "self":
            owner = parameters[0].annotation.rpartition(".")[2]
            troubles.append(_trouble(f"{owner}.{name}", parameters[1:], positional[1:], named))
        else:
            troubles.append(_trouble(name, parameters, positional, named))
    # Of several, what is wrong with the one that is nearest to the call.
    return max(troubles, key=lambda trouble: trouble[0])[1]


def _trouble(
    name: str, parameters: list[_Parameter], positional: list[Any], named: dict[str, Any]
) -> tuple[int, str]:
    """How near a call comes to a signature, and why it does not fit."""
    by_place = [p for p in parameters if not p.by_name]
    known = {p.name: p for p in parameters}
    if len(positional) > len(by_place):
        meant = [p.name for p in parameters if p.by_name][: len(positional) - len(by_place)]
        if meant:
            return 1, f"{name} takes {_and(meant)} by name: {meant[0]}=..."
        most = f"at most {len(by_place)}" if by_place else "no"
        listed = f" ({', '.join(p.name for p in by_place)})" if by_place else ""
        return 0, f"{name} takes {most} arguments{listed}, got {len(positional)}"
    for key in named:
        if key not in known:
            has = f"; it has {', '.join(known)}" if known else ""
            return 0, f"{name} has no argument '{key}'{has}"
    given = {p.name: value for p, value in zip(by_place, positional, strict=False)}
    twice = [key for key in named if key in given]
    if twice:
        return 1, f"{name} got two values for {_and(twice)}"
    given |= named
    missing = [p.name for p in parameters if p.required and p.name not in given]
    if missing:
        return 1, f"{name} needs {_and(missing)}"
    for key, value in given.items():
        annotation = known[key].annotation
        if not _fits(value, annotation):
            return 2, f"{key} of {name} must be {_words(annotation)}, got {_shown(value)}"
    wanted = ", ".join(f"{p.name}: {_words(p.annotation)}" for p in parameters)
    got = ", ".join(_shown(value) for value in given.values())
    return 2, f"{name} takes {wanted or 'no arguments'}; got {got}"


def _parameters(signature: str) -> Iterator[_Parameter]:
    by_name = False
    inside = signature[signature.index("(") + 1 :]
    for part in _split(inside, ","):
        if part == "*":
            by_name = True
        elif part and part != "/":
            name, _, rest = part.partition(":")
            annotation, equals, _ = rest.partition(" = ")
            yield _Parameter(name.lstrip("*").strip(), annotation.strip(), not equals, by_name)


def _split(text: str, separator: str) -> Iterator[str]:
    """Parts outside brackets and quotes, up to a bracket that closes nothing."""
    depth, quote, part = 0, "", ""
    for letter in text:
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "'\"":
            quote = letter
        elif letter in _OPEN:
            depth += 1
        elif letter in _CLOSE:
            depth -= 1
            if depth < 0:
                break
        if letter == separator and depth == 0 and not quote:
            yield part.strip()
            part = ""
        else:
            part += letter
    yield part.strip()


def _fits(value: Any, annotation: str) -> bool:
    return any(_fits_one(value, one) for one in _split(annotation, "|"))


def _fits_one(value: Any, annotation: str) -> bool:
    kind = annotation.partition("[")[0].rpartition(".")[2]
    if kind == "None":
        return value is None
    if kind in ("SupportsFloat", "float"):
        return hasattr(value, "__float__") and np.ndim(value) == 0
    if kind in ("SupportsIndex", "SupportsInt", "int"):
        return hasattr(value, "__index__")
    if kind in ("Annotated", "ArrayLike", "NDArray"):
        try:
            np.asarray(value, float)
        except (TypeError, ValueError):
            return False
        return value is not None
    if kind == "Sequence":
        return hasattr(value, "__len__") and all(_fits(one, _inner(annotation)) for one in value)
    if kind in ("object", "Any", ""):
        return True
    return any(base.__name__ == kind for base in type(value).__mro__)


def _inner(sequence: str) -> str:
    """The annotation of what is in a sequence."""
    return sequence.partition("[")[2][:-1] or "object"


_WORDS = {
    "None": "None",
    "SupportsFloat": "a number",
    "float": "a number",
    "SupportsIndex": "a whole number",
    "SupportsInt": "a whole number",
    "int": "a whole number",
    "bool": "True or False",
    "str": "text",
    "bytes": "bytes",
    "Annotated": "an array of numbers",
    "ArrayLike": "an array of numbers",
    "object": "anything",
}


def _words(annotation: str) -> str:
    words = []
    for one in _split(annotation, "|"):
        kind = one.partition("[")[0].rpartition(".")[2]
        if kind == "Sequence":
            inner = _inner(one)
            word = "a sequence" if inner == "object" else f"a sequence of {_words(inner)}"
        else:
            word = _WORDS.get(kind, kind)
        words.append(word)
    if "a number" in words and "a whole number" in words:
        words.remove("a whole number")
    return _list(list(dict.fromkeys(words)), "or")


def _shown(value: Any) -> str:
    if isinstance(value, (datetime.datetime, datetime.date, np.datetime64)):
        return f"{type(value).__name__} (give seconds, such as its timestamp())"
    if isinstance(value, (datetime.timedelta, np.timedelta64)):
        return f"{type(value).__name__} (give seconds, such as its total_seconds())"
    if isinstance(value, np.ndarray):
        return f"an array of {value.dtype} of shape {value.shape}"
    if value is None or isinstance(value, (str, bytes, bool, int, float)):
        return quoted(value)
    kind = type(value)
    bases = [b for b in kind.__mro__[1:] if b.__module__.startswith("wakeline.")]
    derived = bases and not kind.__module__.startswith("wakeline.")
    return f"{kind.__name__}, derived from {bases[0].__name__}" if derived else kind.__name__


def _and(words: list[str]) -> str:
    return _list(words, "and")


def _list(words: list[str], last: str) -> str:
    return " ".join(filter(None, [", ".join(words[:-1]), last if words[1:] else "", words[-1]]))
