"""Every call of gVXR 2.1: whether it is here, and how it differs. Private; docs/gvxr.md is made from it.

"same": the same arguments, values and units. "differs": it is here, and the remark says what is different. "nothing": it
concerns windows or display and does nothing. "refused": it raises UnsupportedError with the remark.
"""
from __future__ import annotations

_SAME = """
addEnergyBinToSpectrum addEnergyBinToSpectrumPerCm2At1m addEnergyBinToSpectrumPerPixelAtSDD addMesh
addPolygonMeshAsInnerSurface applyCurrentLocalTransformation clearDetectorEnergyResponse clearFiltration
clearInherentFiltration clearLSF computeZNCC destroy destroyAllWindows disablePoissonNoise emptyMesh getAmbientColour
getAngleSetCT getDetectorBias getDetectorGain getDetectorStdDevBias setDetectorBias setDetectorGain
setDetectorStdDevBias getBestSOD getCentreOfRotationPositionCT getChildLabel getDensityFromElement
getDetectorNumberOfPixels getDetectorPixelArea getDetectorPixelSpacing getDetectorPosition getDetectorPositionSet
getDetectorRightVector getDetectorSize getDiffuseColour getEffectiveAtomicNumber getEffectiveMolarMass
getEffectiveZNumber getElementAtomicNumber getElementMolarMass getElementName getElementSymbol getEnergyBins
getEnergyBinSize getFiltrationMaterial getFiltrationThickness getFirstAngleCT getIdentityMatrix4 getImageHeght
getImageRow getImageWidth getIncludeLastAngleFlagCT getIndexNumber getInherentFiltrationMaterial
getInherentFiltrationThickness getLastAngleCT getLastProjectionSet getLocalTransformationMatrix getLSF getmAs
getMaxValue getMean getMeshFilename getMeshUnitOfLength getMinValue getMixtureElementSet getMixtureWeightSet
getNodeLocalTransformationMatrix getNodeWorldTransformationMatrix getNumberOfChildren getNumberOfPhotonCountingBands
getNumberOfPhotons getNumberOfPhotonsPerCm2At1m getNumberOfPhotonsPerPixelAtSDD getNumberOfPrimitives
getNumberOfProjectionsCT getNumberOfVertexNormalVectors getOversamplingFactor getPhotonCountEnergyBins
getPhotonCountingBands getPhotonCountsPerCm2At1m getPhotonCountsPerPixelAtSDD getProjectionOutputPathCT
getRotationAxisCT getSceneRotationMatrix getSceneTransformationMatrix getScintillatorMaterial getScintillatorThickness
getScreenshotOutputPathCT getSDD getShininess getSourceDetectorDistance getSourcePosition getSourcePositionSet
getSourceShape getSpecularColour getStddev getSupportedScintillatorMaterials getTotalEnergyWithoutDetectorResponse
getTubeAngle getUnitOfElectriPotential getUnitOfEnergy getUnitOfLength getVertexNumber getWhiteImagesInFlatFieldCT
getWindowSize getZoom hasNormalVectorsInverted isInnerSurface isOuterSurface isUsingConeBeam isUsingFocalSpot
isUsingParallelBeam isUsingParallelSource isUsingPointSource lineariseTest loadDetectorEnergyResponse loadMeshFile
loadReference loadSpectrumFromTSV loadSpectrumFromTSVPerCm2At1m loadSpectrumFromTSVPerPixelAtSDD loadTest makeCube
makeCuboid makeCylinder mergePhotonCountingBands radian2degree removeMeshAndChildren removePolygonMeshesFromSceneGraph
removePolygonMeshesFromXRayRenderer resetBeamSpectrum resetSceneTransformation rotateDetector rotateNode rotateScene
saveSTLfile scaleNode scaleScene setAmbiantColour setColor setColour setDensity setDetectorEnergyResponse
setDetectorNumberOfPixels setDetectorPixelPitch setDetectorPixelSize setDetectorPosition setDetectorRightVector
setDetectorSize setDetectorUpVector setDiffuseColour setElement setFiltration setLinearAttenuationCoefficient
setLocalTransformationMatrix setMonoChromatic setMonoChromaticPerCm2At1m setMonoChromaticPerPixelAtSDD setMu
setNodeTransformationMatrix setNumberOfPhotons setNumberOfPhotonsPerCm2At1m setNumberOfPhotonsPerPixelAtSDD
setSceneTransformationMatrix setSourcePosition setSpecularColour setTubeAngle shearNode terminate translateNode
translateScene useConeBeam useParallelBeam useParallelSource usePointSource usePoissonNoise
"""

_DIFFERS = {
    "elements at Skiagraph's densities, such as carbon at 2.0 g/cm3; gVXR takes 2.267":
        """addFilter addInherentFilter""",
    "directions have length 1; in gVXR 2.1 the right vector that follows the beam is shorter where up is not perpendicular to it":
        """autoAlignDetector""",
    "marching tetrahedra; the mesh is closed where it meets the border of the volume":
        """createMeshFromImplicitSurface""",
    "lengths of the parameters are in mm":
        """addControlLineSegment addControlPoint createImplicitSurface destroyAllImplicitSurfaces
        destroyImplicitSurface getImplicitSurfaceLabelSet getImplicitSurfaceLastVoxelisation
        getImplicitSurfaceLastVoxelization getNumberOfControlLineSegments getNumberOfControlPoints
        getNumberOfImplicitSurfaces implicitSurfaceExists setControlLineSegmentParameters setControlPointParameters
        voxeliseImplicitSurface voxelizeImplicitSurface""",
    "exact spheres that do not overlap, up to some 50 % of the box; voxels and the name of the volume have no effect":
        """makeFoamInCuboid""",
    "what is at or above the value is inside; the surface is closed where it meets the border of the volume; the arguments that"
    " gVXR documents, and those that its tutorials give: the volume, one value or two, its centre, its spacings":
        """makeIsoSurface""",
    "10 steps unless their number is given, as gVXR documents; gVXR 2.1 makes 2":
        """makeStepWedge""",
    "without indices each three vertices are a triangle, and the mesh must be closed by them":
        """makeTriangularMesh""",
    "spheres lie in the cylinder, do not overlap, and fill the percentage; half as many rings as sectors":
        """makeSpheresInCylinder""",
    "the mesh stands at this distance along the beam; gVXR 2.1 moves it as if it stood at the origin":
        """applySOD""",
    "gain x image + bias, rounded to whole numbers from 0 to 65535, with normal deviations of the bias; gVXR 2.1 adds the bias to"
    " white images alone, no deviations, and refuses a gain below 1":
        """computeXRayImageWithGain getWhiteImageWithGain getWhiteSpectralImageWithGain""",
    "as computeCTAcquisition; projections and white images have gain and bias. gVXR 2.1 stops: it is not implemented there":
        """computeCTAcquisitionWithGain getLastProjectionSetWithGain""",
    "gain x energy + bias, rounded, from 0 to 65535; gVXR 2.1 leaves out the bias":
        """getTotalEnergyWithDetectorResponseWithGain getTotalEnergyWithoutDetectorResponseWithGain""",
    "says that it is Skiagraph's own":
        """getNoiseGenerator""",
    "the mesh from which others are subtracted, or each of its pieces, has to be convex before the first of them; what two of"
    " them share is subtracted twice":
        """subtractMesh""",
    "with inner surfaces one outer surface; they displace it where they are":
        """addPolygonMeshAsOuterSurface""",
    "returns the projections; no screenshots; angles divide the range evenly in both cases; a folder with"
    " projection_0000.tiff, ..., or one file if the name ends in .tif, .tiff or .mha":
        """computeCTAcquisition""",
    "float32 instead of float64; exact at silhouettes, where gVXR is not; of an outer surface without the "
    "inner ones as they stand, in gVXR as they stood in the last image; an unknown label is an error":
        """computeLBuffer""",
    "as computeLBuffer":
        """computePathLength""",
    "the root of the mean, as gVXR documents it; gVXR 2.1 takes the root of the sum":
        """computeRMSE""",
    "[band, row, column]; needs setPhotonCountingBands":
        """computeSpectralImage""",
    "float32 instead of float64; photons per pixel counted by the quantity `photons`; without meshes the open"
    " beam, where gVXR gives nothing":
        """computeXRayImage""",
    "cross sections of NIST XCOM 8.1: some 0.1 % from gVXR's of xraylib":
        """convertHU2mu getLinearAttenuationCoefficient getMassAttenuationCoefficient getMassAttenuationFromCompound
        getMassAttenuationFromElement getMassAttenuationFromHU getMassAttenuationFromMixture""",
    "other random numbers; an exposure in mAs does not turn it on":
        """enablePoissonNoise""",
    "the formula that was set; an empty text for other materials, where gVXR fails":
        """getCompound""",
    "0 instead of a negative number where it has no meaning":
        """getDensity""",
    "the same tables (Schneider 2000), -1050 to 3000":
        """getDensityFromHU""",
    "unit vectors; gVXR 2.1 moves them as if they were positions":
        """getDetectorRightVectorSet getDetectorUpVectorSet""",
    "0, 0, 1 until it is set":
        """getDetectorUpVector""",
    "the four corners in this order: the two triangles may be cut along the other diagonal":
        """getDetectorVertices""",
    "of the response as Skiagraph has it (setScintillator), at 1000 energies from 1 to 300 keV":
        """getEnergyResponse""",
    "there is one for each triangle; gVXR 2.1 has none":
        """getFaceNormalVectorSet getNumberOfFaceNormalVectors""",
    "an array of int32; meshes that are made have their triangles in another order":
        """getIndexSet""",
    "zeros before the first one":
        """getLastLBuffer getLastXRayImage""",
    "Skiagraph's own picture of the scene":
        """getLatestScreenshot takeScreenshot""",
    "2, 1, 0: the gVXR whose calls these are":
        """getMajorVersionOfCoreGVXR getMajorVersionOfSimpleGVXR getMinorVersionOfCoreGVXR getMinorVersionOfSimpleGVXR
        getPatchVersionOfCoreGVXR getPatchVersionOfSimpleGVXR""",
    "coefficients and the fractions of a mixture given as a list are not rounded":
        """getMaterialLabel""",
    "cross sections of NIST XCOM 8.1, and the composition of Schneider 2000":
        """getMuFromHU""",
    "the bounds of the vertices as they stand; gVXR 2.1 turns two corners of the mesh's own box: a cube turned by 45 degrees is 0 wide"
    " there, and bounds of other meshes are too large or too small":
        """getNodeAndChildrenBoundingBox getNodeOnlyBoundingBox""",
    "the middle of these bounds":
        """getNodeAndChildrenBoundingBoxCenter getNodeAndChildrenBoundingBoxCentre getNodeOnlyBoundingBoxCenter
        getNodeOnlyBoundingBoxCentre""",
    "of the device of OpenCL":
        """getOpenGlRenderer getOpenGlVendor getOpenGlVersion""",
    "other random numbers":
        """getPSNR setSeed""",
    "gVXR 2.1 has not implemented it":
        """getRootTransformationMatrix setRootTransformationMatrix""",
    "of the response as Skiagraph has it (setScintillator)":
        """getTotalEnergyWithDetectorResponse""",
    "says that it is Skiagraph":
        """getVersionOfCoreGVXR getVersionOfSimpleGVXR""",
    "the mean of the triangles' normals by area, of length 1, and not moved by the matrix":
        """getVertexNormalVectorSet""",
    "an array of float64; meshes that are made have their vertices in another order":
        """getVertexSet""",
    "other words; a label for the second argument":
        """getVisibilityCheckReport""",
    "-1 V to -1 MV, by its unit, until it is set":
        """getVoltage""",
    "with photon counting too, where gVXR refuses it":
        """getWhiteImage""",
    "[band, row, column]; gVXR 2.1 refuses it":
        """getWhiteSpectralImage""",
    "a closed mesh points outward whatever is asked":
        """invertNormalVectors""",
    "all meshes of the file are one, with the name of the file":
        """loadSceneGraph""",
    "half as many rings as sectors, whatever is asked":
        """makeSphere""",
    "by the bounds of the vertices as they stand":
        """moveToCenter moveToCentre""",
    "to the middle of the bounds of the vertices as they stand, of all meshes; gVXR 2.1 leaves out meshes that are not in the X-ray"
    " renderer and has other bounds of turned ones (getNodeOnlyBoundingBox): 407.1 instead of 403.6 mm to a tetrahedron turned by"
    " 45 degrees":
        """getFOV getFieldOfView getMagnification getODD getObjectDetectorDistance getOptimalNumberOfProjectionsCT
        getProjectionPixelSize getSOD getSourceObjectDistance""",
    "multiples of the direction, rising; origin and direction in mm":
        """rayIntersect""",
    ".png, .tif, .mha, .mhd, .txt or .dcm; not compressed":
        """saveLastLBuffer saveLastPathLength saveLastXRayImage saveLastXRayImageWithGain""",
    ".tif, .mha or .mhd; not compressed":
        """saveLastProjectionSet""",
    "a name of the tables has no effect: formulas by atoms only":
        """setCompound""",
    "0.1 to 10 keV; energies are the middles of the bins":
        """setEnergyBinSize""",
    "the grid of energies stays: those below are left out":
        """setFirstEnergyBin""",
    "the middles of i x i x i equal pieces":
        """setFocalSpot""",
    "the larger of i and j counts along both sides; the middles of equal pieces":
        """setFocalSpotAsRectangle""",
    "the middles of i x i equal pieces, across the line to the detector":
        """setFocalSpotAsSquare""",
    "-1050 to 3000; cross sections of NIST XCOM 8.1":
        """setHounsfieldUnit setHounsfieldValue setHU""",
    "a text file too, as json2gvxr needs it":
        """setLSF""",
    "photons are counted absolutely and fall off with the distance; noise only by enablePoissonNoise":
        """setmAs""",
    "weights that do not sum to 1 are scaled with a warning, where gVXR scales them silently":
        """setMixture""",
    "1 to 16; rays at the middles of the pieces of a pixel":
        """setOversamplingFactor""",
    "bands of equal width from the least to the greatest energy":
        """setPhotonCountingBands""",
    "takeScreenshot shows it from there; the picture always holds the whole scene":
        """setSceneRotationMatrix""",
    "scattered photons and K fluorescence leave the layer or are absorbed in it: 500 um of CsI record 29.0 keV of a photon of 36 keV;"
    " gVXR 2.1 has 11.7 there and 28.9 at 60 keV, where 44.8 are recorded; materials by formula or by a name of the tables":
        """setScintillator""",
    "kept, and not shown by takeScreenshot":
        """setShininess setWindowBackGroundColor setWindowBackGroundColour setZoom""",
    "the tube model of Ebel, calibrated (docs/physics.md); gVXR 2.1 without SpekPy has 4.4 times as many photons per mAs at 100 kV"
    " behind 1 mm of aluminium":
        """setVoltage""",
    "the size of a screenshot":
        """setWindowSize""",
}

_NOTHING = """
autoCreateOpenGLContext computeMixedPrecisionFlag createNewContext createOpenGLContext createWindow
cursorPositionCallback destroyWindow disableArtefactFiltering disableArtifactFiltering displayBeam displayDetector
displayNode displayNormalVectors displayScene enableArtefactFilteringOnCPU enableArtefactFilteringOnGPU
enableArtifactFilteringOnCPU enableArtifactFilteringOnGPU findEGLClients hideWindow lookAt orthographic perspective
popModelViewMatrix pushModelViewMatrix renderLoop rotateModelView scrollCallback setAxisLength setBinTotalEnergyCutoff
setMarkerLength setMaxRadiusLbufferArtefactFilter setWindowPosition showWindow startArcBallRotation
stopArcBallRotation useLighing useLogFile useNegative useWireframe usingArcBallRotation
"""

_REFUSED = {
    "read it by the package that wrote it, such as SimpleITK; makeIsoSurface takes the array":
        """loadImage2D loadImage3D""",
    "gVXR 2.1 refuses it too: use computeCTAcquisition":
        """computeProjectionSet computeSinogram""",
    "gVXR's documentation does not say how the index is computed (it is 0 for one energy); compare computeXRayImage of the"
    " beam with that of its mean energy":
        """getBHPI""",
    "OpenGL is not used":
        """getBuildEnvironment getLargestPossibleDetectorNumberOfPixels getLargestPossibleNumberOfEnergyBins
        getMax2DTextureSize getMax3DTextureSize getMaxRadiusLbufferArtefactFilter getMixedPrecisionFlag
        getNumberOfEGLDevices getPrecisionCleanedLBuffer getPrecisionCumulatedLBuffer getPrecisionEnergyFluence
        getPrecisionSumMuXdX getPrecisionUncleanedLBuffer getPrecisionZBuffer getShadingLanguageVersion
        isArtefactFilteringOnCPUEnabled isArtefactFilteringOnGPUEnabled""",
    "there is no computeSinogram: take rows of getLastProjectionSet":
        """getLastSinogram saveLastSinogram""",
    "compute it from the images with NumPy":
        """getWhiteLevel setWhiteLevel""",
    "a flat spot lies across the line to the detector: give skiagraph.Scene.image(spot={\"axis\": ...})":
        """rotateFocalSpot""",
    "its centre has no unit in gVXR's documentation: call setSourcePosition with the turned position":
        """rotateSource""",
    "nothing is summed up over meshes but the image":
        """saveLastCumulatedLBuffer""",
    "gVXR 2.1 finds no properties after it: use setMu with the product of coefficient and density":
        """setMassAttenuationCoefficient""",
}

#: name -> (kind, remark)
CALLS: dict[str, tuple[str, str]] = {
    **{name: ("same", "") for name in _SAME.split()},
    **{name: ("differs", remark) for remark, names in _DIFFERS.items() for name in names.split()},
    **{name: ("nothing", "no window, no display; leaky meshes are repaired by default") for name in _NOTHING.split()},
    **{name: ("refused", remark) for remark, names in _REFUSED.items() for name in names.split()},
}


def description(name: str) -> str:
    """Text of help() for a call that has no words of its own."""
    kind, remark = CALLS[name]
    if kind == "same":
        return f"The arguments, values and units of gVXR's {name}."
    if kind == "nothing":
        return f"Does nothing: {remark}."
    return f"gVXR's {name}; what differs: {remark}."
