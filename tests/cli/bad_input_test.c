/* Bad input: each gets its exit status and one clear sentence, and nothing is left behind. */
#include "cli/command.h"
#include "cli/scene.h"

#include <sys/stat.h>

static void set_up_scene(void) {
    set_up();
    write_text("scene.json", scene);
}

/* Nothing but the scene's files may be there. */
static void tear_down_scene(void) {
    ck_assert(!has_file("a.mha") && !has_file("a.png") && !has_file("a.tif"));
    tear_down();
}

/* `image` and `plan` with this setting fail so. */
#define ck_setting_fails(expected, text, setting)                                                            \
    do {                                                                                                     \
        ck_run_fails(expected, text, "image scene.json -o a.mha --set '%s'", setting);                       \
        ck_run_fails(expected, text, "plan scene.json --set '%s'", setting);                                 \
        ck_assert_int_eq(look_at_folder(0), 1);                                                              \
    } while (0)

START_TEST(usage) {
    ck_run_fails(2, "unknown flag --presicion; did you mean --precision?",
                 "image scene.json --presicion double");
    ck_run_fails(2, "--precision singel is not known; did you mean single; known: single, double",
                 "image scene.json -o a.mha --precision singel");
    ck_run_fails(2, "--quantity dose is not known; known: energy, fluence, photons",
                 "image scene.json -o a.mha --quantity dose");
    ck_run_fails(2, "--strategy", "plan scene.json --strategy fastest");
    ck_run_fails(2, "--display", "image scene.json -o a.png --display negative");
    ck_run_fails(2, "--repeat 0 is not a whole number from 1", "image scene.json --repeat 0");
    ck_run_fails(2, "--repeat 2x", "image scene.json --repeat 2x");
    ck_run_fails(2, "--range 3:1 is not two numbers LOW:HIGH", "image scene.json -o a.png --range 3:1");
    ck_run_fails(2, "--range 3 ", "image scene.json -o a.png --range 3");
    ck_run_fails(2, "--tolerance 1 is not a relative error", "image scene.json -o a.mha --tolerance 1");
    ck_run_fails(2, "no output is named; add -o FILE", "image scene.json");
    ck_run_fails(2, "--set", "image scene.json -o a.mha --set");
    ck_run_fails(2, "Detector", "image scene.json -o a.mha --set Detector");
    ck_run_fails(2, "the extension .jpg is no image format; use .png, .tif or .mha",
                 "image scene.json -o a.jpg");
    ck_run_fails(2, "SCENE|MESH... is missing", "image -o a.mha");
}
END_TEST

/* A comma too many is a warning. With --strict it is the exit status, and the image is there all the same. */
START_TEST(warnings_are_errors_on_demand) {
    char text[sizeof scene + 4], path[512];
    snprintf(text, sizeof text, "%s", scene);
    char *end = strrchr(text, '}');
    strcpy(end, ", }");
    write_text("comma.json", text);
    ck_run(0, "image comma.json -o b.mha");
    ck_assert_ptr_nonnull(strstr(complained, "warning: "));
    ck_run(1, "image comma.json -o b.mha --strict");
    ck_assert_ptr_nonnull(strstr(complained, "1 warning, which --strict makes an error"));
    ck_run(1, "image comma.json -o b.mha --strict --quiet");
    ck_assert(has_file("b.mha"));
    ck_run(0, "image scene.json -o b.mha --strict");
    ck_run(5, "image comma.json -o none/b.mha --strict");
    snprintf(path, sizeof path, "%s/b.mha", folder);
    ck_assert_int_eq(unlink(path), 0);
}
END_TEST

/* Each image of precision half overflows; there is one warning. */
START_TEST(an_overflow_is_one_warning) {
    static const char bright[] =
        "--precision half --set Source.Shape=PointSource --set Source.Beam.0.PhotonCount=1e9 --set 'Samples.0.Type=outer'";
    char path[512];
    ck_run(0, "image scene.json -o b.mha --repeat 3 %s", bright);
    const char *first = strstr(complained, "not finite");
    ck_assert_msg(first != NULL, "%s", complained);
    ck_assert_msg(strstr(first + 1, "not finite") == NULL, "%s", complained);
    snprintf(path, sizeof path, "%s/b.mha", folder);
    ck_assert_int_eq(unlink(path), 0);
}
END_TEST

START_TEST(outputs_that_cannot_be_written) {
    char path[512];
    ck_run_fails(5, "none/a.mha: cannot be written: No such file or directory; make its folder first",
                 "image scene.json -o a.png -o none/a.mha");
    ck_assert_int_eq(look_at_folder(0), 1); /* not the other one either: refused before any work */
    ck_run_fails(5, "scene.json/a.mha: cannot be written: Not a directory",
                 "image scene.json -o scene.json/a.mha");
    ck_run_fails(5, "/dev/null/a.png", "lbuffer scene.json --part skin -o /dev/null/a.png");
    snprintf(path, sizeof path, "%s/d.mha", folder);
    ck_assert_int_eq(mkdir(path, 0777), 0);
    ck_run_fails(5, "it is a folder; add a file name", "image scene.json -o d.mha");
    ck_assert_int_eq(rmdir(path), 0);
    /* A limit of 2 or 4 MB (the unit is the shell's) to a file stands for a full disk: more than the kernel
     * cache needs, less than the image. */
    char line[1024];
    snprintf(line, sizeof line,
             "cd %s && (trap '' XFSZ; ulimit -f 4000; %s image scene.json -o a.mha "
             "--set 'Detector.NumberOfPixels=[2048,1024]' >.said 2>.complained)",
             folder, SKG_COMMAND);
    int status = system(line);
    read_back(".said", said, sizeof said);
    read_back(".complained", complained, sizeof complained);
    ck_assert_msg(WIFEXITED(status) && WEXITSTATUS(status) == 5, "%s", complained);
    ck_assert_ptr_nonnull(strstr(complained, "a.mha: cannot be written: File too large"));
    ck_assert_int_eq(look_at_folder(0), 1);
    /* A skewed detector is no MetaImage; what can be written is. */
    ck_run(5, "image scene.json -o b.mha -o b.tif --set 'Detector.RightVector=[1,0,0.5]'");
    ck_assert_ptr_nonnull(strstr(complained, "write .tif instead"));
    ck_assert(has_file("b.tif") && !has_file("b.mha"));
}
END_TEST

START_TEST(files_of_the_user_stay) {
    static const char *const ours[] = {"b.png", "b.mha", "b.tif"};
    char text[64];
    write_text("a.png", "mine");
    ck_run_fails(5, "a.png: exists beside the input scene.json and was not written by skiagraph",
                 "image scene.json -o a.png");
    ck_run_fails(5, "exists beside the input", "image ./scene.json -o \"$PWD/a.png\"");
    read_back("a.png", text, sizeof text);
    ck_assert_str_eq(text, "mine");
    ck_run_fails(5, "scene.json: is the input", "image scene.json -o ./scene.json");
    for (int i = 0; i < 3; i++)
        for (int again = 0; again < 2; again++) ck_run(0, "image scene.json -o %s", ours[i]);
    /* Beside no input, a file is the caller's to replace. */
    write_text("c.png", "mine");
    ck_run(0, "beam --kvp 90 --filter Al:3 -o c.png");
    ck_run_fails(2, "frames.avi: .avi files are not written here", "breathe scene.json -o frames.avi");
    ck_run_fails(2, "frames.GIF: .gif files are not written here", "thorax -o frames.GIF");
    ck_assert(!has_file("frames.avi") && !has_file("frames.GIF"));
}
END_TEST

START_TEST(no_device) {
    ck_run_fails(4, "no OpenCL device fits device=quantum", "image scene.json -o a.mha --device quantum");
    ck_run_fails(4, "no OpenCL device", "OCL_ICD_VENDORS=/dev/null |plan scene.json");
    ck_run_fails(4, "no OpenCL device fits", "SKG_DEVICE=quantum |lbuffer scene.json --part skin -o a.mha");
}
END_TEST

START_TEST(scene_files) {
    ck_run_fails(3, "missing.json: cannot be read: No such file or directory", "plan missing.json");
    write_text("empty.json", "");
    ck_run_fails(3, "empty.json", "plan empty.json");
    write_text("cut.json", "{ \"Source\": {\n \"Position\": [0, ");
    ck_run_fails(3, "cut.json: line 2, column", "plan cut.json");
    ck_run_fails(3, "cannot be read", "plan .");
    look_at_folder(1);
    write_text("scene.json", scene);
    ck_setting_fails(3, "did you mean NumberOfPixels", "Detector.NumberOfPixel=[3,3]");
    ck_setting_fails(3, "Noise: ", "Noise=3");
    ck_setting_fails(3, "Spacing", "Detector.Spacing=null"); /* null deletes the key, and it is missed */
    ck_setting_fails(2, "there is no key \"Spacig\" to delete", "Detector.Spacig=null");
    ck_setting_fails(2, "there is no key \"Noise\" to delete", "Noise.Swank=null");
    ck_setting_fails(2, "null deletes keys, not elements", "Samples.bone=null");
    ck_run_fails(3, "did you mean ./scene.json?", "plan ./Scene.JSON");
    ck_run_fails(3, "did you mean ./scene.json?", "plan '.\\scene.json'");
    ck_setting_fails(3, "Tolerance", "Tolerance=2");
}
END_TEST

START_TEST(detectors_and_sources) {
    ck_setting_fails(3, "has 0 columns", "Detector.NumberOfPixels=[0,49]");
    ck_setting_fails(3, "1 to 32768 of each", "Detector.NumberOfPixels=[65,4000000]");
    ck_setting_fails(3, "Spacing", "Detector.Spacing=[0,1,\"mm\"]");
    ck_setting_fails(3, "parallel", "Detector.RightVector=[0,0,2]");
    ck_setting_fails(3, "UpVector: points along the beam", "Detector.UpVector=[0,1,0]");
    ck_run_fails(
        3, "source",
        "image scene.json -o a.mha --set Source.Shape=Point --set 'Source.Position=[5,100,3,\"mm\"]' "
        "--set Detector.RightVector=[1,0,0]");
    ck_setting_fails(3, "Beam[0]: a photon energy of -60 keV", "Source.Beam.0.Energy=-60");
}
END_TEST

START_TEST(parts) {
    ck_setting_fails(3, "itself", "Samples.bone.Parent=bone");
    ck_setting_fails(3, "skim", "Samples.bone.Parent=skim");
    ck_setting_fails(3, "a scaling by 0 flattens", "Samples.bone.Transform=[[\"Scaling\",1,0,1]]");
    ck_setting_fails(3, "its pose is singular",
                     "Samples.bone.Transform=[[\"Matrix\",[1,0,0,0,1,0,0,0,0,0,1,0,0,0,0,1]]]");
    ck_setting_fails(3, "Cube", "Samples.skin.Cube=[-1,\"mm\"]");
    ck_setting_fails(3, "Material", "Samples.skin.Material=[\"mu\",-1]");
    ck_setting_fails(3, "Samples", "Samples=[]");
}
END_TEST

START_TEST(meshes_of_a_scene) {
    write_text("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
    write_text("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    write_text("empty.stl", "");
    static const char *const names[] = {"nan.obj", "index.obj", "empty.stl", "missing.stl"};
    for (int i = 0; i < 4; i++)
        ck_run_fails(3, names[i],
                     "image scene.json -o a.mha --set 'Samples.1={\"Label\":\"bone\",\"Path\":\"%s\","
                     "\"Unit\":\"mm\",\"Material\":[\"mu\",0.5]}'",
                     names[i]);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_scene, tear_down_scene);
    tcase_add_test(tests, usage);
    tcase_add_test(tests, an_overflow_is_one_warning);
    tcase_add_test(tests, warnings_are_errors_on_demand);
    tcase_add_test(tests, outputs_that_cannot_be_written);
    tcase_add_test(tests, files_of_the_user_stay);
    tcase_add_test(tests, no_device);
    tcase_add_test(tests, scene_files);
    tcase_add_test(tests, detectors_and_sources);
    tcase_add_test(tests, parts);
    tcase_add_test(tests, meshes_of_a_scene);
}

SKG_SUITE_MAIN("bad_input", add_tests)
