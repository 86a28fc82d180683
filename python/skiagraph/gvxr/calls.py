"""Every call of gVXR 2.1: whether it is here, and how it differs. Private; docs/gvxr.md is made from it.

"same": the same arguments, values and units. "differs": it is here, and the remark says what is different. "nothing": it
concerns windows or display and does nothing. "refused": it raises UnsupportedError with the remark.
"""
from __future__ import annotations

_NO_WINDOW = "there is no window"
_NO_SURFACES = "implicit surfaces and volumes are not simulated"
_NO_GAIN = "gain, bias and their deviations are not simulated"
_UNKNOWN = "not part of the calls that the tutorials use"
_RESULT = "compute it from the images with NumPy"
_TUBE = "read it from the spectrum, getEnergyBins and getPhotonCountEnergyBins"
_GL = "OpenGL is not used"

_SAME = """
addEnergyBinToSpectrum addEnergyBinToSpectrumPerCm2At1m addEnergyBinToSpectrumPerPixelAtSDD addFilter addMesh
addPolygonMeshAsInnerSurface applyCurrentLocalTransformation clearDetectorEnergyResponse clearFiltration clearLSF
destroy destroyAllWindows disablePoissonNoise emptyMesh getAngleSetCT getChildLabel getDensityFromElement
getDetectorNumberOfPixels getDetectorPixelSpacing getDetectorPosition getDetectorRightVector getDetectorSize
getDetectorUpVector getElementAtomicNumber getElementSymbol getEnergyBins getLastLBuffer getLastProjectionSet
getLastXRayImage getLocalTransformationMatrix getNodeWorldTransformationMatrix getNumberOfChildren
getNumberOfPrimitives getPhotonCountEnergyBins getPhotonCountsPerPixelAtSDD getSDD getSceneTransformationMatrix
getSourceDetectorDistance getSourcePosition getTotalEnergyWithoutDetectorResponse getUnitOfEnergy getUnitOfLength
getmAs isInnerSurface isOuterSurface isUsingConeBeam isUsingFocalSpot isUsingParallelBeam isUsingParallelSource
isUsingPointSource loadDetectorEnergyResponse loadMeshFile loadSpectrumFromTSV loadSpectrumFromTSVPerCm2At1m
loadSpectrumFromTSVPerPixelAtSDD makeCube makeCuboid makeCylinder makeTriangularMesh removeMeshAndChildren
removePolygonMeshesFromSceneGraph removePolygonMeshesFromXRayRenderer resetBeamSpectrum resetSceneTransformation
rotateNode rotateScene saveSTLfile scaleNode scaleScene setDensity setDetectorEnergyResponse setDetectorNumberOfPixels
setDetectorPixelPitch setDetectorPixelSize setDetectorPosition setDetectorRightVector setDetectorSize
setDetectorUpVector setElement setFiltration setLSF setLinearAttenuationCoefficient setLocalTransformationMatrix
setMixture setMonoChromatic setMonoChromaticPerCm2At1m setMonoChromaticPerPixelAtSDD setMu setNodeTransformationMatrix
setSourcePosition setTubeAngle terminate translateNode translateScene useConeBeam useParallelBeam useParallelSource
usePointSource usePoissonNoise
"""

_DIFFERS = {
    "addPolygonMeshAsOuterSurface": "one outer surface; the inner ones displace it where they are",
    "computeCTAcquisition": "projections are written as TIFF; no screenshots; angles divide the range evenly in both cases",
    "computeLBuffer": "float32 instead of float64; exact at silhouettes, where gVXR is not; of an outer surface without the inner ones "
                      "as they stand, in gVXR as they stood in the last image; an unknown label is an error",
    "computePathLength": "as computeLBuffer",
    "getNodeAndChildrenBoundingBox": "the bounds of the vertices as they stand; gVXR's may be larger for turned meshes",
    "getNodeAndChildrenBoundingBoxCenter": "the middle of these bounds",
    "getNodeAndChildrenBoundingBoxCentre": "the middle of these bounds",
    "getNodeOnlyBoundingBox": "the bounds of the vertices as they stand; gVXR's may be larger for turned meshes",
    "getNodeOnlyBoundingBoxCenter": "the middle of these bounds",
    "getNodeOnlyBoundingBoxCentre": "the middle of these bounds",
    "getVertexSet": "an array of float64; meshes that are made have their vertices in another order",
    "getIndexSet": "an array of int32; meshes that are made have their triangles in another order",
    "moveToCentre": "by the bounds of the vertices as they stand",
    "moveToCenter": "by the bounds of the vertices as they stand",
    "computeSpectralImage": "[band, row, column]; needs setPhotonCountingBands",
    "computeXRayImage": "float32 instead of float64; photons per pixel counted by the quantity `photons`",
    "enablePoissonNoise": "other random numbers; an exposure in mAs does not turn it on",
    "getDensity": "0 instead of a negative number where it has no meaning",
    "getDensityFromHU": "the same tables (Schneider 2000), -1050 to 3000",
    "getLinearAttenuationCoefficient": "cross sections of NIST XCOM 8.1: some 0.1 % from gVXR's of xraylib",
    "getMassAttenuationCoefficient": "cross sections of NIST XCOM 8.1: some 0.1 % from gVXR's of xraylib",
    "getMaterialLabel": "the words of a mixture given as a list are its elements",
    "getMuFromHU": "cross sections of NIST XCOM 8.1, and the composition of Schneider 2000",
    "getTotalEnergyWithDetectorResponse": "of the response as Skiagraph has it (setScintillator)",
    "getWhiteImage": "with photon counting too, where gVXR refuses it",
    "makeSphere": "half as many rings as sectors, whatever is asked",
    "saveLastLBuffer": ".png, .tif or .mha; not compressed",
    "saveLastPathLength": ".png, .tif or .mha; not compressed",
    "saveLastProjectionSet": ".tif or .mha; not compressed",
    "saveLastXRayImage": ".png, .tif or .mha; not compressed",
    "setCompound": "a name of the tables has no effect: formulas by atoms only",
    "setFocalSpot": "the middles of i x i x i equal pieces",
    "setFocalSpotAsSquare": "the middles of i x i equal pieces, across the line to the detector",
    "setHU": "-1050 to 3000; cross sections of NIST XCOM 8.1",
    "setHounsfieldUnit": "-1050 to 3000; cross sections of NIST XCOM 8.1",
    "setHounsfieldValue": "-1050 to 3000; cross sections of NIST XCOM 8.1",
    "setOversamplingFactor": "1 to 16; rays at the middles of the pieces of a pixel",
    "setPhotonCountingBands": "bands of equal width from the least to the greatest energy",
    "setScintillator": "every photon that interacts is recorded with all its energy, an upper bound; materials by formula or "
                       "by a name of the tables",
    "setSeed": "other random numbers",
    "setVoltage": "the tube model of Ebel, calibrated (docs/physics.md)",
    "setmAs": "photons are counted absolutely and fall off with the distance; noise only by enablePoissonNoise",
}

_NOTHING = """
autoCreateOpenGLContext computeMixedPrecisionFlag createNewContext createOpenGLContext createWindow
cursorPositionCallback destroyWindow displayBeam displayDetector displayNode displayNormalVectors displayScene
findEGLClients hideWindow lookAt orthographic perspective popModelViewMatrix pushModelViewMatrix renderLoop
rotateModelView scrollCallback setAmbiantColour setAxisLength setColor setColour setDiffuseColour setMarkerLength
setShininess setSpecularColour setWindowBackGroundColor setWindowBackGroundColour setWindowPosition setWindowSize setZoom
showWindow startArcBallRotation stopArcBallRotation takeScreenshot useLighing useLogFile useNegative useWireframe
usingArcBallRotation disableArtefactFiltering disableArtifactFiltering enableArtefactFilteringOnCPU
enableArtefactFilteringOnGPU enableArtifactFilteringOnCPU enableArtifactFilteringOnGPU
setMaxRadiusLbufferArtefactFilter setBinTotalEnergyCutoff
"""

_REFUSED = {
    _NO_WINDOW: """getAmbientColour getDiffuseColour getLatestScreenshot getScreenshotOutputPathCT getShininess
        getSpecularColour getVisibilityCheckReport getWindowSize getZoom getBHPI""",
    _GL: """getMax2DTextureSize getMax3DTextureSize getMixedPrecisionFlag getNumberOfEGLDevices getOpenGlRenderer
        getOpenGlVendor getOpenGlVersion getPrecisionCleanedLBuffer getPrecisionCumulatedLBuffer getPrecisionEnergyFluence
        getPrecisionSumMuXdX getPrecisionUncleanedLBuffer getPrecisionZBuffer getShadingLanguageVersion
        getLargestPossibleDetectorNumberOfPixels getLargestPossibleNumberOfEnergyBins getBuildEnvironment
        getMaxRadiusLbufferArtefactFilter isArtefactFilteringOnCPUEnabled isArtefactFilteringOnGPUEnabled""",
    _NO_SURFACES: """addControlLineSegment addControlPoint convertHU2mu createImplicitSurface createMeshFromImplicitSurface
        destroyAllImplicitSurfaces destroyImplicitSurface getImplicitSurfaceLabelSet getImplicitSurfaceLastVoxelisation
        getImplicitSurfaceLastVoxelization getNumberOfControlLineSegments getNumberOfControlPoints
        getNumberOfImplicitSurfaces implicitSurfaceExists makeFoamInCuboid makeIsoSurface makeSpheresInCylinder
        setControlLineSegmentParameters setControlPointParameters subtractMesh voxeliseImplicitSurface
        voxelizeImplicitSurface loadImage2D loadImage3D""",
    _NO_GAIN: """computeCTAcquisitionWithGain computeXRayImageWithGain getDetectorBias getDetectorGain getDetectorStdDevBias
        getLastProjectionSetWithGain getNoiseGenerator getTotalEnergyWithDetectorResponseWithGain
        getTotalEnergyWithoutDetectorResponseWithGain getWhiteImageWithGain getWhiteSpectralImageWithGain
        saveLastXRayImageWithGain setDetectorBias setDetectorGain setDetectorStdDevBias""",
    _RESULT: """computeRMSE computeZNCC getMaxValue getMean getMinValue getPSNR getStddev getImageHeght getImageRow
        getImageWidth getWhiteLevel setWhiteLevel lineariseTest loadTest loadReference getWhiteSpectralImage
        mergePhotonCountingBands""",
    _TUBE: """getFiltrationMaterial getFiltrationThickness getInherentFiltrationMaterial getInherentFiltrationThickness
        getTubeAngle getVoltage getUnitOfElectriPotential getNumberOfPhotons getNumberOfPhotonsPerCm2At1m
        getNumberOfPhotonsPerPixelAtSDD getPhotonCountsPerCm2At1m getEnergyBinSize setEnergyBinSize setFirstEnergyBin
        setNumberOfPhotons setNumberOfPhotonsPerCm2At1m setNumberOfPhotonsPerPixelAtSDD""",
    "no filtration is assumed: name it by addFilter": "addInherentFilter clearInherentFiltration",
    "give every projection's source and detector as views to skiagraph.Scene.images": """rotateDetector rotateFocalSpot
        rotateSource getDetectorPositionSet getDetectorRightVectorSet getDetectorUpVectorSet getSourcePositionSet""",
    "use computeCTAcquisition": """computeProjectionSet computeSinogram getLastSinogram saveLastSinogram""",
    "the arguments of the last computeCTAcquisition are the caller's": """getCentreOfRotationPositionCT getFirstAngleCT
        getIncludeLastAngleFlagCT getLastAngleCT getNumberOfProjectionsCT getOptimalNumberOfProjectionsCT
        getProjectionOutputPathCT getRotationAxisCT getWhiteImagesInFlatFieldCT""",
    "use skiagraph.Material: its compositions, edges and coefficients": """getCompound getEffectiveAtomicNumber
        getEffectiveMolarMass getEffectiveZNumber getElementMolarMass getElementName getMassAttenuationFromCompound
        getMassAttenuationFromElement getMassAttenuationFromHU getMassAttenuationFromMixture getMixtureElementSet
        getMixtureWeightSet setMassAttenuationCoefficient""",
    "use skiagraph.Response: what a scintillator records": """getEnergyResponse getScintillatorMaterial
        getScintillatorThickness getSupportedScintillatorMaterials getLSF getOversamplingFactor getPhotonCountingBands
        getNumberOfPhotonCountingBands""",
    "normals follow from the order of corners; a closed mesh points outward": """hasNormalVectorsInverted
        invertNormalVectors getFaceNormalVectorSet getVertexNormalVectorSet getNumberOfFaceNormalVectors
        getNumberOfVertexNormalVectors""",
    "the steps of a wedge are equal: make it by skiagraph.Mesh.step_wedge": "makeStepWedge",
    "a rectangle has one number of samples along both sides; use skiagraph.Scene.image(spot=...)":
        "setFocalSpotAsRectangle",
    "place source and detector yourself": """applySOD autoAlignDetector getBestSOD getFOV getFieldOfView getMagnification
        getODD getObjectDetectorDistance getSOD getSourceObjectDistance getProjectionPixelSize getDetectorPixelArea
        getDetectorVertices getSourceShape""",
    "scene graphs are read as one mesh: use loadMeshFile": "loadSceneGraph",
    "it is not Skiagraph's: skiagraph.__version__ is": """getMajorVersionOfCoreGVXR getMajorVersionOfSimpleGVXR
        getMinorVersionOfCoreGVXR getMinorVersionOfSimpleGVXR getPatchVersionOfCoreGVXR getPatchVersionOfSimpleGVXR
        getVersionOfCoreGVXR getVersionOfSimpleGVXR""",
    "nothing is summed up over meshes but the image": "saveLastCumulatedLBuffer",
    _UNKNOWN: """getIdentityMatrix4 getIndexNumber getMeshFilename getMeshUnitOfLength getNodeLocalTransformationMatrix
        getRootTransformationMatrix getSceneRotationMatrix getVertexNumber radian2degree rayIntersect
        setRootTransformationMatrix setSceneRotationMatrix setSceneTransformationMatrix shearNode""",
}

#: name -> (kind, remark)
CALLS: dict[str, tuple[str, str]] = {
    **{name: ("same", "") for name in _SAME.split()},
    **{name: ("differs", remark) for name, remark in _DIFFERS.items()},
    **{name: ("nothing", "no window, no display; leaky meshes are repaired by default") for name in _NOTHING.split()},
    **{name: ("refused", remark) for remark, names in _REFUSED.items() for name in names.split()},
}
