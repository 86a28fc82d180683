"""The calls of gVXR, by themselves and beside gVXR where it is installed."""
import json
import pathlib
import re
import subprocess
import sys
import types

import numpy as np
import pytest

import skiagraph as sk
from skiagraph import gvxr
from skiagraph.gvxr import meshes
from skiagraph.gvxr import state as gvxr_state
from skiagraph.gvxr.calls import CALLS

HERE = pathlib.Path(__file__).parent


@pytest.fixture(autouse=True)
def fresh():
    gvxr.destroyAllWindows()
    yield
    gvxr.destroyAllWindows()


def set_up():
    gvxr.setSourcePosition(0, -40, 0, "cm")
    gvxr.setMonoChromatic(80, "keV", 1000)
    gvxr.setDetectorPosition(0, 10, 0, "cm")
    gvxr.setDetectorUpVector(0, 0, -1)
    gvxr.setDetectorNumberOfPixels(32, 24)
    gvxr.setDetectorPixelSize(2, 2, "mm")


def cube(label="cube", edge=3, mu=0.2):
    gvxr.makeCube(label, edge, "cm")
    gvxr.addPolygonMeshAsInnerSurface(label)
    gvxr.setMu(label, mu, "cm-1")


def test_values_are_in_its_units(tmp_path):
    set_up()
    cube()
    gvxr.useParallelBeam()
    lengths, image = gvxr.computeLBuffer("cube"), gvxr.computeXRayImage()
    assert lengths.max() == pytest.approx(3, rel=3e-5)  # single precision
    assert image.max() == 80 and image.min() == pytest.approx(80 * np.exp(-0.6), rel=1e-4)  # the same, in the exponent
    assert gvxr.computeXRayImage(False).max() == 1000
    assert (gvxr.getLastLBuffer() == lengths).all()
    gvxr.saveLastXRayImage(str(tmp_path / "image.mha"))
    gvxr.saveLastLBuffer(str(tmp_path / "lengths.mha"))
    assert b"MeV per pixel" in (tmp_path / "image.mha").read_bytes()[:1000]
    assert (tmp_path / "lengths.mha").read_bytes().endswith(lengths.tobytes())
    assert gvxr.getUnitOfEnergy("keV") == 1e-3 and gvxr.getUnitOfLength("cm") == 10


def test_an_outer_surface_is_displaced():
    set_up()
    cube("inner", 1, 0.5)
    gvxr.makeCube("outer", 3, "cm")
    gvxr.addPolygonMeshAsOuterSurface("outer")
    gvxr.setMu("outer", 0.2, "cm-1")
    gvxr.useParallelBeam()
    assert gvxr.computeXRayImage().min() == pytest.approx(80 * np.exp(-0.4 - 0.5), rel=1e-4)  # single precision
    assert gvxr.computeLBuffer("outer")[12, 16] == pytest.approx(2, rel=3e-5)  # likewise
    cube("another", 1)
    gvxr.addPolygonMeshAsOuterSurface("another")
    with pytest.raises(sk.SceneError, match="all outer"):
        gvxr.computeXRayImage()


def test_a_change_shows():
    set_up()
    cube()
    before = gvxr.computeXRayImage()
    gvxr.translateNode("cube", 1, 0, 0, "cm")
    moved = gvxr.computeXRayImage()
    assert not (moved == before).all()
    gvxr.setLocalTransformationMatrix("cube", np.eye(4))
    assert (gvxr.computeXRayImage() == before).all()
    gvxr.setMu("cube", 0, "cm-1")
    assert (gvxr.computeXRayImage() == 80).all()
    gvxr.setMonoChromatic(40, "keV", 1000)
    assert (gvxr.computeXRayImage() == 40).all() and (gvxr.getWhiteImage() == 40).all()


def test_a_scan_turns_the_meshes(tmp_path):
    set_up()
    cube(edge=1)
    gvxr.translateNode("cube", 1, 0.5, 0, "cm")
    gvxr.computeCTAcquisition(str(tmp_path / "scan"), "", 4, 0, False, 360, 2, 0, 0, 0, "mm", 0, 0, 1)
    scan = gvxr.getLastProjectionSet()
    assert scan.shape == (4, 24, 32) and scan.max() == 1 and gvxr.getAngleSetCT() == (0, 90, 180, 270)
    gvxr.rotateScene(90, 0, 0, 1)
    np.testing.assert_allclose(gvxr.computeXRayImage() / 80, scan[1], atol=1e-5)  # rounding of the turned view
    assert [path.name for path in sorted((tmp_path / "scan").iterdir())] == [f"projection_{i:04}.tiff" for i in range(4)]


def test_meshes_and_their_graph(tmp_path):
    gvxr.makeTriangularMesh("t", [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3], "cm")
    gvxr.makeCylinder("c", 20, 3, 1, "cm", "t")
    gvxr.translateNode("t", 1, 2, 3, "cm")
    assert gvxr.getNodeOnlyBoundingBox("t") == pytest.approx((1, 2, 3, 2, 3, 4))
    assert gvxr.getNodeOnlyBoundingBox("c", "mm") == pytest.approx((0, 5, 20, 20, 35, 40), abs=1e-6)  # of a cylinder
    gvxr.moveToCentre("t")
    box = np.array(gvxr.getNodeAndChildrenBoundingBox("t"))
    np.testing.assert_allclose(box[:3], -box[3:], atol=1e-12)  # roundings
    gvxr.emptyMesh("all")
    gvxr.addMesh("all", "t")
    gvxr.addMesh("all", "c")
    assert gvxr.getNumberOfPrimitives("all") == 4 + gvxr.getNumberOfPrimitives("c")
    assert gvxr.getChildLabel("root", 1) == "all" and gvxr.getNumberOfChildren("t") == 1
    gvxr.applyCurrentLocalTransformation("t")
    gvxr.saveSTLfile("t", str(tmp_path / "t.stl"))
    gvxr.loadMeshFile("again", str(tmp_path / "t.stl"), "mm")
    assert gvxr.isInnerSurface("again") and not gvxr.isOuterSurface("again")
    gvxr.removeMeshAndChildren("t")
    for call in (lambda: gvxr.scaleNode("c", 1, 1, 1), lambda: gvxr.getNodeOnlyBoundingBox("c"), lambda: gvxr.moveToCentre("c"),
                 lambda: gvxr.computeLBuffer("c"), lambda: gvxr.getSOD("c", "mm"), lambda: gvxr.makeCube("d", 1, "cm", "c")):
        with pytest.raises(sk.SceneError, match="no mesh 'c'; there are 'all', 'again'"):
            call()


def test_bounds_of_a_turned_mesh():
    random = np.random.default_rng(7)
    vertices = random.normal(0, 10, (300, 3)) + (1000, -2000, 500)
    faces = random.permutation(300).reshape(-1, 3)
    gvxr.makeTriangularMesh("t", vertices.ravel(), faces.ravel(), "mm")
    vertices = gvxr.getVertexSet("t").reshape(-1, 3)
    for turn in ((30, 1, 2, 3), (90, 0, 0, 1), (0, 0, 0, 1)):
        gvxr.rotateNode("t", *turn)
        gvxr.scaleNode("t", -1, 2, 0.5)
        matrix = gvxr.getNodeLocalTransformationMatrix("t").T
        placed = vertices @ matrix[:3, :3].T + matrix[:3, 3]
        expected = np.concatenate([placed.min(0), placed.max(0)])
        # Roundings of the floats that are offsets from the middle: 2^-24 of 60 mm, three of them, scaled by 2 each time.
        assert gvxr.getNodeOnlyBoundingBox("t", "mm") == pytest.approx(expected, rel=0, abs=1e-4)


def test_a_mesh_that_is_loaded_anew(tmp_path):
    """An unchanged file gives the mesh that is there; one that changed is read."""
    path = tmp_path / "t.stl"
    sk.Mesh.cube(10).save(path)
    gvxr.loadMeshFile("t", str(path), "mm")  # new: it may change within the clock's step
    gvxr.loadMeshFile("again", str(path), "mm")
    assert gvxr_state.world.mesh("t") is not gvxr_state.world.mesh("again")
    sk.Mesh.cube(20).save(path)  # as long
    gvxr.loadMeshFile("t", str(path), "mm")
    assert gvxr.getNodeOnlyBoundingBox("t", "mm") == (-10, -10, -10, 10, 10, 10)
    real, meshes._SETTLED = meshes._SETTLED, -1e9  # as if it had been written long ago
    try:
        gvxr.loadMeshFile("t", str(path), "mm")
        first = gvxr_state.world.mesh("t")
        gvxr.translateNode("t", 1, 0, 0, "mm")
        gvxr.loadMeshFile("t", str(path), "mm")
        assert gvxr_state.world.mesh("t") is first and gvxr.getNodeOnlyBoundingBox("t", "mm")[3] == 10
        gvxr.loadMeshFile("t", str(path), "cm")
        assert gvxr.getNodeOnlyBoundingBox("t", "mm")[3] == 100
        sk.Mesh.cube(30).save(path)
        gvxr.loadMeshFile("t", str(path), "mm")
        assert gvxr.getNodeOnlyBoundingBox("t", "mm")[3] == 15
    finally:
        meshes._SETTLED = real


def test_matter():
    gvxr.makeCube("a")
    for call, arguments, label in ((gvxr.setElement, ("Fe",), "Element: Fe"), (gvxr.setHU, (50,), "HU: 50"),
                                   (gvxr.setMixture, ("Ti90Al6V4",), "Mixture: Ti90Al6V4"),
                                   (gvxr.setCompound, ("H2O",), "Compound: H2O")):
        call("a", *arguments)
        gvxr.setDensity("a", 2000, "kg/m3")
        assert gvxr.getMaterialLabel("a") == label and gvxr.getDensity("a") == 2
    gvxr.setMixture("a", ["H", 8], [0.112, 0.888])
    gvxr.setDensity("a", 1, "g/cm3")
    # NIST: 0.2059 cm2/g at 60 keV, to the digits of the fractions
    assert gvxr.getLinearAttenuationCoefficient("a", 60, "keV") == pytest.approx(0.2059, abs=1e-4)
    with pytest.raises(sk.ArgumentError, match="'g/l'"):
        gvxr.setDensity("a", 1, "g/l")


def test_beams_and_detectors():
    set_up()
    cube(mu=0)
    gvxr.resetBeamSpectrum()
    with pytest.warns(sk.SkiagraphWarning, match="no beam"):
        assert not gvxr.computeXRayImage().any()
    assert gvxr.getEnergyBins("keV") == () and gvxr.getTotalEnergyWithDetectorResponse() == 0
    gvxr.setMonoChromaticPerCm2At1m(80, "keV", 1000)
    assert gvxr.getPhotonCountsPerPixelAtSDD() == pytest.approx((1000 * 0.04 / 0.25,))  # of 4 mm2 at 0.5 m
    gvxr.addFilter("Cu", 1, "mm")
    assert gvxr.getPhotonCountsPerPixelAtSDD()[0] < 160
    gvxr.clearFiltration()
    gvxr.resetBeamSpectrum()
    gvxr.setVoltage(100, "kV")
    gvxr.setTubeAngle(12)
    gvxr.addFilter(13, 2.5, "mm")
    assert max(gvxr.getEnergyBins("keV")) == pytest.approx(99.5)
    assert gvxr.getTotalEnergyWithDetectorResponse() == pytest.approx(gvxr.getTotalEnergyWithoutDetectorResponse())
    gvxr.setScintillator("CsI", 600, "um")
    assert gvxr.getTotalEnergyWithDetectorResponse() < gvxr.getTotalEnergyWithoutDetectorResponse()
    # Above the K edges of iodine and caesium (33.2 and 36.0 keV) a photon takes an edge's energy away where K fluorescence leaves.
    rows = np.array(gvxr.getEnergyResponse("CsI", 500, "um", "keV"))
    assert np.interp([30, 34, 36.1], *rows.T) == pytest.approx([25.4, 28.8, 29.0], abs=0.3)  # between rows that are .6 % apart
    gvxr.setScintillator("CsI", 500, "um")
    gvxr.setMonoChromatic(36.1, "keV", 1000)
    recorded = gvxr.getTotalEnergyWithDetectorResponse() / gvxr.getTotalEnergyWithoutDetectorResponse()
    assert recorded == pytest.approx(sk.Response.scintillator("CsI", 0.5, escape=True).at(36.1)[0] / 36.1, rel=1e-6)
    gvxr.resetBeamSpectrum()
    gvxr.setVoltage(100, "kV")
    gvxr.clearDetectorEnergyResponse()
    gvxr.setPhotonCountingBands(20, 100, "keV", 4)
    assert gvxr.computeSpectralImage().shape == (4, 24, 32)
    assert gvxr.getPhotonCountingBands("keV") == pytest.approx((20, 40, 60, 80))
    gvxr.enablePoissonNoise()
    assert not (gvxr.computeXRayImage() == gvxr.computeXRayImage()).all()


def test_scene_files(tmp_path):
    path = pathlib.Path(tmp_path / "scene.json")
    path.write_text("""{"Source": {"Position": [0, -40, 0, "cm"], "Shape": "PointSource",
        "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
        "Detector": {"Position": [0, 10, 0, "cm"], "UpVector": [0, 0, -1], "NumberOfPixels": [32, 24],
        "Size": [64, 48, "mm"], "LSF": [0.2, 0.6, 0.2]},
        "Samples": [{"Label": "skin", "Cube": [30, "mm"], "Material": ["mu", 0.2], "Type": "outer"},
        {"Label": "bone", "Cube": [10, "mm"], "Material": ["mu", 0.5]}]}""")
    gvxr.loadSceneFile(str(path))
    expected = sk.Scene(path).image(unit="MeV")
    assert (gvxr.computeXRayImage() == expected).all()
    assert gvxr.isOuterSurface("skin") and gvxr.isInnerSurface("bone")
    gvxr.translateNode("bone", 5, 0, 0, "mm")
    assert not (gvxr.computeXRayImage() == expected).all()
    gvxr.setMonoChromatic(30, "keV", 1000)
    assert gvxr.computeXRayImage().max() == 30
    gvxr.removeMeshAndChildren("bone")
    assert gvxr.computeXRayImage().min() == pytest.approx(30 * np.exp(-0.6), rel=2e-3)  # blurred, and through oblique faces
    gvxr.makeCube("skin", 1, "cm")
    assert gvxr.computeLBuffer("skin").max() < 1.2
    gvxr.setLSF([0.1, 0.8, 0.1])
    with pytest.raises(sk.SceneError, match="keeps its focal spot"):
        gvxr.computeXRayImage()


def test_every_call_is_here_or_refused():
    here = {name for name in dir(gvxr) if not name.startswith("_")}
    listed = {name for name, (kind, _) in CALLS.items() if kind in ("same", "differs")}
    assert listed <= here
    assert gvxr.createOpenGLContext(0, 4, 5) is None and gvxr.displayScene() is None
    assert not here & {name for name, (kind, _) in CALLS.items() if kind == "refused"}
    assert set((HERE / "gvxr_names.txt").read_text().split()) == set(CALLS)
    assert all(len(remark) > 10 for kind, remark in CALLS.values() if kind in ("differs", "refused"))
    with pytest.raises(sk.UnsupportedError, match="refused: "):
        gvxr.computeSinogram()
    for name, (kind, _) in CALLS.items():  # help() has words for each, and the name of those that do nothing
        assert kind == "refused" or len(getattr(gvxr, name).__doc__) > 5, name
        assert kind != "nothing" or getattr(gvxr, name).__name__ == name
    with pytest.raises(AttributeError, match="no call 'computeXrayImage'"):
        gvxr.computeXrayImage()


def test_what_differs_from_gvxr_is_right_here():
    """The example of docs/from-gvxr.md, whose answers are known."""
    path = HERE.parent.parent / "examples" / "gvxr_differences.py"
    said = subprocess.run([sys.executable, str(path)], capture_output=True, text=True, check=True).stdout
    lengths, formula, numbers = said.splitlines()
    assert float(re.search(r"rms error (\S+) mm", lengths)[1]) < 1e-5 and "in 0 % of" in lengths  # single path lengths
    bracketed, plain = re.search(r"OH (\S+) per cm; Ca5P3O13H, the same atoms, (\S+)", formula).groups()
    assert bracketed == plain
    steps = np.array(re.findall(r"(\d+): ([\d.]+)", numbers), float)
    line = np.polyfit(*steps.T, 1)
    assert np.abs(np.polyval(line, steps[:, 0]) / steps[:, 1] - 1).max() < 5e-3  # Schneider's density is a line there


def test_the_page_is_fresh():
    page = HERE.parent.parent / "docs" / "gvxr.md"
    made = subprocess.run([sys.executable, str(HERE / "gvxr_page.py")], capture_output=True, text=True, check=True).stdout
    assert page.read_text() == made, "make it anew: python3 tests/python/gvxr_page.py > docs/gvxr.md"


def test_beside_gvxr_itself(tmp_path):
    try:
        from gvxrPython3 import gvxr as other
    except ImportError as error:
        pytest.skip(f"no gVXR: {error}")
    results = []
    for module in ("gvxrPython3", "skiagraph"):
        file = tmp_path / f"{module}.npz"
        done = subprocess.run([sys.executable, str(HERE / "gvxr_script.py"), module, str(file)], capture_output=True,
                              text=True, cwd=tmp_path, check=False)
        if done.returncode and module == "gvxrPython3":
            pytest.skip("gVXR does not run here: " + done.stderr[-200:])
        assert done.returncode == 0, done.stderr
        results.append(np.load(file))
    theirs, ours = results
    assert not {name for name in dir(other) if isinstance(getattr(other, name), types.FunctionType)
                and name[0] != "_"} - set(CALLS)
    for name in ours.files:
        worst = np.abs(theirs[name] - ours[name]) / np.abs(theirs[name]).max()
        if name.startswith("mu "):
            assert worst.max() < 5e-4, name  # XCOM against xraylib
        elif name.startswith("effective "):
            assert worst.max() < 3e-5, name  # atomic weights of other years: 15.999 and 15.9994
        elif name in ("bounds", "vertices"):
            assert worst.shape == theirs[name].shape  # the page says how they differ
        elif worst.ndim >= 2:
            assert np.quantile(worst, 0.9) < 1e-3, name  # a scan: gVXR's vertices are floats
            assert np.quantile(worst, 0.99) < 0.02, name  # rays that pass an edge, where gVXR's lengths are too long
        else:
            assert worst.max() < 1e-6, name  # gVXR's matrices are floats


def test_the_load_of_a_file(tmp_path):
    def described(y):
        return {"Source": {"Position": [0, y, 0, "mm"], "Shape": "PointSource",
                           "Beam": {"kVp": 80, "Filter": [["Al", 3, "mm"]], "mAs": 2}},
                "Detector": {"Position": [0, 300, 0, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [32, 24],
                             "Spacing": [2, 2, "mm"]},
                "Samples": [{"Label": "cube", "Cube": [20, "mm"], "Material": "H2O"}]}

    path = tmp_path / "scene.json"
    path.write_text(json.dumps(described(-600)))
    gvxr.loadSceneFile(str(path))
    scene = sk.Scene(described(-600))
    np.testing.assert_array_equal(gvxr.computeXRayImage(), scene.image(unit="MeV"))
    photons = scene.beam.resolved(scene.view).photons.sum()
    assert sum(gvxr.getPhotonCountEnergyBins()) == pytest.approx(photons, rel=1e-12)  # roundings of a sum
    gvxr.setSourcePosition(0, -300, 0, "mm")
    nearer = sk.Scene(described(-300)).image(unit="MeV")
    np.testing.assert_allclose(gvxr.computeXRayImage(), nearer, rtol=1e-6)  # the factor is rounded to float


def test_arguments_that_gvxr_takes(tmp_path):
    """Results of gVXR 2.1.0 for these calls."""
    set_up()
    cube()
    array = np.zeros((24, 32))
    image = gvxr.computeXRayImage(array, False)
    assert (array == image).all() and array.max() == 1000
    gvxr.scaleScene(2, 2, 2, "mm")
    gvxr.scaleScene(0.5, 0.5, 0.5, "cm")
    assert np.diag(gvxr.getSceneTransformationMatrix()).tolist() == [10, 10, 10, 1]
    gvxr.usePoissonNoise(True)
    assert gvxr.usePoissonNoise()
    gvxr.usePoissonNoise(False)
    assert not gvxr.usePoissonNoise()
    corners = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]
    faces = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]
    soup = np.reshape(corners, (-1, 3))[faces].ravel()
    for arguments, edge in (((corners, faces), 10), ((corners, faces, "mm"), 1), ((soup,), 10), ((soup, "mm"), 1)):
        gvxr.makeTriangularMesh("t", *arguments)
        assert gvxr.getNumberOfPrimitives("t") == 4
        assert gvxr.getNodeOnlyBoundingBox("t", "mm") == pytest.approx((0, 0, 0, edge, edge, edge))
    path = tmp_path / "t.stl"
    gvxr.saveSTLfile("t", str(path), False)
    assert path.read_text().startswith("solid") and path.read_text().count("vertex") == 12
    assert sk.Mesh.load(path).health["volume"] == pytest.approx(1 / 6)
    values = np.zeros((8, 6, 4))
    values[3, 2, 1] = 100
    gvxr.makeIsoSurface("i", 50, values.ravel().tolist(), 4, 6, 8, 1, 2, 3)  # cm; the voxel is at (2, 3, 4) spacings
    assert np.array(gvxr.getNodeOnlyBoundingBoxCentre("i", "mm")) == pytest.approx((20, 60, 120))
    assert [gvxr.getElementName(z) for z in (26, "Fe", 13, 16)] == ["Iron", "Iron", "Aluminium", "Sulfur"]
    gvxr.setElement("cube", 26)
    assert gvxr.getMaterialLabel("cube") == "Element: Iron"
    gvxr.setMixture("cube", ["Ti", "Al", "V"], [0.9, 0.06, 0.04])
    assert gvxr.getMaterialLabel("cube") == "Mixture: Al6Ti90V4"


def test_the_right_vector_follows_the_beam_until_it_is_set():
    def directions(*expected):
        assert np.hstack([gvxr.getDetectorUpVector(), gvxr.getDetectorRightVector()]) == pytest.approx(expected, abs=6e-5)

    def start():
        gvxr.setSourcePosition(0, -400, 0, "mm")
        gvxr.setDetectorPosition(0, 100, 0, "mm")
        gvxr.setDetectorUpVector(0, 0, -1)
        gvxr.setDetectorNumberOfPixels(64, 48)
        gvxr.setDetectorPixelSize(1, 1, "mm")

    start()  # the directions of gVXR 2.1 itself, made of length 1
    directions(0, 0, -1, -1, 0, 0)
    gvxr.setDetectorRightVector(1, 0, 0)
    gvxr.setSourcePosition(200, -400, 100, "mm")
    directions(0, 0, -1, 1, 0, 0)
    gvxr.autoAlignDetector(True)
    directions(0, 0, -1, -0.9285, -0.3714, 0)
    start()
    gvxr.rotateDetector(10, 0, 0, 1)
    directions(0, 0, -1, -1, 0, 0)
    gvxr.setSourcePosition(100, -400, 0, "mm")
    directions(0, 0, -1, -0.9806, -0.1961, 0)
    gvxr.autoAlignDetector(False)
    start()
    gvxr.setSourcePosition(200, -400, 100, "mm")
    directions(0, 0, -1, -0.9806, -0.1961, 0)
    gvxr.rotateDetector(10, 0, 0, 1)
    directions(0, 0, -1, -0.9316, -0.3634, 0)
    gvxr.autoAlignDetector(True)
    gvxr.setDetectorUpVector(0, 0, 1)
    directions(0, 0, 1, 0.9285, 0.3714, 0)


def test_what_is_inherent_to_a_tube_is_no_filter():
    gvxr.setSourcePosition(0, -400, 0, "mm")
    gvxr.setDetectorPosition(0, 100, 0, "mm")
    gvxr.setDetectorUpVector(0, 0, -1)
    gvxr.setDetectorNumberOfPixels(4, 4)
    gvxr.setDetectorPixelSize(0.01, 0.01, "mm")
    gvxr.setVoltage(100, "kV")
    gvxr.addInherentFilter("Al", 1, "mm")
    bare = gvxr.getNumberOfPhotonsPerCm2At1m(False)
    assert bare == gvxr.getNumberOfPhotonsPerCm2At1m(True)
    gvxr.addFilter("Al", 1, "mm")  # adds to the inherent aluminium
    assert bare == gvxr.getNumberOfPhotonsPerCm2At1m(False) > gvxr.getNumberOfPhotonsPerCm2At1m(True)
    gvxr.setNumberOfPhotonsPerPixelAtSDD(1000)
    assert gvxr.getNumberOfPhotonsPerPixelAtSDD(False) == pytest.approx(1000)
    gvxr.clearFiltration()
    assert gvxr.getNumberOfPhotonsPerPixelAtSDD(True) == pytest.approx(1000)


def test_elements_have_the_densities_of_gvxr():
    for name, density in (("C", 2.267), (26, 7.874), ("Al", 2.698), ("U", 18.95), (7, 0.0012506)):
        assert gvxr.getDensityFromElement(name) == pytest.approx(density)
    gvxr.makeCube("cube", 1, "cm")
    gvxr.setElement("cube", "C")
    assert gvxr.getDensity("cube") == pytest.approx(2.267)
    gvxr.setDensity("cube", 1.8, "g/cm3")
    assert gvxr.getDensity("cube") == pytest.approx(1.8)
