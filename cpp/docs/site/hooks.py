"""What MkDocs calls where it builds the site: pages that are made then, and their navigation."""

from __future__ import annotations

import posixpath
import re
from typing import Any

import gallery
import python_reference

_EXAMPLE = re.compile(r"python/(?:examples|notebooks)/(\w+)\.(?:py|ipynb)")
_LINK = re.compile(r"\[([^\]]+)\]\(([^)\s:]+)\)")


def on_config(config: Any) -> Any:
    """Add the pages that are made to the navigation."""
    config.nav += [
        {
            "Examples": [
                "examples/index.md",
                *({one.title: f"examples/{one.name}.md"} for one in gallery.examples()),
                *(
                    {gallery.title_of(one): f"examples/{one.stem}.md"}
                    for one in gallery.notebooks()
                ),
            ]
        },
        {"Python": [{name: f"api/{name}.md"} for name in ("index", *python_reference.MODULES)]},
    ]
    return config


def on_nav(nav: Any, config: Any, files: Any) -> Any:
    """Add the reference of C++, which Doxygen writes beside these pages."""
    from mkdocs.structure.nav import Link

    nav.items.append(Link("C++", "cpp/index.html"))
    return nav


def on_files(files: Any, config: Any) -> Any:
    """Add the pages that are made, and what programs have drawn."""
    from mkdocs.structure.files import File

    folders = gallery.executed()
    for place, made in (
        ("api", python_reference.pages()),
        ("examples", gallery.pages(folders)),
    ):
        for name, text in made:
            files.append(File.generated(config, f"{place}/{name}.md", content=text))
    for folder in folders.values():
        for picture in gallery.pictures(folder):
            name = f"examples/{picture.name}"
            files.append(File.generated(config, name, abs_src_path=str(picture)))
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    """Links to examples lead to their pages; of other links to files outside, the text is kept."""
    folder = posixpath.dirname(page.file.src_uri)

    def led(link: re.Match[str]) -> str:
        target = posixpath.normpath(posixpath.join("cpp/docs", folder, link[2].partition("#")[0]))
        if f"{target}/".startswith("cpp/docs/"):
            return link[0]
        example = _EXAMPLE.fullmatch(target)
        if example is None:
            return link[1]
        return f"[{link[1]}]({posixpath.relpath(f'examples/{example[1]}.md', folder or '.')})"

    return _LINK.sub(led, markdown)
