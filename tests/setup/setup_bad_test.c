/* Every way in which a scene file can be wrong, and the sentence that says so. */
#include "setup/setup_files.h"

static const struct {
    const char *setting;
    skg_status status;
    const char *says;
} bad_settings[] = {
    {"Detector", SKG_ERR_ARGUMENT, "KEY=VALUE"},
    {"=5", SKG_ERR_ARGUMENT, "KEY=VALUE"},
    {"Detector..Size=5", SKG_ERR_ARGUMENT, "a key is empty"},
    {"Samples.livre.Type=inner", SKG_ERR_ARGUMENT, "\"livre.Type\" is neither"},
    {"Samples.2.Type=inner", SKG_ERR_ARGUMENT, "0 to 1"},
    {"Source.Shape.x=1", SKG_ERR_ARGUMENT, "nothing inside"},
    {"Detector.Sise=[1, 1, \"mm\"]", SKG_ERR_FORMAT,
     "scene.json: Detector.Sise: unknown key; did you mean Size"},
    {"Detector.Size=[1, 1]", SKG_ERR_FORMAT, "scene.json: Detector.Size: has no unit"},
    {"Detector.Size=big", SKG_ERR_FORMAT, "is a string"},
    {"Detector.Size=3", SKG_ERR_FORMAT, "is a number"},
    {"Detector.Size=true", SKG_ERR_FORMAT, "is true"},
    {"Detector.Size=false", SKG_ERR_FORMAT, "is false"},
    {"Detector.Size={}", SKG_ERR_FORMAT, "is an object"},
    {"Detector.UpVector=null", SKG_ERR_FORMAT, "UpVector"},
    {"Detector.UpVector.0=[1]", SKG_ERR_FORMAT, "is an array"},
};

START_TEST(bad_settings_are_refused) {
    const char *const settings[] = {bad_settings[_i].setting};
    write_file("scene.json", good);
    ck_skg_fails(skg_setup_load(NULL, path, 1, settings, &setup), bad_settings[_i].status,
                 bad_settings[_i].says);
    ck_assert_ptr_null(setup);
}
END_TEST

static const struct {
    const char *from, *to;
    skg_status status;
    const char *says;
} bad_files[] = {
    /* JSON */
    {"    ]\n}\n", "    ]\n", SKG_ERR_FORMAT, "scene.json: line 25, column 0: "},
    {"\"Shape\":", "\"Shape\"", SKG_ERR_FORMAT, "line 5, column "},
    {"{\n    \"Window", "[{\n    \"Window", SKG_ERR_FORMAT, "line "},
    {"\"Label\": \"bone\",", "\"Label\": \"bone\", \"Label\": \"b\",", SKG_ERR_FORMAT, "duplicate"},
    /* keys */
    {"\"Material\": [\"mu\", 0.5]", "\"Materail\": [\"mu\", 0.5]", SKG_ERR_FORMAT,
     "scene.json: line 22: Samples[1].Materail: unknown key; did you mean Material"},
    {"\"Window size\"", "\"Windowsise\"", SKG_ERR_FORMAT, "line 2: Windowsise: unknown key"},
    {"\"Shape\"", "\"Zebra\"", SKG_ERR_FORMAT, "line 5: Source.Zebra: unknown key"},
    {"\"Energy\"", "\"Enrgy\"", SKG_ERR_FORMAT,
     "line 6: Source.Beam[0].Enrgy: unknown key; did you mean Energy"},
    {"\"Label\": \"bone\",", "\"Label\": \"bone\", \"label\": \"b\",", SKG_ERR_FORMAT, "twice"},
    {"\"Cuboid\": [1, 2, 3, \"cm\"]", "\"Cuboid\": [1, 2, 3, \"cm\"], \"Parallelepiped\": [1, 2, 3, \"cm\"]",
     SKG_ERR_FORMAT, "twice"},
    {"\"Samples\"", "\"SceneGraph\": {}, \"Samples\"", SKG_ERR_FORMAT, "SceneGraph: has no shape"},
    {"\"Samples\"", "\"SceneGraph\": \"a.dae\", \"Samples\"", SKG_ERR_FORMAT, "SceneGraph: is a string"},
    {"\"Samples\"", "\"Breathing\": {\"Frequency\": 0.25}, \"Samples\"", SKG_ERR_FORMAT, "Frequency"},
    {"\"Samples\"", "\"Noise\": {\"Swank\": 2}, \"Samples\"", SKG_ERR_FORMAT, "Noise.Swank: is 2"},
    {"\"Samples\"", "\"Noise\": {\"Step\": [-1, \"keV\"]}, \"Samples\"", SKG_ERR_FORMAT, "Step[0]: is -1"},
    {"\"Samples\"", "\"Noise\": {\"Electronics\": 1}, \"Samples\"", SKG_ERR_FORMAT, "Electronic"},
    {"\"UpVector\"", "\"LSF\": [1, 1], \"UpVector\"", SKG_ERR_FORMAT, "LSF: has 2 samples"},
    {"\"UpVector\"", "\"LSF\": [[1], [1], [1]], \"UpVector\"", SKG_ERR_FORMAT, "has 3 lists"},
    {"\"UpVector\"", "\"PSF\": [[1], [1, 2], [1]], \"UpVector\"", SKG_ERR_FORMAT, "PSF[1]"},
    {"\"UpVector\"", "\"LSF\": [1], \"PSF\": [[1]], \"UpVector\"", SKG_ERR_FORMAT, "not both"},
    {"\"PointSource\"", "[\"FocalSpot\", 1, \"mm\"]", SKG_ERR_FORMAT, "write it like"},
    {"\"PointSource\"", "[\"Dics\", 1, \"mm\"]", SKG_ERR_FORMAT, "Disc"},
    {"\"PointSource\"", "[\"Disc\", 1, \"mm\"], \"OffFocal\": {\"Share\": 0.1}", SKG_ERR_FORMAT, "Diameter"},
    {"\"PointSource\"", "[\"Disc\", 1, \"mm\"], \"OffFocal\": {\"Share\": 1.5, \"Diameter\": [9, \"mm\"]}",
     SKG_ERR_FORMAT, "above 0, below 1"},
    {"\"PointSource\"", "[\"Disc\", 1, \"mm\"], \"OffFocal\": {\"Share\": 0.1, \"Diameter\": [0, \"mm\"]}",
     SKG_ERR_FORMAT, "no diameter"},
    {"\"PointSource\"", "[\"Disc\", -1, \"mm\"]", SKG_ERR_FORMAT, "no size"},
    {"\"PointSource\"", "[\"Disc\", 1, \"mn\"]", SKG_ERR_FORMAT, "mn"},
    {"\"UpVector\"", "\"Oversampling\": 17, \"UpVector\"", SKG_ERR_FORMAT, "17"},
    {"\"Opacity\": 0.4", "\"Priority\": 0.5", SKG_ERR_FORMAT, "Priority"},
    {"\"Samples\"", "\"Repair\": \"neighbors\", \"Samples\"", SKG_ERR_FORMAT, "did you mean neighbours"},
    /* missing */
    {"\"Samples\": [", "\"Scan\": {}, \"Window_Size\": [", SKG_ERR_FORMAT, "Samples is missing"},
    {"\"Position\": [0, -40, 0, \"cm\"],", "", SKG_ERR_FORMAT, "Source: Position is missing"},
    {"\"Unit\": \"MeV\", ", "", SKG_ERR_FORMAT, "Source.Beam[0]: Unit is missing"},
    {"\"UpVector\": [0, 0, -1],", "", SKG_ERR_FORMAT, "Detector: UpVector is missing"},
    {"\"NumberOfPixels\": [64, 48],", "", SKG_ERR_FORMAT, "NumberOfPixels is missing"},
    {"\"Size\": [6.4, 9.6, \"cm\"]", "\"LSF\": null", SKG_ERR_FORMAT, "Detector: Size is missing"},
    {"\"Cuboid\": [1, 2, 3, \"cm\"],", "", SKG_ERR_FORMAT, "Samples[1]: has no shape"},
    {"\"Material\": [\"mu\", 0.5]", "\"Opacity\": 1", SKG_ERR_FORMAT, "Material is missing"},
    {"[{\"Energy\": 0.06, \"Unit\": \"MeV\", \"PhotonCount\": 1000}]", "[]", SKG_ERR_BEAM, "has no energy"},
    {"[{\"Energy\": 0.06, \"Unit\": \"MeV\", \"PhotonCount\": 1000}]", "{}", SKG_ERR_FORMAT,
     "describes no beam"},
    /* kinds */
    {"\"Samples\"", "\"Source2\": 1, \"Samples\"", SKG_ERR_FORMAT, "unknown key; did you mean Source"},
    {"[0, -40, 0, \"cm\"]", "\"origin\"", SKG_ERR_FORMAT, "Source.Position: is a string; give [0"},
    {"[0, -40, 0, \"cm\"]", "[0, -40, 0]", SKG_ERR_FORMAT, "Source.Position: has no unit"},
    {"[0, -40, 0, \"cm\"]", "[0, -40, \"cm\"]", SKG_ERR_FORMAT, "Source.Position"},
    {"[0, -40, 0, \"cm\"]", "[0, \"-40\", 0, \"cm\"]", SKG_ERR_FORMAT,
     "Source.Position[1]: is a string; give a number"},
    {"[0, -40, 0, \"cm\"]", "[0, -40, 0, \"cmm\"]", SKG_ERR_FORMAT,
     "Source.Position[3]: \"cmm\" is no unit of length; did you mean mm"},
    {"[0, -40, 0, \"cm\"]", "[0, -40, 0, 10]", SKG_ERR_FORMAT,
     "Source.Position[3]: is a number; give a string"},
    {"\"PointSource\"", "7", SKG_ERR_FORMAT, "Source.Shape: is a number; give a string"},
    {"\"PointSource\"", "\"PointSorce\"", SKG_ERR_FORMAT,
     "\"PointSorce\" is no shape of a source; did you mean PointSource"},
    {"\"PointSource\"", "[\"Spot\"]", SKG_ERR_FORMAT, "Source.Shape[0]"},
    {"\"PointSource\"", "[]", SKG_ERR_FORMAT, "Source.Shape[0]: is missing"},
    {"\"MeV\"", "\"MV\"", SKG_ERR_FORMAT, "Source.Beam[0].Unit: \"MV\" is no unit of energy"},
    {"\"Energy\": 0.06", "\"Energy\": \"60\"", SKG_ERR_FORMAT, "Energy: is a string"},
    {"[{\"Energy\"", "[5, {\"Energy\"", SKG_ERR_FORMAT, "Source.Beam[0]: is a number"},
    {"{\"Energy\": 0.06, \"Unit\": \"MeV\", \"PhotonCount\": 1000}", "5", SKG_ERR_FORMAT,
     "Source.Beam[0]: is a number; give an object"},
    {"[0, 0, -1]", "[0, 0]", SKG_ERR_FORMAT, "UpVector: has 2 elements instead of 3"},
    {"[0, 0, -1]", "[0, 0, 0]", SKG_ERR_FORMAT, "no direction"},
    {"[64, 48]", "[64]", SKG_ERR_FORMAT, "has 1 elements instead of 2"},
    {"[64, 48]", "[64.5, 48]", SKG_ERR_FORMAT, "NumberOfPixels[0]: is 64.5; give a whole number"},
    {"[64, 48]", "{}", SKG_ERR_FORMAT, "NumberOfPixels: is an object"},
    {"\"Label\": \"bone\"", "\"Label\": 5", SKG_ERR_FORMAT, "Label: is a number; give a string"},
    {"\"outer\"", "\"outre\"", SKG_ERR_FORMAT, "no type of a sample; did you mean outer"},
    {"[\"mu\", 0.5]", "0.5", SKG_ERR_FORMAT, "Material: is a number; give [\"mu\""},
    {"[\"mu\", 0.5]", "[\"mu\"]", SKG_ERR_FORMAT, "has 1 elements"},
    {"[\"mu\", 0.5]", "[\"nu\", 0.5]", SKG_ERR_FORMAT, "\"nu\" is no kind of material"},
    {"[\"mu\", 0.5]", "[\"mu\", \"much\"]", SKG_ERR_FORMAT, "is no number"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Density\": \"1\"", SKG_ERR_FORMAT, "Density: is a string"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"FlipNormals\": \"yes\"", SKG_ERR_FORMAT,
     "FlipNormals: is a string; give true or false"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"MoveToCentre\": 3", SKG_ERR_FORMAT, "MoveToCentre: is 3"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Parent\": 0", SKG_ERR_FORMAT, "Parent: is a number"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Cube\": [1, \"mm\"]", SKG_ERR_FORMAT, "has both Cube and Cuboid"},
    {"[1, 2, 3, \"cm\"]", "[1, 2, \"cm\"]", SKG_ERR_FORMAT, "has 3 elements instead of 4"},
    {"\"Cuboid\": [1, 2, 3, \"cm\"]", "\"Cylinder\": [2.5, 30, 4, \"mm\"]", SKG_ERR_FORMAT, "whole number"},
    {"\"Cuboid\": [1, 2, 3, \"cm\"]", "\"Cylinder\": [2, 30, 4, \"mm\"]", SKG_ERR_FORMAT, "give 3 to"},
    {"\"Cuboid\": [1, 2, 3, \"cm\"]", "\"Cuboid\": [1, 2, 3, \"cm\"], \"Unit\": \"m\"", SKG_ERR_FORMAT,
     "Unit is for files, and a Cuboid has none: its unit stands with its lengths"},
    {"\"Cuboid\": [1, 2, 3, \"cm\"]", "\"Cuboid\": [1, 2, 3, \"cm\"], \"Group\": \"a\"", SKG_ERR_FORMAT,
     "Group is for files, and a Cuboid has none; leave it out"},
    {"\"Cuboid\": [1, 2, 3, \"cm\"]", "\"StepWedge\": [1]", SKG_ERR_FORMAT,
     "StepWedge: is an array; give an object"},
    {"\"Cuboid\": [1, 2, 3, \"cm\"]", "\"StepWedge\": {\"NumberOfSteps\": 3}", SKG_ERR_FORMAT,
     "Unit is missing"},
    {"    ]\n}", "    , 5]\n}", SKG_ERR_FORMAT, "Samples[2]: is a number; give an object"},
    {"    ]\n}", "    , \"MoveToCenter!\"]\n}", SKG_ERR_FORMAT, "Samples[2]: \"MoveToCenter!\""},
    {"\"Samples\"", "\"Precision\": \"quad\", \"Samples\"", SKG_ERR_FORMAT, "known: single, double"},
    {"\"Samples\"", "\"Precision\": 2, \"Samples\"", SKG_ERR_FORMAT, "Precision: is a number"},
    {"\"Samples\"", "\"Tolerance\": -1, \"Samples\"", SKG_ERR_FORMAT, "Tolerance: is -1"},
    {"\"Samples\"", "\"Tolerance\": [1], \"Samples\"", SKG_ERR_FORMAT, "Tolerance: is an array"},
    {"\"Samples\"", "\"File format version\": [2, 0, 0], \"Samples\"", SKG_ERR_UNSUPPORTED, "version 2"},
    {"\"Samples\"", "\"Scan\": [], \"Samples\"", SKG_ERR_FORMAT, "Scan: is an array"},
    {"\"Samples\"", "\"Scan\": {\"AngleStep\": \"1\"}, \"Samples\"", SKG_ERR_FORMAT,
     "Scan.AngleStep: is a string"},
    {"\"Samples\"", "\"Scan\": {\"NumberOfProjections\": 0}, \"Samples\"", SKG_ERR_FORMAT,
     "NumberOfProjections: is 0"},
    {"\"Samples\"", "\"Scan\": {\"OutFolder\": 1}, \"Samples\"", SKG_ERR_FORMAT, "OutFolder: is a number"},
    {"\"Samples\"", "\"Scan\": {\"RotationAxis\": [0, 0, 0]}, \"Samples\"", SKG_ERR_FORMAT, "no direction"},
    {"\"Samples\"", "\"Scan\": {\"CentreOfRotation\": [0, 0]}, \"Samples\"", SKG_ERR_FORMAT,
     "CentreOfRotation: has 2"},
    /* what cannot be imaged */
    {"\"PhotonCount\": 1000", "\"PhotonCount\": -5", SKG_ERR_BEAM, "Source.Beam[0]: -5 photons"},
    {"\"Energy\": 0.06", "\"Energy\": 21", SKG_ERR_BEAM, "Source.Beam[0]: a photon energy of 21000 keV"},
    {"\"Energy\": 0.06", "\"Energy\": 0", SKG_ERR_BEAM, "a photon energy of 0 keV"},
    {"[64, 48]", "[0, 48]", SKG_ERR_SCENE, "line 8: Detector: the detector has 0 columns"},
    {"[64, 48]", "[64, -48]", SKG_ERR_SCENE, "-48 rows"},
    {"[64, 48]", "[64, 1000000]", SKG_ERR_SCENE, "1 to 32768"},
    {"[64, 48]", "[64, 1e300]", SKG_ERR_FORMAT, "NumberOfPixels[1]"},
    {"[6.4, 9.6, \"cm\"]", "[0, 9.6, \"cm\"]", SKG_ERR_SCENE, "Detector.Size: the detector has no size"},
    {"[6.4, 9.6, \"cm\"]", "[6.4, -9.6, \"cm\"]", SKG_ERR_SCENE, "no size"},
    {"[6.4, 9.6, \"cm\"]", "[1e200, 1e200, \"km\"]", SKG_ERR_SCENE, "too large"},
    {"\"Size\": [6.4, 9.6, \"cm\"]", "\"Size\": [6.4, 9.6, \"cm\"], \"Spacing\": [1, 1, \"mm\"]",
     SKG_ERR_FORMAT, "Size is 64 x 96 mm, but Spacing and NumberOfPixels make 64 x 48 mm"},
    {"[0, 0, -1]", "[0, 0, -1], \"RightVector\": [0, 0, 3]", SKG_ERR_SCENE, "must not be parallel"},
    {"[0, 0, -1]", "[0, 1, 0]", SKG_ERR_SCENE, "Detector.UpVector: points along the beam"},
    {"[0, -40, 0, \"cm\"]", "[0, 10, 0, \"cm\"], \"Shape2\": 1", SKG_ERR_FORMAT, "did you mean Shape"},
    {"\"Position\": [0, 100, 0, \"mm\"],", "\"Position\": [0, -400, 0, \"mm\"],", SKG_ERR_SCENE,
     "Detector: the source (0, -400, 0) mm lies on the detector"},
    {"[0, -40, 0, \"cm\"]", "[0, -1e300, 0, \"km\"]", SKG_ERR_SCENE,
     "Detector: the source's position has an entry of -1e+306 mm, which is too large"},
    {"\"Position\": [0, 100, 0, \"mm\"],", "\"Position\": [0, -400, 0, \"mm\"], \"RightVector\": [1, 0, 0],",
     SKG_ERR_SCENE, "lies on the detector"},
    {"\"UpVector\": [0, 0, -1]", "\"UpVector\": [0, 0, -1], \"RightVector\": [0, 1, 0]", SKG_ERR_SCENE,
     "in its plane"},
    {"\"Shape\": \"PointSource\"", "\"Shape\": \"PointSource\", \"Direction\": [0, 1, 0]", SKG_ERR_FORMAT,
     "only a parallel beam"},
    {"\"Shape\": \"PointSource\"", "\"Shape\": \"Parallel\", \"Direction\": [0, 1, 0]", SKG_ERR_FORMAT,
     "not both"},
    {"[\"mu\", 0.5]", "[\"mu\", -0.5]", SKG_ERR_MATERIAL, "Samples[1].Material[1]: bone: "},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Density\": 0", SKG_ERR_MATERIAL, "Density: is 0"},
    {"\"Label\": \"bone\"", "\"Label\": \"\"", SKG_ERR_SCENE, "empty label"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Parent\": \"bone\"", SKG_ERR_SCENE,
     "Samples[1].Parent: part bone lies inside itself"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Parent\": \"skni\"", SKG_ERR_SCENE,
     "no part has the label skni; did you mean skin"},
    {"\"Type\": \"outer\",", "\"Type\": \"inner\", \"Parent\": \"none\",", SKG_ERR_SCENE,
     "no part has the label none"},
    {"\"Type\": \"outer\"", "\"Type\": \"outer\", \"Parent\": \"bone\"", SKG_ERR_SCENE, "circle"},
    {"    ]\n}",
     "    , {\"Label\": \"o2\", \"Cube\": [9, \"mm\"], \"Type\": \"outer\", \"Material\": [\"mu\", 1]}]\n}",
     SKG_ERR_SCENE, "Samples[1]: there are 2 outer samples"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Transform\": [[\"Scaling\", 1, 0, 1]]", SKG_ERR_SCENE,
     "Samples[1].Transform[0]: a scaling by 0"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Transform\": [[\"Matrix\", [1,0,0,0, 0,1,0,0, 1,1,0,0, 0,0,0,1]]]",
     SKG_ERR_SCENE, "Samples[1]: part bone: its pose is singular"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Transform\": [[\"Matrix\", [1,0,0,5, 0,1,0,6, 0,0,1,7, 0,0,0,1]]]",
     SKG_ERR_SCENE, "column by column"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Transform\": [[\"Matrix\", [1, 0, 0]]]", SKG_ERR_FORMAT,
     "has 3 elements instead of 16"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Transform\": [[\"Rotation\", 90, 0, 0, 0]]", SKG_ERR_SCENE,
     "axis of a rotation"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Transform\": [[\"Rotation\", 90, 0, 0]]", SKG_ERR_FORMAT,
     "has 4 elements; give [\"Rotation\", degrees"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Transform\": [[\"Rotate\", 90, 0, 0, 1]]", SKG_ERR_FORMAT,
     "no transformation; did you mean Rotation"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Transform\": [\"Scaling\", 1, 1, 2]", SKG_ERR_FORMAT,
     "Transform[0]: is a string"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Transform\": {}", SKG_ERR_FORMAT, "Transform: is an object"},
    {"[\"mu\", 0.5]", "[\"mu\", 0.5], \"Transform\": [[\"Translation\", 1, 2, 3, \"ich\"]]", SKG_ERR_FORMAT,
     "Transform[0][4]: \"ich\" is no unit"},
    {"[1, 2, 3, \"cm\"]", "[1, -2, 3, \"cm\"]", SKG_ERR_FORMAT, "Samples[1].Cuboid: "},
    {"\"Cuboid\": [1, 2, 3, \"cm\"]",
     "\"StepWedge\": {\"NumberOfSteps\": 5, \"TotalLength\": 5, \"Width\": 2, \"FirstStepHeight\": 1, "
     "\"OtherStepHeight\": 0, \"Unit\": \"cm\"}",
     SKG_ERR_FORMAT, "heights have to rise"},
    {"\"Cuboid\": [1, 2, 3, \"cm\"]", "\"Path\": \"none.stl\", \"Unit\": \"mm\"", SKG_ERR_FILE,
     "line 21: Samples[1].Path: "},
    {"\"Cuboid\": [1, 2, 3, \"cm\"]", "\"Path\": \"none.stl\"", SKG_ERR_FILE, "none.stl: cannot be read"},
};

START_TEST(bad_files_are_refused) {
    write_edited(bad_files[_i].from, bad_files[_i].to);
    ck_skg_fails(load(), bad_files[_i].status, bad_files[_i].says);
    ck_assert_ptr_null(setup);
}
END_TEST

START_TEST(empty_samples_are_refused) {
    static const char text[] =
        "{\"Source\": {\"Position\": [0, -40, 0, \"cm\"], \"Shape\": \"Point\", \"Beam\": [{\"Energy\": 60, "
        "\"Unit\": \"keV\", \"PhotonCount\": 1}]}, \"Detector\": {\"Position\": [0, 1, 0, \"m\"], "
        "\"UpVector\": [0, 0, 1], \"NumberOfPixels\": [4, 4], \"Spacing\": [1, 1, \"mm\"]}, \"Samples\": "
        "[\"MoveToCentre\"]}";
    write_file("scene.json", text);
    ck_skg_fails(load(), SKG_ERR_SCENE, "Samples: is empty");
}
END_TEST

START_TEST(files_that_are_none) {
    ck_skg_fails(load(), SKG_ERR_FILE, "scene.json: cannot be read");
    write_file("scene.json", "");
    ck_skg_fails(load(), SKG_ERR_FORMAT, "line 1, column 0");
    write_file("scene.json", "[1, 2]");
    ck_skg_fails(load(), SKG_ERR_FORMAT, "one JSON object");
    ck_skg_fails(skg_setup_load(NULL, folder, 0, NULL, &setup), SKG_ERR_FILE, "cannot be read");
    ck_skg_fails(skg_setup_load(NULL, NULL, 0, NULL, &setup), SKG_ERR_ARGUMENT, "path is NULL");
    ck_skg_fails(skg_setup_load(NULL, path, 0, NULL, NULL), SKG_ERR_ARGUMENT, "setup is NULL");
    char marked[sizeof good + 3];
    snprintf(marked, sizeof marked, "\xEF\xBB\xBF%s", good);
    write_file("scene.json", marked);
    ck_skg(load());
}
END_TEST

/* Lines are found behind escapes, nested values and strings that look like structure. */
START_TEST(lines_are_found_in_awkward_text) {
    write_edited("\"Window size\": [800, 450],",
                 "\"Window size\": [{\"a\\\"}]{\": \"]}\\\\\", \"b\": [[], {}, -1.5e3, true]}, 450],\n\n\n"
                 "\"Preci\\u0073ion\": 5,");
    ck_skg_fails(load(), SKG_ERR_FORMAT, "line 5: Precision: is a number");
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_loop_test(tests, bad_settings_are_refused, 0,
                        (int)(sizeof bad_settings / sizeof *bad_settings));
    tcase_add_loop_test(tests, bad_files_are_refused, 0, (int)(sizeof bad_files / sizeof *bad_files));
    tcase_add_test(tests, empty_samples_are_refused);
    tcase_add_test(tests, files_that_are_none);
    tcase_add_test(tests, lines_are_found_in_awkward_text);
}

SKG_SUITE_MAIN("setup_bad", add_tests)
