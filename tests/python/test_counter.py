"""Detectors that count photons."""
import numpy as np
import pytest

import skiagraph as sk

SCENE = {"Source": {"Position": [0, -1000, 0, "mm"], "Shape": "PointSource", "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
         "Detector": {"Position": [0, 0, 0, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [16, 12], "Spacing": [0.1, 0.1, "mm"]},
         "Samples": [{"Label": "aside", "Cuboid": [0.1, 0.1, 0.1, "mm"], "Material": "water", "Transform": [["Translation", 0.7, -1, 0, "mm"]]}]}


def test_energies_and_pixels_of_several_shapes():
    counter = sk.Counter("CdTe", 1, 0.1, [20, 50])
    several = counter.counts([60, 70])
    assert several.shape == (2, 2)
    np.testing.assert_array_equal(several[1], counter.counts(70))
    with pytest.raises(sk.ArgumentError, match="give one number, or two"):
        sk.Counter("CdTe", 1, [0.1, 0.2, 0.3], [20])


def make(**fields):
    return sk.Counter("CdTe", 1, 0.1, [15, 50], electronic_kev=1, bias_v=400, fluorescence=True, **fields)


def test_an_image_has_the_counts_of_photons():
    counter = make()
    image = sk.Scene(SCENE).image("photons", counter=counter)
    assert image.shape == (2, 12, 16)
    # Floats of weights and sums.
    assert np.allclose(image[:, :, 8:], 1000 * counter.counts(60)[:, None, None], rtol=1e-6)


def test_a_scene_file_counts_alike():
    detector = {**SCENE["Detector"], "Counting": {"Material": "CdTe", "Thickness": [1, "mm"], "Thresholds": [15, 50], "ElectronicNoise": 1,
                                                  "Bias": 400, "Fluorescence": True}}
    assert np.array_equal(sk.Scene({**SCENE, "Detector": detector}).image(), sk.Scene(SCENE).image("photons", counter=make()))


def test_tables_add_up():
    counter = make()
    assert len(counter) == 2
    for w in range(2):
        # Sums of the same numbers.
        assert counter.spread(60, w).sum() == pytest.approx(counter.counts(60)[w], rel=1e-12)
        assert counter.pairs(60, w, w)[5, 5] == pytest.approx(counter.counts(60)[w], rel=1e-12)


def test_pile_up_loses_counts():
    counts = make().counts(60).sum()
    counter = make(pile_up="nonparalysable", dead_time_ns=100, exposure_s=1000 * counts * 100e-9 / 0.5)
    image = sk.Scene(SCENE).image("photons", counter=counter)
    assert image.sum(0)[6, 8] == pytest.approx(1000 * counts / 1.5, rel=1e-5)  # floats


def test_bad_fields_get_a_sentence():
    with pytest.raises(sk.Error, match="thresholds are above 0 and rise"):
        sk.Counter("CdTe", 1, 0.1, [50, 20])
    with pytest.raises(sk.ArgumentError, match="bias"):
        sk.Counter("CdTe", 1, 0.1, [50], bias=3)
