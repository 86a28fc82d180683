/* Files of projections: their layout, what is found when they are opened again, and who may write them. */
#include "suite.h"

#include <skiagraph/scanning.h>
#include <skiagraph/skiagraph.h>

#include <dirent.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

enum { COLUMNS = 7, ROWS = 5, PIXELS = COLUMNS * ROWS, COUNT = 9 };

static const char hash[] = "00112233445566778899aabbccddeeff00112233445566778899aabbccddeeff";
static const char other[] = "ff112233445566778899aabbccddeeff00112233445566778899aabbccddeeff";
static const char *const names[] = {"scan.mha", "scan.raw", "scan.tif", "folder", "scan.h5"};
enum { KINDS = sizeof names / sizeof *names };

static char folder[64], path[256];
static skg_scan *scan;
static skg_scan_file *file;
static skg_scan_file_options options;
static float images[COUNT][PIXELS];

static void set_up(void) {
    skg_view view;
    skg_scan_options geometry;
    strcpy(folder, "/tmp/skg-scan-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    skg_view_init(&view);
    view.columns = COLUMNS;
    view.rows = ROWS;
    view.source[1] = -1000;
    view.centre[1] = 500;
    view.column_step[0] = -2;
    view.row_step[2] = -3;
    skg_scan_options_init(&geometry);
    geometry.projections = COUNT;
    geometry.step_rad = 0.5;
    ck_skg(skg_scan_create(&view, &geometry, &scan));
    skg_scan_file_options_init(&options);
    options.scan = scan;
    options.hash = hash;
    options.name = "energy";
    options.unit = "keV per pixel";
    options.flat_field = 1000;
    options.samples = 3;
    file = NULL;
    for (int k = 0; k < COUNT; k++)
        for (int i = 0; i < PIXELS; i++) images[k][i] = (float)(1000 * k + i);
}

static void tear_down(void) {
    char line[128];
    skg_scan_file_release(&file);
    skg_scan_release(&scan);
    snprintf(line, sizeof line, "rm -rf %s", folder);
    ck_assert_int_eq(system(line), 0);
}

static const char *in_folder(const char *name) {
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int has(const char *name) {
    return access(in_folder(name), F_OK) == 0;
}

static void put(int64_t index) {
    ck_skg(skg_scan_file_write(file, 1, &index, images[index], NULL));
}

static int64_t done_count(void) {
    int64_t count = -1;
    ck_skg(skg_scan_file_done_count(file, &count));
    return count;
}

static int files_in_folder(void) {
    int count = 0;
    DIR *directory = opendir(folder);
    for (struct dirent *entry; (entry = readdir(directory));) count += entry->d_name[0] != '.';
    closedir(directory);
    return count;
}

/* The last bytes of a stack are its projections, in order. */
static void ck_values(const char *name) {
    static float read[COUNT * PIXELS];
    FILE *stream = fopen(in_folder(name), "rb");
    ck_assert_ptr_nonnull(stream);
    ck_assert_int_eq(fseek(stream, -(long)sizeof read, SEEK_END), 0);
    ck_assert_uint_eq(fread(read, sizeof(float), COUNT * PIXELS, stream), COUNT * PIXELS);
    fclose(stream);
    ck_assert_mem_eq(read, images, sizeof read);
}

/* A build without HDF5 refuses .h5 with a sentence. */
static int is_possible(const char *name) {
    if (skg_scan_file_path_check(name) == SKG_OK) return 1;
    ck_skg_fails(skg_scan_file_path_check(name), SKG_ERR_UNSUPPORTED, "has no HDF5");
    return 0;
}

/* Projections in any order, with the file closed in between. */
START_TEST(what_is_written_is_found_again) {
    static const int64_t first[] = {8, 2, 0};
    const char *name = names[_i];
    if (!is_possible(name)) return;
    ck_skg(skg_scan_file_open(in_folder(name), &options, &file));
    ck_assert_int_eq(done_count(), 0);
    for (int i = 0; i < 3; i++) put(first[i]);
    skg_scan_file_release(&file);
    int64_t samples = 0;
    ck_skg(skg_scan_file_samples_get(in_folder(name), hash, &samples));
    ck_assert_int_eq(samples, 3);
    ck_skg(skg_scan_file_samples_get(in_folder(name), other, &samples));
    ck_assert_int_eq(samples, 0);
    ck_skg(skg_scan_file_open(in_folder(name), &options, &file));
    ck_assert_int_eq(done_count(), 3);
    for (int64_t k = 0; k < COUNT; k++) {
        int32_t done = -1;
        ck_skg(skg_scan_file_done_get(file, k, &done));
        ck_assert_int_eq(done, k == 0 || k == 2 || k == 8);
        if (!done) put(k);
    }
    ck_skg(skg_scan_file_finish(file));
    skg_scan_file_release(&file);
    ck_assert_int_eq(files_in_folder(), strcmp(name, "scan.raw") == 0 ? 2 : 1);
    if (strcmp(name, "folder") != 0 && strcmp(name, "scan.h5") != 0) ck_values(name);
    ck_skg(skg_scan_file_open(in_folder(name), &options, &file));
    ck_assert_int_eq(done_count(), COUNT);
}
END_TEST

START_TEST(another_scan_is_refused_or_replaced) {
    const char *name = names[_i];
    if (!is_possible(name)) return;
    ck_skg(skg_scan_file_open(in_folder(name), &options, &file));
    put(4);
    skg_scan_file_release(&file);
    options.hash = other;
    ck_skg_fails(skg_scan_file_open(in_folder(name), &options, &file), SKG_ERR_OUTPUT, "is another scan");
    ck_assert_ptr_null(file);
    options.overwrite = 1;
    ck_skg(skg_scan_file_open(in_folder(name), &options, &file));
    ck_assert_int_eq(done_count(), 0);
    skg_scan_file_release(&file);
    options.samples = 4;
    ck_skg_fails(skg_scan_file_open(in_folder(name), &options, &file), SKG_ERR_ARGUMENT, "3 source samples");
}
END_TEST

/* A file that was there before is never lost. */
START_TEST(what_is_no_scan_is_refused) {
    for (int n = 0; n < KINDS; n++) {
        if (strcmp(names[n], "folder") == 0 || !is_possible(names[n])) continue;
        FILE *stream = fopen(in_folder(names[n]), "wb");
        ck_assert_ptr_nonnull(stream);
        fputs("letters", stream);
        fclose(stream);
        ck_skg_fails(skg_scan_file_open(path, &options, &file), SKG_ERR_OUTPUT, "is no scan");
        struct stat there;
        ck_assert(stat(path, &there) == 0 && there.st_size == 7);
    }
    ck_skg_fails(skg_scan_file_open(in_folder("scan.mha/none.mha"), &options, &file), SKG_ERR_OUTPUT, "");
    ck_skg_fails(skg_scan_file_open(in_folder("a.png"), &options, &file), SKG_ERR_ARGUMENT,
                 ".png is no format");
    ck_assert_int_eq(files_in_folder(), is_possible("scan.h5") ? 4 : 3);
}
END_TEST

START_TEST(a_file_of_another_length_is_refused) {
    ck_skg(skg_scan_file_open(in_folder("scan.mha"), &options, &file));
    skg_scan_file_release(&file);
    ck_assert_int_eq(truncate(path, 1000), 0);
    ck_skg_fails(skg_scan_file_open(path, &options, &file), SKG_ERR_OUTPUT, "has 1000 bytes");
}
END_TEST

/* A lock is between processes: a child tries. */
START_TEST(one_writer_at_a_time) {
    int status = 0;
    ck_skg(skg_scan_file_open(in_folder("scan.mha"), &options, &file));
    fflush(NULL);
    const pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child == 0) {
        skg_scan_file *mine = NULL;
        const int refused = skg_scan_file_open(path, &options, &mine) == SKG_ERR_OUTPUT;
        char who[64];
        snprintf(who, sizeof who, "process %ld on ", (long)getppid());
        _exit(refused && strstr(skg_last_error(), who) ? 0 : 1);
    }
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    options.helper = 1; /* who only helps needs no lock */
    skg_scan_file *helper = NULL;
    ck_skg(skg_scan_file_open(path, &options, &helper));
    const int64_t one = 1;
    ck_skg(skg_scan_file_write(helper, 1, &one, images[1], NULL));
    skg_scan_file_release(&helper);
    for (int64_t k = 0; k < COUNT; k++)
        if (k != 1) put(k);
    ck_skg(skg_scan_file_finish(file)); /* sees what the helper wrote */
    ck_assert(!has("scan.mha.progress"));
}
END_TEST

/* A second writer of this process is refused too, also by another way to the folder, and its end takes no lock away. The
 * child of a fork neither has its parent's lock nor ends it. */
START_TEST(one_writer_within_a_process) {
    char link[80], through[256];
    skg_scan_file *second = NULL;
    for (int n = 0; n < KINDS; n++) {
        int status = 0;
        if (!is_possible(names[n])) continue;
        ck_skg(skg_scan_file_open(in_folder(names[n]), &options, &file));
        ck_skg_fails(skg_scan_file_open(path, &options, &second), SKG_ERR_OUTPUT, "locked: this process");
        snprintf(link, sizeof link, "%s-link", folder);
        snprintf(through, sizeof through, "%s/%s", link, names[n]);
        ck_assert_int_eq(symlink(folder, link), 0);
        ck_skg_fails(skg_scan_file_open(through, &options, &second), SKG_ERR_OUTPUT, "locked: this process");
        ck_assert_int_eq(unlink(link), 0);
        snprintf(through, sizeof through, "%s/link-%s", folder, names[n]); /* a link to the output itself */
        if (through[strlen(through) - 1] == '/') through[strlen(through) - 1] = '\0';
        ck_assert_int_eq(symlink(path, through), 0);
        ck_skg_fails(skg_scan_file_open(through, &options, &second), SKG_ERR_OUTPUT, "locked: this process");
        ck_assert_int_eq(unlink(through), 0);
        fflush(NULL);
        const pid_t child = fork();
        ck_assert_int_ge(child, 0);
        if (child == 0) {
            const int refused = skg_scan_file_open(path, &options, &second) == SKG_ERR_OUTPUT;
            skg_scan_file_release(&file);
            _exit(refused && skg_scan_file_open(path, &options, &second) == SKG_ERR_OUTPUT ? 0 : 1);
        }
        ck_assert_int_eq(waitpid(child, &status, 0), child);
        ck_assert(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        skg_scan_file_release(&file);
        ck_skg(skg_scan_file_open(path, &options, &file));
        skg_scan_file_release(&file);
    }
}
END_TEST

/* Files that a killed writer left go when the next one has the lock; files of other names stay. */
START_TEST(leftovers_are_removed) {
    static const struct {
        const char *scan, *left;
    } cases[] = {{"scan.mha", "scan.mha.part-1-0badcafe"},
                 {"scan.mha", "scan.mha.progress.part-1-0badcafe"},
                 {"scan.raw", "scan.raw.part-1"},
                 {"scan.raw", "scan.mhd.part-1-0badcafe-3"},
                 {"scan.tif", "scan.tif.part-1-0badcafe"},
                 {"scan.h5", "scan.h5.part-1-0badcafe"},
                 {"folder", "folder/scan.txt.part-1-0badcafe"},
                 {"folder", "folder/projection-00003.tif.part-1-0badcafe"}};
    static const char *const others[] = {"scan.mha.part-of-mine", "other.mha.part-1-0badcafe",
                                         "scan.mha.partly", "folder/mine.part-1-0badcafe"};
    ck_assert_int_eq(mkdir(in_folder("folder"), 0777), 0);
    for (size_t o = 0; o < sizeof others / sizeof *others; o++) fclose(fopen(in_folder(others[o]), "wb"));
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        if (!is_possible(cases[c].scan)) continue;
        fclose(fopen(in_folder(cases[c].left), "wb"));
        ck_skg(skg_scan_file_open(in_folder(cases[c].scan), &options, &file));
        skg_scan_file_release(&file);
        ck_assert_msg(!has(cases[c].left), "%s is left", cases[c].left);
    }
    for (size_t o = 0; o < sizeof others / sizeof *others; o++)
        ck_assert_msg(has(others[o]), "%s", others[o]);
}
END_TEST

/* A scan that cannot be laid out leaves nothing. */
START_TEST(a_full_disk_leaves_nothing) {
    const struct rlimit small = {1 << 10, 1 << 10};
    for (int n = 0; n < KINDS; n++) {
        int status = 0;
        if (strcmp(names[n], "folder") == 0 || !is_possible(names[n])) continue;
        fflush(NULL);
        const pid_t child = fork();
        ck_assert_int_ge(child, 0);
        if (child == 0) {
            signal(SIGXFSZ, SIG_IGN);
            setrlimit(RLIMIT_FSIZE, &small);
            _exit(skg_scan_file_open(in_folder(names[n]), &options, &file) == SKG_ERR_OUTPUT ? 0 : 1);
        }
        ck_assert_int_eq(waitpid(child, &status, 0), child);
        ck_assert_msg(WIFEXITED(status) && WEXITSTATUS(status) == 0, "%s", names[n]);
        ck_assert_msg(files_in_folder() == 0, "%s leaves a file", names[n]);
    }
}
END_TEST

/* Changes one byte of a projection, as a bad disk would. */
static void flip(const char *name, int64_t index) {
    const size_t image = PIXELS * sizeof(float);
    FILE *stream = fopen(in_folder(name), "r+b");
    ck_assert_ptr_nonnull(stream);
    static char text[1 << 20];
    const size_t size = fread(text, 1, sizeof text, stream);
    size_t at = 0;
    while (at + image <= size && memcmp(text + at, images[index], image) != 0) at++;
    ck_assert_uint_le(at + image, size);
    ck_assert_int_eq(fseek(stream, (long)(at + image / 2), SEEK_SET), 0);
    fputc(text[at + image / 2] ^ 4, stream);
    fclose(stream);
}

static int is_done(int64_t index) {
    int32_t done = -1;
    ck_skg(skg_scan_file_done_get(file, index, &done));
    return done;
}

/* A flipped byte is found when a scan continues, and only that projection is missing then. */
START_TEST(a_damaged_projection_is_missing) {
    const char *name = names[_i];
    int64_t damaged = -1;
    if (strcmp(name, "folder") == 0 || !is_possible(name)) return;
    ck_skg(skg_scan_file_open(in_folder(name), &options, &file));
    for (int64_t k = 0; k < COUNT - 1; k++) put(k);
    skg_scan_file_release(&file);
    ck_skg(skg_scan_file_open(in_folder(name), &options, &file));
    ck_skg(skg_scan_file_damaged_count(file, &damaged));
    ck_assert_int_eq(damaged, 0);
    skg_scan_file_release(&file);
    flip(name, 3);
    ck_skg(skg_scan_file_open(in_folder(name), &options, &file));
    ck_skg(skg_scan_file_damaged_count(file, &damaged));
    ck_assert_int_eq(damaged, 1);
    for (int64_t k = 0; k < COUNT; k++) ck_assert_int_eq(is_done(k), k != 3 && k != COUNT - 1);
    put(3);
    put(COUNT - 1);
    ck_skg(skg_scan_file_verify(file));
    ck_assert_int_eq(done_count(), COUNT);
    ck_skg(skg_scan_file_finish(file));
    skg_scan_file_release(&file);
    if (strcmp(name, "scan.h5") != 0) {
        ck_values(name);
        ck_skg(skg_scan_file_open(in_folder(name), &options, &file));
        ck_skg_fails(skg_scan_file_verify(file), SKG_ERR_UNSUPPORTED, "has no checksums");
        return;
    }
    flip(name, 5); /* a finished .h5 keeps its checksums, and is read on demand */
    ck_skg(skg_scan_file_open(in_folder(name), &options, &file));
    ck_assert_int_eq(done_count(), COUNT);
    ck_skg(skg_scan_file_verify(file));
    ck_assert_int_eq(done_count(), COUNT - 1);
    ck_assert_int_eq(is_done(5), 0);
    skg_scan_file_release(&file);
    ck_skg(skg_scan_file_open(in_folder(name), &options, &file));
    ck_assert_int_eq(is_done(5), 0); /* the next one computes it */
}
END_TEST

/* Damaged projections of a part do not reach the whole. */
START_TEST(joining_leaves_damage_out) {
    skg_scan_file *part = NULL;
    if (!is_possible("part.h5")) return;
    ck_skg(skg_scan_file_open(in_folder("part.h5"), &options, &file));
    for (int64_t k = 0; k < COUNT; k++) put(k);
    skg_scan_file_release(&file);
    flip("part.h5", 2);
    ck_skg(skg_scan_file_open(in_folder("part.h5"), &options, &part));
    ck_skg(skg_scan_file_open(in_folder("whole.h5"), &options, &file));
    ck_skg(skg_scan_file_join(file, part));
    for (int64_t k = 0; k < COUNT; k++) ck_assert_int_eq(is_done(k), k != 2);
    skg_scan_file_release(&part);
}
END_TEST

START_TEST(what_is_missing_is_refused) {
    options.hash = "short";
    ck_skg_fails(skg_scan_file_open(in_folder("scan.mha"), &options, &file), SKG_ERR_ARGUMENT,
                 "64 hexadecimal");
    options.hash = hash;
    options.type = 5;
    ck_skg_fails(skg_scan_file_open(in_folder("scan.mha"), &options, &file), SKG_ERR_ARGUMENT, "type 5");
    options.type = SKG_TYPE_FLOAT32;
    options.helper = 1;
    ck_skg_fails(skg_scan_file_open(in_folder("scan.mha"), &options, &file), SKG_ERR_OUTPUT, "not laid out");
    options.helper = 0;
    ck_skg(skg_scan_file_open(in_folder("scan.mha"), &options, &file));
    const int64_t beyond = COUNT;
    ck_skg_fails(skg_scan_file_write(file, 1, &beyond, images, NULL), SKG_ERR_ARGUMENT, "no projection 9");
}
END_TEST

/* Projections that are large enough for the way past the page cache: of whole blocks of the disk or not, from aligned
 * memory or not, several at a time or one. The bytes are what was written, whatever way they took. */
START_TEST(large_projections_arrive_whole) {
    enum { COLUMNS_LARGE = 256, PAGE = 4096, FIRST = 5, LATER = COUNT - FIRST };
    static const int64_t order[COUNT] = {2, 3, 4, 5, 6, 8, 0, 1, 7};
    static const char *const kinds[] = {"scan.mha", "scan.raw", "scan.tif"};
    const int64_t rows = _i % 2 ? 250 : 256, pixels = COLUMNS_LARGE * rows;
    const size_t bytes = (size_t)(COUNT * pixels) * sizeof(float), offset = _i / 2 % 2 ? 12 : 0;
    char *memory = aligned_alloc(PAGE, bytes / PAGE * PAGE + 2 * PAGE), *read = malloc(bytes);
    skg_scan_options geometry;
    skg_view view;
    ck_assert(memory && read);
    skg_view_init(&view);
    ck_skg(skg_scan_view_get(scan, 0, &view));
    view.columns = COLUMNS_LARGE;
    view.rows = rows;
    skg_scan_options_init(&geometry);
    geometry.projections = COUNT;
    skg_scan_release(&scan);
    ck_skg(skg_scan_create(&view, &geometry, &scan));
    options.scan = scan;
    float *values = (float *)(void *)(memory + offset);
    for (int k = 0; k < COUNT; k++)
        for (int64_t i = 0; i < pixels; i++) values[k * pixels + i] = (float)(order[k] * pixels + i);
    const char *name = kinds[_i / 4];
    ck_skg(skg_scan_file_open(in_folder(name), &options, &file));
    ck_skg(skg_scan_file_write(file, FIRST, order, values, NULL));
    ck_skg(skg_scan_file_write(file, LATER, order + FIRST, values + FIRST * pixels, NULL));
    ck_skg(skg_scan_file_finish(file));
    FILE *stream = fopen(in_folder(name), "rb");
    ck_assert_ptr_nonnull(stream);
    ck_assert_int_eq(fseek(stream, -(long)bytes, SEEK_END), 0);
    ck_assert_uint_eq(fread(read, 1, bytes, stream), bytes);
    fclose(stream);
    int64_t wrong = 0;
    for (int64_t i = 0; i < COUNT * pixels; i++) wrong += ((float *)(void *)read)[i] != (float)i;
    ck_assert_int_eq(wrong, 0);
    free(memory);
    free(read);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_loop_test(tests, large_projections_arrive_whole, 0, 12);
    tcase_add_loop_test(tests, what_is_written_is_found_again, 0, KINDS);
    tcase_add_loop_test(tests, another_scan_is_refused_or_replaced, 0, KINDS);
    tcase_add_test(tests, what_is_no_scan_is_refused);
    tcase_add_test(tests, a_file_of_another_length_is_refused);
    tcase_add_test(tests, one_writer_at_a_time);
    tcase_add_loop_test(tests, a_damaged_projection_is_missing, 0, KINDS);
    tcase_add_test(tests, joining_leaves_damage_out);
    tcase_add_test(tests, one_writer_within_a_process);
    tcase_add_test(tests, leftovers_are_removed);
    tcase_add_test(tests, a_full_disk_leaves_nothing);
    tcase_add_test(tests, what_is_missing_is_refused);
}

SKG_SUITE_MAIN("scan_file", add_tests)
