/* A process that measures one build of the library, turn by turn. */
#ifndef BENCH_CONTENDER_H
#define BENCH_CONTENDER_H

#include "common/bench.h"

/* Measured times. The first ones are measured once for each process, the others in turns. */
enum {
    VERSUS_CONTEXT,
    VERSUS_SCENE,
    VERSUS_PLAN,
    VERSUS_FIRST,
    VERSUS_WARM,
    VERSUS_MOVING,
    VERSUS_VIEWS,
    VERSUS_COUNT
};
enum { VERSUS_ONCE = VERSUS_WARM, VERSUS_SETTINGS = 16 };

typedef struct {
    const char *scene, *device;
    long size, frames, turns, rounds, views;
    int count;                             /* of the settings of a scene file */
    const char *settings[VERSUS_SETTINGS]; /* KEY=VALUE */
} versus_settings;

/* Messages of a process after its first image, and after each turn. */
typedef struct {
    double ms[VERSUS_COUNT];
    int64_t parts, triangles, vertices, columns, rows;
} versus_start;

enum { VERSUS_FRAMES = 256 };
typedef struct {
    uint64_t hash; /* of the images' bits */
    double ms[VERSUS_FRAMES];
} versus_turn;

/* Runs a contender: reads the numbers of turns to take (VERSUS_WARM and so on) from standard input and writes to standard output until the
 * input ends. */
int versus_contend(const versus_settings *set);

#endif
