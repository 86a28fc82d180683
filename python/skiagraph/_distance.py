"""Distances between surfaces. Private."""
from __future__ import annotations

from typing import Any

from . import _arrays
from ._library import as_dict, call, choice, struct
from ._progress import Progress, Watch
from .mesh import as_mesh


def distance(a: Any, b: Any, *, sampling: str = "surface", spacing: float = 0, progress: Progress = False) -> dict[str, Any]:
    """How far the surface of a mesh is from another one's: mean_mm, rms_mm, p95_mm, max_mm and max_position_mm.

    "back" has the same from the second to the first, which differs, and "hausdorff_mm" is the greater of both maxima.
    a, b: meshes, as of Scene.add. sampling: "surface", over the area, or "vertices". spacing: the largest side of the
    triangles that a sample of the surface stands for, mm; 0: such that there are about 200,000. progress: True, or
    a function of (done, of), for one direction after the other; if it returns False, or raises, the measurement is cancelled.

    >>> from skiagraph import Mesh
    >>> found = distance(Mesh.cube(10), Mesh.cube(12), sampling="vertices")
    >>> round(found["max_mm"], 6), round(found["back"]["max_mm"], 3)
    (1.0, 1.732)
    """
    meshes = as_mesh(a), as_mesh(b)
    options = struct("skg_distance_options")
    options.sampling = choice("distance_sampling", sampling, "sampling")
    options.spacing_mm = _arrays.real(spacing, "spacing")

    def measure(of: Any, to: Any) -> dict[str, Any]:
        found = struct("skg_distance")
        with Watch(progress, "samples") as options.progress:
            call("skg_distance_measure", of._handle, to._handle, options, found)
        return as_dict(found, "skg_distance")

    there, back = measure(*meshes), measure(*reversed(meshes))
    return {**there, "back": back, "hausdorff_mm": max(there["max_mm"], back["max_mm"])}
