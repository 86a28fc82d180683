"""Scans: the same projections as batches of views, files of them, breath, interrupts."""
import json
import pathlib
import pickle
import shutil
import signal
import subprocess
import threading

import numpy as np
import pytest

import skiagraph as sk
from skiagraph.scene import state_of

N = 6


@pytest.fixture
def scanned(scene, view):
    scene.trajectory = sk.Scan(view, N, axis="y")
    return scene


@pytest.fixture
def path(tmp_path):
    """A scene file with a scan."""
    made = tmp_path / "scene.json"
    made.write_text(json.dumps({
        "Source": {"Position": [0, -40, 0, "cm"], "Shape": "PointSource",
                   "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
        "Detector": {"Position": [0, 10, 0, "cm"], "UpVector": [0, 0, -1], "NumberOfPixels": [32, 24],
                     "Size": [32, 24, "cm"]},
        "Samples": [{"Label": "block", "Cuboid": [60, 40, 80, "mm"], "Material": ["mu", 0.2]}],
        "Scan": {"NumberOfProjections": N, "FinalAngle": 360}}))
    return made


XTEKCT = """[XTekCT]
Name=turbine
Projections=4
InitialAngle=10.0
AngularStep=90
SrcToObject=200.0
SrcToDetector=1000.0
DetectorPixelsX=64
DetectorPixelsY=48
DetectorPixelSizeX=0.2
DetectorPixelSizeY=0.25
"""


def test_a_scan_of_a_nikon_scanner(tmp_path, scene):
    path = tmp_path / "turbine.xtekct"
    path.write_text(XTEKCT + "ObjectOffsetX=3\n")
    scan = sk.Scan.xtekct(path)
    # As CIL's NikonDataReader has it: sample angles of 180 - InitialAngle - k AngularStep, the axis at -ObjectOffsetX,
    # columns against x and rows against z ("top-right").
    assert scan.angles.round(9).tolist() == [170, 80, -10, -100]
    turned = sk.rotate("z", 170) @ scan[0]
    assert turned.source == pytest.approx((3, -200, 0), abs=1e-9) and turned.detector == pytest.approx((3, 800, 0), abs=1e-9)
    assert turned.column_step == pytest.approx((-0.2, 0, 0), abs=1e-12) and turned.row_step == pytest.approx((0, 0, -0.25), abs=1e-12)
    assert scan[0].shape == (48, 64)
    scene.view, scene.trajectory = scan[0], scan
    assert scene.scan(quantity="attenuation").shape == (4, 48, 64)
    path.write_text(XTEKCT + "CentreOfRotationTop=2\nCentreOfRotationBottom=1\n")  # mm on the detector, 5 times as far
    leaning = pickle.loads(pickle.dumps(sk.Scan.xtekct(path)))
    assert leaning[0].source[2] != 0  # the axis rolls, by 1 in 12
    assert leaning.axis[0][0] / leaning.axis[0][2] == pytest.approx(-1 / 12) and leaning.axis[1] == pytest.approx(0, abs=1e-12)
    path.write_text(XTEKCT + "ObjectTilt=30\n")
    axis = np.cross(*(sk.Scan.xtekct(path)[k].source - sk.Scan.xtekct(path)[k + 1].source for k in (0, 1)))
    assert abs(axis[1:] / np.linalg.norm(axis)) == pytest.approx((0.5, np.sqrt(0.75)))
    path.write_text(XTEKCT + "DetectorOffsetX=4\n")
    with pytest.raises(sk.UnsupportedError, match="DetectorOffsetX is 4, and what it does to the geometry is not known"):
        sk.Scan.xtekct(path)
    path.write_text(XTEKCT.replace("SrcToObject=200.0", "SrcToObject=far"))
    with pytest.raises(sk.FormatError, match="turbine.xtekct: SrcToObject is 'far'"):
        sk.Scan.xtekct(path)
    with pytest.raises(sk.FileError, match="none.xtekct: cannot be read"):
        sk.Scan.xtekct(tmp_path / "none.xtekct")


def stack(path):
    """The values of a .raw file."""
    return np.fromfile(path, np.float32).reshape(N, 24, 32)


def test_a_scan_is_a_sequence_of_views(view):
    scan = sk.Scan(view, 4, axis="y", start=10)
    assert len(scan) == 4 and scan[0].pixels == view.pixels
    np.testing.assert_allclose(scan.angles, [10, 100, 190, 280], rtol=1e-14)  # degrees by way of radians
    # samples that turn one way are a source that turns the other way
    turned = sk.rotate("y", -100) @ view
    np.testing.assert_allclose(scan[1].source, turned.source, atol=1e-9)  # 1e6 roundings of 1000 mm
    assert scan[-1] == scan[3] and [v for v in scan] == scan[:]
    with pytest.raises(IndexError):
        scan[4]
    assert sk.Scan(view, 3, 0, interval_s=0.5, start_s=1).times.tolist() == [1, 1.5, 2]


def test_fields_are_in_degrees(view):
    tilted = sk.Scan(view, 1, detector_tilt=(0, 0, 90))[0]
    np.testing.assert_allclose(tilted.column_step, view.row_step, atol=1e-12)  # the rounding of cos 90 degrees
    with pytest.raises(sk.ArgumentError, match="the field of a scan 'pich_mm' is unknown; did you mean 'pitch_mm'"):
        sk.Scan(view, 3, pich_mm=2)
    with pytest.raises(sk.ArgumentError, match="projections is 0"):
        sk.Scan(view, 0)
    with pytest.raises(sk.ArgumentError, match="axis is 'w'"):
        sk.Scan(view, 3, axis="w")


def test_tables_of_poses(view, tmp_path):
    circle = sk.Scan(view, N, axis="y")
    circle.save(tmp_path / "poses.csv")
    read = sk.Scan.load(view, tmp_path / "poses.csv")
    rows = [np.concatenate((v.source, v.detector, v.column_step, v.row_step)) for v in circle]
    for scan in (read, sk.Scan.table(view, rows), pickle.loads(pickle.dumps(read)), pickle.loads(pickle.dumps(circle))):
        assert len(scan) == N
        for one, other in zip(scan, circle):
            np.testing.assert_allclose(one.source, other.source, atol=1e-9)  # the digits of the file
    with pytest.raises(sk.ArgumentError, match=r"poses has the shape \(3, 4\)"):
        sk.Scan.table(view, np.zeros((3, 4)))


def test_projections_are_images_of_the_views(scanned):
    found = scanned.scan(quantity="attenuation")
    assert found.dtype == np.float32
    assert (found == scanned.images("attenuation", views=scanned.trajectory)).all()
    some = scanned.scan(quantity="attenuation", only=[1, 4])
    assert (some == found[[1, 4]]).all()
    out = np.zeros((N, *scanned.view.shape))
    assert scanned.scan(out, "attenuation") is out and (out == found).all()
    assert scanned.scan(precision="double").dtype == np.float64
    scanned.beam = sk.Beam([30, 60], [100, 200])
    assert scanned.scan(quantity="photons", bands=[20, 40, 80]).shape == (N, 2, *scanned.view.shape)


def test_a_reconstruction_is_about_the_axis_of_its_scan(scanned):
    scanned.trajectory = sk.Scan(scanned.view, 60, axis="y", centre=(2, 0, 1))
    projections = scanned.scan(quantity="attenuation")
    volume = sk.reconstruct(scanned.trajectory, projections, size=16)
    told = sk.reconstruct(scanned.trajectory, projections, size=16, axis="y", centre=(2, 0, 1))
    assert np.array_equal(volume, told) and volume.max() > 0
    with pytest.raises(sk.UnsupportedError, match="but lean by 6 degrees"):
        sk.reconstruct(scanned.trajectory, projections, size=16, axis="z")


def test_what_is_wrong_for_a_reconstruction(scanned, view):
    scan = sk.Scan(view, 60, axis="y")
    projections = np.zeros((60, *view.shape), np.float32)
    projections[4, 3, 2] = np.nan
    with pytest.raises(sk.ArgumentError, match="projection 4: the value of row 3, column 2 is"):
        sk.reconstruct(scan, projections, size=8, axis="y")
    for size in (16.5, (8, 8, 0), "8"):
        with pytest.raises(sk.ArgumentError, match="size is .*; give a whole number"):
            sk.reconstruct(scan, np.zeros_like(projections), size=size, axis="y")


def test_numbers_that_are_not_whole_are_refused(scanned, view):
    def seen(pixels):
        return sk.View(source=view.source, detector=view.detector, column_step=view.column_step, row_step=view.row_step, pixels=pixels)
    with pytest.raises(sk.ArgumentError, match=r"pixels\[0\] is 96.5; give a whole number"):
        seen((96.5, 64))
    assert seen((96.0, np.int64(64))).pixels == (96, 64)
    with pytest.raises(sk.ArgumentError, match="index is -1; give a whole number, 0 or more"):
        scanned.image(index=-1, noise=True)
    with pytest.raises(sk.ArgumentError, match="noise_seed is -1; give a whole number, 0 or more"):
        scanned.image(noise_seed=-1, noise=True)


def test_what_is_wrong_is_named(scanned, view, path):
    with pytest.raises(sk.ArgumentError, match="out has the shape"):
        scanned.scan(np.zeros((N, 3, 4)))
    with pytest.raises(sk.ArgumentError, match="only has"):
        scanned.scan(only=[0.5])
    with pytest.raises(sk.ArgumentError, match="numbers rise"):
        scanned.scan(only=[3, 1])
    with pytest.raises(sk.ArgumentError, match="sub-frames"):
        scanned.scan(subframes=0)
    with pytest.raises(sk.ArgumentError, match="trajectory is a View"):
        scanned.trajectory = view
    assert scanned.scan().shape[0] == N
    with pytest.raises(sk.SceneError, match="no key Scan"):
        sk.Scene().trajectory
    read = sk.Scene(path)
    read.view.source[0] += 1
    with pytest.raises(sk.SceneError, match="view was changed"):
        read.scan()


def test_a_stale_plan_is_made_anew(scanned):
    scanned.beam = sk.Beam.tube(80, {"Al": 2.5})
    scanned["block"].material = "water"
    first = scanned.scan(quantity="transmission", tolerance=1e-3)
    scanned["ball"].material = "bone cortical icru44"
    second = scanned.scan(quantity="transmission", tolerance=1e-3)
    assert second.min() < first.min()


def test_subframes_blur_the_edges(scene, view):
    scene.trajectory = sk.Scan(view, 3, 20, axis="y", interval_s=1, exposure_s=1)
    sharp, blurred = scene.scan(quantity="transmission"), scene.scan(quantity="transmission", subframes=5)
    assert not (sharp == blurred).all()
    mean = np.mean([scene.images("transmission", views=[sk.rotate("y", -a) @ view])[0] for a in (-8, -4, 0, 4, 8)], 0)
    np.testing.assert_allclose(blurred[0], mean, atol=1e-4)  # rounding of the moved views at edges


def test_a_file_is_the_array(path, tmp_path):
    scene = sk.Scene(path)
    said = scene.scan(tmp_path / "scan.raw")
    assert (stack(tmp_path / "scan.raw") == scene.scan()).all()
    assert {k: said[k] for k in ("projections", "found", "computed", "finished")} == {
        "projections": N, "found": 0, "computed": N, "finished": True}
    assert scene.scan(tmp_path / "scan.raw")["computed"] == 0
    with pytest.raises(sk.OutputError):
        scene.scan(tmp_path / "scan.raw", "attenuation")
    assert scene.scan(tmp_path / "scan.raw", "attenuation", overwrite=True)["computed"] == N
    with pytest.raises(sk.ArgumentError, match="xyz"):
        scene.scan(tmp_path / "scan.xyz")
    with pytest.raises(sk.ArgumentError, match="bands"):
        scene.scan(tmp_path / "bands.raw", bands=[10, 100])


def test_a_file_is_continued(path, tmp_path):
    scene = sk.Scene(path)
    scene.scan(tmp_path / "whole.raw")
    part = scene.scan(tmp_path / "scan.raw", only=[1, 4])
    assert part["computed"] == 2 and not part["finished"]
    seen = []
    rest = sk.Scene(path).scan(str(tmp_path / "scan.raw"), progress=lambda done, of: seen.append((done, of)))
    assert rest["found"] == 2 and rest["computed"] == 4 and rest["finished"]
    assert seen[-1] == (4, 4)
    assert (tmp_path / "scan.raw").read_bytes() == (tmp_path / "whole.raw").read_bytes()


@pytest.mark.skipif(not shutil.which("skiagraph"), reason="the command is not on the PATH")
def test_the_command_knows_the_scan(path, tmp_path):
    scene = sk.Scene(path)
    said = scene.scan(tmp_path / "scan.raw", "attenuation", only=[0, 3])
    done = subprocess.run(["skiagraph", "scan", path, "-o", tmp_path / "scan.raw", "--quantity", "attenuation", "--json"],
                          capture_output=True, text=True, check=True)
    printed = json.loads(done.stdout)
    assert printed["hash"] == said["hash"] and printed["found"] == 2 and printed["computed"] == N - 2
    assert (stack(tmp_path / "scan.raw") == scene.scan(quantity="attenuation")).all()


def test_a_scene_that_was_changed_is_another_scan(path, tmp_path):
    def hash_of(change, **options):
        scene = sk.Scene(path)
        change(scene)
        return scene.scan(tmp_path / "scan.raw", overwrite=True, **options)["hash"]

    def add(scene):
        scene.add("ball", sk.Mesh.sphere(5, 16), material="Al", inside="block")

    hashes = [
        hash_of(lambda scene: None), hash_of(lambda scene: None, world=sk.Material("air")), hash_of(add),
        hash_of(lambda scene: setattr(scene["block"], "pose", sk.translate(1, 0, 0))),
        hash_of(lambda scene: setattr(scene["block"], "pose", sk.translate(2, 0, 0))),
        hash_of(lambda scene: setattr(scene["block"], "material", "Al")),
        hash_of(lambda scene: setattr(scene, "beam", sk.Beam.mono(50, 1000))),
        hash_of(lambda scene: setattr(scene["block"].mesh, "vertices", scene["block"].mesh.vertices * 0.9)),
        hash_of(lambda scene: setattr(scene, "trajectory", sk.Scan(scene.view, N, 1))),
        hash_of(lambda scene: None, response=sk.Response.scintillator("CsI", 0.6)),
        hash_of(lambda scene: None, spot={"shape": "disc", "extent": 2, "samples": 4}),
    ]
    assert len(set(hashes)) == len(hashes)
    assert hash_of(lambda scene: None, strategy="tiles") == hashes[0]
    assert hash_of(add) == hashes[2]


def test_hdf5_has_fields(path, tmp_path):
    scene = sk.Scene(path)
    try:
        said = scene.scan(tmp_path / "scan.h5", flats=2, darks=1, noise=True)
    except sk.UnsupportedError:
        pytest.skip("a build without HDF5")
    assert said["finished"]
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "scan.h5") as file:
        assert (file["/exchange/data"][:] == scene.scan(noise=True)).all()
        white = file["/exchange/data_white"][:]
        assert white.shape[0] == 2 and not (white[0] == white[1]).all()
        # 1000 photons of 60 keV a pixel; the mean of 768 pixels within 5 standard errors
        assert abs(white[0].mean() / 60e3 - 1) < 5 / np.sqrt(1000 * 768)
        assert not file["/exchange/data_dark"][:].any()


def test_other_files_have_fields_beside_if_asked_or_needed(path, tmp_path):
    scene = sk.Scene(path)
    scene.scan(tmp_path / "plain.mha")
    assert not (tmp_path / "plain-flats.mha").exists()
    scene.scan(tmp_path / "scan.mha", flats=2)
    size = 768 * 4
    dark = (tmp_path / "scan-darks.mha").read_bytes()[-size:]
    white = np.frombuffer((tmp_path / "scan-flats.mha").read_bytes()[-2 * size:], np.float32)
    assert not any(dark) and white == pytest.approx(60e3, rel=1e-6)
    uneven = sk.Scene(path, settings={"Falloff": True})
    uneven.scan(tmp_path / "uneven.mha")
    assert (tmp_path / "uneven-flats.mha").exists() and b"\nFlatFieldVaries = True" in (tmp_path / "uneven.mha").read_bytes()
    scene.scan(tmp_path / "folder", darks=2)
    assert (tmp_path / "folder" / "flat-00000.tif").exists() and (tmp_path / "folder" / "dark-00001.tif").exists()


def test_an_interrupt_ends_a_scan_and_the_file_is_continued(path, tmp_path):
    scene = sk.Scene(path, settings={"Scan": {"NumberOfProjections": 20000, "FinalAngle": 360}})
    seen = []

    def interrupt(done, of):
        if not seen:
            signal.raise_signal(signal.SIGINT)
        seen.append(done)

    with pytest.raises(KeyboardInterrupt):
        scene.scan(tmp_path / "scan.raw", progress=interrupt)
    assert not seen and state_of(scene).device._unfinished
    # The next call waits for what is under way; then the lock is given up.
    assert scene.image().shape == (24, 32)
    assert not state_of(scene).device._unfinished and not (tmp_path / "scan.raw.lock").exists()
    said = scene.scan(tmp_path / "scan.raw", only=range(100))
    assert 0 < said["found"] < 20000
    with pytest.raises(KeyboardInterrupt):
        scene.scan(progress=interrupt)
    scene.image()
    assert all(thread.name != "skiagraph scan" for thread in threading.enumerate())


def test_progress_that_fails_ends_a_scan(scanned):
    def fail(done, of):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        scanned.scan(progress=fail)
    assert scanned.scan().shape[0] == N


def test_progress_of_a_scan_is_drawn(scanned, capsys):
    scanned.scan(progress=True)
    assert f"{N}/{N}" in capsys.readouterr().err


def test_trajectories_pickle_with_their_scenes(scanned):
    assert (pickle.loads(pickle.dumps(scanned)).scan() == scanned.scan()).all()


def test_a_breathing_scan(tmp_path):
    settings = {"Detector.NumberOfPixels": [16, 16],
                "Scan": {"NumberOfProjections": 3, "FinalAngle": 0, "Interval": 1.0}}
    scene = sk.Scene(sk.thorax(tmp_path, 10000), settings=settings)
    still, vertices = scene.image("attenuation"), scene["liver"].mesh.vertices
    found = scene.scan(quantity="attenuation", breathing=True)
    assert not (found[0] == found[1]).all()
    # The meshes are where they were.
    assert (scene["liver"].mesh.vertices == vertices).all() and not state_of(scene).is_changed()
    assert (scene.image("attenuation") == still).all()
    for image, time in zip(found, scene.trajectory.times):
        scene.breathe(time=time)
        assert (scene.images("attenuation", views=scene.trajectory[:1])[0] == image).all()
    with pytest.raises(sk.SceneError, match="breathing=True"):
        scene.scan()
    posed = scene.image()
    assert (scene.scan(quantity="attenuation", breathing=True) == found).all()
    assert (scene.image() == posed).all()


def test_cost_sees_every_change(path):
    scene = sk.Scene(path)
    assert not state_of(scene).is_changed()
    scene["block"].pose = sk.translate(1, 0, 0)
    assert state_of(scene).is_changed()
    moved = sk.Scene(path)
    moved.view.source[1] -= 10
    assert state_of(moved).is_changed()


@pytest.mark.full  # test_a_breathing_scan, reconstruct_test
@pytest.mark.skipif(not shutil.which("skiagraph"), reason="the command is not on the PATH")
def test_a_dome_in_four_dimensions(tmp_path):
    """A scan while the thorax breathes, reconstructed at two phases: the dome is where the meshes have it."""
    size, voxel, angles = 80, 4.0, 60
    described = json.loads(pathlib.Path(sk.thorax(tmp_path, 10000)).read_text())
    described["Breathing"] = {"Pattern": "quiet", "Period": 4.0, "Reference": 0}
    described["Source"] = {"Position": [0, -1000, 0, "mm"], "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1}]}
    described["Detector"] = {"Position": [0, 500, 0, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [160, 112],
                             "Spacing": [4, 4, "mm"]}
    described["Scan"] = {"NumberOfProjections": 2 * angles, "FinalAngle": 360, "Interval": 2.0}
    described["Samples"] = [part for part in described["Samples"] if part["Label"] != "needle"]  # of steel
    (tmp_path / "scan.json").write_text(json.dumps(described))
    for command in (["scan", "scan.json", "-o", "scan.h5", "--quantity", "attenuation", "--breathing", "--phases", "2"],
                    *(["reconstruct", f"scan.phase-{k}-of-2.h5", "-o", f"{k}.mha", "--size", str(size), "--voxel", str(voxel)]
                      for k in (1, 2))):
        subprocess.run(["skiagraph", *command, "--quiet"], cwd=tmp_path, check=True)
    scene, place, heights = sk.Scene(tmp_path / "scan.json"), None, []
    for phase in (0, 1):
        scene.breathe(phase=phase / 2)
        lung = scene["lung right"].mesh
        corners = np.asarray(lung.vertices, float)[np.asarray(lung.faces)]
        if place is None:  # over the top of the liver
            liver = np.asarray(scene["liver"].mesh.vertices, float)
            place = np.round(liver[liver[:, 2].argmax(), :2] / voxel + (size - 1) / 2).astype(int)
        x, y = (place - (size - 1) / 2) * voxel
        side, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        area = side[:, 0] * other[:, 1] - side[:, 1] * other[:, 0]
        u = ((x - corners[:, 0, 0]) * other[:, 1] - (y - corners[:, 0, 1]) * other[:, 0]) / area
        v = (side[:, 0] * (y - corners[:, 0, 1]) - side[:, 1] * (x - corners[:, 0, 0])) / area
        hit = (u >= 0) & (v >= 0) & (u + v <= 1)
        mesh = (corners[:, 0, 2] + u * side[:, 2] + v * other[:, 2])[hit].min()
        volume = np.frombuffer((tmp_path / f"{phase + 1}.mha").read_bytes()[-4 * size ** 3:], "<f4").reshape((size,) * 3)
        profile = volume[:, place[1], place[0]]
        near = round(mesh / voxel + (size - 1) / 2)
        level = (profile[near - 6:near - 2].mean() + profile[near + 3:near + 7].mean()) / 2
        k = next(k for k in range(near - 3, near + 4) if profile[k] >= level > profile[k + 1])
        seen = (k + (profile[k] - level) / (profile[k] - profile[k + 1]) - (size - 1) / 2) * voxel
        heights.append((mesh, seen))
    meshes, volumes = np.array(heights).T
    assert meshes[1] - meshes[0] > 10
    assert volumes[1] - volumes[0] == pytest.approx(meshes[1] - meshes[0], abs=0.5)  # an eighth of a voxel
    np.testing.assert_allclose(volumes, meshes, atol=voxel / 2)  # the dome is curved within a voxel


def test_lag_of_frames():
    terms = [[0.1, 2], [0.05, 10]]
    lag = sk.Lag(terms)
    light = np.full((2, 3), 5.0)
    for _ in range(200):
        shown = lag(light)
    np.testing.assert_allclose(shown, light, rtol=1e-6)  # exp(-200 / 10) is missing
    for n in range(1, 6):
        expected = 5 * sum(share * np.exp(-(n - 1) / frames) for share, frames in terms)
        np.testing.assert_allclose(lag(np.zeros((2, 3))), expected, rtol=1e-6)
    lag.clear()
    assert lag(np.zeros((2, 3), np.float32)).dtype == np.float32 and not lag(np.zeros((2, 3))).any()
    with pytest.raises(sk.ArgumentError, match="frames before"):
        lag(np.zeros((3, 3)))
    with pytest.raises(sk.ArgumentError, match="less than 1"):
        sk.Lag([[1.5, 2]])(light)
    ghost = sk.Lag(ghosting=[[-0.02, 5]], full=5)
    for n in range(4):
        np.testing.assert_allclose(ghost(light), 5 * (1 - 0.02 * (1 - np.exp(-n / 5))), rtol=1e-12)
    with pytest.raises(sk.ArgumentError, match="rows of a change"):
        sk.Lag(ghosting=[0.1])
