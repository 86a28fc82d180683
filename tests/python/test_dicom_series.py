"""CT images from folders of DICOM slices, written here by pydicom."""
import numpy as np
import pytest

import skiagraph as sk

pydicom = pytest.importorskip("pydicom")
from pydicom.dataset import FileDataset, FileMetaDataset  # noqa: E402
from pydicom.uid import ExplicitVRLittleEndian, generate_uid  # noqa: E402

CELLS = np.random.default_rng(2).integers(-1000, 1500, (6, 5, 4)).astype(np.int16)  # [z, y, x]
TURN = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
TURN *= np.sign(np.linalg.det(TURN))
SPACING, FIRST = np.array([1.5, 2.0, 3.0]), np.array([-10.0, 20.0, 30.0])  # x, y, z


def write_slice(folder, index, *, at, series="1.2.3", **more):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = "1.2.840.10008.5.1.4.1.1.2", generate_uid()
    meta.TransferSyntaxUID = ExplicitVRLittleEndian
    data = FileDataset(None, {}, file_meta=meta, preamble=b"\0" * 128)
    data.is_little_endian, data.is_implicit_VR = True, False
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


@pytest.mark.parametrize("step", [TURN[:, 2] * SPACING[2], TURN @ [0.4, 0.2, 3.0]])  # upright; of a tilted gantry
def test_a_series_is_its_cells_in_their_place(tmp_path, step):
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = np.column_stack([TURN[:, 0] * SPACING[0], TURN[:, 1] * SPACING[1], step]), FIRST
    found, expected = (scene_of(*given).image("attenuation") for given in ((write(tmp_path, step),), (CELLS, affine)))
    assert expected.max() > 0.05
    np.testing.assert_allclose(found, expected, atol=2e-6 * expected.max())  # places are written to a millionth of a mm


@pytest.mark.parametrize("only, more, says", [
    ((0, 1, 2, 4, 5), {}, "6 mm lie between slices 2 and 3, 3 mm between others"),
    ((3,), {}, "holds 1 slice"),
    ((), {}, "holds no DICOM slice"),
])
def test_what_is_no_volume_is_refused(tmp_path, only, more, says):
    with pytest.raises(sk.FileError, match=says):
        scene_of(write(tmp_path, only=only, **more))


@pytest.mark.parametrize("more, says", [
    ({"series": "1.2.4"}, "holds 2 series: 5 slices of '1.2.3', 1 slices of '1.2.4'"),
    ({"PixelSpacing": [1, 1]}, "PixelSpacing of slice . is .1.0, 1.0."),
    ({"ImagePositionPatient": (FIRST + TURN[:, 2] * 6).tolist()}, "lie at one place"),
    ({"ImagePositionPatient": (FIRST + TURN @ [1, 0, 15]).tolist()}, "shifted sideways"),
])
def test_a_slice_of_another_kind_is_named(tmp_path, more, says):
    write(tmp_path, only=range(5))
    write_slice(tmp_path, 5, at=FIRST + 5 * TURN[:, 2] * SPACING[2], **more)
    with pytest.raises(sk.FileError, match=says):
        scene_of(tmp_path)
