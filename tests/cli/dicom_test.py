"""DICOM files of `image` and `scan`, read back by pydicom, which shares nothing with the program that wrote them."""

import json
import math
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
    import pydicom
except ImportError:
    print("skipped: no pydicom (python3-pydicom)")
    sys.exit(77)
if not shutil.which("dump2dcm"):
    print("skipped: no dump2dcm (dcmtk)")
    sys.exit(77)

COMMAND = sys.argv[1]
SCENE = {
    "Source": {"Position": [0, -700, 0, "mm"], "Shape": "PointSource", "Beam": {"kvp": 70, "filter": [["Al", 2.5, "mm"]]}},
    "Detector": {
        "Position": [0, 300, 0, "mm"],
        "UpVector": [0, 0, 1],
        "NumberOfPixels": [40, 30],
        "Spacing": [0.5, 0.25, "mm"],
    },
    "Samples": [{"Label": "ball", "Sphere": [24, 3, "mm"], "Material": "Water"}],
    "Scan": {"NumberOfProjections": 3, "FinalAngle": 90},
}


def run(folder, *words, code=0):
    done = subprocess.run([COMMAND, *words], cwd=folder, capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    return done.stderr


def read_mha(path, shape):
    data = path.read_bytes()
    return np.frombuffer(data[data.index(b"LOCAL\n") + 6 :], "<f4").reshape(shape)


def values(dataset):
    assert dataset.BitsStored == 16 and dataset.PixelRepresentation == 0
    return dataset.pixel_array * float(dataset.RescaleSlope) + float(dataset.RescaleIntercept)


def check_image(folder, quantity):
    run(folder, "image", "scene.json", "--quantity", quantity, "-o", "a.dcm", "-o", "a.mha")
    picture, right = pydicom.dcmread(folder / "a.dcm"), read_mha(folder / "a.mha", (30, 40))
    # Half a step, and nine digits of slope and intercept.
    assert np.abs(values(picture) - right).max() <= 0.5 * float(picture.RescaleSlope) + 1e-8 * np.abs(right).max()
    assert float(picture.RescaleSlope) <= (right.max() - right.min()) / 65535 * (1 + 1e-7)
    assert (picture.Rows, picture.Columns, picture.Modality) == (30, 40, "CR")
    assert [float(x) for x in picture.PixelSpacing] == [float(x) for x in picture.ImagerPixelSpacing] == [0.25, 0.5]
    assert math.isclose(float(picture.DistanceSourceToDetector), 1000, rel_tol=1e-8)
    assert math.isclose(float(picture.DistanceSourceToPatient), 700, rel_tol=1e-4)
    assert 69 <= float(picture.KVP) <= 70
    assert picture.PhotometricInterpretation == ("MONOCHROME2" if quantity == "attenuation" else "MONOCHROME1")
    # The middle of the ball is shown brighter than the corner.
    low = float(picture.WindowCenter) - 0.5 * float(picture.WindowWidth)
    shown = (values(picture) - low) / float(picture.WindowWidth)
    if picture.PhotometricInterpretation == "MONOCHROME1":
        shown = 1 - shown
    assert shown[15, 20] > 0.9 and shown[0, 0] < 0.1, (quantity, shown[15, 20], shown[0, 0])
    return (folder / "a.dcm").read_bytes()


def check_scan(folder):
    run(folder, "scan", "scene.json", "-o", "s.mha", "--dicom", "films")
    right = read_mha(folder / "s.mha", (3, 30, 40))
    series, instances = set(), set()
    for k in range(3):
        picture = pydicom.dcmread(folder / "films" / f"projection-0000{k}.dcm")
        off = np.abs(values(picture) - right[k]).max()
        assert off <= 0.5 * float(picture.RescaleSlope) + 1e-8 * np.abs(right).max()
        assert picture.InstanceNumber == k + 1
        series.add(picture.SeriesInstanceUID)
        instances.add(picture.SOPInstanceUID)
    assert len(series) == 1 and len(instances) == 3
    assert len(list((folder / "films").iterdir())) == 3


with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    (folder / "scene.json").write_text(json.dumps(SCENE))
    assert check_image(folder, "energy") == check_image(folder, "energy")  # nothing of the day or the process is in it
    check_image(folder, "attenuation")
    check_scan(folder)
    assert "one channel" in run(folder, "image", "scene.json", "--bands", "20,40,70", "-o", "b.dcm", code=5)
    assert "one file" in run(folder, "scan", "scene.json", "-o", "folder", "--dicom", "films", code=2)
    assert "no image format" in run(folder, "image", "scene.json", "-o", "c.mha", "--mean", "c.dcm", code=2)
    left = sorted(p.name for p in folder.iterdir())
    assert left == ["a.dcm", "a.mha", "films", "s.mha", "scene.json"], left
