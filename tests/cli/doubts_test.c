/* Answers that are right and may mislead: the command says so. And what `image` refuses, `plan` refuses alike. */
#include "cli/command.h"
#include "cli/scene.h"

static void set_up_scene(void) {
    set_up();
    write_text("scene.json", scene);
}

#define POINT " --set Source.Shape=PointSource "

START_TEST(empty_bands) {
    ck_run(0, "image scene.json --bands 10,20,70 --quantity photons -o a.tif");
    ck_assert_ptr_nonnull(strstr(complained,
                                 "the band from 10 to 20 keV records nothing of the beam, whose energies go "
                                 "from 60 to 60 keV"));
    ck_assert_ptr_null(strstr(complained, "the band from 20 to 70 keV"));
    ck_run(0, "image scene.json --bands 20,70 --quantity photons -o b.tif");
    ck_assert_ptr_null(strstr(complained, "records nothing"));
    ck_run_fails(3, "channel 0 records nothing of the flat field",
                 "image scene.json --bands 10,20 --quantity transmission -o c.tif");
}
END_TEST

/* bone, 10.5 x 20 x 30.5 mm, lies inside skin, 40.5 mm; both have their middle at the origin. */
START_TEST(source_inside_a_part) {
    static const struct {
        const char *position, *part;
    } cases[] = {{"[0,0,0,\"mm\"]", "inside bone:"},   {"[0,-9.9,0,\"mm\"]", "inside bone:"},
                 {"[0,-15,3,\"mm\"]", "inside skin:"}, {"[0,-20.2,0,\"mm\"]", "inside skin:"},
                 {"[0,-20.3,0,\"mm\"]", NULL},         {"[21,-21,0,\"mm\"]", NULL},
                 {"[0,-400,0,\"mm\"]", NULL}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ck_run(0, "image scene.json" POINT "--set 'Source.Position=%s' -o a.mha", cases[k].position);
        if (cases[k].part)
            ck_assert_msg(strstr(complained, cases[k].part) != NULL, "%s: %s", cases[k].position, complained);
        else
            ck_assert_msg(strstr(complained, "the source lies") == NULL, "%s: %s", cases[k].position,
                          complained);
    }
    /* A part that was turned and moved takes its inside along; a mirrored one has one, too. */
    ck_run(0, "image scene.json" POINT "--set 'Samples.bone.Transform=[[\"Translation\",0,-200,0,\"mm\"],"
              "[\"Rotation\",90,0,0,1]]' --set 'Source.Position=[9,-200,0,\"mm\"]' -o a.mha");
    ck_assert_ptr_nonnull(strstr(complained, "inside bone:"));
    ck_run(0, "image scene.json" POINT "--set 'Samples.bone.Transform=[[\"Translation\",0,-200,0,\"mm\"],"
              "[\"Scaling\",-1,1,1]]' --set 'Source.Position=[4,-209,0,\"mm\"]' -o a.mha");
    ck_assert_ptr_nonnull(strstr(complained, "inside bone:"));
}
END_TEST

/* A weight without bands would weigh nothing. */
/* A part about the middle of the detector, and none about source and detector, of which the source is told. */
START_TEST(detector_inside_a_part) {
    ck_run(0, "image scene.json" POINT "--set 'Detector.Position=[0,3,0,\"mm\"]' -o a.mha");
    ck_assert_ptr_nonnull(strstr(complained, "the middle of the detector lies inside bone: rays end there"));
    ck_run(0, "image scene.json" POINT "-o a.mha");
    ck_assert_ptr_null(strstr(complained, "the middle of the detector"));
    ck_run(0, "image scene.json" POINT
              "--set 'Source.Position=[0,-15,0,\"mm\"]' --set 'Detector.Position=[0,15,0,\"mm\"]' -o a.mha");
    ck_assert_ptr_nonnull(strstr(complained, "the source lies inside skin:"));
    ck_assert_ptr_null(strstr(complained, "the middle of the detector"));
}
END_TEST

/* In metres instead of mm, with a corner at the origin or the middle behind the source or the detector: the box is as large. */
START_TEST(boxes_of_another_unit) {
    static const int middles[] = {0, 20000, -20000};
    for (int k = 0; k < 3; k++) {
        ck_run(
            0,
            "image scene.json" POINT
            "--set 'Samples.skin.Cube=[300,\"m\"]' --set 'Samples.skin.Transform=[[\"Translation\",%d,%d,0,\"mm\"]]' -o a.mha",
            middles[k], middles[k]);
        ck_assert_msg(strstr(complained, "skin: its box is 3e+05 mm long, over 500 times of the field") !=
                          NULL,
                      "%d: %s", middles[k], complained);
    }
}
END_TEST

/* A volume has no unit of its own once it is read: its cells have a size. */
START_TEST(a_small_volume_says_its_cells) {
    char path[512];
    snprintf(path, sizeof path, "%s/small.mha", folder);
    FILE *file = fopen(path, "wb");
    ck_assert_ptr_nonnull(file);
    fputs("ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementSpacing = 2 3 4\nDistanceUnits = um\n"
          "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n12345678",
          file);
    fclose(file);
    ck_run(0, "image scene.json" POINT
              "--set 'Samples.bone={\"Label\":\"ct\",\"Volume\":\"small.mha\",\"Values\":\"mu\"}' -o a.mha");
    ck_assert_msg(strstr(complained, "ct: its box is 0.008 mm long") != NULL &&
                      strstr(complained, "the size of its cells is 0.002 x 0.003 x 0.004 mm") != NULL,
                  "%s", complained);
}
END_TEST

START_TEST(flags_without_effect) {
    ck_run_fails(2, "--band-weight weighs the photons of bands; add --bands",
                 "image scene.json --quantity transmission --band-weight energy -o a.mha");
}
END_TEST

/* Without mAs, a tube's photon numbers are only relative, and noise takes them as they are. */
START_TEST(noise_without_a_load) {
    static const char text[] = "because the tube has no mAs";
    ck_run(
        0,
        "image scene.json -o a.mha --set 'Source.Beam={\"kVp\":60,\"Filter\":[[\"Al\",3]]}' --set Noise=true");
    ck_assert_ptr_nonnull(strstr(complained, text));
    ck_run(0, "image scene.json" POINT
              "-o a.mha --set 'Source.Beam={\"kVp\":60,\"Filter\":[[\"Al\",3]],\"mAs\":1}' "
              "--set Noise=true");
    ck_assert_ptr_null(strstr(complained, text));
    ck_run(0, "image scene.json -o a.mha --set Noise=true");
    ck_assert_ptr_null(strstr(complained, text));
}
END_TEST

START_TEST(phases_end_below_one) {
    ck_run_fails(2, "--phase 7: a phase is a number from 0 to below 1",
                 "breathe scene.json --phase 7 -o a.mha");
    ck_run_fails(2, "--phase 1: a phase", "breathe scene.json --phase 1 -o a.mha");
    ck_run_fails(2, "--phase -0.25: a phase", "view scene.json --phase -0.25 -o a.png");
    ck_run_fails(2, "--phase nan: a phase", "view scene.json --phase nan -o a.png");
}
END_TEST

/* Both verbs say the same of a scene that one of them refuses. */
START_TEST(plan_refuses_what_image_refuses) {
    static const char *const settings[] = {"Source.Beam=null",
                                           "Samples.bone.Material=null",
                                           "Samples.skin.Material=\"Unobtainium\"",
                                           "Source.Beam=[]",
                                           "Source.Beam=[{\"Energy\":30,\"Unit\":\"MeV\",\"PhotonCount\":1}]",
                                           "Source.Beam={\"kVp\":5}",
                                           "Detector.UpVector=[0,1,0]",
                                           "Detector.NumberOfPixels=[0,1]",
                                           "Detector.Colour=3",
                                           "Samples.bone.Cuboid=[0,1,2,\"mm\"]",
                                           "Scan={\"NumberOfProjections\":0}",
                                           "Scan={\"FinalAngel\":360}",
                                           "Noise={\"Seed\":-1}",
                                           "Tolerance=2",
                                           "World=\"Unobtainium\"",
                                           "Precision=\"double\"",
                                           "Precision=\"half\"",
                                           "Samples.bone.Parent=\"muscle\"",
                                           "Detector=null",
                                           "Samples=[]"};
    char image[sizeof complained];
    for (size_t k = 0; k < sizeof settings / sizeof *settings; k++) {
        const int by_image = run("image scene.json -o a.mha --quiet --set '%s'", settings[k]);
        snprintf(image, sizeof image, "%s", complained);
        const int by_plan = run("plan scene.json --quiet --set '%s'", settings[k]);
        ck_assert_msg(by_image == by_plan, "%s: image %d, plan %d", settings[k], by_image, by_plan);
        ck_assert_msg(by_image == 0 || strcmp(image, complained) == 0, "%s: %s and %s", settings[k], image,
                      complained);
    }
}
END_TEST

enum { BYTES = 4 * 65 * 49 * sizeof(float) };

/* The last BYTES of a file. */
static void read_end(const char *name, char *bytes) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "rb");
    ck_assert_ptr_nonnull(stream);
    ck_assert_int_eq(fseek(stream, -(long)BYTES, SEEK_END), 0);
    ck_assert_uint_eq(fread(bytes, 1, BYTES, stream), BYTES);
    fclose(stream);
}

/* Projections are told apart: by a full turn if the file does not say how far they go. */
START_TEST(a_scan_without_an_end_goes_once_around) {
    ck_run(0, "scan scene.json --quantity attenuation -o none.mha --set 'Scan={\"NumberOfProjections\":4}'");
    ck_assert_ptr_nonnull(
        strstr(complained, "neither FinalAngle nor AngleStep: the projections go once around"));
    ck_run(0, "scan scene.json --quantity attenuation -o final.mha --set "
              "'Scan={\"NumberOfProjections\":4,\"FinalAngle\":360}'");
    ck_assert_ptr_null(strstr(complained, "once around"));
    ck_run(0, "scan scene.json --quantity attenuation -o step.mha --set 'Scan={\"AngleStep\":90}'");
    ck_assert_ptr_nonnull(strstr(complained, "no FinalAngle: the projections go once around"));
    static char one[BYTES], other[BYTES];
    static const char *const same[] = {"none.mha", "step.mha"};
    read_end("final.mha", one);
    for (int k = 0; k < 2; k++) {
        read_end(same[k], other);
        ck_assert_mem_eq(one, other, BYTES);
    }
    ck_assert_int_ne(memcmp(one, one + BYTES / 4, BYTES / 4), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scene, tear_down);
    tcase_add_test(tests, empty_bands);
    tcase_add_test(tests, source_inside_a_part);
    tcase_add_test(tests, detector_inside_a_part);
    tcase_add_test(tests, boxes_of_another_unit);
    tcase_add_test(tests, a_small_volume_says_its_cells);
    tcase_add_test(tests, flags_without_effect);
    tcase_add_test(tests, noise_without_a_load);
    tcase_add_test(tests, phases_end_below_one);
    tcase_add_test(tests, plan_refuses_what_image_refuses);
    tcase_add_test(tests, a_scan_without_an_end_goes_once_around);
}

SKG_SUITE_MAIN("doubts", add_tests)
