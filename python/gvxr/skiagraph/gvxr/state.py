"""State that the calls set: a graph of meshes, a source and a detector, and the scene that they make. Private.

Lengths are in mm, energies in keV, matrices act on columns.
"""
from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import ArgumentError, SceneError
from ..beam import Beam, Response
from ..material import Material, element_symbol
from ..matrices import translate
from ..mesh import Mesh
from ..scene import Scene
from ..view import View

LENGTHS = {"um": 1e-3, "micrometre": 1e-3, "micrometer": 1e-3, "mm": 1.0, "millimetre": 1.0, "millimeter": 1.0,
           "cm": 10.0, "centimetre": 10.0, "centimeter": 10.0, "dm": 100.0, "decimetre": 100.0, "decimeter": 100.0,
           "m": 1e3, "metre": 1e3, "meter": 1e3, "dam": 1e4, "decametre": 1e4, "decameter": 1e4, "hm": 1e5,
           "hectometre": 1e5, "hectometer": 1e5, "km": 1e6, "kilometre": 1e6, "kilometer": 1e6}
ENERGIES = {"eV": 1e-3, "electronvolt": 1e-3, "keV": 1.0, "kiloelectronvolt": 1.0, "MeV": 1e3, "megaelectronvolt": 1e3}
VOLTAGES = {"V": 1e-3, "volt": 1e-3, "kV": 1.0, "kilovolt": 1.0, "MV": 1e3, "megavolt": 1e3}
DENSITIES = {"g/cm3": 1.0, "g.cm-3": 1.0, "mg/cm3": 1e-3, "mg.cm-3": 1e-3, "kg/m3": 1e-3, "kg.m-3": 1e-3}


def unit(name: str, table: dict[str, float]) -> float:
    if name not in table:
        raise ArgumentError(f"the unit {name!r} is unknown; there are {', '.join(table)}")
    return table[name]


@dataclass
class Node:
    """A node of the scene graph."""

    parent: str
    mesh: Mesh | None = None
    matrix: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    #: "inner", "outer" or "": not in the X-ray renderer.
    surface: str = ""
    material: Material | None = None
    #: How the material was given, "Element: Fe".
    description: str = ""
    #: The file of the mesh and its unit.
    file: str = ""
    unit: str = "N/A"
    inverted: bool = False
    #: ambient, diffuse, specular: red, green, blue, opacity; and shininess.
    colours: dict[str, tuple[float, ...]] = field(default_factory=dict)
    shininess: float = 50.0
    #: A mesh from which others were subtracted, and what it was before.
    cut: tuple[Mesh, Mesh] | None = None


@dataclass
class World:
    nodes: dict[str, Node] = field(default_factory=lambda: {"root": Node("")})
    scene_matrix: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    source: tuple[float, float, float] = (0, 0, 0)
    shape: Any = "PointSource"
    grid: int = 0
    detector: tuple[float, float, float] = (0, 0, 0)
    up: tuple[float, float, float] = (0, 0, 1)
    right: tuple[float, float, float] | None = None
    pixels: tuple[int, int] = (0, 0)
    spacing: tuple[float, float] | None = None
    size: tuple[float, float] | None = None
    #: keV -> photons per pixel, or per cm2 at 1 m
    spectrum: dict[float, float] = field(default_factory=dict)
    per_cm2: bool = False
    #: kVp, angle and load of a tube, the width of its bins and the least energy, keV, and a factor on its photons.
    tube: dict[str, float] = field(default_factory=dict)
    #: Materials, as they were named, and mm.
    filters: list[tuple[int | str, float]] = field(default_factory=list)
    inherent: list[tuple[int | str, float]] = field(default_factory=list)
    #: Keys of the detector in a scene file: blur, oversampling.
    detector_keys: dict[str, Any] = field(default_factory=dict)
    response: Response | None = None
    #: The scintillator of the response, ("CsI", 0.6 mm), or rows of keV and keV.
    scintillator: tuple[str, float] | None = None
    response_rows: NDArray[np.float64] | None = None
    bands: list[float] | None = None
    noise: bool = False
    #: Of the images that are read out, ...WithGain; and how many of them had a noise of the bias.
    gain: float = 1.0
    bias: float = 0.0
    bias_deviation: float = 0.0
    readouts: int = 0
    seed: int = 0
    frame: int = 0
    images: dict[str, Any] = field(default_factory=dict)
    #: Arguments and views of the last scan.
    scan: dict[str, Any] = field(default_factory=dict)
    #: What concerns pictures of the scene: window, zoom, rotation, background.
    look: dict[str, Any] = field(default_factory=dict)
    #: A scene file that was loaded, and source, detector and beam as they were then.
    file: str = ""
    loaded: str = ""
    loaded_spectrum: dict[float, float] = field(default_factory=dict)
    loaded_meshes: dict[str, Mesh] = field(default_factory=dict)
    _scene: Scene | None = None
    _made_of: Any = None

    def node(self, label: str) -> Node:
        if label not in self.nodes:
            raise SceneError(f"there is no mesh {label!r}; there are {', '.join(map(repr, list(self.nodes)[1:])) or 'none'}")
        return self.nodes[label]

    def mesh(self, label: str) -> Mesh:
        mesh = self.node(label).mesh
        if mesh is None:
            raise SceneError(f"the node {label!r} has no mesh")
        return mesh

    def add(self, label: str, mesh: Mesh | None, parent: str) -> Node:
        """A node; one that has the label already gets the mesh and stands where it was made."""
        self.node(parent)
        if label in self.nodes and label in self.above(parent):
            raise SceneError(f"{label!r} cannot lie below {parent!r}, which is itself or lies below it; give another label")
        old = self.nodes.get(label)
        made = Node(parent, mesh)
        if old is not None:
            made.surface, made.material, made.description = old.surface, old.material, old.description
        self.nodes[label] = made
        return made

    def above(self, label: str) -> Iterator[str]:
        """The node and those that it lies below."""
        while label:
            yield label
            label = self.nodes[label].parent

    def children(self, label: str) -> list[str]:
        return [name for name, node in self.nodes.items() if node.parent == label]

    def below(self, label: str) -> Iterator[str]:
        """The node and all below it."""
        self.node(label)
        yield label
        for child in self.children(label):
            yield from self.below(child)

    def world_matrix(self, label: str) -> NDArray[np.float64]:
        """From the mesh to the world, without the transformation of the scene."""
        node = self.node(label)
        return node.matrix if not node.parent else self.world_matrix(node.parent) @ node.matrix

    def bounds(self, labels: Iterator[str]) -> NDArray[np.float64]:
        """Least and greatest x, y, z of these nodes in the world, mm."""
        found = []
        for label in labels:
            mesh = self.node(label).mesh
            if mesh is not None:
                found += _box(mesh, self.world_matrix(label))
        if not found:
            raise SceneError("there is no mesh to bound")
        return np.concatenate([np.min(found, 0), np.max(found, 0)])

    # The scene

    def geometry(self) -> dict[str, Any]:
        """Source and detector as a scene file has them, with a beam that is replaced."""
        source: dict[str, Any] = {"Position": [*self.source, "mm"], "Shape": self.shape, "Beam": {"Bins": [[60, 1]]}}
        if self.grid:
            source["Grid"] = self.grid
        up, right = self.up, self.right
        detector = {"Position": [*self.detector, "mm"], "UpVector": list(up), "NumberOfPixels": list(self.pixels),
                    **self.detector_keys}
        if right:
            detector["RightVector"] = list(right)
        if self.size:
            detector["Size"] = [*self.size, "mm"]
        elif self.spacing:
            detector["Spacing"] = [*self.spacing, "mm"]
        else:
            raise SceneError("the detector has no size; call setDetectorPixelSize")
        return {"Source": source, "Detector": detector}

    def has_beam(self) -> bool:
        return bool(self.spectrum or "kVp" in self.tube)

    def beam(self, filtered: bool = True) -> Beam:
        """The beam, in photons per pixel or absolute. What is inherent to the tube is there without the filters, too."""
        layers: dict[Material, float] = {}
        for name, mm in [*self.inherent, *(self.filters if filtered else [])]:
            material = material_of(name)
            layers[material] = layers.get(material, 0.0) + mm
        if not self.spectrum and "kVp" in self.tube:
            beam = Beam.tube(self.tube["kVp"], layers, target_angle=self.tube.get("TubeAngle"),
                             mas=self.tube["mAs"] if self.tube.get("mAs", 0) > 0 else None,
                             bin_kev=self.tube.get("bin_kev"))
            kept = beam.energies >= self.tube.get("first_kev", 0)
            if not kept.all():
                beam = Beam(beam.energies[kept], beam.photons[kept], beam.absolute)
            return beam.scaled(self.tube.get("factor", 1.0))
        bins = self.spectrum or {60.0: 1.0}  # path lengths need no beam
        beam = Beam(sorted(bins), [bins[kev] for kev in sorted(bins)])
        for material, mm in layers.items():
            beam = beam.filtered({material: mm})
        return beam.scaled(self.pixel_share()) if self.per_cm2 else beam

    def pixel_share(self) -> float:
        """Photons of a pixel at the foot of the perpendicular, for one per cm2 at 1 m."""
        view = self.view()
        area = float(np.linalg.norm(np.cross(view.column_step, view.row_step)))
        return area / 100 * (1000 / float(np.linalg.norm(view.detector - view.source))) ** 2

    def view(self) -> View:
        """Source and detector."""
        return Scene(self.geometry()).view

    def scene(self, needs_beam: bool = True) -> Scene:
        """The scene as it stands. It is made anew only if more than poses and materials changed."""
        if needs_beam and not self.has_beam():
            raise SceneError("there is no beam; call setMonoChromatic, addEnergyBinToSpectrum or setVoltage")
        description = self.geometry()
        shown = [(label, node) for label, node in self.nodes.items() if node.surface and node.mesh is not None]
        outer = [label for label, node in shown if node.surface == "outer"]
        if 1 < len(outer) < len(shown):
            raise SceneError(f"{', '.join(map(repr, outer))} are all outer surfaces; with inner surfaces there can be one, which "
                             "they displace")
        made_of = (json.dumps(description), needs_beam, self.per_cm2, tuple(self.filters), tuple(self.inherent), tuple(self.tube.items()),
                   tuple(self.spectrum.items()), [(label, node.surface, node.mesh) for label, node in shown])
        if self._scene is None or made_of != self._made_of:
            self._scene = self._make(description, shown, outer, needs_beam)
            self._made_of = made_of
        for label, node in shown:
            part = self._scene[label]
            pose = self.scene_matrix @ self.world_matrix(label)
            if not (part.pose == pose).all():
                part.pose = pose
            if part.material is not node.material:
                part.material = self.material(label, needs_beam)
        return self._scene

    def _make(self, description: dict[str, Any], shown: list[tuple[str, Node]], outer: list[str],
              needs_material: bool) -> Scene:
        scene = Scene(description) if not self.file else self._changed_file(description, [label for label, _ in shown])
        present = {part.label for part in scene}
        for label, node in sorted(shown, key=lambda item: item[1].surface != "outer"):
            if label not in present:
                scene.add(label, node.mesh, material=self.material(label, needs_material),
                          inside=None if label in outer or not outer else outer[0],
                          pose=self.scene_matrix @ self.world_matrix(label))
        if not shown:  # a plan needs a part
            scene.add("nothing", Mesh.cube(1), material=Material.mu(0))
        if not self.file or self.beam_changed():
            scene.beam = self.beam()
        return scene

    def beam_changed(self) -> bool:
        """Whether the beam is another one than that of the file that was loaded."""
        return bool(self.spectrum != self.loaded_spectrum or self.filters or self.inherent or "kVp" in self.tube)

    def _changed_file(self, description: dict[str, Any], shown: list[str]) -> Scene:
        """The scene of the file, with source, detector and meshes as they are now."""
        scene = Scene(self.file)
        if self.detector_keys or self.grid:
            raise SceneError(f"{self.file}: a scene that was loaded from a file keeps its focal spot and its detector's blur "
                             "and oversampling; change the file")
        for part in list(scene):
            if part.label not in shown or self.loaded_meshes[part.label] is not self.nodes[part.label].mesh:
                scene.remove(part.label)
        if json.dumps(description) != self.loaded:
            scene.view = Scene(description).view
        return scene

    def reset(self) -> None:
        """Forgets everything."""
        self.__dict__.update(World().__dict__)

    def load(self, path: str) -> None:
        """Takes over what a scene file has, and forgets everything else."""
        scene = Scene(path)
        self.reset()
        view, beam = scene.view, scene.beam
        self.file = path
        self.source, self.detector = three(*view.source), three(*view.detector)
        self.up, self.right, self.pixels = three(*view.row_step), three(*view.column_step), view.pixels
        self.spacing = float(np.linalg.norm(view.column_step)), float(np.linalg.norm(view.row_step))
        self.shape = "PointSource" if view.projection == "point" else "ParallelBeam"
        self.spectrum = dict(zip(beam.energies.tolist(), beam.resolved(view).photons.tolist()))
        self.loaded_spectrum = dict(self.spectrum)
        parents = {part.inside for part in scene}
        for part in scene:
            node = self.add(part.label, part.mesh, "root")
            self.loaded_meshes[part.label] = part.mesh
            node.matrix, node.material, node.description = part.pose.copy(), part.material, part.material.name
            node.surface = "outer" if part.label in parents and len(parents) == 2 else "inner"
        self.loaded = json.dumps(self.geometry())

    def material(self, label: str, needed: bool = True) -> Material:
        material = self.node(label).material
        if material is None and not needed:  # path lengths need none
            return Material.mu(0)
        if material is None:
            raise SceneError(f"{label}: has no material; call setHU, setElement, setMixture, setCompound or setMu")
        return material

    def options(self) -> dict[str, Any]:
        """Options of an image."""
        found: dict[str, Any] = {"noise": True, "noise_seed": self.seed} if self.noise else {}
        if self.response is not None:
            found["response"] = self.response
        return found


def material_of(name: int | str) -> Material:
    """The material of a filter: an element by number, symbol or name, or any other by name."""
    try:
        return Material(element_symbol(name))
    except ArgumentError:
        return Material(str(name))


def _box(mesh: Mesh, matrix: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Least and greatest x, y, z of the vertices behind a matrix."""
    turn, shift = matrix[:3, :3], matrix[:3, 3]
    ends = np.reshape(mesh.health["bounds"], (2, 3))
    if (np.count_nonzero(turn, axis=1) == 1).all() and (np.count_nonzero(turn, axis=0) == 1).all():  # axes stay axes
        placed = ends @ turn.T + shift
        return [placed.min(0), placed.max(0)]
    # Floats find the vertices that may be outermost, doubles choose among them.
    offsets, origin = mesh.offsets, mesh.origin
    reach = float(np.abs(ends - origin).max())
    low, high = np.empty(3), np.empty(3)
    for k in range(3):
        row = turn[k]
        along = offsets @ row.astype(np.float32)
        room = 8 * np.finfo(np.float32).eps * float(np.abs(row).sum()) * reach  # roundings of three products and their sum
        low[k] = (offsets[along <= along.min() + room].astype(float) @ row).min()
        high[k] = (offsets[along >= along.max() - room].astype(float) @ row).max()
    middle = turn @ origin + shift
    return [low + middle, high + middle]


def centred(bounds: NDArray[np.float64]) -> NDArray[np.float64]:
    """The matrix that takes the middle of these bounds to the origin."""
    x, y, z = -(bounds[:3] + bounds[3:]) / 2
    return translate(x, y, z)


def three(x: Any, y: Any, z: Any, scale: float = 1) -> tuple[float, float, float]:
    return float(x) * scale, float(y) * scale, float(z) * scale


def millimetres(length: str) -> float:
    """The mm of a unit."""
    return unit(length, LENGTHS)


#: What all calls of this process act on.
world = World()
