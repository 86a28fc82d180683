"""Pictures of a scene from outside. Private."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._interface import ArgumentError
from ._library import call, ffi, struct

if TYPE_CHECKING:
    from ._state import State


def picture(state: State, pixels: Sequence[int], direction: Any, up: Any, orthographic: bool, image: Any,
            colours: Mapping[str, Any]) -> NDArray[np.uint8]:
    """Renders Scene.picture."""
    keep: list[Any] = []
    look = struct("skg_look")
    look.collimation = state.plans.options(state.options_setup, {}, keep).collimation
    (look.columns, look.rows), look.orthographic = _arrays.raster(pixels, "pixels"), bool(orthographic)
    for name, given in (("from", direction), ("up", up)):
        for k, value in enumerate((0, 0, 0) if given is None else _arrays.vector(given, name)):
            getattr(look, name)[k] = value
    if image is not None:
        look.image = _grey(image, state.require_view().shape, keep)
    if colours:
        look.colours = _colours(state, colours, keep)
    try:
        made = np.empty((look.rows, look.columns, 4), np.uint8)
    except (MemoryError, ValueError):
        raise ArgumentError(f"pixels is {pixels!r}, and a picture of that size does not fit into memory; give fewer") from None
    call("skg_scene_picture", state.device.handle, state.handle, state.require_view()._write(struct("skg_view")), look,
         ffi.cast("uint8_t *", ffi.from_buffer(made)))
    return np.ascontiguousarray(made[..., :3])


def _grey(image: Any, shape: tuple[int, int], keep: list[Any]) -> Any:
    """An image as grey values on the detector: dark where it is least."""
    array = _arrays.numbers(image, "image")
    if array.shape != shape:
        raise ArgumentError(f"image has {_arrays.describe(array)}; give one of {shape[0]} x {shape[1]} pixels, as the view has")
    low, high = float(array.min()), float(array.max())
    grey = np.ascontiguousarray(np.round((array - low) * (255 / (high - low) if high > low else 0)).astype(np.uint8))
    keep.append(grey)
    return ffi.cast("uint8_t *", ffi.from_buffer(grey))


def _colours(state: State, colours: Mapping[str, Any], keep: list[Any]) -> Any:
    """Colours of all parts, the library's or those given by label: red, green, blue and opacity, 0 to 1."""
    made = np.empty((state.count(), 4), np.uint8)
    pointer = ffi.cast("uint8_t *", ffi.from_buffer(made))
    call("skg_look_colours_get", state.handle, pointer)
    for label, colour in colours.items():
        given = _arrays.numbers(colour, "a colour")
        if given.shape not in ((3,), (4,)) or not ((given >= 0) & (given <= 1)).all():
            raise ArgumentError(f"colours[{label!r}] is {colour!r}; give red, green, blue and opacity, 0 to 1")
        made[state.number(label), :len(given)] = np.round(255 * given)
    keep.append(made)
    return pointer
