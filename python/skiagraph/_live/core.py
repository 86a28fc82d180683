"""The core that pages of the command and of notebooks share: the library makes images, chooses their plans, and writes what pages are
told. Private."""
from __future__ import annotations

import json
from typing import Any

import numpy as np

from .._library import call, ffi, make, release, struct
from .._progress import Watch
from ..view import View
from .subject import Subject
from .wish import Message


class Core:
    """The plans of a subject, made with the first image, and the last image. Its calls stand in those of the scene's device."""

    def __init__(self, subject: Subject) -> None:
        self._subject = subject
        self._plans = ffi.NULL

    def anew(self) -> None:
        """Other plans follow."""
        plans, self._plans = self._plans, ffi.NULL
        if plans != ffi.NULL:
            self._subject.state.device.drop("skg_live_plans", plans)

    def __del__(self) -> None:
        self.anew()

    def make(self) -> bool:
        """Makes the image of the wish. Returns whether there is one."""
        keep: list[Any] = []
        subject, wish, frame = self._write(keep), self._subject.wish, struct("skg_live_frame")
        if self._plans == ffi.NULL:
            self._plans = self._subject.state.device.interruptible(
                "skg_live_plans", lambda: make("skg_live_plans_create", "skg_live_plans", subject, wish.handle))
        if wish.says["drag"]:
            call("skg_live_plans_draft", self._plans, subject)
        with Watch(False, "images") as watch:
            call("skg_live_frame_make", self._plans, subject, wish.handle, watch, frame)
        return not frame.dropped

    def frame(self, number: int) -> bytes:
        """The last image as a page takes it."""
        return letter("skg_live_frame_write", self._plans, number)

    def shot(self, number: int) -> Any:
        """The message about the last image."""
        keep: list[Any] = []
        return json.loads(letter("skg_live_shot_write", self._plans, self._write(keep), self._subject.wish.handle, number, False))

    def scene(self, geometry: int, warnings: list[str]) -> Any:
        """The message about the scene. The page has no panel for doses and slices: scene.dose(), scene.scan() and reconstruct()."""
        keep: list[Any] = []
        subject, facts = self._subject, struct("skg_live_facts")

        def held(text: str) -> Any:
            keep.append(ffi.new("char[]", text.encode("utf-8", "replace")))
            return keep[-1]

        facts.geometry, facts.load_ms = geometry, subject.load_ms
        facts.path = held(subject.state.source.path or "scene")
        facts.document = held(json.dumps(subject.document))
        facts.warnings = list_of = ffi.new("const char *[]", [held(sentence) for sentence in warnings])
        facts.warning_count = len(warnings)
        keep.append(list_of)
        return json.loads(letter("skg_live_scene_write", self._plans, self._write(keep), subject.wish.handle, facts))

    def probe(self, message: Message) -> Any:
        """The answer to a probe."""
        keep: list[Any] = []
        return json.loads(letter("skg_live_probe_write", self._write(keep), self._subject.wish.handle, message.handle))

    def take(self, message: Message) -> bytes:
        """A file of the image."""
        keep: list[Any] = []
        return letter("skg_live_file_write", self._write(keep), self._subject.wish.handle, message.handle)

    def picture(self, look: Message) -> bytes:
        """The answer to a look."""
        keep: list[Any] = []
        return letter("skg_live_picture_write", self._plans, self._write(keep), self._subject.wish.handle, look.handle)

    def _write(self, keep: list[Any]) -> Any:
        """The library's skg_live_subject. keep: gets what it points to."""
        subject, its = self._subject, struct("skg_live_subject")
        state, scan = subject.state, subject.scan
        its.posed = True
        its.context, its.scene, its.setup = state.device.handle, state.handle, state.setup
        its.spectrum = state.require_beam()._handle
        its.options = options = state.plans.options(state.options_setup, {}, keep)
        its.view, its.shown = own, shown = written(state.require_view()), written(subject.view())
        base = np.ascontiguousarray(subject.base, dtype=np.float64)
        its.poses = ffi.cast("double *", ffi.from_buffer(base)) if base.size else ffi.NULL
        if scan is not None:
            its.scan = scan._handle
        if subject.breathes:
            its.motion = state.linked()
        keep += [options, own, shown, base, scan]
        return its


def written(view: View) -> Any:
    return view._write(struct("skg_view"))


def letter(name: str, *arguments: Any) -> bytes:
    """The bytes of the letter that a call makes."""
    handle, bytes_of, count = make(name, "skg_live_letter", *arguments), ffi.new("const uint8_t **"), ffi.new("int64_t *")
    try:
        call("skg_live_letter_get", handle, ffi.NULL, bytes_of, count)
        return bytes(ffi.buffer(bytes_of[0], count[0]))
    finally:
        release("skg_live_letter", handle)
