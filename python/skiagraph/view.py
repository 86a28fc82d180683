"""Source and detector."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._interface import ENUMS, ArgumentError
from ._library import call, choice, ffi, struct

_FLOAT64 = np.dtype(np.float64)
_VECTORS = {"source": "source", "detector": "centre", "column_step": "column_step", "row_step": "row_step"}


class View:
    """Where the source and the pixels are. Lengths are in mm.

    source: a position, or a direction for the projection "parallel_from_infinity". detector: its centre. column_step
    and row_step: from one column, and from one row, to the next. pixels: (columns, rows). projection: "point",
    "parallel" or "parallel_from_infinity". radius: of the cylinder on which the columns stand at equal angles, which touches the
    flat detector in its middle and bends towards the source; 0: the detector is flat. With the distance from source to
    detector as its radius, its axis goes through the source (third-generation CT).

    A matrix moves source and detector together: rotate("z", 10) @ view turns both about the z axis.

    >>> from skiagraph import rotate
    >>> view = View(source=(0, -500, 0), detector=(0, 100, 0), column_step=(1, 0, 0), row_step=(0, 0, -1), pixels=(64, 48))
    >>> (rotate("z", 90) @ view).source.round(9).tolist()
    [500.0, -0.0, 0.0]
    """

    __array_ufunc__ = None  # array @ view is ours

    def __init__(self, *, source: Any, detector: Any, column_step: Any, row_step: Any, pixels: Sequence[int],
                 projection: str = "point", radius: float = 0.0) -> None:
        self.source: NDArray[np.float64] = _arrays.vector(source, "source")
        self.detector: NDArray[np.float64] = _arrays.vector(detector, "detector")
        self.column_step: NDArray[np.float64] = _arrays.vector(column_step, "column_step")
        self.row_step: NDArray[np.float64] = _arrays.vector(row_step, "row_step")
        self.pixels: tuple[int, int] = _arrays.raster(pixels, "pixels")
        self.projection: str = projection
        self.radius: float = _arrays.real(radius, "radius")

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, columns), the shape of an image."""
        return self.pixels[1], self.pixels[0]

    def check(self) -> None:
        """Raises SceneError with the reason if the view cannot be imaged."""
        call("skg_view_check", self._write(struct("skg_view")))

    def __rmatmul__(self, matrix: Any) -> View:
        moved = _arrays.matrix(matrix, "the matrix")
        turn, shift = moved[:3, :3], moved[:3, 3]
        infinite = self.projection == "parallel_from_infinity"
        return View(source=turn @ self.source + (0 if infinite else shift), detector=turn @ self.detector + shift,
                    column_step=turn @ self.column_step, row_step=turn @ self.row_step, pixels=self.pixels,
                    projection=self.projection, radius=self.radius)

    def pixel(self, column: float, row: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Where a pixel is, mm, and the step to the next column there. column and row count from the middle of the detector.

        >>> view = View(source=(0, -500, 0), detector=(0, 100, 0), column_step=(1, 0, 0), row_step=(0, 0, -1), pixels=(64, 48),
        ...             radius=600)
        >>> place, step = view.pixel(100, 0)  # on a circle about the source
        >>> round(float(np.linalg.norm(place - view.source)), 9)
        600.0
        """
        centre = self.detector + row * self.row_step
        if not self.radius > 0:
            return centre + column * self.column_step, self.column_step
        width = float(np.linalg.norm(self.column_step))
        across = self.column_step / width
        normal = np.cross(self.column_step, self.row_step)
        normal = normal / np.linalg.norm(normal)
        towards = -self.source if self.projection == "parallel_from_infinity" else self.source - self.detector
        normal = normal if normal @ towards > 0 else -normal
        angle = column * width / self.radius
        place = centre + self.radius * (np.sin(angle) * across + 2 * np.sin(angle / 2) ** 2 * normal)
        return place, width * (np.cos(angle) * across + np.sin(angle) * normal)

    def _write(self, pointer: Any) -> Any:
        pointer.projection = choice("projection", self.projection, "projection")
        pointer.columns, pointer.rows = _arrays.raster(self.pixels, "pixels")
        pointer.radius = _arrays.real(self.radius, "radius")
        for name, field in _VECTORS.items():
            vector = getattr(self, name)
            if type(vector) is not np.ndarray or vector.dtype != _FLOAT64 or vector.shape != (3,):
                vector = _arrays.vector(vector, name)
            getattr(pointer, field)[0:3] = vector.tolist()
        return pointer

    @classmethod
    def _read(cls, pointer: Any) -> View:
        names = {value: name for name, value in ENUMS["projection"].items()}
        vectors = {name: list(getattr(pointer, field)) for name, field in _VECTORS.items()}
        return cls(pixels=(pointer.columns, pointer.rows), projection=names[pointer.projection], radius=pointer.radius, **vectors)

    def _key(self) -> tuple[Any, ...]:
        """Equal for equal views."""
        return (bytes(ffi.buffer(self._write(struct("skg_view")))),)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, View) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def __repr__(self) -> str:
        return (f"<View from {self.source.tolist()} to {self.detector.tolist()} mm, {self.pixels[0]} x "
                f"{self.pixels[1]} pixels, {self.projection}{f', radius {self.radius:g} mm' if self.radius else ''}>")


def as_views(views: Any) -> list[View]:
    if not isinstance(views, (View, Iterable)):
        raise ArgumentError(f"views is a {type(views).__name__}; give Views")
    found = [views] if isinstance(views, View) else list(views)
    for i, view in enumerate(found):
        if not isinstance(view, View):
            raise ArgumentError(f"views[{i}] is a {type(view).__name__}; give Views")
        if view.shape != found[0].shape:
            raise ArgumentError(f"views[{i}] has {view.shape[1]} x {view.shape[0]} pixels and views[0] "
                                f"{found[0].shape[1]} x {found[0].shape[0]}; give views alike")
    return found
