"""The gallery: examples and notebooks, executed where the site is built.

What an example prints and draws is kept in `build/site-cache` under a hash of the example and of
the installed package, so that only what has changed is executed again.
"""

from __future__ import annotations

import ast
import hashlib
import html
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import wakeline as wl

ROOT = Path(__file__).parents[3]
CACHE = ROOT / "build/site-cache"
# In the order of the gallery: the first steps, estimators, sensors, own ship.
ORDER = (
    "first_tracks",
    "tune",
    "calibrate",
    "smooth_recording",
    "which_estimator",
    "imm",
    "own_model",
    "console_loop",
    "live_session",
    "several_sensors",
    "video_console",
    "strobe_tracker",
    "own_ship",
)
PEERS = "compare_peers"  # takes an hour with the peers; cpp/docs/peers.md has what it prints
_HEAD = """\
# Examples

Programs of `python/examples`, each executed when these pages were built. Those with a twin of the
same name in `cpp/examples` do the same in C++. Below them are [three notebooks](#notebooks).
"""


@dataclass(frozen=True)
class Example:
    """One program.

    Attributes
    ----------
    name, title, about : str
        Name of the file; the beginning of its docstring up to a colon, and all of it.
    code, cpp : str
        Without the docstring; the program in C++, empty if there is none.
    """

    name: str
    title: str
    about: str
    code: str
    cpp: str

    @property
    def file(self) -> Path:
        return ROOT / f"python/examples/{self.name}.py"


def examples() -> list[Example]:
    """The examples in the order of the gallery; one that it does not name comes last."""
    names = {file.stem for file in (ROOT / "python/examples").glob("*.py")} - {PEERS}
    order = [name for name in ORDER if name in names] + sorted(names - set(ORDER))
    return [_example(name) for name in order]


def _example(name: str) -> Example:
    text = (ROOT / f"python/examples/{name}.py").read_text(encoding="utf-8")
    about = ast.get_docstring(ast.parse(text)) or ""
    twin = ROOT / f"cpp/examples/{name}.cpp"
    return Example(
        name=name,
        title=" ".join(re.split(r"[:.]", about)[0].split()),
        about=about,
        code=text.split('"""', 2)[2].strip(),
        cpp=twin.read_text(encoding="utf-8").strip() if twin.exists() else "",
    )


def notebooks() -> list[Path]:
    """The notebooks."""
    return sorted((ROOT / "python/notebooks").glob("*.ipynb"))


def executed() -> dict[str, Path]:
    """A folder with what each example and notebook has printed and drawn, by its name."""
    jobs = {one.name: (run_example, one.file) for one in examples()}
    jobs |= {file.stem: (run_notebook, file) for file in notebooks()}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        folders = {name: pool.submit(_kept, file, run) for name, (run, file) in jobs.items()}
        return {name: folder.result() for name, folder in folders.items()}


def _kept(file: Path, run: Callable[[Path, Path], None]) -> Path:
    """The results of a program, of an earlier execution if nothing has changed since."""
    key = hashlib.sha256(f"{_package()}{file.name}".encode() + file.read_bytes()).hexdigest()[:24]
    folder = CACHE / f"{file.stem}-{key}"
    if not folder.is_dir():
        CACHE.mkdir(parents=True, exist_ok=True)
        for old in CACHE.glob(f"{file.stem}-*"):
            shutil.rmtree(old, ignore_errors=True)
        with tempfile.TemporaryDirectory(dir=CACHE) as fresh:
            run(file, Path(fresh))
            shutil.copytree(fresh, folder)
    return folder


@cache
def _package() -> str:
    """A hash of the installed package."""
    digest = hashlib.sha256()
    root = Path(wl.__file__).parent
    for file in sorted(root.rglob("*")):
        if file.is_file() and "__pycache__" not in file.parts:
            digest.update(f"{file.relative_to(root)}\0".encode() + file.read_bytes())
    return digest.hexdigest()


def run_example(file: Path, folder: Path) -> None:
    """Run an example in a folder; what it prints is written to `output.txt` there."""
    printed = _run(file, [str(file)], folder)
    (folder / "output.txt").write_text(printed, encoding="utf-8")


def run_notebook(file: Path, folder: Path) -> None:
    """Execute a notebook; its page and its pictures are written to a folder."""
    command = ["-m", "nbconvert", "--execute", "--to", "markdown", "--output-dir", str(folder)]
    _run(file, [*command, "--NbConvertApp.output_files_dir=.", str(file)], folder)


def _run(file: Path, arguments: list[str], folder: Path) -> str:
    """Run Python in a folder; what it prints."""
    place = os.pathsep.join([str(Path(wl.__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": place.rstrip(os.pathsep), "MPLBACKEND": "agg"},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        raise RuntimeError(f"{file.name} failed:\n{done.stderr}")
    return done.stdout


def pages(folders: dict[str, Path]) -> Iterator[tuple[str, str]]:
    """Name and text of each page, from the results of :func:`executed`."""
    yield "index", "\n".join(_index(folders)) + "\n"
    for example in examples():
        yield example.name, "\n\n".join(_page(example, folders[example.name])) + "\n"
    for file in notebooks():
        text = (folders[file.stem] / f"{file.stem}.md").read_text(encoding="utf-8")
        text = text.replace("](../../cpp/docs/", "](../")
        where = f"Notebook `python/notebooks/{file.name}`, executed when this page was built."
        title, _, rest = text.partition("\n")
        yield file.stem, f"{title}\n\n{where}\n{rest}"


def pictures(folder: Path) -> list[Path]:
    """What a program has drawn."""
    return sorted(folder.glob("*.png"))


def title_of(notebook: Path) -> str:
    """The heading of a notebook."""
    first = json.loads(notebook.read_text(encoding="utf-8"))["cells"][0]["source"]
    return "".join(first).partition("\n")[0].lstrip("# ")


def _index(folders: dict[str, Path]) -> Iterator[str]:
    yield _HEAD
    yield '<div class="grid cards gallery" markdown>\n'
    for example in examples():
        drawn = pictures(folders[example.name])
        if drawn:
            shown = f"![]({drawn[0].name})"
        else:
            printed = html.escape(_last_lines(folders[example.name])).replace("\n", "&#10;")
            shown = f"<pre>{printed}</pre>"
        languages = "Python, C++" if example.cpp else "Python"
        yield (
            f"-   {shown}\n\n    [**{example.title}**]({example.name}.md)"
            f"\n\n    `{example.name}` · {languages}\n"
        )
    yield "</div>\n\n## Notebooks\n\n" + '<div class="grid cards gallery" markdown>\n'
    for file in notebooks():
        picture = pictures(folders[file.stem])[0].name
        yield f"-   ![]({picture})\n\n    [**{title_of(file)}**]({file.stem}.md)\n"
    yield "</div>"


def _last_lines(folder: Path, count: int = 11) -> str:
    return "\n".join(_printed(folder).split("\n")[-count:])


def _printed(folder: Path) -> str:
    """What a program has printed."""
    return (folder / "output.txt").read_text(encoding="utf-8").rstrip()


def _page(example: Example, folder: Path) -> Iterator[str]:
    yield f"# {example.title}"
    yield example.about
    for picture in pictures(folder):
        yield f"![{example.title}]({picture.name})"
    printed = _printed(folder)
    if printed:
        yield f"It prints:\n\n```text\n{printed}\n```"
    yield f'=== "Python"\n\n{_indented(f"`python/examples/{example.name}.py`")}'
    yield _indented(f"```python\n{example.code}\n```")
    if example.cpp:
        yield f'=== "C++"\n\n{_indented(f"`cpp/examples/{example.name}.cpp`")}'
        yield _indented(f"```cpp\n{example.cpp}\n```")


def _indented(text: str) -> str:
    return "\n".join(f"    {line}".rstrip() for line in text.split("\n"))
