"""Laws of every parameter struct of the engine, found by its table of fields."""

import copy
import math
import pickle
import runpy
from pathlib import Path

import pytest

from wakeline import _engine

KINDS = {
    name: kind
    for part in vars(_engine).values()
    for name, kind in getattr(part, "__dict__", {}).items()
    if isinstance(kind, type) and "fields" in vars(kind)
}
COPIES = {
    "pickle": lambda one: pickle.loads(pickle.dumps(one)),
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
}
each_kind = pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
FIELDS = [(kind, field) for kind in KINDS.values() for field in kind.fields()]
each_field = pytest.mark.parametrize(
    ("kind", "field"), FIELDS, ids=[f"{kind.__name__}.{field.name}" for kind, field in FIELDS]
)


def other_values(value):
    """Values of the same type that differ."""
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, int):
        return [value + 1, value - 1]
    if isinstance(value, float):
        return [1.01 * value + 1e-4, 0.99 * value, value / 2]
    if isinstance(value, str):
        words = ["global_nearest", "nearest", "strongest", "minimum", "ordered_statistic"]
        return [word for word in words if word != value]
    name = type(value).fields()[0].name
    return [
        type(value)(**value.as_dict() | {name: changed})
        for changed in other_values(getattr(value, name))
    ]


def room_for(field):
    """Other fields without which the default of a field is its only value."""
    return {"least_amplitude": 9} if field.name == "pedestal" else {}


def changed(kind, field):
    """An instance that differs from the default in one field, and in what leaves room for it."""
    for value in other_values(field.default):
        try:
            return kind(**{field.name: value} | room_for(field))
        except ValueError:
            continue
    raise AssertionError(f"no other value of {kind.__name__}.{field.name} is valid")


def test_the_settings_of_a_tracker_are_among_them():
    assert {"Radar", "TrackerConfig", "VesselModels"} <= KINDS.keys()


@each_kind
def test_the_defaults_are_those_of_the_table(kind):
    defaults = {field.name: field.default for field in kind.fields()}
    assert kind().as_dict() == defaults
    assert kind(**defaults) == kind()
    assert kind() != object()


@each_field
def test_changing_a_field_breaks_equality(kind, field):
    one = changed(kind, field)
    assert one != kind()
    assert getattr(one, field.name) != field.default
    assert f"{field.name}=" in repr(one)


@pytest.mark.parametrize("way", COPIES)
@each_field
def test_copies_are_equal_and_separate(kind, field, way):
    one = changed(kind, field)
    other = COPIES[way](one)
    assert other == one
    assert other is not one
    assert type(other) is kind


@each_field
def test_help_explains_every_field(kind, field):
    doc = getattr(kind, field.name).__doc__
    assert field.sentence in doc
    assert "Default " in doc
    assert f"\n{field.name} : " in kind.__doc__
    assert field.sentence in kind.__doc__
    if isinstance(field.default, int | float) and not isinstance(field.default, bool):
        assert field.unit
        assert field.rule in doc.lower()
        assert field.unit == "1" or field.unit in doc


@each_field
def test_a_value_out_of_range_is_rejected_by_name(kind, field):
    if isinstance(field.default, float):
        with pytest.raises(ValueError, match=rf"{field.name} must be .*, got nan"):
            kind(**{field.name: math.nan})
    elif isinstance(field.default, str):
        with pytest.raises(ValueError, match=f"{field.name} must be '"):
            kind(**{field.name: "none of them"})
    with pytest.raises(TypeError, match=f"{field.name} must be "):
        kind(**{field.name: object()})


@each_field
def test_setting_a_field_checks_it(kind, field):
    one = kind(**kind().as_dict() | room_for(field))
    try:
        setattr(one, field.name, getattr(changed(kind, field), field.name))
    except AttributeError:
        return  # its fields cannot be set
    assert one == changed(kind, field)
    with pytest.raises(TypeError, match=f"{field.name} must be "):
        setattr(one, field.name, object())
    if isinstance(field.default, float):
        with pytest.raises(ValueError, match=f"{field.name} must be "):
            setattr(one, field.name, math.nan)
    assert one == changed(kind, field)


@each_kind
def test_an_unknown_parameter_is_named(kind):
    with pytest.raises(TypeError, match=f"{kind.__name__} has no parameter 'no_such'"):
        kind(no_such=1)


@each_kind
def test_equal_ones_have_equal_hashes(kind):
    if kind.__hash__ is not None and all(
        type(field.default).__hash__ is not None for field in kind.fields()
    ):
        assert hash(kind()) == hash(copy.copy(kind()))


def test_the_page_of_settings_is_current():
    page = Path(__file__).parents[2] / "cpp" / "docs" / "make_settings.py"
    made = runpy.run_path(str(page))
    assert made["PAGE"].read_text(encoding="utf-8") == made["text"]()
