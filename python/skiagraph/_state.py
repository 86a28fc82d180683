"""State of a scene, and the functions that change it. Private."""
from __future__ import annotations

import copy
import functools
import json
import weakref
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ContextManager

import numpy as np
from numpy.typing import NDArray

from . import _edit, _save
from ._device import Device, device_of, note
from ._interface import ArgumentError, SceneError
from ._library import call, check, encode, ffi, integer, lib, make, retained, string, struct
from ._plans import Plans
from ._source import Kept, Source
from .beam import Beam
from .material import Material
from .mesh import Mesh, as_mesh
from .part import Part
from .scan import Scan
from .view import View


@dataclass(eq=False)
class State:
    """A scene as it is now. It is closed with its last reference, which a scene and its parts have."""

    device: Device
    source: Source
    plans: Plans
    #: The library's skg_setup, skg_scene, and skg_motion once the scene breathes; NULL: there is none.
    setup: Any = ffi.NULL
    handle: Any = ffi.NULL
    motion: Any = ffi.NULL
    #: The skg_scene if it is not that of the set-up, because parts were removed.
    own_handle: Any = ffi.NULL
    #: The skg_setup whose options hold if it is not `setup`: source and detector as a page of live() has set them, without parts.
    tuned: Any = ffi.NULL
    view: View | None = None
    beam: Beam | None = None
    trajectory: Scan | None = None
    #: The present phase or time of the breath; None: the scene was not posed.
    breath: dict[str, float] | None = None
    #: Number of the next frame with noise.
    frames: int = 0
    #: As it was read: the number of parts, their poses, and the view.
    file_parts: int = 0
    read_poses: list[Any] = field(default_factory=list)
    read_view: View | None = None
    #: What was assigned since: "view", "beam"; materials by number of the part; labels of removed parts.
    changed: set[str] = field(default_factory=set)
    materials: dict[int, Material] = field(default_factory=dict)
    removed: list[str] = field(default_factory=list)
    #: Of volumes that were added, by the number in `names`, what their hashes are made of.
    volumes: dict[int, list[Any]] = field(default_factory=dict)
    #: For each part a number that it keeps when parts before it are removed.
    names: list[int] = field(default_factory=list)
    #: One object for each mesh of the library, by its address, so that it knows whether it was changed.
    meshes: dict[int, Mesh] = field(default_factory=dict)
    #: Warnings that were given already.
    said: set[str] = field(default_factory=set)
    #: What images of the scene hold that are still in use, by their address: each with a weak reference to it.
    shown: dict[int, tuple[Any, str]] = field(default_factory=dict)
    #: Of a scene that was pickled: its files.
    kept: Kept | None = None

    @classmethod
    def read(cls, source: Source, device: Device | str | None, elsewhere: Mapping[str, str] | None = None) -> State:
        """The state of a scene that is read from its source."""
        opened = device_of(device)
        state = cls(opened, source, Plans(opened))
        with opened.calls(state.said):
            state.setup = source.load(opened.handle, elsewhere)
            handle = ffi.new("skg_scene **")
            call("skg_setup_scene_get", state.setup, handle)
            state.handle, state.beam, state.view = handle[0], beam_of(state.setup), view_of(state.setup)
            state.file_parts = state.count()
            state.names = list(range(state.file_parts))
            state.read_view = copy.deepcopy(state.view)
            state.read_poses = [part.pose for part in state.parts()]
        return state

    def show(self, image: NDArray[Any], quantity: str) -> NDArray[Any]:
        """Remembers what an image holds, for save()."""
        shown, key = self.shown, id(image)
        shown[key] = (weakref.ref(image, lambda _gone: shown.pop(key, None)), quantity)
        return image

    def shows(self, image: Any) -> str | None:
        """Quantity of an image of the scene, or of the batch that it was taken from; None: it is another array."""
        for array in (image, getattr(image, "base", None)):
            known = self.shown.get(id(array))
            if known is not None and known[0]() is array:
                return known[1]
        return None

    def calls(self) -> ContextManager[None]:
        """Context manager for calls of the library: they take turns, and warnings are passed on."""
        if self.setup == ffi.NULL:
            raise ArgumentError("the scene was closed")
        return self.device.calls(self.said)

    # Parts, view and beam

    def count(self) -> int:
        return integer("skg_scene_part_count", self.handle)

    def parts(self) -> list[Part]:
        return [Part(self, number) for number in range(self.count())]

    def number(self, label: str) -> int:
        """The number of the part with this label."""
        if not isinstance(label, str):
            raise ArgumentError(f"the label of a part is a {type(label).__name__}; give its text")
        with self.calls():
            try:
                return integer("skg_scene_part_find", self.handle, encode(label, "label"))
            except SceneError:
                raise _edit.unknown_label(label, [part.label for part in self.parts()]) from None

    def add(self, part: Any, mesh: Mesh, material: Material) -> int:
        """Adds a skg_part of this mesh and material. Its number."""
        part.mesh, part.material = mesh._handle, material._handle
        number = self.add_part(part)
        self.materials[number] = material
        self.meshes[_address(mesh._handle)] = mesh
        return number

    def add_part(self, part: Any) -> int:
        """Adds a skg_part. Its number."""
        number = integer("skg_scene_part_add", self.handle, part)
        self.names.append(max(self.names, default=-1) + 1)
        self.plans.clear()
        breath, self.breath = self.breath, None
        if breath:
            self._rest()
        self.forget_motion()
        if breath:  # a scene whose new part cannot be linked stays at rest
            self.linked()
            self.pose(breath)
            self.breath = breath
        return number

    @functools.cached_property
    def repairs(self) -> set[str]:
        """Words of the key Repair."""
        return _save.repairs(json.loads(string("skg_setup_text_get", self.setup)))

    def mended(self, mesh: Any, unit_mm: float | None, label: str) -> Mesh:
        """A mesh of whatever the caller has for a new part, treated as the key Repair says, as meshes of the file are."""
        made = as_mesh(mesh, unit_mm=unit_mm, name=label, as_wound="none" in self.repairs, _context=self.device.handle)
        if "orientation" not in self.repairs or not made.nesting["inverted"]:
            return made
        note(f"{label}: {made.nesting['inverted']} of {made.nesting['components']} components turned")
        return made.oriented()

    def mesh(self, handle: Any) -> Mesh:
        key = _address(handle)
        if key not in self.meshes:
            self.meshes[key] = Mesh._of(retained("skg_mesh", handle))
        return self.meshes[key]

    def keep_meshes(self, handles: list[Any]) -> None:
        """Lets go of all meshes but these."""
        kept = {_address(handle) for handle in handles}
        self.meshes = {key: mesh for key, mesh in self.meshes.items() if key in kept}

    def material(self, number: int, handle: Any) -> Material:
        return self.materials.get(number) or Material._borrowed(handle)

    def require_view(self) -> View:
        if self.view is None:
            raise SceneError("the scene has no source and detector; assign a View to scene.view")
        return self.view

    def shape(self, view: View | None = None) -> tuple[int, int]:
        """(rows, columns) of images of this view, or the scene's, which can be imaged: arrays of that size may be made."""
        seen = view or self.require_view()
        seen.check()
        return seen.shape

    def require_beam(self) -> Beam:
        if self.beam is None:
            raise SceneError("the scene has no beam; assign a Beam to scene.beam")
        return self.beam

    def plan(self, options: Mapping[str, Any], view: View | None = None, anew: bool = False) -> Any:
        """The plan of these options, with another view than the scene's if one is given."""
        return self.plans.get(self.options_setup, self.handle, view or self.require_view(), self.require_beam(), options, anew)

    @property
    def options_setup(self) -> Any:
        """The set-up that has the options of plans."""
        return self.setup if self.tuned == ffi.NULL else self.tuned

    def light(self, text: str, settings: list[str]) -> Any:
        """A set-up without parts, which the caller releases or gives to tune()."""
        source = Source(text.encode(), self.source.path, True, settings, self.source.lenient)
        setup = source.load(self.device.handle, self.kept.elsewhere if self.kept else None)
        self.source.files.update(source.files)
        return setup

    def tune(self, setup: Any) -> None:
        """Takes over a set-up whose options hold from now on."""
        self.plans.clear()
        tuned, self.tuned = self.tuned, setup
        if tuned != ffi.NULL:
            self.device.drop("skg_setup", tuned)

    def is_changed(self) -> bool:
        """Whether it differs from what its source says."""
        moved = any(mesh._changed for mesh in self.meshes.values()) or any(
            (part.pose != pose).any() for part, pose in zip(self.parts(), self.read_poses))
        return bool(self.changed or self.removed or self.materials or self.tuned != ffi.NULL or self.count() > self.file_parts or moved or self.breath
                    or self.view != self.read_view)

    # Breath

    def linked(self) -> Any:
        """The motion of the scene."""
        if self.removed:
            raise SceneError(f"{', '.join(map(repr, self.removed))} was removed, and the breath links the parts of the file; "
                             "take it out of the file instead")
        if self.motion == ffi.NULL:
            self.motion = make("skg_motion_create", "skg_motion", self.device.handle, self.setup)
        return self.motion

    def pose(self, breath: Mapping[str, float]) -> None:
        for name, value in breath.items():
            call(f"skg_motion_pose_at_{name}", self.motion, value)

    def _rest(self) -> None:
        """Meshes that the breath posed return to where they were before, so that the next motion is linked there. The last part is new."""
        for part in self.parts()[:-1]:
            if self.moves(part.number):
                rest = np.empty(part.mesh.vertices.shape)
                call("skg_motion_rest_get", self.motion, part.number, ffi.cast("double *", ffi.from_buffer(rest)))
                part.mesh._place(rest)

    def moves(self, number: int) -> bool:
        """Whether a part moves with the breath."""
        found = ffi.new("int32_t *")
        call("skg_motion_part_moves", self.motion, number, found)
        return bool(found[0])

    def completer(self) -> Any:
        """Writes what the breath changes into a skg_frame; None: nothing."""
        if self.motion == ffi.NULL or self.breath is None:
            return None
        motion = self.motion
        return lambda frame: check(lib.skg_motion_fill(motion, frame))

    def forget_motion(self) -> None:
        """The parts are others: the next breath links them anew."""
        motion, self.motion = self.motion, ffi.NULL
        if motion != ffi.NULL:
            self.device.drop("skg_motion", motion)

    # Life

    def close(self) -> None:
        if self.setup == ffi.NULL:
            return
        self.tune(ffi.NULL)
        self.forget_motion()
        setup, self.setup = self.setup, ffi.NULL
        own, self.own_handle = self.own_handle, ffi.NULL
        self.meshes.clear()
        self.materials.clear()
        if own != ffi.NULL:
            self.device.drop("skg_scene", own)
        self.device.drop("skg_setup", setup)

    def __del__(self) -> None:
        self.close()


def beam_of(setup: Any) -> Beam | None:
    spectrum = ffi.new("skg_spectrum **")
    call("skg_setup_spectrum_get", setup, spectrum)
    return Beam._borrowed(spectrum[0]) if spectrum[0] != ffi.NULL else None


def view_of(setup: Any) -> View | None:
    view = struct("skg_view")
    call("skg_setup_view_get", setup, view)
    return View._read(view) if view.columns else None


def _address(handle: Any) -> int:
    return int(ffi.cast("intptr_t", handle))
