"""Detectors that count photons."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays
from ._interface import ArgumentError
from ._library import call, ffi, fill, integer, make, owned, struct
from .material import Material, as_material

_SIDE = 11


class Counter:
    """A sensor whose pixels count photons by thresholds; the option `counter` of an image, whose channels are its windows.

    A window begins at each threshold and ends at the next one.

    >>> counter = Counter("CdTe", 1, 0.1, [20, 50], bias_v=400, electronic_kev=2, fluorescence=True)
    >>> low, high = counter.counts(80)
    >>> bool(0.5 < low < 1.5)
    True
    >>> counter.spread(80, 1).shape
    (11, 11)
    """

    def __init__(self, material: Material | str, thickness_mm: float, pixel_mm: float | ArrayLike, thresholds: ArrayLike,
                 **fields: Any) -> None:
        """pixel_mm: along rows and along columns, or one number for both. thresholds: keV, rising. fields: those of
        skg_counting, such as electronic_kev, bias_v, cloud_mm, fluorescence=True, anti_coincidence=True, and
        pile_up="paralysable" with dead_time_ns and exposure_s."""
        kept = as_material(material)
        edges = np.atleast_1d(_arrays.numbers(thresholds, "thresholds").astype(float))
        keep: list[Any] = [kept]
        sides = np.atleast_1d(_arrays.numbers(pixel_mm, "pixel_mm").astype(float))
        if sides.shape not in ((1,), (2,)):
            raise ArgumentError(f"pixel_mm is {pixel_mm!r}; give one number, or two: along rows and along columns")
        given = {"material": kept, "thickness_mm": _arrays.real(thickness_mm, "thickness_mm"), "pixel_mm": np.broadcast_to(sides, 2),
                 "threshold_kev": edges, "count": len(edges), **fields}
        made = fill(struct("skg_counting"), "skg_counting", given, keep, "the field of a counter")
        self._handle = owned("skg_counter", make("skg_counter_create", "skg_counter", made))

    def __len__(self) -> int:
        """The number of windows."""
        return integer("skg_counter_thresholds_get", self._handle)

    def counts(self, kev: ArrayLike) -> NDArray[np.float64]:
        """Mean counts in each window of one photon of this energy, in all pixels together and before pile-up; of several energies
        [energy, window]."""
        given = _arrays.numbers(kev, "kev")
        rows = [self._table("skg_counter_counts_get", len(self), float(one)) for one in given.reshape(-1)]
        return np.reshape(rows, (*given.shape, len(self)))

    def spread(self, kev: float, window: int) -> NDArray[np.float64]:
        """Where the counts of a window are: [row, column], in the middle the pixel that the photon enters."""
        return self._table("skg_counter_spread_get", _SIDE * _SIDE, _arrays.real(kev, "kev"), self._window(window)).reshape(_SIDE, _SIDE)

    def pairs(self, kev: float, window: int, other: int) -> NDArray[np.float64]:
        """How often a photon counts in two pixels, of the windows `window` and `other`: [row, column] of the second as seen
        from the first."""
        return self._table("skg_counter_pairs_get", _SIDE * _SIDE, _arrays.real(kev, "kev"), self._window(window), self._window(other)).reshape(_SIDE, _SIDE)

    def _window(self, number: int) -> int:
        return _arrays.whole(number, "the number of a window", 0, len(self) - 1)

    def _table(self, name: str, count: int, *arguments: Any) -> NDArray[np.float64]:
        values = np.zeros(count)
        call(name, self._handle, *arguments, ffi.cast("double *", values.ctypes.data))
        return values
