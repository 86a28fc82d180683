"""Tables for the rays or pixels of a plan's view are made anew for another view, or the view is refused."""
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


def tube_of(**source):
    """A scene with a heel effect or a bow-tie filter."""
    return sk.Scene({
        "Detector": {"Position": [0, 0, 0, "mm"], "RightVector": [1, 0, 0], "UpVector": [0, 0, -1], "NumberOfPixels": [32, 32],
                     "Spacing": [6.25, 6.25, "mm"]},
        "Source": {"Shape": "PointSource", "Position": [0, -1200, 0, "mm"], "Beam": {"kVp": 100, "mAs": 2, "TubeAngle": 20, "Filter": [["Al", 3, "mm"]]},
                   **source},
        "Samples": [{"Label": "w", "Cube": [50, "mm"], "Material": "Water", "Transform": [["Translation", 0, -200, 0, "mm"]]}]})


BOWTIE = {"Material": "Al", "Direction": [1, 0, 0], "Unit": "mm", "Profile": [[-10, 5], [0, 1], [10, 5]]}


@pytest.mark.parametrize("key, beyond, says", [("Heel", (0, -250, 0), "photons would leave the anode|heel effect"),
                                               ("BowTie", (0, -300, 0), "profile goes from -10 to 10 degrees")])
def test_tubes_of_another_view(key, beyond, says):
    value = {"Heel": {"Direction": [0, 0, 1]}, "BowTie": BOWTIE}[key]
    used, fresh = tube_of(**{key: value}), tube_of(**{key: value})
    used.image("transmission")
    for scene in (used, fresh):
        scene.view = moved(scene.view, (0, -700, 0))
    images = [scene.image("transmission") for scene in (used, fresh)]
    np.testing.assert_allclose(*images, rtol=1e-5)
    used.view = moved(used.view, beyond)
    with pytest.raises(sk.Error, match=says):
        used.image("transmission")
    with pytest.raises(sk.Error, match="make a plan for it|profile goes from"):
        fresh.images("transmission", views=[fresh.view, used.view])


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
    with pytest.raises(sk.Error, match="of which the detector counts .* in the window from 20 keV on, so there is no ratio"):
        scene.image("transmission")


def test_a_window_above_the_beam_is_warned_of():
    with pytest.warns(sk.SkiagraphWarning, match="from 70 keV on counts nothing of the beam"):
        scene_of(Spacing=[0.1, 0.1, "mm"], Counting={"Material": "CdTe", "Thickness": [1, "mm"], "Thresholds": [70]}).image("photons")
    with pytest.raises(sk.ArgumentError, match="give a Counter"):
        scene_of().image("photons", counter="CdTe")


MTF = [[0, 1], [0.5, 0.7], [1, 0.4], [5, 0]]


def pixels_of(scene, mm):
    scene.view = sk.View(source=scene.view.source, detector=scene.view.detector, column_step=(mm, 0, 0), row_step=(0, 0, mm), pixels=(32, 32))


def test_a_modulation_transfer_function_is_of_the_pixels_of_the_file():
    scene, fine = scene_of(Spacing=[0.5, 0.5, "mm"], MTF=MTF), scene_of(Spacing=[0.25, 0.25, "mm"], MTF=MTF)
    ball = sk.Mesh.sphere(1.5, 24)
    for one in (scene, fine):
        one.remove("w")
        one.add("b", ball, material="Al").pose = [[1, 0, 0, 0], [0, 1, 0, -200], [0, 0, 1, 0], [0, 0, 0, 1]]
    there = scene.image("photons")
    pixels_of(scene, 0.25)
    with pytest.raises(sk.SceneError, match=r"\(MTF\) is of pixels of 0.5 x 0.5 mm, those of the view are 0.25 x 0.25 mm; give it for these"):
        scene.image("photons")
    np.testing.assert_allclose(scene.image("photons", blur={"mtf": MTF}), fine.image("photons"), rtol=1e-6)  # places of pixels are rounded
    pixels_of(scene, 0.5)
    np.testing.assert_allclose(scene.image("photons", blur={"mtf": MTF}), there, rtol=1e-6)
    assert not np.array_equal(scene.image("photons", blur=False), there)


def test_line_spread_functions_are_of_any_pixels():
    scene = scene_of(Spacing=[0.5, 0.5, "mm"], LSF=[0.25, 0.5, 0.25])
    pixels_of(scene, 0.25)
    scene.image("photons")


def test_views_of_other_pixels_in_a_batch_are_refused():
    scene = scene_of(Spacing=[0.5, 0.5, "mm"], MTF=MTF)
    there = scene.view
    pixels_of(scene, 0.25)
    fine, scene.view = scene.view, there
    with pytest.raises(sk.SceneError, match="MTF"):
        scene.images("photons", views=[there, fine])


def test_noise_power_is_of_the_pixels_of_the_view():
    dqe = {"MTF": MTF, "DQE": [[0, 0.7], [5, 0.2]]}
    scene, fine = scene_of(Spacing=[0.5, 0.5, "mm"], **dqe), scene_of(Spacing=[0.25, 0.25, "mm"], **dqe)
    scene.image("photons", noise=True, blur={"mtf": MTF})
    pixels_of(scene, 0.25)
    np.testing.assert_array_equal(scene.image("photons", noise=True, blur={"mtf": MTF}, index=0),
                                  fine.image("photons", noise=True, index=0))


@pytest.mark.parametrize("mtf", [[0, 1], [[0, 1, 2]], [[0.5, 1], [5, 0]], [[0, 1], [0.01, 0.5]]])
def test_tables_of_another_shape_are_refused(mtf):
    with pytest.raises(sk.ArgumentError):
        scene_of().image("photons", blur={"mtf": mtf})
