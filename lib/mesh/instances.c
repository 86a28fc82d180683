/* Counts how often the parts of a file are placed: each part once, whatever the number of ways to it. */
#include "mesh/instances.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

enum { UNSEEN, OPEN, DONE };

double skg_mesh_bytes_max(int64_t size) {
    const double most = SKG_MESH_BYTES_TIMES * (double)size;
    return most > (double)SKG_MESH_BYTES_LEAST ? most : (double)SKG_MESH_BYTES_LEAST;
}

skg_status skg_mesh_check_bytes(const char *path, int64_t size, double bytes) {
    if (bytes <= skg_mesh_bytes_max(size)) return SKG_OK;
    return skg_fail(
        SKG_ERR_FORMAT,
        "%s: would take %.0f MiB of memory, more than 1 GiB and more than %d times its %" PRId64
        " bytes; save what it places many times as a file of its own, and place that in the scene",
        path, bytes / 1048576, SKG_MESH_BYTES_TIMES, size);
}

skg_status skg_mesh_check_times(const char *path, double times, const char *kind, const char *name,
                                double its) {
    if (times <= SKG_INSTANCES_MAX) return SKG_OK;
    return skg_fail(
        SKG_ERR_FORMAT,
        "%s: places %.15g parts, more than %d (the %s \"%s\" alone is made of %.15g); save what it places "
        "many times as a file of its own, and place that in the scene",
        path, times, (int)SKG_INSTANCES_MAX, kind, name, its);
}

void skg_instances_free(skg_instances *all) {
    skg_free(&all->nodes);
    skg_free(&all->names);
    skg_free(&all->references);
}

/* Room for one more. */
#define ROOM(all, array, its_count, its_capacity)                                                            \
    do {                                                                                                     \
        if ((all)->its_count == (all)->its_capacity) {                                                       \
            (all)->its_capacity = 2 * (all)->its_capacity + 16;                                              \
            SKG_TRY(skg_realloc((all)->its_capacity, sizeof *(all)->array, (all)->path, &(all)->array));     \
        }                                                                                                    \
    } while (0)

skg_status skg_instances_add(skg_instances *all, const char *name, double own, int64_t *node) {
    ROOM(all, nodes, count, capacity);
    *node = all->count++;
    all->nodes[*node] = (skg_instance){.own = own, .first = -1};
    snprintf(all->nodes[*node].name, sizeof all->nodes[*node].name, "%s", name);
    return SKG_OK;
}

/* FNV-1a; never 0. */
uint64_t skg_instances_key(uint64_t kind, const char *name) {
    uint64_t key = (UINT64_C(0xcbf29ce484222325) ^ kind) * UINT64_C(0x100000001b3);
    for (; *name; name++) key = (key ^ (unsigned char)*name) * UINT64_C(0x100000001b3);
    return key ? key : 1;
}

skg_status skg_instances_name(skg_instances *all, int64_t node, uint64_t key) {
    ROOM(all, names, name_count, name_capacity);
    all->names[all->name_count++] = (skg_instance_name){key, node};
    return SKG_OK;
}

static skg_status refer(skg_instances *all, int64_t from, skg_instance_reference what) {
    ROOM(all, references, reference_count, reference_capacity);
    what.next = all->nodes[from].first;
    all->nodes[from].first = all->reference_count;
    all->references[all->reference_count++] = what;
    return SKG_OK;
}

skg_status skg_instances_place(skg_instances *all, int64_t from, int64_t to) {
    return refer(all, from, (skg_instance_reference){.to = to});
}

skg_status skg_instances_place_named(skg_instances *all, int64_t from, uint64_t key, uint64_t other) {
    return refer(all, from, (skg_instance_reference){.key = key, .other = other, .to = -1});
}

static int by_key(const void *a, const void *b) {
    const skg_instance_name *one = a, *two = b;
    if (one->key != two->key) return one->key < two->key ? -1 : 1;
    return (one->node > two->node) - (one->node < two->node);
}

/* A name that several parts have becomes a part that places them, so that references stay as many as the file has. */
static skg_status join_names(skg_instances *all) {
    int64_t kept = 0;
    if (all->name_count > 0) qsort(all->names, (size_t)all->name_count, sizeof *all->names, by_key);
    for (int64_t i = 0, end; i < all->name_count; i = end) {
        skg_instance_name name = all->names[i];
        for (end = i + 1; end < all->name_count && all->names[end].key == name.key;) end++;
        if (end > i + 1) {
            char text[sizeof all->nodes->name];
            snprintf(text, sizeof text, "%s", all->nodes[name.node].name);
            SKG_TRY(skg_instances_add(all, text, 0, &name.node));
            for (int64_t k = i; k < end; k++)
                SKG_TRY(skg_instances_place(all, name.node, all->names[k].node));
        }
        all->names[kept++] = name;
    }
    all->name_count = kept;
    return SKG_OK;
}

static int64_t find(const skg_instances *all, uint64_t key) {
    int64_t low = 0, high = all->name_count;
    while (low < high) {
        const int64_t middle = (low + high) / 2;
        if (all->names[middle].key < key)
            low = middle + 1;
        else
            high = middle;
    }
    return key && low < all->name_count && all->names[low].key == key ? all->names[low].node : -1;
}

static skg_status resolve(skg_instances *all) {
    SKG_TRY(join_names(all));
    for (int64_t i = 0; i < all->reference_count; i++) {
        skg_instance_reference *reference = &all->references[i];
        if (reference->to < 0) reference->to = find(all, reference->key);
        if (reference->to < 0) reference->to = find(all, reference->other);
        if (reference->to >= 0) all->nodes[reference->to].placed = 1;
    }
    return SKG_OK;
}

static skg_status fail_deep(const skg_instances *all, const skg_instance *node) {
    return skg_fail(SKG_ERR_FORMAT,
                    "%s: the %s \"%s\" lies more than %d of them deep; save it without so many levels",
                    all->path, all->kind, node->name, (int)all->deepest);
}

static skg_status count_node(skg_instances *all, int64_t index, int32_t depth) {
    skg_instance *node = &all->nodes[index];
    if (node->state == DONE) return depth + node->height > all->deepest ? fail_deep(all, node) : SKG_OK;
    if (node->state == OPEN)
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: the %s \"%s\" contains itself; take what leads back to it out of the file",
                        all->path, all->kind, node->name);
    if (depth > all->deepest) return fail_deep(all, node);
    node->state = OPEN;
    node->times = node->own;
    node->takes = node->bytes;
    for (int64_t k = node->first; k >= 0; k = all->references[k].next) {
        const int64_t to = all->references[k].to;
        if (to < 0) continue;
        SKG_TRY(count_node(all, to, depth + 1));
        node->times += all->nodes[to].times;
        node->takes += all->nodes[to].takes;
        if (node->height <= all->nodes[to].height) node->height = all->nodes[to].height + 1;
    }
    node->state = DONE;
    return SKG_OK;
}

skg_status skg_instances_check(skg_instances *all) {
    double times = 0, takes = 0;
    int64_t most = -1;
    SKG_TRY(resolve(all));
    for (int64_t i = 0; i < all->count; i++) {
        const skg_instance *node = &all->nodes[i];
        if (i == 0 || all->all) SKG_TRY(count_node(all, i, 0));
        if (i > 0 && (most < 0 || node->times > all->nodes[most].times)) most = i;
        if (all->all ? !node->placed : i == 0) times += node->times, takes += node->takes;
    }
    SKG_TRY(skg_mesh_check_times(all->path, times, all->kind, most < 0 ? "" : all->nodes[most].name,
                                 most < 0 ? 0 : all->nodes[most].times));
    return skg_mesh_check_bytes(all->path, all->size, takes);
}
