"""The generated thorax, for trials and lessons without patient data."""
from __future__ import annotations

import os

from ._library import call, encode, fill, make, release, struct


def thorax(folder: str | os.PathLike[str], triangles: int | None = None, simple: bool = False) -> str:
    """Writes the meshes and the scene file of a thorax into a folder, which is made if need be; returns the
    path of the file.

    triangles: about how many, 10,000 or more. simple: without muscle, vessels, marrow, shoulder blades and bowel.

    >>> import tempfile
    >>> from skiagraph import Scene
    >>> with tempfile.TemporaryDirectory() as folder, Scene(thorax(folder, 10000)) as scene:
    ...     scene.breathe(phase=0.5)["amplitude"] < 0.1
    True
    """
    os.makedirs(folder, exist_ok=True)
    options = struct("skg_thorax_options")
    fill(options, "skg_thorax_options", {"triangles": triangles, "simple": simple}, [], "option")
    made = make("skg_thorax_create", "skg_thorax", options)
    try:
        call("skg_thorax_save", made, encode(folder, "folder"))
    finally:
        release("skg_thorax", made)
    return os.path.join(os.fspath(folder), "thorax.json")
