/* The inside of a volume of cells. Private. */
#ifndef SKG_VOLUME_PRIVATE_H
#define SKG_VOLUME_PRIVATE_H

#include "core/core.h"

#include <skiagraph/mesh.h>
#include <skiagraph/volume.h>

/* Sentences about a volume, at most: of values below 0; of its file's unit, the size of its cells, the order of its bytes, what its
 * numbers are. */
enum { SKG_VOLUME_REMARKS = 5 };

typedef struct {
    int32_t level; /* enum skg_log_level */
    char text[256];
} skg_volume_remark;

/* A cell holds an amount of a curve: of the attenuation of one composition at 1 g/cm3 (SKG_VOLUME_MU: of 1/cm at every energy). Cells
 * of 16 bits are codes, of which a table says curve and amount. Cells of 32 bits are amounts of the only curve, in `unit`. */
struct skg_volume {
    skg_refs refs;
    char *name;
    int64_t size[3];   /* cells along the axes */
    double affine[16]; /* from (column, row, slice), of the centre of a cell, to mm */
    int32_t values;    /* enum skg_volume_values */
    int32_t wide;      /* 1: cells of 32 bits */
    int32_t linear;    /* 1: values change linearly between the centres of cells */
    void *cells;       /* uint16_t or int32_t */
    int64_t codes;     /* cells of 16 bits: of the table */
    double low, high;  /* least and greatest value */
    double unit;       /* wide */
    int64_t curve_count;
    skg_material **curves; /* [curve_count] retained */
    int32_t *curve_of;     /* [codes] */
    double *amounts;       /* [codes] */
    double *shares;        /* [curve_count] of the cells */
    double mean_amount;
    int64_t beyond;        /* cells above HU 3000 */
    skg_mesh *hull;        /* the box of all cells */
    skg_material *nothing; /* of the hull: cells add what is inside */
    int32_t remark_count;
    skg_volume_remark remarks[SKG_VOLUME_REMARKS];
};

/* Adds a sentence about a volume. level: enum skg_log_level */
void skg_volume_say(skg_volume *volume, int32_t level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

int64_t skg_volume_bytes(const skg_volume *volume);

/* The curve and the amount of a cell. at: its number, columns first */
int32_t skg_volume_cell(const skg_volume *volume, int64_t at, double *amount);

/* The inverse of pose times affine, for coordinates that are 0 and size at the ends of the cells: from mm to cells. */
void skg_volume_to_cells(const skg_volume *volume, const double *pose, double to_cells[16]);

/* Adds to amounts [curves] the integral of each curve's amount over the line from one point to another, both in coordinates of cells; a
 * unit is the whole line. */
void skg_volume_trace(const skg_volume *volume, const double from[3], const double to[3], double *amounts);

#endif
