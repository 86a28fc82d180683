"""Vertices and triangles of the objects of other packages. Private."""
from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._device import warn
from ._interface import ArgumentError, FormatError
from ._library import call, encode, ffi

#: Corners of a cell of VTK, and the faces of a volume cell in the order in which they face outward.
_FACES: dict[str, list[tuple[int, ...]]] = {
    "tetra": [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)],
    "hexahedron": [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
    "wedge": [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
    "pyramid": [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]}
_CORNERS = {"triangle": 3, "quad": 4, "tetra": 4, "hexahedron": 8, "wedge": 6, "pyramid": 5}
_NO_FACES = {"vertex", "line", "line3"}


def parts_of(value: Any) -> tuple[Any, Any]:
    """(vertices, faces) of a pair, or of an object of trimesh, Open3D, meshio or PyVista."""
    if isinstance(value, (tuple, list)) and len(value) == 2:
        return value[0], value[1]
    if hasattr(value, "geometry") and hasattr(value, "dump"):  # trimesh.Scene: every geometry where its nodes place it
        value = value.dump(concatenate=True)
    if hasattr(value, "vertices") and hasattr(value, "faces"):
        return value.vertices, value.faces
    if hasattr(value, "vertices") and hasattr(value, "triangles"):  # Open3D
        return np.asarray(value.vertices), np.asarray(value.triangles)
    if hasattr(value, "points") and hasattr(value, "cells_dict"):  # meshio, and grids of PyVista have both
        if not hasattr(value, "extract_surface"):
            return _used(np.asarray(value.points), triangles_of(value.cells_dict))
    if hasattr(value, "points") and hasattr(value, "extract_surface"):  # PyVista
        surface = value if hasattr(value, "faces") and not hasattr(value, "cells") else value.extract_surface()
        if hasattr(surface, "triangulate") and not _is_triangles(surface.faces):
            surface = surface.triangulate()
        return surface.points, _without_counts(surface.faces)
    if hasattr(value, "points") and hasattr(value, "faces"):
        return value.points, _without_counts(value.faces)
    raise ArgumentError(f"mesh is a {type(value).__name__}; give (vertices, faces), an object with vertices and faces, "
                        "or the path of a file")


def unit_of(value: Any) -> float:
    """The mm in the unit that an object of trimesh names in its plural ("meters", "inches"); 1 without one."""
    units = getattr(value, "units", None)
    if not isinstance(units, str) or not units.strip():
        return 1
    mm = ffi.new("double *")
    for name in (units.strip(), units.strip().removesuffix("s")):
        try:
            call("skg_length_unit_get", encode(name, "units"), mm)
            return float(mm[0])
        except FormatError:
            continue
    warn(f"the units {units!r} of the mesh are no unit of length; its numbers are taken for mm; unit_mm says what they are")
    return 1


def triangles_of(cells: Any) -> NDArray[Any]:
    """Triangles of the cells of meshio: the skin of volume cells, and triangles and halved quads that are no face of one."""
    plain: dict[str, NDArray[Any]] = {}
    for kind, rows in cells.items():
        if kind in _NO_FACES:
            continue
        name = kind.rstrip("0123456789")
        if name not in _CORNERS:
            raise ArgumentError(f"the mesh has cells of the type {kind}; give triangles, quads, or tetra, hexahedron, wedge and pyramid")
        corners = np.asarray(rows)[:, :_CORNERS[name]]
        if np.shape(rows)[1] > _CORNERS[name]:
            warn(f"cells of the type {kind} are taken with straight edges, by their corners")
        plain[name] = np.concatenate([plain[name], corners]) if name in plain else corners
    volumes = {name: rows for name, rows in plain.items() if name in _FACES}
    flat = [plain[name] for name in ("triangle", "quad") if name in plain]
    faces = _skin(volumes) + [_apart(rows, volumes) for rows in flat] if volumes else flat
    if not faces:
        raise ArgumentError("the mesh has no triangles, quads or volume cells")
    return np.concatenate([part for rows in faces for part in _halves(rows)])


def _used(points: NDArray[Any], faces: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Without the points that no triangle has, such as those inside volume cells: they would widen the bounds."""
    used, numbers = np.unique(faces, return_inverse=True)
    if used.size == len(points) or used[0] < 0 or used[-1] >= len(points):
        return points, faces
    return points[used], numbers.reshape(faces.shape)


def _apart(rows: NDArray[Any], volumes: dict[str, NDArray[Any]]) -> NDArray[Any]:
    """Of triangles or quads those that are no face of a volume cell, nor half of one."""
    corners = rows.shape[1]
    found = [rows[:0]]
    for name, cells in volumes.items():
        for face in _FACES[name]:
            found += [cells[:, list(part)] for part in combinations(face, corners)]
    faces = np.sort(np.concatenate(found), axis=1)
    every = np.concatenate([np.unique(faces, axis=0), np.sort(rows, axis=1)])
    _, first, inverse = np.unique(every, axis=0, return_index=True, return_inverse=True)
    own = len(every) - len(rows)
    return rows[first[inverse.ravel()[own:]] >= own]


def _halves(rows: NDArray[Any]) -> list[NDArray[Any]]:
    return [rows] if rows.shape[1] == 3 else [rows[:, [0, 1, 2]], rows[:, [0, 2, 3]]]


def _skin(volumes: dict[str, NDArray[Any]]) -> list[NDArray[Any]]:
    """Faces that belong to one cell only, by their number of corners."""
    found = []
    for corners in (3, 4):
        rows = [cells[:, list(face)] for name, cells in volumes.items() for face in _FACES[name] if len(face) == corners]
        if not rows:
            continue
        every = np.concatenate(rows)
        _, inverse, count = np.unique(np.sort(every, axis=1), axis=0, return_inverse=True, return_counts=True)
        found.append(every[count[inverse.ravel()] == 1])
    return found


def _is_triangles(faces: Any) -> bool:
    array = np.asarray(faces)
    return array.ndim == 2 or (array.size % 4 == 0 and bool((array[::4] == 3).all()))


def _without_counts(faces: Any) -> NDArray[Any]:
    """[3, a, b, c, 3, a, b, c, ...] as rows a, b, c."""
    array = _arrays.numbers(faces, "faces")
    if array.ndim == 2:
        return array
    if array.ndim != 1 or not _is_triangles(array):
        raise ArgumentError("faces are not triangles alone; call triangulate() first")
    return array.reshape(-1, 4)[:, 1:]
