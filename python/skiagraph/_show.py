"""The view page of a scene, for a cell of a notebook. Private."""
from __future__ import annotations

import base64
import html
import os
import pathlib
import tempfile
from typing import TYPE_CHECKING, Any

from . import _command, _save

if TYPE_CHECKING:
    from ._state import State


class Page:
    """A page of a scene that turns with the mouse: the last value of a cell shows it, and save() writes it."""

    def __init__(self, text: str, picture: bytes, height: int) -> None:
        self.html = text
        self.height = height
        #: A PNG of the scene, in base64, as the plots of K3D have it.
        self.screenshot = base64.b64encode(picture).decode()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page as .html."""
        pathlib.Path(path).write_text(self.html, encoding="utf-8")

    def fetch_screenshot(self, *arguments: Any) -> None:
        """Does nothing: `screenshot` is there."""

    def display(self) -> None:
        """Shows it now. Without IPython it says how to see it."""
        try:
            from IPython.display import display  # type: ignore[import-not-found, unused-ignore]
        except ImportError:
            print("a page is shown by a notebook; save(\"scene.html\") writes it for a browser")
            return
        display(self)  # type: ignore[no-untyped-call, unused-ignore]

    def _repr_html_(self) -> str:
        return (f'<iframe srcdoc="{html.escape(self.html)}" style="width: 100%; height: {self.height}px; border: 0"></iframe>')

    def __repr__(self) -> str:
        return f"<Page of a scene, {len(self.html)} characters of HTML; save(path) writes it>"


def page(state: State, height: int) -> Page:
    with tempfile.TemporaryDirectory(prefix="skiagraph-") as folder:
        written, shown, drawn = (pathlib.Path(folder, name) for name in ("scene.json", "scene.html", "scene.png"))
        _save.save(state, written)
        for target in (shown, drawn):
            _command.run("view", str(written), "-o", str(target), "--quiet", *(["--lenient"] if state.source.lenient else []))
        return Page(shown.read_text(encoding="utf-8"), drawn.read_bytes(), height)
