"""python -m skiagraph.gvxr.tests.test_gvxr"""
from __future__ import annotations

from . import test_gvxr

if __name__ == "__main__":
    test_gvxr()
