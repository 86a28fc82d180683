"""Registering parts of a scene to radiographs. Private."""
from __future__ import annotations

import json
import os
import pathlib
import tempfile
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _arrays, _command
from ._interface import ArgumentError, SceneError

if TYPE_CHECKING:
    from ._state import State

#: An array [row, column], or a file.
Radiograph = Union[ArrayLike, "os.PathLike[str]", str]


def write(path: pathlib.Path, image: Any, name: str) -> str:
    """An array as a MetaImage of doubles; a file as it stands."""
    if isinstance(image, (str, os.PathLike)):
        return str(os.fspath(image))
    values = np.ascontiguousarray(_arrays.numbers(image, name), dtype="<f8")
    if values.ndim != 2:
        raise ArgumentError(f"{name}: an array of shape {values.shape}; give [row, column], or a file")
    rows, columns = values.shape
    header = (f"ObjectType = Image\nNDims = 2\nBinaryData = True\nBinaryDataByteOrderMSB = False\nElementSpacing = 1 1\n"
              f"DimSize = {columns} {rows}\nElementType = MET_DOUBLE\nElementDataFile = LOCAL\n")
    path.write_bytes(header.encode() + values.tobytes())
    return str(path)


def listed(images: Any) -> list[tuple[int | None, Any]]:
    """The radiographs with their projections; None is the scene's own view."""
    if isinstance(images, Mapping):
        return list(images.items())
    if isinstance(images, (list, tuple)) and not (images and np.ndim(images[0]) == 1):
        return list(enumerate(images))
    return [(None, images)]


def register(state: State, images: Any, parts: str | Sequence[str], out: str | os.PathLike[str] | None,
             flags: Mapping[str, Any], mask: Radiograph | None, flat: float | Radiograph | None) -> dict[str, Any]:
    if state.is_changed():
        raise SceneError("the scene was changed since it was read, and register() starts from it as it was read; save() it, and "
                         "register what sk.Scene reads of that file")
    with tempfile.TemporaryDirectory(prefix="skiagraph-") as name:
        folder = pathlib.Path(name)
        scene = state.source.path
        if scene is None:
            scene = str(folder / "scene.json")
            pathlib.Path(scene).write_bytes(state.source.text)
        words = ["register", scene, "--json", "-o", str(folder / "registered.json") if out is None else os.fspath(out)]
        for number, (projection, image) in enumerate(listed(images)):
            path = write(folder / f"{number}.mha", image, f"radiograph {number + 1}")
            words += ["--image", path if projection is None else f"{path}@{projection}"]
        for part in [parts] if isinstance(parts, str) else parts:
            words += ["--part", part]
        if mask is not None:
            words += ["--mask", write(folder / "mask.mha", mask, "mask")]
        if flat is not None:
            words += ["--flat", f"{flat!r}" if isinstance(flat, (int, float)) else write(folder / "flat.mha", flat, "flat")]
        for flag, value in flags.items():
            if value is True:
                words.append(flag)
            elif value is not None and value is not False:
                words += [flag, ",".join(map(repr, value)) if isinstance(value, tuple) else str(value)]
        if state.source.lenient:
            words.append("--lenient")
        for setting in state.source.settings:
            words += ["--set", setting]
        found: dict[str, Any] = json.loads(_command.run(*words, also=1))
    return found
