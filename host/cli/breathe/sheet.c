/* Frames of a breath side by side in one picture. */
#include "breathe/outputs.h"

#include "common/say.h"

#include <stdlib.h>

enum { SMALL_MAX = 16, ACROSS = 4, SMALL_COLUMNS = 256, GAP = 4 };

static int64_t sheet_columns(const contact_sheet *sheet) {
    return sheet->across * (sheet->columns + GAP) - GAP;
}

static int64_t sheet_rows(const contact_sheet *sheet) {
    return sheet->down * (sheet->rows + GAP) - GAP;
}

int sheet_create(const fluoroscopy *f, int64_t frames, contact_sheet *sheet) {
    const skg_view *view = &f->session.view;
    sheet->frames = frames < SMALL_MAX ? frames : SMALL_MAX;
    sheet->across = sheet->frames < ACROSS ? sheet->frames : ACROSS;
    sheet->down = (sheet->frames + sheet->across - 1) / sheet->across;
    sheet->step = (view->columns + SMALL_COLUMNS - 1) / SMALL_COLUMNS;
    sheet->columns = (view->columns + sheet->step - 1) / sheet->step;
    sheet->rows = (view->rows + sheet->step - 1) / sheet->step;
    sheet->values = calloc((size_t)(sheet_columns(sheet) * sheet_rows(sheet)), sizeof *sheet->values);
    return sheet->values ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory for the contact sheet");
}

/* The mean of a block of pixels, as far as it lies inside the frame. */
static float mean_of(const fluoroscopy *f, const float *image, int64_t step, int64_t column, int64_t row) {
    const skg_view *view = &f->session.view;
    double sum = 0;
    int64_t count = 0;
    for (int64_t r = row * step; r < (row + 1) * step && r < view->rows; r++)
        for (int64_t c = column * step; c < (column + 1) * step && c < view->columns; c++) {
            const double value = (double)image[r * view->columns + c];
            sum += value > f->high ? f->high : value;
            count++;
        }
    return (float)(sum / (double)count);
}

void sheet_add(const fluoroscopy *f, int which, int64_t frame, int64_t frames, contact_sheet *sheet) {
    for (int64_t k = 0; k < sheet->frames; k++) {
        if (k * frames / sheet->frames != frame) continue;
        float *to = sheet->values + k / sheet->across * (sheet->rows + GAP) * sheet_columns(sheet) +
                    k % sheet->across * (sheet->columns + GAP);
        for (int64_t r = 0; r < sheet->rows; r++)
            for (int64_t c = 0; c < sheet->columns; c++)
                to[r * sheet_columns(sheet) + c] = mean_of(f, f->image[which], sheet->step, c, r);
    }
}

int sheet_write(const fluoroscopy *f, const contact_sheet *sheet, const char *path) {
    skg_picture picture;
    fluoroscopy_picture(f, sheet_columns(sheet), sheet_rows(sheet), sheet->values, &picture);
    skg_status status = skg_picture_save(&picture, path);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}
