"""The JSON Schema of scene files says what reading says."""
import json
import pathlib
import re

import pytest

import skiagraph as sk
from skiagraph._library import ffi, lib
from skiagraph._source import Source

jsonschema = pytest.importorskip("jsonschema", reason="no jsonschema (python3-jsonschema)")
ROOT = pathlib.Path(__file__).parents[2]
SCHEMA = sk.Scene.schema()
CHECKER = jsonschema.Draft202012Validator(SCHEMA)

TUBE = {"kVp": 100, "Filter": [["Al", 2.5, "mm"]], "TubeAngle": 12}
SOURCE = {"Position": [0, -400, 0, "mm"], "Shape": "Point", "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 100}]}
DETECTOR = {"Position": [0, 100, 0, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [8, 6], "Size": [80, 60, "mm"]}
CUBE = {"Label": "cube", "Cube": [20, "mm"], "Material": "Water", "Transform": [["Rotation", 30, 0, 0, 1]]}


def scene(**keys):
    return {"Source": SOURCE, "Detector": DETECTOR, "Samples": [CUBE], **keys}


# Together they have every object that the schema knows; a new one needs a place here.
BASES = [
    scene(World={"Material": "Air"}, Noise={"Quantum": True, "Electronic": [1, "keV"]}, Scatter={"Tolerance": 0.05},
          Collimation={"Rectangle": [[-9, 9], [-9, 9], "mm"], "Distance": [200, "mm"]}, Repair=["exact", "union"]),
    scene(Source=dict(SOURCE, Beam=TUBE, Heel={"Direction": [1, 0, 0]}, Bowtie={"Material": "Al", "Profile": [[-20, 9], [0, 1], [20, 9]]})),
    scene(Detector=dict(DETECTOR, Grid={"Ratio": 8, "LinesPerCm": 40, "StripThickness": [0.05, "mm"]},
                        Scintillator={"Material": "CsI", "Thickness": 600, "Unit": "um", "Depths": [{"To": 1, "LSF": [0.1, 0.8, 0.1]}]})),
    scene(Detector=dict(DETECTOR, Counting={"Material": "CdTe", "Thickness": [1, "mm"], "Thresholds": [20, 50]})),
    scene(Detector=dict(DETECTOR, EnergyResponse={"PulseHeights": {"Heights": [10, 40], "Rows": [[40, 0.2, 0.5], [80, 0, 1]]}})),
    scene(Detector=dict(DETECTOR, GreyValues={"Full": 50000, "BadPixels": {"Path": "bad.raw", "Format": "uint8"}})),
    scene(Samples=[{"Label": "steps", "StepWedge": {"NumberOfSteps": 5, "TotalLength": 50, "Width": 20, "FirstStepHeight": 5,
                                                    "OtherStepHeight": 5, "Unit": "mm"}, "Material": ["mu", 0.2]}]),
    scene(Scan={"NumberOfProjections": 4, "FinalAngle": 360, "Drift": {"Source": [1, 0, 0, "mm"]}, "Jitter": {"Seed": 2},
                "Flats": {"Number": 2}, "Darks": {"Number": 1}}),
    scene(Source=dict(SOURCE, Shape=["Disc", 1, "mm"], OffFocal={"Share": 0.1, "Diameter": [20, "mm"]},
                      Beam={"TextFile": "beam.txt", "Unit": "keV"}),
          Samples=[{"Label": "box", "Path": "box.obj", "Unit": "mm", "Material": "Water"}]),
    scene(Source=dict(SOURCE, Beam={"Bins": [[60, 100]]}),
          Detector=dict(DETECTOR, Curved={"Radius": [1000, "mm"], "Axis": "columns"})),
    {"Source": {"From": "LAO 30", "SOD": [700, "mm"], "SDD": [1000, "mm"], "Beam": SOURCE["Beam"]}, "Samples": [CUBE]},
    scene(Samples=[{"Label": "ct", "Volume": "ct.mha", "Values": "HU", "Classes": [[-1000, "Air"], [-400, "Water"]], "Interpolation": "linear"}]),
    scene(Breathing={"Organs": {"cube": {"Kind": "Deformable", "Links": [{"To": "rib", "Distance": [15, "mm"]}]}},
                     "Events": [{"Hold": [1, 2]}], "Fit": {"Parameters": ["tendon"]}}),
]


@pytest.fixture(autouse=True)
def _files(tmp_path, monkeypatch):
    (tmp_path / "bad.raw").write_bytes(bytes(48))
    (tmp_path / "ct.mha").write_bytes(b"ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementSpacing = 9 9 9\nElementType = MET_SHORT\n"
                                      b"ElementByteOrderMSB = False\nElementDataFile = LOCAL\n" + bytes(16))
    (tmp_path / "beam.txt").write_text("60 100\n")
    (tmp_path / "box.obj").write_text("v -9 -9 -9\nv 9 -9 -9\nv -9 9 -9\nv -9 -9 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
    monkeypatch.chdir(tmp_path)


def refusal(text, folder="."):
    """The message with which reading refuses a scene; None: it is read."""
    try:
        setup = Source(json.dumps(text).encode(), str(pathlib.Path(folder) / "scene.json"), False, []).load(ffi.NULL)
    except sk.Error as error:
        return str(error)
    pointer = ffi.new("skg_setup **", setup)
    lib.skg_setup_release(pointer)
    return None


def places(schema, value, path=()):
    """Where in a scene each object of the schema stands: its name, and the path to it."""
    while "$ref" in schema:
        name = schema["$ref"].removeprefix("#/$defs/")
        schema = SCHEMA["$defs"][name]
        if isinstance(value, dict) and "properties" in schema:
            yield name, path
    for one in schema.get("anyOf", []):
        yield from places(one, value, path)
    if isinstance(value, dict):
        for key, its in value.items():
            if key in schema.get("properties", {}):
                yield from places(schema["properties"][key], its, (*path, key))
            elif isinstance(schema.get("additionalProperties"), dict):
                yield from places(schema["additionalProperties"], its, (*path, key))
    for i, its in enumerate(value if isinstance(value, list) and "items" in schema else []):
        yield from places(schema["items"], its, (*path, i))


def changed(text, path, key, value):
    """A copy in which the object at a path has another value."""
    copy = json.loads(json.dumps(text))
    place = copy
    for step in path:
        place = place[step]
    place[key] = value
    return copy


ALL: dict = {}
for _base in BASES:
    for _name, _path in places(SCHEMA, _base):
        ALL.setdefault(_name, []).append((_base, _path))


def test_the_schema_is_one():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    assert set(ALL) == {name for name, its in SCHEMA["$defs"].items() if "properties" in its}


@pytest.mark.parametrize("number", range(len(BASES)))
def test_these_scenes_are_right(number):
    assert refusal(BASES[number]) is None
    CHECKER.validate(BASES[number])


def written_scenes():
    for folder in ("examples/scenes", "tests/fuzz/corpus/scene", "bench/hashes", "bench/mc"):
        for path in sorted((ROOT / folder).glob("*.json")):
            yield path.parent, path.read_text(encoding="utf-8", errors="replace")
    for page in sorted((ROOT / "docs").glob("*.md")):
        for block in re.findall(r"^```json\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S):
            yield page.parent, block


def test_what_is_read_is_valid():
    checked = 0
    for folder, text in written_scenes():
        try:
            value = json.loads(text)
        except ValueError:
            continue
        if not isinstance(value, dict) or "Source" not in value:
            continue
        errors = [error.message for error in CHECKER.iter_errors(value)]
        if errors:
            assert refusal(value, folder) is not None, (text, errors)
        checked += not errors
    assert checked >= 15


@pytest.mark.parametrize("name", sorted(ALL))
def test_each_key_refuses_what_it_is_not(name):
    """In one of the places where the object stands: beside other keys it may have no meaning."""
    for key, form in SCHEMA["$defs"][name]["properties"].items():
        wrong = 17 if "additionalProperties" in form else {"no such key": []}
        broken = [changed(base, path, key, wrong) for base, path in ALL[name]]
        if form.get("$ref") == "#/$defs/any" or key == "$schema":  # read over
            continue
        assert not any(CHECKER.is_valid(one) for one in broken), (name, key)
        assert any(refusal(one) is not None for one in broken), (name, key)


@pytest.mark.parametrize("name", sorted(ALL))
def test_unknown_keys_are_refused(name):
    base, path = ALL[name][0]
    broken = changed(base, path, "NoSuchKeyAtAll", 1)
    assert not CHECKER.is_valid(broken)
    assert "unknown key" in refusal(broken)
    assert CHECKER.is_valid(changed(base, path, "comment", "anything"))


def test_limits_are_those_of_reading():
    """Beyond each limit of a number both refuse; on it reading may still have reasons of its own."""
    tried = 0
    for name, places_of in ALL.items():
        for key, form in SCHEMA["$defs"][name]["properties"].items():
            for limit, step in (("minimum", -1), ("maximum", 1), ("exclusiveMinimum", 0), ("exclusiveMaximum", 0)):
                if limit not in form:
                    continue
                broken = [changed(base, path, key, form[limit] + step) for base, path in places_of]
                assert not any(CHECKER.is_valid(one) for one in broken), (name, key)
                assert any(refusal(one) is not None for one in broken), (name, key, form[limit] + step)
                tried += 1
    assert tried > 60


def test_spellings_are_those_of_reading():
    for key in ("number of pixels", "Number_Of-Pixels", "NUMBEROFPIXELS"):
        base = changed(BASES[0], ("Detector",), key, [8, 6])
        del base["Detector"]["NumberOfPixels"]
        assert CHECKER.is_valid(base) and refusal(base) is None
    assert CHECKER.is_valid(scene(Precision="Double")) and refusal(scene(Precision="Double")) is None
    assert not CHECKER.is_valid(scene(Precision="triple")) and refusal(scene(Precision="triple"))


def test_each_key_is_explained():
    page = (ROOT / "docs/scene-files.md").read_text(encoding="utf-8")
    keys = {key for table in SCHEMA["$defs"].values() for key in table.get("properties", {})}
    keys = {key.replace("Center", "Centre").replace("center", "centre").replace("Color", "Colour") for key in keys}
    missing = {key for key in keys if f"`{key}`" not in page and f'"{key}"' not in page}
    assert not missing, sorted(missing)


def test_saved_scenes_name_the_schema(tmp_path):
    sk.Scene(BASES[0]).save(tmp_path / "saved.json")
    saved = json.loads((tmp_path / "saved.json").read_text())
    assert saved["$schema"] == "scene.schema.json"
    CHECKER.validate(saved)
