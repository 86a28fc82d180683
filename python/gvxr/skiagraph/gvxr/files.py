"""Image files that gVXR writes and Skiagraph does not, or otherwise: flat MetaImage, text, and DICOM. Private."""
from __future__ import annotations

import os
import struct
import tempfile
import uuid
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import ArgumentError, FileError

_Spacing = tuple[float, float]


def _replace(path: str, content: bytes) -> None:
    """Writes a file that appears whole or not at all."""
    name = ""
    try:
        handle, name = tempfile.mkstemp(prefix=os.path.basename(path), dir=os.path.dirname(path) or ".")
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)  # mkstemp lets the owner alone read
        os.replace(name, path)
    except OSError as error:
        if name and os.path.exists(name):
            os.unlink(name)
        raise FileError(f"{path}: cannot be written: {error.strerror}") from None


def _header(image: NDArray[np.float32], spacing: _Spacing, data: str, comment: str) -> bytes:
    """As many dimensions as the array has, and no place in the world, as gVXR's have none."""
    steps = [*spacing, 1.0][:image.ndim]
    lines = ["ObjectType = Image", f"NDims = {image.ndim}", f"Comment = {comment}", "BinaryData = True",
             "BinaryDataByteOrderMSB = False", "CompressedData = False", "DimSize = " + " ".join(map(str, image.shape[::-1])),
             "ElementSpacing = " + " ".join(f"{step:.9g}" for step in steps), "ElementType = MET_FLOAT",
             f"ElementDataFile = {data}"]
    return ("\n".join(lines) + "\n").encode()


def _mha(path: str, image: NDArray[np.float32], spacing: _Spacing, comment: str) -> None:
    _replace(path, _header(image, spacing, "LOCAL", comment) + image.astype("<f4").tobytes())


def _mhd(path: str, image: NDArray[np.float32], spacing: _Spacing, comment: str) -> None:
    """The header, and the numbers in a file .raw beside it."""
    raw = os.path.splitext(path)[0] + ".raw"
    _replace(raw, image.astype("<f4").tobytes())
    _replace(path, _header(image, spacing, os.path.basename(raw), comment))


def _raw(path: str, image: NDArray[np.float32], spacing: _Spacing, comment: str) -> None:
    _replace(path, image.astype("<f4").tobytes())


def _txt(path: str, image: NDArray[np.float32], spacing: _Spacing, comment: str) -> None:
    """A line a row; NumPy's loadtxt reads it."""
    _replace(path, "".join(" ".join(f"{value:.9g}" for value in row) + "\n" for row in image.tolist()).encode())


def _element(group: int, number: int, kind: str, value: bytes) -> bytes:
    """A data element with explicit kind, little endian, of even length."""
    if len(value) % 2:
        value += b"\0" if kind == "UI" else b" "
    if kind in ("OB", "OW"):
        return struct.pack("<HH2sHI", group, number, kind.encode(), 0, len(value)) + value
    return struct.pack("<HH2sH", group, number, kind.encode(), len(value)) + value


def _dicom(path: str, image: NDArray[np.float32], spacing: _Spacing, comment: str) -> None:
    """A secondary capture of 16 bits; slope and intercept give the values back to 1/65535 of their range."""
    low, high = float(image.min()), float(image.max())
    slope = float(f"{(high - low) / 65535:.9g}") or 1.0  # a decimal string has at most 16 characters
    levels = np.clip(np.rint((image - low) / slope), 0, 65535).astype("<u2")
    capture, instance, study, series = (b"1.2.840.10008.5.1.4.1.1.7", *(f"2.25.{uuid.uuid4().int}".encode() for _ in range(3)))
    meta = b"".join(_element(2, *row) for row in (
        (1, "OB", b"\0\1"), (2, "UI", capture), (3, "UI", instance), (0x10, "UI", b"1.2.840.10008.1.2.1"), (0x12, "UI", b"2.25.1")))
    numbers = {0x02: 1, 0x10: image.shape[0], 0x11: image.shape[1], 0x100: 16, 0x101: 16, 0x102: 15, 0x103: 0}
    rows: list[tuple[int, int, str, bytes]] = [
        (8, 0x16, "UI", capture), (8, 0x18, "UI", instance), (8, 0x20, "DA", b""), (8, 0x30, "TM", b""), (8, 0x50, "SH", b""),
        (8, 0x60, "CS", b"OT"), (8, 0x64, "CS", b"WSD"), (8, 0x70, "LO", b"Skiagraph"), (8, 0x90, "PN", b""),
        (0x10, 0x10, "PN", b""), (0x10, 0x20, "LO", b""), (0x10, 0x30, "DA", b""), (0x10, 0x40, "CS", b""),
        (0x20, 0x0D, "UI", study), (0x20, 0x0E, "UI", series), (0x20, 0x10, "SH", b""), (0x20, 0x11, "IS", b""),
        (0x20, 0x13, "IS", b"1"), (0x20, 0x20, "CS", b""), (0x28, 0x04, "CS", b"MONOCHROME2"),
        (0x28, 0x30, "DS", f"{spacing[1]:.9g}\\{spacing[0]:.9g}".encode()), (0x28, 0x1052, "DS", f"{low:.9g}".encode()),
        (0x28, 0x1053, "DS", f"{slope:.9g}".encode()), (0x28, 0x1054, "LO", b"US"),
        *((0x28, number, "US", struct.pack("<H", value)) for number, value in numbers.items()),
        (0x7FE0, 0x10, "OW", levels.tobytes())]
    data = b"".join(_element(*row) for row in sorted(rows, key=lambda row: row[:2]))
    _replace(path, b"\0" * 128 + b"DICM" + _element(2, 0, "UL", struct.pack("<I", len(meta))) + meta + data)


_WRITERS: dict[str, tuple[Callable[[str, Any, _Spacing, str], None], bool]] = {
    ".mha": (_mha, True), ".mhd": (_mhd, True), ".raw": (_raw, True), ".txt": (_txt, False), ".dcm": (_dicom, False)}


def write_other(path: str, image: Any, spacing: _Spacing, comment: str) -> bool:
    """Writes [row, column] or [n, row, column] by the extension; False if it is none of these. spacing: mm."""
    extension = os.path.splitext(path)[1].lower()
    if extension not in _WRITERS:
        return False
    writer, several = _WRITERS[extension]
    if image.ndim != 2 and not several:
        raise ArgumentError(f"{path}: {extension} holds one image and not {image.shape[0]}; give .mhd, .mha or .tif")
    writer(path, np.ascontiguousarray(image, np.float32), spacing, comment)
    return True
