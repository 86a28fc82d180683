"""Triangle meshes."""
from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._interface import ArgumentError
from ._library import call, encode, ffi, filled, integer, make, owned, string


class Mesh:
    """Vertices and triangles, whose numbering stays as it was given.

    vertices: [n, 3], float32 or float64, in units of unit_mm. faces: [m, 3], whole numbers from 0.

    >>> mesh = Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    >>> mesh.health["closed"], round(mesh.health["volume"], 6)
    (1, 0.166667)
    >>> Mesh.sphere(40, 64)
    <Mesh "sphere": 1986 vertices, 3968 triangles, closed>
    """

    def __init__(self, vertices: Any, faces: Any, *, unit_mm: float = 1, name: str = "mesh",
                 _context: Any = ffi.NULL) -> None:
        positions = _arrays.rows(vertices, "vertices", (np.float64, np.float32))
        corners = _arrays.rows(faces, "faces", (np.int32,))
        single = positions.dtype == np.float32
        create, element = ("skg_mesh_create_float", "float *") if single else ("skg_mesh_create", "double *")
        self._handle = owned("skg_mesh", make(create, "skg_mesh", _context, encode(name, "name"),
                                              *_strided(positions, element), *_strided(corners, "int32_t *"),
                                              float(unit_mm)))
        self._changed = False

    @classmethod
    def _of(cls, handle: Any) -> Mesh:
        """A mesh of an owned handle."""
        made = cls.__new__(cls)
        made._handle, made._changed = handle, False
        return made

    @classmethod
    def _made(cls, name: str, *arguments: Any) -> Mesh:
        return cls._of(owned("skg_mesh", make(name, "skg_mesh", *arguments)))

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, unit_mm: float = 1, _context: Any = ffi.NULL) -> Mesh:
        """Reads STL, PLY, OBJ and the other formats that the library reads; its numbers are in units of unit_mm."""
        return cls._made("skg_mesh_load", _context, encode(path, "path"), float(unit_mm))

    @classmethod
    def cube(cls, edge: float) -> Mesh:
        """A cube about the origin; edge in mm."""
        return cls._made("skg_mesh_create_cube", float(edge))

    @classmethod
    def cuboid(cls, x: float, y: float, z: float) -> Mesh:
        """A cuboid about the origin; edges in mm."""
        return cls._made("skg_mesh_create_cuboid", float(x), float(y), float(z))

    @classmethod
    def sphere(cls, radius: float, segments: int) -> Mesh:
        """A sphere about the origin; radius in mm."""
        return cls._made("skg_mesh_create_sphere", float(radius), int(segments))

    @classmethod
    def cylinder(cls, radius: float, height: float, segments: int) -> Mesh:
        """A cylinder about the origin along z; lengths in mm."""
        return cls._made("skg_mesh_create_cylinder", float(radius), float(height), int(segments))

    @classmethod
    def step_wedge(cls, x: float, y: float, z: float, steps: int) -> Mesh:
        """A step wedge about the origin, with steps along x up to the height z; lengths in mm."""
        return cls._made("skg_mesh_create_step_wedge", float(x), float(y), float(z), int(steps))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes an STL file, or PLY, which keeps every bit."""
        call("skg_mesh_save", self._handle, encode(path, "path"))

    @property
    def name(self) -> str:
        return string("skg_mesh_name_get", self._handle)

    def _counts(self) -> tuple[int, int]:
        counts = ffi.new("int64_t[2]")
        call("skg_mesh_count", self._handle, counts, counts + 1)
        return int(counts[0]), int(counts[1])

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Positions [n, 3] in mm, a copy. Assign an array to move the vertices: the next image shows it."""
        made = np.empty((self._counts()[0], 3))
        call("skg_mesh_positions_get", self._handle, ffi.cast("double *", ffi.from_buffer(made)), 0)
        made.flags.writeable = False
        return made

    @vertices.setter
    def vertices(self, value: Any) -> None:
        positions = _arrays.rows(value, "vertices", (np.float64,))
        if len(positions) != self._counts()[0]:
            raise ArgumentError(f"vertices has {_arrays.describe(positions)}; the mesh has {self._counts()[0]} vertices")
        self._place(positions)
        self._changed = True

    def _place(self, positions: NDArray[np.float64]) -> None:
        call("skg_mesh_positions_set", self._handle, *_strided(positions, "double *")[1:])

    @property
    def faces(self) -> NDArray[np.int32]:
        """Triangles [m, 3] as numbers of vertices, a copy."""
        made = np.empty((self._counts()[1], 3), dtype=np.int32)
        call("skg_mesh_triangles_get", self._handle, ffi.cast("int32_t *", ffi.from_buffer(made)), 0)
        made.flags.writeable = False
        return made

    @property
    def offsets(self) -> NDArray[np.float32]:
        """The library's own float offsets [n, 3] from `origin`, in mm, without a copy. Write there and call moved()."""
        data = ffi.new("float **")
        call("skg_mesh_offsets_get", self._handle, data, ffi.new("const double **"))
        count = self._counts()[0]
        keep = ffi.gc(data[0], lambda _pointer, mesh=self._handle: None)  # the array keeps the mesh
        return np.frombuffer(ffi.buffer(keep, 12 * count), dtype=np.float32).reshape(count, 3)

    @property
    def origin(self) -> NDArray[np.float64]:
        """The point from which offsets count, mm."""
        origin = ffi.new("const double **")
        call("skg_mesh_offsets_get", self._handle, ffi.new("float **"), origin)
        return np.array([origin[0][k] for k in range(3)])

    def moved(self) -> None:
        """Says that offsets were written."""
        self._changed = True
        call("skg_mesh_offsets_moved", self._handle)

    @property
    def version(self) -> int:
        """1 at first, one more whenever the vertices moved."""
        return integer("skg_mesh_version_get", self._handle)

    @property
    def health(self) -> dict[str, Any]:
        """Is it closed? Volume in mm3, area in mm2, bounds and more."""
        return filled("skg_mesh_health", "skg_mesh_health_get", self._handle)

    @property
    def nesting(self) -> dict[str, Any]:
        """How the components of a closed mesh lie in each other, and which of them face the wrong way."""
        return filled("skg_mesh_nesting", "skg_mesh_nesting_get", self._handle)

    def oriented(self) -> Mesh:
        """A mesh in which the components that face the wrong way are turned."""
        return Mesh._made("skg_mesh_create_oriented", ffi.NULL, self._handle)

    def __repr__(self) -> str:
        health = self.health
        state = "closed" if health["closed"] else f"leaky ({health['open_edges']} open edges)"
        return f'<Mesh "{self.name}": {health["vertices"]} vertices, {health["triangles"]} triangles, {state}>'

    def __reduce__(self) -> tuple[Any, ...]:
        return _remake, (self.vertices, self.faces, self.name)


def _remake(vertices: Any, faces: Any, name: str) -> Mesh:
    return Mesh(vertices, faces, name=name)


def _strided(array: NDArray[Any], kind: str) -> tuple[int, Any, int]:
    """The count of rows, where they are, and the elements from one to the next."""
    if not len(array):
        return 0, ffi.NULL, 0
    address = ffi.cast(kind, array.__array_interface__["data"][0])
    return len(array), address, max(array.strides[0] // array.itemsize, 3)


def as_mesh(value: Any, *, unit_mm: float = 1, name: str | None = None, _context: Any = ffi.NULL) -> Mesh:
    """A mesh of whatever has vertices and triangles.

    value: a Mesh; (vertices, faces); the path of a file; an object of trimesh (`vertices`, `faces`), of meshio
    (`points`, cells of the type "triangle") or of PyVista (`points`, `faces` with their counts).
    """
    if isinstance(value, Mesh):
        return value
    if isinstance(value, (str, os.PathLike)):
        return Mesh.load(value, unit_mm=unit_mm, _context=_context)
    vertices, faces = _parts_of(value)
    return Mesh(vertices, faces, unit_mm=unit_mm, name=name or "mesh", _context=_context)


def _parts_of(value: Any) -> tuple[Any, Any]:
    if isinstance(value, (tuple, list)) and len(value) == 2:
        return value[0], value[1]
    if hasattr(value, "vertices") and hasattr(value, "faces"):
        return value.vertices, value.faces
    if hasattr(value, "points") and hasattr(value, "cells_dict"):
        cells = value.cells_dict
        others = sorted(set(cells) - {"triangle", "vertex", "line"})
        if "triangle" not in cells or others:
            raise ArgumentError(f"the mesh has cells of the types {sorted(cells)}; give triangles")
        return value.points, cells["triangle"]
    if hasattr(value, "points") and hasattr(value, "faces"):
        return value.points, _without_counts(value.faces)
    raise ArgumentError(f"mesh is a {type(value).__name__}; give (vertices, faces), an object with vertices and faces, "
                        "or the path of a file")


def _without_counts(faces: Any) -> NDArray[Any]:
    """[3, a, b, c, 3, a, b, c, ...] as rows a, b, c."""
    array = _arrays.numbers(faces, "faces")
    if array.ndim == 2:
        return array
    if array.ndim != 1 or array.size % 4 or (array[::4] != 3).any():
        raise ArgumentError("faces are not triangles alone; call triangulate() first")
    return array.reshape(-1, 4)[:, 1:]
