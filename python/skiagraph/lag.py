"""The lag of a detector: what its pixels hold back of the frames of a sequence, and how these change its sensitivity."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._interface import ENUMS, ArgumentError
from ._library import call, doubles, ffi, make, owned


def _rows(given: Any, name: str, first: str) -> NDArray[np.float64]:
    rows = np.array(_arrays.numbers(given, name), dtype=np.float64)
    if rows.size and (rows.ndim != 2 or rows.shape[1] != 2):
        raise ArgumentError(f"{name} has {_arrays.describe(rows)}; give rows of a {first} and its frames")
    return rows.reshape(-1, 2)


class Lag:
    """The lag of a detector that begins at rest. Frames go through it in their order, whatever makes them.

    terms: [[share, frames], ...]: shares of the signal that a frame leaves to the next ones, all together below 1, and the time
    constants of their release. The n-th frame after a long exposure shows the sum of share exp(-(n - 1) / frames) of it; a steady
    signal is shown as it is.

    ghosting: [[change, frames], ...]: changes of the sensitivity after a long exposure to the open beam, whose signal in a frame is
    `full`, and the time constants with which they build up and go. The sensitivity is 1 + the sum of change q, where q goes by
    1 - exp(-1 / frames) of the way to signal / full in each frame.

    >>> lag = Lag([[0.1, 2]])
    >>> lag(np.ones((1, 1))).tolist()
    [[0.9]]
    >>> round(float(lag(np.zeros((1, 1)))[0, 0]), 4)
    0.0393
    """

    def __init__(self, terms: Sequence[Sequence[float]] | NDArray[Any] = (), *,
                 ghosting: Sequence[Sequence[float]] | NDArray[Any] = (), full: float = 1) -> None:
        self.terms, self.ghosting = _rows(terms, "terms", "share"), _rows(ghosting, "ghosting", "change")
        self.full = _arrays.real(full, "full")
        self._handle: Any = None
        self._shape: tuple[int, ...] = ()

    def __call__(self, image: Any) -> NDArray[Any]:
        """Applies lag and ghosting to the next frame, whose pixels are energies or photons; float32 stays float32."""
        given = _arrays.numbers(image, "image")
        frame = np.ascontiguousarray(given, dtype=np.float32 if given.dtype == np.float32 else np.float64)
        if self._handle is None:
            keep: list[Any] = []
            pointer = doubles(self.terms, "terms", keep)
            self._handle = owned("skg_lag", make("skg_lag_create", "skg_lag", frame.size, len(self.terms), pointer))
            if len(self.ghosting):
                call("skg_lag_ghosting_set", self._handle, self.full, len(self.ghosting), doubles(self.ghosting, "ghosting", keep))
            self._shape = frame.shape
        if frame.shape != self._shape:
            raise ArgumentError(f"image has {_arrays.describe(frame)}; the frames before had the shape {self._shape}")
        shown = np.empty_like(frame)
        call("skg_lag_apply", self._handle, ENUMS["type"][frame.dtype.name], ffi.cast("void *", ffi.from_buffer(frame)), 1.0,
             ffi.cast("void *", ffi.from_buffer(shown)))
        return shown

    def clear(self) -> None:
        """Lets the detector come to rest."""
        if self._handle is not None:
            call("skg_lag_clear", self._handle)
