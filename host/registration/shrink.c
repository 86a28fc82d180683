/* Views and images of coarser pixels. */
#include "registration/types.h"

skg_view reg_view_shrunk(const skg_view *view, int64_t factor) {
    skg_view shrunk = *view;
    shrunk.columns = view->columns / factor;
    shrunk.rows = view->rows / factor;
    /* Columns and rows that are left over at the end are left out. */
    const double c = 0.5 * (double)(shrunk.columns * factor - view->columns),
                 l = 0.5 * (double)(shrunk.rows * factor - view->rows);
    skg_add_scaled(shrunk.centre, c, view->column_step, shrunk.centre);
    skg_add_scaled(shrunk.centre, l, view->row_step, shrunk.centre);
    skg_scale_vector((double)factor, view->column_step, shrunk.column_step);
    skg_scale_vector((double)factor, view->row_step, shrunk.row_step);
    return shrunk;
}

void reg_shrink(const skg_view *view, int64_t factor, const double *from, double *to) {
    const int64_t rows = view->rows / factor, columns = view->columns / factor;
    for (int64_t l = 0; l < rows; l++)
        for (int64_t c = 0; c < columns; c++) {
            double sum = 0;
            for (int64_t y = 0; y < factor; y++)
                for (int64_t x = 0; x < factor; x++)
                    sum += from[(l * factor + y) * view->columns + c * factor + x];
            to[l * columns + c] = sum / (double)(factor * factor);
        }
}
