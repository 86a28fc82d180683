"""Image files. Private."""
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _dicom
from ._interface import ArgumentError
from ._library import call, choice, encode, ffi, struct
from .view import View


def write_picture(path: str | os.PathLike[str], image: Any, *, names: Sequence[str], unit: str, view: View | None = None,
                  flat_field: float = 0, quantity: str = "energy", display: str = "radiograph",
                  range: tuple[float, float] | None = None, kvp: float = 0) -> None:
    """[row, column] or [channel, row, column]; one name, or one a channel. flat_field 0: shown as it is. kvp: of a .dcm."""
    array = _image_of(image)
    if os.fspath(path).lower().endswith(".dcm"):
        rises = quantity == "attenuation" or unit == "mm"
        _dicom.write(path, array, name=names[0], unit=unit, falls=not rises,
                     view=view if view is not None and view.shape == array.shape[-2:] else None, kvp=kvp)
        return
    keep: list[Any] = []
    call("skg_picture_save", _picture(array, names, unit, view, flat_field, quantity, display, range, keep), encode(path, "path"))


def encode_picture(name: str, image: Any, *, names: Sequence[str], unit: str, view: View, flat_field: float,
                   range: tuple[float, float]) -> bytes:
    """The bytes of the file that write_picture would write; the extension of the name says the format."""
    array = _image_of(image)
    keep: list[Any] = []
    picture = _picture(array, names, unit, view, flat_field, "energy", "radiograph", range, keep)
    size = ffi.new("int64_t *")
    call("skg_picture_encode", picture, name.encode(), ffi.NULL, 0, size)
    data = bytearray(size[0])
    call("skg_picture_encode", picture, name.encode(), ffi.from_buffer(data), len(data), size)
    return bytes(data)


def _image_of(image: Any) -> NDArray[Any]:
    array: NDArray[Any] = np.ascontiguousarray(_arrays.numbers(image, "image"))
    if array.dtype not in (np.dtype(np.float32), np.dtype(np.float64)) or array.ndim not in (2, 3):
        raise ArgumentError(f"image has {_arrays.describe(array)}; give [row, column] or [channel, row, column] of "
                            "float32 or float64")
    return array


def _picture(array: NDArray[Any], names: Sequence[str], unit: str, view: View | None, flat_field: float, quantity: str,
             display: str, range: tuple[float, float] | None, keep: list[Any]) -> Any:
    """An skg_picture of an array. keep: gets what the struct points to."""
    keep += [ffi.new("char[]", word.encode()) for word in (*names, unit)]
    picture = struct("skg_picture")
    picture.name, picture.unit, picture.flat_field = keep[0], keep[-1], flat_field
    picture.type = choice("type", str(array.dtype), "the type")
    picture.rows, picture.columns = array.shape[-2:]
    picture.channels = array.shape[0] if array.ndim == 3 else 1
    if len(names) > 1 and len(names) == picture.channels:
        keep.append(ffi.new("const char *[]", keep[:len(names)]))
        picture.channel_names = keep[-1]
    picture.data = ffi.cast("void *", ffi.from_buffer(array))
    picture.quantity = choice("quantity", quantity, "quantity")
    picture.display = choice("display", display, "display")
    picture.low, picture.high = range or (0, 0)
    if view is not None and view.shape == array.shape[-2:]:
        keep.append(view._write(struct("skg_view")))
        picture.view = keep[-1]
    return picture
