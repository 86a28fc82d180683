/* Single interactions as the kernel samples them. */
#include "sample.h"

#include "device/programs.h"
#include "frame/plans.h"

#include <stdio.h>
#include <string.h>

/* One interaction of each photon at the middle of a cell: how it flies on. out: weight, cosine, keV, 1 after a Compton scattering */
static const char sampling_kernel[] =
    "__kernel void sample(skg_scatter_args args, __global const skg_mix *media, __global const uint *tree, __global const float4 *faces, __global const skg_mix *energies,\n"
    "                     __global const skg_mix *momenta, __global const float *angles, int cell, float kev,\n"
    "                     int photons, __global float4 *out) {\n"
    "    const skg_scattering s = {&args, {media, tree, faces}, energies, momenta, 0};\n"
    "    const int first = (int)get_global_id(0) * SKG_WIDE;\n"
    "    int number[SKG_WIDE], changed[SKG_WIDE];\n"
    "    float weight[SKG_WIDE], cosine[SKG_WIDE], left[SKG_WIDE];\n"
    "    skg_interaction i;\n"
    "    skg_sight sight;\n"
    "    skg_uv words[4];\n"
    "    const skg_fv middle[3] = {(skg_fv)(0.5f * args.size[0]), (skg_fv)(0.5f * args.size[1]), (skg_fv)(0.5f * args.size[2])};\n"
    "    const skg_place3 direction = {(skg_fv)(0.48f), (skg_fv)(-0.6f), (skg_fv)(0.64f)};\n"
    "    skg_photons p = {.at = {middle[0], middle[1], middle[2]}, .direction = direction, .kev = (skg_fv)(kev), .weight = (skg_fv)(1.0f),\n"
    "                     .order = (skg_uv)(0u), .alive = (skg_intv)(-1), .changed = (skg_intv)(0)};\n"
    "    for (int l = 0; l < SKG_WIDE; l++) number[l] = first + l, i.medium.of[l] = media[SKG_CELL_MEDIUM_OF(tree[cell])];\n"
    "    const skg_intv numbers = SKG_LOAD_V(intv, number);\n"
    "    const skg_rows rows = skg_rows_at(skg_energy_place(&args, p.kev));\n"
    "    i.total = skg_value(energies, SKG_SCATTER_COLUMNS, SKG_OF_TOTAL, &rows, &i.medium);\n"
    "    i.compton = skg_value(energies, SKG_SCATTER_COLUMNS, SKG_OF_COMPTON, &rows, &i.medium);\n"
    "    i.rayleigh = skg_value(energies, SKG_SCATTER_COLUMNS, SKG_OF_RAYLEIGH, &rows, &i.medium);\n"
    "    i.compton_shape = skg_value(energies, SKG_SCATTER_COLUMNS, SKG_OF_COMPTON_SHAPE, &rows, &i.medium);\n"
    "    i.rayleigh_shape = skg_value(energies, SKG_SCATTER_COLUMNS, SKG_OF_RAYLEIGH_SHAPE, &rows, &i.medium);\n"
    "    i.emitted = (skg_fv)(0.0f), i.line = p.kev;\n"
    "    skg_see(&args, p.at, &sight);\n"
    "    skg_words(&args, SKG_AS_UINT_V(numbers), p.order, 0, 0, words);\n"
    "    const skg_fv angle = (SKG_TO_FLOAT_V(numbers) + (skg_fv)(0.5f)) * (skg_fv)(1.0f / photons);\n"
    "    skg_fly_on(&s, angles, &p, &sight, &i, angle, skg_uniform(words[0]), skg_uniform(words[1]));\n"
    "    SKG_STORE_V(realv, p.weight, weight);\n"
    "    SKG_STORE_V(realv, skg_dot3(direction, p.direction), cosine);\n"
    "    SKG_STORE_V(realv, p.kev, left);\n"
    "    SKG_STORE_V(intv, p.changed, changed);\n"
    "    for (int l = 0; l < SKG_WIDE; l++) out[first + l] = (float4)(weight[l], cosine[l], left[l], changed[l] ? 1.0f : 0.0f);\n"
    "}\n";

enum { TEXTS = 22 };

static skg_status build(skg_context *context, cl_program *program) {
    static const char *const names[TEXTS - 1] = {
        "config.clh",       "types.clh",       "skg_shared.h", "scalar.clh", "triangle.clh", "wide.clh",
        "triangle.clh",     "exponential.clh", "random.clh",   "noise.clh",  "scatter.clh",  "walk.clh",
        "fluorescence.clh", "sight.clh",       "strips.clh",   "arrive.clh", "profile.clh",  "emit.clh",
        "tally.clh",        "next_event.clh",  "scatter.cl"};
    const char *texts[TEXTS] = {0};
    char options[256];
    cl_int code = CL_SUCCESS;
    for (int f = 0; f < TEXTS - 1; f++)
        for (int i = 0; i < skg_kernel_source_count; i++)
            if (strcmp(skg_kernel_sources[i].name, names[f]) == 0) texts[f] = skg_kernel_sources[i].text;
    texts[TEXTS - 1] = sampling_kernel;
    snprintf(options, sizeof options,
             "-D SKG_DOUBLE=0 -D SKG_BITS=32 -D SKG_SEAMS=0 -D SKG_NOISE=0 -D SKG_WIDE=%d",
             (int)skg_kernel_lanes(context, SKG_PRECISION_SINGLE));
    *program = clCreateProgramWithSource(context->device->cl, TEXTS, texts, NULL, &code);
    SKG_CL_TRY(code);
    SKG_CL_TRY(clBuildProgram(*program, 1, &context->device->id, options, NULL, NULL));
    return SKG_OK;
}

static skg_status launch(skg_context *context, const skg_tracing *t, cl_program program, SKG_INT cell,
                         double kev, skg_buffer *buffer, float *out) {
    const SKG_INT photons = SAMPLE_PHOTONS;
    const float energy = (float)kev;
    const skg_work_size work = {1, {SAMPLE_PHOTONS / skg_kernel_lanes(context, SKG_PRECISION_SINGLE)}, {1}};
    const int64_t bytes = SAMPLE_PHOTONS * 4 * (int64_t)sizeof *out;
    SKG_TRY(skg_buffer_reserve(context, buffer, bytes, CL_MEM_READ_WRITE, "sample"));
    const skg_argument arguments[] = {
        {0, sizeof t->args, &t->args},
        {1, sizeof t->media.memory, &t->media.memory},
        {2, sizeof t->tree.memory, &t->tree.memory},
        {3, sizeof t->faces.memory, &t->faces.memory},
        {4, sizeof t->energies.memory, &t->energies.memory},
        {5, sizeof t->momenta.memory, &t->momenta.memory},
        {6, sizeof t->angles.memory, &t->angles.memory},
        {7, sizeof cell, &cell},
        {8, sizeof energy, &energy},
        {9, sizeof photons, &photons},
        {10, sizeof buffer->memory, &buffer->memory},
    };
    SKG_TRY(SKG_LAUNCH_ONCE(context, program, "sample", "sample", &work, arguments, NULL));
    SKG_CL_TRY(clEnqueueReadBuffer(context->device->queue, buffer->memory, CL_TRUE, 0, (size_t)bytes, out, 0,
                                   NULL, NULL));
    return SKG_OK;
}

skg_status sample_run(skg_context *context, const skg_plan *plan, const double at[3], double kev,
                      float *out) {
    const skg_tracing *t = &plan->scatterer.tracing;
    const SKG_INT *n = t->args.cells;
    const SKG_INT x = (SKG_INT)(at[0] * n[0]), y = (SKG_INT)(at[1] * n[1]), z = (SKG_INT)(at[2] * n[2]);
    cl_program program = NULL;
    skg_buffer buffer = {0};
    skg_status status = build(context, &program);
    if (status == SKG_OK) status = launch(context, t, program, (z * n[1] + y) * n[0] + x, kev, &buffer, out);
    skg_buffer_release(&buffer);
    if (program) clReleaseProgram(program);
    return status;
}
