"""One mesh cut out of another. Private.

A mesh that is turned inside out counts negative in the sum of signed distances. So what a source has inside a destination is
clipped from it, turned, and added to the destination.
"""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import ArgumentError

_Vertices = NDArray[np.float64]
_Faces = NDArray[Any]
#: Of the size of a mesh: vertices as close as this to a plane lie on it.
CLOSE = 1e-9


def welded(vertices: _Vertices, faces: _Faces) -> tuple[_Vertices, _Faces]:
    """One vertex for each place."""
    places, which = np.unique(vertices, axis=0, return_inverse=True)
    return places, np.asarray(which).reshape(-1)[faces]


def components(vertices: _Vertices, faces: _Faces) -> list[tuple[_Vertices, _Faces]]:
    """The meshes that share no vertex, of a welded one."""
    label = np.arange(len(vertices))
    while True:
        least = label[faces].min(axis=1)
        new = label.copy()
        for k in range(3):
            np.minimum.at(new, faces[:, k], least)
        new = new[new]
        if (new == label).all():
            break
        label = new
    found = []
    for one in np.unique(label[faces[:, 0]]):
        own = faces[label[faces[:, 0]] == one]
        used, which = np.unique(own, return_inverse=True)
        found.append((vertices[used], np.asarray(which).reshape(-1, 3)))
    return found


def planes(vertices: _Vertices, faces: _Faces) -> tuple[_Vertices, _Vertices, bool]:
    """Outward normals and offsets of the faces of a mesh, and whether it is convex."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    size = float(np.ptp(vertices, axis=0).max())
    flat = lengths > 1e-12 * size ** 2
    normals = normals[flat] / lengths[flat, None]
    offsets = np.einsum("ij,ij->i", normals, a[flat])
    rounded = np.round(np.column_stack([normals, offsets / size]), 9)
    first = np.unique(rounded, axis=0, return_index=True)[1]
    normals, offsets = normals[first], offsets[first]
    convex = bool((vertices @ normals.T - offsets <= 1e-6 * size).all())
    return normals, offsets, convex


def _cut(sides: NDArray[np.float64], faces: _Faces, vertices: list[_Vertices]) -> list[list[int]]:
    """The triangles behind the plane; new vertices go to the end."""
    made: dict[tuple[int, int], int] = {}
    kept: list[list[int]] = []
    for face in faces.tolist():
        if max(sides[i] for i in face) > 0 and min(sides[i] for i in face) >= 0:
            continue  # before the plane; one that lies in it stays
        polygon: list[int] = []
        for i, j in zip(face, face[1:] + face[:1]):
            if sides[i] <= 0:
                polygon.append(i)
            if sides[i] * sides[j] < 0:
                low, high = min(i, j), max(i, j)  # the same place from both triangles of the edge
                if (low, high) not in made:
                    share = sides[low] / (sides[low] - sides[high])
                    made[low, high] = len(vertices)
                    vertices.append(vertices[low] + share * (vertices[high] - vertices[low]))
                polygon.append(made[low, high])
        kept += [[polygon[0], polygon[k], polygon[k + 1]] for k in range(1, len(polygon) - 1)]
    return kept


def _capped(kept: list[list[int]]) -> list[list[int]]:
    """Closed again by triangles from one corner of the hole: where they overlap, their signs cancel."""
    edges = {(f[k], f[(k + 1) % 3]) for f in kept for k in range(3)}
    rim = [(i, j) for i, j in edges if (j, i) not in edges]
    if rim:
        corner = min(rim)[0]
        kept = kept + [[j, i, corner] for i, j in sorted(rim) if corner not in (i, j)]
    return kept


def clipped(vertices: _Vertices, faces: _Faces, normals: _Vertices, offsets: _Vertices, size: float) -> tuple[_Vertices, _Faces]:
    """The part of a closed mesh behind all these planes, closed."""
    for normal, offset in zip(normals, offsets):
        if not len(faces):
            break
        sides = vertices @ normal - offset
        sides[np.abs(sides) <= CLOSE * size] = 0
        if (sides <= 0).all():
            continue
        places = list(vertices)
        kept = _capped(_cut(sides, faces, places))
        used, which = np.unique(np.array(kept, np.int64).reshape(-1, 3), return_inverse=True)
        vertices, faces = np.array(places)[used], np.asarray(which).reshape(-1, 3)
    return vertices, faces


def subtracted(destination: tuple[_Vertices, _Faces], solid: tuple[_Vertices, _Faces], source: tuple[_Vertices, _Faces],
               label: str) -> tuple[_Vertices, _Faces]:
    """destination, which was cut out of solid, without what source has in solid. The pieces of solid have to be convex."""
    cutters = components(*welded(*source))
    vertices, faces = [destination[0]], [np.asarray(destination[1], np.int64)]
    count = len(destination[0])
    for piece in components(*welded(*solid)):
        normals, offsets, convex = planes(*piece)
        size = float(np.ptp(piece[0], axis=0).max())
        for cutter in cutters:
            if (cutter[0].min(0) > piece[0].max(0)).any() or (cutter[0].max(0) < piece[0].min(0)).any():
                continue
            if not convex:
                raise ArgumentError(f"{label}: is not convex, so that nothing can be subtracted from it; add what is to be "
                                    f"subtracted as an inner surface and {label!r} as the outer one, which it displaces")
            inside, triangles = clipped(*cutter, normals, offsets, size)
            if len(triangles):
                vertices.append(inside)
                faces.append(triangles[:, ::-1] + count)
                count += len(inside)
    return np.concatenate(vertices), np.concatenate(faces)
