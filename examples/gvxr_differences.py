"""Three numbers in which gVXR 2.1.0 and Skiagraph differ, beside what is right: python gvxr_differences.py gvxrPython3|skiagraph [OFF.npy]

The length through a turned cube, in closed form; the attenuation of a formula with brackets, by the sum over its elements; and that of
bone by Hounsfield numbers, beside those of its neighbours. OFF.npy receives how far each pixel of the cube is off, in mm.
"""
import importlib
import sys
import time

import numpy as np

name = sys.argv[1] if len(sys.argv) > 1 else "skiagraph"
module = importlib.import_module(name)
gvxr = module.gvxr if hasattr(module, "gvxr") else importlib.import_module("skiagraph.gvxr")
if name == "gvxrPython3":
    gvxr.createNewContext("EGL", 3, 3)
EDGE, TURN, SIDE, STEP = 20.0, (30, 1, 2, 3), 256, 0.25  # mm; degrees about an axis; pixels of mm
gvxr.setSourcePosition(0, -400, 0, "mm")
gvxr.usePointSource()
gvxr.setMonoChromatic(60, "keV", 1000)
gvxr.setDetectorPosition(0, 100, 0, "mm")
gvxr.setDetectorUpVector(0, 0, -1)
gvxr.setDetectorNumberOfPixels(SIDE, SIDE)
gvxr.setDetectorPixelSize(STEP, STEP, "mm")
gvxr.makeCube("cube", EDGE, "mm")
gvxr.addPolygonMeshAsInnerSurface("cube")
gvxr.setMu("cube", 0.2, "cm-1")
gvxr.rotateNode("cube", *TURN)

lengths = 10 * np.array(gvxr.computeLBuffer("cube"), dtype=float)  # mm
cpu = time.process_time()
for _ in range(10):
    gvxr.computeXRayImage()
cpu = (time.process_time() - cpu) / 10

# In the cube's own system, a ray from the source is inside between the planes of each axis.
turn = np.reshape(gvxr.getLocalTransformationMatrix("cube"), (4, 4))[:3, :3]  # rows are the columns of the matrix
at = (np.arange(SIDE) - (SIDE - 1) / 2) * STEP
right, up = np.array(gvxr.getDetectorRightVector()), np.array(gvxr.getDetectorUpVector())
pixels = np.array([0, 100, 0]) + at[:, None, None] * up + at[:, None] * right
source = turn @ [0, -400, 0]
ray = pixels @ turn.T - source
with np.errstate(divide="ignore"):
    ends = (np.array([[[-EDGE / 2]], [[EDGE / 2]]])[..., None] - source) / ray
inside = ends.max(0).min(-1) - ends.min(0).max(-1)
true = np.maximum(inside, 0) * np.linalg.norm(ray, axis=-1)
shadow = true > 0
error = np.abs(lengths - true)[shadow]
if len(sys.argv) > 2:
    np.save(sys.argv[2], np.where(shadow, lengths - true, np.nan))
print(f"length of a turned cube: rms error {np.sqrt((error ** 2).mean()):.2g} mm, in {100 * (error > 0.1).mean():.3g} % of the pixels of "
      f"its shadow more than 0.1 mm, greatest {error.max():.2g} mm; an image takes {1e3 * cpu:.3g} ms of the processors")

gvxr.setCompound("cube", "Ca5(PO4)3OH")
gvxr.setDensity("cube", 3.16, "g/cm3")
plain = "Ca5P3O13H"
bracketed = gvxr.getLinearAttenuationCoefficient("cube", 25, "keV")
gvxr.setCompound("cube", plain)
gvxr.setDensity("cube", 3.16, "g/cm3")
print(f"hydroxyapatite at 25 keV: Ca5(PO4)3OH {bracketed:.4g} per cm; {plain}, the same atoms, "
      f"{gvxr.getLinearAttenuationCoefficient('cube', 25, 'keV'):.4g}")
values = []
for hu in (1600, 1630, 1640, 1800, 2000, 2500, 3000):
    try:
        gvxr.setHU("cube", hu)
        values.append(f"{hu}: {gvxr.getLinearAttenuationCoefficient('cube', 60, 'keV'):.4g}")
    except Exception as error:  # one that only gVXR raises is a result, too
        values.append(f"{hu}: {type(error).__name__}")
print("per cm at 60 keV of Hounsfield numbers " + ", ".join(values))
