"""python -m skiagraph.gvxr.tests.test_offscreen"""
from __future__ import annotations

from . import test_offscreen

if __name__ == "__main__":
    test_offscreen()
