/* The command itself, and the verbs devices and mesh. */
#include "cli/command.h"

#include <math.h>
#include <stdint.h>

/* A tetrahedron with legs of 2 along the axes, wound outward. */
static const char tetrahedron[] = "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\n"
                                  "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
static const char inverted[] = "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\n"
                               "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
static const char open_mesh[] = "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\n"
                                "f 1 3 2\nf 1 2 4\nf 1 4 3\n";

START_TEST(help_is_everywhere) {
    static const char *const verbs[] = {"devices", "mesh"};
    ck_run(0, "help");
    ck_assert_ptr_nonnull(strstr(said, "exit status:\n  0  The work is done.\n  1  A check failed."));
    ck_assert_str_eq(complained, "");
    for (size_t i = 0; i < sizeof verbs / sizeof *verbs; i++) {
        char usage[64];
        static char first[sizeof said];
        ck_run(0, "help");
        ck_assert_ptr_nonnull(strstr(said, verbs[i]));
        snprintf(usage, sizeof usage, "usage: skiagraph %s ", verbs[i]);
        ck_run(0, "help %s", verbs[i]);
        ck_assert_ptr_nonnull(strstr(said, usage));
        memcpy(first, said, sizeof first);
        ck_run(0, "%s --help", verbs[i]);
        ck_assert_str_eq(said, first);
        ck_assert_ptr_nonnull(strstr(said, "--json"));
    }
    ck_run(0, "--version");
    ck_assert_int_eq(strncmp(said, "skiagraph ", 10), 0);
    char version[64] = "";
    ck_assert_int_eq(sscanf(said, "skiagraph %63s", version), 1);
    ck_assert_ptr_nonnull(strstr(said, "\nbuilt by "));
    ck_assert_ptr_nonnull(strstr(said, ", with Assimp "));
    ck_run(0, "--version --json");
    json_t *object = said_json();
    ck_assert_str_eq(json_string_value(member(object, "version")), version);
    ck_assert(json_is_string(member(member(object, "libraries"), "Assimp")));
    ck_assert(json_is_string(member(object, "compiler")));
    json_decref(object);
}
END_TEST

static void check_failure(const char *status, const char *message, const char *where) {
    json_t *object = said_json(), *error = member(object, "error");
    ck_assert_str_eq(json_string_value(member(error, "status")), status);
    ck_assert_str_eq(json_string_value(member(error, "message")), message);
    if (where)
        ck_assert_str_eq(json_string_value(member(error, "where")), where);
    else
        ck_assert(json_is_null(member(error, "where")));
    json_decref(object);
}

/* The sentence of standard error, for programs. */
START_TEST(failures_are_json_too) {
    ck_run(2, "mesh --json");
    check_failure("SKG_ERR_ARGUMENT", "mesh: FILE... is missing; see `skiagraph help mesh`", "mesh");
    ck_assert_str_eq(complained, "skiagraph: mesh: FILE... is missing; see `skiagraph help mesh`\n");
    ck_run(3, "plan --json 'no such.json'");
    check_failure("SKG_ERR_FILE", "no such.json: cannot be read: No such file or directory", NULL);
    ck_run(3, "plan 'no such.json' --json");
    check_failure("SKG_ERR_FILE", "no such.json: cannot be read: No such file or directory", "no such.json");
    write_text("a.json", "{\n\"Source\": {},\n\"Detector\": {},\n\"Samples\": []}");
    ck_run(3, "plan a.json --json");
    json_t *object = said_json();
    ck_assert_str_eq(json_string_value(member(member(object, "error"), "where")), "a.json: line 2: Source");
    json_decref(object);
    ck_run(3, "material Unobtainium --json");
    object = said_json();
    ck_assert_str_eq(json_string_value(member(member(object, "error"), "status")), "SKG_ERR_MATERIAL");
    json_decref(object);
    write_text("a.obj", tetrahedron);
    ck_run(3, "mesh none.obj a.obj --json"); /* one object: what could be read */
    object = said_json();
    ck_assert_uint_eq(json_array_size(member(object, "files")), 1);
    json_decref(object);
}
END_TEST

START_TEST(slips_of_the_finger_are_named) {
    ck_run(2, "%s", "");
    ck_assert_ptr_nonnull(strstr(complained, "usage: skiagraph VERB"));
    ck_run_fails(2, "unknown verb mehs; did you mean mesh?", "mehs a.obj");
    ck_run_fails(2, "unknown verb xyzzy; `skiagraph help`", "xyzzy");
    ck_run_fails(2, "unknown flag --jason; did you mean --json? `skiagraph help devices`", "devices --jason");
    ck_run_fails(2, "unknown flag --jsn", "devices --jsn=3");
    ck_run_fails(2, "--json takes no value", "devices --json=3");
    ck_run_fails(2, "--device needs a value: --device NAME", "devices --device");
    ck_run_fails(2, "\"extra\" is one word too many", "devices extra");
    ck_run_fails(2, "mesh: FILE... is missing", "mesh");
    ck_run_fails(2,
                 "--unit inches is not known; did you mean inch; known: nm, um, mm, cm, dm, m, in, inch, ft",
                 "mesh a.obj --unit inches");
}
END_TEST

START_TEST(devices_are_listed_and_chosen) {
    ck_run(0, "devices --json");
    json_t *object = said_json(), *list = member(object, "devices");
    ck_assert_uint_ge(json_array_size(list), 1);
    int chosen = 0;
    for (size_t i = 0; i < json_array_size(list); i++) {
        json_t *device = json_array_get(list, i);
        chosen += json_is_true(member(device, "chosen"));
        ck_assert_int_ge(json_integer_value(member(device, "compute_units")), 1);
        ck_assert_int_gt(json_integer_value(member(device, "memory_bytes")), 0);
        ck_assert(json_is_boolean(member(device, "has_double")));
        ck_assert(json_is_boolean(member(device, "correct_division")));
    }
    ck_assert_int_eq(chosen, 1);
    ck_assert(json_is_string(member(member(object, "environment"), "POCL_CACHE_DIR")));
    json_decref(object);
    ck_run(0, "devices");
    ck_assert_ptr_nonnull(strstr(said, "* "));
    ck_assert_ptr_nonnull(strstr(said, "POCL_AFFINITY"));
}
END_TEST

START_TEST(no_device_is_status_4) {
    /* the list follows where there are drivers that are not known, also of no device, as Mesa's */
    ck_run(4, "devices --device no-such-device");
    ck_assert_ptr_nonnull(strstr(complained, "skiagraph: no OpenCL device fits device=no-such-device"));
    ck_run_fails(4, "no OpenCL device on this machine", "OCL_ICD_VENDORS=/dev/null |devices");
    ck_run_fails(4, "driver=/no/such/driver.so cannot be loaded",
                 "devices --device driver=/no/such/driver.so");
    ck_run_fails(4, "driver=/no/such/driver.so cannot be loaded",
                 "SKG_DEVICE=driver=/no/such/driver.so |devices");
    ck_run_fails(4, "driver=/no/such/driver.so cannot be loaded",
                 "devices --test --device driver=/no/such/driver.so");
    ck_run_fails(2, "threads=none is not a number", "devices --device 'cpu threads=none'");
    ck_run_fails(2, "SKG_DEVICE=colour=blue", "SKG_DEVICE=colour=blue |devices");
}
END_TEST

START_TEST(affinity_is_left_alone_where_it_would_hurt) {
    ck_run(0, "POCL_AFFINITY=0 |devices");
    ck_assert_ptr_nonnull(strstr(said, "0 (as the environment says)"));
    ck_run(0, "SLURM_JOB_ID=7 |devices");
    ck_assert_ptr_nonnull(strstr(said, "- (not pinned: SLURM_JOB_ID says"));
    if (sysconf(_SC_NPROCESSORS_ONLN) > 1) { /* 0 is a core that every machine has */
        char line[256];
        snprintf(
            line, sizeof line,
            "taskset -c 0 env -u POCL_MAX_PTHREAD_COUNT %s devices | "
            "grep -c -e 'not pinned: this process may run on 1 of ' -e 'POCL_MAX_PTHREAD_COUNT *1$' | grep -q 2",
            SKG_COMMAND);
        ck_assert_int_eq(system(line), 0);
    }
    ck_run(0, "OMP_PROC_BIND=true |devices");
    ck_assert_ptr_nonnull(strstr(said, "- (not pinned: OMP_PROC_BIND binds threads"));
    /* PoCL aborts if it pins a thread to a core that there is not. */
    ck_run(0, "POCL_MAX_PTHREAD_COUNT=600 |devices");
    ck_assert_ptr_nonnull(strstr(said, "- (not pinned: POCL_MAX_PTHREAD_COUNT asks for more threads"));
}
END_TEST

START_TEST(an_unwritable_kernel_cache_is_a_warning) {
    char line[128];
    ck_run(0, "POCL_CACHE_DIR=/dev/null/cache TMPDIR=. |devices --json");
    ck_assert_ptr_nonnull(
        strstr(complained, "skiagraph: warning: kernels cannot be kept in /dev/null/cache"));
    json_decref(said_json());
    ck_assert_int_eq(look_at_folder(0), 0);                /* the temporary cache is gone */
    ck_run(0, "POCL_CACHE_DIR=/proc/none/cache |devices"); /* where even root makes no folder */
    ck_assert_ptr_nonnull(
        strstr(complained, "skiagraph: warning: kernels cannot be kept in /proc/none/cache"));
    ck_run(0, "POCL_CACHE_DIR= XDG_CACHE_HOME=. |devices"); /* as if it were not set */
    ck_assert_str_eq(complained, "");
    snprintf(line, sizeof line, "rm -r %s/pocl", folder);
    ck_assert_int_eq(system(line), 0);
    ck_run(0, "POCL_CACHE_DIR=/dev/null/cache |devices --quiet");
    ck_assert_str_eq(complained, "");
}
END_TEST

START_TEST(standard_output_that_is_full_is_status_5) {
    char line[256];
    snprintf(line, sizeof line, "%s help >/dev/full 2>%s/complaint", SKG_COMMAND, folder);
    if (access("/dev/full", W_OK) != 0) return;
    int status = system(line);
    ck_assert(WIFEXITED(status) && WEXITSTATUS(status) == 5);
    read_back("complaint", complained, sizeof complained);
    ck_assert_ptr_nonnull(strstr(complained, "standard output: cannot be written: No space left on device"));
}
END_TEST

START_TEST(mesh_tells_health) {
    write_text("good.obj", tetrahedron);
    write_text("inverted.obj", inverted);
    write_text("open.obj", open_mesh);
    ck_run(0, "mesh good.obj inverted.obj --unit cm --json");
    ck_assert_str_eq(complained, "");
    json_t *object = said_json(), *list = member(object, "files");
    ck_assert_uint_eq(json_array_size(list), 2);
    for (size_t i = 0; i < 2; i++) {
        json_t *file = json_array_get(list, i);
        ck_assert_int_eq(json_integer_value(member(file, "triangles")), 4);
        ck_assert_int_eq(json_integer_value(member(file, "vertices")), 4);
        ck_assert_int_eq(json_integer_value(member(file, "open_edges")), 0);
        ck_assert_int_eq(json_integer_value(member(file, "components")), 1);
        ck_assert(json_is_true(member(file, "closed")));
        ck_assert_int_eq(json_is_true(member(file, "flipped")), i == 1);
        /* 20 mm legs: 20^3/6; three half squares and the slanted face; 4 roundings of 1e-16 each */
        ck_assert_double_eq_tol(json_real_value(member(file, "volume_mm3")), 8000.0 / 6, 1e-12 * 8000 / 6);
        ck_assert_double_eq_tol(json_real_value(member(file, "area_mm2")), 600 + 200 * sqrt(3), 1e-12 * 946);
        json_t *bounds = member(file, "bounds");
        for (size_t k = 0; k < 6; k++)
            ck_assert(json_real_value(json_array_get(bounds, k)) == (k < 3 ? 0 : 20));
    }
    json_decref(object);
    ck_run(1, "mesh good.obj open.obj");
    ck_assert_ptr_nonnull(strstr(said, "good.obj: closed\n"));
    ck_assert_ptr_nonnull(strstr(said, "open.obj: LEAKY\n  3 open edges, first at vertex "));
    ck_run(1, "mesh open.obj --json");
    object = said_json();
    json_t *file = json_array_get(member(object, "files"), 0);
    ck_assert(json_is_false(member(file, "closed")));
    ck_assert_int_eq(json_integer_value(member(file, "open_edges")), 3);
    json_decref(object);
    ck_run(1, "mesh --quiet -- open.obj");
    ck_assert_str_eq(said, "");
}
END_TEST

/* The header of a binary STL with this count, and one triangle. */
static size_t stl_of(uint32_t count, unsigned char bytes[134]) {
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    memset(bytes, 0, 134);
    memcpy(bytes, "made here", 9);
    for (int i = 0; i < 4; i++) bytes[80 + i] = (unsigned char)(count >> (8 * i));
    memcpy(bytes + 96, corners, sizeof corners); /* the tests' machines are little-endian */
    return 134;
}

START_TEST(bad_meshes_are_status_3) {
    unsigned char bytes[134];
    write_text("empty.stl", "");
    write_bytes("cut.stl", bytes, stl_of(1, bytes) - 20);
    write_bytes("large.stl", bytes, stl_of(1000000, bytes));
    write_bytes("none.stl", bytes, stl_of(0, bytes) - 50);
    write_text("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    write_text("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
    write_text("infinite.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                               "end_header\n0 0 0\n1 0 0\n0 inf 0\n3 0 1 2\n");
    write_text("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    ck_run_fails(3, "missing.stl: cannot be read: No such file or directory", "mesh missing.stl");
    ck_run_fails(3, "empty.stl", "mesh empty.stl");
    ck_run_fails(3, "cut.stl", "mesh cut.stl");
    ck_run_fails(3, "large.stl", "mesh large.stl");
    ck_run_fails(3, "none.stl", "mesh none.stl");
    ck_run_fails(3, "points.obj", "mesh points.obj");
    ck_run_fails(3, "nan.obj", "mesh nan.obj");
    ck_run_fails(3, "infinite.ply", "mesh infinite.ply");
    ck_run_fails(3, "index.obj", "mesh index.obj");
    ck_run_fails(3, ".: holds no DICOM slice", "mesh .");
    /* Files that can be read are still reported. */
    write_text("good.obj", tetrahedron);
    ck_run(3, "mesh missing.stl good.obj --json");
    ck_assert_ptr_nonnull(strstr(complained, "missing.stl"));
    json_t *object = said_json();
    ck_assert_uint_eq(json_array_size(member(object, "files")), 1);
    json_decref(object);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, help_is_everywhere);
    tcase_add_test(tests, failures_are_json_too);
    tcase_add_test(tests, slips_of_the_finger_are_named);
    tcase_add_test(tests, devices_are_listed_and_chosen);
    tcase_add_test(tests, no_device_is_status_4);
    tcase_add_test(tests, affinity_is_left_alone_where_it_would_hurt);
    tcase_add_test(tests, an_unwritable_kernel_cache_is_a_warning);
    tcase_add_test(tests, standard_output_that_is_full_is_status_5);
    tcase_add_test(tests, mesh_tells_health);
    tcase_add_test(tests, bad_meshes_are_status_3);
}

SKG_SUITE_MAIN("command", add_tests)
