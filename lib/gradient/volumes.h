/* The share of the cells of volumes in derivatives by the places of parts that displace them. Private. */
#ifndef SKG_GRADIENT_VOLUMES_H
#define SKG_GRADIENT_VOLUMES_H

#include "gradient/gather_run.h"

/* Adds to memory->slopes, behind skg_hits_slopes. */
skg_status skg_gather_volumes(const skg_gather_run *run);

/* No slope of a hit becomes larger by it. most: [planes] */
double skg_gather_volumes_bound(const skg_gather_run *run, const double *most);

/* Marks the planes that the cells of these parts add to. parts: NULL: all */
void skg_volumes_mark(const skg_volumes *volumes, const uint8_t *parts, int32_t *planes);

#endif
