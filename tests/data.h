/* Measured and published tables that are not part of the repository: in $SKG_DATA, or ../shared/data beside
 * the checkout. */
#ifndef SKG_TESTS_DATA_H
#define SKG_TESTS_DATA_H

#include <stdio.h>
#include <stdlib.h>

/* The file, or NULL after a line that says why its test is skipped. */
static inline FILE *open_data(const char *name) {
    const char *folder = getenv("SKG_DATA");
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder && *folder ? folder : SKG_SOURCE "/../shared/data", name);
    FILE *file = fopen(path, "r");
    if (!file) printf("skipped: %s is not there (SKG_DATA names its folder)\n", path);
    return file;
}

#endif
