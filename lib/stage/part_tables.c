/* The tables of the parts of a pass, on the device. */
#include "stage/tables.h"

#include <float.h>
#include <math.h>
#include <string.h>

static size_t contribution_size(const skg_geometry *geometry) {
    return skg_geometry_is_double(geometry) ? sizeof(skg_contribution_double)
                                            : sizeof(skg_contribution_float);
}

/* Waits until the device has read what this slot was last filled with: only then may it be filled again. */
static skg_status wait_for(skg_table_slot *slot) {
    if (!slot->read) return SKG_OK;
    SKG_CL_TRY(clWaitForEvents(1, &slot->read));
    clReleaseEvent(slot->read);
    slot->read = NULL;
    return SKG_OK;
}

void skg_geometry_release_tables(skg_geometry *geometry) {
    for (int i = 0; i < SKG_TABLE_SLOTS; i++) {
        skg_table_slot *slot = &geometry->slots[i];
        if (wait_for(slot) != SKG_OK) clReleaseEvent(slot->read);
        skg_free(&slot->entries);
        skg_free(&slot->contributions);
    }
}

static float round_to(double from, float *low) {
    const float high = (float)from;
    *low = (float)(from - (double)high);
    return high;
}

/* Single precision takes what changes from frame to frame from the double values, rounded once. */
static void round_entry(const skg_part_double *from, skg_part_float *to) {
    for (int k = 0; k < 3; k++) {
        to->row0[k] = round_to(from->row0[k], &to->low0[k]);
        to->row1[k] = round_to(from->row1[k], &to->low1[k]);
        to->row2[k] = round_to(from->row2[k], &to->low2[k]);
        to->start[k] = (float)from->start[k];
    }
    to->offset_x = round_to(from->offset_x, &to->low_x);
    to->offset_y = round_to(from->offset_y, &to->low_y);
    to->offset_r = round_to(from->offset_r, &to->low_r);
    to->anchor_x = round_to(from->anchor_x, &to->low_anchor_x);
    to->anchor_y = round_to(from->anchor_y, &to->low_anchor_y);
    to->reference = round_to(from->reference, &to->low_reference);
    to->highest = (float)from->highest;
    to->steepest = (float)fmin(from->steepest, (double)FLT_MAX);
    to->shift = (float)from->shift;
    to->pixel_i = from->pixel_i;
    to->pixel_j = from->pixel_j;
    to->vertices = from->vertices;
    to->turned = from->turned;
    to->fine = from->fine;
    to->lines = from->lines;
    to->reserved = 0;
    to->first_contribution = from->first_contribution;
    to->contributions = from->contributions;
}

static void set_contribution(const skg_geometry *geometry, void *contributions, int64_t index,
                             const skg_contribution *from, double factor) {
    if (skg_geometry_is_double(geometry))
        ((skg_contribution_double *)contributions)[index] = (skg_contribution_double){
            .weight = from->weight * factor, .bias = from->bias, .plane = (SKG_INT)from->plane};
    else
        ((skg_contribution_float *)contributions)[index] =
            (skg_contribution_float){.weight = (float)(from->weight * factor),
                                     .bias = (float)from->bias,
                                     .plane = (SKG_INT)from->plane};
}

/* A face is steep if the last bit of a coordinate moves its depth by more than this share of the part's depth. The share is
 * that of the bars in docs/numerics.md: a length is held to be well defined if such a shift changes it by less. */
static const double STEEP_SHARE = 1e-6;

/* A face of a thin part is steep from a smaller share on: only steep faces have the digits that its vertices have. */
static const double FINE_SHARE = 0.25e-6;

static double steepest(const skg_geometry *geometry, const skg_camera *camera, const skg_geometry_part *part,
                       int32_t fine) {
    const double last_bit = skg_geometry_is_double(geometry) ? DBL_EPSILON : (double)FLT_EPSILON;
    const double z =
        camera->parallel ? part->depth : part->depth / part->reference; /* z = r / t, t about reference */
    return (fine ? FINE_SHARE : STEEP_SHARE) * fabs(z) / last_bit;
}

/* Bytes of the lines of a curved detector, which stand behind the entries. */
static size_t lines_size(const skg_geometry *geometry, const skg_camera *camera) {
    const size_t number = skg_geometry_is_double(geometry) ? sizeof(double) : sizeof(float);
    return skg_camera_is_curved(camera) ? (size_t)SKG_LINES_SIZE(camera->rows) * number : 0;
}

/* Makes memory for the lines, and writes them. */
static skg_status fill_lines(const skg_geometry *geometry, const skg_camera *camera, skg_table_slot *slot) {
    const size_t table = (size_t)geometry->parts * skg_geometry_entry_size(geometry);
    const size_t lines = lines_size(geometry, camera);
    if ((int64_t)lines > slot->lines_bytes) {
        SKG_TRY(skg_realloc((int64_t)(table + lines), 1, "part table", &slot->entries));
        slot->lines_bytes = (int64_t)lines;
    }
    if (lines > 0) skg_bends_table(camera, skg_geometry_is_double(geometry), (char *)slot->entries + table);
    return SKG_OK;
}

/* The reals from an entry to the lines. */
static SKG_INT way_to_lines(const skg_geometry *geometry, const skg_camera *camera, int64_t part) {
    const size_t number = skg_geometry_is_double(geometry) ? sizeof(double) : sizeof(float);
    const size_t reals = skg_geometry_entry_size(geometry) / number;
    return skg_camera_is_curved(camera) ? (SKG_INT)((size_t)(geometry->parts - part) * reals) : 0;
}

/* pass: of several that are drawn together; their contributions stand one behind the other. */
static skg_status fill_tables(const skg_geometry *geometry, int64_t pass, const skg_camera *camera,
                              const skg_geometry_part *part, double scale, skg_table_slot *slot) {
    int64_t total = 0;
    for (int64_t p = 0; p < geometry->parts; p++) total += part[p].contributions;
    if (total > slot->capacity) {
        SKG_TRY(skg_realloc(total, contribution_size(geometry), "contribution table", &slot->contributions));
        slot->capacity = total;
    }
    slot->contribution_count = 0;
    SKG_TRY(fill_lines(geometry, camera, slot));
    for (int64_t p = 0; p < geometry->parts; p++) {
        skg_part_double local,
            *entry = skg_geometry_is_double(geometry) ? &((skg_part_double *)slot->entries)[p] : &local;
        const skg_mesh_layout *layout = &geometry->layouts[geometry->mesh_of_part[p]];
        const int32_t thin = layout->thin && !skg_geometry_is_double(geometry);
        const skg_camera_place place = skg_geometry_place(&part[p], skg_geometry_is_double(geometry) || thin);
        skg_camera_part(camera, &place, entry);
        entry->vertices = (SKG_INT)layout->vertices;
        entry->fine = layout->fine && (thin || part[p].touches);
        entry->steepest = steepest(geometry, camera, &part[p], thin);
        entry->shift = part[p].shift;
        entry->lines = way_to_lines(geometry, camera, p);
        entry->reserved = 0;
        entry->first_contribution = (SKG_INT)(pass * total + slot->contribution_count);
        entry->contributions = (SKG_INT)part[p].contributions;
        if (!skg_geometry_is_double(geometry)) round_entry(entry, &((skg_part_float *)slot->entries)[p]);
        /* Kernels weigh q = r / reference; a parallel beam's q is r itself. A part that lies on no path weighs nothing: its
         * hits would cancel, but the scale does not consider them, so that they need not be integers of the device. */
        const double depth_unit = camera->parallel ? scale : scale * entry->reference;
        const double factor = part[p].depth > 0 ? depth_unit : 0;
        for (int32_t w = 0; w < part[p].contributions; w++)
            set_contribution(geometry, slot->contributions, slot->contribution_count++,
                             &part[p].contribution[w], factor);
    }
    return SKG_OK;
}

/* lines: bytes behind the entries of a. */
static int same_tables(const skg_geometry *geometry, const skg_table_slot *a, const skg_table_slot *b,
                       size_t lines) {
    return a->contribution_count == b->contribution_count && (int64_t)lines <= b->lines_bytes &&
           memcmp(a->entries, b->entries,
                  (size_t)geometry->parts * skg_geometry_entry_size(geometry) + lines) == 0 &&
           (a->contribution_count == 0 ||
            memcmp(a->contributions, b->contributions,
                   (size_t)a->contribution_count * contribution_size(geometry)) == 0);
}

/* Enqueues the upload of tables: [parts] entries and contributions of each pass. read: the event of the write; NULL: none. */
static skg_status upload_tables(skg_context *context, skg_geometry *geometry, const skg_pass_tables *tables,
                                cl_event *read) {
    cl_command_queue queue = context->device->queue;
    const int64_t bytes = tables->passes * tables->contribution_count * (int64_t)contribution_size(geometry);
    const int64_t table =
        tables->passes * geometry->parts * (int64_t)skg_geometry_entry_size(geometry) + tables->lines_bytes;
    geometry->state++;
    geometry->uploaded = 0; /* if one of the two writes fails, the device has neither table */
    SKG_TRY(skg_buffer_reserve(context, &geometry->contribution_table, bytes, CL_MEM_READ_ONLY,
                               "contribution table"));
    SKG_TRY(skg_buffer_reserve(context, &geometry->part_table, table, CL_MEM_READ_ONLY, "part table"));
    if (bytes > 0)
        SKG_CL_TRY(clEnqueueWriteBuffer(queue, geometry->contribution_table.memory, CL_FALSE, 0,
                                        (size_t)bytes, tables->contributions, 0, NULL, NULL));
    SKG_CL_TRY(clEnqueueWriteBuffer(queue, geometry->part_table.memory, CL_FALSE, 0, (size_t)table,
                                    tables->entries, 0, NULL, read));
    return SKG_OK;
}

/* Brings the frame's tables to the device where they differ from those it has. */
skg_status skg_geometry_weigh(skg_context *context, skg_geometry *geometry, const skg_camera *camera,
                              const skg_geometry_part *part, double scale) {
    const int32_t next = (geometry->slot + 1) % geometry->slot_count;
    skg_table_slot *slot = &geometry->slots[next];
    SKG_TRY(wait_for(slot));
    SKG_TRY(fill_tables(geometry, 0, camera, part, scale, slot));
    const size_t lines = lines_size(geometry, camera);
    if (geometry->uploaded && same_tables(geometry, slot, &geometry->slots[geometry->slot], lines))
        return SKG_OK;
    const skg_pass_tables tables = {.passes = 1,
                                    .lines_bytes = (int64_t)lines,
                                    .contribution_count = slot->contribution_count,
                                    .entries = slot->entries,
                                    .contributions = slot->contributions};
    SKG_TRY(upload_tables(context, geometry, &tables, &slot->read));
    geometry->slot = next;
    geometry->uploaded = 1;
    return SKG_OK;
}

skg_status skg_geometry_weigh_pass(skg_geometry *geometry, const skg_camera *camera,
                                   const skg_geometry_part *part, double scale, int32_t room,
                                   skg_pass_tables *tables, skg_staging *staging) {
    skg_table_slot *slot = &geometry->slots[(geometry->slot + 1) % geometry->slot_count];
    const size_t table = (size_t)geometry->parts * skg_geometry_entry_size(geometry);
    SKG_TRY(wait_for(slot));
    SKG_TRY(fill_tables(geometry, tables->passes, camera, part, scale, slot));
    const size_t bytes = (size_t)slot->contribution_count * contribution_size(geometry);
    if (tables->passes == 0) {
        tables->contribution_count = slot->contribution_count;
        SKG_TRY(skg_staging_take(staging, room, table, "part table", &tables->entries));
        SKG_TRY(skg_staging_take(staging, room, bytes + 1, "contribution table", &tables->contributions));
    }
    if (slot->contribution_count != tables->contribution_count)
        return skg_fail(SKG_ERR_INTERNAL, "passes with different numbers of contributions");
    memcpy((char *)tables->entries + (size_t)tables->passes * table, slot->entries, table);
    if (bytes > 0)
        memcpy((char *)tables->contributions + (size_t)tables->passes * bytes, slot->contributions, bytes);
    tables->passes++;
    return SKG_OK;
}

skg_status skg_geometry_send_passes(skg_context *context, skg_geometry *geometry,
                                    const skg_pass_tables *tables) {
    return upload_tables(context, geometry, tables, NULL);
}
