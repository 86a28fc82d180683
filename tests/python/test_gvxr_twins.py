"""Twins of scanners by gVXR's descriptions in JSON5. Those of gVXR itself are read where its wheel is installed."""
import json

import numpy as np
import pytest

import skiagraph as sk
from skiagraph import gvxr
from skiagraph.gvxr.twins import DigitalTwin, beam, json5, utils

DESCRIBED = """{
    // a laboratory and a beamline in one
    name: 'Both "of" them', "description": "", "date": "", facility: "here",
    beams: {
        tube: {beam_type: "tube", shape: "point", kV: [30, 220], uA: [50, 1000], inherent_filteration: [["Be", .5]],
               filters: [["Cu", 0.1, 0.25], ["Al", 1]], flux: {curve: [1e4, 0], x: [], y: [], interpolator: ""},
               target_amperage_table: [[100, 100, 80], [100, 200, 150], [200, 100, 90], [200, 200, 190]]},
        line: {beam_type: "monochromatic", shape: "parallel", keV: [10, 40], flux: {curve: [2, 100]}},
        pink: {beam_type: "fixed-spectrum", shape: "parallel", filters: [], spectrum: [[10, 1e6], [20, 3e6],],},
    },
    detector: {exposures: [0.5, 2.], resolutions: [[0x40, 48], [32, 24]], pixel_pitch: 200, lsf: [],
               scintillator: {material: "CsI", thickness: 600}, gain: {k: 0.5, adus: [1, 4]},
               darkfield: {bias: 3, sigma: 0}},
    /* fixed
       sideways */
    stage: {static_sdd: true, source: {x: [0, 0], y: [0, 1000], z: [0, 0]}, detector: {x: [0, 0], y: [100, 900, 300], z: []}},
}"""


@pytest.fixture(autouse=True)
def fresh():
    gvxr.destroyAllWindows()
    yield
    gvxr.destroyAllWindows()


@pytest.fixture
def twin(tmp_path):
    (tmp_path / "both.json5").write_text(DESCRIBED)
    return DigitalTwin.from_file(tmp_path / "both.json5")


def test_json5():
    assert json5.loads("{a: [1, 0xF, .5, 5., +2, -1e3,], 'b': 'it\\'s \"x\"', // c\n /* d */ $e: null}") == {
        "a": [1, 15, 0.5, 5.0, 2, -1000], "b": 'it\'s "x"', "$e": None}
    assert json5.loads('{"url": "http://a//b", "c": "\\u00e9"}') == json.loads('{"url": "http://a//b", "c": "\\u00e9"}')
    with pytest.raises(ValueError, match="line 2: '@' is no JSON5"):
        json5.loads("{\n@")


def test_a_tube_is_applied(twin):
    assert twin.get_beams() == ["tube", "line", "pink"] and twin.selected_beam == "tube"
    assert (twin.beam.kV, twin.beam.uA, twin.detector.exposure) == (125, 525, 0.5)
    assert twin.source.position == (0, 500, 0) and twin.detector.position == (0, 300, 0) and twin.sdd == 800
    twin.beam.kV, twin.beam.uA, twin.detector.exposure, twin.detector.gain = 150, 150, 2.0, 1
    twin.beam.filter = ["Cu", 0.25]
    twin.sod, twin.odd = 10, 120
    twin.apply()
    assert twin.sdd == 130 and gvxr.getSDD("mm") == 130 and gvxr.getSourceShape().upper().startswith("POINT")
    assert gvxr.getDetectorNumberOfPixels() == (64, 48) and gvxr.getDetectorPixelSpacing("um") == pytest.approx((200, 200))
    assert gvxr.getVoltage("kV") == 150 and gvxr.getmAs() == pytest.approx(127.5 * 0.001 * 2)  # bilinear, by hand
    assert gvxr.getScintillatorMaterial() == "CsI" and gvxr.getScintillatorThickness("um") == pytest.approx(600)
    assert gvxr.getDetectorGain() == 0.5 and gvxr.getDetectorBias() == 3
    assert gvxr.getInherentFiltrationThickness("mm") == pytest.approx((0.5,))
    assert gvxr.getFiltrationThickness("mm") == pytest.approx((0.25,))
    bare = gvxr.getNumberOfPhotonsPerCm2At1m(False)
    twin.beam.filter = []
    twin.apply()  # the layers are set anew, not added
    assert gvxr.getNumberOfPhotonsPerCm2At1m(True) == pytest.approx(1e4 * 150 * 0.255)
    assert gvxr.getNumberOfPhotonsPerCm2At1m(False) == pytest.approx(bare)
    assert gvxr.getInherentFiltrationThickness("mm") == pytest.approx((0.5,)) and gvxr.getFiltrationThickness("mm") == ()


def test_the_other_beams_are_applied(twin):
    assert twin.set_beam("line") and not twin.set_beam("dotted") and twin.selected_beam == "line"
    twin.beam.keV, twin.detector.fov = 20, 1
    twin.apply()
    assert gvxr.getEnergyBins("keV") == pytest.approx((20,)) and gvxr.getDetectorNumberOfPixels() == (32, 24)
    assert gvxr.getNumberOfPhotonsPerCm2At1m() == pytest.approx(140 * 0.5)
    assert twin.set_beam("pink")
    twin.detector.exposure = 2.0
    twin.apply()
    assert gvxr.getPhotonCountsPerCm2At1m() == pytest.approx((2e6, 6e6)) and gvxr.isUsingParallelBeam()


def test_settings_are_checked(twin):
    assert twin.validate() == (False, [])
    twin.beam.kV, twin.beam.uA, twin.detector.exposure, twin.detector.fov, twin.detector.gain = 300, 1, 1.0, 2, -1
    twin.beam.position, twin.detector.position = [3, 0, 0], 50.0
    wrong, found = twin.validate()
    assert wrong and len(found) == 7
    for word in ("kV of 300", "uA of 1", "exposure of 1 s", "fov of 2", "gain of -1", "Beam does not support x", "Detector y"):
        assert any(word in line for line in found), word
    with pytest.raises(ValueError, match="Incorrect Twin Settings:\nkV of 300"):
        twin.apply()
    with pytest.raises(ValueError, match=r"\[material, mm\]"):
        twin.beam.filter = [["Cu", 1, 2]]
    with pytest.raises(ValueError, match="less than the 3 mm"):
        twin.sod = 2


def test_flux_between_points():
    scipy = pytest.importorskip("scipy")
    has_makima = tuple(int(x) for x in scipy.__version__.split(".")[:2]) >= (1, 13)
    made = {name: beam.TwinFlux(x=[10, 20, 40, 50], y=[5, 8, 2, 1], interpolator=name) for name in (
        "CubicSpline", "PchipInterpolator", "Akima1DInterpolator", "Makima1DInterpolator", "BarycentricInterpolator")}
    for name, flux in made.items():
        if name[0] == "M" and not has_makima:
            with pytest.raises(sk.UnsupportedError, match="SciPy 1.13"):
                flux.at(20)
            continue
        assert flux.at(20) == pytest.approx(8), name
    with pytest.raises(ValueError, match="'None' is no interpolator"):
        beam.TwinFlux(x=[1], y=[1], interpolator="None").at(1)


def test_the_list(twin, tmp_path, monkeypatch):
    monkeypatch.setattr(utils, "models", lambda: tmp_path)
    monkeypatch.setattr(utils, "_read", [])
    assert [found["facility"] for found in utils.getDigitalTwinList()] == ["here"]
    assert utils.createDigitalTwin(id=0) == utils.createDigitalTwin(name='BOTH "OF" THEM') == twin
    with pytest.raises(ValueError, match="either"):
        utils.createDigitalTwin()
    with pytest.raises(ValueError, match="the twins are 0 'Both"):
        utils.createDigitalTwin(name="DIAD")
    assert utils.getFilterMaterial(twin, "tube") == ["None", "Cu", "Al"]
    assert utils.getFilterThickness(twin, "tube", "Cu") == ["0.0", "0.1", "0.25"]


def test_the_twins_of_gvxr():
    pytest.importorskip("scipy", minversion="1.13")
    try:
        described = utils.getDigitalTwinList()
    except FileNotFoundError as missing:
        assert "skiagraph.gvxr.dragon" in str(missing)
        pytest.skip("gVXR's descriptions are not here")
    for at in range(len(described)):
        twin = utils.createDigitalTwin(id=at)
        for name in twin.get_beams():
            twin.set_beam(name)
            twin.detector.fov = 0
            for resolution in twin.specification.detector.resolutions:
                resolution[:] = [8, 8]
            twin.apply(disable_validation=True)
            assert np.isfinite(gvxr.getNumberOfPhotons()) and gvxr.getNumberOfPhotons() > 0
