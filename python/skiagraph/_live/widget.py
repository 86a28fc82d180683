"""The widget of a scene under one's hands: the page of `skiagraph live` in a cell. Private."""
from __future__ import annotations

import asyncio
import functools
import importlib.resources
import threading
import weakref
from collections.abc import Callable
from typing import Any

from .._interface import UnsupportedError
from .._state import State
from .hub import Hub


@functools.cache
def _kind() -> Any:
    """The class, which needs anywidget."""
    try:
        import anywidget
        import traitlets
    except ImportError:
        raise UnsupportedError("scene.live() needs anywidget, which is not installed: pip install \"skiagraph[notebook]\"") \
            from None

    class Live(anywidget.AnyWidget):  # type: ignore[misc, unused-ignore]
        """A scene under one's hands. What is dragged is in the scene, and what Python assigns is shown after its cell, or by refresh()."""

        _esm = importlib.resources.files("skiagraph").joinpath("_live", "widget.js").read_text(encoding="utf-8")
        #: Of the page, in pixels.
        height = traitlets.Int(640).tag(sync=True)

        def __init__(self, hub: Hub, height: int) -> None:
            super().__init__(height=height)
            self._hub = hub
            hub.send = lambda content, buffers: self.send(content, buffers or None)
            self._thread, self._loop = threading.current_thread(), _running_loop()
            self.on_msg(lambda _widget, content, _buffers: self._receive(content))
            self._follow()

        def refresh(self) -> None:
            """Shows the scene as it is now; within a cell that goes on changing it."""
            self._hub.refresh()

        def close(self) -> None:
            """Ends it; the page stays as it is."""
            self._unfollow()
            super().close()  # type: ignore[no-untyped-call, unused-ignore]

        def _receive(self, content: Any) -> None:
            """Kernels that have subshells deliver messages in a thread of their own; the scene is that of the thread of cells."""
            if self._loop is None or threading.current_thread() is self._thread:
                self._hub.hear(content)
            else:
                self._loop.call_soon_threadsafe(self._hub.hear, content)

        def _follow(self) -> None:
            """After each cell, what it has changed is shown."""
            self._unfollow: Callable[[], None] = lambda: None
            try:
                from IPython import get_ipython  # type: ignore[import-not-found, attr-defined, unused-ignore]
            except ImportError:
                return
            shell, this = get_ipython(), weakref.ref(self)  # type: ignore[no-untyped-call, unused-ignore]
            if shell is None:
                return

            def after(*_: Any) -> None:
                widget = this()
                if widget is not None and widget.comm is not None:
                    widget.refresh()

            shell.events.register("post_run_cell", after)
            self._unfollow = lambda: shell.events.unregister("post_run_cell", after)

    return Live


def _running_loop() -> asyncio.AbstractEventLoop | None:
    """The event loop of the kernel; None: there is no kernel."""
    try:
        return asyncio.get_running_loop()
    except RuntimeError:
        return None


def widget(state: State, height: int) -> Any:
    kind = _kind()
    return kind(Hub(state), height)
