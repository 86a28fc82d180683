"""Triangle meshes."""
from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._device import warn
from ._interface import ArgumentError
from ._library import call, doubles, encode, ffi, fill, filled, integer, make, owned, string, struct
from ._meshes import parts_of, unit_of


class Mesh:
    """Vertices and triangles, whose numbering stays as it was given.

    vertices: [n, 3], float32 or float64, in units of unit_mm. faces: [m, 3], whole numbers from 0. Triangles that are wound
    otherwise than their neighbours are turned, with a warning; as_wound=True leaves them.

    >>> mesh = Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    >>> mesh.health["closed"], round(mesh.health["volume"], 6)
    (1, 0.166667)
    >>> Mesh.sphere(40, 64)
    <Mesh "sphere": 1986 vertices, 3968 triangles, closed>
    """

    def __init__(self, vertices: Any, faces: Any, *, unit_mm: float = 1, name: str = "mesh",
                 as_wound: bool = False, _context: Any = ffi.NULL) -> None:
        positions = _arrays.rows(vertices, "vertices", (np.float64, np.float32))
        corners = _arrays.rows(faces, "faces", (np.int32,))
        source = struct("skg_mesh_source")
        source.vertices, address, source.position_stride = _strided(positions)
        if positions.dtype == np.float32:
            source.floats = ffi.cast("float *", address)
        else:
            source.positions = ffi.cast("double *", address)
        source.triangles, address, source.triangle_stride = _strided(corners)
        source.corners = ffi.cast("int32_t *", address)
        source.unit_mm = _arrays.real(unit_mm, "unit_mm")
        source.as_wound = bool(as_wound)
        self._handle = owned("skg_mesh", make("skg_mesh_create", "skg_mesh", _context, encode(name, "name"), source))
        self._changed = False
        if _context == ffi.NULL:
            self._say_turned()

    def _say_turned(self) -> None:
        """Warns of what a mesh that is made without a device cannot log."""
        health = self.health
        if health["turned"]:
            near = ", ".join(f"{x:.4g}" for x in health["first_turned_position"])
            warn(f"{self.name}: wound inconsistently; {health['turned']} of {health['triangles']} triangles were turned, first "
                 f"number {health['first_turned']} near ({near}) mm")

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
    def load(cls, path: str | os.PathLike[str], *, unit_mm: float | None = None, group: str | None = None,
             as_wound: bool = False, _context: Any = ffi.NULL) -> Mesh:
        """Reads STL, PLY, OBJ, 3MF and the other formats that the library reads.

        unit_mm: mm per unit of its numbers; None: the unit that the file or its format names, otherwise mm. group: only the
        group or object of this name.
        """
        if unit_mm is not None and not _arrays.real(unit_mm, "unit_mm") > 0:
            raise ArgumentError(f"unit_mm is {unit_mm}; give a number above 0, or None for the file's own unit")
        reading = struct("skg_mesh_reading")
        reading.unit_mm, reading.as_wound = float(unit_mm or 0), bool(as_wound)
        named = ffi.NULL if group is None else ffi.new("char[]", encode(group, "group"))
        reading.group = named
        made = cls._made("skg_mesh_load_as", _context, encode(path, "path"), reading)
        if _context == ffi.NULL:
            made._say_turned()
        return made

    @classmethod
    def from_object(cls, value: Any, *, unit_mm: float | None = None, name: str = "mesh") -> Mesh:
        """A mesh of an object of trimesh (also a Scene), Open3D, PyVista or meshio, in units of unit_mm.

        unit_mm: mm per unit of its numbers; None: what the `units` of an object of trimesh name, otherwise mm. Quads are halved; of
        volume cells the skin is taken, beside triangles and quads that are no face of one. Points of meshio that no triangle has
        are left out.
        """
        vertices, faces = parts_of(value)
        return cls(vertices, faces, unit_mm=unit_of(value) if unit_mm is None else unit_mm, name=name)

    @classmethod
    def from_meshio(cls, mesh: Any, *, unit_mm: float | None = None, name: str | None = None) -> Mesh:
        """A mesh of a file that meshio reads (.vtk, .vtu, .msh, .inp, ...), or of its meshio.Mesh, as from_object()."""
        if isinstance(mesh, (str, os.PathLike)):
            try:
                import meshio
            except ImportError as failure:
                raise ArgumentError(f"{os.fspath(mesh)}: reading it needs the package meshio (pip install meshio)") from failure
            name, mesh = name or os.path.basename(mesh), meshio.read(mesh)
        return cls.from_object(mesh, unit_mm=unit_mm, name=name or "mesh")

    @classmethod
    def cube(cls, edge: float) -> Mesh:
        """A cube about the origin; edge in mm."""
        return cls._made("skg_mesh_create_cube", _arrays.real(edge, "edge"))

    @classmethod
    def cuboid(cls, x: float, y: float, z: float) -> Mesh:
        """A cuboid about the origin; edges in mm."""
        return cls._made("skg_mesh_create_cuboid", *_arrays.reals(x=x, y=y, z=z))

    @classmethod
    def sphere(cls, radius: float, segments: int) -> Mesh:
        """A sphere about the origin; radius in mm."""
        return cls._made("skg_mesh_create_sphere", _arrays.real(radius, "radius"), _arrays.whole(segments, "segments"))

    @classmethod
    def cylinder(cls, radius: float, height: float, segments: int) -> Mesh:
        """A cylinder about the origin along z; lengths in mm."""
        return cls._made("skg_mesh_create_cylinder", *_arrays.reals(radius=radius, height=height), _arrays.whole(segments, "segments"))

    @classmethod
    def step_wedge(cls, x: float, y: float, z: float, steps: int) -> Mesh:
        """A step wedge about the origin, with steps along x up to the height z; lengths in mm."""
        return cls._made("skg_mesh_create_step_wedge", *_arrays.reals(x=x, y=y, z=z), _arrays.whole(steps, "steps"))

    @classmethod
    def steps(cls, x: float, y: float, heights: Any) -> Mesh:
        """A step wedge about the origin, with steps along x of these heights, which rise; lengths in mm.

        >>> Mesh.steps(30, 10, [1, 5, 7]).health["bounds"]
        (-15.0, -5.0, -3.5, 15.0, 5.0, 3.5)
        """
        keep: list[Any] = []
        wanted = np.atleast_1d(_arrays.numbers(heights, "heights"))
        if wanted.ndim != 1:
            raise ArgumentError(f"heights has {_arrays.describe(wanted)}; give a list of heights")
        return cls._made("skg_mesh_create_steps", *_arrays.reals(x=x, y=y), len(wanted), doubles(wanted, "heights", keep))

    @classmethod
    def spheres(cls, centres: Any, radii: Any, segments: int = 12) -> Mesh:
        """Spheres as one mesh: centres [n, 3] and radii [n], or one for all, in mm."""
        keep: list[Any] = []
        places = _arrays.rows(centres, "centres", (np.float64,))
        sizes = np.broadcast_to(_arrays.numbers(radii, "radii"), (len(places),))
        return cls._made("skg_mesh_create_spheres", len(places), doubles(places, "centres", keep),
                         doubles(sizes, "radii", keep), _arrays.whole(segments, "segments"))

    @classmethod
    def _of_struct(cls, kind: str, maker: str, fields: dict[str, Any], what: str) -> Mesh:
        given = {name: value for name, value in fields.items() if value is not None}
        return cls._made(maker, fill(struct(kind), kind, given, [], what))

    @classmethod
    def foam(cls, box: Any, radius: float, fraction: float | None = None, *, spread: float | None = None,
             gap: float | None = None, count: int | None = None, seed: int | None = None, segments: int | None = None) -> Mesh:
        """Spheres in a box that do not overlap: the pores of a foam, or grains. The same seed gives the same.

        box: (x, y, z) in mm. radius: mean, mm. fraction: the share of the box that they fill, 0.1 by default, or count:
        their number. spread: standard deviation of the radius as a share of it. gap: least distance, mm.

        >>> Mesh.foam((20, 20, 20), 2, 0.2, seed=1)
        <Mesh "spheres": 2976 vertices, 5760 triangles, closed>
        """
        return cls._of_struct("skg_foam", "skg_mesh_create_foam", {
            "box": box, "radius_mm": radius, "fraction": fraction, "spread": spread, "gap_mm": gap, "count": count,
            "seed": seed, "segments": segments}, "the parameter of a foam")

    @classmethod
    def fibres(cls, box: Any, radius: float, count: int, *, tilt: float | None = None, gap: float | None = None,
               seed: int | None = None, segments: int | None = None) -> Mesh:
        """Straight fibres through a box that do not touch, from its lower to its upper face across z.

        box: (x, y, z) in mm. tilt: greatest angle to z, degrees. gap: least distance, mm.

        >>> Mesh.fibres((20, 20, 10), 0.5, 30, tilt=20).health["components"]
        30
        """
        return cls._of_struct("skg_fibres", "skg_mesh_create_fibres", {
            "box": box, "radius_mm": radius, "count": count, "tilt_deg": tilt, "gap_mm": gap, "seed": seed,
            "segments": segments}, "the parameter of fibres")

    @classmethod
    def isosurface(cls, values: Any, level: float, spacing: Any = 1.0) -> Mesh:
        """The surface of a volume where it crosses a level, about the origin; what is at or above it is inside.

        values: [z, y, x]. spacing: mm from one value to the next, or (x, y, z). Beyond the volume nothing is inside.

        >>> z, y, x = np.mgrid[-10:11, -10:11, -10:11]
        >>> ball = Mesh.isosurface(8 - np.sqrt(x ** 2 + y ** 2 + z ** 2), 0)
        >>> ball.health["closed"], round(ball.health["volume"] / (4 / 3 * np.pi * 8 ** 3), 1)
        (1, 1.0)
        """
        keep: list[Any] = []
        volume = np.ascontiguousarray(_arrays.numbers(values, "values"), dtype=np.float32)
        if volume.ndim != 3:
            raise ArgumentError(f"values has {_arrays.describe(volume)}; give [z, y, x]")
        steps = _three(spacing, "spacing")
        return cls._made("skg_mesh_create_isosurface", ffi.new("int64_t[3]", list(volume.shape[::-1])),
                         doubles(steps, "spacing", keep), ffi.cast("float *", ffi.from_buffer(volume)), _arrays.real(level, "level"))

    @classmethod
    def gyroid(cls, box: Any, period: float, level: float = 0.3, cells: int = 0) -> Mesh:
        """A sheet of a gyroid in a box: where abs(sin x cos y + sin y cos z + sin z cos x) is below level.

        box: (x, y, z) in mm. period: mm. cells: of the grid along a period, at least 3 pi / level, so that the sheet has no holes of its own;
        0: so many, and at least 24.
        """
        keep: list[Any] = []
        return cls._made("skg_mesh_create_gyroid", doubles(_three(box, "box"), "box", keep),
                         *_arrays.reals(period=period, level=level), _arrays.whole(cells, "cells"))

    @classmethod
    def line_pairs(cls, per_mm: Any, bars: int, length: float, thickness: float) -> Mesh:
        """Groups of bars side by side along x, one group for each number of line pairs per mm; lengths in mm."""
        keep: list[Any] = []
        wanted = np.atleast_1d(_arrays.numbers(per_mm, "per_mm"))
        return cls._made("skg_mesh_create_line_pairs", len(wanted), doubles(wanted, "per_mm", keep),
                         _arrays.whole(bars, "bars"), *_arrays.reals(length=length, thickness=thickness))

    @classmethod
    def star(cls, radius: float, inner: float, spokes: int, thickness: float) -> Mesh:
        """A Siemens star about z, of spokes that are as wide as the spaces between them; lengths in mm."""
        return cls._made("skg_mesh_create_star", *_arrays.reals(radius=radius, inner=inner), _arrays.whole(spokes, "spokes"),
                         _arrays.real(thickness, "thickness"))

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
        """Positions [n, 3] in mm, a copy. Assign an array to move the vertices: the next image shows it. A closed mesh that this mirrors is
        turned outward, as one whose pose mirrors it.

        >>> mesh = Mesh.cube(2)
        >>> mesh.vertices = mesh.vertices * (-1, 1, 1)
        >>> round(mesh.health["volume"], 6)
        8.0
        """
        made = np.empty((self._counts()[0], 3))
        call("skg_mesh_positions_get", self._handle, ffi.cast("double *", ffi.from_buffer(made)), 0)
        return _arrays.fixed(made)

    @vertices.setter
    def vertices(self, value: Any) -> None:
        positions = _arrays.rows(value, "vertices", (np.float64,))
        if len(positions) != self._counts()[0]:
            raise ArgumentError(f"vertices has {_arrays.describe(positions)}; the mesh has {self._counts()[0]} vertices")
        self._place(positions)
        self._changed = True

    def _place(self, positions: NDArray[np.float64]) -> None:
        call("skg_mesh_positions_set", self._handle, *_strided(positions)[1:])

    @property
    def faces(self) -> NDArray[np.int32]:
        """Triangles [m, 3] as numbers of vertices, a copy."""
        made = np.empty((self._counts()[1], 3), dtype=np.int32)
        call("skg_mesh_triangles_get", self._handle, ffi.cast("int32_t *", ffi.from_buffer(made)), 0)
        return _arrays.fixed(made)

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
        return _arrays.fixed(np.array([origin[0][k] for k in range(3)]))

    def moved(self) -> None:
        """Says that offsets were written. As with `vertices`, a closed mesh that they mirror is turned outward."""
        self._changed = True
        call("skg_mesh_offsets_moved", self._handle)
        health = struct("skg_mesh_health")
        call("skg_mesh_health_get", self._handle, health)
        if health.closed and health.volume < 0:
            self._place(self.vertices)

    @property
    def version(self) -> int:
        """1 at first, one more whenever the vertices moved."""
        return integer("skg_mesh_version_get", self._handle)

    @property
    def health(self) -> dict[str, Any]:
        """Is it closed? Volume in mm3, area in mm2, bounds and more."""
        return filled("skg_mesh_health", "skg_mesh_health_get", self._handle)

    @property
    def unit(self) -> dict[str, Any]:
        """The unit of the numbers that the mesh was made of: its name, "mm" per unit, and "from": 0 assumed, 1 the file, 2 named."""
        return filled("skg_mesh_unit", "skg_mesh_unit_get", self._handle)

    @property
    def groups(self) -> list[str]:
        """Names of the groups and objects of the file, in its order, each once."""
        name = ffi.new("const char **")
        found: dict[str, None] = {}
        for number in range(integer("skg_mesh_group_count", self._handle)):
            call("skg_mesh_group_get", self._handle, number, name, ffi.NULL, ffi.NULL)
            if name[0] != ffi.NULL:
                found[ffi.string(name[0]).decode(errors="replace")] = None
        return list(found)

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
    return Mesh(vertices, faces, name=name, as_wound=True)  # they were turned when it was made


def _three(value: Any, what: str) -> NDArray[np.float64]:
    """Three numbers, or one for all of them."""
    given = _arrays.numbers(value, what)
    if given.shape not in ((), (1,), (3,)):
        raise ArgumentError(f"{what} has {_arrays.describe(given)}; give one number, or (x, y, z)")
    return np.broadcast_to(given, (3,)).astype(np.float64)


def _strided(array: NDArray[Any]) -> tuple[int, Any, int]:
    """The count of rows, where they are, and the elements from one to the next."""
    if not len(array):
        return 0, ffi.NULL, 0
    address = ffi.cast("void *", array.__array_interface__["data"][0])
    return len(array), address, max(array.strides[0] // array.itemsize, 3)


def as_mesh(value: Any, *, unit_mm: float | None = None, name: str | None = None, as_wound: bool = False,
            _context: Any = ffi.NULL) -> Mesh:
    """A mesh of whatever has vertices and triangles.

    value: a Mesh, which stays as it is; (vertices, faces); the path of a file; an object of trimesh (also a Scene), Open3D, meshio or PyVista.
    """
    if isinstance(value, Mesh):
        return value
    if isinstance(value, (str, os.PathLike)):
        return Mesh.load(value, unit_mm=unit_mm, as_wound=as_wound, _context=_context)
    vertices, faces = parts_of(value)
    return Mesh(vertices, faces, unit_mm=unit_of(value) if unit_mm is None else unit_mm, name=name or "mesh", as_wound=as_wound,
                _context=_context)
