/* A picture of two channels and a folder for its files. */
#ifndef SKG_TESTS_IMAGE_FILES_H
#define SKG_TESTS_IMAGE_FILES_H

#include "suite.h"

#include <skiagraph/image.h>

#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { COLUMNS = 7, ROWS = 5, PIXELS = COLUMNS * ROWS, CHANNELS = 2 };

static char folder[64], path[128];
static float floats[CHANNELS * PIXELS];
static double doubles[CHANNELS * PIXELS];
static skg_view view;

static inline void set_up(void) {
    strcpy(folder, "/tmp/skg-image-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    for (int i = 0; i < CHANNELS * PIXELS; i++) {
        doubles[i] = 1.0 / 3 + i * 1000.0 / 7;
        floats[i] = (float)doubles[i];
    }
    skg_view_init(&view);
    view.columns = COLUMNS;
    view.rows = ROWS;
    view.source[1] = -400;
    /* columns along (0.6, 0, 0.8) and rows along -y: a third axis of (0.8, 0, -0.6) */
    view.centre[0] = 10, view.centre[1] = 20, view.centre[2] = 30;
    view.column_step[0] = 0.6 * 0.5, view.column_step[1] = 0, view.column_step[2] = 0.8 * 0.5;
    view.row_step[0] = 0, view.row_step[1] = -0.25, view.row_step[2] = 0;
}

static inline int files_in_folder(void) {
    int count = 0;
    DIR *directory = opendir(folder);
    ck_assert_ptr_nonnull(directory);
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory))
        count += entry->d_name[0] != '.';
    closedir(directory);
    return count;
}

static inline void tear_down(void) {
    static const char *const names[] = {"a.png", "a.tif", "A.TIFF", "a.mha"};
    for (int i = 0; i < 4; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        unlink(path);
    }
    ck_assert_int_eq(rmdir(folder), 0);
}

static inline const char *at(const char *name) {
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static inline skg_picture picture_of(int32_t type) {
    skg_picture picture;
    skg_picture_init(&picture);
    picture.type = type;
    picture.columns = COLUMNS;
    picture.rows = ROWS;
    picture.data = type == SKG_TYPE_FLOAT64 ? (const void *)doubles : (const void *)floats;
    picture.name = "energy";
    picture.unit = "keV per pixel";
    picture.view = &view;
    return picture;
}

#endif
