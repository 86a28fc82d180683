/* The health of a mesh: whether it is closed, which way its triangles face, how large it is. The time is linear in
 * the number of triangles except for the sorting of small groups. */
#include "mesh/groups.h"
#include "mesh/mesh.h"

#include "core/maths.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint64_t bits_of(double x) {
    uint64_t bits;
    x += 0.0; /* -0.0 becomes 0.0 */
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* The odd multipliers are digits of the golden ratio and of pi: they spread bits evenly and have no other meaning.
 * The shifts bring the high bits of a product down. */
static uint64_t hash(const double p[3]) {
    uint64_t h = bits_of(p[0]) * 0x9E3779B97F4A7C15u;
    h = ((h ^ (h >> 32)) + bits_of(p[1])) * 0x9E3779B97F4A7C15u;
    h = ((h ^ (h >> 32)) + bits_of(p[2])) * 0x243F6A8885A308D3u;
    return h ^ (h >> 29);
}

/* Sets mesh->weld: for each vertex the first one at the same place, found in a hash table of vertices. */
static skg_status weld(skg_mesh *mesh) {
    int32_t *table = NULL;
    uint64_t capacity = 16; /* a power of two, filled to three quarters at most */
    while (capacity < (uint64_t)mesh->vertices + (uint64_t)mesh->vertices / 3) capacity *= 2;
    SKG_TRY(skg_alloc(mesh->vertices, sizeof *mesh->weld, mesh->name, &mesh->weld));
    SKG_TRY(skg_alloc((int64_t)capacity, sizeof *table, mesh->name, &table));
    for (int32_t i = 0; i < mesh->vertices; i++) {
        const double *p = mesh->positions + 3 * (int64_t)i;
        uint64_t slot = hash(p) & (capacity - 1);
        for (;; slot = (slot + 1) & (capacity - 1)) {
            int32_t other = table[slot] - 1; /* 0: free */
            if (other < 0) {
                table[slot] = i + 1;
                mesh->weld[i] = i;
                mesh->health.welded_vertices++;
                break;
            }
            const double *q = mesh->positions + 3 * (int64_t)other;
            if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) {
                mesh->weld[i] = other;
                break;
            }
        }
    }
    skg_free(&table);
    return SKG_OK;
}

/* Counts how often one edge runs in each direction, and joins the components of its triangles. */
static void examine_edge(skg_mesh_health *health, const uint64_t *key, int64_t count, int64_t vertex,
                         int32_t *parent, int32_t *multiplicity) {
    int64_t up = 0;
    for (int64_t i = 0; i < count; i++) {
        up += (int64_t)(key[i] & 1);
        if (i > 0) skg_join(parent, (int32_t)(key[0] >> 1 & 0x3fffffff), (int32_t)(key[i] >> 1 & 0x3fffffff));
    }
    const int64_t down = count - up, most = up > down ? up : down;
    if (most > 1) health->consistent = 0;
    if (most > *multiplicity) *multiplicity = (int32_t)most;
    health->nonmanifold_edges += count > 2;
    health->same_way_edges += count == 2 && most == 2 ? 2 : 0;
    health->open_edges += up > down ? up - down : down - up;
    if (up != down && health->first_open_vertex < 0) health->first_open_vertex = vertex;
}

/* Counts what edges say, and joins the components of the triangles. parent: [triangles] */
static void walk_edges(skg_mesh *mesh, const skg_mesh_groups *edges, int32_t *parent, int32_t *multiplicity) {
    skg_mesh_health *health = &mesh->health;
    for (int32_t t = 0; t < mesh->triangles; t++) parent[t] = t;
    health->consistent = 1;
    health->first_open_vertex = -1;
    health->open_edges = health->nonmanifold_edges = 0;
    *multiplicity = 1;
    for (int64_t v = 0; v < mesh->vertices; v++)
        for (int64_t i = edges->start[v], end; i < edges->start[v + 1]; i = end) {
            end = skg_mesh_group_end(edges, v, i);
            examine_edge(health, edges->key + i, end - i, v, parent, multiplicity);
        }
    health->closed = health->open_edges == 0;
}

static skg_status examine_edges(skg_mesh *mesh) {
    skg_mesh_health *health = &mesh->health;
    skg_mesh_groups edges;
    int32_t *parent = NULL; /* of the triangles, which edges join to components */
    int32_t multiplicity = 1;
    skg_status status = SKG_OK;
    SKG_TRY(skg_mesh_group_edges(mesh, &edges));
    SKG_TRY_CLEANUP(skg_alloc(mesh->triangles, sizeof *parent, mesh->name, &parent));
    walk_edges(mesh, &edges, parent, &multiplicity);
    if (health->same_way_edges > 0 && !mesh->as_wound) {
        const int64_t same_way = health->same_way_edges;
        SKG_TRY_CLEANUP(skg_mesh_wind(mesh, &edges));
        skg_mesh_groups_free(&edges);
        SKG_TRY_CLEANUP(skg_mesh_group_edges(mesh, &edges));
        walk_edges(mesh, &edges, parent, &multiplicity);
        health->same_way_edges = same_way; /* as the caller wound them */
    }
    for (int32_t t = 0; t < mesh->triangles; t++) parent[t] = skg_root_of(parent, t);
    status = skg_mesh_set_pieces(mesh, parent, multiplicity);
cleanup:
    skg_mesh_groups_free(&edges);
    skg_free(&parent);
    return status;
}

/* Union-find over the welded vertices that triangles use. */
skg_status skg_mesh_components(const skg_mesh *mesh, int32_t *number, int64_t *count) {
    int32_t *parent = NULL; /* -1: not used so far */
    *count = 0;
    SKG_TRY(skg_alloc(mesh->vertices, sizeof *parent, mesh->name, &parent));
    for (int64_t v = 0; v < mesh->vertices; v++) parent[v] = -1;
    for (int64_t t = 0; t < mesh->triangles; t++) {
        uint32_t corner[3];
        int32_t root[3];
        skg_mesh_welded(mesh, t, corner);
        for (int k = 0; k < 3; k++) {
            int32_t v = (int32_t)corner[k];
            if (parent[v] < 0) parent[v] = v, ++*count;
            root[k] = skg_root_of(parent, v);
        }
        for (int k = 1; k < 3; k++) {
            *count -= skg_root_of(parent, root[0]) != skg_root_of(parent, root[k]);
            skg_join(parent, root[0], root[k]);
        }
    }
    if (number) { /* roots are replaced by -2 - number, in the order of their first triangles */
        int32_t next = 0;
        for (int64_t t = 0; t < mesh->triangles; t++) {
            uint32_t corner[3];
            skg_mesh_welded(mesh, t, corner);
            number[t] = skg_root_of(parent, (int32_t)corner[0]);
        }
        for (int64_t t = 0; t < mesh->triangles; t++) {
            if (parent[number[t]] >= 0) parent[number[t]] = -2 - next++;
            number[t] = -2 - parent[number[t]];
        }
    }
    skg_free(&parent);
    return SKG_OK;
}

void skg_mesh_measure(const skg_mesh *mesh, skg_mesh_health *health) {
    double volume = 0, area = 0, p[3];
    int64_t degenerate = 0;
    for (int k = 0; k < 3; k++) health->bounds[k] = DBL_MAX, health->bounds[3 + k] = -DBL_MAX;
    for (int64_t i = 0; i < mesh->vertices; i++) {
        skg_mesh_vertex(mesh, i, p);
        for (int k = 0; k < 3; k++) {
            if (p[k] < health->bounds[k]) health->bounds[k] = p[k];
            if (p[k] > health->bounds[3 + k]) health->bounds[3 + k] = p[k];
        }
    }
    for (int64_t t = 0; t < mesh->triangles; t++) {
        double a[3], b[3], c[3], u[3], v[3], cross[3];
        skg_mesh_vertex(mesh, mesh->corners[3 * t], a);
        skg_mesh_vertex(mesh, mesh->corners[3 * t + 1], b);
        skg_mesh_vertex(mesh, mesh->corners[3 * t + 2], c);
        for (int k = 0; k < 3; k++) u[k] = b[k] - a[k], v[k] = c[k] - a[k], a[k] -= mesh->origin[k];
        skg_cross(u, v, cross);
        degenerate += skg_mesh_no_area(cross, u, v);
        area += 0.5 * skg_length(cross);
        /* Divergence theorem: the signed volume of the tetrahedron with the mesh's origin. */
        volume += skg_dot(a, cross) / 6;
    }
    health->degenerate_triangles = degenerate;
    health->area = area;
    health->volume = mesh->orientation * volume;
}

void skg_mesh_turn_outward(skg_mesh *mesh) {
    skg_mesh_health *health = &mesh->health;
    skg_mesh_measure(mesh, health);
    if (!mesh->closed || !(health->volume < 0)) return;
    mesh->orientation = -mesh->orientation;
    health->volume = -health->volume;
    health->flipped = mesh->orientation < 0;
}

skg_status skg_mesh_examine(skg_mesh *mesh) {
    skg_mesh_health *health = &mesh->health;
    const skg_mesh_health of_file = *health;
    skg_mesh_health_init(health);
    health->left_out = of_file.left_out, health->trailing_bytes = of_file.trailing_bytes;
    health->vertices = mesh->vertices;
    health->triangles = mesh->triangles;
    SKG_TRY(weld(mesh));
    SKG_TRY(examine_edges(mesh));
    SKG_TRY(skg_mesh_count_duplicates(mesh));
    SKG_TRY(skg_mesh_components(mesh, NULL, &health->components));
    mesh->orientation = 1;
    mesh->closed = health->closed;
    skg_mesh_turn_outward(mesh);
    health->outward = health->closed && health->volume > 0;
    if (!health->closed) skg_mesh_vertex(mesh, health->first_open_vertex, health->first_open_position);
    if (health->welded_vertices == mesh->vertices) skg_free(&mesh->weld);
    return SKG_OK;
}

void skg_mesh_health_init_sized(void *health, int32_t size) {
    const skg_mesh_health defaults = {.first_open_vertex = -1, .first_turned = -1};
    skg_struct_init(health, size, &defaults, sizeof defaults);
}

skg_status skg_mesh_health_get(const skg_mesh *mesh, skg_mesh_health *health) {
    SKG_NEEDS(mesh);
    SKG_NEEDS(health);
    skg_mesh_health now = mesh->health;
    if (mesh->version > 1) {
        skg_mesh_measure(mesh, &now);
        if (now.first_open_vertex >= 0) skg_mesh_vertex(mesh, now.first_open_vertex, now.first_open_position);
    }
    return skg_struct_write(&now, sizeof now, "skg_mesh_health", health);
}
