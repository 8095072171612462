"""The documentation: its programs run, its links and file names exist, its figures hold."""

import re
import runpy
from dataclasses import replace
from pathlib import Path

import pytest

import wakeline as wl
from wakeline import metrics, recording, scenario
from wakeline.tracking import read_settings

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "cpp/docs").rglob("*.md"))]


def block_of_the_readme(language):
    (block,) = re.findall(rf"```{language}\n(.*?)```", PAGES[0].read_text(), flags=re.DOTALL)
    return block


def test_the_python_of_the_readme_ends_in_a_picture(tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "readme.py").write_text(block_of_the_readme("python"))
    runpy.run_path("readme.py")
    assert (tmp_path / "joyride.png").stat().st_size > 10_000


def python_of(page):
    return re.findall(r"^```python\n(.*?)^```", page.read_text(), flags=re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize(
    "page", [page for page in PAGES[1:] if python_of(page)], ids=lambda page: page.name
)
def test_the_python_of_a_page_runs(page, tmp_path, monkeypatch):
    for module in ("matplotlib", "pandas"):
        pytest.importorskip(module)
    monkeypatch.chdir(tmp_path)
    recording.write_plots("plots.csv", recording.load("joyride"))
    radar = scenario.RadarVideoSimulator(sweeps_per_turn=256, cells=64, beam_width_rad=0.1)
    recording.write_video("harbour.cat240", radar.turns({}, 2, seed=1))
    Path("radar.toml").write_text("range_std_m = 6.0\nperiod_s = 2.5\n")
    Path("page.py").write_text("\n".join(python_of(page)))
    runpy.run_path("page.py")


def test_the_cpp_of_the_readme_is_an_example_that_ctest_runs():
    example = (ROOT / "cpp/examples/imm.cpp").read_text()
    assert example.endswith("\n\n" + block_of_the_readme("cpp"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
    for link in re.findall(r"\]\(([^)#]+)", text):
        if "://" not in link:
            assert (page.parent / link).exists(), link


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_files_that_are_named_exist(page):
    for name in re.findall(r"`((?:cpp|bindings|python|tests)/[\w./-]+)`", page.read_text()):
        assert (ROOT / name).exists(), name


WITHOUT = {
    "outliers": ("tracker", {"outlier_probability": 0.0}),
    "the clutter map": ("tracker", {"clutter_cell_m": 0.0}),
    "noise that grows with speed": (
        "models",
        {
            f"{mode}_course_psd_rad2s": 1e-12
            for mode in ("cruising", "steady", "restless", "turning")
        },
    ),
    "visibility": ("tracker", {"visible_time_s": 0.0}),
    "showing coasting tracks": ("tracker", {"shown_probability": 1.0}),
    "probabilistic association (GNN instead)": ("tracker", {"association": "global_nearest"}),
}
BOATS = {"fast boat": "joyride", "close boats": "autoferry"}
FIGURES = {
    "coverage": ("coverage", 100.0),
    "ids": ("ids", 1.0),
    "switches": ("switches", 1.0),
    "breaks": ("breaks", 1.0),
    "velocity": ("velocity_rmse_mps", 1.0),
    "course": ("course_rms_deg", 1.0),
    "position": ("position_rmse_debiased_m", 1.0),
    "false tracks a scan": ("false_track_scans_per_scan", 1.0),
}


def figures_of(name, section="tracker", changes=()):
    settings = read_settings(radar=name)
    changed = replace(settings, **{section: getattr(settings, section) | dict(changes)})
    recorded = recording.load(name)
    return metrics.score(wl.track_recording(recorded, config=changed), recorded).overall.as_dict()


@pytest.mark.parametrize("part", WITHOUT)
def test_what_each_part_of_the_tracker_is_worth(part):
    page = (ROOT / "cpp/docs/tracking.md").read_text()
    (row,) = re.findall(rf"^\| {re.escape(part)} \| (.*) \|$", page, flags=re.MULTILINE)
    for boats, text in re.findall(r"(fast boat|close boats): ([^;]*)", row):
        scores = figures_of(BOATS[boats]), figures_of(BOATS[boats], *WITHOUT[part])
        reported = re.findall(rf"({'|'.join(FIGURES)}) ([\d.]+) → ([\d.]+)", text)
        assert len(reported) == text.count("→")
        for figure, *numbers in reported:
            key, scale = FIGURES[figure]
            for score, number in zip(scores, numbers, strict=True):
                last_digit = 10.0 ** -len(number.partition(".")[2])
                assert abs(scale * score[key] - float(number)) < 0.6 * last_digit, (boats, figure)


def test_the_citation_has_the_version_of_the_header():
    header = (ROOT / "cpp/include/wakeline/core/version.hpp").read_text()
    parts = [re.search(rf"_{part} (\d+)", header)[1] for part in ("MAJOR", "MINOR", "PATCH")]
    assert f"\nversion: {'.'.join(parts)}\n" in (ROOT / "CITATION.cff").read_text()
