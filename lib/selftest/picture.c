/* The self-test of the 3D view: two boxes. */
#include "selftest/selftest.h"

#include <skiagraph/scene_picture.h>

#include <stdio.h>
#include <string.h>

enum { N = 160, BOXES = 2, CORNERS = 8, FACES = 6, MARGIN = 2 };

typedef struct {
    skg_scene *scene;
    skg_view view;
    skg_look look;
    skg_box boxes[BOXES];
    double corners[BOXES * CORNERS][3], places[BOXES * CORNERS][2];
    uint8_t opaque[4 * N * N], translucent[4 * N * N];
} picture_run;

/* Red stands behind green. */
static const uint8_t colours[4 * BOXES] = {220, 30, 30, 255, 30, 220, 30, 255};
static const uint8_t half_green[4 * BOXES] = {220, 30, 30, 255, 30, 220, 30, 128};

static skg_status add_box(skg_context *context, picture_run *run, int number) {
    skg_part part;
    skg_part_init(&part);
    part.label = number == 0 ? "behind" : "in front";
    skg_status status = skg_boxes_mesh(context, &run->boxes[number], 1, 0, &part.mesh);
    if (status == SKG_OK) status = skg_material_create_mu(part.label, 0.1, &part.material);
    if (status == SKG_OK) status = skg_scene_part_add(run->scene, &part, NULL);
    skg_material_release(&part.material);
    skg_mesh_release(&part.mesh);
    return status;
}

static skg_status make_scene(skg_context *context, picture_run *run) {
    static const double centres[BOXES][3] = {{0, 0, 12}, {7, 4, -12}},
                        halves[BOXES][3] = {{22, 18, 5}, {8, 9, 6}};
    static const double angles[3] = {0.2, 0.1, 0.3}, from[3] = {0.4, -0.3, -1};
    skg_view_init(&run->view);
    run->view.columns = run->view.rows = N;
    run->view.source[2] = -80;
    run->view.centre[2] = 50;
    run->view.column_step[0] = run->view.row_step[1] = 0.4;
    skg_look_init(&run->look);
    run->look.orthographic = 1;
    run->look.columns = run->look.rows = N;
    run->look.colours = colours;
    for (int k = 0; k < 3; k++) run->look.from[k] = from[k];
    SKG_TRY(skg_scene_create(context, &run->scene));
    for (int b = 0; b < BOXES; b++) {
        run->boxes[b] = skg_box_turned(centres[b], halves[b], angles);
        for (int n = 0; n < CORNERS; n++) skg_box_corner(&run->boxes[b], n, run->corners[CORNERS * b + n]);
        SKG_TRY(add_box(context, run, b));
    }
    return SKG_OK;
}

/* Whether a place of the picture lies within a quadrilateral. */
static int within(double (*places)[2], const int *quad, double x, double y) {
    int left = 0;
    for (int k = 0; k < 4; k++) {
        const double *a = places[quad[k]], *b = places[quad[(k + 1) % 4]];
        left += (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0;
    }
    return left == 0 || left == 4;
}

/* A box covers what its faces cover. */
static int covers(picture_run *run, int box, double x, double y) {
    static const int quads[FACES][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    int any = 0;
    for (int f = 0; f < FACES; f++) any |= within(run->places + CORNERS * box, quads[f], x, y);
    return any;
}

/* 1: the box covers all places around the pixel; 0: none; -1: some. */
static int around(picture_run *run, int box, int row, int column) {
    int covered = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) covered += covers(run, box, column + MARGIN * i, row + MARGIN * j);
    return covered == 9 ? 1 : covered == 0 ? 0 : -1;
}

/* Whether a pixel looks as it has to, in both pictures: the box that it shows, and behind the translucent one the other. */
static int is_right(const uint8_t *opaque, const uint8_t *translucent, int front, int behind) {
    if (!front) return opaque[0] > 2 * opaque[1] && translucent[0] == opaque[0];
    if (opaque[1] <= 2 * opaque[0]) return 0;
    return !behind || (translucent[0] > opaque[0] + 2 && translucent[1] < opaque[1]);
}

static void compare(picture_run *run, skg_verdict *verdict) {
    int wrong = 0, compared[BOXES] = {0};
    for (int p = 0; p < N * N; p++) {
        const int front = around(run, 1, p / N, p % N), behind = around(run, 0, p / N, p % N);
        if (front < 0 || behind < 0 || front + behind == 0) continue;
        compared[front]++;
        const uint8_t *c = run->opaque + 4 * p;
        if (is_right(c, run->translucent + 4 * p, front, behind)) continue;
        if (wrong++ == 0)
            snprintf(verdict->reason, sizeof verdict->reason,
                     "pixel (%d, %d) of the picture is (%d, %d, %d) where the %s box is, the first", p / N,
                     p % N, c[0], c[1], c[2], front ? "green" : "red");
    }
    /* An edge of the beam crosses the boxes. */
    verdict->good = compared[0] > N && compared[1] > N && 20 * wrong <= compared[0] + compared[1];
    if (verdict->good) verdict->reason[0] = '\0';
    const size_t used = strlen(verdict->reason);
    if (!verdict->good)
        snprintf(verdict->reason + used, sizeof verdict->reason - used, " of %d pixels", wrong);
}

skg_status skg_self_test_picture(skg_context *context, skg_verdict *verdict) {
    picture_run *run = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof *run, "device test", &run));
    SKG_TRY_CLEANUP(make_scene(context, run));
    SKG_TRY_CLEANUP(skg_scene_places_get(run->scene, &run->view, &run->look, BOXES * CORNERS, run->corners[0],
                                         run->places[0]));
    SKG_TRY_CLEANUP(skg_scene_picture(context, run->scene, &run->view, &run->look, run->opaque));
    run->look.colours = half_green;
    SKG_TRY_CLEANUP(skg_scene_picture(context, run->scene, &run->view, &run->look, run->translucent));
    compare(run, verdict);
cleanup:
    skg_scene_release(&run->scene);
    skg_free(&run);
    return status;
}
