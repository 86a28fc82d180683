"""CT images from folders of DICOM slices, written here by pydicom, and read by the library."""
import json
import pickle
import re
import subprocess
import sys
import warnings

import numpy as np
import pytest

import skiagraph as sk
from skiagraph import _command

pydicom = pytest.importorskip("pydicom")
from pydicom.dataset import Dataset, FileDataset, FileMetaDataset  # noqa: E402
from pydicom.sequence import Sequence  # noqa: E402
from pydicom.uid import ExplicitVRLittleEndian, ImplicitVRLittleEndian, RLELossless, generate_uid  # noqa: E402

CELLS = np.random.default_rng(2).integers(-1000, 1500, (6, 5, 4)).astype(np.int16)  # [z, y, x]
TURN = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
TURN *= np.sign(np.linalg.det(TURN))
SPACING, FIRST = np.array([1.5, 2.0, 3.0]), np.array([-10.0, 20.0, 30.0])  # x, y, z


def write_slice(folder, index, *, at, series="1.2.3", implicit=False, compressed=False, **more):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = "1.2.840.10008.5.1.4.1.1.2", generate_uid()
    meta.TransferSyntaxUID = ImplicitVRLittleEndian if implicit else ExplicitVRLittleEndian
    data = FileDataset(None, {}, file_meta=meta, preamble=b"\0" * 128)
    data.is_little_endian, data.is_implicit_VR = True, implicit
    data.SOPClassUID, data.SOPInstanceUID, data.SeriesInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID, series
    data.Rows, data.Columns = CELLS.shape[1:]
    data.PixelSpacing = [SPACING[1], SPACING[0]]
    data.ImageOrientationPatient = np.round(TURN[:, :2].T.ravel(), 9).tolist()
    data.ImagePositionPatient = np.round(at, 6).tolist()
    data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
    data.BitsAllocated, data.BitsStored, data.HighBit, data.PixelRepresentation = 16, 16, 15, 0
    data.RescaleSlope, data.RescaleIntercept = 1, -1024
    data.PixelData = (CELLS[index] + 1024).astype("<u2").tobytes()
    for name, value in more.items():
        setattr(data, name, value)
    if compressed:
        data.compress(RLELossless)
    data.save_as(folder / f"{(7 * index) % 11}.dcm", write_like_original=False)  # not in the order of their names


def write(folder, step=TURN[:, 2] * SPACING[2], only=range(6), **more):
    for index in only:
        write_slice(folder, index, at=FIRST + index * step, **more)
    (folder / "notes.txt").write_text("no slice")
    return folder


def scene_of(array, affine=None):
    scene = sk.Scene()
    scene.view = sk.View(source=(0, 0, -400), detector=(0, 0, 100), column_step=(1, 0, 0), row_step=(0, 1, 0), pixels=(60, 60))
    scene.beam = sk.Beam.mono(60, 1000)
    scene.add_volume("ct", array, affine)
    return scene


SCENE = {"Source": {"Position": [0, 0, -400, "mm"], "Shape": "PointSource", "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
         "Detector": {"Position": [0, 0, 100, "mm"], "ColumnStep": [1, 0, 0, "mm"], "RowStep": [0, 1, 0, "mm"], "NumberOfPixels": [60, 60]}}


def scene_of_file(folder):
    return sk.Scene(SCENE | {"Samples": [{"Label": "ct", "Volume": str(folder), "Values": "HU"}]})


both = pytest.mark.parametrize("reading", [scene_of, scene_of_file])


def by_pydicom(folder):
    """Cells and affine as pydicom reads the slices."""
    slices = [pydicom.dcmread(path) for path in folder.glob("*.dcm")]
    slices.sort(key=lambda data: float(np.array(data.ImagePositionPatient, float) @ TURN[:, 2]))
    cells = np.stack([data.pixel_array * float(data.RescaleSlope) + float(data.RescaleIntercept) for data in slices])
    places = np.array([data.ImagePositionPatient for data in slices], float)
    turns, (down, right) = np.array(slices[0].ImageOrientationPatient, float), np.array(slices[0].PixelSpacing, float)
    affine = np.eye(4)
    affine[:3, :3] = np.column_stack([turns[:3] * right, turns[3:] * down, (places[-1] - places[0]) / (len(places) - 1)])
    affine[:3, 3] = places[0]
    whole = (cells == np.rint(cells)).all() and abs(cells).max() < 32768
    return cells.astype(np.int16 if whole else np.float32), affine


def same(folder, reading=scene_of_file):
    """Our cells of a folder are pydicom's, and in their place."""
    ours, theirs = reading(folder), scene_of(*by_pydicom(folder))
    for key in ("columns", "rows", "slices", "bits", "low", "high", "beyond", "classes"):
        assert ours["ct"].volume[key] == theirs["ct"].volume[key], key
    np.testing.assert_allclose(ours["ct"].volume["affine"], theirs["ct"].volume["affine"], rtol=0, atol=1e-12)  # roundings of 30 mm
    image = theirs.image("attenuation")
    assert image.max() > 0.05
    np.testing.assert_allclose(ours.image("attenuation"), image, rtol=0, atol=1e-6 * image.max())  # crossings are floats


@both
@pytest.mark.parametrize("step", [TURN[:, 2] * SPACING[2], TURN @ [0.4, 0.2, 3.0]])  # upright; of a tilted gantry
def test_a_series_is_its_cells_in_their_place(tmp_path, reading, step):
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = np.column_stack([TURN[:, 0] * SPACING[0], TURN[:, 1] * SPACING[1], step]), FIRST
    found, expected = (scene.image("attenuation") for scene in (reading(write(tmp_path, step)), scene_of(CELLS, affine)))
    assert expected.max() > 0.05
    np.testing.assert_allclose(found, expected, atol=2e-6 * expected.max())  # places are written to a millionth of a mm


def nested(depth):
    """Attributes within attributes, a small picture among them."""
    item = Dataset()
    item.PixelData, item.Rows, item.Columns, item.ImagePositionPatient = b"\0" * 8, 2, 2, [9, 9, 9]
    item["PixelData"].VR = "OW"
    if depth:
        item.IconImageSequence = Sequence([nested(depth - 1)])
    for sequence in item:
        if sequence.VR == "SQ":
            sequence.is_undefined_length = depth % 2 == 0
    item.is_undefined_length_sequence_item = depth % 2 == 1
    return item


@pytest.mark.parametrize("more", [
    {},
    {"implicit": True},
    {"RescaleSlope": 0.25, "RescaleIntercept": -700},  # no whole numbers
    {"RescaleSlope": 20},  # beyond 16 bits
    {"PixelRepresentation": 1},
    {"BitsAllocated": 8, "BitsStored": 8, "HighBit": 7, "PixelData": bytes(range(20)), "RescaleSlope": 50},
    {"SliceThickness": 5, "ImageComments": "c" * 700, "ReferencedImageSequence": Sequence([])},
    {"IconImageSequence": Sequence([nested(3), nested(2)])},
    {"IconImageSequence": Sequence([nested(3), nested(2)]), "implicit": True},
])
def test_the_library_reads_what_pydicom_reads(tmp_path, more):
    same(write(tmp_path, **more))


@both
@pytest.mark.parametrize("only, more, says", [
    ((0, 1, 2, 4, 5), {}, "6 mm lie between slices 2 and 3, 3 mm between others"),
    ((3,), {}, "holds 1 slice"),
    ((), {}, "holds no DICOM slice"),
    (range(6), {"NumberOfFrames": 3}, "holds 3 frames"),
    (range(6), {"SamplesPerPixel": 3, "PhotometricInterpretation": "RGB", "PlanarConfiguration": 0, "PixelData": b"\0" * 120}, "colours"),
    (range(6), {"PixelData": b"\0" * 30}, "pixels|PixelData"),
    (range(6), {"PixelData": b"\0" * 42}, "has 42 bytes of pixels, and its size asks for 40"),  # the picture would be askew
    (range(6), {"Rows": 4}, "has 40 bytes of pixels, and its size asks for 32"),
    (range(6), {"ImageOrientationPatient": [2, 0, 0, 0, 2, 0]}, "is .2 0 0 0 2 0., vectors of the lengths 2 and 2 with the product 0"),
    (range(6), {"ImageOrientationPatient": [1, 0, 0, .6, .8, 0]}, "of the lengths 1 and 1 with the product 0.6"),
    (range(6), {"RescaleSlope": 0}, "RescaleSlope is 0"),
    (range(6), {"ModalityLUTSequence": Sequence([])}, "stand in a table"),
])
def test_what_is_no_volume_is_refused(tmp_path, reading, only, more, says):
    with pytest.raises(sk.Error, match=says):
        reading(write(tmp_path, only=only, **more))


def patch(folder, before, after):
    """Other bytes of the same number in each slice: what pydicom would not write."""
    assert len(before) == len(after)
    for path in folder.glob("*.dcm"):
        whole = path.read_bytes()
        assert whole.count(before) == 1
        path.write_bytes(whole.replace(before, after))


@both
@pytest.mark.parametrize("text", [b"-1O24 ", b"-10,4 ", b"      ", b"nan   ", b"1e9999", b"-1024-", b"0x400 ", b"1\\2   ", b"--1024"])
def test_a_number_that_is_none_is_refused(tmp_path, reading, text):
    """Read as far as it goes, -1O24 would be -1, and all Hounsfield numbers 1023 too high."""
    patch(write(tmp_path, RescaleIntercept="-1024"), b"-1024 ", text)
    with pytest.raises(sk.Error, match=r"\.dcm: its RescaleIntercept says \"" + re.escape(text.decode().rstrip())):
        reading(tmp_path)


@pytest.mark.parametrize("name, before, after", [("PixelSpacing", b"2.0\\1.5 ", b"2.0\\1.S "), ("PixelSpacing", b"2.0\\1.5 ", b"2\\1.5\\3 "),
                                                 ("RescaleSlope", b"1.25", b"1,25"), ("NumberOfFrames", b"01", b"O1")])
def test_each_number_of_text_is_read_whole(tmp_path, name, before, after):
    value = {"PixelSpacing": [2.0, 1.5]}.get(name, before.decode())
    write(tmp_path)
    for path in tmp_path.glob("*.dcm"):
        data = pydicom.dcmread(path)
        setattr(data, name, value)
        data.save_as(path)
    tag = pydicom.tag.Tag(name)
    head = tag.group.to_bytes(2, "little") + tag.element.to_bytes(2, "little") + (b"IS" if name == "NumberOfFrames" else b"DS")
    head += len(before).to_bytes(2, "little")
    patch(tmp_path, head + before, head + after)
    with pytest.raises(sk.Error, match=f"dcm: its {name} says"):
        scene_of_file(tmp_path)


@pytest.mark.parametrize("text", [b" -1024", b"-1024\0", b"-1.0e3", b"-1024."])
def test_blanks_and_a_zero_byte_are_no_part_of_a_number(tmp_path, text):
    patch(write(tmp_path, RescaleIntercept="-1024"), b"-1024 ", text)
    volume = scene_of_file(tmp_path)["ct"].volume
    assert (volume["low"], volume["high"]) == (CELLS.min() + 24 * (b"e" in text), CELLS.max() + 24 * (b"e" in text))


@both
@pytest.mark.parametrize("more, says", [
    ({"series": "1.2.4"}, "holds 2 series: 5 slices of '1.2.3', 1 slices of '1.2.4'"),
    ({"PixelSpacing": [1, 1]}, "PixelSpacing of slice . is .1"),
    ({"ImagePositionPatient": (FIRST + TURN[:, 2] * 6).tolist()}, "lie at one place"),
    ({"ImagePositionPatient": (FIRST + TURN @ [1, 0, 15]).tolist()}, "shifted sideways"),
])
def test_a_slice_of_another_kind_is_named(tmp_path, reading, more, says):
    write(tmp_path, only=range(5))
    write_slice(tmp_path, 5, at=FIRST + 5 * TURN[:, 2] * SPACING[2], **more)
    with pytest.raises(sk.Error, match=says):
        reading(tmp_path)


@both
@pytest.mark.parametrize("more, says", [
    ({"Modality": "MR"}, "Modality is 'MR'"),
    ({"Modality": "CT", "RescaleType": "US"}, "RescaleType is 'US'"),
    ({"Modality": "CT"}, None),
    ({"Modality": "OT", "RescaleType": "HU"}, None),
])
def test_numbers_of_another_kind_are_warned_of(tmp_path, reading, more, says):
    """A magnetic resonance image has the same attributes, and would be a patient of bone."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        reading(write(tmp_path, **more))
    found = [str(w.message) for w in found if "taken as Hounsfield" in str(w.message)]
    assert len(found) == (says is not None) and all(says in text for text in found)


def test_what_the_library_does_not_expand_pydicom_does(tmp_path, monkeypatch):
    write(tmp_path, compressed=True)
    with pytest.raises(sk.Error, match="compressed .1.2.840.10008.1.2.5.; expand them"):
        scene_of_file(tmp_path)
    same(tmp_path, scene_of)
    (tmp_path / "3.dcm").unlink()
    with pytest.raises(sk.Error, match=f"{tmp_path}: 6 mm lie between"):
        scene_of(tmp_path)
    monkeypatch.setitem(sys.modules, "pydicom", None)
    with pytest.raises(sk.Error, match="compressed .1.2.840.10008.1.2.5.; expand them"):
        scene_of(tmp_path)


@both
@pytest.mark.parametrize("without, says", [("PixelData", "is of the series of the slices, and has no PixelData"),
                                           ("ImagePositionPatient", "and has no ImagePositionPatient"),
                                           ("ImageOrientationPatient", "and has no ImageOrientationPatient"),
                                           ("SeriesInstanceUID", "holds 2 series|says no series")])
def test_the_last_slice_is_not_left_out(tmp_path, reading, without, says):
    """No gap shows that it is missing."""
    path = max(write(tmp_path).glob("*.dcm"), key=lambda path: pydicom.dcmread(path).ImagePositionPatient @ TURN[:, 2])
    data = pydicom.dcmread(path)
    del data[without]
    data.save_as(path)
    with pytest.raises(sk.Error, match=says):
        reading(tmp_path)


def test_files_of_other_series_may_lie_beside_the_slices(tmp_path):
    write(tmp_path)
    write_slice(tmp_path, 0, at=FIRST, series="1.2.9")
    data = pydicom.dcmread(tmp_path / "0.dcm")
    del data.PixelData
    data.save_as(tmp_path / "report.dcm")
    write_slice(tmp_path, 0, at=FIRST)
    (tmp_path / "._1.dcm").write_bytes(b"of the system")
    assert scene_of_file(tmp_path)["ct"].volume["slices"] == len(CELLS)


def test_an_odd_number_of_bytes_is_filled_up(tmp_path):
    write(tmp_path, Rows=5, Columns=3, BitsAllocated=8, BitsStored=8, HighBit=7, PixelData=bytes(range(16)))
    assert scene_of_file(tmp_path)["ct"].volume["columns"] == 3


def test_files_that_end_early_end_no_process(tmp_path):
    write(tmp_path, IconImageSequence=Sequence([nested(2)]))
    path = tmp_path / "0.dcm"
    whole, failed = path.read_bytes(), 0
    for size in range(3, len(whole), 7):
        path.write_bytes(whole[:size])
        with pytest.raises(sk.Error, match="is it the whole file|bytes of pixels"):
            scene_of_file(tmp_path)
        failed += 1
    assert failed > 50
    path.write_bytes(whole)
    same(tmp_path)


def test_a_scene_of_a_folder_is_not_pickled(tmp_path):
    with pytest.raises(sk.FileError, match="is a folder, .*cannot be pickled"):
        pickle.dumps(scene_of_file(write(tmp_path)))


def test_no_slice_is_overwritten(tmp_path, command):
    folder, path = tmp_path / "series", tmp_path / "at" / "scene.json"
    folder.mkdir(), path.parent.mkdir()
    write(folder)
    path.write_text(json.dumps(SCENE | {"Samples": [{"Label": "ct", "Volume": "../series"}]}))
    before = (folder / "0.dcm").read_bytes()
    for output, status in ((folder / "0.dcm", 5), (folder / "picture.png", 0), (folder / "picture.png", 0)):
        run = subprocess.run([_command.path(), "image", str(path), "-o", str(output)], capture_output=True, text=True)
        assert run.returncode == status, run.stderr
        assert status == 0 or "is read by the scene, as ../series" in run.stderr
    assert (folder / "0.dcm").read_bytes() == before


def test_the_command_says_what_is_in_a_folder(tmp_path, command):
    folder = tmp_path / "series"
    folder.mkdir()
    run = subprocess.run([_command.path(), "mesh", "--json", f"{write(folder)}/"], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)["files"][0]
    assert found["cells"] == [4, 5, 6] and (found["low"], found["high"]) == (CELLS.min(), CELLS.max())
    np.testing.assert_allclose(found["spacing_mm"], SPACING, rtol=1e-8)  # cosines have 9 decimals
    run = subprocess.run([_command.path(), "mesh", str(tmp_path)], capture_output=True, text=True)
    assert run.returncode == 3 and "holds no DICOM slice" in run.stderr
