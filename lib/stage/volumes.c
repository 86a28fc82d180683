/* Volumes of cells on the device, and what they add to the sums of a pass. */
#include "stage/volumes.h"

#include "core/maths.h"
#include "mesh/mesh.h"
#include "scene/volume.h"
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Bits behind the point of places in cells, and the bits of all of a place. */
enum { POINT_MIN = 30, POINT_MAX = 40, PLACE_BITS = 60 };

static skg_status check_size(const skg_context *context, const skg_scene *scene, int64_t part) {
    const skg_device_info *info = &context->device->info;
    const int64_t bytes = skg_volume_bytes(scene->parts[part].volume);
    if (bytes <= info->max_allocation) return SKG_OK;
    return skg_fail(
        SKG_ERR_DEVICE_MEMORY,
        "%s: its cells take %.0f MB, and a buffer of this device at most %.0f MB; crop the volume, make its "
        "cells larger, or use another device",
        scene->parts[part].label, (double)bytes * 1e-6, (double)info->max_allocation * 1e-6);
}

skg_status skg_volumes_create(skg_context *context, const skg_scene *scene, skg_volumes *volumes) {
    const int64_t count = skg_scene_volumes(scene);
    if (count == 0) return SKG_OK;
    SKG_TRY(skg_alloc(count, sizeof *volumes->volumes, "volumes", &volumes->volumes));
    for (int64_t p = 0; p < scene->count; p++) {
        const skg_volume *volume = scene->parts[p].volume;
        skg_placed_volume *placed = &volumes->volumes[volumes->count];
        if (!volume) continue;
        SKG_TRY(check_size(context, scene, p));
        *placed = (skg_placed_volume){.part = p, .volume = volume};
        volumes->count++;
        SKG_TRY(skg_buffer_share(context, skg_volume_bytes(volume), volume->cells, "cells of a volume",
                                 &placed->cells));
    }
    return SKG_OK;
}

/* Everything but the cells. */
static void release_placed(skg_placed_volume *placed) {
    skg_buffer_release(&placed->weights);
    skg_buffer_release(&placed->displacing);
    skg_cell_lines_release(&placed->lines);
    skg_free(&placed->planes);
}

void skg_volumes_release(skg_volumes *volumes) {
    for (int64_t v = 0; v < volumes->count; v++) {
        skg_buffer_release(&volumes->volumes[v].cells);
        release_placed(&volumes->volumes[v]);
    }
    release_placed(&volumes->alone);
    skg_free(&volumes->volumes);
    volumes->count = 0;
}

int64_t skg_volumes_bytes(const skg_volumes *volumes) {
    int64_t bytes = 0;
    for (int64_t v = 0; v < volumes->count; v++)
        bytes += volumes->volumes[v].cells.bytes + volumes->volumes[v].weights.bytes;
    return bytes;
}

const skg_placed_volume *skg_volumes_find(const skg_volumes *volumes, int64_t part) {
    for (int64_t v = 0; v < volumes->count; v++)
        if (volumes->volumes[v].part == part) return &volumes->volumes[v];
    return NULL;
}

double skg_volumes_most(const skg_volumes *volumes, int64_t part) {
    const skg_placed_volume *placed = skg_volumes_find(volumes, part);
    return placed ? placed->most : 0;
}

/* --- weights */

/* The contributions of the curves of a volume. */
typedef struct {
    const skg_model *model;
    int64_t first; /* of its curves, among the contributors of the model */
} contributors;

/* The number of a plane among those of the volume. */
static int64_t plane_of(const skg_placed_volume *placed, int64_t plane) {
    int64_t p = 0;
    while (p < placed->plane_count && placed->planes[p] != plane) p++;
    return p;
}

static skg_status list_planes(const contributors *c, skg_placed_volume *placed) {
    const int64_t *first = c->model->first_contribution + c->first;
    skg_free(&placed->planes);
    placed->plane_count = 0;
    SKG_TRY(skg_alloc(c->model->planes, sizeof *placed->planes, "planes of a volume", &placed->planes));
    for (int64_t w = first[0]; w < first[placed->volume->curve_count]; w++) {
        const int64_t plane = c->model->contributions[w].plane;
        if (plane_of(placed, plane) == placed->plane_count)
            placed->planes[placed->plane_count++] = (int32_t)plane;
    }
    placed->lanes = 1;
    while (placed->lanes < placed->plane_count && placed->lanes < SKG_VOLUME_PLANES_MAX)
        placed->lanes *= placed->lanes == 1 ? 4 : 2;
    return SKG_OK;
}

/* The weight of code k on plane p of the volume is weights[p * codes + k]; planes that are not listed are left out. A volume of wide cells
 * has one, for the unit of its cells. */
static void fill_weights(const contributors *c, skg_placed_volume *placed, int64_t codes, double *weights) {
    const skg_volume *volume = placed->volume;
    const skg_model *model = c->model;
    placed->most = 0;
    for (int64_t k = 0; k < codes; k++) {
        const int64_t curve = c->first + (volume->wide ? 0 : volume->curve_of[k]);
        const double amount = volume->wide ? volume->unit : volume->amounts[k];
        for (int64_t w = model->first_contribution[curve]; w < model->first_contribution[curve + 1]; w++) {
            const skg_contribution *own = &model->contributions[w];
            const int64_t plane = plane_of(placed, own->plane);
            if (plane == placed->plane_count) continue;
            weights[plane * codes + k] = own->weight * amount;
            placed->most = fmax(placed->most, fabs(own->weight * amount));
        }
    }
}

static skg_status upload_weights(skg_context *context, const contributors *c, skg_placed_volume *placed) {
    const int64_t codes = placed->volume->wide ? 1 : placed->volume->codes, lanes = placed->lanes;
    const int64_t groups = (placed->plane_count + lanes - 1) / lanes, count = groups * lanes * codes;
    double *weights = NULL;
    float *scaled = NULL;
    int exponent = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(placed->plane_count * codes, sizeof *weights, "weights of a volume", &weights));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *scaled, "weights of a volume", &scaled));
    fill_weights(c, placed, codes, weights);
    frexp(placed->most, &exponent); /* most < 2^exponent */
    placed->exponent = SKG_VOLUME_WEIGHT_BITS - exponent;
    for (int64_t p = 0; p < placed->plane_count; p++)
        for (int64_t k = 0; k < codes; k++)
            scaled[(p / lanes * codes + k) * lanes + p % lanes] =
                (float)ldexp(weights[p * codes + k], placed->exponent);
    if (placed->volume->wide) placed->most *= 0x1p30;
    status = skg_buffer_write(context, &placed->weights, count * (int64_t)sizeof *scaled, scaled,
                              "weights of a volume");
cleanup:
    skg_free(&weights);
    skg_free(&scaled);
    return status;
}

skg_status skg_volumes_weigh(skg_context *context, const skg_scene *scene, const skg_model *model,
                             skg_volumes *volumes) {
    for (int64_t v = 0; v < volumes->count; v++) {
        skg_placed_volume *placed = &volumes->volumes[v];
        const contributors c = {model, scene->count + skg_scene_curves(scene, placed->part)};
        SKG_TRY(list_planes(&c, placed));
        if (placed->plane_count > 0) SKG_TRY(upload_weights(context, &c, placed));
    }
    return SKG_OK;
}

/* --- a pass */

static void turn(const double *to_cells, const double *vector, double *turned) {
    for (int r = 0; r < 3; r++) turned[r] = skg_dot(to_cells + 4 * r, vector);
}

void skg_cell_rays_find(const skg_camera *camera, const double *to_cells, skg_cell_rays *rays) {
    double origin[3];
    *rays = (skg_cell_rays){0};
    skg_add_scaled(camera->origin, camera->parallel ? -1 : 0, camera->first, origin);
    skg_pose_point(to_cells, origin, rays->base[0]);
    turn(to_cells, camera->first, rays->way[0]);
    turn(to_cells, camera->column, camera->parallel ? rays->base[1] : rays->way[1]);
    turn(to_cells, camera->row, camera->parallel ? rays->base[2] : rays->way[2]);
}

/* The bits behind the point that the farthest place leaves. */
static int32_t bits_for(const skg_camera *camera, const skg_cell_rays *rays) {
    double most = 1;
    int exponent = 0;
    for (int k = 0; k < 3; k++) {
        const double columns = (double)camera->columns, rows = (double)camera->rows;
        const double base =
            fabs(rays->base[0][k]) + columns * fabs(rays->base[1][k]) + rows * fabs(rays->base[2][k]);
        const double way =
            fabs(rays->way[0][k]) + columns * fabs(rays->way[1][k]) + rows * fabs(rays->way[2][k]);
        most = fmax(most, base + way);
    }
    frexp(most, &exponent); /* most < 2^exponent */
    return exponent > PLACE_BITS - POINT_MIN   ? 0
           : exponent > PLACE_BITS - POINT_MAX ? PLACE_BITS - exponent
                                               : POINT_MAX;
}

static skg_status fill_rays(skg_placed_volume *placed, const skg_pass *pass, skg_context *context,
                            skg_volume_args *args) {
    const skg_camera *camera = &pass->camera;
    double to_cells[16];
    skg_cell_rays rays;
    skg_volume_to_cells(placed->volume, pass->parts[placed->part].pose, to_cells);
    /* Between centres values are polynomials in half cells, and these are walked. */
    for (int k = 0; k < 12 && placed->volume->linear; k++) to_cells[k] *= 2;
    skg_cell_rays_find(camera, to_cells, &rays);
    args->bits = bits_for(camera, &rays);
    if (args->bits == 0)
        return skg_fail(
            SKG_ERR_SCENE,
            "%s: source or detector are more than 2^%d cells away from it; move them nearer, or take a "
            "parallel beam",
            pass->scene->parts[placed->part].label, PLACE_BITS - POINT_MIN);
    for (int k = 0; k < 3; k++) {
        args->base[k] = skg_cell_fixed(rays.base[0][k], args->bits);
        args->base_column[k] = skg_cell_fixed(rays.base[1][k], args->bits);
        args->base_row[k] = skg_cell_fixed(rays.base[2][k], args->bits);
        args->way[k] = skg_cell_fixed(rays.way[0][k], args->bits);
        args->way_column[k] = skg_cell_fixed(rays.way[1][k], args->bits);
        args->way_row[k] = skg_cell_fixed(rays.way[2][k], args->bits);
        args->cells[k] = (SKG_INT)(placed->volume->size[k] * (placed->volume->linear ? 2 : 1));
        args->start[k] = (float)camera->start[k];
    }
    args->whole = skg_starts_nowhere(camera);
    return skg_cell_lines_write(&placed->lines, context, camera, &rays, args->bits);
}

/* The parts that displace the volume in this pass. */
static skg_status fill_lists(skg_placed_volume *placed, const skg_pass *pass, const skg_hits_memory *hits,
                             skg_staging *staging, skg_volume_args *args) {
    const skg_priority *priority = &pass->priority;
    const int32_t *window = priority->window;
    const int64_t words = skg_priority_slots(priority) / 32;
    int32_t *set = NULL;
    args->slot = -1;
    if (priority->count == 0 || window[0] >= window[1] || window[2] >= window[3] || !hits->table.memory)
        return SKG_OK;
    SKG_TRY(skg_staging_take(staging, words, sizeof *set, "parts inside a volume", &set));
    args->slot = (SKG_INT)skg_priority_displacing(pass->scene, priority, placed->part, set);
    for (int k = 0; k < 4; k++) args->lists[k] = window[k < 2 ? 2 - 2 * k : 7 - 2 * k];
    return skg_staging_write(staging, &placed->displacing, words * (int64_t)sizeof *set, set,
                             "parts inside a volume");
}

skg_status skg_volume_program(const skg_placed_volume *placed, const skg_pass *pass, skg_context *context,
                              int32_t count, const char *const *files, cl_program *program) {
    const skg_define defines[] = {{"SKG_VOLUME_PLANES", placed->volume->wide ? 1 : placed->lanes},
                                  {"SKG_VOLUME_WIDE", placed->volume->wide},
                                  {"SKG_VOLUME_LINEAR", placed->volume->linear},
                                  {"SKG_SLOTS", skg_priority_slots(&pass->priority)}};
    /* Options for triangles alone change no word of these kernels; without them scenes share the program. */
    skg_kernel_options options = pass->kernels;
    options.seams = options.source_plane = options.listed = 0;
    return skg_kernels_get(context, &options, count, files, SKG_DEFINES(defines), program);
}

static skg_status get_program(const skg_placed_volume *placed, const skg_pass *pass, skg_context *context,
                              cl_program *program) {
    static const char *const files[] = {"pixel.clh", "intervals.clh", "cell_rays.clh", "cell_values.clh",
                                        "volume.cl"};
    return skg_volume_program(placed, pass, context, 5, files, program);
}

static skg_status launch(const skg_placed_volume *placed, const skg_pass *pass, const skg_hits_memory *hits,
                         const skg_volume_args *filled, skg_staging *staging) {
    const skg_volume_args args = *filled;
    const int on_gpu = staging->context->device->info.gpu;
    const int64_t columns = args.window[2] - args.window[0], rows = args.window[3] - args.window[1];
    const int64_t lanes = skg_kernel_lanes(staging->context, pass->kernels.precision);
    const skg_work_size work = {2, {skg_divide_up(columns, lanes), rows}, {on_gpu ? 8 : 1, on_gpu ? 8 : 1}};
    const skg_buffer *none = &placed->weights; /* of what is not read: hits, lines */
    const int listed = args.slot >= 0;
    const skg_argument arguments[] = {
        SKG_ARGUMENT(VOLUME_ADD, args, args),
        SKG_ARGUMENT(VOLUME_ADD, cells, placed->cells.memory),
        SKG_ARGUMENT(VOLUME_ADD, weights, placed->weights.memory),
        SKG_ARGUMENT(VOLUME_ADD, counts, (listed ? &hits->counts : none)->memory),
        SKG_ARGUMENT(VOLUME_ADD, starts, (listed ? &hits->starts : none)->memory),
        SKG_ARGUMENT(VOLUME_ADD, hits, (listed ? &hits->hits : none)->memory),
        SKG_ARGUMENT(VOLUME_ADD, table, (listed ? &hits->table : none)->memory),
        SKG_ARGUMENT(VOLUME_ADD, displacing, (listed ? &placed->displacing : none)->memory),
        SKG_ARGUMENT(VOLUME_ADD, lines, (pass->kernels.curved ? &placed->lines.memory : none)->memory),
        SKG_ARGUMENT(VOLUME_ADD, sums, pass->main.raster->sums.memory),
    };
    cl_program program = NULL;
    if (columns <= 0 || rows <= 0) return SKG_OK;
    SKG_TRY(get_program(placed, pass, staging->context, &program));
    return SKG_LAUNCH_ONCE(staging->context, program, "skg_volume_add", "volume", &work, arguments,
                           &staging->log);
}

/* Pixels of the volume's box, within the camera. */
static void fill_window(const skg_pass *pass, int64_t part, SKG_INT window[4]) {
    int32_t pixels[4];
    skg_extent_pixels(&pass->camera, &pass->extents[part], pixels);
    const int64_t rows = pass->camera.rows, columns = pass->camera.columns;
    window[0] = pixels[2], window[1] = pixels[0];
    window[2] = pixels[3] < columns ? pixels[3] : (SKG_INT)columns;
    window[3] = pixels[1] < rows ? pixels[1] : (SKG_INT)rows;
}

skg_status skg_volume_args_fill(skg_placed_volume *placed, const skg_pass *pass, const skg_hits_memory *hits,
                                skg_staging *staging, skg_volume_args *args) {
    *args = (skg_volume_args){.layout = pass->main.raster->layout};
    SKG_TRY(fill_rays(placed, pass, staging->context, args));
    SKG_TRY(fill_lists(placed, pass, hits, staging, args));
    if (args->slot >= 0) args->common = skg_cell_fixed(skg_hits_common(pass), SKG_PATH_BITS);
    return SKG_OK;
}

void skg_volume_args_planes(const skg_placed_volume *placed, int64_t first, skg_volume_args *args) {
    const int64_t left = placed->plane_count - first, count = left < placed->lanes ? left : placed->lanes;
    args->plane_count = (SKG_INT)count;
    for (int64_t k = 0; k < count; k++) args->planes[k] = placed->planes[first + k];
    args->first_weight = (SKG_INT)(first * (placed->volume->wide ? 1 : placed->volume->codes));
}

static skg_status add(skg_placed_volume *placed, const skg_pass *pass, const skg_hits_memory *hits,
                      skg_staging *staging) {
    skg_volume_args args;
    if (placed->volume->hull->version != 1)
        return skg_fail(
            SKG_ERR_SCENE,
            "%s: the vertices of its box were moved, which moves no cell; move the part by its pose",
            pass->scene->parts[placed->part].label);
    if (!pass->extents[placed->part].on_detector || placed->plane_count == 0) return SKG_OK;
    SKG_TRY(skg_volume_args_fill(placed, pass, hits, staging, &args));
    fill_window(pass, placed->part, args.window);
    args.unit = (float)ldexp(pass->scale.scale, args.bits - placed->exponent);
    for (int64_t first = 0; first < placed->plane_count; first += placed->lanes) {
        skg_volume_args_planes(placed, first, &args);
        SKG_TRY(launch(placed, pass, hits, &args, staging));
    }
    return SKG_OK;
}

skg_status skg_volumes_add(const skg_volumes *volumes, const skg_pass *pass, const skg_hits_memory *hits,
                           skg_staging *staging) {
    for (int64_t v = 0; v < volumes->count; v++) SKG_TRY(add(&volumes->volumes[v], pass, hits, staging));
    return SKG_OK;
}

/* A copy of a volume that adds to plane 0 what it adds to a plane of the model. The memory of the last copy is taken again. */
static skg_status place_alone(skg_volumes *volumes, const skg_model *model, int64_t part, int32_t plane,
                              const skg_pass *pass, skg_context *context) {
    const skg_placed_volume *placed = skg_volumes_find(volumes, part);
    const contributors c = {model, pass->scene->count + skg_scene_curves(pass->scene, part)};
    skg_placed_volume *alone = &volumes->alone;
    if (!alone->planes) SKG_TRY(skg_alloc(1, sizeof *alone->planes, "planes of a volume", &alone->planes));
    alone->part = part, alone->volume = placed->volume, alone->cells = placed->cells;
    alone->lanes = 1, alone->plane_count = 1, alone->planes[0] = plane;
    SKG_TRY(upload_weights(context, &c, alone));
    alone->planes[0] = 0;
    return SKG_OK;
}

skg_status skg_volumes_add_alone(skg_volumes *volumes, const skg_model *model, int64_t part, int32_t plane,
                                 const skg_pass *pass, const skg_hits_memory *hits, skg_staging *staging) {
    SKG_TRY(place_alone(volumes, model, part, plane, pass, staging->context));
    return add(&volumes->alone, pass, hits, staging);
}
