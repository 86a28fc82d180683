/* The meshes of a scene, loaded by several threads before the samples are read one by one. What fails here is tried again
 * where its sample is read, which finds the same failure and names the place in the file. */
#include "core/text.h"
#include "core/threads.h"
#include "mesh/mesh.h"
#include "setup/sections.h"

#include <string.h>

int skg_mesh_cache_same(const char *a, const char *b) {
    return a && b ? strcmp(a, b) == 0 : a == b;
}

static const struct skg_fetched_mesh *find(const skg_mesh_cache *cache, const char *path, const char *group,
                                           double unit_mm) {
    for (int64_t i = 0; i < cache->fetched_count; i++) {
        const struct skg_fetched_mesh *known = &cache->fetched[i];
        if (known->unit_mm == unit_mm && strcmp(known->path, path) == 0 &&
            skg_mesh_cache_same(known->group, group))
            return known;
    }
    return NULL;
}

skg_status skg_mesh_cache_want(const skg_setup_reader *reader, const skg_json_object *sample,
                               skg_mesh_cache *cache) {
    const skg_json_node name = skg_json_member(sample, "Path"), unit = skg_json_member(sample, "Unit"),
                        group = skg_json_member(sample, "Group");
    struct skg_fetched_mesh file = {.group = json_string_value(group.value)};
    if (!json_is_string(name.value) || (unit.value && !json_is_string(unit.value))) return SKG_OK;
    if (unit.value && skg_unit_of_length(json_string_value(unit.value), &file.unit_mm) != SKG_OK)
        return SKG_OK;
    SKG_TRY(skg_setup_where(reader, json_string_value(name.value), &file.path));
    skg_status status = SKG_OK;
    if (skg_mesh_is_shareable(file.path) && !find(cache, file.path, file.group, file.unit_mm)) {
        status = skg_realloc(cache->fetched_count + 1, sizeof *cache->fetched, "meshes", &cache->fetched);
        if (status == SKG_OK) {
            cache->fetched[cache->fetched_count++] = file;
            return SKG_OK;
        }
    }
    skg_free(&file.path);
    return status;
}

static skg_status fetch_one(void *user, int64_t item) {
    const skg_mesh_cache *cache = user;
    struct skg_fetched_mesh *file = &cache->fetched[item];
    const skg_mesh_reading reading = {
        .as_wound = cache->as_wound, .unit_mm = file->unit_mm, .group = file->group};
    skg_mesh_load_silently(file->path, &reading, &file->loaded);
    return SKG_OK;
}

skg_status skg_mesh_cache_fetch(skg_mesh_cache *cache) {
    return cache->fetched_count > 1 ? skg_parallel(cache->fetched_count, fetch_one, cache) : SKG_OK;
}

skg_status skg_mesh_cache_load(skg_mesh_cache *cache, skg_context *context, const char *path,
                               const char *group, double unit_mm, skg_mesh **mesh) {
    const struct skg_fetched_mesh *known = find(cache, path, group, unit_mm);
    const skg_mesh_reading reading = {
        .size = sizeof reading, .as_wound = cache->as_wound, .unit_mm = unit_mm, .group = group};
    if (!known || !known->loaded.mesh) return skg_mesh_load_as(context, path, &reading, mesh);
    SKG_TRY(skg_mesh_retain(known->loaded.mesh));
    skg_mesh_load_warn(context, path, &known->loaded);
    *mesh = known->loaded.mesh;
    return SKG_OK;
}

void skg_mesh_cache_clear(skg_mesh_cache *cache) {
    for (int64_t i = 0; i < cache->count; i++) skg_mesh_release(&cache->loaded[i].mesh);
    for (int64_t i = 0; i < cache->fetched_count; i++) {
        skg_mesh_release(&cache->fetched[i].loaded.mesh);
        skg_free(&cache->fetched[i].path);
    }
    skg_free(&cache->loaded);
    skg_free(&cache->fetched);
    cache->count = cache->fetched_count = 0;
}
