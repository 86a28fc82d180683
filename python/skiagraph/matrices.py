"""Matrices of 4 x 4 that move parts and views. Lengths are in mm, angles in degrees.

A matrix acts on columns, so that the last one in a product acts first.
"""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._arrays import real, reals, vector
from ._interface import ArgumentError

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def translate(x: float, y: float, z: float) -> NDArray[np.float64]:
    """Moves by x, y, z in mm.

    >>> translate(1, 2, 3)[:3, 3].tolist()
    [1.0, 2.0, 3.0]
    """
    made = np.eye(4)
    made[:3, 3] = reals(x=x, y=y, z=z)
    return made


def rotate(axis: str | Sequence[float] | NDArray[Any], degrees: float,
           about: Sequence[float] | NDArray[Any] = (0, 0, 0)) -> NDArray[np.float64]:
    """Turns about an axis, "x", "y", "z" or a direction, through the point `about`, by the right-hand rule.

    >>> (rotate("z", 90) @ (1, 0, 0, 1)).round(12).tolist()
    [0.0, 1.0, 0.0, 1.0]
    >>> (rotate("z", 180, about=(1, 0, 0)) @ (0, 3, 0, 1)).round(12).tolist()
    [2.0, -3.0, 0.0, 1.0]
    """
    centre = vector(about, "about")
    x, y, z = direction(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(real(degrees, "degrees"))
    made = np.eye(4)
    made[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)
    made[:3, 3] = centre - made[:3, :3] @ centre
    return made


def direction(axis: str | Sequence[float] | NDArray[Any]) -> NDArray[np.float64]:
    """The direction of an axis, of length 1.

    >>> direction("y").tolist(), direction((0, 0, 2)).tolist()
    ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0])
    """
    if isinstance(axis, str):
        if axis not in _AXES:
            raise ArgumentError(f"axis is {axis!r}; give 'x', 'y', 'z' or a direction")
        axis = _AXES[axis]
    given = vector(axis, "axis")
    length = np.linalg.norm(given)
    if not np.isfinite(length) or length == 0:
        raise ArgumentError(f"axis is {given.tolist()}, which is no direction")
    made: NDArray[np.float64] = given / length
    return made
