/* Files in the user's folder: kept, damaged, removed. */
#include "device/cache.h"
#include "device/cache_folder.h"
#include "suite.h"

#include "core/core.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>

static skg_digest key_of(const char *text) {
    return skg_digest_of(text, strlen(text));
}

static void keep(const char *name, const char *text) {
    const skg_digest key = key_of(name);
    ck_assert_int_eq(skg_store_write(cache_folder, &key, SKG_KEPT_PROGRAM, text, (int64_t)strlen(text)), 1);
}

/* 1: the text is kept under this name */
static int is_kept(const char *name, const char *text) {
    const skg_digest key = key_of(name);
    void *data = NULL;
    int64_t bytes = 0;
    if (!skg_store_read(cache_folder, &key, SKG_KEPT_PROGRAM, &data, &bytes)) {
        ck_assert_ptr_null(data);
        return 0;
    }
    const int same = bytes == (int64_t)strlen(text) && memcmp(data, text, (size_t)bytes) == 0;
    skg_free(&data);
    return same;
}

START_TEST(what_is_written_is_read) {
    const skg_digest key = key_of("b");
    keep("a", "one");
    keep("b", "two");
    keep("a", "three");
    ck_assert_int_eq(is_kept("a", "three"), 1);
    ck_assert_int_eq(is_kept("b", "two"), 1);
    ck_assert_int_eq(is_kept("c", ""), 0);
    skg_store_remove(cache_folder, &key, SKG_KEPT_VERDICT); /* another kind */
    ck_assert_int_eq(is_kept("b", "two"), 1);
    skg_store_remove(cache_folder, &key, SKG_KEPT_PROGRAM);
    ck_assert_int_eq(is_kept("b", "two"), 0);
    ck_assert_int_eq(count_kept("", NULL), 1); /* no temporary file is left */
}
END_TEST

/* Changes byte `at` of the only file. */
static void damage(long at) {
    char path[512];
    ck_assert_int_eq(count_kept(".program", path), 1);
    FILE *file = fopen(path, "r+b");
    ck_assert_ptr_nonnull(file);
    ck_assert_int_eq(fseek(file, at, SEEK_SET), 0);
    const int byte = fgetc(file);
    ck_assert_int_eq(fseek(file, at, SEEK_SET), 0);
    fputc(byte ^ 1, file);
    fclose(file);
}

/* The driver runs what is read, so that a changed byte, a lost end and a wrong name must all be found. */
START_TEST(damaged_files_are_removed) {
    enum { HEADER = 64, CONTENT = 7 };
    char path[512], other[512];
    for (long at = 0; at < HEADER + CONTENT; at++) {
        keep("a", "content");
        ck_assert_int_eq(is_kept("a", "content"), 1);
        damage(at);
        ck_assert_msg(!is_kept("a", "content"), "byte %ld", at);
        ck_assert_int_eq(count_kept("", NULL), 0);
    }
    for (int bytes = 0; bytes < HEADER + CONTENT; bytes++) {
        keep("a", "content");
        count_kept(".program", path);
        ck_assert_int_eq(truncate(path, bytes), 0);
        ck_assert_int_eq(is_kept("a", "content"), 0);
    }
    keep("a", "content");
    count_kept(".program", path);
    keep("b", "other");
    char text[SKG_DIGEST_TEXT];
    const skg_digest key = key_of("b");
    skg_digest_text(&key, text);
    snprintf(other, sizeof other, "%s/%s.program", cache_folder, text);
    ck_assert_int_eq(rename(path, other), 0); /* what was kept under a stands under b's name */
    ck_assert_int_eq(is_kept("b", "content"), 0);
}
END_TEST

START_TEST(what_others_may_write_is_not_read) {
    char path[512], target[600];
    keep("a", "content");
    count_kept(".program", path);
    ck_assert_int_eq(chmod(cache_folder, 0777), 0);
    ck_assert_int_eq(is_kept("a", "content"), 0);
    const skg_digest key = key_of("b");
    ck_assert_int_eq(skg_store_write(cache_folder, &key, SKG_KEPT_PROGRAM, "x", 1), 0);
    ck_assert_int_eq(chmod(cache_folder, 0700), 0);
    ck_assert_int_eq(is_kept("a", "content"), 1);
    ck_assert_int_eq(chmod(path, 0666), 0);
    ck_assert_int_eq(is_kept("a", "content"), 0);
    keep("a", "content");
    snprintf(target, sizeof target, "%s.moved", path);
    ck_assert_int_eq(rename(path, target), 0);
    ck_assert_int_eq(symlink(target, path), 0);
    ck_assert_int_eq(is_kept("a", "content"), 0); /* a link is not followed */
    if (geteuid() == 0) {
        keep("a", "content");
        ck_assert_int_eq(chown(cache_folder, 65534, 65534), 0);
        ck_assert_int_eq(is_kept("a", "content"), 0);
        ck_assert_int_eq(chown(cache_folder, 0, 0), 0);
    }
}
END_TEST

START_TEST(the_folder_is_made_private) {
    char path[SKG_STORE_PATH];
    struct stat status;
    const skg_digest key = key_of("a");
    snprintf(path, sizeof path, "%s/x/skiagraph", cache_folder);
    ck_assert_int_eq(skg_store_write(path, &key, SKG_KEPT_PROGRAM, "", 0), 1);
    ck_assert_int_eq(stat(path, &status), 0);
    ck_assert_uint_eq(status.st_mode & 0777, 0700);
    skg_store_remove(path, &key, SKG_KEPT_PROGRAM);
    ck_assert_int_eq(rmdir(path), 0);
    snprintf(path, sizeof path, "%s/x", cache_folder);
    ck_assert_int_eq(rmdir(path), 0);
    ck_assert_int_eq(skg_store_write("/dev/null/cache", &key, SKG_KEPT_PROGRAM, "", 0), 0);
    ck_assert_int_eq(skg_store_write("", &key, SKG_KEPT_PROGRAM, "", 0), 0);
}
END_TEST

START_TEST(the_environment_names_the_folder) {
    char path[SKG_STORE_PATH], lengthy[2 * SKG_STORE_PATH];
    skg_store_find(path);
    ck_assert_str_eq(path, cache_folder);
    setenv("SKG_CACHE_DIR", "none", 1);
    skg_store_find(path);
    ck_assert_str_eq(path, "");
    setenv("SKG_CACHE_DIR", "", 1); /* as if it were not set */
    setenv("XDG_CACHE_HOME", "/x", 1);
    skg_store_find(path);
    ck_assert_str_eq(path, "/x/skiagraph");
    setenv("XDG_CACHE_HOME", "relative", 1); /* the standard says: to be ignored */
    setenv("HOME", "/h", 1);
    skg_store_find(path);
    ck_assert_str_eq(path, "/h/.cache/skiagraph");
    unsetenv("HOME");
    skg_store_find(path);
    ck_assert_str_eq(path, "");
    memset(lengthy, 'a', sizeof lengthy);
    lengthy[sizeof lengthy - 1] = '\0';
    setenv("SKG_CACHE_DIR", lengthy, 1);
    skg_store_find(path);
    ck_assert_str_eq(path, "");
}
END_TEST

/* Makes a file of a kept program's name with `mib` MiB of nothing, used `hours` ago. */
static void pretend(const char *name, const char *ending, long mib, long hours) {
    char path[256], text[SKG_DIGEST_TEXT];
    const skg_digest key = key_of(name);
    skg_digest_text(&key, text);
    snprintf(path, sizeof path, "%s/%s%s", cache_folder, text, ending);
    const int file = open(path, O_WRONLY | O_CREAT, 0600);
    ck_assert_int_ge(file, 0);
    ck_assert_int_eq(ftruncate(file, mib << 20), 0);
    const struct timespec then = {time(NULL) - hours * 3600, 0}, times[2] = {then, then};
    ck_assert_int_eq(futimens(file, times), 0);
    close(file);
}

START_TEST(the_folder_is_bounded) {
    pretend("old", ".program", 100, 300);
    pretend("older", ".program", 100, 400);
    pretend("new", ".program", 100, 200);
    pretend("died", ".program.1.0.part", 1, 2);
    pretend("now", ".program.2.0.part", 1, 0); /* another process may be writing it */
    char path[128];
    snprintf(path, sizeof path, "%s/README", cache_folder);
    fclose(fopen(path, "w"));
    keep("a", "content");
    ck_assert_int_eq(count_kept(".program", NULL), 3); /* the oldest is gone */
    ck_assert_int_eq(count_kept(".part", NULL), 1);
    ck_assert_int_eq(count_kept("README", NULL), 1);
    ck_assert_int_eq(is_kept("a", "content"), 1);
}
END_TEST

/* Reading counts as a use. */
START_TEST(use_is_noted) {
    char path[512];
    struct stat status;
    keep("a", "content");
    count_kept(".program", path);
    const struct timespec then = {time(NULL) - 7200, 0}, times[2] = {then, then};
    ck_assert_int_eq(utimensat(AT_FDCWD, path, times, 0), 0);
    ck_assert_int_eq(is_kept("a", "content"), 1);
    ck_assert_int_eq(stat(path, &status), 0);
    ck_assert_int_gt(status.st_mtime, then.tv_sec + 3600);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, make_cache_folder, remove_cache_folder);
    tcase_add_test(tests, what_is_written_is_read);
    tcase_add_test(tests, damaged_files_are_removed);
    tcase_add_test(tests, what_others_may_write_is_not_read);
    tcase_add_test(tests, the_folder_is_made_private);
    tcase_add_test(tests, the_environment_names_the_folder);
    tcase_add_test(tests, the_folder_is_bounded);
    tcase_add_test(tests, use_is_noted);
}

SKG_SUITE_MAIN("store", add_tests)
