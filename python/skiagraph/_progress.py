"""Progress of a batch, on standard error or to a function. Private."""
from __future__ import annotations

import sys
import time
from collections.abc import Callable
from types import TracebackType
from typing import Any, Union

from ._interface import CancelledError
from ._library import call, ffi, release

#: False: none. True: a line on standard error. A function: it is called with (done, of); if it returns False before the
#: end, or raises, the work is cancelled.
Progress = Union[bool, Callable[[int, int], object]]

_WIDTH = 30


class Meter:
    def __init__(self, progress: Progress, total: int, unit: str = "images") -> None:
        self._progress, self._total, self._unit = progress, total, unit
        self._start = self._last = time.monotonic()
        self._line = 0

    def update(self, done: int) -> None:
        if callable(self._progress):
            if self._progress(done, self._total) is False and done < self._total:
                raise CancelledError(f"cancelled after {done} of {self._total} {self._unit}")
        elif self._progress:
            now = time.monotonic()
            if done == self._total or now - self._last >= 0.1:
                self._last = now
                self._draw(done, now - self._start)

    def _draw(self, done: int, seconds: float) -> None:
        rate = done / seconds if seconds > 0 else 0
        left = f"{(self._total - done) / rate:.0f} s left" if rate else ""
        bar = "#" * (_WIDTH * done // self._total)
        line = f"{done}/{self._total} |{bar:<{_WIDTH}}| {rate:.1f} {self._unit}/s {left}"
        sys.stderr.write("\r" + line.ljust(self._line))
        self._line = len(line)
        if done == self._total:
            sys.stderr.write("\n")
        sys.stderr.flush()


class Watch:
    """The progress of one long call of the library: for its options inside of a with statement.

    An exception of the caller's function, also that of Ctrl-C, cancels the call and is raised instead of its error.
    """

    def __init__(self, progress: Progress, unit: str) -> None:
        self._progress, self._unit = progress, unit
        self._meter: Meter | None = None
        self._raised: BaseException | None = None
        # Python raises a pending interrupt as soon as a function begins, before its first statement
        self._function = ffi.callback("skg_progress_function", self._hear, error=1, onerror=self._fail)
        address = ffi.new("skg_progress **")
        call("skg_progress_create", self._function, ffi.NULL, address)
        self.handle = address[0]

    def _hear(self, done: int, total: int, user: Any) -> int:
        self._meter = self._meter or Meter(self._progress, total, self._unit)
        if done:
            self._meter.update(done)
        return 0

    def _fail(self, kind: type[BaseException], error: BaseException, trace: TracebackType) -> None:
        self._raised = error

    def __enter__(self) -> Any:
        return self.handle

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        release("skg_progress", self.handle)
        if self._raised is not None:
            raise self._raised from None
