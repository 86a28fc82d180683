"""Progress of a batch, on standard error or to a function. Private."""
from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Union

#: False: none. True: a line on standard error. A function: it is called with (done, of).
Progress = Union[bool, Callable[[int, int], object]]

_WIDTH = 30


class Meter:
    def __init__(self, progress: Progress, total: int) -> None:
        self._progress, self._total = progress, total
        self._start = self._last = time.monotonic()
        self._line = 0

    def update(self, done: int) -> None:
        if callable(self._progress):
            self._progress(done, self._total)
        elif self._progress:
            now = time.monotonic()
            if done == self._total or now - self._last >= 0.1:
                self._last = now
                self._draw(done, now - self._start)

    def _draw(self, done: int, seconds: float) -> None:
        rate = done / seconds if seconds > 0 else 0
        left = f"{(self._total - done) / rate:.0f} s left" if rate else ""
        bar = "#" * (_WIDTH * done // self._total)
        line = f"{done}/{self._total} |{bar:<{_WIDTH}}| {rate:.1f} images/s {left}"
        sys.stderr.write("\r" + line.ljust(self._line))
        self._line = len(line)
        if done == self._total:
            sys.stderr.write("\n")
        sys.stderr.flush()
