"""Arrays that come from the caller: shapes and types are checked, and named where they are wrong. Private."""
from __future__ import annotations

import operator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._interface import ArgumentError
from ._library import ffi


def describe(array: NDArray[Any]) -> str:
    return f"the shape {array.shape} and the type {array.dtype}"


def numbers(value: Any, what: str) -> NDArray[Any]:
    """An array of real numbers, without a copy where there is one already."""
    try:
        array = np.asarray(value)
    except (TypeError, ValueError):
        raise ArgumentError(f"{what} is no array of numbers, but a {type(value).__name__}") from None
    if isinstance(value, np.ma.MaskedArray):
        masked = np.count_nonzero(np.broadcast_to(np.asarray(value.mask), array.shape))
        if masked:
            raise ArgumentError(f"{what} has {masked} masked values of {array.size}, which are no numbers; fill them, as by .filled(0)")
    if array.dtype.kind not in "fiub":
        raise ArgumentError(f"{what} has {describe(array)}; give real numbers")
    return array


def fixed(array: NDArray[Any]) -> NDArray[Any]:
    """Makes an array read-only: it is a copy of what an object has, so that what is written there would be lost."""
    array.flags.writeable = False
    return array


def edges(bands: Any) -> NDArray[np.float64]:
    """The edges of energy bands, keV: two or more."""
    found = np.atleast_1d(numbers(bands, "bands")).astype(np.float64)
    if found.ndim != 1:
        raise ArgumentError(f"bands has {describe(found)}; give a list of edges in keV")
    if len(found) < 2:
        raise ArgumentError(f"bands is {found.tolist()}: {'one edge makes' if len(found) else 'without edges there is'} no band; give two or more")
    return found


def real(value: Any, what: str) -> float:
    """A number."""
    try:
        if not isinstance(value, (str, bytes)):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise ArgumentError(f"{what} is {value!r}; give a number")


def reals(**values: Any) -> tuple[float, ...]:
    """Numbers with their names."""
    return tuple(real(value, name) for name, value in values.items())


def whole(value: Any, what: str, least: int = 0, most: int = 2 ** 63 - 1) -> int:
    """A whole number from the least to the most; 96.0 is one, and 96.5 is not cut off."""
    number = int(value) if isinstance(value, (float, np.floating)) and float(value).is_integer() else value
    try:
        number = operator.index(number)
    except TypeError:
        raise ArgumentError(f"{what} is {value!r}; give a whole number") from None
    if not least <= number <= most:
        limits = f"{least} or more" if number < least and most == 2 ** 63 - 1 else f"{least} to {most}"
        raise ArgumentError(f"{what} is {value!r}; give a whole number, {limits}")
    return number


def raster(value: Any, what: str) -> tuple[int, int]:
    """(columns, rows) of an image."""
    try:
        columns, rows = value
    except (TypeError, ValueError):
        raise ArgumentError(f"{what} is {value!r}; give (columns, rows)") from None
    return whole(columns, f"{what}[0]", 0, 2 ** 31 - 1), whole(rows, f"{what}[1]", 0, 2 ** 31 - 1)


def vector(value: Any, what: str) -> NDArray[np.float64]:
    """Three numbers of its own memory."""
    array = numbers(value, what)
    if array.shape != (3,):
        raise ArgumentError(f"{what} has {describe(array)}; give 3 numbers")
    return np.array(array, dtype=np.float64)


def matrix(value: Any, what: str) -> NDArray[np.float64]:
    array = numbers(value, what)
    if array.shape != (4, 4):
        raise ArgumentError(f"{what} has {describe(array)}; give a 4 x 4 matrix")
    return np.ascontiguousarray(array, dtype=np.float64)


def matrices(value: Any, what: str) -> NDArray[np.float64]:
    """[n, 4, 4], or one matrix for all frames as [4, 4]."""
    array = numbers(value, what)
    if array.ndim not in (2, 3) or array.shape[-2:] != (4, 4):
        raise ArgumentError(f"{what} has {describe(array)}; give 4 x 4 matrices, [n, 4, 4]")
    return np.asarray(array, dtype=np.float64)


def rows(value: Any, what: str, types: tuple[Any, ...]) -> NDArray[Any]:
    """[n, 3] with dense rows, of one of these types; otherwise a copy of the first type."""
    array = numbers(value, what)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ArgumentError(f"{what} has {describe(array)}; give rows of 3 numbers, [n, 3]")
    size = array.itemsize
    dense = array.shape[0] == 0 or (array.strides[1] == size and array.strides[0] % size == 0
                                    and array.strides[0] >= 3 * size)
    if array.dtype in [np.dtype(t) for t in types] and dense:
        return array
    if np.dtype(types[0]).kind == "i":
        if array.dtype.kind not in "iu":
            raise ArgumentError(f"{what} has {describe(array)}; give whole numbers")
        limits = np.iinfo(types[0])
        if array.size and (array.max() > limits.max or array.min() < limits.min):
            raise ArgumentError(f"{what} has numbers beyond {limits.max}")
    return np.ascontiguousarray(array, dtype=types[0])


def output(out: Any, shape: tuple[int, ...], what: str = "out") -> NDArray[Any]:
    """The caller's array as one that the library can write: float32 or float64, this shape, dense rows' elements."""
    array = _shared(out, what)
    if array.shape != shape or array.dtype not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise ArgumentError(f"{what} has {describe(array)}; give the shape {shape} and the type float32 or float64")
    if not array.flags.writeable:
        raise ArgumentError(f"{what} is read-only")
    size = array.itemsize
    if array.shape[-1] > 1 and array.strides[-1] != size:
        raise ArgumentError(f"{what} has elements {array.strides[-1]} bytes apart; give dense rows")
    for axis in range(array.ndim - 1):
        if array.shape[axis] > 1 and (array.strides[axis] <= 0 or array.strides[axis] % size):
            raise ArgumentError(f"{what} has axis {axis} {array.strides[axis]} bytes apart; give a positive multiple "
                                f"of {size}")
    return array


def _writable(array: NDArray[Any]) -> NDArray[Any]:
    """A view of the caller's memory that can be written, as the caller offers it; NumPy marks arrays from DLPack as read-only."""
    if not array.size:
        return array
    if min(array.strides, default=0) < 0:
        raise BufferError("its strides are negative")
    last = sum((extent - 1) * stride for extent, stride in zip(array.shape, array.strides))
    memory = ffi.buffer(ffi.cast("char *", array.__array_interface__["data"][0]), last + array.itemsize)
    return np.ndarray(array.shape, array.dtype, memory, strides=array.strides)


def _shared(out: Any, what: str) -> NDArray[Any]:
    """An array on the same memory, by the buffer protocol or DLPack."""
    if isinstance(out, np.ndarray):
        return out
    try:
        if hasattr(out, "__dlpack__"):
            return _writable(np.from_dlpack(out))
        return np.asarray(memoryview(out))
    except (TypeError, BufferError, RuntimeError) as error:
        raise ArgumentError(f"{what} is a {type(out).__name__}, which shares no memory: {error}") from None
