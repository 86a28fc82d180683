/* Fills a pass: what parts contribute, where they lie, and the scale of the sums. */
#include "frame/frames.h"
#include "geometry/optics.h"
#include "stage/volumes.h"

#include <math.h>
#include <string.h>

/* Contributions of parts to the only plane of path lengths: 1 mm per mm of the part asked for, less its children. The box of cells, which
 * are added to the plane later, is listed without a contribution. */
static skg_status list_lengths(const skg_scene *scene, const skg_frame_work *work, skg_pass *pass) {
    SKG_TRY(skg_alloc(scene->count, sizeof *pass->own_contributions, "parts of a frame",
                      &pass->own_contributions));
    SKG_TRY(skg_alloc(scene->count + 1, sizeof *pass->own_first, "parts of a frame", &pass->own_first));
    int64_t count = 0;
    for (int64_t p = 0; p < scene->count; p++) {
        const int is_child = work->which == SKG_LENGTHS_NET && scene->parts[p].inside == work->part;
        pass->own_first[p] = count;
        if (p == work->part || is_child)
            pass->own_contributions[count++] =
                (skg_contribution){.weight = is_child                           ? -1
                                             : work->which == SKG_LENGTHS_CELLS ? 0
                                                                                : 1};
    }
    pass->own_first[scene->count] = count;
    return SKG_OK;
}

static skg_status list_contributions(const skg_recipe *recipe, const skg_frame_work *work, skg_pass *pass) {
    const int is_length = work->kind == SKG_OUTPUT_LENGTHS;
    pass->planes = is_length ? 1 : recipe->model.planes;
    if (is_length)
        SKG_TRY(list_lengths(recipe->scene, work, pass));
    else if (work->frame && work->frame->override_count != 0)
        SKG_TRY(skg_overrides_apply(recipe, work->frame, &pass->own_contributions, &pass->own_first));
    pass->contributions = pass->own_first ? pass->own_contributions : recipe->model.contributions;
    pass->first = pass->own_first ? pass->own_first : recipe->model.first_contribution;
    return SKG_OK;
}

/* Parts that contribute alike share an accumulator, if that pays and there are not more kinds than planned. */
static skg_status mix_planes(const skg_recipe *recipe, const skg_frame_work *work, skg_pass *pass) {
    if (work->kind == SKG_OUTPUT_LENGTHS || !recipe->mixed) return SKG_OK;
    SKG_TRY(skg_mix_find(recipe->scene->count, recipe->model.planes, pass->contributions, pass->first,
                         recipe->mixed, &pass->mix));
    if (!pass->mix.sums) return SKG_OK; /* the overrides of this frame make more kinds of parts */
    pass->contributions = pass->mix.contributions;
    pass->first = pass->mix.first_contribution;
    pass->planes = recipe->mixed;
    return SKG_OK;
}

/* Whether some part contributes to more than one plane. */
static int has_lists(const skg_pass *pass, int64_t parts) {
    for (int64_t p = 0; p < parts; p++)
        if (pass->first[p + 1] - pass->first[p] > 1) return 1;
    return 0;
}

static double largest_weight(const skg_pass *pass, int64_t part) {
    double largest = 0;
    for (int64_t c = pass->first[part]; c < pass->first[part + 1]; c++)
        largest = fmax(largest, fabs(pass->contributions[c].weight));
    return largest;
}

/* Where the parts lie, what they may contribute, and the scale that follows from both. */
static void place_parts(const skg_recipe *recipe, const skg_frame_work *work, const skg_pass_memory *memory,
                        skg_pass *pass) {
    const skg_scene *scene = recipe->scene;
    const skg_scale_grid grid = skg_scale_grid_of(&memory->grid, pass->camera.columns, pass->camera.rows);
    const double last_bit = skg_recipe_last_bit(recipe);
    int64_t contributing = 0;
    pass->parts = memory->parts;
    pass->extents = memory->extents;
    pass->volumes = memory->volumes;
    for (int64_t p = 0; p < scene->count; p++) {
        const skg_mesh *mesh = scene->parts[p].mesh;
        const double *pose = work->poses && work->poses[p] ? work->poses[p] : scene->parts[p].pose;
        const int64_t count = pass->first[p + 1] - pass->first[p];
        skg_extent *extent = &pass->extents[p];
        const skg_placed_mesh *placed = skg_placement_of(memory->placement, mesh, recipe->meshes.of_part[p]);
        if (placed)
            skg_extent_find_within(&pass->camera, mesh, placed->lowest, placed->highest, pose, last_bit,
                                   skg_mesh_layers_unseen(mesh), extent);
        else
            skg_extent_find(&pass->camera, mesh, pose, last_bit, extent);
        pass->parts[p] =
            (skg_geometry_part){.pose = pose,
                                .origin = mesh->origin,
                                .flipped = mesh->orientation < 0,
                                .reference = 0.5 * (extent->scale.low_depth + extent->scale.high_depth),
                                .depth = extent->scale.high_depth - extent->scale.low_depth,
                                .columns = {extent->scale.low_column, extent->scale.high_column},
                                .rows = {extent->scale.low_row, extent->scale.high_row},
                                .contributions = mesh->closed ? (int32_t)count : 0,
                                .contribution = pass->contributions + pass->first[p]};
        if (count == 0) continue;
        extent->scale.weight = largest_weight(pass, p);
        if (work->kind != SKG_OUTPUT_LENGTHS || work->which == SKG_LENGTHS_CELLS)
            extent->scale.weight += skg_volumes_most(memory->volumes, p);
        memory->scales[contributing++] = extent->scale;
        pass->kernels.source_plane |= extent->near_source && extent->on_detector;
    }
    skg_scale_find(&grid, contributing, memory->scales,
                   recipe->options.precision == SKG_PRECISION_DOUBLE ? 64 : 32, &pass->scale);
}

/* The groups of parts that touch, unless they are known for these poses and meshes. Parts whose vertices move together go on touching:
 * of meshes that move, every sixteenth version is looked at, because that takes a twentieth of a frame. */
static void find_groups(const skg_recipe *recipe, const skg_pass_memory *memory, const skg_pass *pass) {
    enum { EVERY = 16 };
    int64_t count = 0;
    int known = 1;
    for (int64_t p = 0; p < pass->scene->count; p++) {
        const skg_mesh *mesh = recipe->scene->parts[p].mesh;
        const skg_mesh_layout *layout = &memory->geometry->layouts[recipe->meshes.of_part[p]];
        const double *pose = pass->parts[p].pose;
        if (!layout->flat) continue;
        known &= memory->versions[p] == 1 + mesh->version / EVERY &&
                 memcmp(memory->poses[p], pose, sizeof *memory->poses) == 0;
        memory->versions[p] = 1 + mesh->version / EVERY;
        memcpy(memory->poses[p], pose, sizeof *memory->poses);
        memory->touching[count++] =
            (skg_touching){.part = (int32_t)p, .mesh = mesh, .layout = layout, .pose = pose};
    }
    if (!known) skg_touching_find(count, memory->touching, memory->group_of);
}

/* Gives the parts that touch what they have in common. Near the plane of the source, coordinates of single precision have no rests
 * (fine.clh), and are better off with the part's own pixel. */
static void find_touching(const skg_recipe *recipe, const skg_pass_memory *memory, skg_pass *pass) {
    const int is_double = recipe->options.precision == SKG_PRECISION_DOUBLE;
    const int apart = pass->kernels.source_plane && !is_double && !pass->camera.parallel;
    find_groups(recipe, memory, pass);
    for (int64_t p = 0; p < pass->scene->count; p++) memory->groups[p].members = 0;
    for (int64_t p = 0; p < pass->scene->count; p++) {
        skg_geometry_part *part = &pass->parts[p];
        if (!memory->geometry->layouts[recipe->meshes.of_part[p]].flat) continue;
        if (apart || skg_touching_is_huge(&pass->camera, part->columns, part->rows)) {
            skg_touching_group own = {.members = 0};
            skg_touching_join(&own, part->columns, part->rows, 0);
            skg_touching_measure(&pass->camera, &own);
            part->shift = is_double ? 0x1p-44 * own.farthest : skg_touching_shift(&own, 0);
        } else {
            const double noise = skg_touching_noise(&pass->camera, recipe->scene->parts[p].mesh, part->pose,
                                                    &pass->extents[p].scale);
            skg_touching_join(&memory->groups[memory->group_of[p]], part->columns, part->rows, noise);
        }
    }
    for (int64_t p = 0; p < pass->scene->count; p++)
        if (memory->groups[p].members > 1) skg_touching_measure(&pass->camera, &memory->groups[p]);
    for (int64_t p = 0; p < pass->scene->count; p++) {
        skg_geometry_part *part = &pass->parts[p];
        if (!memory->geometry->layouts[recipe->meshes.of_part[p]].flat || part->shift > 0) continue;
        const skg_touching_group *group = &memory->groups[memory->group_of[p]];
        if (group->members < 2) continue;
        part->shift = skg_touching_shift(group, is_double);
        part->touches = 1;
        part->shared[0] = group->pixel[0], part->shared[1] = group->pixel[1];
    }
}

/* Whether a part that competes, or falls with one that does, adds anything to this frame. */
static int competitors_contribute(const skg_pass *pass) {
    for (int64_t s = 0; s < pass->priority.count; s++)
        if (pass->first[pass->priority.parts[s] + 1] > pass->first[pass->priority.parts[s]]) return 1;
    return 0;
}

/* Which parts compete for intervals in this frame. The lengths of a mesh's surface do not depend on other parts. */
static skg_status find_priorities(const skg_recipe *recipe, const skg_frame_work *work, skg_pass *pass) {
    pass->rules = skg_priority_rules(recipe->options.clip, recipe->options.unite);
    if (!recipe->priority_possible ||
        (work->kind == SKG_OUTPUT_LENGTHS && work->which == SKG_LENGTHS_SURFACE))
        return SKG_OK;
    SKG_TRY(skg_priority_find(recipe->scene, pass->rules, &pass->camera, pass->extents, &pass->priority));
    if (!competitors_contribute(pass)) skg_priority_release(&pass->priority);
    for (int64_t s = 0; s < pass->priority.count; s++)
        pass->kernels.source_plane |= pass->extents[pass->priority.parts[s]].near_source;
    return SKG_OK;
}

/* Fails if the detector is curved and a part reaches the plane of a point source, where a vertex has no place on a line. */
static skg_status check_curved(const skg_pass *pass) {
    if (!skg_camera_is_curved(&pass->camera) || pass->camera.parallel || !pass->kernels.source_plane)
        return SKG_OK;
    for (int64_t p = 0; p < pass->scene->count; p++)
        if (pass->extents[p].near_source)
            return skg_fail(
                SKG_ERR_UNSUPPORTED,
                "part %s reaches the plane of the source, which is not computed with a curved detector; "
                "move it, or take a flat one",
                pass->scene->parts[p].label);
    return skg_fail(SKG_ERR_INTERNAL, "a curved detector without a part at the source");
}

/* Which pixels the jaws leave. */
static skg_status find_window(const skg_recipe *recipe, const skg_frame_work *work, skg_pass *pass) {
    const skg_collimation *collimation = recipe->options.collimation;
    skg_field field;
    if (work->kind == SKG_OUTPUT_LENGTHS || !skg_collimation_limits(collimation)) return SKG_OK;
    SKG_TRY(skg_field_make(collimation, work->view, &field));
    return skg_field_window(&field, &pass->camera, pass->window);
}

skg_status skg_pass_fill(const skg_recipe *recipe, const skg_frame_work *work, int64_t number,
                         const skg_pass_memory *memory, skg_pass *pass) {
    skg_kernel_options *kernels = &pass->kernels;
    *pass = (skg_pass){.scene = recipe->scene, .fine = number < 0 ? 1 : (int32_t)recipe->samples.fine};
    if (number < 0)
        SKG_TRY(skg_camera_make(work->view, NULL, 0, 0, &pass->camera));
    else
        SKG_TRY(skg_samples_camera(&recipe->samples, work->view, number, &pass->camera));
    SKG_TRY(find_window(recipe, work, pass));
    SKG_TRY(list_contributions(recipe, work, pass));
    SKG_TRY(mix_planes(recipe, work, pass));
    place_parts(recipe, work, memory, pass);
    find_touching(recipe, memory, pass);
    SKG_TRY(find_priorities(recipe, work, pass));
    SKG_TRY(check_curved(pass));
    kernels->precision = skg_recipe_kernel_precision(recipe);
    kernels->half = recipe->options.precision == SKG_PRECISION_HALF;
    kernels->bits = kernels->half ? 32 : pass->scale.bits; /* half: units of 2^-24 m, whatever the scene */
    kernels->parallel = pass->camera.parallel;
    kernels->curved = skg_camera_is_curved(&pass->camera);
    kernels->seams = recipe->scene->count > 1;
    kernels->listed = kernels->half || has_lists(pass, recipe->scene->count);
    return SKG_OK;
}

void skg_pass_extents(const skg_pass *pass, cl_int *extents) {
    for (int64_t p = 0; p < pass->scene->count; p++) {
        cl_int own[4];
        skg_extent_pixels(&pass->camera, &pass->extents[p], own);
        for (int64_t c = pass->first[p]; c < pass->first[p + 1]; c++)
            skg_extent_join(extents + 4 * pass->contributions[c].plane, own);
    }
}
