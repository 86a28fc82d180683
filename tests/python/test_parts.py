"""The table of parts: scene.parts()."""
import json

import pytest

import skiagraph as sk
from skiagraph import _command

SCENE = {
    "Source": {"Position": [0, -900, 0, "mm"], "Shape": "ParallelBeam",
               "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
    "Detector": {"Position": [0, 300, 0, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [50, 50], "Spacing": [1, 1, "mm"]},
    "Samples": [{"Label": "block", "Cuboid": [20, 30, 10, "mm"], "Material": "water"},
                {"Label": "hole", "Cuboid": [10, 6, 4, "mm"], "Material": "Al", "Parent": "block"},
                {"Label": "paint", "Cuboid": [2, 2, 2, "mm"], "Material": ["mu", 0.5],
                 "Transform": [["Translation", 20, 0, 0, "mm"]]}]}


def test_the_table_of_boxes():
    scene = sk.Scene(SCENE)
    assert [part.label for part in scene.parts] == ["block", "hole", "paint"]
    table = scene.parts()
    assert table["energy_keV"] == 60
    block, hole, paint = table["parts"]
    assert block["volume_mm3"] == pytest.approx(20 * 30 * 10 - 10 * 6 * 4, rel=1e-6)
    assert block["mass_g"] == pytest.approx(5.76 * block["density_g_cm3"], rel=1e-6)
    assert hole["mass_g"] == pytest.approx(0.24 * hole["density_g_cm3"], rel=1e-6) and hole["density_g_cm3"] > 2.6
    # rays along y: 200 through the block, of which 40 miss 6 mm of it
    assert block["mean_path_mm"] == pytest.approx((200 * 30 - 40 * 6) / 200, rel=1e-5)
    assert hole["mean_path_mm"] == pytest.approx(6, rel=1e-5)
    assert paint["density_g_cm3"] is None and paint["mass_g"] is None and paint["mean_path_mm"] == pytest.approx(2, rel=1e-5)
    weights = [sk.Material(name).attenuation(60) * length
               for name, length in (("water", 200 * 30 - 40 * 6), ("Al", 40 * 6))] + [0.5 * 4 * 2]
    assert [row["share"] for row in table["parts"]] == pytest.approx([w / sum(weights) for w in weights], rel=1e-5)


def test_the_command_has_the_same_table(tmp_path, command):
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(SCENE))
    scene = sk.Scene(str(path))
    assert scene.parts() == json.loads(_command.run("parts", str(path), "--json"))
    scene.remove("hole")  # the table is that of the scene as it stands
    assert scene.parts()["parts"][0]["volume_mm3"] == pytest.approx(6000, rel=1e-6)
