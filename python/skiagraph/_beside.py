"""Finds what other packages add to this one: skiagraph.gvxr, of the package skiagraph-gvxr. Private."""
from __future__ import annotations

import pathlib
import sys
from collections.abc import Iterable


def folders(own: Iterable[str]) -> list[str]:
    """Where modules of this package are looked for: here, where skiagraph.gvxr lies if it was installed into another folder, or is
    edited in its own, and at last where a sentence says that it is not there."""
    given = list(own)
    places = (pathlib.Path(entry) / "skiagraph" for entry in sys.path)
    beside = [str(place) for place in places if (place / "gvxr" / "__init__.py").exists() and not (place / "__init__.py").exists()]
    return [*given, *beside, str(pathlib.Path(__file__).parent / "_without")]
