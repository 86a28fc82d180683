/* The attenuation: what pixels show of their planes, and its tables on the device. Private. */
#ifndef SKG_ATTENUATION_H
#define SKG_ATTENUATION_H

#include "spectral/shading.h"
#include "stage/raster.h"

/* How planes become what is shown. The exponent of node n is the sum over planes of coefficient[n][p] times the mm of
 * plane p; a channel shows the sum over nodes of weight[n][c] exp(-exponent). The tables are on the device. */
typedef struct {
    int32_t planes, nodes; /* planes: the shades are the last, and are not accumulated */
    int32_t channels;      /* layers of a channel of the image included */
    int32_t layers;        /* that add up to a channel of the image */
    int32_t shown;         /* SKG_SHOW_... */
    int32_t world_plane;   /* that the world's path adds to; -1: vacuum */
    int32_t ratio;         /* 1: divided by what the world alone transmits */
    int32_t falloff;       /* 1: intensities fall with the distance */
    int32_t energies;      /* 1: shows keV, which half precision stores in MeV */
    int32_t noise;         /* 1: quantum noise is drawn; then intensities are no ratio */
    int32_t apart;       /* 1, with noise: deviations are written behind the channels, apart from the means */
    int32_t collimated;  /* 1: rays outside the window are stopped; never of flat fields */
    int32_t window[4];   /* of a pass: columns from, columns to, rows from, rows to */
    double world_weight; /* of a mm of the world's path in its plane */
    const skg_shades *shades; /* borrowed; count 0, or NULL: none */
    skg_buffer coefficients, weights, variances;
    skg_buffer polynomials, tables; /* of shades */
    /* [planes][2] mm: lowest and highest that an error bound holds for; none: not checked */
    skg_buffer range;
} skg_attenuation;

/* The tables as the host gives them. */
typedef struct {
    const double *coefficients; /* [nodes][planes] */
    const double *weights;      /* [nodes][channels] */
    const double *variances;    /* [nodes][channels] with noise; else NULL */
    const double *range;        /* [planes][2]; NULL: not checked */
} skg_attenuation_tables;

/* shape: planes, nodes, channels and what is shown. The tables are copied. */
skg_status skg_attenuation_create(skg_context *context, int32_t precision, const skg_attenuation *shape,
                                  const skg_attenuation_tables *tables, skg_attenuation *attenuation);
void skg_attenuation_release(skg_attenuation *attenuation);

/* Bytes on the device. */
int64_t skg_attenuation_bytes(const skg_attenuation *attenuation);

/* Shades among its planes. */
static inline int32_t skg_attenuation_shades(const skg_attenuation *attenuation) {
    return attenuation->shades ? attenuation->shades->count : 0;
}

/* Writes numbers to the device, as floats or as doubles. */
skg_status skg_attenuation_upload(skg_context *context, int32_t is_double, int64_t count,
                                  const double *numbers, skg_buffer *buffer);

/* log2 of e, to the precision of a double: the kernel takes powers of two. */
#define SKG_LOG2_E 1.4426950408889634

#endif
