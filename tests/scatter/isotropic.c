/* The histories of a plan's view with cross sections of our own: photons that scatter alike in all directions and keep their energy. */
#include "isotropic.h"

#include "frame/plans.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/* Thomson's cross section times this F^2 is the same for all angles. */
static void replace(skg_scatter_physics *p, double albedo, double per_mm) {
    for (int64_t e = 0; e < p->energies; e++)
        for (int k = 0; k < SKG_SCATTER_RANK; k++) {
            p->total[e][k] = k ? 0 : (float)per_mm;
            p->compton[e][k] = 0;
            p->rayleigh[e][k] = k ? 0 : (float)(albedo * per_mm);
            p->compton_shape[e][k] = k ? 0 : 1;
            p->rayleigh_shape[e][k] = k ? 0 : (float)(4 * PI);
        }
    for (int64_t m = 0; m < p->momenta; m++) {
        const double share = skg_scatter_momentum(p, m) / p->momentum_high, cosine = 1 - 2 * share * share;
        for (int k = 0; k < SKG_SCATTER_RANK; k++) {
            p->incoherent[m][k] = k ? 0 : 1;
            p->coherent[m][k] = k ? 0 : (float)(2 / (1 + cosine * cosine));
        }
    }
}

static skg_status run(skg_context *context, const skg_scatter_work *work, const skg_scatter_object *object,
                      int64_t histories, double orders[3], double *sigma) {
    skg_tracing t = {0};
    skg_scatter_tables tables;
    int64_t columns = 0, rows = 0, *sums = NULL;
    skg_status status = SKG_OK;
    skg_trace_places(work, &columns, &rows);
    const int64_t places = columns * rows;
    SKG_TRY_CLEANUP(skg_scatter_tables_make(work, object, &tables));
    SKG_TRY_CLEANUP(skg_trace_begin(context, work, object, &tables, columns, rows, &t));
    SKG_TRY_CLEANUP(skg_trace_until(context, &t, histories));
    SKG_TRY_CLEANUP(
        skg_alloc(SKG_SCATTER_BATCHES * SKG_SCATTER_PLANES * places, sizeof *sums, "sums", &sums));
    SKG_TRY_CLEANUP(skg_trace_read(context, &t, sums));
    double squares = 0, all = 0;
    for (int64_t b = 0; b < SKG_SCATTER_BATCHES; b++) {
        double batch = 0;
        for (int64_t i = 0; i < SKG_SCATTER_KINDS * places; i++) {
            const double share = (double)sums[b * SKG_SCATTER_PLANES * places + i] /
                                 ((double)t.args.scale * (double)histories * SKG_SCATTER_BATCHES);
            orders[i / places % 3] += share;
            batch += share;
        }
        all += batch, squares += batch * batch;
    }
    *sigma =
        sqrt((squares - all * all / SKG_SCATTER_BATCHES) * SKG_SCATTER_BATCHES / (SKG_SCATTER_BATCHES - 1.0));
cleanup:
    skg_scatter_tables_free(&tables);
    skg_trace_release(&t);
    skg_free(&sums);
    return status;
}

skg_status isotropic_run(skg_context *context, const skg_plan *plan, double albedo, double per_mm,
                         int64_t histories, double orders[3], double *sigma) {
    const skg_scatter_work work = {.recipe = plan->recipe, .view = &plan->recipe->view};
    skg_scatter_object object;
    for (int k = 0; k < 3; k++) orders[k] = 0;
    skg_status status = skg_scatter_object_make(&work, &object);
    if (status == SKG_OK) {
        replace(&object.physics, albedo, per_mm);
        status = run(context, &work, &object, histories, orders, sigma);
    }
    skg_scatter_object_free(&object);
    return status;
}
