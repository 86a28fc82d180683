/* Meshes made of arrays, and moved. */
#include "mesh/mesh.h"

#include "core/context.h"
#include "core/text.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

static skg_status check_counts(const char *name, int64_t vertices, int64_t triangles) {
    if (vertices < 0 || triangles < 0)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: %" PRId64 " vertices and %" PRId64 " triangles: counts from 0",
                        name, vertices, triangles);
    if (triangles == 0) return skg_fail(SKG_ERR_MESH, "%s: no triangles", name);
    if (vertices == 0) return skg_fail(SKG_ERR_MESH, "%s: no vertices", name);
    if (vertices > SKG_MESH_LIMIT || triangles > SKG_MESH_LIMIT)
        return skg_fail(SKG_ERR_MESH,
                        "%s: %" PRId64 " vertices and %" PRId64 " triangles: a mesh holds at most %" PRId64
                        " of each; cut it into several",
                        name, vertices, triangles, SKG_MESH_LIMIT);
    return SKG_OK;
}

static skg_status check_positions(const char *name, const double *positions, int64_t vertices,
                                  int64_t stride) {
    for (int64_t i = 0; i < vertices; i++) {
        const double *p = positions + i * stride;
        if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]))
            return skg_fail(SKG_ERR_MESH, "%s: vertex %" PRId64 " is at (%g, %g, %g) mm: not finite", name, i,
                            p[0], p[1], p[2]);
    }
    return SKG_OK;
}

static skg_status check_corners(const char *name, const int32_t *corners, int64_t triangles,
                                int64_t vertices) {
    for (int64_t i = 0; i < 3 * triangles; i++)
        if (corners[i] < 0 || corners[i] >= vertices)
            return skg_fail(SKG_ERR_MESH,
                            "%s: triangle %" PRId64 " names vertex %" PRId32
                            ", but vertices run from 0 to %" PRId64,
                            name, i / 3, corners[i], vertices - 1);
    return SKG_OK;
}

static void centre_and_reach(const double *positions, int64_t vertices, int64_t stride, double centre[3],
                             double *reach) {
    double lowest[3], highest[3];
    for (int k = 0; k < 3; k++) lowest[k] = highest[k] = positions[k];
    for (int64_t i = 1; i < vertices; i++)
        for (int k = 0; k < 3; k++) {
            double x = positions[i * stride + k];
            lowest[k] = x < lowest[k] ? x : lowest[k];
            highest[k] = x > highest[k] ? x : highest[k];
        }
    *reach = 0;
    for (int k = 0; k < 3; k++) {
        centre[k] = 0.5 * lowest[k] + 0.5 * highest[k];
        *reach = fmax(*reach, 0.5 * highest[k] - 0.5 * lowest[k]);
    }
}

static skg_status check_reach(const char *name, double reach) {
    if (reach < (double)FLT_MAX) return SKG_OK;
    return skg_fail(SKG_ERR_MESH, "%s: %g mm from its centre to its end: more than single precision holds",
                    name, reach);
}

static void set_offsets(skg_mesh *mesh) {
    for (int64_t i = 0; i < mesh->vertices; i++)
        for (int k = 0; k < 3; k++)
            mesh->offsets[3 * i + k] = (float)(mesh->positions[3 * i + k] - mesh->origin[k]);
}

static skg_status fill(skg_mesh *mesh, const char *name, skg_mesh_arrays *arrays) {
    double reach;
    SKG_TRY(skg_copy_text(name, &mesh->name));
    SKG_TRY(check_counts(name, arrays->vertices, arrays->triangles));
    SKG_TRY(check_positions(name, arrays->positions, arrays->vertices, 3));
    SKG_TRY(check_corners(name, arrays->corners, arrays->triangles, arrays->vertices));
    centre_and_reach(arrays->positions, arrays->vertices, 3, mesh->origin, &reach);
    SKG_TRY(check_reach(name, reach));
    mesh->vertices = arrays->vertices;
    mesh->triangles = arrays->triangles;
    mesh->positions = arrays->positions;
    mesh->corners = arrays->corners;
    mesh->as_wound = arrays->as_wound;
    mesh->unit_mm = arrays->unit_mm, mesh->file_unit_mm = arrays->file_unit_mm;
    mesh->unit_from = arrays->unit_from;
    mesh->health.left_out = arrays->left_out, mesh->health.trailing_bytes = arrays->trailing;
    mesh->groups = arrays->pieces, mesh->group_count = arrays->piece_count;
    *arrays = (skg_mesh_arrays){0};
    SKG_TRY(skg_alloc(3 * mesh->vertices, sizeof *mesh->offsets, name, &mesh->offsets));
    set_offsets(mesh);
    skg_mesh_set_bounds(mesh);
    mesh->version = 1;
    return skg_mesh_examine(mesh);
}

void skg_mesh_warn_turned(const skg_context *context, const skg_mesh *mesh) {
    const skg_mesh_health *health = &mesh->health;
    const double *p = health->first_turned_position;
    if (health->turned > 0)
        skg_log(context, SKG_LOG_WARNING,
                "%s: wound inconsistently; %" PRId64 " of %" PRId64
                " triangles were turned, first number %" PRId64 " near (%.4g, %.4g, %.4g) mm%s",
                mesh->name, health->turned, health->triangles, health->first_turned, p[0], p[1], p[2],
                health->closed ? "" : "; it has holes, too");
    if (health->one_sided > 0)
        skg_log(context, SKG_LOG_WARNING,
                "%s: %" PRId64 " %s no inside, as a Moebius strip has none; turning triangles cannot mend it",
                mesh->name, health->one_sided, skg_plural(health->one_sided, "patch has", "patches have"));
    if (mesh->orientation < 0)
        skg_log(context, SKG_LOG_WARNING,
                "%s: inverted as a whole (its triangles face inward); turned outward", mesh->name);
}

/* Vertices of no triangle keep their numbers, so that arrays of positions fit; where they stretch the bounds, these are not the body's. */
static skg_status warn_unused(const skg_context *context, const skg_mesh *mesh) {
    uint8_t *used = NULL;
    int64_t unused = 0, outside = 0;
    float low[3] = {FLT_MAX, FLT_MAX, FLT_MAX}, high[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
    SKG_TRY(skg_alloc(mesh->vertices, sizeof *used, mesh->name, &used));
    for (int64_t c = 0; c < 3 * mesh->triangles; c++) used[mesh->corners[c]] = 1;
    for (int64_t v = 0; v < mesh->vertices; v++)
        for (int k = 0; k < 3; k++) {
            const float at = mesh->offsets[3 * v + k];
            unused += k == 0 && !used[v];
            if (used[v]) low[k] = fminf(low[k], at), high[k] = fmaxf(high[k], at);
        }
    skg_free(&used);
    for (int k = 0; k < 3; k++) outside += mesh->lowest[k] < low[k] || mesh->highest[k] > high[k];
    if (outside > 0)
        skg_log(context, SKG_LOG_WARNING,
                "%s: %" PRId64
                " %s to no triangle, but %s its bounds, by which detectors are fitted and parts moved "
                "to the centre; leave them out",
                mesh->name, unused, skg_plural(unused, "vertex belongs", "vertices belong"),
                skg_plural(unused, "stretches", "stretch"));
    return SKG_OK;
}

skg_status skg_mesh_adopt(skg_context *context, const char *name, skg_mesh_arrays *arrays, skg_mesh **mesh) {
    skg_mesh *made = NULL;
    if (!name || !*name) name = "mesh";
    skg_status status = skg_alloc(1, sizeof *made, name, &made);
    if (status == SKG_OK) {
        skg_refs_init(&made->refs);
        status = fill(made, name, arrays);
    }
    skg_mesh_arrays_free(arrays);
    if (status != SKG_OK) {
        skg_mesh_release(&made);
        return status;
    }
    skg_mesh_warn_turned(context, made);
    if (context) status = warn_unused(context, made);
    if (status != SKG_OK) skg_mesh_release(&made);
    *mesh = made;
    return status;
}

static skg_status check_stride(const char *name, const char *what, int64_t *stride) {
    if (*stride == 0) *stride = 3;
    if (*stride >= 3) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s: %s stride %" PRId64 ": at least 3 elements, or 0 for 3", name,
                    what, *stride);
}

void skg_mesh_source_init_sized(void *source, int32_t size) {
    const skg_mesh_source defaults = {.unit_mm = 1};
    skg_struct_init(source, size, &defaults, sizeof defaults);
}

static skg_status check_source(const char *name, skg_mesh_source *from) {
    if (!isfinite(from->unit_mm) || from->unit_mm <= 0)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: unit %g mm is not usable; give one that is finite and above 0",
                        name, from->unit_mm);
    SKG_TRY(check_stride(name, "position", &from->position_stride));
    SKG_TRY(check_stride(name, "triangle", &from->triangle_stride));
    SKG_TRY(check_counts(name, from->vertices, from->triangles));
    if (from->as_wound < 0 || from->as_wound > 1)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: as_wound is %" PRId32 "; give 0 or 1", name, from->as_wound);
    if (from->positions && from->floats)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: positions and floats are both given; set one of them to NULL",
                        name);
    if ((!from->positions && !from->floats) || !from->corners)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: %s are NULL", name, from->corners ? "positions" : "triangles");
    return SKG_OK;
}

static skg_status copy_arrays(const char *name, const skg_mesh_source *from, skg_mesh_arrays *arrays) {
    SKG_TRY(skg_alloc(3 * from->vertices, sizeof(double), name, &arrays->positions));
    SKG_TRY(skg_alloc(3 * from->triangles, sizeof(int32_t), name, &arrays->corners));
    arrays->as_wound = from->as_wound;
    arrays->unit_mm = from->unit_mm;
    arrays->unit_from = SKG_UNIT_NAMED;
    arrays->vertices = from->vertices;
    arrays->triangles = from->triangles;
    for (int64_t i = 0; i < from->vertices; i++)
        for (int64_t k = 0; k < 3; k++) {
            const int64_t at = i * from->position_stride + k;
            arrays->positions[3 * i + k] =
                from->unit_mm * (from->positions ? from->positions[at] : (double)from->floats[at]);
        }
    for (int64_t i = 0; i < from->triangles; i++)
        memcpy(arrays->corners + 3 * i, from->corners + i * from->triangle_stride, 3 * sizeof(int32_t));
    return SKG_OK;
}

static skg_status create(skg_context *context, const char *name, const skg_mesh_source *source,
                         skg_mesh **mesh) {
    SKG_PLAIN;
    skg_mesh_arrays arrays = {0};
    skg_mesh_source from;
    SKG_NEEDS_OF("skg_mesh_create", mesh);
    *mesh = NULL;
    if (!name || !*name) name = "mesh";
    skg_mesh_source_init(&from);
    SKG_TRY(skg_struct_read(source, "skg_mesh_source", &from, sizeof from));
    SKG_TRY(check_source(name, &from));
    const skg_status status = copy_arrays(name, &from, &arrays);
    if (status == SKG_OK) return skg_mesh_adopt(context, name, &arrays, mesh);
    skg_mesh_arrays_free(&arrays);
    return status;
}

skg_status skg_mesh_create(skg_context *context, const char *name, const skg_mesh_source *source,
                           skg_mesh **mesh) {
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, create(context, name, source, mesh));
}

skg_status skg_mesh_retain(skg_mesh *mesh) {
    SKG_NEEDS(mesh);
    skg_ref(&mesh->refs);
    return SKG_OK;
}

void skg_mesh_release(skg_mesh **mesh) {
    if (!mesh || !*mesh) return;
    skg_mesh *last = *mesh;
    *mesh = NULL;
    if (!skg_unref(&last->refs)) return;
    skg_free(&last->name);
    skg_free(&last->positions);
    skg_free(&last->offsets);
    skg_free(&last->corners);
    skg_free(&last->weld);
    for (int64_t i = 0; i < last->group_count; i++) {
        skg_free(&last->groups[i].object);
        skg_free(&last->groups[i].group);
    }
    skg_free(&last->groups);
    skg_free(&last->runs);
    skg_free(&last->boxes);
    skg_free(&last->piece);
    skg_free(&last);
}

skg_status skg_mesh_count(const skg_mesh *mesh, int64_t *vertices, int64_t *triangles) {
    SKG_NEEDS(mesh);
    if (vertices) *vertices = mesh->vertices;
    if (triangles) *triangles = mesh->triangles;
    return SKG_OK;
}

skg_status skg_mesh_name_get(const skg_mesh *mesh, const char **name) {
    SKG_NEEDS(mesh);
    SKG_NEEDS(name);
    *name = mesh->name;
    return SKG_OK;
}

skg_status skg_mesh_version_get(const skg_mesh *mesh, int64_t *version) {
    SKG_NEEDS(mesh);
    SKG_NEEDS(version);
    *version = mesh->version;
    return SKG_OK;
}

void skg_mesh_bounds(const skg_mesh *mesh, float lowest[3], float highest[3], int64_t *first_bad) {
    memcpy(lowest, mesh->lowest, sizeof mesh->lowest);
    memcpy(highest, mesh->highest, sizeof mesh->highest);
    *first_bad = mesh->first_bad;
}

skg_status skg_mesh_positions_get(const skg_mesh *mesh, double *positions, int64_t position_stride) {
    SKG_NEEDS(mesh);
    SKG_NEEDS(positions);
    SKG_TRY(check_stride(mesh->name, "position", &position_stride));
    for (int64_t i = 0; i < mesh->vertices; i++) skg_mesh_vertex(mesh, i, positions + i * position_stride);
    return SKG_OK;
}

skg_status skg_mesh_triangles_get(const skg_mesh *mesh, int32_t *corners, int64_t triangle_stride) {
    SKG_NEEDS(mesh);
    SKG_NEEDS(corners);
    SKG_TRY(check_stride(mesh->name, "triangle", &triangle_stride));
    for (int64_t i = 0; i < mesh->triangles; i++)
        memcpy(corners + i * triangle_stride, mesh->corners + 3 * i, 3 * sizeof(int32_t));
    return SKG_OK;
}

/* Vertices that are one only because they are at the same place have parted, and the closed mesh has become leaky. */
static skg_status torn(const skg_mesh *mesh, int64_t vertex) {
    return skg_fail(
        SKG_ERR_MESH,
        "%s: vertices %" PRId32 " and %" PRId64
        " were at the same place and now are not, which makes the closed mesh leaky; move them together",
        mesh->name, mesh->weld[vertex], vertex);
}

skg_status skg_mesh_positions_set(skg_mesh *mesh, const double *positions, int64_t position_stride) {
    SKG_PLAIN;
    double centre[3], reach;
    int far = 0;
    SKG_NEEDS(mesh);
    SKG_NEEDS(positions);
    SKG_TRY(check_stride(mesh->name, "position", &position_stride));
    SKG_TRY(check_positions(mesh->name, positions, mesh->vertices, position_stride));
    centre_and_reach(positions, mesh->vertices, position_stride, centre, &reach);
    SKG_TRY(check_reach(mesh->name, reach));
    for (int64_t i = 0; mesh->weld && mesh->closed && i < mesh->vertices; i++)
        for (int k = 0; k < 3; k++)
            if (positions[i * position_stride + k] != positions[mesh->weld[i] * position_stride + k])
                return torn(mesh, i);
    for (int64_t i = 0; i < mesh->vertices; i++)
        memcpy(mesh->positions + 3 * i, positions + i * position_stride, 3 * sizeof(double));
    /* The origin stays while it is near the middle of the mesh, so that vertices at rest keep the bits of their
     * offsets. */
    for (int k = 0; k < 3; k++) far |= fabs(centre[k] - mesh->origin[k]) > 0.5 * reach;
    if (far) memcpy(mesh->origin, centre, sizeof centre);
    mesh->positions_stale = 0;
    set_offsets(mesh);
    skg_mesh_turn_outward(mesh);
    skg_mesh_set_bounds(mesh);
    mesh->version++;
    return skg_mesh_count_layers(mesh);
}

skg_status skg_mesh_offsets_get(skg_mesh *mesh, float **offsets, const double **origin) {
    SKG_NEEDS(mesh);
    SKG_NEEDS(offsets);
    *offsets = mesh->offsets;
    if (origin) *origin = mesh->origin;
    return SKG_OK;
}

skg_status skg_mesh_offsets_moved(skg_mesh *mesh) {
    SKG_PLAIN;
    SKG_NEEDS(mesh);
    mesh->positions_stale = 1;
    mesh->version++;
    skg_mesh_set_bounds(mesh);
    for (int64_t i = 0; mesh->weld && mesh->closed && mesh->first_bad < 0 && i < mesh->vertices; i++)
        for (int k = 0; mesh->weld[i] != i && k < 3; k++)
            if (mesh->offsets[3 * i + k] != mesh->offsets[3 * (int64_t)mesh->weld[i] + k])
                return torn(mesh, i);
    return skg_mesh_count_layers(mesh);
}

void skg_mesh_unit_init_sized(void *unit, int32_t size) {
    const skg_mesh_unit defaults = {.mm = 1};
    skg_struct_init(unit, size, &defaults, sizeof defaults);
}

skg_status skg_mesh_unit_get(const skg_mesh *mesh, skg_mesh_unit *unit) {
    SKG_NEEDS(mesh);
    SKG_NEEDS(unit);
    skg_mesh_unit ours = {
        .from = mesh->unit_from, .mm = mesh->unit_mm > 0 ? mesh->unit_mm : 1, .file_mm = mesh->file_unit_mm};
    skg_unit_describe(ours.mm, ours.name, sizeof ours.name);
    return skg_struct_write(&ours, sizeof ours, "skg_mesh_unit", unit);
}

skg_status skg_length_unit_get(const char *name, double *mm) {
    SKG_NEEDS(name);
    SKG_NEEDS(mm);
    *mm = 0;
    return skg_unit_of_length(name, mm);
}

skg_status skg_mesh_group_count(const skg_mesh *mesh, int64_t *count) {
    SKG_NEEDS(mesh);
    SKG_NEEDS(count);
    *count = mesh->group_count;
    return SKG_OK;
}

skg_status skg_mesh_group_get(const skg_mesh *mesh, int64_t group, const char **name, int64_t *first,
                              int64_t *triangles) {
    SKG_NEEDS(mesh);
    if (group < 0 || group >= mesh->group_count)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: group %" PRId64 " of %" PRId64, mesh->name, group,
                        mesh->group_count);
    const skg_mesh_piece *piece = &mesh->groups[group];
    const int64_t end = group + 1 < mesh->group_count ? piece[1].first : mesh->triangles;
    if (name) *name = skg_mesh_piece_name(piece);
    if (first) *first = piece->first;
    if (triangles) *triangles = end - piece->first;
    return SKG_OK;
}
