/* Measured and published tables and meshes that are not part of the repository: in the folder $SKG_DATA, or in
 * ../shared/data beside the checkout. A test that does not find them is skipped (skip_test). */
#ifndef SKG_TESTS_DATA_H
#define SKG_TESTS_DATA_H

#include "suite.h"

#include <stdio.h>
#include <stdlib.h>

enum { DATA_PATH = 1024 };

/* The path of a file or folder of the data, whether it exists or not. */
static inline const char *data_path(const char *name, char path[DATA_PATH]) {
    const char *folder = getenv("SKG_DATA");
    snprintf(path, DATA_PATH, "%s/%s", folder && *folder ? folder : SKG_SOURCE "/../shared/data", name);
    return path;
}

/* Opens a file of the data or skips the test. */
#define open_data(file, name)                                                                                \
    do {                                                                                                     \
        char data_file[DATA_PATH];                                                                           \
        file = fopen(data_path(name, data_file), "r");                                                       \
        if (!file) skip_test("%s is missing; SKG_DATA names its folder", data_file);                         \
    } while (0)

#endif
