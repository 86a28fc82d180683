"""Curved detectors: images against flat detectors of one column, files, and a third-generation scanner."""
import json

import numpy as np
import pytest

import skiagraph as sk

SDD, SOD = 500.0, 300.0


@pytest.fixture
def fan():
    """The axis of the detector goes through the source; 96 columns up to 26 degrees from the middle."""
    return sk.View(source=(0, -SOD, 0), detector=(0, SDD - SOD, 0), column_step=(-4.8, 0, 0), row_step=(0, 0, -4),
                   pixels=(96, 20), radius=SDD)


def column(view, k):
    place, step = view.pixel(k - (view.pixels[0] - 1) / 2, 0)
    return sk.View(source=view.source, detector=place, column_step=step, row_step=view.row_step, pixels=(1, view.pixels[1]))


def cylinder(radius=80.0, height=200.0):
    made = sk.Scene()
    made.add("body", sk.Mesh.cylinder(radius, height, segments=720), material=sk.Material.mu(0.2))
    made.beam = sk.Beam.mono(60, 1e5)
    return made


def test_columns_are_flat_detectors_elsewhere(fan):
    scene = cylinder()
    scene.view = fan
    image = scene.image(quantity="attenuation")
    for k in range(15, 85, 6):
        scene.view = column(fan, k)
        # Two single-precision images: some roundings of 2^-24, of 3.2 at most
        assert np.allclose(image[:, k:k + 1], scene.image(quantity="attenuation"), rtol=0, atol=1e-5)


def test_places(fan):
    ends = [fan.pixel(x, 0)[0] for x in (-47.5, 47.5)]
    assert np.allclose([np.linalg.norm(end - fan.source) for end in ends], SDD, rtol=1e-12)
    half = 47.5 * 4.8 / SDD
    assert np.allclose(ends[1], (-SDD * np.sin(half), SDD * np.cos(half) - SOD, 0), atol=1e-9)
    turned = sk.rotate("z", 30) @ fan
    assert turned.radius == SDD and turned != sk.View(source=turned.source, detector=turned.detector, pixels=turned.pixels,
                                                      column_step=turned.column_step, row_step=turned.row_step)
    assert "radius 500 mm" in repr(fan)


def test_what_cannot_be_imaged(fan):
    fan.radius = 60
    with pytest.raises(sk.SceneError, match="degrees"):
        fan.check()
    fan.radius = SDD
    scene = cylinder()
    scene.view = fan
    with pytest.raises(sk.UnsupportedError, match="curved detector"):
        scene.image(scatter=True)


def test_a_scene_file(tmp_path, fan):
    text = {"Source": {"Position": [0, -300, 0, "mm"], "Shape": "PointSource",
                       "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
            "Detector": {"Position": [0, 200, 0, "mm"], "ColumnStep": [-4.8, 0, 0, "mm"], "RowStep": [0, 0, -4, "mm"],
                         "NumberOfPixels": [96, 20], "Curved": {"Radius": [50, "cm"], "Axis": "columns"}},
            "Samples": [{"Label": "block", "Cuboid": [60, 40, 80, "mm"], "Material": ["mu", 0.2]}]}
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(text))
    scene = sk.Scene(path)
    assert scene.view == fan
    scene.save(tmp_path / "again.json")
    again = sk.Scene(tmp_path / "again.json")
    assert again.view == fan and np.array_equal(again.image(), scene.image())
    for radius, said in (([0, "mm"], "radius 0"), ([-1, "mm"], "radius"), (None, "Radius")):
        text["Detector"]["Curved"] = {"Radius": radius} if radius else {}
        path.write_text(json.dumps(text))
        with pytest.raises(sk.Error, match=said):
            sk.Scene(path)


def test_third_generation(tmp_path, fan):
    """A scanner whose detector turns with the source: a uniform cylinder has its coefficient, to 1 %, also beside the middle plane."""
    fan = sk.View(source=fan.source, detector=fan.detector, column_step=(-1.2, 0, 0), row_step=fan.row_step, pixels=(384, 8),
                  radius=SDD)
    scene = cylinder(radius=70)
    scene.view = fan
    scene.trajectory = sk.Scan(fan, 360, axis="z")
    images = scene.scan(quantity="attenuation")
    volume = sk.reconstruct(scene.trajectory, images, size=(64, 64, 3), voxel=3, filter="hann")
    across = (np.arange(64) - 31.5) * 3
    inside = np.hypot(*np.meshgrid(across, across)) < 70 - 6
    outside = (np.hypot(*np.meshgrid(across, across)) > 70 + 6) & (np.hypot(*np.meshgrid(across, across)) < 95)
    for plane in volume:
        assert np.abs(plane[inside] / 0.2 - 1).max() < 0.01
        assert np.abs(plane[outside]).max() < 0.01 * 0.2
    scene.scan(tmp_path / "scan.h5", quantity="attenuation")
    read = sk.reconstruct(tmp_path / "scan.h5", size=(64, 64, 3), voxel=3, filter="hann")
    assert np.allclose(read, volume, rtol=0, atol=1e-5)
    scene.trajectory.save(tmp_path / "scan.csv")
    flat = sk.View(source=fan.source, detector=fan.detector, column_step=fan.column_step, row_step=fan.row_step, pixels=fan.pixels)
    assert sk.Scan.load(flat, tmp_path / "scan.csv")[7] == scene.trajectory[7]
