"""DICOM files of `image` and `scan`, read back by pydicom, which shares nothing with the program that wrote them; and those that
`register` reads, among them what pydicom and DCMTK's compressors make of one."""

import json
import math
import os
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


BODY = {
    **SCENE,
    "Source": {"Position": [0, -700, 0, "mm"], "Shape": "PointSource", "Beam": [{"Energy": 60, "PhotonCount": 1000, "Unit": "keV"}]},
    "Samples": [
        {
            "Label": "body",
            "Cuboid": [7, 3, 2, "mm"],
            "Material": ["mu", 0.5],
            "Transform": [["Translation", 0.5, 0, 0.3, "mm"], ["Rotation", 20, 1, 2, 3]],
        }
    ],
}


def found(folder, file, *words):
    run(folder, "register", "scene.json", "--image", file, "--part", "body", "-o", "found.json", "--quiet", "--json", *words)
    scene = json.loads((folder / "found.json").read_text())
    return np.array(scene["Samples"][0]["Transform"][-1][1:17] if scene["Samples"][0]["Transform"] else [], float)


def written(folder, name, of, stored=None, **attributes):
    """Another file, with other stored values and attributes."""
    picture = pydicom.dcmread(folder / of)
    for key, value in attributes.items():
        if value is None:
            delattr(picture, key)
        else:
            setattr(picture, key, value)
    if stored is not None:
        picture.PixelData = stored.tobytes()
    picture.save_as(folder / name)
    return name


def check_register(folder):
    """Equal values in another file are the same search, but for the rounding of 16 bits."""
    (folder / "truth.json").write_text(json.dumps(BODY))
    BODY["Samples"][0]["Transform"][0][1] = 0.2
    (folder / "scene.json").write_text(json.dumps(BODY))
    run(folder, "image", "truth.json", "--quantity", "attenuation", "-o", "log.mha", "-o", "log.dcm")
    run(folder, "image", "truth.json", "-o", "lin.mha", "-o", "lin.dcm")
    right = found(folder, "log.mha")
    assert right.size and np.isfinite(right).all(), right
    near = {"atol": 2e-3}  # mm: 1/65535 of the attenuation is a 65535th of the body's edge, seen from all its pixels
    assert np.allclose(found(folder, "log.dcm"), right, **near)
    assert np.allclose(found(folder, "lin.dcm", "--flat", "60000"), found(folder, "lin.mha", "--flat", "60000"), **near)
    for program in ("dcmcjpls", "dcmcrle"):
        subprocess.run([program, folder / "log.dcm", folder / f"{program}.dcm"], check=True)
        assert np.array_equal(found(folder, f"{program}.dcm"), found(folder, "log.dcm"))
    # Twelve signed bits in the upper part of a word, and a picture of eight bits.
    picture = pydicom.dcmread(folder / "log.dcm")
    coarse = picture.pixel_array // 16
    shifted = ((coarse.astype(np.int32) - 2048) * 16).astype("<i2")
    signed = {"BitsStored": 12, "HighBit": 15, "PixelRepresentation": 1, "RescaleSlope": float(picture.RescaleSlope) * 16}
    middle = float(picture.RescaleIntercept) + 2048 * 16 * float(picture.RescaleSlope)
    twelve = written(folder, "twelve.dcm", "log.dcm", shifted, RescaleIntercept=float(f"{middle:.9g}"), **signed)
    assert np.allclose(found(folder, twelve), right, atol=0.05)
    bits = {"BitsAllocated": 8, "BitsStored": 8, "HighBit": 7, "RescaleSlope": float(f"{float(picture.RescaleSlope) * 256:.9g}")}
    eight = written(folder, "eight.dcm", "log.dcm", (picture.pixel_array // 256).astype("u1"), **bits)
    assert np.allclose(found(folder, eight), right, atol=0.2)
    check_refusals(folder)


def check_refusals(folder):
    """Refusals of files that give no numbers."""
    def refused(file, *words):
        return run(folder, "register", "scene.json", "--image", file, "--part", "body", "-o", "f.json", *words, code=3)

    assert "to which base" in run(folder, "register", "scene.json", "--part", "body", "-o", "f.json", "--image",
                                  written(folder, "a1.dcm", "log.dcm", Manufacturer="Other"))
    assert "rise with" in refused(written(folder, "a2.dcm", "log.dcm", PixelIntensityRelationshipSign=1, Manufacturer="Other"))
    assert "fall with" in refused(written(folder, "a3.dcm", "lin.dcm", PixelIntensityRelationshipSign=-1))
    assert "in colour" in refused(written(folder, "a4.dcm", "lin.dcm", SamplesPerPixel=3))
    assert "fewer pixels" in refused(written(folder, "a5.dcm", "lin.dcm", np.zeros(600, "<u2")))
    assert "has no Rows" in refused(written(folder, "a6.dcm", "lin.dcm", Rows=None))
    assert "29 x 41" in refused(written(folder, "a7.dcm", "lin.dcm", Rows=41, Columns=29))
    number = (folder / written(folder, "b1.dcm", "lin.dcm", RescaleIntercept="-1024")).read_bytes()
    (folder / "b1.dcm").write_bytes(number.replace(b"-1024 ", b"-1O24 "))
    assert 'RescaleIntercept (0028,1052) says "-1O24' in refused("b1.dcm")
    (folder / "a8.dcm").write_text("no picture")
    assert "no DICOM file" in refused("a8.dcm")
    assert "cannot be read" in refused("a9.dcm")


with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    (folder / "temporary").mkdir()
    os.environ["TMPDIR"] = str(folder / "temporary")
    check_register(folder)
    assert not list((folder / "temporary").iterdir())
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
