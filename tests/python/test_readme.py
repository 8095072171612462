"""What the documentation says, holds: its Python runs and its links lead somewhere."""

import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "cpp/docs").rglob("*.md"))]


def test_the_python_of_the_readme_runs(tmp_path, capsys):
    (block,) = re.findall(r"```python\n(.*?)```", PAGES[0].read_text(), flags=re.DOTALL)
    script = tmp_path / "readme.py"
    script.write_text(block)
    runpy.run_path(str(script))
    assert "(58, 4)" in capsys.readouterr().out


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
