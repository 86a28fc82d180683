"""Prints docs/gvxr.md: python3 gvxr_page.py > docs/gvxr.md, with the package on the path."""
from skiagraph.gvxr.calls import CALLS

HEAD = """# Scripts of gVXR

`from skiagraph import gvxr` instead of `from gvxrPython3 import gvxr` runs a script that was written for gVXR 2.1, as far as
its tutorials go. The module was written from gVXR's documentation. Its values are in gVXR's units: MeV per pixel, cm of path
length, matrices of 16 numbers column by column in mm. A call that is refused raises `skiagraph.UnsupportedError` with the
reason. `from skiagraph.gvxr import json2gvxr` has `initGVXR` and the other `init...` calls that read a scene file;
`json2gvxr.doCTScan` is refused, `gvxr.computeCTAcquisition` takes the angles.

```python
from skiagraph import gvxr

gvxr.createOpenGLContext()                       # does nothing
gvxr.setSourcePosition(0, -40, 0, "cm")
gvxr.usePointSource()
gvxr.setMonoChromatic(0.08, "MeV", 1000)
gvxr.setDetectorPosition(0, 10, 0, "cm")
gvxr.setDetectorUpVector(0, 0, -1)
gvxr.setDetectorNumberOfPixels(640, 320)
gvxr.setDetectorPixelSize(0.5, 0.5, "mm")
gvxr.loadMeshFile("dragon", "welsh-dragon.stl", "mm")
gvxr.moveToCentre("dragon")
gvxr.setHU("dragon", 1000)
image = gvxr.computeXRayImage()                  # NumPy, [row, column], MeV
```

An unknown label, a missing material and a missing beam are errors here, where gVXR goes on. With one outer surface, the inner
ones displace it; two outer surfaces are refused.

The test `tests/python/test_gvxr.py` runs one script with both modules, where the wheel `gvxr` is installed with an OpenGL
that works without a window. On 2026-11-22, with gVXR 2.1.0 on Mesa 22.3.6 (llvmpipe), 95 % of the pixels of an image agreed
within 1e-6 of the greatest value, after a blur within 3e-5, in a scan within 2e-4. Attenuation coefficients agreed within 2e-4 at 30, 60 and 120 keV. The pixels that differ
by up to 0.7 % of the open beam belong to rays that pass an edge of a cube: there gVXR's path lengths are too long, by 0.5 mm
of 20.4 mm. In the scan, two of 49152 pixels, on edges of the cube, differ by 15 %.

## Every call
"same": the same arguments, values and units. "does nothing": it concerns windows, display or the repair of meshes.
"""

KINDS = {"same": "same", "differs": "differs", "nothing": "does nothing", "refused": "refused"}


def page():
    """The whole page."""
    lines = [HEAD, "| call | | |", "|---|---|---|"]
    for name, (kind, remark) in sorted(CALLS.items(), key=lambda item: item[0].lower()):
        lines.append(f"| `{name}` | {KINDS[kind]} | {'' if kind in ('same', 'nothing') else remark} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(page(), end="")
