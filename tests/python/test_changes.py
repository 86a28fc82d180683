"""Scenes that are changed at random have the images of new scenes with the same changes: nothing stale is kept. No oracle is needed."""
import random
import warnings

import numpy as np
import pytest

import skiagraph as sk

GRID = {"Ratio": 8, "LinesPerCm": 40, "StripThickness": [0.05, "mm"], "Interspace": "Al", "FocusDistance": [1200, "mm"]}
DETECTOR = {"Grid": GRID, "LSF": [0.2, 0.6, 0.2],
            "Scintillator": {"Material": "CsI", "Thickness": 300, "Unit": "um", "Oblique": True}}
SOURCE = {"Heel": {"Direction": [0, 0, 1]},
          "BowTie": {"Material": "Al", "Direction": [1, 0, 0], "Unit": "mm", "Profile": [[-25, 5], [0, 1], [25, 5]]}}
OPTIONS = {"spot": {"shape": "disc", "extent": 2.0, "samples": 16}, "supersampling": 2, "tolerance": 1e-3, "bands": [10, 40, 110],
           "precision": "double", "collimation": {"kind": "rectangle", "distance_mm": 300, "low": [-20, -20], "high": [25, 15]}}


def some(rng, of):
    return {key: value for key, value in of.items() if rng.random() < 0.3}


def scene_of(rng):
    place = {"Position": [0, 0, 0, "mm"], "RightVector": [1, 0, 0], "UpVector": [0, 0, -1], "NumberOfPixels": [24, 20],
             "Spacing": [6, 6, "mm"]}
    return {"Detector": {**place, **some(rng, DETECTOR)},
            "Source": {"Shape": "PointSource", "Position": [0, -1200, 0, "mm"], **some(rng, SOURCE),
                       "Beam": {"kVp": 100, "mAs": 2, "TubeAngle": 20, "Filter": [["Al", 3, "mm"]]}},
            "Samples": [{"Label": label, "Cube": [side, "mm"], "Material": material, "Transform": [["Translation", *at, "mm"]]}
                        for label, side, material, at in (("large", 50, "Water", [5, -300, 0]), ("small", 10, "Al", [40, -250, 10]))],
            **some(rng, {"World": "Air"})}


def change_of(rng, view):
    """A function of a scene."""
    kind = rng.choice(["view", "view", "pose", "material"])
    if kind == "view":
        source = (rng.uniform(-80, 80), -rng.uniform(800, 1800), rng.uniform(-80, 80))
        centre = view.detector + [rng.uniform(-20, 20), rng.uniform(0, 60), rng.uniform(-20, 20)]
        moved = sk.View(source=source, detector=centre, column_step=view.column_step * rng.choice([1, 0.8]),
                        row_step=view.row_step * rng.choice([1, 1.2]), pixels=view.pixels)
        return lambda scene: setattr(scene, "view", moved)
    if kind == "material":
        material = rng.choice(["Al", "Fe", "Water"])
        return lambda scene: setattr(scene["small"], "material", material)
    pose = np.eye(4)
    pose[:3, 3] = rng.uniform(-50, 50), rng.uniform(-500, -100), rng.uniform(-30, 30)
    return lambda scene: setattr(scene["small"], "pose", pose)


def image_or_sentence(scene, quantity, options):
    try:
        return scene.image(quantity, index=0, **options)
    except sk.Error as error:
        return str(error)


@pytest.mark.parametrize("seed", [*range(8), *(pytest.param(seed, marks=pytest.mark.full) for seed in range(8, 24))])
def test_a_changed_scene_is_as_a_new_one(seed):
    rng = random.Random(seed)
    given, options = scene_of(rng), some(rng, OPTIONS)
    quantity = rng.choice(["energy", "photons", "fluence", "transmission", "attenuation"])
    changes, used = [], sk.Scene(given)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        image_or_sentence(used, quantity, options)
        for _ in range(3):
            changes.append(change_of(rng, used.view))
            changes[-1](used)
            fresh = sk.Scene(given)
            for change in changes:
                change(fresh)
            found, expected = (image_or_sentence(scene, quantity, options) for scene in (used, fresh))
            if isinstance(expected, str):
                assert isinstance(found, str)
                continue
            assert not isinstance(found, str), found
            # Tables of a grid reach a little further than one view's rays; energies are put together for the first view's.
            share = 3e-3 if "tolerance" in options else 1e-4
            np.testing.assert_allclose(found, expected, rtol=0, atol=share * float(expected.max()))
