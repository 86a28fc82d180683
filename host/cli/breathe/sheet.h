/* The contact sheet: small pictures of up to 16 frames, side by side. */
#ifndef SKG_CLI_SHEET_H
#define SKG_CLI_SHEET_H

#include "breathe/fluoroscopy.h"

typedef struct {
    int64_t frames, across, down;
    int64_t step;          /* a block of step x step pixels of a frame becomes one pixel */
    int64_t columns, rows; /* of a small picture */
    float *values;
} contact_sheet;

/* Functions that return int return an exit status and print the error. The caller frees sheet->values. */
int sheet_create(const fluoroscopy *f, int64_t frames, contact_sheet *sheet);

/* Adds image[which], frame number `frame` of `frames`, if it is one of those shown. */
void sheet_add(const fluoroscopy *f, int which, int64_t frame, int64_t frames, contact_sheet *sheet);
int sheet_write(const fluoroscopy *f, const contact_sheet *sheet, const char *path);

#endif
