/* Solids and views at which coverage by rounded arithmetic goes wrong, with the truth about each. */
#include "hard/scenes.h"

#include <string.h>

static void octahedra(hard_scene *h, int projection, int edges) {
    h->name = edges                                ? "octahedra with edges along rays"
              : projection == SKG_PROJECTION_POINT ? "octahedra"
                                                   : "octahedra, parallel";
    h->turned = edges ? 1e-4 : 0;
    h->view = run_view(512, 0.75); /* steps and places of pixels are floats */
    h->view.projection = projection;
    h->wobble =
        0x1p-15; /* an ulp of a corner's float place, 256 pixels from the part's own: these are steep */
    h->body = solid_octahedra(3000, &h->view, projection == SKG_PROJECTION_POINT ? 3 : 0, edges ? 1 : 2, 11);
}

static void cubes_on_centres(hard_scene *h) {
    h->name = "cubes with front edges on centres";
    h->view = run_view(65, 3);
    h->view.source[2] = -800;
    h->view.centre[2] = 800;
    h->body = solid_box(24, 24, 24); /* front at z = 0, half-way: its corners are at 8 pixels */
    for (int n = 1; n < 4; n++) {
        solid next = solid_box(24, 24, 24);
        solid_shift(&next, 24 * (n & 1), 24 * (n >> 1), 0);
        solid_add(&h->body, &next);
        solid_free(&next);
    }
    solid_shift(&h->body, 0, 0, 12);
    h->wobble = 1e-4;
}

static void flat(hard_scene *h, int oblique) {
    static const double tilt[16] = {1, 0.3, 0, 0, 0, 0.01, 0, 0.2, 0.2, 0, 0.02, 0, 0, 0, 0, 1};
    static const double squeeze[12] = {1, 0, 0, 0, 0, 0.02, 0, 0, 0, 0, 1, 0};
    h->name = oblique ? "oblique slivers" : "slivers";
    h->view = run_view(256, 0.75);
    h->body = solid_blob(60, 200, 100, 3);
    h->sliver = 1;
    if (oblique)
        memcpy(h->pose, tilt, sizeof tilt);
    else
        solid_move(&h->body, squeeze);
}

static void layers(hard_scene *h) {
    h->name = "twenty shells at one place";
    h->view = run_view(128, 1.25);
    h->body = solid_sphere(40, 40, 20);
    for (int n = 1; n < 20; n++) {
        solid again = solid_sphere(40, 40, 20);
        solid_add(&h->body, &again);
        solid_free(&again);
    }
}

static void dust(hard_scene *h, int speck) {
    h->name = speck ? "a speck" : "dust";
    h->view = run_view(64, 2);
    h->body = solid_blob(speck ? 2.5 : 40, speck ? 200 : 400, speck ? 100 : 200, 8);
    if (speck) solid_shift(&h->body, 31.7, -22.9, 14);
}

static void about_the_source(hard_scene *h, int which) {
    h->view = run_view(160, 1.5);
    if (which == HARD_SOURCE_AND_DETECTOR) {
        h->name = "a box through source and detector";
        h->body = solid_box(150, 90, 4000);
        solid_shift(&h->body, 7, -11, 0);
    } else if (which == HARD_SOURCE_INSIDE) {
        h->name = "source inside";
        h->body = solid_blob(60, 60, 30, 4);
        h->view.source[0] = 13.7;
        h->view.source[2] = -21.3;
    } else {
        h->name = "cut by the detector";
        h->body = solid_blob(90, 60, 30, 5);
        solid_shift(&h->body, 20, 10, 190);
    }
}

/* Depths of the origin and of the bounding sphere say little about what is between source and detector here.
 */
static void large(hard_scene *h, int which) {
    h->view = run_view(64, 3.7);
    h->wobble = 0x1p-15;
    if (which == HARD_WIDE) {
        h->name = "a wide slab";
        h->body = solid_box(2000, 1600, 7);
    } else if (which == HARD_LONG) {
        h->name = "a very long box";
        h->body = solid_box(150, 90, 40000);
    } else {
        h->name = which == HARD_MOSTLY_BEHIND ? "mostly behind the detector"
                                              : "mostly behind the detector, parallel";
        h->body = solid_box(150, 90, 1000);
        solid_shift(&h->body, 0, 0, 650);
        h->view.projection = which == HARD_MOSTLY_BEHIND ? SKG_PROJECTION_POINT : SKG_PROJECTION_PARALLEL;
    }
}

static void simple(hard_scene *h, int which) {
    if (which == HARD_CUBE_ON_CENTRES) {
        h->name = "cube on centres";
        h->view = run_view(65, 1);
        h->view.projection = SKG_PROJECTION_PARALLEL;
        h->body = solid_box(32, 32, 32);
        h->wobble = 1e-4;
    } else {
        h->name = "a giant";
        h->view = run_view(96, 1.5);
        h->body = solid_blob(300, 24, 12, 9);
        solid_move(&h->body, (const double[12]){20, 0, 0, 900, 0, 30, 0, -2000, 0.1, 0, 0.5, -200});
    }
}

hard_scene hard_make(int which) {
    hard_scene h = {.pose = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    switch (which) {
    case HARD_OCTAHEDRA:
        octahedra(&h, SKG_PROJECTION_POINT, 0);
        break;
    case HARD_OCTAHEDRA_EDGES:
        octahedra(&h, SKG_PROJECTION_POINT, 1);
        break;
    case HARD_OCTAHEDRA_PARALLEL:
        octahedra(&h, SKG_PROJECTION_PARALLEL, 0);
        break;
    case HARD_CUBES_ON_CENTRES:
        cubes_on_centres(&h);
        break;
    case HARD_SLIVERS:
        flat(&h, 0);
        break;
    case HARD_SLIVERS_OBLIQUE:
        flat(&h, 1);
        break;
    case HARD_DUST:
        dust(&h, 0);
        break;
    case HARD_SPECK:
        dust(&h, 1);
        break;
    case HARD_LAYERS:
        layers(&h);
        break;
    case HARD_LONG:
    case HARD_WIDE:
    case HARD_MOSTLY_BEHIND:
    case HARD_MOSTLY_BEHIND_PARALLEL:
        large(&h, which);
        break;
    case HARD_CUBE_ON_CENTRES:
    case HARD_GIANT:
        simple(&h, which);
        break;
    default:
        about_the_source(&h, which);
        break;
    }
    return h;
}

void hard_free(hard_scene *h) {
    solid_free(&h->body);
}
