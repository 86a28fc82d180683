"""Detector.Binning against the sums of the sensor's pixels, which need no other truth."""
import json

import numpy as np
import pytest

import skiagraph as sk

LSF = [0.05, 0.15, 0.6, 0.15, 0.05]
AWAY = [{"Label": "ball", "Sphere": [24, 9, "mm"], "Material": "Al", "Transform": [["Translation", 0, 0, 900, "mm"]]}]


def scene_of(tmp_path, detector=None, **keys):
    text = {
        "Source": {"Position": [0, -500, 0, "mm"], "Shape": "PointSource",
                   "Beam": [{"Energy": 40, "Unit": "keV", "PhotonCount": 500}, {"Energy": 70, "Unit": "keV", "PhotonCount": 300}]},
        "Detector": {"Position": [0, 250, 0, "mm"], "UpVector": [0, 0, 1], "NumberOfPixels": [96, 72], "Spacing": [0.5, 0.5, "mm"],
                     **(detector or {})},
        "Samples": [{"Label": "ball", "Sphere": [24, 9, "mm"], "Material": "Al"}], **keys}
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(text))
    return sk.Scene(path)


def bins(image, columns, rows):
    r, c = image.shape
    return image.reshape(r // rows, rows, c // columns, columns).sum(axis=(1, 3))


@pytest.mark.parametrize("columns, rows", [(2, 2), (3, 3)])
@pytest.mark.parametrize("blur", [{}, {"LSF": LSF}])
def test_a_bin_is_the_sum_of_its_pixels(tmp_path, columns, rows, blur):
    sensor = scene_of(tmp_path, blur)
    scene = scene_of(tmp_path, {"Binning": [columns, rows], **blur})
    assert scene.view.pixels == (96 // columns, 72 // rows)
    np.testing.assert_allclose(scene.view.column_step, columns * sensor.view.column_step, rtol=1e-15)
    for quantity, factor in (("energy", 1), ("photons", 1), ("fluence", 1 / (columns * rows)), ("transmission", 1 / (columns * rows))):
        right = factor * bins(sensor.image(quantity, precision="double"), columns, rows)
        # Without blur the rays are the same, and only sums are rounded; with it, what changes within a bin is spread evenly over it.
        bar = 0.02 if blur else 1e-9
        np.testing.assert_allclose(scene.image(quantity, precision="double"), right, rtol=0, atol=bar * right.max())


def test_oblong_bins_have_rays_for_every_pixel(tmp_path):
    """Twice as many rays along the columns as there are sensor pixels: the sums of a sensor that is finer there."""
    fine = scene_of(tmp_path, {"NumberOfPixels": [96, 144], "Spacing": [0.5, 0.25, "mm"]}).image("transmission", precision="double")
    binned = scene_of(tmp_path, {"Binning": [2, 1]}).image("transmission", precision="double")
    np.testing.assert_allclose(binned, bins(fine, 2, 2) / 4, rtol=0, atol=1e-9)


@pytest.mark.parametrize("once", [False, True])
def test_noise_is_that_of_sums(tmp_path, once):
    noise = {"Quantum": True, "Electronic": [300, "keV"], "Step": [400, "keV"], "Seed": 3}
    detector = {"Binning": [2, 2], "BinningNoise": "once"} if once else {"Binning": [2, 2]}
    scene = scene_of(tmp_path, {**detector, "NumberOfPixels": [512, 512], "Spacing": [0.02, 0.02, "mm"]}, Noise=noise, Samples=AWAY)
    image = scene.image("energy", precision="double")
    quantum = 4 * (500 * 40**2 + 300 * 70**2)
    right = quantum + (300**2 + 400**2 / 12) * (1 if once else 4)
    assert image.mean() == pytest.approx(4 * (500 * 40 + 300 * 70), rel=1e-3)
    # The standard error of a variance of n values is sqrt(2 / n) of it; four of them.
    assert image.var() == pytest.approx(right, rel=4 * np.sqrt(2 / image.size))


@pytest.mark.parametrize("blur, said", [({"LSF": LSF}, 0.9615), ({"PSF": [[0, 1, 0], [1, 4, 1], [0, 1, 0]]}, None)])
def test_noise_behind_a_blur(tmp_path, blur, said, caplog):
    """The share of the variance that the note says."""
    detector = {"NumberOfPixels": [512, 512], "Spacing": [0.02, 0.02, "mm"], **blur}
    sensor = bins(scene_of(tmp_path, detector, Noise=True, Samples=AWAY).image("energy", precision="double"), 2, 2)
    with caplog.at_level("INFO"):
        binned = scene_of(tmp_path, {**detector, "Binning": [2, 2]}, Noise=True, Samples=AWAY).image("energy", precision="double")
    note = next(record.message for record in caplog.records if "Binning behind a blur" in record.message)
    share = float(note.split("makes ")[1].split()[0])
    assert said is None or share == pytest.approx(said, abs=2e-3)
    assert binned.mean() == pytest.approx(sensor.mean(), rel=1e-3)
    # Neighbours are correlated: about half as many values are independent.
    assert binned.var() / sensor.var() == pytest.approx(share, abs=6 * np.sqrt(2 * 2 / binned.size))


def test_photons_of_mas_are_per_area(tmp_path):
    beam = {"Source": {"Position": [0, -500, 0, "mm"], "Shape": "PointSource", "Beam": {"kVp": 80, "mAs": 2, "Filter": [["Al", 3, "mm"]]}}}
    sensor, binned = scene_of(tmp_path, **beam), scene_of(tmp_path, {"Binning": [2, 2]}, **beam)
    right = bins(sensor.image("photons", precision="double"), 2, 2)
    np.testing.assert_allclose(binned.image("photons", precision="double"), right, rtol=1e-6)


def test_a_binned_scene_is_saved_and_read(tmp_path):
    scene = scene_of(tmp_path, {"Binning": [2, 2]}, Noise={"Electronic": [3, "keV"], "Seed": 5})
    scene.save(tmp_path / "again.json")
    again = sk.Scene(tmp_path / "again.json")
    assert again.view == scene.view
    np.testing.assert_array_equal(again.image(index=0), scene.image(index=0))
    scene.beam = sk.Beam.mono(60, 1000)
    scene.save(tmp_path / "again.json")
    np.testing.assert_array_equal(sk.Scene(tmp_path / "again.json").image(index=0), scene.image(index=0))


@pytest.mark.parametrize("detector, sentence", [
    ({"Binning": [5, 2]}, "does not divide NumberOfPixels, 96 x 72"),
    ({"Binning": [2, 2], "Oversampling": 9}, "18 x 18 rays"),
    ({"BinningNoise": "once"}, "give Binning as well"),
    ({"Binning": [2, 2], "BinningNoise": "twice"}, 'give "each"'),
    ({"Binning": [2, 2], "MTF": [[0, 1], [1, 0.5]], "DQE": [[0, 0.7], [1, 0.5]]}, "leave Binning out"),
])
def test_what_is_refused(tmp_path, detector, sentence):
    with pytest.raises(sk.Error, match=sentence):
        scene_of(tmp_path, detector)


def test_a_table_has_the_steps_of_the_image(tmp_path):
    row = [0, -500, 0, 0, 250, 0, 0.5, 0, 0, 0, 0, -0.5]
    with pytest.raises(sk.Error, match="0.5 mm apart; with Binning"):
        scene_of(tmp_path, {"Binning": [2, 2]}, Scan={"Table": [row]})
    row[6], row[11] = 1, -1
    assert scene_of(tmp_path, {"Binning": [2, 2]}, Scan={"Table": [row]}).trajectory is not None
