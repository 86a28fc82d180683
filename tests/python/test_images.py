"""Images, batches and path lengths, against closed forms and against each other."""
import json

import numpy as np
import pytest

import skiagraph as sk
from conftest import MU, SIDE


def test_cube_in_a_parallel_beam_has_its_edge_as_length(scene, view):
    view.projection = "parallel"
    lengths = scene.lengths("block", "surface")
    inside = lengths > 1
    assert lengths.shape == (SIDE, SIDE + 16)
    # single precision: within 3e-5 of the longest path
    np.testing.assert_allclose(lengths[inside], 40, atol=3e-5 * 40)
    assert inside.sum() == 20 * 20  # pixels of 2 mm


def test_transmission_follows_beer_and_lambert(scene):
    net, ball = scene.lengths("block"), scene.lengths("ball")
    image = scene.image("transmission")
    # exponent to 3e-5 of 40 mm at 0.5/cm
    np.testing.assert_allclose(image, np.exp(-(MU * net + 0.5 * ball) / 10), atol=1e-4)
    assert net.max() < 42 and 19 < ball.max() <= 20
    np.testing.assert_allclose(net + ball, scene.lengths("block", "surface"), atol=3e-5 * 40)


def test_energy_in_other_units(scene):
    kev = scene.image()
    assert kev.dtype == np.float32 and kev.max() == 60000
    assert scene.image(unit="MeV").max() == np.float32(60)
    assert scene.image(unit="eV", precision="double").dtype == np.float64
    with pytest.raises(sk.ArgumentError, match="'J'"):
        scene.image(unit="J")
    with pytest.raises(sk.ArgumentError, match="energy alone"):
        scene.image("photons", unit="MeV")


def test_bands_are_a_leading_axis(scene, poses):
    scene.beam = sk.Beam([30, 50, 80], [100, 200, 300])
    bands = scene.image("photons", bands=[20, 40, 100])
    assert bands.shape == (2, SIDE, SIDE + 16)
    assert bands[:, 0, 0].tolist() == [100, 500]
    assert scene.image("photons", bands=[20, 100]).shape == (1, SIDE, SIDE + 16)
    many = scene.images("photons", bands=[20, 40, 100], poses={"ball": poses})
    assert many.shape == (7, 2, SIDE, SIDE + 16)
    out = np.empty_like(many)
    assert scene.images("photons", bands=[20, 40, 100], poses={"ball": poses}, out=out) is out
    assert (out == many).all()


@pytest.mark.parametrize("bands, words", [([100], "one edge makes no band"), ([], "there is no band"), (100, "one edge"),
                                          ([[20, 40]], "a list of edges"), ("20,40", "real numbers")])
def test_bands_without_a_band_are_refused(scene, bands, words):
    weights = np.ones((SIDE, SIDE + 16))
    for call in (scene.image, scene.scatter, scene.plan, scene.noise, scene.scan, scene.parts, scene.dose,
                 lambda **options: scene.images(views=[scene.view], **options), lambda **options: scene.gradient(weights, **options),
                 lambda **options: scene.derivative({"source": (1, 0, 0)}, **options)):
        scene.trajectory = sk.Scan(scene.view, 2)
        with pytest.raises(sk.ArgumentError, match=f"bands .*{words}"):
            call(bands=bands)


def test_a_batch_is_its_images(scene, poses):
    batch = scene.images(poses={"ball": poses})
    for pose, image in zip(poses, batch):
        scene["ball"].pose = pose
        assert (scene.image() == image).all()
    assert not (batch[0] == batch[-1]).all()


def test_a_circular_scan_by_views(scene, view):
    views = [sk.rotate("y", angle) @ view for angle in range(0, 360, 90)]
    scan = scene.images("attenuation", views=views)
    # a cube looks the same from its four sides
    np.testing.assert_allclose(scan[0], scan[2], atol=1e-4)  # rounding of the moved view
    scene.view = views[1]
    assert (scene.image("attenuation") == scan[1]).all()
    tolerant = scene.images("attenuation", views=views, tolerance=1e-4)
    np.testing.assert_allclose(tolerant, scan, atol=1e-4)  # the tolerance


def test_poses_and_views_together(scene, view, poses):
    views = [view] * 7
    assert (scene.images(poses={"ball": poses}, views=views) == scene.images(poses={"ball": poses})).all()
    turned = scene.images(poses={"ball": np.eye(4)}, views=views)
    assert (turned[0] == turned[6]).all()
    with pytest.raises(sk.ArgumentError, match=r"views has 2 frames and poses\['ball'\] 7"):
        scene.images(poses={"ball": poses}, views=views[:2])
    with pytest.raises(sk.ArgumentError, match="nothing to compute"):
        scene.images()


def test_lengths_of_many_frames(scene, poses):
    lengths = scene.lengths("ball", poses={"ball": poses})
    assert lengths.shape == (7, SIDE, SIDE + 16)
    assert (lengths[3] == scene.lengths("ball")).all()
    for precision in ("single", "double"):  # a part has the same bits alone and among others
        options = {"poses": {"ball": poses}, "precision": precision}
        together = scene.lengths(["ball", "block"], **options)
        assert list(together) == ["ball", "block"]
        for label, found in together.items():
            assert (found == scene.lengths(label, **options)).all()
    assert scene.lengths([]) == {}


def test_out_is_written_in_place(scene):
    plain = scene.image()
    wide = np.zeros((SIDE, 100), np.float32)
    part = wide[:, 10:10 + SIDE + 16]
    assert scene.image(out=part) is part
    assert (part == plain).all() and (wide[:, :10] == 0).all() and (wide[:, 10 + SIDE + 16:] == 0).all()
    double = np.empty(plain.shape)
    scene.image(out=double)
    assert (double == plain).all()


def test_out_by_the_buffer_protocol(scene):
    memory = bytearray(4 * SIDE * (SIDE + 16))
    scene.image(out=memoryview(memory).cast("f", (SIDE, SIDE + 16)))
    assert (np.frombuffer(memory, np.float32).reshape(SIDE, -1) == scene.image()).all()


class OnlyDlpack:
    """An array of another library, as far as NumPy can see."""

    def __init__(self, array):
        self._array = array

    def __dlpack__(self, **keys):
        return self._array.__dlpack__()

    def __dlpack_device__(self):
        return self._array.__dlpack_device__()


def test_images_leave_by_dlpack(scene):
    image = scene.image()
    other = np.from_dlpack(OnlyDlpack(image))
    assert np.shares_memory(other, image)


def test_an_output_by_dlpack(scene):
    wide = np.zeros((SIDE, 100), np.float32)
    scene.image(out=OnlyDlpack(wide[:, :SIDE + 16]))
    assert (wide[:, :SIDE + 16] == scene.image()).all() and (wide[:, SIDE + 16:] == 0).all()


@pytest.mark.parametrize("out, words", [
    (np.empty((3, 4), np.float32), "out has the shape (3, 4) and the type float32"),
    (np.empty((SIDE, SIDE + 16), np.int32), "the type int32"),
    (np.empty((SIDE + 16, SIDE), np.float32).T, "dense rows"),
    ([[1.0]], "shares no memory"),
])
def test_an_out_that_does_not_fit_is_named(scene, out, words):
    with pytest.raises(sk.ArgumentError) as caught:
        scene.image(out=out)
    assert words in str(caught.value)


def test_a_read_only_out_is_refused(scene):
    out = np.empty((SIDE, SIDE + 16), np.float32)
    out.flags.writeable = False
    with pytest.raises(sk.ArgumentError, match="read-only"):
        scene.image(out=out)


def test_progress_counts_to_the_end(scene, poses, capsys):
    seen = []
    scene.images(poses={"ball": poses}, progress=lambda done, of: seen.append((done, of)))
    assert seen[-1] == (7, 7) and seen == sorted(seen)
    scene.images(poses={"ball": poses}, progress=True)
    assert "7/7" in capsys.readouterr().err


def test_progress_that_returns_false_cancels(scene, poses):
    expected = scene.image()
    for at in (1, 3):
        seen = []
        with pytest.raises(sk.CancelledError, match="of 7 images"):
            scene.images(poses={"ball": poses}, progress=lambda done, of: seen.append(done) or done < at)
        assert seen[-1] >= at
        assert (scene.image() == expected).all()
    assert len(scene.images(poses={"ball": poses}, progress=lambda done, of: done < 7)) == 7  # too late


def test_mean_and_variance_of_noise(scene, poses):
    scene.beam = sk.Beam([40], [1000])
    found = scene.noise(noise=True)
    # single precision: the same sums with weights that are multiplied in another order
    np.testing.assert_allclose(found["mean"], scene.image(), rtol=16 * np.finfo(np.float32).eps)
    # photons of 40 keV: each adds 40 keV to the mean and their square to the variance
    np.testing.assert_allclose(found["variance"], 40 * found["mean"], rtol=16 * np.finfo(np.float32).eps)
    counted = scene.noise("photons", bands=[20, 100], precision="double", noise=True)
    assert counted["mean"].shape == (1, SIDE, SIDE + 16) and counted["mean"].dtype == np.float64
    np.testing.assert_allclose(counted["variance"], counted["mean"], rtol=1e-6)  # weights in single precision
    batch = scene.noise("attenuation", poses={"ball": poses}, noise=True)
    assert batch["variance"].shape == batch["mean"].shape == (7, SIDE, SIDE + 16)
    scene["ball"].pose = poses[3]
    np.testing.assert_array_equal(scene.noise("attenuation", noise=True)["variance"], batch["variance"][3])
    with pytest.raises(sk.ArgumentError, match="the variance of the noise is asked for, but the plan has none"):
        scene.noise()


def test_noise_belongs_to_frames(scene, poses):
    still = {"ball": np.eye(4)[None].repeat(3, 0)}
    noisy = scene.images(poses=still, noise=True, noise_seed=5)
    assert not (noisy[0] == noisy[1]).all()
    assert (scene.image(noise=True, noise_seed=5, index=2) == noisy[2]).all()
    assert (scene.images(poses=still, noise=True, noise_seed=5, index=1)[0] == noisy[1]).all()


def test_options_of_the_plan(scene):
    plain = scene.image("transmission")
    blurred = scene.image("transmission", blur={"along_row": [0.25, 0.5, 0.25], "along_column": [1]})
    expected = np.pad(plain, ((0, 0), (1, 1)), "edge")
    expected = (expected[:, :-2] + 2 * expected[:, 1:-1] + expected[:, 2:]) / 4
    np.testing.assert_allclose(blurred, expected, atol=1e-6)  # a few roundings of float
    spot = scene.image(spot={"shape": "disc", "extent": 4, "samples": 16})
    assert not (spot == scene.image()).all()
    csi = scene.image(response=sk.Response.scintillator("CsI", 0.1))
    assert csi.max() < 60000
    assert scene.image(world=sk.Material("air")).max() < 60000
    assert scene.image(strategy="tiles", tile=16).shape == (SIDE, SIDE + 16)


@pytest.mark.parametrize("options, words", [
    ({"supersampeling": 2}, "option 'supersampeling' is unknown; did you mean 'supersampling'?"),
    ({"quantity": "energie"}, "quantity is 'energie'; give one of 'energy'"),
    ({"noise": "yes"}, "noise is 'yes'; give a number"),
    ({"response": 3}, "response is a int; give a skg_response"),
    ({"spot": {"shape": "dice"}}, "shape is 'dice'"),
    ({"spot": {"form": "disc"}}, "spot: the field 'form' is unknown"),
    ({"supersampling": 99}, "99 rays a side"),
])
def test_options_that_are_wrong_are_named(scene, options, words):
    with pytest.raises(sk.ArgumentError) as caught:
        scene.image(**options)
    assert words in str(caught.value)


def test_double_precision(scene):
    image = scene.image("transmission", precision="double")
    assert image.dtype == np.float64
    np.testing.assert_allclose(image, scene.image("transmission"), atol=1e-4)  # single against double


def test_a_scene_that_changes_needs_no_care(scene, view):
    first = scene.image()
    scene.add("plate", sk.Mesh.cuboid(300, 300, 1), material="Al", pose=sk.translate(0, 0, 50))
    assert scene.image().max() < first.max()
    scene["plate"].material = sk.Material.mu(0)
    np.testing.assert_allclose(scene.image(), first, rtol=1e-6)  # a few roundings of float
    scene.view = sk.View(source=(0, 0, -1000), detector=(0, 0, 200), column_step=(2, 0, 0), row_step=(0, 2, 0),
                         pixels=(8, 4))
    assert scene.image().shape == (4, 8)


def test_another_beam_and_other_matter_need_no_care(scene):
    first = scene.image("transmission", tolerance=1e-3)
    scene.beam = sk.Beam.tube(80, {"Al": 2.5})
    scene["ball"].material = "water"
    second = scene.image("transmission", tolerance=1e-3)
    assert not (second == first).all()
    scene["ball"].material = "bone cortical icru44"  # the plan is stale
    third = scene.image("transmission", tolerance=1e-3)
    assert third.min() < second.min()
    scene.beam = sk.Beam.tube(40, {"Al": 2.5})
    assert scene.image("transmission", tolerance=1e-3).min() < third.min()


def test_a_range_that_is_left_warns(scene):
    scene.beam = sk.Beam.tube(80, {"Al": 2.5})
    scene["block"].material = "water"
    scene["ball"].material = "bone cortical icru44"
    scene.image(tolerance=1e-3)
    scene["ball"].pose = np.diag([3, 3, 3, 1.0])
    with pytest.warns(sk.RangeWarning):
        scene.image(tolerance=1e-3)


def test_pictures_are_written(scene, tmp_path):
    scene.save(tmp_path / "ball.png", scene.image())
    assert (tmp_path / "ball.png").read_bytes()[1:4] == b"PNG"
    scene.save(tmp_path / "ball.mha", scene.image("attenuation"), "attenuation")
    header = (tmp_path / "ball.mha").read_bytes()[:1000]
    assert b"DimSize = 64 48" in header and b"attenuation" in header
    scene.save(tmp_path / "lengths.tif", scene.lengths("ball"), "lengths")
    assert b"path length" in (tmp_path / "lengths.tif").read_bytes()
    scene.beam = sk.Beam([30, 60], [1, 1])
    scene.save(tmp_path / "bands.mha", scene.image("photons", bands=[20, 40, 80]), "photons", bands=[20, 40, 80])
    assert b"from 20 to 40 keV" in (tmp_path / "bands.mha").read_bytes()[:1000]
    with pytest.raises(sk.ArgumentError, match="row, column"):
        scene.save(tmp_path / "line.png", np.zeros(3))
    with pytest.raises(sk.OutputError):
        scene.save(tmp_path / "nowhere" / "ball.png", scene.image())


def test_save_remembers_what_an_image_holds(scene, tmp_path):
    """Without a quantity, -ln was once taken of an attenuation: the picture was inverted."""
    batch = scene.images("attenuation", views=[scene.view] * 2)
    for name, image, quantity in (("a", scene.image("attenuation"), "attenuation"), ("b", batch[1], "attenuation"),
                                  ("l", scene.lengths("ball"), "lengths"), ("e", scene.image(), "energy")):
        scene.save(tmp_path / f"{name}.png", image)
        scene.save(tmp_path / f"{name}-said.png", image, quantity)
        assert (tmp_path / f"{name}.png").read_bytes() == (tmp_path / f"{name}-said.png").read_bytes(), name
    scene.save(tmp_path / "other.png", scene.image() * 1)  # an array of the caller's: energies
    assert (tmp_path / "other.png").read_bytes() == (tmp_path / "e.png").read_bytes()


def test_jaws_limit_the_beam(scene):
    jaws = {"kind": "rectangle", "distance_mm": 400, "low": [-10.1, -4.1], "high": [7.3, 9.2]}
    image, limited = scene.image(), scene.image(collimation=jaws)
    x = 2 * (np.arange(SIDE + 16) - (SIDE + 15) / 2) / 3  # in the plane of the jaws, at a third of the distance
    y = 2 * (np.arange(SIDE) - (SIDE - 1) / 2) / 3
    field = ((y > -4.1) & (y < 9.2))[:, None] & ((x > -10.1) & (x < 7.3))
    assert 0 < field.sum() < field.size
    np.testing.assert_array_equal(limited, np.where(field, image, 0))
    with pytest.raises(sk.SceneError, match="behind the detector at 1200 mm"):
        scene.image(collimation={**jaws, "distance_mm": 1300})
    with pytest.raises(sk.ArgumentError, match="'rectangle'"):
        scene.image(collimation={"kind": "circle"})


def test_a_saved_scene_keeps_its_collimation(scene, tmp_path):
    scene.save(tmp_path / "open.json")
    text = json.loads((tmp_path / "open.json").read_text())
    text["Collimation"] = {"Rectangle": [[-10.1, 7.3], [-9.2, 4.1], "mm"], "Distance": [400, "mm"]}
    (tmp_path / "limited.json").write_text(json.dumps(text))
    limited = sk.Scene(tmp_path / "limited.json")
    limited.save(tmp_path / "again.json")
    jaws = {"kind": "rectangle", "distance_mm": 400, "low": [-10.1, -4.1], "high": [7.3, 9.2]}
    np.testing.assert_array_equal(limited.image(), scene.image(collimation=jaws))
    np.testing.assert_array_equal(sk.Scene(tmp_path / "again.json").image(), limited.image())
