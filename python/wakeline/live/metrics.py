"""Status as text for Prometheus."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

_COUNTERS = {
    "messages": "Messages received or sent.",
    "octets": "Octets received or sent.",
    "duplicates": "Messages dropped because another sender of the same data was first.",
    "dropped": "Messages that a receiver did not take in time.",
    "plots": "Plots received.",
    "sectors": "Sectors received.",
    "unused_plots": "Plots not used, because own ship was not known.",
    "excluded_plots": "Plots in exclusion zones or on land that are not used.",
    "lost_sweeps": "Sweeps missing according to the sender's count.",
    "late_sweeps": "Sweeps that came after later ones and are not used.",
}
_GAUGES = {
    "messages_per_s": "Messages a second, over 5 s.",
    "octets_per_s": "Octets a second, over 5 s.",
    "age_s": "Age of the last message or sector.",
    "clock_offset_s": "Correction of the sensor's clock.",
    "period_s": "Time of an antenna revolution.",
}
_LABELS = {"inputs": "input", "outputs": "output", "radars": "radar"}


def metrics_of(status: Mapping[str, Any]) -> str:
    """Text of a status."""
    samples: dict[str, list[str]] = {}
    for group, label in _LABELS.items():
        for name, values in status[group].items():
            for key in (*_COUNTERS, *_GAUGES):
                if values.get(key) is not None:
                    metric = f"wakeline_{label}_{key}" + ("_total" if key in _COUNTERS else "")
                    sample = f'{metric}{{{label}="{_escaped(name)}"}} {values[key]}'
                    samples.setdefault(metric, []).append(sample)
            for kind, count in values.get("problems", {}).items():
                metric = f"wakeline_{label}_problems_total"
                labels = f'{label}="{_escaped(name)}",kind="{_escaped(kind)}"'
                samples.setdefault(metric, []).append(f"{metric}{{{labels}}} {count}")
    for quantity, one in status["own"].items():
        if one["age_s"] is not None:
            metric = "wakeline_own_age_s"
            samples.setdefault(metric, []).append(
                f'{metric}{{quantity="{quantity}"}} {one["age_s"]}'
            )
    for key in ("tracks", "ais_vessels"):
        samples[f"wakeline_{key}"] = [f"wakeline_{key} {status[key]}"]
    for key in ("late_inputs", "too_late_inputs", "corrections"):
        metric = f"wakeline_{key}_total"
        samples[metric] = [f"{metric} {status['late'][key]}"]
    samples["wakeline_frozen"] = [f"wakeline_frozen {int(bool(status['frozen']))}"]
    return "".join(f"{line}\n" for metric in samples for line in _family(metric, samples[metric]))


def _family(metric: str, samples: list[str]) -> Iterator[str]:
    key = metric.removesuffix("_total").partition("_")[2].partition("_")[2]
    about = (_COUNTERS | _GAUGES).get(key)
    if about:
        yield f"# HELP {metric} {about}"
    yield f"# TYPE {metric} {'counter' if metric.endswith('_total') else 'gauge'}"
    yield from samples


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
