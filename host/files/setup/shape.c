/* Shapes of a scene file that are made and not read. */
#include "core/context.h"
#include "core/maths.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <inttypes.h>
#include <string.h>

enum { PATH, CUBE, CUBOID, CYLINDER, SPHERE, STEP_WEDGE, SHAPES };
static const char *const shapes[] = {"Path", "Cube", "Cuboid", "Cylinder", "Sphere", "StepWedge"};

/* In the arrays of generated shapes a number of sectors comes first, then lengths, and the unit last. */
static const struct {
    int64_t sectors, lengths;
    const char *example;
} forms[] = {[CUBE] = {0, 1, "[edge, \"mm\"]"},
             [CUBOID] = {0, 3, "[x, y, z, \"mm\"]"},
             [CYLINDER] = {1, 2, "[sectors, height, radius, \"mm\"]"},
             [SPHERE] = {1, 1, "[sectors, radius, \"mm\"]"}};

enum { SECTORS_MAX = 100000 };

/* The mesh gets one more owner; the path belongs to the set-up. */
static skg_status remember(skg_mesh_cache *cache, const char *path, const char *group, double unit_mm,
                           int32_t flip, skg_mesh *mesh) {
    SKG_TRY(skg_realloc(cache->count + 1, sizeof *cache->loaded, "meshes", &cache->loaded));
    SKG_TRY(skg_mesh_retain(mesh));
    cache->loaded[cache->count++] = (struct skg_loaded_mesh){
        .path = path, .group = group, .unit_mm = unit_mm, .flip = flip, .mesh = mesh};
    return SKG_OK;
}

/* Replaces a leaky mesh by one with every triangle reversed. The normals of a closed mesh point outward whatever its
 * file says, so nothing changes. */
static skg_status turn_inside_out(const skg_setup_reader *reader, const skg_json_node *node,
                                  skg_mesh **mesh) {
    skg_mesh_health health;
    skg_mesh_health_init(&health);
    SKG_TRY(skg_mesh_health_get(*mesh, &health));
    if (health.closed) {
        char place[256];
        skg_json_place(node, place, sizeof place);
        skg_logger_say(&reader->log, SKG_LOG_NOTE,
                       "%s: FlipNormals has no effect on a closed mesh, whose normals point outward anyway",
                       place);
        return SKG_OK;
    }
    const char *name = NULL;
    double *positions = NULL;
    int32_t *corners = NULL;
    skg_mesh *turned = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_mesh_name_get(*mesh, &name));
    SKG_TRY_CLEANUP(skg_alloc(health.vertices, 3 * sizeof *positions, name, &positions));
    SKG_TRY_CLEANUP(skg_alloc(health.triangles, 3 * sizeof *corners, name, &corners));
    SKG_TRY_CLEANUP(skg_mesh_positions_get(*mesh, positions, 3));
    SKG_TRY_CLEANUP(skg_mesh_triangles_get(*mesh, corners, 3));
    for (int64_t i = 0; i < health.triangles; i++) {
        int32_t second = corners[3 * i + 1];
        corners[3 * i + 1] = corners[3 * i + 2];
        corners[3 * i + 2] = second;
    }
    SKG_TRY_CLEANUP(skg_mesh_create(reader->context, name,
                                    &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                       .vertices = health.vertices,
                                                       .positions = positions,
                                                       .as_wound = reader->setup->as_wound,
                                                       .position_stride = 3,
                                                       .triangles = health.triangles,
                                                       .corners = corners,
                                                       .triangle_stride = 3,
                                                       .unit_mm = 1},
                                    &turned));
    skg_mesh_release(mesh);
    *mesh = turned;
cleanup:
    skg_free(&positions);
    skg_free(&corners);
    return status;
}

/* Turns the inverted components of a mesh, if it has some. */
static skg_status orient(const skg_setup_reader *reader, const skg_json_node *node, skg_mesh **mesh) {
    skg_mesh_nesting nesting;
    skg_mesh *oriented = NULL;
    char place[256];
    skg_mesh_nesting_init(&nesting);
    SKG_TRY(skg_mesh_nesting_get(*mesh, &nesting));
    if (nesting.inverted == 0) return SKG_OK;
    SKG_TRY(skg_mesh_create_oriented(reader->context, *mesh, &oriented));
    skg_mesh_release(mesh);
    *mesh = oriented;
    skg_json_place(node, place, sizeof place);
    skg_logger_say(&reader->log, SKG_LOG_NOTE, "%s: %" PRId64 " of %" PRId64 " components turned", place,
                   nesting.inverted, nesting.components);
    return SKG_OK;
}

static skg_status load(skg_setup_reader *reader, const skg_json_object *sample, const skg_json_node *node,
                       int32_t flip, skg_mesh_cache *cache, skg_mesh **mesh) {
    const char *name = NULL, *path = NULL, *group = NULL;
    double unit_mm = 0; /* the file's */
    const skg_json_node unit = skg_json_member(sample, "Unit"), piece = skg_json_member(sample, "Group");
    SKG_TRY(skg_json_text(node, &name));
    if (unit.value) SKG_TRY(skg_json_unit_of_length(&unit, &unit_mm));
    if (piece.value) SKG_TRY(skg_json_text(&piece, &group));
    SKG_TRY(skg_setup_find_file(reader, name, &path));
    for (int64_t i = 0; i < cache->count; i++) {
        const struct skg_loaded_mesh *known = &cache->loaded[i];
        if (strcmp(known->path, path) != 0 || known->unit_mm != unit_mm || known->flip != flip ||
            !skg_mesh_cache_same(known->group, group))
            continue;
        SKG_TRY(skg_mesh_retain(known->mesh));
        *mesh = known->mesh;
        return SKG_OK;
    }
    SKG_TRY(skg_json_at(node, skg_mesh_cache_load(cache, reader->context, path, group, unit_mm, mesh)));
    if (flip) SKG_TRY(turn_inside_out(reader, node, mesh));
    if (reader->setup->orient) SKG_TRY(orient(reader, node, mesh));
    return remember(cache, path, group, unit_mm, flip, *mesh);
}

static skg_status make_step_wedge(const skg_json_node *node, skg_mesh **mesh) {
    static const char *const names[] = {"TotalLength", "Width", "FirstStepHeight", "OtherStepHeight"};
    skg_json_object wedge;
    skg_json_node member;
    int64_t steps = 0;
    double length[4], mm = 1;
    SKG_TRY(skg_json_read_object(node, &skg_keys_step_wedge, &wedge));
    SKG_TRY(skg_json_need(&wedge, "NumberOfSteps", "5", &member));
    SKG_TRY(skg_json_integer(&member, 1, SECTORS_MAX, &steps));
    SKG_TRY(skg_json_need(&wedge, "Unit", "\"mm\"", &member));
    SKG_TRY(skg_json_unit_of_length(&member, &mm));
    for (int k = 0; k < 4; k++) {
        SKG_TRY(skg_json_need(&wedge, names[k], "10", &member));
        SKG_TRY(skg_json_number(&member, &length[k]));
        length[k] *= mm;
    }
    double *heights = NULL;
    SKG_TRY(skg_alloc(steps, sizeof *heights, "step wedge", &heights));
    for (int64_t k = 0; k < steps; k++) heights[k] = length[2] + (double)k * length[3];
    const skg_status status = skg_mesh_create_steps(length[0], length[1], steps, heights, mesh);
    skg_free(&heights);
    return skg_json_at(node, status);
}

/* The axis of the schema's cylinders is y, that of generated ones z. */
static const double y_from_z[16] = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};

static skg_status make(const skg_json_node *node, int shape, skg_mesh **mesh, double *own) {
    if (shape == STEP_WEDGE) return make_step_wedge(node, mesh);
    int64_t count = 0, sectors = 0;
    int64_t wanted = forms[shape].sectors + forms[shape].lengths + 1;
    double length[3] = {0, 0, 0}, mm = 1;
    SKG_TRY(skg_json_array(node, forms[shape].example, &count));
    if (count != wanted)
        return skg_json_fail(node, SKG_ERR_FORMAT, "has %" PRId64 " elements instead of %" PRId64 "; give %s",
                             count, wanted, forms[shape].example);
    if (forms[shape].sectors) {
        skg_json_node element = skg_json_element(node, 0);
        SKG_TRY(skg_json_integer(&element, 3, SECTORS_MAX, &sectors));
    }
    skg_json_node unit = skg_json_element(node, count - 1);
    SKG_TRY(skg_json_unit_of_length(&unit, &mm));
    for (int64_t k = 0; k < forms[shape].lengths; k++) {
        skg_json_node element = skg_json_element(node, forms[shape].sectors + k);
        SKG_TRY(skg_json_number(&element, &length[k]));
        length[k] *= mm;
    }
    if (shape == CYLINDER) memcpy(own, y_from_z, sizeof y_from_z);
    skg_status status = shape == CUBE     ? skg_mesh_create_cube(length[0], mesh)
                        : shape == CUBOID ? skg_mesh_create_cuboid(length[0], length[1], length[2], mesh)
                        : shape == SPHERE ? skg_mesh_create_sphere(length[0], sectors, mesh)
                                          : skg_mesh_create_cylinder(length[1], length[0], sectors, mesh);
    return skg_json_at(node, status);
}

skg_status skg_setup_read_shape(skg_setup_reader *reader, const skg_json_object *sample, int32_t flip,
                                skg_mesh_cache *cache, skg_mesh **mesh, double *own) {
    int found = -1;
    skg_pose_identity(own);
    for (int shape = 0; shape < SHAPES; shape++) {
        if (!skg_json_member(sample, shapes[shape]).value) continue;
        if (found >= 0)
            return skg_json_fail(sample->node, SKG_ERR_FORMAT, "has both %s and %s; a sample has one of them",
                                 shapes[found], shapes[shape]);
        found = shape;
    }
    if (found < 0)
        return skg_json_fail(sample->node, SKG_ERR_FORMAT,
                             "has no shape; give a Path, or a Cube, Cuboid, Cylinder, Sphere or StepWedge");
    skg_json_node node = skg_json_member(sample, shapes[found]);
    static const char *const of_files[] = {"Unit", "Group"};
    for (int k = 0; k < 2 && found != PATH; k++) {
        const skg_json_node other = skg_json_member(sample, of_files[k]);
        if (other.value)
            return skg_json_fail(&other, SKG_ERR_FORMAT, "%s is for files, and a %s has none%s; leave it out",
                                 of_files[k], shapes[found], k ? "" : ": its unit stands with its lengths");
    }
    return found == PATH ? load(reader, sample, &node, flip, cache, mesh) : make(&node, found, mesh, own);
}
