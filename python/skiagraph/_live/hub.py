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
from .._interface import ArgumentError, Error
from .._library import ffi
from .._state import State
from . import page
from .core import Core, letter
from .subject import Subject
from .wish import Message, Wish, read

#: Frames under way to the page: while it shows one, the next is sent.
_UNTAKEN_MAX = 2
_VIEWS_MAX = 8

#: What the page of the command asks for and this one does not.
_ELSEWHERE = {
    "measure": "the dials are measured by the command: skiagraph live, or scene.cost() here",
    "register": "parts are registered by the command: skiagraph live --fixed, or scene.register() here",
    "reconstruct": "slices are reconstructed by the command: skiagraph live, or scene.scan() and sk.reconstruct() here"}

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
        self._is_wanted = self._is_closed = False
        self._played = 0.0
        self._last: tuple[bytes, dict[str, Any]] | None = None
        #: The newest look of a view that has not been answered yet.
        self._look: Message | None = None
        #: What the library warned of since the page began. The text about the scene has it.
        self._warnings: list[str] = []
        self._has_failed = False
        #: The last text about the scene, and whether it holds.
        self._scene: dict[str, Any] = {}
        self._is_told = False
        with state.calls():
            self._subject = Subject(state)
            self._core = Core(self._subject)
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
                self._take(name, read(message))
            except ArgumentError as refusal:
                self._tell({"refused": str(refusal)}, name)
        self._go_on()
        self._draw(name)

    def _take(self, name: str, message: Message) -> None:
        if message.kind == "ack":
            number = message.says["number"]
            if name == self._views[-1] and number in self._untaken:
                self._untaken = self._untaken[self._untaken.index(number) + 1:]
        elif message.kind == "probe":
            self._try(lambda: self._tell(self._core.probe(message), name))
        elif message.kind == "look":
            self._look = message
        elif name != self._views[-1]:
            self._tell({"refused": "another page changes this scene; this one only shows it"}, name)
        elif isinstance(message, Wish):
            if not self._subject.is_late(message):
                self._try(lambda: self._apply(message), message.wish)
        elif message.kind == "take":
            self._try(lambda: self.send({"to": name}, [self._core.take(message)]))
        else:
            self._tell({"refused": _ELSEWHERE[message.kind]}, name)

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
                self._core.anew()
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
                    self._core.anew()
                    self._is_told = False
                self._tell({"adopted": self._subject.wish.json(), "fresh": is_new})
            self._make()

        self._try(show)

    # Frames

    def _apply(self, wish: Wish) -> None:
        if self._subject.apply(wish):
            self._core.anew()
            self._is_told = False
        self._is_wanted = True
        if not wish.play:
            self._played = 0.0

    def _begin(self) -> None:
        """A page for the surfaces that there are now."""
        self._geometry += 1
        self._warnings.clear()
        self._page = page.html(self._subject)
        self._core.anew()
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
        number = self._number + 1
        with self._state.calls():
            if not self._core.make():
                return
            data, shot = self._core.frame(number), self._core.shot(number)
            if not self._is_told:
                self._is_told = True
                self._scene = self._core.scene(self._geometry, self._warnings)
                self._tell(self._scene)
        self._number = number
        self._last = data, shot
        self._untaken.append(number)
        self.send({}, [data])
        self._tell(shot)

    def _draw(self, name: str) -> None:
        """Answers the look of a view, with a frame first if one was wanted."""
        look, self._look = self._look, None
        if look is None:
            return
        try:
            with self._state.calls():
                data = self._core.picture(look)
        except Error as error:
            data = letter("skg_live_picture_miss", look.handle)
            self._tell({"refused": str(error)}, name)
        self.send({"to": name}, [data])

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
            self._scene["scene"]["warnings"] = list(self._warnings)
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
        self.send({"text": message, **({"to": name} if name else {})}, [])
