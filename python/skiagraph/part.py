"""Parts of a scene."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _volume
from ._interface import SceneError
from ._library import call, ffi, struct, text
from .material import Material, as_material
from .mesh import Mesh

if TYPE_CHECKING:
    from ._state import State


class LabelError(SceneError, KeyError):
    """There is no part with this label. The text names those that there are."""

    def __str__(self) -> str:
        return Exception.__str__(self)  # that of KeyError has quotes


class Part:
    """A part of a scene: a mesh with its material, where it stands, and what it lies inside."""

    def __init__(self, state: State, number: int) -> None:
        self._state = state
        self._name = state.names[number]

    @property
    def number(self) -> int:
        """Number of the part, which grows smaller when a part before it is removed."""
        try:
            return self._state.names.index(self._name)
        except ValueError:
            raise SceneError("the part was removed from its scene") from None

    def _get(self) -> Any:
        part = struct("skg_part")
        call("skg_scene_part_get", self._state.handle, self.number, part)
        return part

    @property
    def volume(self) -> dict[str, Any] | None:
        """Contents of a volume of cells (Scene.add_volume): size, spacing, range, shares of compositions; None: the part is a mesh. The
        mesh of a volume is the box of all cells."""
        with self._state.calls():
            volume = self._get().volume
            return None if volume == ffi.NULL else _volume.describe(volume)

    @property
    def label(self) -> str:
        with self._state.calls():
            return text(self._get().label)

    @property
    def pose(self) -> NDArray[np.float64]:
        """The 4 x 4 matrix from the mesh to the world, mm; read-only. Assign another one to move the part."""
        with self._state.calls():
            part = self._get()  # its arrays live as long as this name
            made = np.array(list(part.pose)).reshape(4, 4)
        return _arrays.fixed(made)

    @pose.setter
    def pose(self, value: Any) -> None:
        pose = _arrays.matrix(value, "pose")
        with self._state.calls():
            call("skg_scene_part_pose_set", self._state.handle, self.number,
                 ffi.cast("double *", ffi.from_buffer(pose)))

    @property
    def mesh(self) -> Mesh:
        """Mesh of the part, which other parts may share."""
        with self._state.calls():
            return self._state.mesh(self._get().mesh)

    @property
    def material(self) -> Material:
        """Material of the part. Assign a Material or a name."""
        with self._state.calls():
            return self._state.material(self.number, self._get().material)

    @material.setter
    def material(self, value: Any) -> None:
        material = as_material(value)
        with self._state.calls():
            call("skg_scene_part_material_set", self._state.handle, self.number, material._handle)
            self._state.materials[self.number] = material

    @property
    def density(self) -> float:
        """g/cm3; 0 if it is unknown or has no meaning. Assign another one: the matter stays."""
        return self.material.density

    @density.setter
    def density(self, value: float) -> None:
        self.material = self.material.at_density(value)

    @property
    def inside(self) -> str | None:
        """The label of the part that it lies inside and displaces; None: none."""
        with self._state.calls():
            parent = int(self._get().inside)
        return None if parent < 0 else Part(self._state, parent).label

    @property
    def priority(self) -> int:
        """Where parts overlap, the one with the highest priority displaces the others."""
        with self._state.calls():
            return int(self._get().priority)

    def __repr__(self) -> str:
        inside = self.inside
        return f"<Part {self.label!r}: {self.material.name}" + (f", inside {inside!r}>" if inside else ">")
