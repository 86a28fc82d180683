"""Scenes and their parts: reading, changing, failing, breathing."""
import base64
import json
import pathlib
import pickle
import re
import shutil
import warnings
import zlib

import numpy as np
import pytest

import skiagraph as sk

DICTIONARY = {
    "Source": {"Position": [0, -40, 0, "cm"], "Shape": "PointSource",
               "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
    "Detector": {"Position": [0, 10, 0, "cm"], "UpVector": [0, 0, -1], "NumberOfPixels": [32, 24],
                 "Size": [32, 24, "cm"]},
    "Samples": [{"Label": "skin", "Cube": [80, "mm"], "Material": ["mu", 0.2], "Type": "outer"},
                {"Label": "bone", "Path": "bone.ply", "Unit": "mm", "Material": "bone cortical icru44"}],
}


@pytest.fixture
def path(tmp_path):
    sk.Mesh.sphere(20, 32).save(tmp_path / "bone.ply")
    made = tmp_path / "scene.json"
    made.write_text(json.dumps(DICTIONARY))
    return made


def test_a_file_is_read(path):
    with sk.Scene(path) as scene:
        assert [part.label for part in scene] == ["skin", "bone"]
        assert len(scene) == 2 and "bone" in scene and "liver" not in scene
        assert scene["BONE"].inside == "skin" and scene["skin"].inside is None
        assert scene["bone"].density == pytest.approx(1.92, abs=0.01)  # the table's two decimals
        assert scene.view.source.tolist() == [0, -400, 0]
        assert scene.view.pixels == (32, 24) and scene.view.shape == (24, 32)
        assert scene.beam.energies.tolist() == [60]
        assert scene.image().shape == (24, 32)
    with pytest.raises(sk.ArgumentError, match="closed"):
        scene.image()


def test_settings_and_dictionaries(path):
    small = sk.Scene(path, settings={"Detector.NumberOfPixels": [8, 4]})
    assert small.image().shape == (4, 8)
    assert sk.Scene(path, settings=["Detector.NumberOfPixels=[4, 4]"]).image().shape == (4, 4)
    given = {**DICTIONARY, "Samples": DICTIONARY["Samples"][:1]}
    assert sk.Scene(given).image().shape == (24, 32)
    assert len(sk.Scene({"Samples": given["Samples"]})) == 1
    assert len(sk.Scene()) == 0


def test_files_that_others_wrote(path):
    text = json.loads(path.read_text())
    text["Samples"][0]["Flavour"] = "vanilla"
    with pytest.raises(sk.FormatError, match="Flavour"):
        sk.Scene(text)
    text["Samples"].pop()
    with pytest.warns(sk.SkiagraphWarning, match="Flavour"):
        assert sk.Scene(text, lenient=True).image().shape == (24, 32)
    del text["Samples"][0]["Flavour"], text["Source"]["Beam"], text["Samples"][0]["Material"]
    with pytest.raises(sk.Error):
        sk.Scene(text)
    with pytest.warns(sk.SkiagraphWarning):
        assert sk.Scene(text, lengths_only=True).lengths("skin").max() > 80


def test_failures_have_their_sentences(path, tmp_path):
    with pytest.raises(sk.FileError, match="nowhere.json"):
        sk.Scene(tmp_path / "nowhere.json")
    with pytest.raises(sk.FormatError, match="line 1"):
        (tmp_path / "bad.json").write_text("{;}")
        sk.Scene(tmp_path / "bad.json")
    with pytest.raises(sk.MaterialError, match="unobtainium"):
        sk.Material("unobtainium")
    with pytest.raises(sk.SceneError, match="liver"):
        sk.Scene(path)["liver"]
    with pytest.raises(sk.SceneError, match="assign a View"):
        sk.Scene().image()
    with pytest.raises(sk.ArgumentError, match="no JSON"):
        sk.Scene({"Samples": object()})
    with pytest.raises(sk.ArgumentError, match="scene is a int"):
        sk.Scene(3)
    with pytest.raises(sk.ArgumentError, match="label of a part is a int"):
        sk.Scene(path)[0]
    assert sk.FileError.status == -3 and sk.FileError.status_name == "SKG_ERR_FILE"
    assert issubclass(sk.FileError, sk.Error)


@pytest.mark.parametrize("call, words", [
    (lambda s: s.image(index=2 ** 65), "index is .*, 0 to 9223372036854775807"),
    (lambda s: s.add("more", sk.Mesh.cube(1), material="Al", priority=1.5), "priority is 1.5; give a whole number"),
    (lambda s: s.add("more", sk.Mesh.cube(1), material="Al", priority=2 ** 40), "priority is .* to 2147483647"),
    (lambda s: s.add_volume("more", np.zeros((2, 2, 2)), np.eye(4), priority=1.5), "priority is 1.5; give a whole number"),
    (lambda s: s.add_volume("more", np.zeros((2, 2, 2)), np.eye(4), classes=[5]), "give pairs of a value and a material"),
    (lambda s: s.add(5, sk.Mesh.cube(1), material="Al"), "label is 5; give a text"),
    (lambda s: s.dose("a"), "at has .*; give real numbers"),
    (lambda s: s.dose(histories=1.5), "histories is 1.5; give a whole number"),
    (lambda s: s.dose(seed="a"), "seed is 'a'; give a whole number"),
    (lambda s: s.scan(subframes=1.5), "subframes is 1.5; give a whole number"),
    (lambda s: s.images(views=5), "views is a int; give Views"),
    (lambda s: s.lengths(5), "label is a int"),
    (lambda s: s.picture(8), r"pixels is 8; give \(columns, rows\)"),
    (lambda s: s.gradient("a"), "weights has .*; give real numbers"),
    (lambda s: sk.Scan(s.view, 2.5), "projections is 2.5; give a whole number"),
    (lambda s: sk.Scan(s.view, 2, step="a"), "step has .*; give real numbers"),
    (lambda s: sk.Scan(s.view, 2)[0.5], "the number of a projection is 0.5"),
    (lambda s: sk.View(source=(0, 0, -9), detector=(0, 0, 9), column_step=(1, 0, 0), row_step=(0, 1, 0), pixels=8), "pixels is 8"),
])
def test_wrong_arguments_are_named(scene, call, words):
    """None is cut to a whole number, and none is an error of Python's own."""
    with pytest.raises(sk.ArgumentError, match=words):
        call(scene)


def test_a_view_that_is_too_large_is_refused_before_memory_is_taken(scene):
    scene.view.pixels = (10 ** 6, 10 ** 6)
    for call in (scene.image, lambda: scene.images(views=[scene.view]), lambda: scene.lengths("ball"), lambda: scene.noise(noise=True),
                 scene.scatter, lambda: scene.derivative({"source": (1, 0, 0)}), scene.parts, scene.dose):
        with pytest.raises(sk.SceneError, match="1 to 32768"):
            call()
    scene.view.pixels = (64, 48)
    with pytest.raises(sk.ArgumentError, match="does not fit into memory"):
        scene.picture((10 ** 6, 10 ** 6))


def test_no_device_is_a_sentence():
    with pytest.raises(sk.NoDeviceError):
        sk.Device("device=a-device-that-nobody-has")
    assert sk.Device("device=cpu threads=1").info["compute_units"] == 1


def test_poses(scene):
    part = scene["ball"]
    assert (part.pose == np.eye(4)).all()
    part.pose = sk.rotate("x", 30) @ sk.translate(1, 2, 3)
    np.testing.assert_array_equal(part.pose, sk.rotate("x", 30) @ sk.translate(1, 2, 3))
    with pytest.raises(ValueError):
        part.pose[0, 3] = 5  # a copy: an assignment would be lost
    with pytest.raises(sk.ArgumentError, match=r"pose has the shape \(3, 3\) and the type float64"):
        part.pose = np.eye(3)
    with pytest.raises(sk.ArgumentError, match="real numbers"):
        part.pose = np.full((4, 4), "x")
    with pytest.raises(sk.SceneError, match="singular"):
        part.pose = np.diag([0, 1, 1, 1.0])
    with pytest.raises(sk.ArgumentError, match=r"poses\['ball'\] has the shape \(2, 3\)"):
        scene.images(poses={"ball": np.zeros((2, 3))})


def test_matter(scene):
    part = scene["ball"]
    part.material = "water"
    assert part.material.name == "Water, Liquid"
    part.density = 2
    assert part.density == 2
    # mu is proportional to the density; 16 roundings
    assert part.material.attenuation(60) == pytest.approx(2 * sk.Material("water").attenuation(60), rel=16 * 2.2e-16)
    with pytest.raises(sk.ArgumentError, match="material is a int"):
        part.material = 3


def test_vertices_move(scene):
    before = scene.lengths("block", "surface")
    mesh = scene["block"].mesh
    assert mesh is scene["block"].mesh and mesh.version == 1
    mesh.vertices = mesh.vertices * (1, 1, 0.5)
    assert mesh.version == 2
    half = scene.lengths("block", "surface")
    assert half.max() == pytest.approx(before.max() / 2, rel=1e-2)  # the rays are not quite along z
    mesh.offsets[:] *= (1, 1, 2)
    mesh.moved()
    np.testing.assert_allclose(scene.lengths("block", "surface"), before, atol=3e-5 * 40)  # single precision
    with pytest.raises(sk.ArgumentError, match="the mesh has"):
        mesh.vertices = mesh.vertices[:-1]


def mirror_by_vertices(mesh):
    mesh.vertices = mesh.vertices * (-1, 1, 1)


def mirror_by_offsets(mesh):
    mesh.offsets[:, 0] *= -1  # about the origin of the offsets, which is that of the mesh here
    mesh.moved()


@pytest.mark.parametrize("mirror", [mirror_by_vertices, mirror_by_offsets])
def test_a_mirrored_mesh_stays_matter(view, tmp_path, mirror):
    """As with a pose that mirrors it, and twice as not at all. The wedge is no mirror image of itself."""
    scene = sk.Scene()
    scene.view, scene.beam = view, sk.Beam.mono(60, 1e6)
    scene.add("wedge", sk.Mesh.step_wedge(20, 20, 20, 4), material="water")
    first, mesh = scene.image(), scene["wedge"].mesh
    scene["wedge"].pose = np.diag([-1.0, 1, 1, 1])
    posed = scene.image()
    assert (posed != first).any()
    scene["wedge"].pose = np.eye(4)
    mass = scene.parts()["parts"][0]["mass_g"]
    mirror(mesh)
    np.testing.assert_allclose(scene.image(), posed, rtol=1e-6)  # the order of float sums is another
    assert scene.parts()["parts"][0]["mass_g"] == pytest.approx(mass, rel=1e-6) and mass > 0
    assert scene.dose(histories=2000)["parts"][0]["energy_keV"] > 0
    scene.save(tmp_path / "scene.json")
    for other in (sk.Scene(tmp_path / "scene.json"), pickle.loads(pickle.dumps(scene))):
        np.testing.assert_allclose(other.image(), posed, rtol=1e-6)
    mirror(mesh)
    np.testing.assert_array_equal(scene.image(), first)


def nested_boxes():
    """A box inside a box that should be its cavity, but faces outward."""
    box = sk.Mesh.cube(10)
    return sk.Mesh(np.concatenate((box.vertices, 0.5 * box.vertices)), np.concatenate((box.faces, box.faces + len(box.vertices))))


@pytest.mark.parametrize("repair", ["orientation", ["Exact", "Orientation"]])
@pytest.mark.parametrize("kind", ["mesh", "arrays", "path"])
def test_added_meshes_are_repaired_as_those_of_the_file(view, tmp_path, repair, kind):
    boxes = nested_boxes()
    boxes.save(tmp_path / "boxes.ply")
    given = {"mesh": boxes, "arrays": (boxes.vertices, boxes.faces), "path": tmp_path / "boxes.ply"}[kind]
    scene = sk.Scene({"Repair": repair})
    scene.view, scene.beam = view, sk.Beam.mono(60, 1000)
    scene.add("boxes", given, material=sk.Material.mu(1))
    assert scene["boxes"].mesh.nesting["inverted"] == 0 and boxes.nesting["inverted"] == 1
    middle = scene.lengths("boxes", precision="double")[24, 32]
    assert middle == pytest.approx(10 - 5, abs=1e-4)  # the ray is aslant by 1 mm in 1 m
    scene.save(tmp_path / "scene.json")
    assert (sk.Scene(tmp_path / "scene.json").image() == scene.image()).all()


def test_added_files_stay_as_wound(view, tmp_path):
    box = sk.Mesh.cube(10)
    (tmp_path / "box.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in box.vertices) + "".join(
        f"f {a} {b} {c}\n" for a, b, c in [box.faces[0][::-1] + 1, *(box.faces[1:] + 1)]))
    scene = sk.Scene({"Repair": "none"})
    scene.add("box", tmp_path / "box.obj", material=sk.Material.mu(1))
    assert scene["box"].mesh.health["turned"] == 0 and not scene["box"].mesh.health["closed"]


def test_a_plan_explains_itself(scene):
    report = scene.plan(noise=True)
    assert report["parts"] == 2 and report["precision"] == "single" and report["nodes"] == 1
    effects = {effect["name"]: effect for effect in report["effects"]}
    assert effects["quantum noise"]["on"] is True and effects["blur"]["on"] is False
    assert effects["blur"]["reason"] in str(report)
    assert "<table>" in report._repr_html_() and "quantum noise" in repr(report)
    assert dict(report)["energies"] == [(60, 1000)]
    assert 0 < report["precision_bound"] < 1e-3 and f"rounding at most {report['precision_bound']:.2g}" in str(report)
    assert report["channels"][0]["unit"] == "keV per pixel"


def test_a_cell_shows_the_picture_first_and_folds_a_long_table(scene):
    shown = scene._repr_html_()
    assert shown.startswith("<img") and "<td>ball</td>" in shown and "<details>" not in shown
    pixels = base64.b64decode(re.search('base64,([^"]*)"', shown).group(1))
    assert pixels.startswith(b"\x89PNG")
    body = pixels[pixels.index(b"IDAT") + 4:pixels.index(b"IEND") - 8]
    lines = np.frombuffer(zlib.decompress(body), np.uint8).reshape(420, 1 + 3 * 640)
    assert (lines[:, 0] == 0).all() and (lines[:, 1:].reshape(420, 640, 3) == scene.picture((640, 420))).all()
    for number in range(13 - len(scene)):
        scene.add(f"crumb {number}", sk.Mesh.cube(0.1), material="Water", pose=sk.translate(0, 0, 200 + number))
    seen, folded = scene._repr_html_().split("<details>")
    assert seen.count("<tr>") == 1 + 12 and folded.count("<tr>") == 1 + 1 and "<summary>1 more<" in folded
    bare = sk.Scene()
    assert bare._repr_html_().startswith("<p>") and "<table>" in bare._repr_html_()
    bare.close()
    assert "closed" in bare._repr_html_()


def test_overlaps_have_labels(scene):
    with pytest.warns(sk.SkiagraphWarning, match="other"):
        scene.add("other", sk.Mesh.cube(10), material="water", pose=sk.translate(20, 0, 0))
        report = scene.plan()
    assert {report["overlaps"][0]["part"], report["overlaps"][0]["other"]} == {"block", "other"}


def test_a_warning_names_the_worst_three_overlaps(scene):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        for i in range(3):
            scene.add(f"cube {i}", sk.Mesh.cube(10), material="water", pose=sk.translate(20, 0, i))
        scene.plan()
    said = str(found[-1].message)
    assert said.count("; then ") == 2 and ", up to " in said and " pairs of parts overlap" in said, said


def test_a_warning_about_a_file_of_one_line_names_the_column(tmp_path):
    path = tmp_path / "one.json"
    path.write_text('{"Source": {"Position": [0, -9, 0, "mm"], "Beam": {"kVp": 80}}, "Detector": {"Position": [0, 9, 0, "mm"], '
                    '"UpVector": [0, 0, 1], "NumberOfPixels": [2, 2], "Spacing": [1, 1, "mm"]}, "Foo": 1, "Samples": [{"Label": "a", "Cube": [2, "mm"], "Material": ["mu", 1]}]}')
    with pytest.warns(sk.SkiagraphWarning, match=r"Foo \(line 1, column 18[0-9]\): unknown key"):
        sk.Scene(path, lenient=True)


def test_of_many_overlaps_the_worst_are_printed(scene):
    with pytest.warns(sk.SkiagraphWarning):
        for n in range(5):
            scene.add(f"cube {n}", sk.Mesh.cube(10), material="water", pose=sk.translate(20, 0, n))
        report = scene.plan()
    lines = [line for line in str(report).splitlines() if " overlaps " in line or "leaves its parent" in line]
    assert len(report["overlaps"]) > 10 and len(lines) == 3
    assert f"and {len(report['overlaps']) - 3} more" in str(report)


def test_breath(tmp_path):
    with sk.Scene(sk.thorax(tmp_path, 10000), settings={"Detector.NumberOfPixels": [32, 32]}) as scene:
        rest = scene["liver"].mesh.vertices
        state = scene.breathe(phase=0)
        assert state["amplitude"] == 1 and np.isnan(state["time_s"])
        inhaled, image = scene["liver"].mesh.vertices, scene.image()
        assert (inhaled - rest)[:, 2].mean() < -3  # it descends by some mm
        scene.breathe(time=1)
        scene.breathe(phase=0)
        assert (scene["liver"].mesh.vertices == inhaled).all() and (scene.image() == image).all()
        still = {"skin": np.eye(4)[None].repeat(2, 0)}
        assert (scene.images(poses=still) == image).all()  # frames of a batch breathe too
        with pytest.raises(sk.ArgumentError, match="phase is 'a'; give a number"):
            scene.breathe(phase="a")
    with pytest.raises(sk.ArgumentError, match="one of them"):
        sk.Scene().breathe()


def test_costs_are_the_commands(path):
    if not shutil.which("skiagraph"):
        pytest.skip("the command skiagraph is not on the path")
    scene = sk.Scene(path, settings={"Detector.NumberOfPixels": [16, 16]})
    cost = scene.cost(quick=True)
    assert {"points", "advice"} <= cost.keys() and cost["sensitivity"] is None
    found = scene.cost(quick=True, within=1, sensitivity=True)["sensitivity"]["parts"]
    assert sorted(part["part"] for part in found) == sorted(part.label for part in scene)
    assert found[0]["largest"] > found[-1]["largest"] >= 0  # the skin's sides are beside the image
    scene["bone"].material = "water"
    with pytest.raises(sk.SceneError, match="was changed"):
        scene.cost()


def test_the_declarations_are_the_librarys():
    """Every function of the list is in the library that was loaded, and every struct has the size that it expects."""
    from skiagraph._library import ffi, lib

    names = [name for name in dir(lib) if name.startswith("skg_")]
    assert len(names) > 150 and all(getattr(lib, name) for name in names)
    view = ffi.new("skg_view *")
    lib.skg_view_init_sized(view, ffi.sizeof("skg_view"))
    assert view.size == ffi.sizeof("skg_view")


def test_a_scene_without_organs_does_not_breathe(scene):
    with pytest.raises(sk.BreathingError):
        scene.breathe(phase=0)


def test_a_warning_is_said_once(scene):
    import warnings

    scene["ball"].pose = sk.translate(200, 0, 0)
    with pytest.warns(sk.SkiagraphWarning, match="ball leaves block") as caught:
        scene.image()
    assert pathlib.Path(caught[0].filename).name == "test_scene.py"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene.image(supersampling=2)  # another plan of the same scene


def test_warnings_of_a_failure_are_not_the_next_scenes():
    import warnings

    def cylinder(**scan):
        scene = sk.Scene()
        scene.add("big", sk.Mesh.cylinder(35, 60, 24), material=sk.Material.mu(0.2))
        scene.beam = sk.Beam.mono(60, 1000)
        scene.view = sk.View(source=(0, -400, 0), detector=(0, 200, 0), column_step=(2, 0, 0), row_step=(0, 0, -2), pixels=(64, 48))
        scene.trajectory = sk.Scan(scene.view, 12, **scan)
        return scene

    with pytest.warns(sk.SkiagraphWarning, match="nothing falls on the detector"), pytest.raises(sk.SceneError, match="lies on the detector"):
        cylinder(detector_fixed=True).scan()  # from beside the detector, then from its plane
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cylinder().image()
        with pytest.raises(sk.SceneError, match="lies on the detector"):  # the error, not the warning before it
            cylinder(detector_fixed=True).scan()
        cylinder().image()


def test_removed_meshes_are_let_go():
    import gc
    import weakref
    scene = sk.Scene()
    fixed = scene.add("fixed", sk.Mesh.cube(20), material="Al").mesh
    gone = []
    for _ in range(5):
        gone.append(weakref.ref(scene.add("guest", sk.Mesh.sphere(10, 16), material="Al").mesh))
        scene.remove("guest")
    gc.collect()
    assert [mesh() for mesh in gone] == [None] * 5
    assert scene["fixed"].mesh is fixed
