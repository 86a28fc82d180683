"""The lag of a detector: what its pixels hold back of the frames of a sequence."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._interface import ENUMS, ArgumentError
from ._library import call, doubles, ffi, make, owned


class Lag:
    """The lag of a detector that begins at rest. Frames go through it in their order, whatever makes them.

    terms: [[share, frames], ...]: shares of the signal that a frame leaves to the next ones, all together below 1, and the time
    constants of their release. The n-th frame after a long exposure shows the sum of share exp(-(n - 1) / frames) of it; a steady
    signal is shown as it is.

    >>> lag = Lag([[0.1, 2]])
    >>> lag(np.ones((1, 1))).tolist()
    [[0.9]]
    >>> round(float(lag(np.zeros((1, 1)))[0, 0]), 4)
    0.0393
    """

    def __init__(self, terms: Sequence[Sequence[float]] | NDArray[Any]) -> None:
        self.terms = np.array(_arrays.numbers(terms, "terms"), dtype=np.float64)
        if self.terms.ndim != 2 or self.terms.shape[1] != 2:
            raise ArgumentError(f"terms has {_arrays.describe(self.terms)}; give rows of a share and its frames")
        self._handle: Any = None
        self._shape: tuple[int, ...] = ()

    def __call__(self, image: Any) -> NDArray[Any]:
        """What the detector shows of the next frame, whose pixels are energies or photons; float32 stays float32."""
        given = _arrays.numbers(image, "image")
        frame = np.ascontiguousarray(given, dtype=np.float32 if given.dtype == np.float32 else np.float64)
        if self._handle is None:
            keep: list[Any] = []
            pointer = doubles(self.terms, "terms", keep)
            self._handle = owned("skg_lag", make("skg_lag_create", "skg_lag", frame.size, len(self.terms), pointer))
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
