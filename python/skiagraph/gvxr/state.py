"""What the calls set: a graph of meshes, a source and a detector, and the scene that they make. Private.

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
from .._library import string
from ..material import Material
from ..matrices import translate
from ..mesh import Mesh
from ..scene import Scene

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
    #: How the material was given, "Element: Fe", and whether its density was.
    description: str = ""


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
    tube: dict[str, Any] = field(default_factory=dict)
    filters: list[tuple[int, float]] = field(default_factory=list)
    #: Keys of the detector in a scene file: response, blur, oversampling.
    detector_keys: dict[str, Any] = field(default_factory=dict)
    bands: list[float] | None = None
    noise: bool = False
    seed: int = 0
    frame: int = 0
    images: dict[str, Any] = field(default_factory=dict)
    angles: list[float] = field(default_factory=list)
    #: A scene file that was loaded, and source, detector and beam as they were then.
    file: str = ""
    loaded: str = ""
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
        if parent not in self.nodes:
            raise SceneError(f"the parent {parent!r} is not there")
        if label in self.nodes:
            raise SceneError(f"there is a node {label!r} already")
        self.nodes[label] = Node(parent, mesh)
        return self.nodes[label]

    def children(self, label: str) -> list[str]:
        return [name for name, node in self.nodes.items() if node.parent == label]

    def below(self, label: str) -> Iterator[str]:
        """The node and all below it."""
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
            mesh = self.nodes[label].mesh
            if mesh is not None:
                matrix = self.world_matrix(label)
                vertices = mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3]
                found += [vertices.min(0), vertices.max(0)]
        if not found:
            raise SceneError("there is no mesh to bound")
        return np.concatenate([np.min(found, 0), np.max(found, 0)])

    # The scene

    def geometry(self) -> dict[str, Any]:
        """Source and detector as a scene file has them."""
        source: dict[str, Any] = {"Position": [*self.source, "mm"], "Shape": self.shape}
        if self.grid:
            source["Grid"] = self.grid
        detector = {"Position": [*self.detector, "mm"], "UpVector": list(self.up), "NumberOfPixels": list(self.pixels),
                    **self.detector_keys}
        if self.right:
            detector["RightVector"] = list(self.right)
        if self.size:
            detector["Size"] = [*self.size, "mm"]
        elif self.spacing:
            detector["Spacing"] = [*self.spacing, "mm"]
        else:
            raise SceneError("the detector has no size; call setDetectorPixelSize")
        return {"Source": source, "Detector": detector}

    def beam(self, scene: dict[str, Any]) -> None:
        filters = [[z, mm, "mm"] for z, mm in self.filters]
        if self.tube and not self.spectrum:
            scene["Source"]["Beam"] = {**self.tube, "Filter": filters}
            return
        bins = self.spectrum or {60.0: 1.0}  # path lengths need no beam
        scene["Source"]["Beam"] = [{"Energy": kev, "Unit": "keV", "PhotonCount": n} for kev, n in sorted(bins.items())]

    def scene(self, needs_beam: bool = True) -> Scene:
        """The scene as it stands. It is made anew only if more than poses and materials changed."""
        if needs_beam and not self.spectrum and not self.tube:
            raise SceneError("there is no beam; call setMonoChromatic, addEnergyBinToSpectrum or setVoltage")
        description = self.geometry()
        self.beam(description)
        shown = [(label, node) for label, node in self.nodes.items() if node.surface and node.mesh is not None]
        outer = [label for label, node in shown if node.surface == "outer"]
        if len(outer) > 1:
            raise SceneError(f"{', '.join(map(repr, outer))} are all outer surfaces; there can be one, which the inner "
                             "ones displace")
        made_of = (json.dumps(description), self.per_cm2, list(self.filters), [(label, node.surface, id(node.mesh)) for label, node in shown])
        if self._scene is None or made_of != self._made_of:
            self._scene = self._make(description, shown, outer)
            self._made_of = made_of
        for label, node in shown:
            part = self._scene[label]
            pose = self.scene_matrix @ self.world_matrix(label)
            if not (part.pose == pose).all():
                part.pose = pose
            if part.material is not node.material:
                part.material = self.material(label)
        return self._scene

    def _make(self, description: dict[str, Any], shown: list[tuple[str, Node]], outer: list[str]) -> Scene:
        scene = Scene(description) if not self.file else self._changed_file(description, [label for label, _ in shown])
        present = {part.label for part in scene}
        for label, node in sorted(shown, key=lambda item: item[1].surface != "outer"):
            if label not in present:
                scene.add(label, node.mesh, material=self.material(label),
                          inside=None if label in outer or not outer else outer[0],
                          pose=self.scene_matrix @ self.world_matrix(label))
        if self.per_cm2:
            view = scene.view
            area = np.linalg.norm(np.cross(view.column_step, view.row_step)) / 100
            scene.beam = scene.beam.scaled(float(area * (1000 / np.linalg.norm(view.detector - view.source)) ** 2))
        if self.filters and self.spectrum:
            layers: list[tuple[Material, float]] = [(Material(_symbol(z)), mm) for z, mm in self.filters]
            for material, mm in layers:
                scene.beam = scene.beam.filtered({material: mm})
        return scene

    def _changed_file(self, description: dict[str, Any], shown: list[str]) -> Scene:
        """The scene of the file, with source, detector and beam as they are now."""
        scene = Scene(self.file)
        missing = [part.label for part in scene if part.label not in shown]
        if missing or self.detector_keys or self.grid:
            raise SceneError(f"{self.file}: a scene that was loaded from a file keeps its meshes, its focal spot and its "
                             "detector's response, blur and oversampling; change the file")
        if json.dumps(description) != self.loaded:
            other = Scene(description)
            scene.view, scene.beam = other.view, other.beam
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
        self.spectrum = dict(zip(beam.energies.tolist(), beam.photons.tolist()))
        parents = {part.inside for part in scene}
        for part in scene:
            node = self.add(part.label, part.mesh, "root")
            node.matrix, node.material, node.description = part.pose.copy(), part.material, part.material.name
            node.surface = "outer" if part.label in parents and len(parents) == 2 else "inner"
        description = self.geometry()
        self.beam(description)
        self.loaded = json.dumps(description)

    def material(self, label: str) -> Material:
        material = self.node(label).material
        if material is None:
            raise SceneError(f"{label}: has no material; call setHU, setElement, setMixture, setCompound or setMu")
        return material

    def options(self) -> dict[str, Any]:
        return {"noise": True, "noise_seed": self.seed} if self.noise else {}


def _symbol(z: int) -> str:
    return string("skg_element_symbol_get", int(z))


def centred(bounds: NDArray[np.float64]) -> NDArray[np.float64]:
    """The matrix that takes the middle of these bounds to the origin."""
    x, y, z = -(bounds[:3] + bounds[3:]) / 2
    return translate(x, y, z)


def three(x: float, y: float, z: float, scale: float = 1) -> tuple[float, float, float]:
    return float(x) * scale, float(y) * scale, float(z) * scale


def millimetres(length: str) -> float:
    """The mm of a unit."""
    return unit(length, LENGTHS)


#: What all calls of this process act on.
world = World()
