"""Volumes of cells as parts."""
import gzip
import json
import pickle
import struct

import numpy as np
import pytest

import skiagraph as sk

AFFINE = np.array([[2.0, 0, 0, -19], [0, 2, 0, -14], [0, 0, 2, -9], [0, 0, 0, 1]])


def make_scene():
    scene = sk.Scene()
    scene.view = sk.View(source=(0, 0, -400), detector=(0, 0, 100), column_step=(2, 0, 0), row_step=(0, 2, 0), pixels=(40, 30))
    scene.beam = sk.Beam.mono(60, 1000)
    return scene


def block(volume, **more):
    """A block of water of 40 x 30 x 20 mm, of cells or of triangles."""
    scene = make_scene()
    if volume is None:
        scene.add("block", sk.Mesh.cuboid(40, 30, 20), material="Water")
    else:
        scene.add_volume("block", volume, AFFINE, **more)
    return scene


@pytest.mark.parametrize("cells, more", [
    (np.ones((10, 15, 20), np.int8), {"values": "density", "material": "Water"}),
    (np.ones((10, 15, 20), np.uint16), {"values": "density", "classes": [(0, "Water"), (2, "Pb")]}),
    (np.ones((20, 15, 10)).T, {"values": "density", "material": sk.Material("Water")}),
    (np.full((10, 15, 20), sk.Material("Water").attenuation(60), np.float64), {"values": "mu"}),
])
def test_cells_are_a_block(cells, more):
    expected = block(None).image("attenuation")
    found = block(cells, **more).image("attenuation")
    np.testing.assert_allclose(found, expected, atol=2e-6 * expected.max())  # faces of meshes are rounded


@pytest.mark.parametrize("kind", ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8"])
def test_the_byte_order_of_an_array_does_not_matter(kind):
    cells = np.full((10, 15, 20), 50)
    cells[3, 4, 5] = 100
    images = [block(cells.astype(order + kind), values="HU").image("attenuation") for order in "<>"]
    np.testing.assert_array_equal(*images)
    assert images[0].max() > 0.3  # 20 mm of tissue


def test_densities_that_nothing_has_are_warned_of():
    with pytest.warns(sk.SkiagraphWarning, match="are they mg/cm3"):
        block(np.full((10, 15, 20), 1000.0), values="density", material="Water")


def test_the_axes_are_z_y_x():
    cells = np.zeros((10, 15, 20), np.float32)
    cells[:, 3, 7] = 1  # a rod along the beam, at x = -5 and y = -8 mm
    scene = make_scene()
    scene.add_volume("rod", cells, AFFINE, "mu", pose=sk.translate(0, 0, 0))
    row, column = np.unravel_index(scene.image("attenuation").argmax(), (30, 40))
    # The detector is 1.25 times as far as the middle of the cells.
    assert abs((column - 19.5) * 2 / 1.25 + 5) < 1.5 and abs((row - 14.5) * 2 / 1.25 + 8) < 1.5


def test_values_are_linear_between_cells():
    cells = np.zeros((1, 1, 2), np.float32)
    cells[0, 0] = 0, 1
    images = []
    for interpolation in ("cells", "linear"):
        scene = make_scene()
        scene.add_volume("two", cells, np.diag([20, 20, 20, 1]), "mu", interpolation=interpolation, pose=sk.translate(-10, 0, 0))
        images.append(scene.image("attenuation"))
    # A step, and a ramp over 20 mm with the same sum.
    assert np.unique(images[0][15].round(2)).size < np.unique(images[1][15].round(2)).size
    np.testing.assert_allclose(images[1].sum(), images[0].sum(), rtol=0.02)


def test_parts_inside_displace_cells():
    images = []
    for volume in (None, np.ones((10, 15, 20), np.int16)):
        scene = block(volume, values="density", material="Water") if volume is not None else block(None)
        part = scene.add("needle", sk.Mesh.cube(6), material="Ti", inside="block")
        assert part.inside == "block" and (scene["block"].volume is None) == (volume is None) and part.volume is None
        images.append(scene.image("attenuation"))
        scene.remove("needle")
        assert scene.image("attenuation").max() < images[-1].max()
    np.testing.assert_allclose(images[1], images[0], atol=2e-6 * images[0].max())


def test_what_cannot_be_is_refused(tmp_path):
    cells = np.zeros((2, 3, 4), np.int16)
    scene = make_scene()
    with pytest.raises(sk.ArgumentError, match="affine is missing"):
        scene.add_volume("ct", cells)
    with pytest.raises(sk.ArgumentError, match=r"cells \[z, y, x\]"):
        scene.add_volume("ct", cells[0], AFFINE)
    with pytest.raises(sk.ArgumentError, match="'HU', 'density' or 'mu'"):
        scene.add_volume("ct", cells, AFFINE, "grey")
    with pytest.raises(sk.ArgumentError, match="'cells' or 'linear'"):
        scene.add_volume("ct", cells, AFFINE, interpolation="cubic")
    with pytest.raises(sk.Error, match="singular"):
        scene.add_volume("ct", cells, np.diag([1, 1, 0, 1]))
    with pytest.raises(sk.Error, match="column 1, row 2, slice 0 is nan"):
        scene.add_volume("ct", np.where(np.arange(24).reshape(2, 3, 4) == 9, np.nan, 0), AFFINE)
    with pytest.raises(sk.ArgumentError, match="array has 3 masked values of 24"):
        scene.add_volume("ct", np.ma.masked_less(np.arange(24.0).reshape(2, 3, 4), 3), AFFINE)
    scene.add_volume("ct", np.ma.masked_less(cells, 0), AFFINE)  # none is
    with pytest.raises(sk.Error, match="whose cells say"):
        scene["ct"].material = "Water"
    with pytest.raises(sk.Error, match="not pickled"):
        pickle.dumps(scene)
    with pytest.raises(sk.Error, match="not written"):
        scene.save(tmp_path / "scene.json")
    with pytest.raises(sk.Error, match="no derivative by source or detector"):
        scene.gradient(np.ones((30, 40)), wrt=("source",))
    assert np.isnan(scene.gradient(np.ones((30, 40)), wrt=("poses",))["poses"]["ct"]).all()
    assert np.isnan(scene.gradient(np.ones((30, 40)), wrt=("mu",))["mu"]["ct"]).all()
    assert scene.gradient(np.ones((30, 40)), wrt=("density",))["density"]["ct"] < 0  # less arrives, as energy
    scene.add_volume("mu", np.ones((2, 3, 4)), AFFINE, "mu")
    with pytest.raises(sk.Error, match="mu are attenuation coefficients"):
        scene.image(scatter=0.1)


def test_files_and_what_is_in_them(tmp_path):
    cells = np.array([[[-1000, 40], [40, 40]]], "<i2")
    path = tmp_path / "ct.mha"
    path.write_bytes(b"NDims = 3\nElementSpacing = 2 3 4\nDimSize = 2 2 1\nElementType = MET_SHORT\nElementDataFile = LOCAL\n"
                     + cells.tobytes())
    scene = make_scene()
    part = scene.add_volume("ct", path)
    found = part.volume
    assert (found["columns"], found["rows"], found["slices"], found["bits"]) == (2, 2, 1, 16)
    assert found["low"] == -1000 and found["high"] == 40 and sorted(found["classes"].values()) == [0.25, 0.75]
    with pytest.raises(sk.ArgumentError, match="beside a file"):
        scene.add_volume("other", path, AFFINE)


def test_what_a_file_leaves_open_is_warned_of(tmp_path):
    path = tmp_path / "ct.nrrd"
    path.write_bytes(b"NRRD0004\ntype: short\ndimension: 3\nsizes: 2 2 1\nencoding: raw\n\n" + np.array([-1000, 40, 40, 40], "<i2").tobytes())
    with pytest.warns(sk.SkiagraphWarning) as warned:
        part = make_scene().add_volume("ct", path)
    said = [str(one.message) for one in warned]
    assert "ct: its header does not say how large" in said[0] and "no endian" in said[1] and len(said) == 2
    assert len(part.volume["remarks"]) == 2
    path.write_bytes(path.read_bytes().replace(b"\n\n", b"\nendian: little\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace units: \"cm\" \"cm\" \"cm\"\n\n", 1))
    part = make_scene().add_volume("ct", path)
    assert part.volume["spacing"][0] == 10 and part.volume["remarks"] == []


def test_a_scene_file_with_a_volume_is_saved_as_it_was(tmp_path):
    cells = np.full((4, 4, 4), 40, "<i2")
    (tmp_path / "ct.mha").write_bytes(b"NDims = 3\nElementSpacing = 9 9 9\nDimSize = 4 4 4\nElementType = MET_SHORT\n"
                                      b"ElementDataFile = LOCAL\n" + cells.tobytes())
    text = {"Source": {"Position": [0, 0, -400, "mm"], "Shape": "PointSource", "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 9}]},
            "Detector": {"Position": [0, 0, 100, "mm"], "ColumnStep": [2, 0, 0, "mm"], "RowStep": [0, 2, 0, "mm"], "NumberOfPixels": [40, 30]},
            "Samples": [{"Label": "ct", "Volume": "ct.mha", "Values": "HU"}]}
    (tmp_path / "scene.json").write_text(json.dumps(text))
    scene = sk.Scene(tmp_path / "scene.json")
    scene["ct"].pose = sk.translate(3, -20, 0)
    image = scene.image("attenuation")
    assert image.max() > 0.5
    scene.save(tmp_path / "moved.json")
    np.testing.assert_array_equal(sk.Scene(tmp_path / "moved.json").image("attenuation"), image)


def test_metal_is_warned_of():
    cells = np.full((2, 3, 4), 5000, np.int16)
    with pytest.warns(sk.SkiagraphWarning, match="24 cells are above HU 3000, up to HU 5000"):
        make_scene().add_volume("ct", cells, AFFINE)
    make_scene().add_volume("ct", cells, AFFINE, classes=[(-1000, "Air"), (0, "Water"), (3000, "Ti")])


def test_other_cells_make_another_scan(tmp_path):
    hashes = []
    for value in (1, 1, 2):
        scene = block(np.full((10, 15, 20), value, np.int16), values="density", material="Water")
        scene.trajectory = sk.Scan(scene.view, 1)
        hashes.append(scene.scan(tmp_path / f"{len(hashes)}.mha")["hash"])
    assert hashes[0] == hashes[1] != hashes[2]


def test_values_beside_a_header_are_part_of_the_scan(tmp_path):
    text = {"Source": {"Position": [0, 0, -400, "mm"], "Shape": "PointSource", "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 9}]},
            "Detector": {"Position": [0, 0, 100, "mm"], "ColumnStep": [2, 0, 0, "mm"], "RowStep": [0, 2, 0, "mm"], "NumberOfPixels": [8, 8]},
            "Samples": [{"Label": "ct", "Volume": "ct.mhd"}], "Scan": {"NumberOfProjections": 2, "FinalAngle": 180}}
    (tmp_path / "scene.json").write_text(json.dumps(text))
    (tmp_path / "ct.mhd").write_text("NDims = 3\nElementSpacing = 9 9 9\nDimSize = 2 2 2\nElementType = MET_SHORT\nElementDataFile = ct.raw\n")
    hashes = []
    for number in (40, 40, 41):
        (tmp_path / "ct.raw").write_bytes(np.full(8, number, "<i2").tobytes())
        hashes.append(sk.Scene(tmp_path / "scene.json").scan(tmp_path / f"{len(hashes)}.mha")["hash"])
    assert hashes[0] == hashes[1] != hashes[2]


def test_simpleitk_images(tmp_path):
    itk = pytest.importorskip("SimpleITK")
    image = itk.GetImageFromArray(np.ones((10, 15, 20), np.int16))
    image.SetSpacing((2, 2, 2))
    image.SetOrigin((-19, -14, -9))
    scene = make_scene()
    scene.add_volume("block", image, values="density", material="Water")
    expected = block(None).image("attenuation")
    np.testing.assert_allclose(scene.image("attenuation"), expected, atol=2e-6 * expected.max())
    cells = np.random.default_rng(1).integers(-900, 1500, (10, 15, 20)).astype(np.int16)
    image = itk.GetImageFromArray(cells)
    image.SetSpacing((2, 2.5, 1.5))
    image.SetOrigin((-19, 14, -9))
    image.SetDirection((0.8, 0.6, 0, 0.6, -0.8, 0, 0, 0, 1))
    scene = make_scene()
    for other, words in ((itk.Image(4, 4, itk.sitkInt16), "2 dimensions"), (itk.Image([4, 4, 4], itk.sitkVectorUInt8, 3), "3 values a pixel")):
        with pytest.raises(sk.ArgumentError, match=words):
            scene.add_volume("ct", other)
    scene.add_volume("ct", image)
    expected = scene.image("attenuation")
    for name in ("ct.mha", "ct.mhd", "ct.nrrd"):
        for compressed in (False, True):
            itk.WriteImage(image, str(tmp_path / name), compressed)
            scene = make_scene()
            scene.add_volume("ct", tmp_path / name)
            np.testing.assert_allclose(scene.image("attenuation"), expected, atol=1e-6 * expected.max())


def nifti(cells):
    """A NIfTI-1 file of 16-bit cells [z, y, x] with sides of 2 mm."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *reversed(cells.shape), 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 4, 16)
    struct.pack_into("<f", header, 108, 352)
    struct.pack_into("<2h", header, 252, 0, 1)
    struct.pack_into("<12f", header, 280, 2, 0, 0, -19, 0, 2, 0, -14, 0, 0, 2, -9)
    header[123], header[344:347] = 2, b"n+1"
    return bytes(header) + cells.astype("<i2").tobytes()


def test_compressed_files_are_whole(tmp_path):
    cells = np.arange(3000).reshape(10, 15, 20) - 1000
    plain, path = nifti(cells), tmp_path / "ct.nii.gz"
    whole = gzip.compress(plain, mtime=0)
    members = b"".join(gzip.compress(plain[i:i + 999], mtime=0) for i in range(0, len(plain), 999))  # as pigz -i and bgzip write it
    for data in (whole, members, members + bytes(512)):
        path.write_bytes(data)
        scene = make_scene()
        scene.add_volume("ct", str(path))
        scene.image("attenuation")
    wrong = bytearray(whole)
    wrong[-7] ^= 1
    damaged = bytearray(whole)
    damaged[len(whole) // 2:len(whole) // 2 + 40] = bytes(40)
    for data, says in [(whole[:-4], "ends before the checksum"), (bytes(wrong), "do not agree with their checksum"),
                       (whole + b"more", "has bytes behind its compressed values"), (bytes(damaged), "damaged|checksum|holds more"),
                       (whole[:len(whole) // 2], "ends in slice"), (whole + whole, "holds more than")]:
        path.write_bytes(data)
        with pytest.raises(sk.Error, match=says):
            make_scene().add_volume("ct", str(path))


@pytest.mark.parametrize("from_file", [False, True])
def test_added_volumes_are_neither_saved_nor_pickled(tmp_path, from_file):
    scene = make_scene()
    itk = pytest.importorskip("SimpleITK")
    itk.WriteImage(itk.GetImageFromArray(np.zeros((4, 4, 4), np.int16)), str(tmp_path / "hu.nii"))
    scene.add_volume("ct", tmp_path / "hu.nii" if from_file else np.zeros((4, 4, 4)), None if from_file else np.eye(4))
    for write in (lambda: scene.save(tmp_path / "scene.json"), lambda: pickle.dumps(scene)):
        with pytest.raises(sk.SceneError, match=r"ct: a volume that add_volume\(\) added .* key Volume"):
            write()
