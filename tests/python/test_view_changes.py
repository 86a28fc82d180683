"""What is tabulated for the rays or pixels of a plan's view is made anew for another view, or the view is refused."""
import numpy as np
import pytest

import skiagraph as sk

GRID = {"Ratio": 12, "LinesPerCm": 40, "StripThickness": [0.05, "mm"], "Interspace": "Al", "FocusDistance": [1200, "mm"]}


def scene_of(**detector):
    return sk.Scene({
        "Detector": {"Position": [0, 0, 0, "mm"], "RightVector": [1, 0, 0], "UpVector": [0, 0, -1], "NumberOfPixels": [32, 32],
                     "Spacing": [12.5, 12.5, "mm"], **detector},
        "Source": {"Shape": "PointSource", "Position": [0, -1200, 0, "mm"], "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
        "Samples": [{"Label": "w", "Cube": [50, "mm"], "Material": "Water", "Transform": [["Translation", 0, -200, 0, "mm"]]}]})


def moved(view, source):
    return sk.View(source=source, detector=view.detector, column_step=view.column_step, row_step=view.row_step, pixels=(32, 32))


@pytest.mark.parametrize("source", [(0, -900, 0), (60, -1200, 0)])
@pytest.mark.parametrize("detector", [{"Grid": GRID}, {"Scintillator": {"Material": "CsI", "Thickness": 300, "Unit": "um", "Oblique": True}}])
def test_another_view_has_tables_of_its_own(source, detector):
    used, fresh = scene_of(**detector), scene_of(**detector)
    used.image("photons" if "Grid" in detector else "energy")
    for scene in (used, fresh):
        scene.view = moved(scene.view, source)
    images = [scene.image("photons" if "Grid" in detector else "energy") for scene in (used, fresh)]
    np.testing.assert_allclose(*images, rtol=1e-5)  # a grid's table may reach a little further than the view's rays


def test_views_beyond_the_tables_are_refused_in_a_batch():
    scene = scene_of(Grid=GRID)
    with pytest.raises(sk.SceneError, match="lean by up to .* across the strips of the grid"):
        scene.images("photons", views=[scene.view, moved(scene.view, (0, -900, 0))])


def test_pixels_that_count_are_those_of_the_table():
    scene = scene_of(Spacing=[0.1, 0.1, "mm"], Counting={"Material": "CdTe", "Thickness": [1, "mm"], "Thresholds": [20]})
    scene.image("photons")
    for steps, says in [(((0.2, 0, 0), (0, 0, 0.2)), "pixels of 0.1 x 0.1 mm, those of the view are 0.2 x 0.2 mm"),
                        (((0.1, 0, 0), (0.06, 0, 0.08)), "are rectangles, and those of the view lean")]:
        scene.view = sk.View(source=scene.view.source, detector=scene.view.detector, column_step=steps[0], row_step=steps[1], pixels=(32, 32))
        with pytest.raises(sk.SceneError, match=says):
            scene.image("photons")


def test_dead_times_that_leave_nothing_of_the_flat_field_have_no_ratio():
    scene = scene_of(Spacing=[0.1, 0.1, "mm"], Counting={"Material": "CdTe", "Thickness": [1, "mm"], "Thresholds": [20], "PileUp": "paralysable",
                                                         "DeadTime": 1e7, "ExposureTime": 0.1})
    with pytest.raises(sk.Error, match="of which a paralysable detector counts none"):
        scene.image("transmission")


def test_a_window_above_the_beam_is_warned_of():
    with pytest.warns(sk.SkiagraphWarning, match="from 70 keV on counts nothing of the beam"):
        scene_of(Spacing=[0.1, 0.1, "mm"], Counting={"Material": "CdTe", "Thickness": [1, "mm"], "Thresholds": [70]}).image("photons")
    with pytest.raises(sk.ArgumentError, match="give a Counter"):
        scene_of().image("photons", counter="CdTe")
