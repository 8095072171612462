"""How objects of the engine are pickled: as the call that makes an equal one, and what it knows.

That serves `pickle`, processes (`multiprocessing`, Dask) and `copy` alike.
"""

from __future__ import annotations

from types import ModuleType

from . import _engine


def _parts(module: ModuleType) -> dict[str, ModuleType]:
    return {name: part for name, part in vars(module).items() if isinstance(part, ModuleType)}


_NAMES = {
    name: one
    for part in _parts(_engine).values()
    for name, one in vars(part).items()
    if not name.startswith("_")
}


def made_by(call: str, state: bytes | None = None) -> object:
    """What a call makes, such as the `repr` of an estimator; with a state, what `save` gave."""
    made = eval(call, dict(_NAMES))
    if state is not None:
        made.restore(state)
    return made


def _reduced(one: object, _protocol: int) -> tuple[object, tuple[str, bytes | None]]:
    kind = type(one)
    if kind not in _KINDS:
        raise TypeError(f"{kind.__name__} is derived in Python: define __reduce_ex__")
    return made_by, (repr(one), one.save() if hasattr(one, "save") else None)


_KINDS = {
    kind
    for kind in _NAMES.values()
    if isinstance(kind, type) and not vars(kind).keys().isdisjoint({"__copy__", "save"})
}
for _kind in _KINDS:
    _kind.__reduce_ex__ = _reduced
