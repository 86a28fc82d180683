"""The server of a page in a notebook: messages of its views in, frames and texts out. Private.

The protocol is that of docs/live.md. What comes is {"view": ID} with "page" (the page is asked for), "gone", or "messages", a bundle,
which is answered by {"heard": true} when all of it is dealt with. What goes is {"to": ID} or, to all views, {}, with "text", a
message of the protocol, or with a buffer: the page, a frame, a picture of the 3D view or a file.
"""
from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from .._device import RangeWarning
from .._interface import Error
from .._library import ffi
from .._state import State
from . import describe, page
from .frame import Camera, Frame, pack, probe, take
from .look import Look, draw, read_look
from .subject import Subject
from .wish import Refusal, kind_of, read_ack, read_probe, read_take, read_wish

#: Frames under way to the page: while it shows one, the next is sent.
_UNTAKEN_MAX = 2
_VIEWS_MAX = 8

#: Sends content and buffers.
Send = Callable[[dict[str, Any], list[bytes]], None]


class Hub:
    """The scene of a state, with a first frame; until something else is assigned to `send`, nobody is told.

    A failure of the first frame is raised; later ones become sentences of the page.
    """

    def __init__(self, state: State) -> None:
        self._state = state
        self.send: Send = lambda content, buffers: None
        #: Those that are shown; the newest may change the scene.
        self._views: list[str] = []
        self._untaken: list[int] = []
        self._number = self._geometry = 0
        self._is_wanted = self._drag = self._is_closed = False
        self._played = 0.0
        self._last: tuple[bytes, dict[str, Any]] | None = None
        #: The last frame, and the newest look of a view that has not been answered yet.
        self._frame: Frame | None = None
        self._look: Look | None = None
        #: What the library warned of since the page began. The text about the scene has it.
        self._warnings: list[str] = []
        self._has_failed = False
        #: The last text about the scene, and whether it holds.
        self._scene: dict[str, Any] = {}
        self._is_told = False
        with state.calls():
            self._subject = Subject(state)
            self._camera = Camera(self._subject)
            self._begin()
            self._make()

    # From the views

    def hear(self, content: Any) -> None:
        """Takes what a view has sent. Failures of the scene become sentences of the page."""
        name = content.get("view") if isinstance(content, dict) else None
        if not isinstance(name, str):
            return
        if content.get("page"):
            with self._noting():
                self._show_changes()
            self.send({"to": name, "page": True}, [self._page])
        elif content.get("gone"):
            self._leave(name)
        elif isinstance(content.get("messages"), list):
            try:
                with self._noting():
                    self._hear(name, content["messages"])
            finally:
                self.send({"to": name, "heard": True}, [])

    def _hear(self, name: str, messages: list[Any]) -> None:
        if name not in self._views or not messages:  # a page that begins has nothing to say yet
            self._join(name)
        self._show_changes()
        for message in messages:
            try:
                self._take(name, kind_of(message), message)
            except Refusal as refusal:
                self._tell({"refused": str(refusal)}, name)
        self._go_on()
        self._draw(name)

    def _take(self, name: str, kind: str, message: dict[str, Any]) -> None:
        if kind == "ack":
            number = read_ack(message["ack"])
            if name == self._views[-1] and number in self._untaken:
                self._untaken = self._untaken[self._untaken.index(number) + 1:]
        elif kind == "probe":
            at = read_probe(message["probe"])
            self._try(lambda: self._tell({"probed": message["probe"], "parts": probe(self._subject, at)}, name))
        elif kind == "look":
            self._look = read_look(message["look"])
        elif name != self._views[-1]:
            self._tell({"refused": "another page changes this scene; this one only shows it"}, name)
        elif kind == "wish":
            wish, drag = read_wish(message)
            if not self._subject.is_late(wish):
                self._try(lambda: self._apply(wish, drag), wish.wish)
        elif kind == "take":
            ending = read_take(message["take"])
            self._try(lambda: self.send({"to": name}, [take(self._subject, ending)]))
        else:
            self._tell({"refused": "the dials are measured by the command: skiagraph live, or scene.cost() here"}, name)

    def _join(self, name: str) -> None:
        self._views = [*(view for view in self._views if view != name), name][-_VIEWS_MAX:]
        self._untaken = []
        self._tell_roles()
        self._tell(self._scene, name)
        if self._last is not None:
            self._tell(self._last[1], name)
            self.send({"to": name}, [self._last[0]])

    def _leave(self, name: str) -> None:
        self._views = [view for view in self._views if view != name]
        self._untaken = []
        self._tell_roles()

    def _tell_roles(self) -> None:
        for view in self._views:
            self._tell({"role": "owner" if view == self._views[-1] else "reader"}, view)

    # From Python

    def refresh(self) -> None:
        """Shows what was changed elsewhere, if anything was. Failures and warnings become sentences of the page."""
        if self._views:
            with self._noting():
                self._show_changes()

    def _show_changes(self) -> None:
        if self._state.setup == ffi.NULL:
            if not self._is_closed:
                self._is_closed = True
                self._tell({"error": "the scene was closed; this is its last image", "wish": self._subject.wish.wish})
            return

        def show() -> None:
            if not self._subject.is_other():
                return
            if self._subject.has_other_surfaces():
                self._subject.begin()
                self._begin()
                self._views = []
                self.send({"page": True}, [self._page])
            else:
                is_new = self._subject.take_over()
                if is_new:
                    self._camera.anew()
                    self._is_told = False
                self._tell({"adopted": self._subject.wish.json(), "fresh": is_new})
            self._make()

        self._try(show)

    # Frames

    def _apply(self, wish: Any, drag: bool) -> None:
        if self._subject.apply(wish):
            self._camera.anew()
            self._is_told = False
        self._is_wanted, self._drag = True, drag
        if not wish.play:
            self._played = 0.0

    def _begin(self) -> None:
        """A page for the surfaces that there are now."""
        self._geometry += 1
        self._warnings.clear()
        self._page = page.html(self._subject)
        self._camera.anew()
        self._is_told = False

    def _go_on(self) -> None:
        """The next frame, if it is wanted and the page can take one."""
        if len(self._untaken) >= _UNTAKEN_MAX:
            return
        wish, now = self._subject.wish, time.monotonic()
        if wish.play and wish.phase is not None and not self._is_wanted:
            self._is_wanted = self._try(lambda: self._subject.play((now - self._played) if self._played else 0))
            self._played = now
        if self._is_wanted:
            self._is_wanted = False
            self._try(self._make, wish.wish)

    def _make(self) -> None:
        """Makes a frame and sends it to all."""
        subject, number = self._subject, self._number + 1
        with self._state.calls():
            frame = self._camera.make(self._drag)
            data = pack(frame, number, subject.wish)
            shot = describe.shot(subject, subject.view(), frame.plan, number, frame.ms, frame.is_draft)
            if not self._is_told:
                self._is_told = True
                facts = {"geometry": self._geometry, "warnings": self._warnings, "plan_ms": frame.ms}
                self._scene = describe.scene(subject, frame.plan, facts)
                self._tell(self._scene)
        self._number, self._drag, self._frame = number, False, frame
        self._last = data, shot
        self._untaken.append(number)
        self.send({}, [data])
        self._tell(shot)

    def _draw(self, name: str) -> None:
        """Answers the look of a view, with a frame first if one was wanted."""
        look, self._look = self._look, None
        if look is not None:
            data, failure = draw(self._subject, self._frame, look)
            self.send({"to": name}, [data])
            if failure is not None:
                self._tell({"refused": str(failure)}, name)

    # Texts

    @contextmanager
    def _noting(self) -> Iterator[None]:
        """Warnings inside of it are the page's: each message would repeat them in the notebook."""
        self._has_failed = False
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            yield
        new = {str(warning.message) for warning in said if not issubclass(warning.category, RangeWarning)}.difference(self._warnings)
        if new and self._scene and not self._has_failed:
            self._warnings += sorted(new)
            self._tell(self._scene)

    def _try(self, act: Callable[[], Any], wish: int | None = None) -> bool:
        """Does it; a failure of the scene becomes a sentence of the page."""
        try:
            with self._state.calls():
                act()
        except Error as error:
            self._has_failed = True
            self._tell({"error": str(error), "wish": self._subject.wish.wish if wish is None else wish})
            return False
        return True

    def _tell(self, message: dict[str, Any], name: str | None = None) -> None:
        self.send({"text": describe.finite(message), **({"to": name} if name else {})}, [])
