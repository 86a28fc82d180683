/* The geometry of a scan in the words of reconstruction tools, and what their writers share. Private. */
#ifndef SKG_TRAJECTORY_WRITERS_H
#define SKG_TRAJECTORY_WRITERS_H

#include "trajectory/types.h"

#include <stdio.h>

/* Axes of a tool's world as rows, and its origin, in the axes of the scan. */
typedef struct {
    double axes[3][3], origin[3];
} skg_tool_world;

/* The axes of the scan themselves. */
void skg_tool_world_init(skg_tool_world *world);

/* A scan as it turns: the view at angle 0, the axis with the first row of pixels at its lower end, and the direction from the
 * axis to the source. Both have the length 1. */
typedef struct {
    skg_view view;
    double up[3], front[3];
    int is_reversed; /* 1: `up` is opposite to the scan's axis */
} skg_tool_turn;

/* 0 if there is no such thing: of a table of poses without an axis, and of a source on the axis. */
int skg_tool_find_turn(const skg_scan *scan, skg_tool_turn *turn);

void skg_tool_direction(const skg_tool_world *world, const double *vector, double *result);
void skg_tool_point(const skg_tool_world *world, const double *point, double *result);

/* Directions of a detector's column step, row step and normal (column x row) in a tool's world, each of length 1. Fails if
 * the steps are not across each other. tool: for the message */
skg_status skg_tool_detector(const skg_tool_world *world, const skg_view *view, int64_t index,
                             const char *tool, double axes[3][3]);

/* Fails if the detector is curved. tool: for the message */
skg_status skg_tool_flat(const skg_view *view, int64_t index, const char *tool);

/* The lengths of both steps of a scan's detector. Fails if projections differ in them. */
skg_status skg_tool_pixel(const skg_scan *scan, const char *tool, double pixel_mm[2]);

/* Comment lines of a Python file: where the axes of a tool's world are. */
void skg_tool_write_world(const skg_tool_world *world, FILE *stream);

/* First words of a table of poses, by enum skg_projection. */
extern const char *const skg_scan_table_beams[];

skg_status skg_scan_write_rtk(const skg_scan *scan, FILE *stream);
skg_status skg_scan_write_tigre(const skg_scan *scan, FILE *stream);
skg_status skg_scan_write_cil(const skg_scan *scan, FILE *stream);
skg_status skg_scan_write_nerf(const skg_scan *scan, FILE *stream);

#endif
