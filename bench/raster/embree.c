/* Every hit of every ray by Embree 3: packets of 16 coherent rays (4 x 4 pixels) with a filter function that
 * adds the signed distance and rejects the hit, so that the ray continues. The tree is built beforehand and
 * is not timed. It has no spatial splits (quality high), because a triangle in two leaves would be hit twice. */
#include "contenders.h"
#include "geometry.h"

#include <embree3/rtcore.h>

#include <math.h>
#include <stdlib.h>

enum { RAYS = 16, SIDE = 4 };

struct embree {
    RTCDevice device;
    RTCScene scene;
    float *lengths;
    int threads, columns, rows;
    float source[3], first[3], column[3], row[3];
};

/* The filter finds its sums behind the context, which Embree passes to it. */
typedef struct {
    struct RTCIntersectContext context;
    float sum[RAYS];
} collector;

/* Rays and hits are structures of arrays of `count` elements, one field after the other. These are the
 * numbers of the fields: the accessors of Embree's header are for C++ only. */
enum { RAY_DIRECTION = 4, RAY_FAR = 8, RAY_NUMBER = 10, HIT_NORMAL = 0 };

/* Each lane has one hit. */
static inline void collect_lanes(const float *ray, const float *hit, int *restrict valid, unsigned count,
                                 float *restrict sum) {
    for (unsigned k = 0; k < count; k++) {
        const float *direction = ray + RAY_DIRECTION * count + k, *normal = hit + HIT_NORMAL * count + k;
        const float facing = direction[0] * normal[0] + direction[count] * normal[count] +
                             direction[2 * count] * normal[2 * count];
        const float t = ray[RAY_FAR * count + k], signed_t = facing > 0 ? t : -t;
        sum[k] += valid[k] ? signed_t : 0;
        valid[k] = 0;
    }
}

/* Embree passes 16 rays at once, or 8, or fewer. id: the ray's index in the packet. */
static void collect(const struct RTCFilterFunctionNArguments *arguments) {
    collector *into = (collector *)(void *)arguments->context;
    const unsigned count = arguments->N, *id = (const unsigned *)arguments->ray + RAY_NUMBER * count;
    const float *ray = (const float *)arguments->ray, *hit = (const float *)arguments->hit;
    float sum[RAYS] = {0};
    if (count == RAYS)
        collect_lanes(ray, hit, arguments->valid, RAYS, sum);
    else if (count == RAYS / 2)
        collect_lanes(ray, hit, arguments->valid, RAYS / 2, sum);
    else
        collect_lanes(ray, hit, arguments->valid, count, sum);
    for (unsigned k = 0; k < count; k++) into->sum[id[k]] += sum[k];
}

static void build(embree *self, const bench_shape *shape) {
    self->device = rtcNewDevice(NULL);
    if (!self->device) bench_die("Embree cannot open a device");
    self->scene = rtcNewScene(self->device);
    rtcSetSceneFlags(self->scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry mesh = rtcNewGeometry(self->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *positions = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                               3 * sizeof(float), (size_t)shape->vertices);
    unsigned *corners = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(unsigned), (size_t)shape->triangles);
    if (!positions || !corners) bench_die("Embree: memory for the mesh is exhausted");
    for (int64_t k = 0; k < 3 * shape->vertices; k++) positions[k] = shape->positions[k];
    for (int64_t k = 0; k < 3 * shape->triangles; k++) corners[k] = (unsigned)shape->corners[k];
    rtcSetGeometryIntersectFilterFunction(mesh, collect);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(self->scene, mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(self->scene);
    if (rtcGetDeviceError(self->device) != RTC_ERROR_NONE) bench_die("Embree cannot build its scene");
}

embree *embree_create(const bench_shape *shape, const skg_view *view, int threads, float *lengths) {
    embree *self = bench_alloc(1, sizeof *self);
    build(self, shape);
    self->lengths = lengths;
    self->threads = threads;
    self->columns = (int)view->columns;
    self->rows = (int)view->rows;
    double first[3];
    to_first_pixel(view, first);
    for (int k = 0; k < 3; k++) {
        self->first[k] = (float)first[k];
        self->source[k] = (float)view->source[k];
        self->column[k] = (float)view->column_step[k];
        self->row[k] = (float)view->row_step[k];
    }
    return self;
}

void embree_free(embree *self) {
    if (!self) return;
    rtcReleaseScene(self->scene);
    rtcReleaseDevice(self->device);
    free(self);
}

/* The rays of the packet whose first pixel is (i, j): from the source at t = 0 to their pixels at t = 1. */
static void aim(const embree *self, int i, int j, struct RTCRayHit16 *rays) {
    for (int k = 0; k < RAYS; k++) {
        const float column = (float)(i + k % SIDE), row = (float)(j + k / SIDE);
        rays->ray.org_x[k] = self->source[0];
        rays->ray.org_y[k] = self->source[1];
        rays->ray.org_z[k] = self->source[2];
        rays->ray.dir_x[k] = self->first[0] + column * self->column[0] + row * self->row[0];
        rays->ray.dir_y[k] = self->first[1] + column * self->column[1] + row * self->row[1];
        rays->ray.dir_z[k] = self->first[2] + column * self->column[2] + row * self->row[2];
        rays->ray.tnear[k] = 0;
        rays->ray.tfar[k] = 1;
        rays->ray.time[k] = 0;
        rays->ray.mask[k] = ~0u;
        rays->ray.id[k] = (unsigned)k;
        rays->ray.flags[k] = 0;
        rays->hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        rays->hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
}

static void trace(const embree *self, int i, int j) {
    _Alignas(64) struct RTCRayHit16 rays;
    _Alignas(64) int valid[RAYS];
    collector into;
    rtcInitIntersectContext(&into.context);
    into.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    aim(self, i, j, &rays);
    for (int k = 0; k < RAYS; k++) {
        into.sum[k] = 0;
        valid[k] = i + k % SIDE < self->columns && j + k / SIDE < self->rows ? -1 : 0;
    }
    rtcIntersect16(valid, self->scene, &into.context, &rays);
    for (int k = 0; k < RAYS; k++) {
        if (!valid[k]) continue;
        const float x = rays.ray.dir_x[k], y = rays.ray.dir_y[k], z = rays.ray.dir_z[k];
        self->lengths[(int64_t)(j + k / SIDE) * self->columns + i + k % SIDE] =
            into.sum[k] * sqrtf(x * x + y * y + z * z);
    }
}

void embree_frame(void *contender) {
    const embree *self = contender;
#pragma omp parallel for schedule(dynamic, 1) num_threads(self->threads)
    for (int j = 0; j < self->rows; j += SIDE)
        for (int i = 0; i < self->columns; i += SIDE) trace(self, i, j);
}
