"""Prints docs/gvxr.md: python3 gvxr_page.py > docs/gvxr.md, with the package on the path."""
from skiagraph.gvxr.calls import CALLS

HEAD = """# Scripts of gVXR

`from skiagraph import gvxr` instead of `from gvxrPython3 import gvxr` runs a script that was written for gVXR 2.1. Where a
script names the package, `gvxrPython3` becomes `skiagraph`, and `gvxrPython3.NAME` becomes `skiagraph.gvxr.NAME`. The module
was written from gVXR's documentation. Its values are in gVXR's units: MeV per pixel, cm of path length, matrices of 16
numbers column by column in mm. A call that is refused raises `skiagraph.UnsupportedError` with the reason.

The module is a package of its own, `skiagraph-gvxr`: `pip install . ./python/gvxr` in the folder of the project installs both.

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

## Where it behaves otherwise
| what | here | in gVXR 2.1 |
|---|---|---|
| a scene without meshes | renders the open beam | gives an empty image |
| no beam yet | an image of zeros, with a warning; no energies | an image of zeros, or an error |
| the last image before the first one | zeros | zeros, or an error |
| an unknown label | an error that names those that there are | goes on, or an error |
| a missing material | an error | an error |
| a mixture whose weights do not sum to 1 | scaled to 1, with a warning | scaled to 1 |
| a label that is made again | the mesh is replaced; surface and material stay | two children with one label |
| inner and outer surfaces | the inner ones displace the one outer surface; two outer ones are refused where there are inner ones | several outer ones |
| `voxelise`, `getLastVoxelisation` of gVXR 2.0 | `voxeliseImplicitSurface`, `getImplicitSurfaceLastVoxelisation` | no longer there |
| lengths through large triangles that lie oblique to the beam, near the source | exact | up to 7 % longer, at the top of the tutorial's pyramid |
| parts behind the detector | cast no shadow, with a warning where all lie there; a part astride is cut by the detector | in the image as if they lay before it |
| `PhotonCount` and files of spectra in `json2gvxr` | photons per pixel, as `skiagraph image` reads them | photons per cm2 at 1 m, before and after `initDetector`: 400 times fewer per pixel of 0.5 mm at 1 m |
| photons of a tube without an exposure | those of 1 mAs | a spectrum with a total energy of 80 eV |

## The modules beside it
| module | |
|---|---|
| `skiagraph.gvxr.utils` | every function. Spectra (`loadSpectrumSpekpy`, `loadXpecgenSpectrum` and the others) are those of Skiagraph's own tube, which is calibrated with SpekPy; neither package is needed. `visualise` gives Skiagraph's page of the scene instead of a plot of K3D: it has `display()`, `save(path)`, `fetch_screenshot()` and `screenshot`. The flags `has_...` of packages that are not needed are true |
| `skiagraph.json2gvxr` | every function, and `params`, which a script may change. A tube is Skiagraph's own. Energies count photons per pixel |
| `skiagraph.gvxr2json` | `saveJSON`. Meshes that were made are written as PLY beside the file |
| `skiagraph.gvxr.JSON2gVXRDataReader`, `skiagraph.gvxr.gVXRDataReader` | the readers for CIL, which has to be installed. Lengths are in mm |
| `skiagraph.gvxr.tests` | `test_gvxr` and `test_offscreen` |
| `skiagraph.gvxr.twins` | `DigitalTwin` and its parts, `createDigitalTwin`, `getDigitalTwinList` and the filters of `utils`. The descriptions of scanners are gVXR's (JSON5) and not part of Skiagraph: they are those of an installed gVXR, or fetched as below; `DigitalTwin.from_file` takes one of your own. `apply()` sets all layers anew; setting `sod` or `odd` gives that distance. A table of target currents is a list, not a table of pandas; a flux that is given by points needs SciPy |
| `benchmark`, `gvxr2radiograph`, `computeLBuffer` | are not there |

The tutorials load a dragon from the folder of the module. It is not part of Skiagraph, nor are the descriptions of the twins:
<!-- not run: it fetches 29 MB -->
```sh
python3 -m skiagraph.gvxr.dragon
```
asks pip for the wheel of gVXR 2.1.0 and copies the mesh beside the module, the descriptions into its folder `twins/models`;
with the path of a wheel it takes that one.

`python3 tests/python/gvxr_scripts.py FOLDER` runs the scripts and notebooks of a folder with the import alone changed, each in a
copy of its whole project, and counts those that end without an error. A comment `# arguments: ...` at the top of a script gives
it the words of a command line. On 25 November 2026, 58 public scripts and notebooks of 20 projects were run so, written out
without comments and with other meshes where theirs are not public: 57 ended well, 48 of them at their own sizes and 9 with
a detector 4 or 8 times coarser, and one of 1,030 images had not ended. Eleven take CIL, for which a stand-in stood. Some twenty more fail in
gVXR 2.1 itself, or for want of packages or of files, and were left out.

## Compared with gVXR
The test `tests/python/test_gvxr.py` runs one script with both modules, where the wheel `gvxr` is installed with an OpenGL
that works without a window. On 2026-11-23, with gVXR 2.1.0 on Mesa 22.3.6 (llvmpipe), 95 % of the pixels of an image agreed
within 1e-6 of the greatest value, after a blur within 3e-5, in a scan within 2e-4. Attenuation coefficients agreed within 2e-4 at 30, 60 and 120 keV. The pixels that differ
by up to 0.7 % of the open beam belong to rays that pass an edge of a cube: there gVXR's path lengths are too long, by 0.5 mm
of 20.4 mm. In the scan, two of 49152 pixels, on edges of the cube, differ by 15 %. Distances, magnification, matrices and
numbers of photons agreed to the digits of floats.

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
