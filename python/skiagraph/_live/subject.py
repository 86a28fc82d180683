"""The scene as a page has it: what a wish changes, and what was changed elsewhere. Private.

A page states everything relative to a beginning: settings on top of a text, and moves on top of poses. The beginning is the scene
when the page was made; a source, detector or beam that Python assigns makes another one.
"""
from __future__ import annotations

import json
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _save
from .._interface import SceneError
from .._library import call, ffi, filled, integer, number, struct
from .._state import State, beam_of, view_of
from ..beam import Beam
from ..mesh import Mesh
from ..scan import Scan
from ..view import View
from .wish import Wish

_OF_PARTS = ("samples", "scenegraph", "breathing")

#: Numbers of wishes, which begin anew, and how many a change elsewhere leaves out: those are late that the page sends before it
#: knows of it.
_NUMBERS, _SKIPPED = 1 << 32, 1 << 16


class Subject:
    """A scene under a page's hands."""

    def __init__(self, state: State) -> None:
        self.state = state
        self.wish = Wish({"wish": 0})
        #: What it took to read the settings, ms.
        self.load_ms = 0.0
        self.begin()

    def begin(self) -> None:
        """Takes the scene as it is now for the beginning."""
        state = self.state
        self.breathes = _breathes(state)
        self.period = number("skg_motion_period_get", state.linked()) if self.breathes else 0.0
        self.document = _save.without_parts(_save.settings_text(state, True))
        _show_mono(self.document, state.require_beam())
        setup = state.light(json.dumps(self.document), [])
        self._scan = _scan_of(setup)
        state.device.drop("skg_setup", setup)
        self.base = [part.pose for part in state.parts()]
        self._breath = self._phase()
        #: Vertices before the page makes the scene breathe; none if it breathes already.
        self._still: list[tuple[Mesh, NDArray[np.float64]]] = []
        if self.breathes and self._breath is None:
            self._still = [(part.mesh, part.mesh.vertices) for part in state.parts()]
        self.wish = self.wish.but(wish=_later(self.wish.wish), settings={}, poses={}, phase=self._breath, projection=None, play=False)
        self.surfaces = self._surfaces()
        self.note()

    # Changes by a wish

    def is_late(self, wish: Wish) -> bool:
        """Whether it was sent before the page could know of the last change elsewhere."""
        return (wish.wish - self.wish.wish) % _NUMBERS >= _NUMBERS // 2

    def check(self, wish: Wish) -> None:
        """Raises the sentence for what the scene does not have."""
        if wish.phase is not None and not self.breathes:
            raise SceneError("the scene does not breathe: it has no key Breathing")
        if wish.projection is not None and wish.projection >= len(self.scan or ()):
            raise SceneError(f"the scene has no projection {wish.projection}")
        for key in wish.settings:
            if key.split(".")[0].strip().lower() in _OF_PARTS:
                raise SceneError(f"{key}: in a notebook, parts are changed by Python, such as scene[\"liver\"].density = 1.06; the "
                                 "image here follows")

    def apply(self, wish: Wish) -> bool:
        """Makes the scene as the wish has it. Returns whether it needs other plans."""
        self.check(wish)
        moved, other = ffi.new("int32_t *"), ffi.new("int32_t *")
        call("skg_live_wish_compare", self.wish.handle, wish.handle, moved, other)
        if wish.settings != self.wish.settings:
            self._set(wish.settings, bool(other[0]))
        moves, before = wish.moves(), self.wish.moves()
        for number, part in enumerate(self.state.parts()):
            if number in moves or number in before:
                part.pose = moves[number] @ self.base[number] if number in moves else self.base[number]
        if wish.phase != self._phase():
            self._breathe(wish.phase)
        self.wish = wish
        self.note()
        return bool(other[0])

    def _set(self, settings: dict[str, Any], is_new: bool) -> None:
        state, start = self.state, time.perf_counter()
        words = [f"{key}={json.dumps(value)}" for key, value in settings.items()]
        setup = state.light(json.dumps(self.document), words)
        view, beam, self._scan = view_of(setup), beam_of(setup), _scan_of(setup)
        if is_new:
            state.tune(setup)
            if beam is not None and not _alike(beam, state.require_beam()):
                state.beam = beam
                state.changed.discard("beam")  # its text is that of the set-up
        else:
            state.device.drop("skg_setup", setup)
        if view != state.view:
            state.view = view
            state.changed.add("view")
        self.load_ms = 1000 * (time.perf_counter() - start)

    def _breathe(self, phase: float | None) -> None:
        """To a phase; None: to where it was at the beginning."""
        state, phase = self.state, self._breath if phase is None else phase
        if phase is None:
            for mesh, vertices in self._still:
                mesh._place(vertices)
            state.breath = None
        else:
            state.linked()
            state.pose({"phase": phase})
            state.breath = {"phase": phase}

    def play(self, seconds: float) -> None:
        """The breath goes on by itself."""
        if self.wish.phase is not None:
            phase = (self.wish.phase + seconds / self.period) % 1
            self._breathe(phase)
            self.wish = self.wish.but(phase=phase)
            self.note()

    def moments(self, count: int) -> Iterator[None]:
        """Poses the scene at moments of its breath, one after the other, and then as it was."""
        phase = self._phase()
        for i in range(count if self.breathes else 1):
            if self.breathes:
                self._breathe(i / count)
            yield
        if self.breathes:
            self._breathe(phase)

    # Changes elsewhere

    def note(self) -> None:
        """Remembers how the scene is, so that a change elsewhere is seen."""
        self._seen = self._key()

    def is_other(self) -> bool:
        """Whether the scene was changed since by others."""
        return bool(self._key() != self._seen)

    def has_other_surfaces(self) -> bool:
        """Whether the page shows parts that the scene no longer has so."""
        return self._surfaces() != self.surfaces

    def take_over(self) -> bool:
        """Says by a wish what was changed elsewhere. Returns whether that is a new beginning."""
        view, beam = self._seen[0], self._seen[1]
        now = self._key()
        if now[0] != view or now[1] != beam:
            self.begin()
            return True
        poses = dict(self.wish.poses)
        for number, (part, base) in enumerate(zip(self.state.parts(), self.base)):
            was = self.wish.moves().get(number)
            if (part.pose == (base if was is None else was @ base)).all():
                continue
            poses.pop(str(number), None)
            if (part.pose != base).any():
                moved = part.pose @ np.linalg.inv(base)
                moved[3] = 0, 0, 0, 1
                poses[str(number)] = moved.ravel().tolist()
        self.wish = self.wish.but(wish=_later(self.wish.wish), poses=poses, phase=self._phase(), play=False)
        self.note()
        return False

    def _key(self) -> tuple[Any, ...]:
        state = self.state
        poses = b"".join(part.pose.tobytes() for part in state.parts())
        matter = [(number, id(material)) for number, material in sorted(state.materials.items())]
        return state.require_view()._key(), id(state.require_beam()), poses, matter, self._phase(), self._surfaces()

    def _surfaces(self) -> list[Any]:
        """Identity of the geometry in the 3D view. Of a scene that breathes, vertices move with the breath."""
        state = self.state
        return [(part.label, id(part.mesh), part.mesh._changed if self.breathes else part.mesh.version) for part in state.parts()]

    def _phase(self) -> float | None:
        state = self.state
        if not state.breath:
            return None
        if "phase" in state.breath:
            return float(state.breath["phase"])
        return float(filled("skg_motion_state", "skg_motion_state_get", state.linked())["phase"]) % 1

    # Source and detector of a frame

    @property
    def scan(self) -> Scan | None:
        """The projections. Those of the key Scan follow source and detector."""
        return self.state.trajectory or self._scan

    def view(self) -> View:
        """Source and detector as the page shows them."""
        if self.wish.projection is None or self.scan is None:
            return self.state.require_view()
        return self.scan[self.wish.projection]


def _later(number: int) -> int:
    return (number + _SKIPPED) % _NUMBERS


def _alike(a: Beam, b: Beam) -> bool:
    return a.absolute == b.absolute and all(np.array_equal(x, y) for x, y in zip(a._bins(), b._bins()))


def _show_mono(document: dict[str, Any], beam: Beam) -> None:
    """One energy as the page has a field for it."""
    energies, photons = beam._bins()
    source = _save._object(document, "Source")
    if isinstance(_save._get(source, "Beam"), dict) and "Bins" in _save._get(source, "Beam") and len(energies) == 1 and not beam.absolute:
        _save._put(source, "Beam", [{"Energy": float(energies[0]), "Unit": "keV", "PhotonCount": float(photons[0])}])


def _scan_of(setup: Any) -> Scan | None:
    if integer("skg_setup_projection_count_get", setup) < 2:
        return None
    handle = ffi.new("skg_scan **")
    call("skg_setup_scan_get", setup, handle)
    return Scan._borrowed(handle[0])


def _breathes(state: State) -> bool:
    found = ffi.new("int32_t *")
    call("skg_setup_body_options_get", state.setup, found, struct("skg_body_options"))
    return bool(found[0]) and not state.removed
