"""One script for both: `python gvxr_script.py gvxrPython3|skiagraph FILE` writes what it computes, as .npz."""
import importlib
import sys

import numpy as np

module = importlib.import_module(sys.argv[1])
gvxr = module.gvxr if hasattr(module, "gvxr") else importlib.import_module("skiagraph.gvxr")
found = {}


def keep(name, value):
    found[name] = np.array(value, dtype=float)


if sys.argv[1] == "gvxrPython3":
    gvxr.createNewContext("EGL", 4, 5)
else:
    gvxr.createOpenGLContext()
gvxr.setSourcePosition(0, -40, 0, "cm")
gvxr.usePointSource()
gvxr.setMonoChromatic(0.08, "MeV", 1000)
gvxr.setDetectorPosition(0, 10, 0, "cm")
gvxr.setDetectorUpVector(0, 0, -1)
gvxr.setDetectorNumberOfPixels(96, 64)
gvxr.setDetectorPixelSize(1, 1, "mm")
keep("right", gvxr.getDetectorRightVector())
keep("size", gvxr.getDetectorSize("cm"))
keep("distance", gvxr.getSDD("cm"))

gvxr.makeCube("cube", 3, "cm")
gvxr.addPolygonMeshAsOuterSurface("cube")
gvxr.setMu("cube", 0.2, "cm-1")
gvxr.makeCuboid("box", 6, 8, 10, "mm")
gvxr.addPolygonMeshAsInnerSurface("box")
gvxr.setMixture("box", ["Ti", "Al", "V"], [0.9, 0.06, 0.04])
gvxr.setDensity("box", 4.43, "g/cm3")
gvxr.translateNode("box", 5, 0, 4, "mm")
gvxr.rotateNode("box", 30, 0, 0, 1)
gvxr.rotateNode("box", 10, 20, 30)
gvxr.scaleNode("box", 1, 0.5, 1)
keep("local", gvxr.getLocalTransformationMatrix("box"))
keep("bounds", gvxr.getNodeOnlyBoundingBox("box", "mm"))
keep("vertices", gvxr.getVertexSet("cube")[:3])
keep("mono", gvxr.computeXRayImage())
keep("photons", gvxr.computeXRayImage(False))
keep("cube", gvxr.computeLBuffer("cube"))
keep("box", gvxr.computeLBuffer("box"))
keep("total", gvxr.getTotalEnergyWithDetectorResponse())
gvxr.moveToCentre("box")
keep("moved", gvxr.getLocalTransformationMatrix("box"))
gvxr.rotateScene(20, 0, 1, 0)
gvxr.computeXRayImage()  # gVXR's lengths of an outer surface are without the inner ones of the last image
keep("turned", gvxr.computeLBuffer("cube"))
gvxr.resetSceneTransformation()

for label, call, arguments in (("hu", "setHU", (50,)), ("element", "setElement", ("Fe",)),
                               ("mass", "setMixture", ("Ti90Al6V4",)), ("atoms", "setCompound", ("H2O",))):
    getattr(gvxr, call)("box", *arguments)
    if label in ("mass", "atoms"):
        gvxr.setDensity("box", 2, "g/cm3")
    keep("density " + label, gvxr.getDensity("box"))
    keep("mu " + label, [gvxr.getLinearAttenuationCoefficient("box", e, "keV") for e in (30, 60, 120)])

gvxr.setLocalTransformationMatrix("box", np.eye(4).ravel().tolist())  # its bounds are those of gVXR
gvxr.translateNode("box", 20, -50, 0, "mm")
keep("space", [gvxr.getSOD("box", "mm"), gvxr.getODD("mm"), gvxr.getMagnification(), gvxr.getFOV("mm"),
               gvxr.getBestSOD("cube", "mm"), gvxr.getOptimalNumberOfProjectionsCT(), *gvxr.getProjectionPixelSize("mm"),
               gvxr.getDetectorPixelArea("mm"), gvxr.getUnitOfElectriPotential("kV")])
gvxr.translateNode("box", 0, 50, 0, "mm")  # gVXR moves it as if it stood at the origin
gvxr.applySOD("box", 300, "mm")
keep("applied", gvxr.getLocalTransformationMatrix("box"))
gvxr.setLocalTransformationMatrix("box", np.eye(4).ravel().tolist())
gvxr.makeStepWedge("wedge", 5, 10, 2, 1, 3, "mm")
gvxr.shearNode("wedge", 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
keep("sheared", gvxr.getLocalTransformationMatrix("wedge"))
gvxr.setLocalTransformationMatrix("wedge", np.eye(4).ravel().tolist())
keep("wedge", gvxr.getNodeOnlyBoundingBox("wedge", "mm"))
gvxr.removeMeshAndChildren("wedge")
for name, call, arguments in (("elements", "setMixture", ([22, 13], [0.5, 0.3])), ("alloy", "setMixture", ("Ti90Al6V4",)),
                              ("water", "setCompound", ("H2O",))):
    getattr(gvxr, call)("box", *arguments)
    keep("effective parts " + name, [*gvxr.getMixtureElementSet("box"), *gvxr.getMixtureWeightSet("box")])
    keep("effective " + name, [gvxr.getEffectiveAtomicNumber("box"), gvxr.getEffectiveMolarMass("box")])
keep("correlation", [gvxr.computeZNCC([1., 2, 3], [2., 4, 7]), gvxr.getMean([1., 2, 3]), gvxr.getStddev([1., 2, 3])])
gvxr.setNumberOfPhotons(5000)
gvxr.addFilter("Al", 1, "mm")
keep("mu photons", [*gvxr.getPhotonCountEnergyBins(), *gvxr.getPhotonCountEnergyBins(False), gvxr.getNumberOfPhotonsPerCm2At1m()])
gvxr.clearFiltration()

gvxr.resetBeamSpectrum()
gvxr.addEnergyBinToSpectrum(30, "keV", 100)
gvxr.addEnergyBinToSpectrum(60, "keV", 200)
gvxr.setCompound("box", "H2O")
gvxr.setDensity("box", 1, "g/cm3")
keep("two energies", gvxr.computeXRayImage())
gvxr.setLSF([0.1, 0.8, 0.1])
keep("blurred", gvxr.computeXRayImage())
gvxr.clearLSF()
gvxr.setDetectorEnergyResponse([[10, 5], [100, 50]], "keV")
keep("response", gvxr.computeXRayImage())
gvxr.clearDetectorEnergyResponse()
gvxr.computeCTAcquisition("", "", 8, 0.0, False, 360.0, 4, 3, 0, 0, "mm", 0, 0, -1, True)
keep("scan", gvxr.getLastProjectionSet())
keep("angles", gvxr.getAngleSetCT())
gvxr.setMonoChromaticPerCm2At1m(0.08, "MeV", 1000)
keep("per cm2", gvxr.computeXRayImage())
gvxr.useParallelBeam()
gvxr.computeXRayImage()
keep("parallel", gvxr.computeLBuffer("cube"))
np.savez(sys.argv[2], **found)
