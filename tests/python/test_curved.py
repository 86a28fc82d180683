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


def test_a_cylinder_of_cells_has_its_chords(fan):
    """Cells of 1 mm hold the share of a cylinder, of 30 mm radius and beside the middle, that is in them. A row 2 mm from the middle has
    paths that are longer by 8e-6."""
    fine = (np.arange(88 * 8) + 0.5) / 8 - 44
    inside = np.hypot(*np.meshgrid(fine - 7, fine + 3)) < 30
    cells = inside.reshape(88, 8, 88, 8).mean((1, 3))[None].astype(np.float32)
    scene = sk.Scene()
    scene.view, scene.beam = fan, sk.Beam.mono(60, 1000)
    affine = np.diag([1, 1, 200, 1.0])
    affine[:2, 3] = -43.5
    scene.add_volume("cylinder", 0.2 * cells, affine, "mu")
    found = scene.image("attenuation")[10].astype(float)
    angle = (np.arange(96) - 47.5) * 4.8 / SDD  # of the fan: towards -x with the columns
    way, off = np.array([-np.sin(angle), np.cos(angle)]), np.array([7, -3 + SOD])
    aside = way[0] * off[1] - way[1] * off[0]
    chord = 2 * np.sqrt(np.maximum(30 ** 2 - aside ** 2, 0)) / 10  # cm
    assert np.count_nonzero(chord > 3) > 8
    off = (found - 0.2 * chord)[np.abs(aside) < 28]  # ends are cut by cells: by less than one, and on average not
    assert np.abs(off).max() < 0.2 * 0.1 and np.abs(off.mean()) < 0.2 * 0.02
    assert np.all(found[np.abs(aside) > 31] == 0)


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


@pytest.mark.full  # reconstruct_test: an_equiangular_fan
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


def bent(radius=160.0, columns=120):
    """Columns up to 54 degrees from the middle, where the touching plane would have 1.7 times the space between them."""
    return sk.View(source=(0, -SOD, 0), detector=(0, SDD - SOD, 0), column_step=(2.5, 0, 0), row_step=(0, 0, 2.5), pixels=(columns, 24),
                   radius=radius)


def edge(x, view):
    """An opaque plate beside a plane that is parallel to the columns."""
    made = sk.Scene()
    made.add("plate", sk.Mesh.cuboid(200, 2, 400), material=sk.Material.mu(1000), pose=sk.translate(x + 100, -100, 0))
    made.beam = sk.Beam.mono(60, 1e4)
    made.view = view
    return made


def moved(image, row, column):
    """Pixels beyond the border have the value of the nearest one."""
    rows, columns = (np.clip(np.arange(size) - by, 0, size - 1) for size, by in zip(image.shape, (row, column)))
    return image[np.ix_(rows, columns)]


@pytest.mark.parametrize("x", [5, 55])  # shadows near the middle, and 50 degrees from it
def test_blur_has_its_width_along_the_cylinder(x):
    sigma = 4.0  # mm
    lines = np.linspace(0, 0.4, 81)  # per mm, to twice the pixels' limit
    mtf = np.stack([lines, np.exp(-2 * (np.pi * sigma * lines) ** 2)], axis=1)
    widths = []
    for blur in (False, {"mtf": mtf}):
        steps = -np.diff(edge(x, bent(columns=140)).image("transmission", blur=blur)[12].astype(float))
        place = 2.5 * np.arange(steps.size)  # mm along the cylinder
        assert steps.sum() == pytest.approx(1, abs=1e-4)
        widths.append(np.average((place - np.average(place, weights=steps)) ** 2, weights=steps))
    # The fewest samples whose transfer function is within 0.005 of the table.
    assert widths[1] - widths[0] == pytest.approx(sigma ** 2, rel=0.05)


def test_blur_keeps_rows_and_columns_apart():
    scene = edge(20, bent())
    scene.add("bar", sk.Mesh.cuboid(90, 2, 5), material=sk.Material.mu(5), pose=sk.translate(-40, -100, 3))
    image, row, column = scene.image("transmission", blur=False).astype(float), (0.1, 0.7, 0.2), (0.3, 0.6, 0.1)
    expected = sum(a * b * moved(image, i - 1, j - 1) for i, a in enumerate(column) for j, b in enumerate(row))
    found = scene.image("transmission", blur={"along_row": row, "along_column": column})
    assert np.ptp(image[:, 30]) > 0.5 and np.allclose(found, expected, rtol=0, atol=1e-6)  # floats


def test_a_counting_detector_that_is_curved():
    """Counts are those of the photons that enter each pixel, spread to its neighbours along the cylinder; on a very large cylinder all is as on a
    flat detector: columns stand 0.01 mm before the plane."""
    counter = sk.Counter("CdTe", 1, 2.5, [15, 50], electronic_kev=1, cloud_mm=0.5)
    scene = edge(20, bent())
    photons = scene.image("transmission").astype(float) * 1e4
    counts = scene.image("photons", counter=counter)
    assert counts.shape == (2, 24, 120)
    for window in range(2):
        spread = counter.spread(60, window)
        expected = sum(spread[5 + i, 5 + j] * moved(photons, i, j) for i in range(-5, 6) for j in range(-5, 6))
        assert np.allclose(counts[window], expected, rtol=0, atol=1e-5 * expected.max())  # floats of weights and sums
    images = []
    for radius in (0, 1e6):
        scene = edge(20, bent(radius, columns=90))
        images.append(scene.image("photons", counter=counter))
        images.append(scene.image("transmission", blur={"along_row": (0.1, 0.7, 0.2), "along_column": (0.3, 0.6, 0.1)}))
        images.append(scene.noise("photons", counter=counter, noise=True)["variance"])
    for flat, curved in zip(images[:3], images[3:]):
        # Each pixel, but for those whose centre the edge may pass.
        assert np.mean(~np.isclose(flat, curved, rtol=1e-5, atol=0)) < 0.04
