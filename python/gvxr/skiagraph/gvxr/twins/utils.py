"""The twins that there are."""
from __future__ import annotations

import importlib.util
import pathlib
from typing import Any

from .beam import TwinBeam
from .digital_twin import DigitalTwin
from .json5 import loads

__all__ = ["createDigitalTwin", "getAvailableFilters", "getDigitalTwinList", "getFilterMaterial", "getFilterThickness"]

ADVICE = "`python -m skiagraph.gvxr.dragon` fetches them from the wheel of gVXR"
_read: list[dict[str, Any]] = []


def models() -> pathlib.Path:
    """The folder of the descriptions: beside this file, or that of an installed gVXR."""
    here = pathlib.Path(__file__).parent / "models"
    if any(here.glob("*.json5")):
        return here
    installed = importlib.util.find_spec("gvxrPython3")
    for folder in installed.submodule_search_locations or [] if installed else []:
        if any(pathlib.Path(folder, "twins", "models").glob("*.json5")):
            return pathlib.Path(folder, "twins", "models")
    raise FileNotFoundError(f"{here}: the descriptions of the twins are gVXR's and not part of Skiagraph; {ADVICE}; "
                            "DigitalTwin.from_file takes a description of your own")


def getDigitalTwinList() -> list[dict[str, Any]]:
    """The descriptions of the twins, by the names of their files."""
    if not _read:
        _read.extend(loads(path.read_text(encoding="utf-8")) for path in sorted(models().glob("*.json5")))
    return _read


def createDigitalTwin(*, id: int | None = None, name: str | None = None) -> DigitalTwin:
    """A twin by its place in the list, or by its name in any case."""
    if (id is None) == (name is None):
        raise ValueError("give either the id or the name of a twin")
    known = getDigitalTwinList()
    for at, twin in enumerate(known):
        if at == id or (name is not None and name.upper() == twin["name"].upper()):
            return DigitalTwin.from_json(twin)
    raise ValueError(f"there is no twin {id if name is None else name!r}; the twins are "
                     + ", ".join(f"{at} {twin['name']!r}" for at, twin in enumerate(known)))


def _beam(twin: DigitalTwin, beam_type: str) -> TwinBeam:
    return twin.specification.beams[beam_type]


def getAvailableFilters(twin: DigitalTwin, beam_type: str) -> list[list[Any]]:
    """The filters of a beam: a material and thicknesses in mm."""
    return _beam(twin, beam_type).filters


def getFilterMaterial(twin: DigitalTwin, beam_type: str) -> list[str]:
    """The materials of the filters of a beam, and "None"."""
    return ["None", *(layer[0] for layer in _beam(twin, beam_type).filters)]


def getFilterThickness(twin: DigitalTwin, beam_type: str, material: str) -> list[str]:
    """The thicknesses in mm of a material, 0.0 before them."""
    return ["0.0", *(str(mm) for layer in _beam(twin, beam_type).filters if layer[0] == material for mm in layer[1:])]
