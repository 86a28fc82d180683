"""A scene is written as a scene file and read back; parts are taken out."""
import json
import pickle

import numpy as np
import pytest

import skiagraph as sk


def again(scene, path, **options):
    """The scene that was written, which has the same image."""
    scene.save(path)
    read = sk.Scene(path)
    np.testing.assert_array_equal(read.image(index=0, **options), scene.image(index=0, **options))  # frames count on
    assert [(p.label, p.inside, p.priority) for p in read] == [(p.label, p.inside, p.priority) for p in scene]
    return read


def test_a_scene_reads_back_to_the_same_bits(scene, tmp_path):
    scene["ball"].pose = sk.rotate((1, 2, 3), 33.3) @ sk.translate(1.1, 2.2, 3.3)
    scene.view = sk.rotate((1, 1, 0), 12.34) @ scene.view
    scene.beam = sk.Beam.tube(100, {"Al": 2.5}, mas=2)
    read = again(scene, tmp_path / "a.json")
    assert read.view == scene.view and read.beam.absolute
    read["ball"].material, read["block"].material = "water", sk.Material.mu(0.123)
    read.beam = sk.Beam.mono(61.7, 1234.5)
    read.trajectory = sk.Scan(read.view, 3)
    twice = again(read, tmp_path / "b.json")
    np.testing.assert_array_equal(twice.scan(), read.scan())


def test_materials_of_every_kind_are_written(scene, tmp_path):
    kinds = [sk.Material("Ti90Al6V4", by="mass"), sk.Material.table([10, 100], [0.3, 0.1]), sk.Material.hu(52),
             sk.Material.mixture({"H": 0.112, "O": 0.888}, 1.0), sk.Material.formula("SiO2", 2.2), sk.Material("Al", density=2),
             sk.Material("water").at_density(0.9)]
    for number, kind in enumerate(kinds):
        scene.add(f"part {number}", sk.Mesh.cube(2), material=kind, pose=sk.translate(3 * number - 9, 0, 40))
    again(scene, tmp_path / "scene.json")


FILE = {"Source": {"Position": [0, -500, 0, "mm"], "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
        "Detector": {"Position": [0, 100, 0, "mm"], "Up vector": [0, 0, -1], "NumberOfPixels": [32, 24], "Spacing": [2, 2, "mm"]},
        "Noise": {"Seed": 3}, "Samples": [
            {"Label": "pot", "Path": "pot.ply", "Unit": "mm", "Material": ["mu", 0.1], "Type": "outer"},
            {"Label": "rod", "Cylinder": [20, 20, 4, "mm"], "Material": "Al", "Transform": [["Rotation", 40, 1, 0, 0]]},
            {"Label": "nut", "Cube": [3, "mm"], "Material": "Fe", "MoveToCentre": True, "Parent": "rod"}]}


@pytest.mark.parametrize("key", ["FlipNormals", "InvertNormalVectors", "invert normal"])
def test_a_changed_mesh_is_not_turned_again(key, tmp_path):
    """The schema knows all spellings of the key."""
    scene = sk.Scene({**FILE, "Samples": [{"Label": "nut", "Cube": [3, "mm"], "Material": "Fe", key: True, "MoveToCenter": True}]})
    scene["nut"].mesh.vertices = 2 * scene["nut"].mesh.vertices
    again(scene, tmp_path / "scene.json")
    sample, = json.loads((tmp_path / "scene.json").read_text())["Samples"]
    assert set(sample) <= {"Label", "Path", "Unit", "Material", "Transform", "Parent"}


def described(folder, **others):
    (folder / "old").mkdir()
    sk.Mesh.cuboid(30, 20, 25).save(folder / "old" / "pot.ply")
    path = folder / "old" / "scene.json"
    path.write_text(json.dumps({**FILE, **others}))
    return sk.Scene(path)


@pytest.mark.parametrize("together", [False, True])
def test_files_and_keys_stay(tmp_path, together):
    scene = described(tmp_path, **({"Samples": [*FILE["Samples"], "MoveToCentre"]} if together else {}))
    again(scene, tmp_path / "same.json")
    text = json.loads((tmp_path / "same.json").read_text())
    assert text["Samples"][0]["Path"] == "old/pot.ply" and text["Noise"] == {"Seed": 3}
    scene["rod"].pose = sk.translate(1, 2, 3) @ scene["rod"].pose
    scene.add("new", sk.Mesh.sphere(2, 16), material="Cu", inside="pot", priority=2)
    again(scene, tmp_path / "more.json")
    assert (tmp_path / "more-parts" / "3-new.ply").exists()
    scene["pot"].mesh.vertices = 1.1 * scene["pot"].mesh.vertices
    again(scene, tmp_path / "moved.json", precision="double")  # floats count from another origin
    with pytest.raises(sk.OutputError, match="there is no folder .*missing; make it first"):
        scene.save(tmp_path / "missing" / "scene.json")
    with pytest.raises(sk.ArgumentError, match="written as .json"):
        scene.save(tmp_path / "scene.png")


def test_a_mesh_that_stays_as_wound_is_refused(view, tmp_path):
    """A file says it of all its meshes or of none."""
    box = sk.Mesh.cube(10)
    mesh = sk.Mesh(box.vertices, np.concatenate((box.faces[:1, ::-1], box.faces[1:])), as_wound=True)
    for text in ({}, {"Repair": "none"}):
        scene = sk.Scene(text)
        scene.view, scene.beam = view, sk.Beam.mono(60, 1000)
        scene.add("box", mesh, material=sk.Material.mu(1))
        if text:
            again(scene, tmp_path / "as.json")
        else:
            with pytest.raises(sk.SceneError, match='box: .* as_wound.* "Repair": "none"'):
                scene.save(tmp_path / "scene.json")
            assert not (tmp_path / "scene.json").exists()


def test_parts_are_removed(tmp_path):
    scene = described(tmp_path)
    nut, rod = scene["nut"], scene["rod"]
    scene.remove("rod")
    assert [part.label for part in scene.parts] == ["pot", "nut"] and nut.inside == "pot" and nut.label == "nut"
    with pytest.raises(sk.SceneError, match="the part was removed"):
        rod.label
    other = sk.Scene({**FILE, "Samples": [{**FILE["Samples"][0], "Path": str(tmp_path / "old" / "pot.ply")},
                                          {**FILE["Samples"][2], "Parent": "pot"}]})
    np.testing.assert_array_equal(scene.image(index=0), other.image(index=0))
    again(scene, tmp_path / "less.json")
    copied = pickle.loads(pickle.dumps(scene))
    np.testing.assert_array_equal(copied.image(index=0), other.image(index=0))
    scene.remove("pot")
    assert nut.inside is None and scene["nut"].label == "nut"
    scene.add("pot", sk.Mesh.cube(1), material="Fe")
    scene.remove("nut")
    assert [part.label for part in pickle.loads(pickle.dumps(scene))] == ["pot"]
    with pytest.raises(sk.SceneError, match="'rod', 'pot', 'nut' was removed"):
        scene.breathe(phase=0)


def test_a_removed_part_makes_another_scan(tmp_path):
    scene = described(tmp_path)
    scene.trajectory = sk.Scan(scene.view, 2)
    first = scene.scan(tmp_path / "a.mha")["hash"]
    scene.remove("nut")
    assert scene.scan(tmp_path / "b.mha")["hash"] != first


def test_parts_that_move_in_a_scan_are_not_removed(tmp_path):
    still = np.eye(4).T.ravel().tolist()
    samples = [FILE["Samples"][0], {**FILE["Samples"][1], "Poses": [still, still]}]
    del samples[1]["Transform"]
    scene = described(tmp_path, Samples=samples, Scan={"NumberOfProjections": 2, "FinalAngle": 90})
    with pytest.raises(sk.SceneError, match="found by their numbers"):
        scene.remove("pot")


def test_labels_are_named(scene):
    with pytest.raises(KeyError, match="there is no part 'bal'; did you mean 'ball'") as caught:
        scene["bal"]
    assert isinstance(caught.value, sk.SceneError) and isinstance(caught.value, sk.LabelError)
    with pytest.raises(sk.LabelError, match="there are 'block', 'ball'"):
        scene.lengths("nothing")
    with pytest.raises(sk.LabelError, match="the scene has no parts"):
        sk.Scene().remove("x")


def test_lengths_of_several_parts(scene):
    alone = {label: scene.lengths(label) for label in ("block", "ball")}
    for found in (scene.lengths(), scene.lengths(["block", "ball"])):
        assert list(found) == ["block", "ball"]
        assert all((found[label] == alone[label]).all() for label in alone)
    assert scene.lengths(["ball"], views=[scene.view] * 2)["ball"].shape == (2, *scene.view.shape)
    with pytest.raises(sk.ArgumentError, match="one label"):
        scene.lengths(["ball"], out=np.empty(scene.view.shape, np.float32))


def test_a_picture_and_a_page(command, scene, tmp_path):
    seen = scene.picture((64, 48), colours={"ball": (1, 0, 0, 1), "block": (0, 0, 0, 0)})
    assert seen.shape == (48, 64, 3) and seen.dtype == np.uint8
    redness = (seen - scene.picture((64, 48)).astype(float))[..., 0] - (seen - scene.picture((64, 48)).astype(float))[..., 1]
    assert redness.max() > 50
    assert (scene.picture((64, 48), direction=(0, -1, 0)) != scene.picture((64, 48), direction=(1, 0, 0))).any()
    assert (scene.picture((64, 48), image=scene.image()) != scene.picture((64, 48))).any()
    with pytest.raises(sk.ArgumentError, match="as the view has"):
        scene.picture(image=np.zeros((2, 2)))
    with pytest.raises(sk.ArgumentError, match="0 to 1"):
        scene.picture(colours={"ball": (255, 0, 0)})
    page = scene.show(height=300)
    page.save(tmp_path / "scene.html")
    assert "height: 300px" in page._repr_html_() and (tmp_path / "scene.html").stat().st_size == len(page.html.encode())


def test_dicom_reads_back(scene, tmp_path):
    pydicom = pytest.importorskip("pydicom")
    image = scene.image("attenuation")
    scene.save(tmp_path / "a.dcm", image, "attenuation")
    read = pydicom.dcmread(tmp_path / "a.dcm")
    values = read.pixel_array * float(read.RescaleSlope) + float(read.RescaleIntercept)
    # Half a step, and nine digits of slope and intercept.
    assert np.abs(values - image).max() <= 0.5 * float(read.RescaleSlope) + 1e-8 * np.abs(image).max()
    assert float(read.RescaleSlope) <= (image.max() - image.min()) / 65535 * (1 + 1e-7)
    assert read.PhotometricInterpretation == "MONOCHROME2" and read.Modality == "CR"
    view = scene.view
    assert float(read.DistanceSourceToDetector) == pytest.approx(np.linalg.norm(view.detector - view.source))
    assert [float(x) for x in read.PixelSpacing] == pytest.approx([np.linalg.norm(view.row_step), np.linalg.norm(view.column_step)])
    assert float(read.KVP) == pytest.approx(max(scene.beam.energies))
    scene.save(tmp_path / "b.dcm", image, "attenuation")
    assert (tmp_path / "a.dcm").read_bytes() == (tmp_path / "b.dcm").read_bytes()
    scene.save(tmp_path / "b.dcm", image[None], "attenuation")  # one channel
    assert (tmp_path / "a.dcm").read_bytes() == (tmp_path / "b.dcm").read_bytes()
    image[0, 0] = np.nan
    with pytest.raises(sk.Error, match="1 of .* pixels are not finite"):
        scene.save(tmp_path / "c.dcm", image, "attenuation")
    with pytest.raises(sk.Error, match="one channel"):
        scene.save(tmp_path / "c.dcm", np.zeros((2, 4, 4), np.float32), "attenuation")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.dcm", "b.dcm"]


@pytest.fixture
def breathing(tmp_path):
    """A thorax whose bile ducts fill with contrast medium from 1 s to 2 s."""
    path = sk.thorax(tmp_path / "thorax", 10000, simple=True)
    text = json.loads(open(path).read())
    next(sample for sample in text["Samples"] if sample["Label"] == "bile ducts")["Material"] = ["Mixture", ["H", 0.1, "O", 0.8, "I", 0.1]]
    next(sample for sample in text["Samples"] if sample["Label"] == "bile ducts")["Density"] = 1.4
    text.setdefault("Breathing", {})["Events"] = [{"Contrast": "bile ducts", "Share": [[1, 0], [2, 1]]}]
    open(path, "w").write(json.dumps(text))
    return sk.Scene(path, settings={"Detector.NumberOfPixels": [64, 64], "Tolerance": 0, "Source.Beam.mAs": 2})


@pytest.mark.parametrize("breath", [{"phase": 0}, {"time": 1.4}])
def test_matter_of_the_breath_is_saved(breathing, tmp_path, breath):
    """The lungs' mass stays, so that their density changes, and the bile ducts of the second case are filled in part."""
    rest = {row["label"]: row for row in breathing.parts()["parts"]}
    ratio = breathing.breathe(**breath)["lung_density_ratio"]
    assert abs(ratio - 1) > 0.02
    breathing.save(tmp_path / "posed.json")
    read = sk.Scene(tmp_path / "posed.json")
    # floats of vertices that moved, and the coefficients of a mixture whose fractions were rounded
    np.testing.assert_allclose(read.image(), breathing.image(), rtol=3e-5)
    found = [{row["label"]: row for row in scene.parts()["parts"]} for scene in (breathing, read)]
    for label in ("lung left", "lung right", "bile ducts"):
        for name in ("density_g_cm3", "mass_g"):
            assert found[1][label][name] == pytest.approx(found[0][label][name], rel=1e-6)
    lungs = ("lung left", "lung right")
    assert found[0]["lung left"]["density_g_cm3"] == pytest.approx(ratio * rest["lung left"]["density_g_cm3"], rel=1e-12)
    # vertices of floats; the bronchi in the lungs change their volumes, too
    assert sum(found[0][label]["mass_g"] for label in lungs) == pytest.approx(sum(rest[label]["mass_g"] for label in lungs), rel=1e-3)
    dose, again = ({part["label"]: part["dose_uGy"] for part in scene.dose(histories=20000)["parts"]} for scene in (breathing, read))
    assert dose["lung left"] == pytest.approx(again["lung left"], rel=1e-3)  # the same photons, but for those at rounded surfaces
    assert breathing["lung left"].density == pytest.approx(rest["lung left"]["density_g_cm3"])  # the part keeps its own material


def test_a_part_is_added_to_a_posed_scene(breathing):
    """The breath links the parts anew, from their positions at rest, and the image stays."""
    breathing.breathe(phase=0)
    before = breathing.image()
    breathing.add("lead", sk.Mesh.cube(1), material="Pb", pose=sk.translate(0, 700, 0))  # behind the detector
    np.testing.assert_array_equal(breathing.image(), before)
    breathing.breathe(phase=0)
    np.testing.assert_array_equal(breathing.image(), before)
