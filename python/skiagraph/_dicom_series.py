"""Folders of DICOM slices whose pixels the library does not expand: pydicom does. Private."""
from __future__ import annotations

import contextlib
import pathlib
import tempfile
from collections.abc import Iterator
from typing import Any

from ._interface import FileError


def _expand(path: pathlib.Path, data: Any) -> None:
    """Pixels as they are without compression, least significant byte first."""
    from pydicom.uid import ExplicitVRLittleEndian

    try:
        pixels = data.pixel_array
    except (AttributeError, NotImplementedError, RuntimeError, ValueError) as failure:
        raise FileError(f"{path}: its pixels cannot be read: {failure}") from failure
    data.PixelData = pixels.astype(pixels.dtype.newbyteorder("<")).tobytes()
    data["PixelData"].VR, data["PixelData"].is_undefined_length = "OW" if data.BitsAllocated > 8 else "OB", False
    data.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
    data.is_little_endian, data.is_implicit_VR = True, False


@contextlib.contextmanager
def expanded(folder: pathlib.Path) -> Iterator[str]:
    """A folder with the same slices, expanded, while the block lasts. ImportError: there is no pydicom."""
    import pydicom
    from pydicom.errors import InvalidDicomError
    from pydicom.uid import ExplicitVRLittleEndian, ImplicitVRLittleEndian

    with tempfile.TemporaryDirectory() as name:
        for path in sorted(folder.iterdir()):
            try:
                data = pydicom.dcmread(path)
            except (InvalidDicomError, IsADirectoryError):  # others may lie beside them
                continue
            if "PixelData" not in data:
                continue
            if data.file_meta.TransferSyntaxUID not in (ImplicitVRLittleEndian, ExplicitVRLittleEndian):
                _expand(path, data)
            data.save_as(pathlib.Path(name) / path.name, write_like_original=False)
        yield name
