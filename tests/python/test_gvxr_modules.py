"""The modules beside gVXR's calls: utils, json2gvxr, gvxr2json, the readers, and the scripts that use them."""
import json
import os
import pathlib
import struct
import subprocess
import sys
import zipfile

import numpy as np
import pytest

import skiagraph as sk
from skiagraph import gvxr, gvxr2json, json2gvxr
from skiagraph.gvxr import dragon, packing, utils
from skiagraph.gvxr.gVXRDataReader import gVXRDataReader
from skiagraph.gvxr.JSON2gVXRDataReader import JSON2gVXRDataReader
from skiagraph.gvxr.wheel import DRAGON

HERE = pathlib.Path(__file__).parent
#: Roundings of sums and products of doubles.
ROUNDED = 1e-12


@pytest.fixture(autouse=True)
def fresh():
    gvxr.destroyAllWindows()
    yield
    gvxr.destroyAllWindows()


def described(**others):
    return {"WindowSize": [320, 240],
            "Source": {"Position": [0, -40, 0, "cm"], "Shape": "Point",
                       "Beam": [{"Energy": 30, "Unit": "keV", "PhotonCount": 400},
                                {"Energy": 0.06, "Unit": "MeV", "PhotonCount": 600}]},
            "Detector": {"Position": [0, 10, 0, "cm"], "UpVector": [0, 0, -1], "Number of pixels": [32, 24],
                         "Size": [64, 48, "mm"], "Oversampling": 2},
            "Scan": {"NumberOfProjections": 4, "FinalAngle": 360, "OutFolder": "out", "Flat-Field Correction": True,
                     "NumberOfWhiteImages": 3, "RotationAxis": [0, 0, 1]},
            "Samples": [{"Label": "skin", "Cube": [30, "mm"], "Material": ["mu", 0.2], "Type": "outer"},
                        {"Label": "bone", "Cylinder": [20, 20, 5, "mm"], "Material": ["Mixture", [20, 0.4, 8, 0.4]],
                         "Density": 1.5, "Transform": [["Translation", 3, 0, 2, "mm"], ["Rotation", 30, 1, 0, 0]]},
                        {"Label": "wedge", "Material": ["Compound", "SiO2"], "Density": 2.2, "StepWedge": {
                            "NumberOfSteps": 3, "TotalLength": 9, "Width": 4, "FirstStepHeight": 1, "OtherStepHeight": 2,
                            "Unit": "mm"}}], **others}


def written(folder, **others):
    path = folder / "scene.json"
    path.write_text(json.dumps(described(**others)))
    return path


def read(path):
    json2gvxr.initGVXR(str(path), "EGL")
    json2gvxr.initSourceGeometry()
    json2gvxr.initSpectrum(verbose=0)
    json2gvxr.initDetector()
    with pytest.warns(sk.SkiagraphWarning, match="sum to 0.8; they are scaled"):
        json2gvxr.initSamples(verbose=0)


def test_a_scene_file_is_read_section_by_section(tmp_path):
    path = written(tmp_path)
    read(path)
    assert gvxr.getWindowSize() == (320, 240) and gvxr.getOversamplingFactor() == 2
    expected = sk.Scene(path, lenient=True, settings={"Samples.wedge.Transform": [["Translation", 0, 0, 2.5, "mm"]]})
    np.testing.assert_allclose(gvxr.computeXRayImage(), expected.image(unit="MeV"), rtol=2e-6)  # matrices in another order
    assert json2gvxr.params["Detector"]["Size"] == [64, 48, "mm"]
    assert json2gvxr.getFilePath("a/b.stl") == str(tmp_path / "a" / "b.stl") and json2gvxr.getFilePath("/a.stl") == "/a.stl"
    json2gvxr.params["Detector"]["Size"] = [32, 24, "mm"]  # a script may change it
    json2gvxr.initDetector()
    assert gvxr.getDetectorPixelSpacing("mm") == (1, 1)
    gvxr.removeMeshAndChildren("bone")
    assert gvxr.computeXRayImage().shape == (24, 32)


def test_params_may_hold_arrays(tmp_path):
    path = written(tmp_path)
    read(path)
    image = gvxr.computeXRayImage()
    params = json2gvxr.params
    params["Source"]["Position"] = (*np.array([0.0, -40, 0]), "cm")
    params["Detector"].update({"UpVector": np.array([0, 0, -1]), "RightVector": np.array([-1, 0, 0]), "Size": None,
                               "NumberOfPixels": np.array([32, 24]), "Spacing": (np.float32(2), np.float64(2), "mm")})
    params["Samples"][1]["Transform"][1] = ["Rotation", *np.array([30, 1, 0, 0])]
    params["Scan"]["RotationAxis"] = np.array([0, 0, 1])
    for part in (json2gvxr.initSourceGeometry, json2gvxr.initSpectrum, json2gvxr.initDetector, json2gvxr.initScan):
        part()
    with pytest.warns(sk.SkiagraphWarning, match="sum to 0.8"):
        json2gvxr.initSamples()
    np.testing.assert_allclose(gvxr.computeXRayImage(), image, rtol=2e-6)


def test_sections_do_not_need_a_window(tmp_path):
    path = str(written(tmp_path))
    json2gvxr.initDetector(path)
    json2gvxr.initSourceGeometry(path)
    assert gvxr.getDetectorUpVector() == (0, 0, -1) and gvxr.getSourceShape() == "POINT"
    with pytest.raises(sk.FormatError, match="Source.Shape is 'Moon'"):
        json2gvxr.params["Source"]["Shape"] = "Moon"
        json2gvxr.initSourceGeometry()


def test_a_scan_of_a_scene_file(tmp_path):
    read(written(tmp_path))
    with pytest.raises(sk.SceneError, match="call initScan first"):
        json2gvxr.scan_params.clear()
        json2gvxr.doCTScan()
    json2gvxr.initScan()
    assert json2gvxr.doCTScan() == (0, 90, 180, 270)
    scan = gvxr.getLastProjectionSet()
    assert scan.shape == (4, 24, 32) and scan.max() == pytest.approx(1, rel=1e-6)  # a mean of floats
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [f"projection_{i:04}.tiff" for i in range(4)]
    assert gvxr.getWhiteImagesInFlatFieldCT() == 3 and gvxr.getRotationAxisCT() == (0, 0, 1)
    assert gvxr.getDetectorPositionSet("cm")[1] == pytest.approx((10, 0, 0), abs=1e-9)  # a turn by 90 degrees
    json2gvxr.params["Scan"] = {"AngleStep": 10}
    with pytest.raises(sk.FormatError, match="give two of"):
        json2gvxr.initScan()


def test_a_world_is_written_and_read_again(tmp_path):
    read(written(tmp_path))
    gvxr.addFilter("Al", 1, "mm")
    gvxr.setScintillator("Gadox", 300, "um")
    gvxr.setColour("bone", 1, 0.5, 0.25, 1)
    gvxr.translateNode("bone", 1, 2, 3, "mm")
    before = gvxr.computeXRayImage()
    target = tmp_path / "written" / "again.json"
    target.parent.mkdir()
    gvxr2json.saveJSON(str(target))
    # Meshes as files, and photons behind the filters.
    np.testing.assert_allclose(sk.Scene(target).image(unit="MeV"), before, rtol=2e-6)
    gvxr.destroyAllWindows()
    for call in (json2gvxr.initSourceGeometry, json2gvxr.initSpectrum, json2gvxr.initDetector, json2gvxr.initSamples):
        call(str(target))
    np.testing.assert_allclose(gvxr.computeXRayImage(), before, rtol=2e-6)
    assert gvxr.getAmbientColour("bone") == (1, 0.5, 0.25, 1) and gvxr.isOuterSurface("skin")


@pytest.mark.parametrize("mas", [0, -2, float("nan")])
def test_a_load_of_nothing_is_refused(mas):
    with pytest.raises(sk.ArgumentError, match="above 0"):
        gvxr.setmAs(mas)


def test_a_tube_is_written_and_read_again(tmp_path):
    gvxr.setSourcePosition(0, -40, 0, "cm")
    gvxr.setDetectorPosition(0, 10, 0, "cm")
    gvxr.setDetectorUpVector(0, 0, -1)
    gvxr.setDetectorNumberOfPixels(8, 6)
    gvxr.setDetectorPixelSize(1, 1, "mm")
    gvxr.setVoltage(90, "kV")
    gvxr.setmAs(2)
    gvxr.addInherentFilter("Be", 0.8, "mm")
    gvxr.addFilter("Al", 3, "mm")
    gvxr.setFocalSpotAsRectangle(0, -40, 0, 1, 2, "mm", 2, 3)
    gvxr.clearFiltration()
    gvxr.setFiltration([(13, 3)], "mm")
    assert gvxr.getInherentFiltrationMaterial() == (4,) and gvxr.getFiltrationThickness("cm") == (pytest.approx(0.3),)
    gvxr.makeCube("cube", 2, "mm")
    gvxr.addPolygonMeshAsInnerSurface("cube")
    gvxr.setElement("cube", "Al")
    gvxr2json.saveJSON(str(tmp_path / "tube.json"))
    said = json.loads((tmp_path / "tube.json").read_text())
    assert said["Source"]["Shape"] == ["Rectangle", 1, 2, "mm"] and said["Source"]["Grid"] == 3
    np.testing.assert_allclose(sk.Scene(tmp_path / "tube.json").image(unit="MeV"), gvxr.computeXRayImage(), rtol=2e-6)


def test_spectra_of_utils(tmp_path):
    gvxr.setSourcePosition(0, -1, 0, "m")
    gvxr.setDetectorPosition(0, 0, 0, "m")
    gvxr.setDetectorUpVector(0, 0, -1)
    gvxr.setDetectorNumberOfPixels(8, 6)
    gvxr.setDetectorPixelSize(2, 2, "mm")
    energies, counts, unit = utils.getSpectrumSpekpy(100, [["Cu", 0.1, "mm"], ["None", 1]], 10, 20)
    assert unit == "keV" and len(energies) == 20 and counts.sum() == pytest.approx(1, rel=ROUNDED)
    spectrum, energies, counts, unit = utils.loadSpectrumSpekpy(100, [["Cu", 0.1, "mm"]], mAs=2, z=100)
    beam = sk.Beam.tube(100, {"Al": 0.5, "Cu": 0.1}, mas=2)
    assert gvxr.getFiltrationMaterial() == (29,) and gvxr.getVoltage("kV") == 100 and gvxr.getmAs() == 2
    # photons per mm2 at 1 m, on pixels of 4 mm2; what carries 1 eV at most is left out
    assert gvxr.getNumberOfPhotons() == pytest.approx(4 * beam.photons.sum(), rel=1e-6)
    assert sum(counts) == pytest.approx(100 * beam.photons.sum(), rel=1e-6)
    (tmp_path / "beam.txt").write_text("# energy photons\n20 5\n0 30 10 # the second\n")
    assert utils.loadTextFileSpectrum(str(tmp_path / "beam.txt"), "keV")[0] == {20: 5, 30: 10}
    assert gvxr.getPhotonCountEnergyBins(False) == pytest.approx((5, 10))
    (tmp_path / "bad.txt").write_text("20\n")
    with pytest.raises(sk.FormatError, match="bad.txt: line 1"):
        utils.getSpectrumTextFile(str(tmp_path / "bad.txt"), "keV")


def test_images_of_utils():
    image = np.linspace(1, 4, 12).reshape(3, 4)
    assert utils.logImage(image, 1, 4)[0, 0] == pytest.approx(0, abs=1e-8)  # log(1 + 1e-9)
    assert utils.applyLogScaleAndNegative(image)[-1, -1] == pytest.approx(0, abs=1e-8)
    sharp = utils.sharpen(image, 1, 2)
    assert sharp.min() == image.min() and sharp.max() == image.max() and not (sharp == image).all()
    assert utils.rgb2k3d(1, 2, 3) == 0x010203 and utils.standardisation(image).std() == pytest.approx(1, rel=ROUNDED)


def test_plots_of_utils(tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    image = np.linspace(1, 4, 12).reshape(3, 4)
    utils.saveProjections(image, str(tmp_path / "a.png"))
    utils.compareWithGroundTruth(image, image + 0.1, str(tmp_path / "b.png"))
    utils.interactPlotPowerLaw(image, 0.5)
    assert (tmp_path / "a.png").stat().st_size > 1000 and (tmp_path / "b.png").stat().st_size > 1000


def test_the_scene_is_shown(command, tmp_path):
    read(written(tmp_path))
    gvxr.setSceneRotationMatrix(np.eye(4))
    seen = gvxr.takeScreenshot()
    assert seen.shape == (240, 320, 3) and 0 <= seen.min() < seen.max() <= 1
    gvxr.setColour("skin", 1, 0, 0, 1)
    assert (gvxr.takeScreenshot()[..., 0] - gvxr.takeScreenshot()[..., 2]).sum() > (seen[..., 0] - seen[..., 2]).sum()
    assert (gvxr.getLatestScreenshot() == gvxr.takeScreenshot()).all()
    page = utils.visualise()
    assert "<html" in page.html and "<iframe" in page._repr_html_() and len(page.screenshot) > 1000


def test_readers_for_cil(tmp_path):
    reader = JSON2gVXRDataReader(written(tmp_path))
    try:
        import cil  # noqa: F401
    except ImportError:
        with pytest.raises(sk.UnsupportedError, match="CIL, which is not installed"):
            reader.read()
    said = gVXRDataReader(tmp_path, [0, 90], (0, 0, 1), (1, 0, 0)).geometry()
    assert said["source_position"].tolist() == [0, -400, 0] and said["detector_position"].tolist() == [0, 100, 0]
    assert said["rotation_axis_position"].tolist() == [1, 0, 0] and said["detector_direction_y"].tolist() == [0, 0, -1]
    gvxr.useParallelBeam()
    assert gVXRDataReader(tmp_path, [0], (0, 0, 1)).geometry()["ray_direction"].tolist() == [0, 1, 0]


def test_the_dragon_and_the_twins_are_fetched_by_the_user(tmp_path):
    with pytest.raises(sk.FileError, match="skiagraph.gvxr.dragon"):
        gvxr.loadMeshFile("dragon", str(tmp_path / DRAGON), "mm")
    with zipfile.ZipFile(tmp_path / "gvxr.whl", "w") as archive:
        archive.writestr("gvxrPython3/_gvxrPython3/" + DRAGON, b"solid")
        archive.writestr("gvxrPython3/twins/models/one.json5", b"{}")
        archive.writestr("gvxrPython3/utils.py", b"")
    assert dragon.take(tmp_path / "gvxr.whl", tmp_path).read_bytes() == b"solid"
    assert (tmp_path / "twins" / "models" / "one.json5").read_bytes() == b"{}"
    with zipfile.ZipFile(tmp_path / "other.whl", "w") as archive:
        archive.writestr("a.py", b"")
    with pytest.raises(FileNotFoundError, match="other.whl"):
        dragon.take(tmp_path / "other.whl", tmp_path)
    command = [sys.executable, "-W", "error", "-m", "skiagraph.gvxr.dragon"]
    done = subprocess.run([*command, str(tmp_path / "other.whl")], capture_output=True, text=True, check=False)
    assert "FileNotFoundError" in done.stderr and "RuntimeWarning" not in done.stderr
    # pip that finds nothing says which file is missing, and where it goes
    nowhere = {**os.environ, "PIP_NO_INDEX": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=nowhere)
    assert done.returncode == 1 and "Traceback" not in done.stderr
    assert "gvxr-2.1.0-*.whl" in done.stderr and DRAGON in done.stderr and str(pathlib.Path(dragon.__file__).parent) in done.stderr


def test_shapes_of_gvxr():
    gvxr.makeFoamInCuboid("pores", "", 20, 20, 20, (2, 0.2), 20, 10, 0.5, "mm")
    volume = sk.Mesh(gvxr.getVertexSet("pores").reshape(-1, 3), gvxr.getIndexSet("pores").reshape(-1, 3)).health["volume"]
    assert 0.16 * 8000 < volume < 0.21 * 8000  # of polyhedra in spheres that fill 0.2
    assert gvxr.makeSpheresInCylinder("cylinder", 20, 10, 20, "spheres", 8, 8, 1, 10, "mm") == 150
    assert np.hypot(*gvxr.getVertexSet("spheres").reshape(-1, 3)[:, :2].T).max() <= 10
    with pytest.raises(sk.ArgumentError, match="no place is left after"):
        gvxr.makeSpheresInCylinder("c", 20, 3, 3, "s", 8, 8, 1, 70, "mm")
    volume = np.zeros((5, 6, 7))
    volume[1:4, 1:5, 1:6] = 1
    for values in ((0.5, volume), (0.5, volume.ravel().tolist()), (volume.ravel().tolist(), 0.5)):
        gvxr.makeIsoSurface("surface", *values, 7, 6, 5, 1, 1, 2, "mm")
        assert gvxr.getNodeOnlyBoundingBox("surface", "mm") == pytest.approx((1.5, 1.5, 3, 6.5, 5.5, 9))
    gvxr.emptyMesh("sample")  # as the tutorials have it: the volume first, and where its middle is; gVXR 2.1 to 0.002
    for values in ((volume.astype(np.uint8), 1), (volume, 0.5), ((7 * volume).astype(int), 3, 9)):
        gvxr.makeIsoSurface("surface", *values, 3, 4, 5, 1, 1, 2, "mm", "sample")
        assert gvxr.getNodeOnlyBoundingBox("surface", "mm") == pytest.approx((0.5, 2, 2, 5.5, 6, 8))
    gvxr.makeIsoSurface("surface", volume.astype(np.uint8), 0, 0, 0, 0, 1, 1, 2, "mm", "sample", True)
    assert gvxr.getNodeOnlyBoundingBox("surface", "mm") == pytest.approx((-3.5, -3, -5, 3.5, 3, 5))
    with pytest.raises(sk.ArgumentError, match="has 210 values instead of 7 x 6 x 4"):
        gvxr.makeIsoSurface("surface", 0.5, volume, 7, 6, 4, 1, 1, 2, "mm")
    gvxr.makeStepWedge("wedge", 3, 9, 4, 1, 2, "mm")
    assert gvxr.getNodeOnlyBoundingBox("wedge", "mm") == pytest.approx((-4.5, -2, 0, 4.5, 2, 5))


def test_implicit_surfaces():
    gvxr.createImplicitSurface("s")
    gvxr.addControlPoint("s", 1, 0, 0, "mm", "blobby molecule", 1, 0.5)
    gvxr.voxeliseImplicitSurface("s", 41, 41, 41, 0.1, 0, 0, 0.01, 0.01, 0.01, "cm")
    volume = gvxr.getImplicitSurfaceLastVoxelisation("s")
    assert volume.shape == (41, 41, 41) and volume.max() == volume[20, 20, 20] == 1  # about (1, 0, 0) mm
    gvxr.voxelise("s", 41, 41, 41, 0.1, 0, 0, 0.01, 0.01, 0.01, "cm")  # as gVXR 2.0 calls them
    assert (gvxr.getLastVoxelisation("s") == volume).all()
    gvxr.createMeshFromImplicitSurface("s", 0.5)
    assert made("s")["closed"]
    gvxr.createMeshFromImplicitSurface("s", "ball", 0.5, "root", 1)
    radius = np.sqrt(2 * np.log(2))  # where exp(-r^2 / 2) is a half
    assert gvxr.getNodeOnlyBoundingBox("ball", "mm") == pytest.approx((1 - radius, -radius, -radius, 1 + radius, radius, radius),
                                                                     abs=0.01)  # linear between voxels of 0.1 mm
    gvxr.createMeshFromImplicitSurface("s", "shell", 0.5, 0.8)
    shell = sk.Mesh(gvxr.getVertexSet("shell").reshape(-1, 3), gvxr.getIndexSet("shell").reshape(-1, 3)).health
    assert shell["closed"] and shell["components"] == 2
    gvxr.addControlLineSegment("s", 0, 0, 0, 1, 0, 0, "mm", "META_BALL", 2, 1)
    gvxr.setControlLineSegmentParameters("s", 0, "soft object", 2, 1)
    assert (gvxr.getNumberOfControlPoints("s"), gvxr.getNumberOfControlLineSegments("s")) == (1, 1)
    with pytest.raises(sk.ArgumentError, match="'cube' is unknown"):
        gvxr.setControlPointParameters("s", 0, "cube", 1)
    gvxr.destroyImplicitSurface("s")
    with pytest.raises(sk.SceneError, match="no implicit surface 's'"):
        gvxr.getNumberOfControlPoints("s")


@pytest.mark.parametrize("percentage, spread", [(30, 10), (50, 10), (50, 0), (45, 30)])
def test_dense_foam(percentage, spread):
    box, random = np.array([20.0, 18.0, 16.0]), np.random.default_rng(3)
    radii = packing.radii_of(box, 1.5, spread / 100, percentage / 100, random)
    assert percentage / 100 <= 4 / 3 * np.pi * (radii ** 3).sum() / box.prod() < percentage / 100 + 0.03  # one sphere more
    places = packing.pack(box, radii, random)
    distances = np.linalg.norm(places[:, None] - places, axis=-1) + np.eye(len(radii)) * 1e9
    assert (distances >= radii[:, None] + radii).all()
    assert (np.abs(places) + radii[:, None] <= box / 2).all()
    gvxr.makeFoamInCuboid("pores", "", 20, 18, 16, 1.5, percentage, spread, 0.5, "mm")
    made = sk.Mesh(gvxr.getVertexSet("pores").reshape(-1, 3), gvxr.getIndexSet("pores").reshape(-1, 3)).health
    assert made["closed"] and 0.8 * percentage / 100 < made["volume"] / box.prod() < percentage / 100  # polyhedra in spheres


@pytest.mark.parametrize("seed", (2, 5))  # 2 came to rest jammed
def test_foam_of_120_spheres_at_half_the_box(seed):
    gvxr.setSeed(seed)
    side = (120 * 4 / 3 * np.pi * 1.5 ** 3 / 0.5) ** (1 / 3)
    gvxr.makeFoamInCuboid("pores", "", side, side, side, 1.5, 50, 10, 0.5, "mm")
    found = made("pores")
    assert found["closed"] and 110 < found["components"] < 130 and 0.44 * side ** 3 < found["volume"] < 0.5 * side ** 3


@pytest.mark.full  # test_dense_foam
def test_foam_that_is_too_dense():
    with pytest.raises(sk.ArgumentError, match="fill 80.* % of the box; give a smaller percentage"):
        gvxr.makeFoamInCuboid("pores", "", 10, 10, 10, 2, 80, 0, 0.5, "mm")
    with pytest.raises(sk.ArgumentError, match="radius 6 mm does not fit"):
        gvxr.makeFoamInCuboid("pores", "", 10, 10, 10, 6, 50, 0, 0.5, "mm")


def imaged():
    """A cube of water before a small detector, MeV."""
    gvxr.setSourcePosition(0, -40, 0, "cm")
    gvxr.usePointSource()
    gvxr.setMonoChromatic(80, "keV", 1000)
    gvxr.setDetectorPosition(0, 10, 0, "cm")
    gvxr.setDetectorUpVector(0, 0, -1)
    gvxr.setDetectorNumberOfPixels(16, 12)
    gvxr.setDetectorPixelSize(2, 3, "mm")
    gvxr.makeCube("cube", 1, "cm")
    gvxr.setCompound("cube", "H2O")
    gvxr.addPolygonMeshAsInnerSurface("cube")
    return gvxr.computeXRayImage()


def dicom_elements(data):
    """Explicit kinds, little endian: (group, element) -> value."""
    found, at = {}, 132
    while at < len(data):
        group, number, kind, length = struct.unpack_from("<HH2sH", data, at)
        at += 8
        if kind in (b"OB", b"OW"):
            length = struct.unpack_from("<I", data, at)[0]
            at += 4
        found[group, number] = data[at:at + length]
        at += length
    assert at == len(data)
    return found


def test_images_in_the_formats_of_gvxr(tmp_path):
    image = imaged()
    gvxr.saveLastXRayImage(str(tmp_path / "i.mha"))
    assert b"NDims = 2\n" in (tmp_path / "i.mha").read_bytes() and b"DimSize = 16 12\n" in (tmp_path / "i.mha").read_bytes()
    gvxr.saveLastXRayImage(str(tmp_path / "i.mhd"))
    header = dict(line.split(" = ") for line in (tmp_path / "i.mhd").read_text().splitlines())
    assert (header["DimSize"], header["ElementSpacing"], header["ElementType"]) == ("16 12", "2 3", "MET_FLOAT")
    assert (np.fromfile(tmp_path / header["ElementDataFile"], "<f4").reshape(12, 16) == image).all()
    gvxr.saveLastXRayImage(str(tmp_path / "i.txt"))
    assert (np.loadtxt(tmp_path / "i.txt", dtype=np.float32) == image).all()
    gvxr.saveLastXRayImage(str(tmp_path / "i.dcm"))
    data = (tmp_path / "i.dcm").read_bytes()
    found = dicom_elements(data)
    assert data[128:132] == b"DICM" and struct.unpack("<I", found[2, 0])[0] == len(data[144:]) - sum(
        len(value) + (12 if key == (0x7FE0, 0x10) else 8) for key, value in found.items() if key[0] > 2)
    assert [key for key in found] == sorted(found)
    levels = np.frombuffer(found[0x7FE0, 0x10], "<u2").reshape(12, 16)
    slope, low = float(found[0x28, 0x1053]), float(found[0x28, 0x1052])
    assert levels.max() == 65535 and np.abs(levels * slope + low - image).max() <= 0.51 * slope  # and roundings to 9 digits
    gvxr.computeCTAcquisition(str(tmp_path / "scan.mhd"), "", 2, 0, False, 180, 0, 0, 0, 0, "mm", 0, 0, 1)
    assert len(list(tmp_path.glob("scan.mhd/*.tiff"))) == 2  # a folder, as its name is none of a file of a scan
    gvxr.saveLastProjectionSet(str(tmp_path / "set.mhd"))
    assert "DimSize = 16 12 2" in (tmp_path / "set.mhd").read_text()
    with pytest.raises(sk.ArgumentError, match=r"\.txt holds one image and not 2"):
        gvxr.saveLastProjectionSet(str(tmp_path / "set.txt"))
    (tmp_path / "folder.txt").mkdir()
    before = sorted(tmp_path.iterdir())
    with pytest.raises(sk.FileError, match="cannot be written"):
        gvxr.saveLastXRayImage(str(tmp_path / "folder.txt"))
    assert sorted(tmp_path.iterdir()) == before  # nothing half written stays behind


def test_images_with_gain():
    image = imaged()
    assert (gvxr.computeXRayImageWithGain() == np.rint(image)).all()  # whole numbers, as gVXR 2.1 gives them
    gvxr.setDetectorGain(3)
    gvxr.setDetectorBias(50)
    read = gvxr.computeXRayImageWithGain()
    assert read.dtype == np.uint16 and np.abs(read - (3 * image + 50)).max() <= 0.5001
    assert np.abs(gvxr.getWhiteImageWithGain() - (3 * gvxr.getWhiteImage() + 50)).max() <= 0.5001
    assert (gvxr.getLastXRayImage() == image).all()
    assert gvxr.getTotalEnergyWithDetectorResponseWithGain() == 3 * 80 + 50
    into = np.zeros(image.shape, np.uint16)
    gvxr.computeXRayImageWithGain(into)
    assert (into == read).all()
    gvxr.setDetectorStdDevBias(2)
    noise = np.array([gvxr.computeXRayImageWithGain().astype(float) - read for _ in range(50)])
    assert abs(noise.std() - np.sqrt(4 + 1 / 12)) < 0.1 and abs(noise.mean()) < 0.1  # 9600 numbers: 5 standard deviations each
    assert (gvxr.getDetectorGain(), gvxr.getDetectorBias(), gvxr.getDetectorStdDevBias()) == (3, 50, 2)
    gvxr.setDetectorStdDevBias(0)
    arguments = ("", "", 3, 0, False, 180, 1, 0, 0, 0, "mm", 0, 0, 1)
    scan = gvxr.computeCTAcquisitionWithGain(*arguments)
    assert (gvxr.getLastProjectionSetWithGain() == scan).all()
    assert np.abs(scan[0] - read / gvxr.getWhiteImageWithGain()).max() < 1e-6
    assert np.abs(gvxr.computeCTAcquisition(*arguments)[0] - image / gvxr.getWhiteImage()).max() < 1e-6
    gvxr.setDetectorGain(1e6)  # overexposed
    assert gvxr.computeXRayImageWithGain().max() == gvxr.getTotalEnergyWithDetectorResponseWithGain() == 65535
    gvxr.setDetectorBias(-1e9)
    assert gvxr.computeXRayImageWithGain().max() == 0


def test_readers_bring_what_gvxrs_bring():
    for module, names in (("gVXRDataReader", "gVXRDataReader gvxr np os"),
                          ("JSON2gVXRDataReader", "JSON2gVXRDataReader gvxr json np os")):
        brought = {}
        exec(f"from skiagraph.gvxr.{module} import *", brought)
        assert set(names.split()) <= set(brought) and brought["gvxr"] is gvxr


def made(label):
    return sk.Mesh(gvxr.getVertexSet(label).reshape(-1, 3), gvxr.getIndexSet(label).reshape(-1, 3)).health


@pytest.mark.parametrize("inner", (20, 24, 10))  # as high, longer, and within
def test_a_cylinder_is_hollowed(inner):
    gvxr.makeCylinder("hollow", 12, 20, 6, "mm")
    gvxr.makeCylinder("core", 12, inner, 3, "mm")
    whole, core = made("hollow")["volume"], made("core")["volume"]
    gvxr.subtractMesh("hollow", "core")
    rest = made("hollow")
    assert rest["closed"] and rest["volume"] == pytest.approx(whole - core * min(inner, 20) / inner, rel=1e-9)


def test_meshes_are_subtracted_one_after_another():
    gvxr.makeCuboid("matrix", 40, 10, 20, "mm")
    for number, place in enumerate((-12, 0, 12)):
        for name, radius in (("fibre", 4), ("core", 1)):
            label = f"{name}{number}"
            gvxr.makeCylinder(label, 16, 14, radius, "mm")
            gvxr.translateNode(label, place, 0, 0, "mm")
            gvxr.applyCurrentLocalTransformation(label)
        gvxr.subtractMesh("matrix", f"fibre{number}")
    hole = made("fibre0")["volume"] / 14
    assert made("matrix")["closed"] and made("matrix")["volume"] == pytest.approx(40 * 10 * 20 - 3 * 10 * hole, rel=1e-9)
    for name in ("fibre", "core"):
        gvxr.emptyMesh(name + "s")
        for number in range(3):
            gvxr.addMesh(name + "s", f"{name}{number}")
    before, cores = made("fibres")["volume"], made("cores")["volume"]
    gvxr.subtractMesh("fibres", "cores")  # three convex pieces
    assert made("fibres")["volume"] == pytest.approx(before - cores, rel=1e-9)
    imaged()
    gvxr.removePolygonMeshesFromXRayRenderer()
    gvxr.addPolygonMeshAsInnerSurface("matrix")
    gvxr.setCompound("matrix", "H2O")
    lengths = gvxr.computeLBuffer("matrix")
    assert lengths.min() >= 0 and lengths.max() < 1.02  # cm: through 10 mm of the matrix, up to 6 degrees oblique


def test_what_cannot_be_subtracted():
    gvxr.makeCuboid("l", 10, 10, 10, "mm")
    gvxr.makeCuboid("arm", 30, 4, 4, "mm")
    gvxr.translateNode("arm", 100, 0, 0, "mm")
    whole = made("l")["volume"]
    gvxr.subtractMesh("l", "arm")  # beside it
    assert made("l")["volume"] == whole
    vertices = [0, 0, 0, 20, 0, 0, 20, 5, 0, 5, 5, 0, 5, 20, 0, 0, 20, 0]
    walls = [[i, (i + 1) % 6, (i + 1) % 6 + 6] for i in range(6)] + [[i, (i + 1) % 6 + 6, i + 6] for i in range(6)]
    top = [[6, 7, 8], [6, 8, 9], [6, 9, 10], [6, 10, 11]]
    faces = walls + top + [[c - 6, b - 6, a - 6] for a, b, c in top]
    gvxr.makeTriangularMesh("angle", vertices + [v + (i % 3 == 2) * 5 for i, v in enumerate(vertices)], np.ravel(faces), "mm")
    assert made("angle")["volume"] == pytest.approx(875)
    with pytest.raises(sk.ArgumentError, match="angle: is not convex"):
        gvxr.subtractMesh("angle", "l")


def test_a_line_spread_function_is_written_and_read_again(tmp_path):
    imaged()
    gvxr.setLSF([0.2, 0.6, 0.2])
    image = gvxr.computeXRayImage()
    gvxr2json.saveJSON(str(tmp_path / "scene.json"))
    gvxr.destroyAllWindows()
    json2gvxr.initGVXR(str(tmp_path / "scene.json"))
    for part in (json2gvxr.initSourceGeometry, json2gvxr.initSpectrum, json2gvxr.initDetector, json2gvxr.initSamples):
        part()
    assert list(gvxr.getLSF()) == pytest.approx([0.2, 0.6, 0.2])
    np.testing.assert_allclose(gvxr.computeXRayImage(), image, rtol=2e-6)


def test_several_outer_surfaces_without_inner_ones():
    imaged()
    gvxr.makeCube("other", 1, "cm")
    gvxr.translateNode("other", -1.2, 0, 0, "cm")
    gvxr.setCompound("other", "H2O")
    gvxr.addPolygonMeshAsInnerSurface("other")
    inner = gvxr.computeXRayImage()
    for label in ("cube", "other"):
        gvxr.addPolygonMeshAsOuterSurface(label)
    assert (gvxr.computeXRayImage() == inner).all()
