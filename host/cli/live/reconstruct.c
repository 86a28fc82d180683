/* Tells pages of a slice that is being reconstructed. */
#include "live/ask.h"

#include "common/encode.h"
#include "common/interrupt.h"
#include "common/progress.h"
#include "live/slice.h"

static const double TELL = 100; /* ms between two messages about projections */

typedef struct {
    live_hub *hub;
    double told_ms;
    void (*meanwhile)(void *user);
    void *user;
} teller;

static void tell(live_hub *hub, const char *key, json_t *inner) {
    json_t *object = json_object();
    json_object_set_new(object, key, inner);
    live_hub_tell_json(hub, object);
}

/* Between two projections. A newer wish, another slice and the end are not kept waiting. */
static int32_t hear(int64_t done, int64_t total, void *user) {
    teller *t = user;
    const double now = cli_now_ms();
    if (live_hub_has(t->hub, SKG_LIVE_ASKED_WISH) || live_hub_has(t->hub, SKG_LIVE_ASKED_RECONSTRUCT) ||
        cli_stop_asked())
        return 1;
    t->meanwhile(t->user);
    if (now - t->told_ms < TELL) return 0;
    t->told_ms = now;
    json_t *inner = json_object();
    json_object_set_new(inner, "done", json_integer(done));
    json_object_set_new(inner, "of", json_integer(total));
    tell(t->hub, "reconstructing", inner);
    return 0;
}

static json_t *figures(const live_slice *slice, const skg_live_asked *switches) {
    static const char *const axes[] = {"x", "y", "z"};
    json_t *object = json_object();
    json_object_set_new(object, "projections", json_integer(slice->projections));
    json_object_set_new(object, "columns", json_integer(slice->columns));
    json_object_set_new(object, "rows", json_integer(slice->rows));
    json_object_set_new(object, "voxel_mm", cli_json_number(slice->voxel_mm));
    json_object_set_new(object, "across", json_string(axes[slice->across]));
    json_object_set_new(object, "at_mm", cli_json_number(slice->at_mm));
    json_object_set_new(object, "mean_keV", cli_json_number(slice->mean_kev));
    json_object_set_new(object, "seconds", cli_json_number(slice->turn_s));
    json_object_set_new(object, "truncated", cli_json_number(slice->truncated));
    json_object_set_new(object, "spectrum", json_boolean(switches->spectrum));
    json_object_set_new(object, "noise", json_boolean(switches->noise));
    json_object_set_new(object, "scatter", json_boolean(switches->scatter));
    json_object_set_new(object, "motion", json_boolean(switches->motion));
    return object;
}

/* The slice, as a frame that begins with SKLS. */
static void give(live_hub *hub, const live_slice *slice) {
    skg_live_letter *letter = NULL;
    (void)skg_live_image_write("SKLS", LIVE_SLICE_SIZE, LIVE_SLICE_SIZE, SKG_QUANTITY_ENERGY, 0,
                               slice->values, &letter);
    live_hub_give(hub, letter);
}

void live_reconstruct(const live_base *base, const live_wish *wish, const skg_live_asked *switches,
                      live_hub *hub, void (*meanwhile)(void *user), void *user) {
    live_slice slice;
    char sentence[LIVE_SENTENCE] = "";
    teller t = {.hub = hub, .meanwhile = meanwhile, .user = user};
    skg_progress *progress = NULL;
    json_t *inner = NULL;
    if (skg_progress_create(hear, &t, &progress) != SKG_OK) return;
    (void)hear(0, 0, &t);
    if (live_slice_make(base, wish, switches, progress, &slice, sentence)) {
        give(hub, &slice);
        inner = figures(&slice, switches);
    } else {
        inner = json_object();
        json_object_set_new(
            inner, "error",
            cli_json_text(slice.is_cancelled ? "stopped: something newer was asked for" : sentence));
    }
    tell(hub, "reconstructed", inner);
    skg_progress_release(&progress);
}
