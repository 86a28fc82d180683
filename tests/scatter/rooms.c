/* The rooms of which the truth is known. */
#include "rooms.h"

#include "support/random.h"

#include <stdio.h>

#define MONO(energy) .bins = 1, .kev = {energy}, .photons = {1}
#define BOX(x, y, z, a, b, c, ...)                                                                           \
    { .shape = ROOM_BOX, .at = {x, y, z}, .size = {a, b, c}, .material = __VA_ARGS__ }
#define BALL(x, y, z, r, ...)                                                                                \
    { .shape = ROOM_BALL, .at = {x, y, z}, .size = {r}, .material = __VA_ARGS__ }
#define ROD(x, y, z, r, l, axis, ...)                                                                        \
    { .shape = ROOM_ROD, .at = {x, y, z}, .size = {r, l, axis}, .material = __VA_ARGS__ }
#define WATER "Water, Liquid"
#define PMMA "PMMA"
#define AIR "Air, Dry (near sea level)"
#define BONE "Bone, Cortical (ICRU-44)"
#define TISSUE "Tissue, Soft (ICRU-44)"

const room rooms[] = {
    {.name = "lead 3 mm with a hole of 60 mm, 200 mm before water",
     MONO(80),
     .source = -1000,
     .plane = 150,
     .side = {300, 300},
     .count = 5,
     .bodies = {BOX(0, 0, 0, 300, 300, 200, WATER), BOX(-115, 0, -301.5, 170, 400, 3, "Pb"),
                BOX(115, 0, -301.5, 170, 400, 3, "Pb"), BOX(0, -115, -301.5, 60, 170, 3, "Pb"),
                BOX(0, 115, -301.5, 60, 170, 3, "Pb")}},
    {.name = "lead 2 mm, 50 mm behind water, before half",
     MONO(100),
     .source = -1000,
     .plane = 200,
     .side = {300, 300},
     .count = 2,
     .bodies = {BOX(0, 0, 0, 300, 300, 200, WATER), BOX(100, 0, 151, 200, 400, 2, "Pb")}},
    {.name = "lead .5 mm on the exit side of water, half",
     MONO(80),
     .source = -1000,
     .plane = 200,
     .side = {300, 300},
     .count = 2,
     .bodies = {BOX(0, 0, 0, 300, 300, 200, WATER), BOX(75, 0, 100.25, 150, 300, 0.5, "Pb")}},
    {.name = "iron cube 20 mm, table of 1 m 400 mm below",
     MONO(200),
     .source = -1000,
     .plane = 150,
     .side = {100, 100},
     .count = 2,
     .bodies = {BOX(0, 0, 0, 20, 20, 20, "Fe"), BOX(0, -420, 0, 1000, 20, 1000, PMMA)}},
    {.name = "aluminium cube 20 mm in .9 m of air",
     MONO(80),
     .source = -1000,
     .plane = 200,
     .side = {150, 150},
     .count = 2,
     .bodies = {BOX(0, 0, -250.5, 400, 400, 899, AIR), BOX(0, 0, 0, 20, 20, 20, "Al", .inside = 1)}},
    {.name = "aluminium cube 20 mm over a table of 1 m",
     MONO(80),
     .source = -1000,
     .plane = 200,
     .side = {150, 150},
     .count = 2,
     .bodies = {BOX(0, 0, 0, 20, 20, 20, "Al"), BOX(0, -120, 0, 1000, 20, 1000, PMMA)}},
    {.name = "aluminium cube 20 mm on a steel stage of 100 mm",
     MONO(80),
     .source = -1000,
     .plane = 200,
     .side = {150, 150},
     .count = 2,
     .bodies = {BOX(0, 0, 0, 20, 20, 20, "Al"), ROD(0, -20.01, 0, 50, 20, 1, "Fe")}},
    {.name = "hand 25 mm with bones on a table of 600 mm",
     MONO(60),
     .source = -1000,
     .plane = 80,
     .side = {240, 240},
     .count = 7,
     .bodies = {BOX(0, 0, 0, 90, 180, 25, TISSUE), BOX(0, 0, 20, 600, 600, 10, PMMA),
                ROD(-34, 0, 0, 5, 170, 1, BONE, .inside = 1), ROD(-17, 0, 0, 5, 170, 1, BONE, .inside = 1),
                ROD(0, 0, 0, 5, 170, 1, BONE, .inside = 1), ROD(17, 0, 0, 5, 170, 1, BONE, .inside = 1),
                ROD(34, 0, 0, 5, 170, 1, BONE, .inside = 1)}},
    {.name = "ten materials with K edges in 60 mm of water, 120 kV",
     .bins = 10,
     .kev = {25, 35, 45, 55, 59.3, 67.2, 75, 85, 95, 110},
     .photons = {.05, .13, .16, .16, .14, .1, .1, .08, .05, .03},
     .source = -1000,
     .plane = 120,
     .side = {200, 100},
     .count = 11,
     .bodies = {BOX(0, 0, 0, 200, 100, 60, WATER),
                BOX(-80, -20, 0, 15, 15, 15, "Mo", .density = .3, .inside = 1),
                BOX(-40, -20, 0, 15, 15, 15, "Ag", .density = .3, .inside = 1),
                BOX(0, -20, 0, 15, 15, 15, "Sn", .density = .3, .inside = 1),
                BOX(40, -20, 0, 15, 15, 15, "I", .density = .3, .inside = 1),
                BOX(80, -20, 0, 15, 15, 15, "Ba", .density = .3, .inside = 1),
                BOX(-80, 20, 0, 15, 15, 15, "Gd", .density = .3, .inside = 1),
                BOX(-40, 20, 0, 15, 15, 15, "Ta", .density = .3, .inside = 1),
                BOX(0, 20, 0, 15, 15, 15, "W", .density = .3, .inside = 1),
                BOX(40, 20, 0, 15, 15, 15, "Pb", .density = .3, .inside = 1),
                BOX(80, 20, 0, 15, 15, 15, "Al", .inside = 1)}},
    {.name = "aluminium casting with three holes",
     MONO(150),
     .source = -1000,
     .plane = 200,
     .side = {150, 150},
     .count = 4,
     .bodies = {ROD(0, 0, 0, 30, 90, 1, "Al"), BALL(0, -25, 0, 6, "Vacuum", .inside = 1),
                BALL(10, 0, 5, 9, "Vacuum", .inside = 1), BALL(-8, 25, -6, 4, "Vacuum", .inside = 1)}},
    {.name = "aluminium cube 20 mm, a world of air",
     MONO(60),
     .world = AIR,
     .source = -1000,
     .plane = 200,
     .side = {300, 300},
     .count = 1,
     .bodies = {BOX(0, 0, 0, 20, 20, 20, "Al")}},
    {.name = "lead slit of 2 mm, 200 mm before PMMA",
     MONO(100),
     .source = -800,
     .plane = 250,
     .side = {200, 200},
     .count = 3,
     .bodies = {BOX(0, 0, 0, 150, 150, 100, PMMA), BOX(-51, 0, -200, 100, 200, 5, "Pb"),
                BOX(51, 0, -200, 100, 200, 5, "Pb")}},
    {.name = "nickel blade 8 mm with three channels of 4 mm",
     MONO(250),
     .source = -700,
     .plane = 300,
     .side = {120, 160},
     .count = 4,
     .bodies = {BOX(0, 0, 0, 60, 100, 8, "Ni"), ROD(-15, 0, 0, 2, 90, 1, "Vacuum", .inside = 1),
                ROD(0, 0, 0, 2, 90, 1, "Vacuum", .inside = 1),
                ROD(15, 0, 0, 2, 90, 1, "Vacuum", .inside = 1)}},
    {.name = "teeth in tissue, one with gold",
     MONO(50),
     .source = -400,
     .plane = 30,
     .side = {60, 60},
     .count = 5,
     .bodies = {BOX(0, 0, 0, 60, 60, 40, TISSUE), BOX(-12, 0, 0, 8, 20, 8, BONE, .inside = 1),
                BOX(0, 0, 0, 8, 20, 8, BONE, .inside = 1), BOX(0, -12, 0, 8, 3, 8, "Au", .inside = 1),
                BOX(12, 0, 0, 8, 20, 8, BONE, .inside = 1)}},
    {.name = "water in a steel tank of 206 mm",
     MONO(300),
     .source = -1500,
     .plane = 400,
     .side = {400, 400},
     .count = 2,
     .bodies = {ROD(0, 0, 0, 103, 300, 1, "Fe"), ROD(0, 0, 0, 100, 294, 1, WATER, .inside = 1)}},
    {.name = "printed board, copper .035 mm, two chips",
     MONO(40),
     .source = -300,
     .plane = 60,
     .side = {80, 80},
     .count = 5,
     .bodies = {BOX(0, 0, 0, 80, 60, 1.6, PMMA), BOX(-20, 0, 0.8175, 1, 50, 0.035, "Cu"),
                BOX(0, 0, 0.8175, 10, 50, 0.035, "Cu"), BOX(20, 10, 2, 10, 10, 2, "Si"),
                BOX(20, -10, 1.9, 6, 6, 1.8, "Sn")}},
};

const int rooms_count = sizeof rooms / sizeof *rooms;

/* A body of a layer that begins at z and is `thick` deep. */
static room_body draw_body(uint64_t *seed, double z, double thick) {
    static const char *const materials[] = {WATER, PMMA, "Al", "Fe", "Cu", BONE, TISSUE, "Pb"};
    enum { MATERIALS = sizeof materials / sizeof *materials };
    room_body body = {.shape = (int)draw_below(seed, 3), .material = materials[draw_below(seed, MATERIALS)]};
    for (int k = 0; k < 2; k++) body.at[k] = draw(seed, -60, 60);
    body.at[2] = z + thick / 2;
    if (thick < 10) body.shape = ROOM_BOX;
    if (body.shape == ROOM_BOX) {
        for (int k = 0; k < 2; k++) body.size[k] = draw(seed, 20, thick < 10 ? 300 : 150);
        body.size[2] = thick;
        return body;
    }
    body.size[0] = thick / 2;
    body.size[1] = draw(seed, 30, 200), body.size[2] = (double)draw_below(seed, 2);
    return body;
}

room room_draw(uint64_t seed, char *name) {
    room r = {.name = name, .source = -1000, .bins = 1, .photons = {1}};
    double z = -200;
    snprintf(name, 32, "random room %d", (int)seed);
    r.kev[0] = draw(&seed, 45, 180);
    r.count = 2 + (int)draw_below(&seed, 4);
    for (int i = 0; i < r.count; i++) {
        const int is_thin = draw(&seed, 0, 1) < 0.4;
        const double thick = is_thin ? draw(&seed, 0.3, 4) : draw(&seed, 15, 90);
        r.bodies[i] = draw_body(&seed, z, thick);
        z += thick + draw(&seed, 1, 60);
    }
    r.plane = z + draw(&seed, 30, 150);
    for (int k = 0; k < 2; k++) r.side[k] = draw(&seed, 120, 300);
    return r;
}
