/* Programs and kernels for the stages: the one place that writes -D options, sets arguments and enqueues. Private. */
#ifndef SKG_KERNELS_H
#define SKG_KERNELS_H

#include "arguments.h"
#include "stage/stage_log.h"

/* The options of the kernels that project and rasterise. */
typedef struct {
    int32_t precision;    /* SKG_PRECISION_SINGLE or SKG_PRECISION_DOUBLE */
    int32_t bits;         /* of an accumulator: 32 or 64 */
    int32_t parallel;     /* 1: parallel beam */
    int32_t source_plane; /* 1: some part may reach the source, or the plane where parallel paths start */
    int32_t seams;        /* 1: parts may touch, so that edges are moved for coverage */
    int32_t half;         /* 1: distances are rounded to 16 bits; precision is single */
    int32_t listed;       /* 1: parts contribute as their lists say; 0: to one plane each, without bias */
    int32_t curved;       /* 1: rows of the raster are lines of a curved detector */
} skg_kernel_options;

/* How many lanes kernels with wide vectors use on this device. */
int32_t skg_kernel_lanes(skg_context *context, int32_t precision);

/* A -D name of a program and its value. A table of them gives the options of a program, and tells it from others. */
typedef struct {
    const char *name;
    int64_t value;
} skg_define;

/* The options "-D NAME=VALUE -D ..." of a table. */
skg_status skg_defines_text(int32_t count, const skg_define *defines, size_t size, char *text);

/* Tables of -D names, and further options of the compiler. */
typedef struct {
    int32_t count, reserved;
    const skg_define *defines; /* [count] */
    const char *flags;         /* NULL: none */
} skg_program_options;
#define SKG_DEFINES(table)                                                                                   \
    (&(const skg_program_options){.count = (int32_t)(sizeof(table) / sizeof *(table)), .defines = (table)})

/* The program of these kernel files, behind the headers that all need, from the context's cache or built. more: NULL: no -D
 * names but those of the options; program: NULL: it is only prefetched (skg_prefetch_begin). */
skg_status skg_kernels_get(skg_context *context, const skg_kernel_options *options, int32_t files,
                           const char *const *names, const skg_program_options *more, cl_program *program);

/* The share of a work-item of the stage `attenuate` on a CPU: vectors of pixels together, and how often. */
enum { SKG_CPU_RUNS = 4, SKG_CPU_STRIP = 8 };

/* Whether these are the options of the program that a first image needs on a CPU. */
int skg_kernels_are_first(const skg_context *context, const skg_kernel_options *options);

/* Gets the program of a first image: strategy `copies`, and the attenuation of one plane. Both together take less time to compile than two programs,
 * because a driver reads its own header for each. */
skg_status skg_kernels_get_first(skg_context *context, cl_program *program);

/* One argument of a kernel: its position, by the name that kernels/shared/arguments.h gives it, and its value. */
typedef struct {
    cl_uint position;
    size_t size;
    const void *value;
} skg_argument;
#define SKG_ARGUMENT(kernel, name, object)                                                                   \
    { SKG_##kernel##_##name, sizeof(object), &(object) }

/* The work-items of a launch in each of its dimensions; whole groups are launched. */
typedef struct {
    cl_uint dimensions;
    int64_t items[3], group[3];
} skg_work_size;

/* Sets a kernel's arguments and enqueues it. arguments: an array of skg_argument; stage: for messages and for the log, which may
 * be NULL. */
#define SKG_LAUNCH(context, kernel, stage, work, arguments, log)                                             \
    skg_kernel_launch(context, kernel, stage, work, (int32_t)(sizeof(arguments) / sizeof *(arguments)),      \
                      arguments, log)
skg_status skg_kernel_launch(skg_context *context, cl_kernel kernel, const char *stage,
                             const skg_work_size *work, int32_t count, const skg_argument *arguments,
                             skg_stage_log *log);

/* SKG_LAUNCH with a kernel that is made for this launch alone. */
#define SKG_LAUNCH_ONCE(context, program, function, stage, work, arguments, log)                             \
    skg_program_launch(context, program, function, stage, work,                                              \
                       (int32_t)(sizeof(arguments) / sizeof *(arguments)), arguments, log)
skg_status skg_program_launch(skg_context *context, cl_program program, const char *function,
                              const char *stage, const skg_work_size *work, int32_t count,
                              const skg_argument *arguments, skg_stage_log *log);

/* An argument that is a struct in the precision of the kernel. */
#define SKG_ARGUMENT_WITH(kernel, name, is_double, twice, single)                                            \
    {                                                                                                        \
        SKG_##kernel##_##name, (is_double) ? sizeof(twice) : sizeof(single),                                 \
            (is_double) ? (const void *)&(twice) : (const void *)&(single)                                   \
    }

/* Rounds a struct of arguments to single precision. first_whole: the first member behind the reals. */
#define SKG_ROUND_ARGUMENTS(twice, single, first_whole)                                                      \
    skg_arguments_round(&(twice), (size_t)((const char *)&(twice).first_whole - (const char *)&(twice)),     \
                        sizeof(twice), &(single))
void skg_arguments_round(const void *twice, size_t reals, size_t size, void *single);

/* Enqueues a write of `bytes` of data. The data must stay until the device has read them. */
skg_status skg_stage_write(skg_context *context, const char *stage, cl_mem buffer, int64_t offset,
                           int64_t bytes, const void *data, skg_stage_log *log);

#endif
