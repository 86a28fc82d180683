"""The generated thorax, for trials and lessons without patient data."""
from __future__ import annotations

import atexit
import os
import shutil
import tempfile
from typing import overload

from ._library import call, encode, fill, make, release, struct
from .scene import Scene


@overload
def thorax(folder: None = None, triangles: int | None = None, simple: bool = False) -> Scene: ...
@overload
def thorax(folder: str | os.PathLike[str], triangles: int | None = None, simple: bool = False) -> str: ...
def thorax(folder: str | os.PathLike[str] | None = None, triangles: int | None = None, simple: bool = False) -> Scene | str:
    """A thorax that breathes. Without a folder, a scene: its files lie in a temporary folder until Python ends. With a
    folder, which is made if need be, the meshes and the scene file are written there; returns the path of the file.

    triangles: about how many, 10,000 or more. simple: without muscle, vessels, marrow, shoulder blades and bowel.

    >>> from skiagraph import thorax
    >>> with thorax(triangles=10000) as scene:
    ...     scene.breathe(phase=0.5)["amplitude"] < 0.1
    True
    """
    if folder is None:
        made = tempfile.mkdtemp(prefix="skiagraph-thorax-")
        atexit.register(shutil.rmtree, made, ignore_errors=True)
        return Scene(_write(made, triangles, simple))
    return _write(folder, triangles, simple)


def _write(folder: str | os.PathLike[str], triangles: int | None, simple: bool) -> str:
    encode(folder, "folder")
    os.makedirs(folder, exist_ok=True)
    options = struct("skg_thorax_options")
    fill(options, "skg_thorax_options", {"triangles": triangles, "simple": simple}, [], "option")
    made = make("skg_thorax_create", "skg_thorax", options)
    try:
        call("skg_thorax_save", made, encode(folder, "folder"))
    finally:
        release("skg_thorax", made)
    return os.path.join(os.fspath(folder), "thorax.json")
