/* The media of an object, and where faces of parts are in its cells. Private. */
#ifndef SKG_MEDIA_H
#define SKG_MEDIA_H

#include "scatter/voxels.h"

/* --- Media by their amounts, each once. All zero: none. */

typedef struct {
    const double *base; /* of skg_cell_parts, or NULL */
    int64_t count, capacity, slots;
    skg_mixture *mixtures;    /* [count] */
    skg_cell_amount *amounts; /* [count] of those that were found by them */
    uint32_t *slot;           /* [slots] 1 + the number of a medium, 0: free */
} skg_media;

/* The number of the medium with these amounts beyond the base, which is new if there is none. */
skg_status skg_media_find(skg_media *media, const skg_cell_amount amounts, uint32_t *number);

/* Adds a mixture as it is. */
skg_status skg_media_add(skg_media *media, const float *mixture, uint32_t *number);
void skg_media_free(skg_media *media);

/* --- Faces of parts in cells. Coordinates are in cells. */

/* The axes that may separate a triangle from a cube (T. Akenine-Moeller, Fast 3D triangle-box overlap testing, Journal of Graphics Tools 6
 * (2001) 29-33), with its shadow on each. They are found once for all cells. */
enum { SKG_FACE_AXES = 3 + 1 + 9 };
typedef struct {
    int count;
    double axis[SKG_FACE_AXES][3], low[SKG_FACE_AXES], high[SKG_FACE_AXES];
} skg_face_axes;
void skg_face_axes_find(const double corners[9], skg_face_axes *axes);

/* How large half the side of a cube may be, about the middle of the cell whose lowest corner is at `low`, in which the triangle has no
 * piece. The cell's is 1/2. From `enough` on it may be larger. */
double skg_face_distance(const skg_face_axes *axes, const double low[3], double enough);

/* The range of cells that hold a triangle's box: first to last along each side, from 0 to count - 1. */
void skg_face_cells(const double corners[9], const int64_t count[3], double margin, int64_t first[3],
                    int64_t last[3]);

/* Whether a line from one place to another crosses a triangle: 1 into the part, -1 out of it; 0: not. */
int skg_face_crossed(const double corners[9], const double from[3], const double to[3], double *share);

/* --- Leaps: so many cells on every side of a cell with a medium have the same word. Writes them into the words of the coarse cells. */

skg_status skg_cells_leap(const skg_cells *cells, uint32_t *words);

/* settled: [cells] 1 where a part may displace others, or, if children are clipped or parts united, where any part may be. Freed by the
 * caller. */
skg_status skg_cells_settled(const skg_cell_parts *parts, const skg_cells *cells, uint8_t **settled);

/* --- Growing lists. */

typedef struct {
    int64_t count, capacity;
    uint32_t *of;
} skg_words;

/* Makes room for `more` words behind the last, which are not set; *first: the number of the first of them. */
skg_status skg_words_grow(skg_words *words, int64_t more, int64_t *first);

#endif
