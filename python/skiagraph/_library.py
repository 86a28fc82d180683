"""The library: loading it, calling it, and its structs as dictionaries. Private.

Calls release the global lock of the interpreter while they run, because cffi does so in ABI mode.
"""
from __future__ import annotations

import difflib
import functools
import os
import pathlib
from collections.abc import Iterable, Mapping
from typing import Any

import cffi
import numpy as np
from numpy.typing import NDArray

from . import _interface
from ._interface import ENUMS, ERRORS, ArgumentError, Error

ffi: Any = cffi.FFI()
ffi.cdef(_interface.CDEF)


def _load() -> Any:
    """The library of the package, or else that of the system; SKIAGRAPH_LIBRARY names another one."""
    inside = pathlib.Path(__file__).parent / "lib" / _interface.SONAME
    path = os.environ.get("SKIAGRAPH_LIBRARY") or (str(inside) if inside.exists() else _interface.SONAME)
    try:
        return ffi.dlopen(path)
    except OSError as error:
        raise ImportError(f"{path} cannot be loaded: {error}. Install the library, or let SKIAGRAPH_LIBRARY name it "
                          "(an OpenCL driver is needed besides, such as pocl-opencl-icd)") from None


lib = _load()


def text(pointer: Any) -> str:
    """A C string; "" for NULL."""
    return "" if pointer == ffi.NULL else ffi.string(pointer).decode("utf-8", "replace")


def encode(value: str | os.PathLike[str], what: str) -> bytes:
    try:
        encoded = os.fsencode(value)
    except (TypeError, UnicodeError):
        raise ArgumentError(f"{what} is {value!r}; give a text") from None
    if b"\0" in encoded:
        raise ArgumentError(f"{what} has a zero byte")
    return encoded


def check(status: int) -> int:
    """Raises the error of a failure; returns the status of success, SKG_STALE or SKG_RANGE."""
    if status < 0:
        raise ERRORS.get(status, Error)(text(lib.skg_last_error()) or text(lib.skg_status_text(status)))
    return status


def call(name: str, *arguments: Any) -> int:
    try:
        status = getattr(lib, name)(*arguments)
    except (TypeError, OverflowError) as error:  # what C cannot take
        raise ArgumentError(f"{name}: {error}") from None
    return check(status)


def make(name: str, kind: str, *arguments: Any) -> Any:
    """Calls a function whose last argument is the address of a new handle."""
    address = ffi.new(f"{kind} **")
    call(name, *arguments, address)
    return address[0]


def release(kind: str, handle: Any) -> None:
    """Removes an owner of a handle; its kind is such as "skg_mesh"."""
    if handle != ffi.NULL:
        getattr(lib, kind + "_release")(ffi.new(f"{kind} **", handle))


def owned(kind: str, handle: Any) -> Any:
    """A handle that is released with its last reference. For kinds whose owners are counted atomically only."""
    free, new, null = getattr(lib, kind + "_release"), ffi.new, ffi.NULL

    def drop(pointer: Any) -> None:
        if pointer != null:
            free(new(f"{kind} **", pointer))

    return ffi.gc(handle, drop)


def retained(kind: str, handle: Any) -> Any:
    """A handle that belongs to somebody else, retained and released as one of `owned`."""
    call(kind + "_retain", handle)
    return owned(kind, handle)


def integer(name: str, *arguments: Any) -> int:
    """The number that a call gives through its last argument."""
    result = ffi.new("int64_t *")
    call(name, *arguments, result)
    return int(result[0])


def number(name: str, *arguments: Any) -> float:
    result = ffi.new("double *")
    call(name, *arguments, result)
    return float(result[0])


def string(name: str, *arguments: Any) -> str:
    result = ffi.new("const char **")
    call(name, *arguments, result)
    return text(result[0])


@functools.cache
def _defaults(kind: str) -> tuple[Any, Any, bytes]:
    """The types of a pointer and of an array of a kind of struct, and its bytes with the library's defaults."""
    made, size = ffi.new(f"{kind} *"), ffi.sizeof(kind)
    getattr(lib, kind + "_init_sized")(made, size)
    return ffi.typeof(f"{kind} *"), ffi.typeof(f"{kind}[]"), bytes(ffi.buffer(made))


def struct(kind: str, count: int | None = None) -> Any:
    """A struct, or an array of them, with the library's defaults."""
    one, many, defaults = _defaults(kind)
    made = ffi.new(one) if count is None else ffi.new(many, count)
    ffi.buffer(made)[:] = defaults if count is None else defaults * count
    return made


def filled(kind: str, name: str, *arguments: Any) -> dict[str, Any]:
    """The struct that a call fills, as a dictionary."""
    made = struct(kind)
    call(name, *arguments, made)
    return as_dict(made, kind)


def listed(kind: str, name: str, handle: Any) -> list[dict[str, Any]]:
    """All structs of a list of the library, by name_count and name_get."""
    return [filled(kind, name + "_get", handle, i) for i in range(integer(name + "_count", handle))]


def as_dict(pointer: Any, kind: str) -> dict[str, Any]:
    """The fields of a struct, without its size, handles and other pointers than texts."""
    found: dict[str, Any] = {}
    for name, field in ffi.typeof(kind).fields:
        value, cname = getattr(pointer, name), field.type.cname
        if name in ("size", "reserved"):
            continue
        if field.type.kind == "primitive":
            found[name] = _name_of(kind, name, value)
        elif cname == "char *":
            found[name] = text(value)
        elif cname.startswith("char["):
            found[name] = text(value)
        elif field.type.kind == "array" and field.type.item.kind == "primitive":
            found[name] = tuple(value)
    return found


def _enum_of(kind: str, name: str) -> dict[str, int] | None:
    """The enumeration of a field, which has the field's name, or the struct's and the field's."""
    return ENUMS.get(name) or ENUMS.get(f"{kind[len('skg_'):]}_{name}")


def _name_of(kind: str, name: str, value: Any) -> Any:
    values = _enum_of(kind, name)
    return next((n for n, v in values.items() if v == value), value) if values else value


def choice(enum: str, value: Any, what: str) -> int:
    """The number of an enumerator by its name."""
    values = ENUMS[enum]
    if isinstance(value, str) and value.lower() in values:
        return values[value.lower()]
    raise ArgumentError(f"{what} is {value!r}; give one of {', '.join(repr(name) for name in values)}")


def unknown(name: str, known: Iterable[str], what: str) -> ArgumentError:
    known = list(known)
    near = difflib.get_close_matches(name, known, 1)
    advice = f"did you mean {near[0]!r}?" if near else "there are " + ", ".join(known)
    return ArgumentError(f"{what} {name!r} is unknown; {advice}")


def fill(pointer: Any, kind: str, values: Mapping[str, Any], keep: list[Any], what: str) -> Any:
    """Writes values into the fields of a struct. What they point to is appended to keep."""
    fields = dict(ffi.typeof(kind).fields)
    for name, value in values.items():
        if name not in fields or name in ("size", "reserved"):
            raise unknown(name, (n for n in fields if n not in ("size", "reserved")), what)
        if value is not None:
            _set(pointer, kind, name, fields[name].type, value, keep)
    return pointer


def _set(pointer: Any, kind: str, name: str, field: Any, value: Any, keep: list[Any]) -> None:
    enum = _enum_of(kind, name)
    if field.kind == "primitive":
        if isinstance(value, str) and enum:
            value = choice(f"{kind[len('skg_'):]}_{name}" if name not in ENUMS else name, value, name)
        _assign(pointer, name, value, "a number" if not enum else "one of " + ", ".join(map(repr, enum)))
    elif field.kind == "array":
        given = np.atleast_1d(floats(value, name))
        if given.ndim != 1 or len(given) > field.length:
            raise ArgumentError(f"{name} has the shape {given.shape}; give up to {field.length} numbers")
        for i, element in enumerate(given):
            getattr(pointer, name)[i] = element
    elif field.item.kind == "struct" and isinstance(value, Mapping):
        inner = field.item.cname
        keep.append(fill(struct(inner), inner, value, keep, f"{name}: the field"))
        setattr(pointer, name, keep[-1])
    elif field.item.kind == "primitive" and field.item.cname != "char":
        setattr(pointer, name, doubles(value, name, keep))
    else:
        handle = getattr(value, "_handle", value)
        if not isinstance(handle, ffi.CData):
            raise ArgumentError(f"{name} is a {type(value).__name__}; give a {field.item.cname}")
        keep.append(value)
        setattr(pointer, name, handle)


def _assign(pointer: Any, name: str, value: Any, expected: str) -> None:
    try:
        setattr(pointer, name, int(value) if isinstance(value, (bool, np.integer, np.bool_)) else value)
    except (TypeError, OverflowError):
        raise ArgumentError(f"{name} is {value!r}; give {expected}") from None


def floats(values: Any, what: str) -> NDArray[np.float64]:
    """A dense array of doubles, a copy only if the values are others."""
    try:
        return np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"{what} is {values!r}; give numbers") from None


def doubles(values: Any, what: str, keep: list[Any]) -> Any:
    """A pointer to numbers as C has them; the array is copied only if it is laid out otherwise."""
    array = floats(values, what)
    keep.append(array)
    return ffi.cast("double *", ffi.from_buffer(array)) if array.size else ffi.NULL
