"""Tubes made in Python are those of a scene file; noisy frames count on."""
import pickle

import numpy as np
import pytest

import skiagraph as sk

TUBE = {"kVp": 80, "Filter": [["Al", 3, "mm"]], "mAs": 5e-4}


def described(distance, spacing, **more):
    """A cube of water, halfway between a source and a detector of this distance (mm) and pixel (mm)."""
    return {"Source": {"Position": [0, -distance / 2, 0, "mm"], "Shape": "PointSource", "Beam": TUBE},
            "Detector": {"Position": [0, distance / 2, 0, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [40, 32],
                         "Spacing": [spacing, spacing, "mm"]},
            "Samples": [{"Label": "block", "Cube": [20, "mm"], "Material": "H2O"}], **more}


def made(scene):
    """An equal scene, without a file but for its view."""
    own = sk.Scene()
    own.add("block", sk.Mesh.cube(20), material="H2O")
    own.view = scene.view
    own.beam = sk.Beam.tube(TUBE["kVp"], {"Al": 3}, mas=TUBE["mAs"])
    return own


@pytest.mark.parametrize("mas", [0, -1, float("nan")])
def test_a_load_of_nothing_is_refused(mas):
    with pytest.raises(sk.ArgumentError, match="above 0 mA s"):
        sk.Beam.tube(80, mas=mas)


@pytest.mark.parametrize("distance, spacing", [(1000, 1), (500, 0.5), (2000, 0.2), (300, 3)])
def test_a_tube_is_that_of_the_file(distance, spacing):
    scene = sk.Scene(described(distance, spacing))
    own = made(scene)
    assert own.beam.absolute and scene.beam.absolute
    for options in ({}, {"quantity": "photons"}, {"quantity": "photons", "noise": True}, {"noise": True, "precision": "double"}):
        assert (own.image(**options) == scene.image(**options)).all(), options
    # the closed form; roundings of a hundred sums
    expected = own.beam.photons.sum() * spacing**2 * (1000 / distance) ** 2
    assert own.beam.resolved(own.view).photons.sum() == pytest.approx(expected, rel=1e-12)
    assert own.plan(quantity="photons")["channels"][0]["flat_field"] == pytest.approx(expected, rel=1e-12)


def test_the_view_rescales():
    scene = made(sk.Scene(described(1000, 1)))
    before = scene.image("photons")
    near = sk.Scene(described(500, 1))
    scene.view = near.view
    assert scene.plan(quantity="photons")["channels"][0]["flat_field"] == pytest.approx(
        4 * scene.beam.resolved(sk.Scene(described(1000, 1)).view).photons.sum(), rel=1e-12)  # roundings
    after = scene.image("photons")
    assert after[0, 0] > 3.5 * before[0, 0]  # a corner: less than 4 by its obliquity
    np.testing.assert_allclose(after, near.image("photons"), rtol=1e-6)  # the factor is rounded to float
    batch = scene.images("photons", views=[near.view, sk.Scene(described(1000, 1)).view])
    np.testing.assert_allclose(batch[1], before, rtol=1e-6)  # likewise


def test_a_scan_has_the_photons_of_each_projection():
    scene = made(sk.Scene(described(1000, 1)))
    views = [sk.Scene(described(distance, 1)).view for distance in (1000, 700, 1400)]
    rows = [np.concatenate((v.source, v.detector, v.column_step, v.row_step)) for v in views]
    scene.trajectory = sk.Scan.table(scene.view, rows)
    for found, view in zip(scene.scan(quantity="photons"), views):
        scene.view = view
        np.testing.assert_allclose(found, made(scene).image("photons"), rtol=1e-6)  # the factor is rounded to float


def test_variance_is_that_of_the_photons():
    scene = made(sk.Scene(described(1000, 1)))
    mean, noisy = scene.image("photons"), scene.images("photons", poses={"block": np.stack([np.eye(4)] * 50)}, noise=True)
    share = ((noisy - mean) ** 2 / mean).mean()
    assert share == pytest.approx(1, abs=5 * np.sqrt(2.1 / noisy.size))  # five standard errors


def test_pickled_beams_stay_absolute():
    beam = sk.Beam.tube(80, {"Al": 3}, mas=2)
    again = pickle.loads(pickle.dumps(beam))
    assert again.absolute and (again.photons == beam.photons).all()
    assert "per mm2 at 1 m" in repr(again)
    for same in (beam.filtered({"Cu": 0.1}), beam.scaled(2), sk.Beam([60], [3], absolute=True)):
        assert same.absolute
    for other in (sk.Beam.tube(80, {"Al": 3}), sk.Beam.mono(60, 3), sk.Beam([60], [3])):
        assert not other.absolute and "1 m" not in repr(other)
    assert not sk.Beam.tube(80, {"Al": 3}, mas=2, distance_mm=500, pixel_mm2=2).absolute
    with pytest.raises(sk.BeamError, match="a pixel of 0 mm2"):
        sk.Beam.tube(80, {"Al": 3}, mas=2, distance_mm=500)
    with pytest.raises(sk.BeamError, match="without a tube load"):
        sk.Beam.tube(80, {"Al": 3}, distance_mm=500, pixel_mm2=2)


def test_parallel_beams_say_so():
    scene = made(sk.Scene(described(1000, 1)))
    scene.view.projection = "parallel"
    with pytest.warns(sk.SkiagraphWarning, match="mAs does not say how many photons arrive"):
        assert scene.image("photons")[0, 0] == pytest.approx(scene.beam.photons.sum(), rel=1e-6)  # a float


def test_noise_counts_on(scene, view, poses):
    first, second = scene.image(noise=True), scene.image(noise=True)
    assert (first != second).any()
    batch = scene.images(poses={"ball": np.stack([scene["ball"].pose] * 2)}, noise=True)
    assert all((one != other).any() for one, other in ((batch[0], first), (batch[0], second), (batch[0], batch[1])))
    fresh = pickle.loads(pickle.dumps(scene))
    assert (fresh.image(noise=True) == scene.image(noise=True)).all()  # the fifth of both
    assert (scene.image(noise=True, index=0) == first).all() and (scene.image(noise=True, index=1) == second).all()
    scene.image(), scene.lengths("ball")
    assert (scene.image(noise=True) == scene.image(noise=True, index=5)).all()  # without noise nothing is counted


def test_a_seed_repeats(scene, poses):
    one, again = scene.image(noise=True, noise_seed=7), scene.image(noise=True, noise_seed=7)
    assert (one == again).all() and (one != scene.image(noise=True, noise_seed=8)).any()
    first, second = (scene.images(poses={"ball": poses}, noise=True, noise_seed=7) for _ in range(2))
    assert (first == second).all()
    electronic = [scene.image(electronic_kev=20.0) for _ in range(2)]
    assert (electronic[0] != electronic[1]).any()


def test_noise_of_a_file_counts_on():
    scene, other = (sk.Scene(described(1000, 1, Noise=True)) for _ in range(2))
    first = scene.image()
    assert (first != scene.image()).any() and (first == other.image()).all()
    assert (other.image(noise=False) == scene.image(noise=False)).all()


def test_responses_by_a_table(scene):
    recorded = sk.Response([10, 100], [5, 50])
    assert recorded.at(40) == (20, 1)
    assert sk.Response([10, 100], [5, 50], meaning="absorbed").at(40) == (20, 0.5)
    assert sk.Response([10, 100], [5, 50], efficiency=[0.5, 1]).at(100) == (50, 1)
    np.testing.assert_allclose(scene.image(response=recorded), scene.image() / 2, rtol=1e-6)  # single precision
    with pytest.raises(sk.ArgumentError, match="lists alike"):
        sk.Response([10, 100], [5])


def test_filters_are_named():
    with pytest.raises(sk.ArgumentError, match="give the mm of each material"):
        sk.Beam.tube(100, [("Al", 2.5)])
