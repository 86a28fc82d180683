"""Output of a scene in a cell of a notebook: its picture and its parts, or its view page. Private."""
from __future__ import annotations

import base64
import html
import os
import pathlib
import struct
import tempfile
import zlib
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _command, _save
from ._interface import Error
from ._library import ffi

if TYPE_CHECKING:
    from ._state import State
    from .scene import Scene

#: Rows of a table that are seen before it is unfolded, and the picture's columns and rows.
_ROWS_SEEN = 12
_PICTURE = (640, 420)


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


def summary(scene: Scene) -> str:
    """The scene as HTML: its picture, if it has a view and parts, and its table of parts, which folds after 12 rows."""
    said = f"<p>{html.escape(repr(scene))}</p>"
    if scene._state.setup == ffi.NULL:
        return said
    rows = [f"<tr><td>{html.escape(p.label)}</td><td>{html.escape(p.material.name)}</td><td>{p.density:.4g}</td>"
            f"<td>{html.escape(p.inside or '')}</td><td>{p.mesh.health['triangles']}</td></tr>" for p in scene]
    head = "<tr><th>part</th><th>material</th><th>g/cm3</th><th>inside</th><th>triangles</th></tr>"
    seen, folded = rows[:_ROWS_SEEN], rows[_ROWS_SEEN:]
    more = (f"<details><summary>{len(folded)} more</summary><table>{head}{''.join(folded)}</table></details>"
            if folded else "")
    return f"{_drawn(scene)}{said}<table>{head}{''.join(seen)}</table>{more}"


def _drawn(scene: Scene) -> str:
    """The picture as an img; nothing where the scene cannot be drawn yet, because a cell shows what there is."""
    try:
        pixels = scene.picture(_PICTURE)
    except Error:
        return ""
    return f'<img alt="source, detector and parts" width="{_PICTURE[0]}" src="data:image/png;base64,{base64.b64encode(_png(pixels)).decode()}">'


def _png(pixels: NDArray[np.uint8]) -> bytes:
    """[row, column, red green blue] as a PNG."""
    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    rows, columns = pixels.shape[:2]
    lines = b"".join(b"\0" + line.tobytes() for line in pixels)  # each line: no filter
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b""))
