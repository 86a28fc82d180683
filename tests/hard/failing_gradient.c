/* Derivatives for failing_test: of everything, and along a direction. */
#include "hard/failing_gradient.h"

#include "support/doubles.h"

#include <stddef.h>

enum { PARTS = 3, VERTICES = 512, PIXELS = 24 * 18, CHANNELS = 2, NODES = 256 };

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        skg_status try_status = (call);                                                                      \
        if (try_status < 0) return try_status;                                                               \
    } while (0)

/* In static memory: Check would allocate. */
static double poses[PARTS][6], vertices[3 * VERTICES], densities[PARTS], source[3], detector[6],
    attenuations[PARTS * NODES];

static skg_status by_everything(skg_plan *plan, const skg_view *view, void *weights, int64_t channels) {
    double *const of_parts[PARTS] = {NULL, vertices, NULL};
    skg_adjoint adjoint;
    skg_gradient gradient;
    skg_adjoint_init(&adjoint);
    skg_gradient_init(&gradient);
    adjoint.type = SKG_TYPE_FLOAT32;
    adjoint.channels = channels;
    adjoint.rows = view->rows;
    adjoint.columns = view->columns;
    adjoint.buffer = weights;
    gradient.poses = *poses;
    gradient.source = source;
    gradient.detector = detector;
    gradient.vertices = of_parts;
    gradient.densities = densities;
    TRY(skg_plan_node_count(plan, &gradient.nodes));
    if (gradient.nodes > NODES) return SKG_ERR_ARGUMENT;
    gradient.attenuations = attenuations;
    skg_job *job = NULL;
    int32_t done = 0;
    TRY(skg_plan_gradient_submit(plan, NULL, &adjoint, &gradient, &job));
    const skg_status asked = skg_job_test(job, &done);
    TRY(skg_job_wait(&job)); /* the job is released, whatever became of the question */
    return asked;
}

static skg_status along_a_direction(skg_plan *plan, float *image) {
    static const double twists[PARTS][6] = {{0}, {0.1, 0, 0.2, 0, 0.01, 0}};
    static const double away[3] = {0, -1, 0};
    static const double changes[PARTS] = {0, 1, 0};
    static double ones[3 * VERTICES], derivatives[2 * CHANNELS * PIXELS], coefficients[PARTS * NODES];
    const double *const of_parts[PARTS] = {NULL, ones, NULL};
    int64_t saturated[2];
    skg_direction directions[2], direction;
    skg_direction_init(&direction);
    skg_direction_init(&directions[1]);
    for (int k = 0; k < 3 * VERTICES; k++) ones[k] = 1;
    direction.poses = *twists;
    direction.vertices = of_parts;
    direction.source = away;
    direction.densities = changes;
    TRY(skg_plan_node_count(plan, &direction.nodes));
    if (direction.nodes > NODES) return SKG_ERR_ARGUMENT;
    coefficients[direction.nodes] = 0.01; /* of part 1 at the first energy */
    direction.attenuations = coefficients;
    directions[0] = direction;
    directions[1].poses = *twists;
    TRY(skg_plan_derivatives(plan, NULL, 2, directions, DOUBLES(derivatives), saturated));
    for (int i = 0; i < PIXELS; i++) image[i] = (float)derivatives[i];
    return SKG_OK;
}

/* Floats in the caller's buffer, which has been read by now. */
static skg_status into_a_buffer(skg_plan *plan, void *buffer) {
    static const double twists[PARTS][6] = {{0}, {0, 0, 0.1, 0, 0, 0}};
    skg_direction direction;
    skg_output output;
    skg_direction_init(&direction);
    skg_output_init(&output);
    direction.poses = *twists;
    output.buffer = buffer;
    return skg_plan_derivatives(plan, NULL, 1, &direction, &output, NULL);
}

skg_status failing_gradient(skg_plan *plan, const skg_scene *scene, const skg_view *view, void *weights,
                            float *image) {
    int64_t count = 0, triangles = 0, channels = 0;
    skg_part part;
    skg_part_init(&part);
    TRY(skg_scene_part_get(scene, 1, &part));
    TRY(skg_mesh_count(part.mesh, &count, &triangles));
    TRY(skg_plan_channel_count(plan, &channels));
    if (count > VERTICES || channels > CHANNELS) return SKG_ERR_ARGUMENT;
    TRY(by_everything(plan, view, weights, channels));
    TRY(along_a_direction(plan, image));
    TRY(into_a_buffer(plan, weights));
    for (int k = 0; k < 6; k++) image[k] = (float)poses[1][k], image[6 + k] = (float)detector[k];
    for (int k = 0; k < 3; k++)
        image[12 + k] = (float)source[k], image[15 + k] = (float)densities[k],
                   image[18 + k] = (float)vertices[k];
    return SKG_OK;
}
