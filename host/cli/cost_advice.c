/* skiagraph cost: which setting to use. */
#include "cost.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void cost_find_frontier(cost_study *study) {
    for (int i = 0; i < study->count; i++) {
        cost_point *point = &study->points[i];
        point->on_frontier = point->reference == 0 && !isnan(point->max_open);
        for (int k = 0; k < study->count && point->on_frontier; k++) {
            const cost_point *other = &study->points[k];
            int no_worse =
                other->reference == 0 && other->min_ms <= point->min_ms && other->max_open <= point->max_open;
            int better = other->min_ms < point->min_ms || other->max_open < point->max_open;
            if (no_worse && better) point->on_frontier = 0;
        }
    }
}

/* The fastest (minimum: the one that other load disturbs least) of the rays' settings within a bar, or else
 * the one with the least error. */
static int choose_rays(const cost_study *study, double bar) {
    int fastest = -1, best = -1;
    for (int i = 0; i < study->count; i++) {
        const cost_point *point = &study->points[i];
        if (point->reference != 0 || isnan(point->max_open)) continue;
        if (best < 0 || point->max_open < study->points[best].max_open) best = i;
        if (!(point->max_open <= bar)) continue;
        if (fastest < 0 || point->min_ms < study->points[fastest].min_ms) fastest = i;
    }
    return fastest >= 0 ? fastest : best;
}

/* The one with the fewest passes within a bar, or else the one with the least error; -1: the dial is not
 * there. */
static int choose_sampling(const cost_study *study, int reference, double bar) {
    int best = -1;
    for (int i = 0; i < study->count; i++) { /* rising in passes */
        if (study->points[i].reference != reference) continue;
        if (study->points[i].rms_open <= bar) return i;
        if (best < 0 || study->points[i].rms_open < study->points[best].rms_open) best = i;
    }
    return best;
}

static int is_plain(const char *word) {
    return *word &&
           strspn(word, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./=:,+-@%") ==
               strlen(word);
}

/* A word as a shell reads it back. */
static void put_word(FILE *stream, const char *word) {
    fputc(' ', stream);
    if (is_plain(word)) {
        fputs(word, stream);
        return;
    }
    fputc('\'', stream);
    for (; *word; word++)
        if (*word == '\'')
            fputs("'\\''", stream);
        else
            fputc(*word, stream);
    fputc('\'', stream);
}

static void put_flag(FILE *stream, const cost_study *study, const cli_flag *flag) {
    const char *value;
    for (int i = 0; (value = cli_nth_value(study->arguments, flag, i)); i++) {
        fprintf(stream, " %s", flag->name);
        put_word(stream, value);
    }
}

/* The command line of `image` that a setting stands for; NULL: no memory. */
static char *command_of(const cost_study *study, const cost_setting *setting) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return NULL;
    fputs("skiagraph image", stream);
    put_word(stream, study->session.path);
    fputs(" -o image.mha", stream);
    put_flag(stream, study, &cli_flag_device);
    put_flag(stream, study, &cli_flag_strategy);
    put_flag(stream, study, &cli_flag_set);
    fprintf(stream, " --precision %s --tolerance %.3g", cli_precision_names[setting->precision],
            setting->tolerance);
    if (setting->bins > 0)
        fprintf(stream, " --set Source.Beam.MaxNumberOfEnergyBins=%lld", (long long)setting->bins);
    if (setting->samples > 0) fprintf(stream, " --set Source.Samples=%lld", (long long)setting->samples);
    if (setting->supersampling != study->own.supersampling)
        fprintf(stream, " --set Detector.Oversampling=%d", (int)setting->supersampling);
    if (fclose(stream) == 0) return text;
    free(text);
    return NULL;
}

static cost_setting whole_of(const cost_study *study, const cost_advice *advice) {
    cost_setting setting = study->points[advice->rays].setting;
    if (advice->samples >= 0) setting.samples = study->points[advice->samples].setting.samples;
    if (advice->supersampling >= 0)
        setting.supersampling = study->points[advice->supersampling].setting.supersampling;
    return setting;
}

/* Time of an image with the reference's rays and so many passes, ms. */
static double reference_ms(const cost_study *study, const cost_setting *setting) {
    double slowest = 0;
    for (int i = 0; i < study->count; i++)
        if (study->points[i].reference == 0) slowest = fmax(slowest, study->points[i].median_ms);
    return slowest / cost_passes(&study->own) * cost_passes(setting);
}

static int measure_whole(cost_study *study, cost_advice *advice) {
    double *image = calloc((size_t)study->pixels, sizeof *image);
    double *reference = calloc((size_t)study->pixels, sizeof *reference);
    cost_setting best = study->references[0].setting;
    best.samples = advice->whole.setting.samples;
    best.supersampling = advice->whole.setting.supersampling;
    int exit_status = CLI_DONE;
    if (!image || !reference) {
        exit_status = cli_error(CLI_DEVICE, "out of host memory for the image");
    } else {
        skg_status status = cost_image(study, &advice->whole.setting, image, &advice->whole);
        if (status >= SKG_OK) status = cost_image(study, &best, reference, NULL);
        exit_status =
            status < SKG_OK ? cli_fail(status) : cost_compare(study, image, reference, &advice->whole);
    }
    free(advice->whole.difference);
    advice->whole.difference = NULL;
    free(image);
    free(reference);
    return exit_status;
}

/* Rays, samples and supersampling together; more careful rays where the whole misses the tolerance. */
static int advise_whole(cost_study *study, cost_advice *advice) {
    double bar = advice->bar;
    for (int turn = 0; turn < 3; turn++, bar /= 4) {
        advice->rays = choose_rays(study, bar);
        advice->rays_met = study->points[advice->rays].max_open <= advice->bar;
        advice->whole = (cost_point){.dial = COST_SCENE, .setting = whole_of(study, advice)};
        const cost_setting *setting = &advice->whole.setting;
        advice->whole_state = COST_WHOLE_IS_RAYS;
        if (setting->samples == study->own.samples && setting->supersampling == study->own.supersampling)
            return CLI_DONE;
        advice->whole_state = COST_WHOLE_TOO_LONG;
        if (reference_ms(study, setting) > cost_patience_ms(study)) return CLI_DONE;
        advice->whole_state = COST_WHOLE_MEASURED;
        int exit_status = measure_whole(study, advice);
        if (exit_status != CLI_DONE || !advice->rays_met || advice->whole.max_open <= advice->bar)
            return exit_status;
    }
    advice->rays_met = 0;
    return CLI_DONE;
}

int cost_advise(cost_study *study) {
    cost_find_frontier(study);
    if (choose_rays(study, 0) < 0)
        return cli_error(CLI_DEVICE, "no setting could be measured; the scene as it stands takes too long");
    for (int i = 0; i < COST_TOLERANCES; i++) {
        cost_advice *advice = &study->advice[i];
        advice->tolerance = cost_tolerances[i];
        advice->bar = fmax(advice->tolerance, study->noise / 10);
        advice->samples = choose_sampling(study, 1, advice->bar);
        advice->supersampling = choose_sampling(study, 2, advice->bar);
        advice->sampling_met =
            (advice->samples < 0 || study->points[advice->samples].rms_open <= advice->bar) &&
            (advice->supersampling < 0 || study->points[advice->supersampling].rms_open <= advice->bar);
        int exit_status = advise_whole(study, advice);
        if (exit_status != CLI_DONE) return exit_status;
        advice->rays_command = command_of(study, &study->points[advice->rays].setting);
        advice->whole_command = command_of(study, &advice->whole.setting);
        if (!advice->rays_command || !advice->whole_command)
            return cli_error(CLI_DEVICE, "out of host memory");
    }
    return CLI_DONE;
}
