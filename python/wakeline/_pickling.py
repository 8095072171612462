"""How objects of the engine are pickled: as the arguments that make an equal one, and its state."""

from __future__ import annotations

from typing import Any


def rebuilt(
    kind: type, factory: str | None, arguments: dict[str, Any], state: bytes | None = None
) -> Any:
    """An object made by its type, or a factory of its type, in the state that `save` gave."""
    made = (getattr(kind, factory) if factory else kind)(**arguments)
    if state is not None:
        made.restore(state)
    return made
