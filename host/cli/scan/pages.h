/* Images of one size in files: the pages of a stack, or the TIFFs of a folder. Functions that return int return an exit status and
 * print the error. */
#ifndef CLI_SCAN_PAGES_H
#define CLI_SCAN_PAGES_H

#include <skiagraph/skiagraph.h>

enum pages_kind { PAGES_PROJECTIONS, PAGES_FLATS, PAGES_DARKS };

typedef struct {
    char **paths; /* [files]: 1 of a stack, `count` of a folder */
    int64_t files, columns, rows, count;
    int32_t quantity; /* enum skg_quantity; -1: not known */
} pages;

int pages_is_folder(const char *path);

/* Opens a .mha, .mhd or .tif, a page for each image. */
int pages_open_stack(const char *path, pages *p);

/* Finds the TIFFs of a folder, in the order of their numbers: of projections NAME_0000.tif, without gaps, of fields NAME_flat_0000.tif
 * and NAME_dark.tif. Leaves count 0 if there are none of the kind. */
int pages_open_folder(const char *folder, enum pages_kind kind, pages *p);

/* Reads image k: [rows][columns]. */
int pages_read(const pages *p, int64_t k, double *values);

/* Frees the pages, also after a failure. */
void pages_close(pages *p);

#endif
