"""Files of gVXR's wheel that are not part of Skiagraph. Private."""
from __future__ import annotations

#: The mesh of gVXR's tutorials.
DRAGON = "welsh-dragon-small.stl"
ADVICE = "`python -m skiagraph.gvxr.dragon` fetches it from the wheel of gVXR (29 MB)"
