/* A scan from the flags to its finished file. */
#include "scan/steps.h"

#include "common/file.h"
#include "common/interrupt.h"
#include "common/progress.h"
#include "common/say.h"
#include "common/values.h"
#include "session/explain.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { PROJECTIONS_MAX = 10000000, SUBFRAMES_MAX = 1000, FIELDS_MAX = 1000, NOTE_LENGTH = 1000 };

/* Reads "3,7,12". */
static int read_only(const cli_arguments *arguments, cli_acquisition *a) {
    const char *value = cli_value(arguments, "--only"), *at = value;
    if (!value) return CLI_DONE;
    a->only = calloc(strlen(value) / 2 + 1, sizeof *a->only);
    if (!a->only) return cli_error(CLI_DEVICE, "out of host memory");
    while (at) {
        char *end = NULL;
        const long long number = strtoll(at, &end, 10);
        if (end == at || (*end && *end != ',') || number < 0)
            return cli_error(CLI_USAGE, "--only %s: \"%.*s\" is not the number of a projection", value,
                             (int)strcspn(at, ","), at);
        a->only[a->options.only_count++] = number;
        at = *end ? end + 1 : NULL;
    }
    a->options.only = a->only;
    return CLI_DONE;
}

int acquisition_read_flags(const cli_arguments *arguments, cli_acquisition *a) {
    int64_t to = -1;
    skg_scan_run_options_init(&a->options);
    a->flats = a->darks = 1;
    a->place = cli_value(arguments, "-o");
    if (!a->place)
        return cli_error(CLI_USAGE,
                         "scan: no output is named; add -o FILE (.h5, .nxs, .mha, .raw, .tif or a folder)");
    if (cli_given(arguments, "--grey16") && cli_given(arguments, "--quantity"))
        return cli_error(CLI_USAGE,
                         "--grey16 and --quantity exclude each other: grey values are made of energies");
    const skg_status status = skg_scan_file_path_check(a->place);
    if (status != SKG_OK) return cli_fail(status);
    int exit_status = cli_integer(arguments, "--from", 0, PROJECTIONS_MAX, &a->options.from);
    if (exit_status == CLI_DONE) exit_status = cli_integer(arguments, "--to", 0, PROJECTIONS_MAX, &to);
    if (exit_status == CLI_DONE)
        exit_status = cli_integer(arguments, "--subframes", 1, SUBFRAMES_MAX, &a->options.subframes);
    if (exit_status == CLI_DONE) exit_status = cli_integer(arguments, "--flats", 0, FIELDS_MAX, &a->flats);
    if (exit_status == CLI_DONE) exit_status = cli_integer(arguments, "--darks", 0, FIELDS_MAX, &a->darks);
    if (exit_status == CLI_DONE) exit_status = read_only(arguments, a);
    a->options.to = to + 1;
    if (exit_status == CLI_DONE) exit_status = shards_read_flag(arguments, a);
    if (exit_status == CLI_DONE) exit_status = phases_read_flag(arguments, a);
    if (exit_status == CLI_DONE) exit_status = packed_read_flags(arguments, a);
    if (exit_status == CLI_DONE) exit_status = pictures_read_flag(arguments, a);
    return exit_status;
}

/* A scan that is continued has the number of source samples with which it was begun. */
static int choose_samples(const cli_arguments *arguments, cli_acquisition *a) {
    skg_plan_options *options = &a->session.options;
    int64_t samples = 0;
    const skg_status status = skg_scan_file_samples_get(a->place, a->hash, &samples);
    if (status != SKG_OK) return cli_fail(status);
    const int exit_status = verify_check(arguments, a, samples);
    if (exit_status != CLI_DONE) return exit_status;
    if (samples == 0 || !options->spot || options->spot->samples > 0 || options->spot->grid > 0)
        return CLI_DONE;
    a->spot = *options->spot;
    a->spot.samples = samples / ((int64_t)options->supersampling * options->supersampling);
    options->spot = &a->spot;
    return CLI_DONE;
}

/* The first rank lays the output out and holds its lock; the others open it when it has. */
static int open_output(const cli_arguments *arguments, cli_acquisition *a) {
    skg_scan_file_options options = a->file_options; /* with its levels */
    skg_channel channel;
    skg_plan_report report;
    skg_channel_init(&channel);
    skg_plan_report_init(&report);
    int64_t channels = 0;
    skg_status status = skg_plan_channel_count(a->plan, &channels);
    if (status == SKG_OK && channels > 1)
        return cli_error(CLI_USAGE,
                         "a file of projections has one channel, and these have %" PRId64
                         "; give Counting one threshold for each scan",
                         channels);
    if (status == SKG_OK) status = skg_plan_channel_get(a->plan, 0, &channel);
    if (status == SKG_OK) status = skg_plan_report_get(a->plan, &report);
    options.type = grey_type(a);
    options.scan = a->record.known ? a->record.known : a->scan;
    options.hash = a->hash;
    options.name = a->is_grey ? "grey value" : channel.name;
    options.unit = a->is_grey ? "" : channel.unit;
    options.stem = a->stem;
    options.samples = report.samples;
    options.flats = a->flats;
    options.darks = a->darks;
    options.from = a->part_from;
    options.count = a->part_count;
    options.overwrite = cli_given(arguments, "--overwrite");
    options.helper = a->ranks.rank > 0;
    a->file_options = options;
    if (status == SKG_OK) status = skg_scan_file_open(a->place, &options, &a->file);
    if (status != SKG_OK) return cli_fail(status);
    const int is_joined = cli_given(arguments, "--join") && a->ranks.rank == 0;
    if (is_joined) {
        const int exit_status = shards_join(a, &options);
        if (exit_status != CLI_DONE) return exit_status;
    }
    status = skg_scan_file_done_count(a->file, &a->found);
    if (status != SKG_OK) return cli_fail(status);
    const int is_open =
        is_joined || a->found < a->projections || (a->fields_beside && !cli_given(arguments, "--verify"));
    return a->has_fields && a->ranks.rank == 0 && is_open ? fields_write(a) : CLI_DONE;
}

static int write_geometry(const cli_arguments *arguments, const cli_acquisition *a) {
    const char *path;
    char note[NOTE_LENGTH];
    int exit_status = fields_describe(a, note, sizeof note);
    for (int i = 0; exit_status == CLI_DONE && (path = cli_nth_value(arguments, "--geometry", i)); i++)
        exit_status = cli_check_file_kept(a->session.setup, path);
    if (exit_status != CLI_DONE) return exit_status;
    for (int i = 0; a->ranks.rank == 0 && (path = cli_nth_value(arguments, "--geometry", i)); i++) {
        if (scenario_is(path)) continue; /* once there is a plan */
        const skg_status status = skg_scan_geometry_save_noted(a->record.known ? a->record.known : a->scan,
                                                               path, *note ? note : NULL);
        if (status == SKG_ERR_UNSUPPORTED) return cli_fail(status), CLI_OUTPUT;
        if (status != SKG_OK) return cli_fail(status);
    }
    return CLI_DONE;
}

/* Whether the scan has the projections that were asked for: before anything is laid out for them. */
static int check_chosen(const cli_acquisition *a) {
    const skg_scan_run_options *o = &a->options;
    const int64_t last = a->projections - 1, to = o->to > 0 ? o->to - 1 : last;
    if (o->from > to || to > last)
        return cli_error(CLI_USAGE,
                         "projections from %" PRId64 " to %" PRId64
                         " are asked for; the scan has 0 to %" PRId64,
                         o->from, to, last);
    for (int64_t i = 0; i < o->only_count; i++)
        if (o->only[i] > last || (i > 0 && o->only[i] <= o->only[i - 1]))
            return cli_error(CLI_USAGE,
                             "--only: projection %" PRId64 "; the scan has 0 to %" PRId64
                             ", and the numbers rise",
                             o->only[i], last);
    return CLI_DONE;
}

/* Scene, scan, motion and plan: of every rank its own. */
static int prepare(const cli_arguments *arguments, cli_acquisition *a) {
    int32_t quantity = -1;
    int exit_status = cli_choice(arguments, "--quantity", &quantity);
    if (exit_status == CLI_DONE) exit_status = cli_open_session(arguments, 0, &a->session);
    if (exit_status != CLI_DONE) return exit_status;
    if (a->ranks.rank == 0) cli_note_no_noise(&a->session);
    if (quantity >= 0) a->session.options.quantity = quantity;
    if (a->session.options.scatter)
        a->options.batch = 1; /* each waits: so progress moves, and Ctrl-C is heard */
    a->options.type =
        a->session.options.precision == SKG_PRECISION_DOUBLE ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
    skg_status status = skg_setup_scan_get(a->session.setup, &a->scan);
    if (status == SKG_OK) status = skg_scan_projection_count(a->scan, &a->projections);
    if (status == SKG_OK && cli_given(arguments, "--breathing"))
        status = skg_motion_create(a->session.context, a->session.setup, &a->motion);
    a->options.motion = a->motion;
    if (status == SKG_OK)
        status =
            skg_scan_hash_get(a->session.setup, &a->session.options, &a->options, a->hash, sizeof a->hash);
    if (status != SKG_OK) return cli_fail(status);
    a->whole_projections = a->projections;
    exit_status = check_chosen(a);
    if (exit_status == CLI_DONE) exit_status = grey_decide(arguments, a);
    if (exit_status == CLI_DONE) exit_status = shards_choose_part(a);
    if (exit_status == CLI_DONE) exit_status = choose_samples(arguments, a);
    if (exit_status == CLI_DONE) exit_status = cli_make_plan(&a->session, &a->plan, &a->plan_ms);
    if (exit_status == CLI_DONE) exit_status = grey_prepare(arguments, a);
    if (exit_status == CLI_DONE) exit_status = write_geometry(arguments, a);
    return exit_status == CLI_DONE ? scenario_write(arguments, a) : exit_status;
}

int acquisition_open(const cli_arguments *arguments, cli_acquisition *a) {
    int exit_status = ranks_agree(&a->ranks, prepare(arguments, a));
    if (exit_status == CLI_DONE && a->ranks.rank == 0) exit_status = open_output(arguments, a);
    exit_status = ranks_agree(&a->ranks, exit_status);
    if (exit_status == CLI_DONE && a->ranks.rank > 0) exit_status = open_output(arguments, a);
    return ranks_agree(&a->ranks, exit_status);
}

static int run_alone(cli_acquisition *a) {
    skg_scan_run *run = NULL;
    const double begun_ms = cli_now_ms(); /* a run computes from its creation on */
    skg_status status = skg_scan_run_create(a->plan, a->scan, &a->options, &run);
    if (status == SKG_OK) status = write_batches(a, run, begun_ms);
    skg_scan_run_release(&run);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

int acquisition_run(const cli_arguments *arguments, cli_acquisition *a) {
    const int lag = lag_open(a);
    if (lag != CLI_DONE) return lag;
    if (a->ranks.rank == 0 && a->found > 0 && a->found < a->projections && !cli_is_quiet())
        cli_log(SKG_LOG_NOTE, "the output has projections of this scan already; it is continued", NULL);
    a->options.file = a->file;
    if (a->ranks.rank == 0) verify_note(a);
    if (a->ranks.count == 1) {
        cli_stop_gently();
        a->options.progress = cli_progress();
    }
    const int exit_status = a->ranks.count > 1 ? shared_run(arguments, a) : run_alone(a);
    if (a->ranks.rank == 0) grey_warn(a);
    if (exit_status != CLI_DONE || a->ranks.rank > 0 || a->is_stopped) return exit_status;
    const skg_status status = skg_scan_file_finish(a->file);
    if (status != SKG_OK) return cli_fail(status);
    const int packed = packed_write(arguments, a);
    if (packed != CLI_DONE) return packed;
    const int pictures = a->pictures ? pictures_write(a) : CLI_DONE;
    if (pictures != CLI_DONE) return pictures;
    if (a->phases > 0) return phases_write(a);
    return a->stem && cli_names_folder(a->place) ? metadata_write(a) : CLI_DONE;
}

void acquisition_close(cli_acquisition *a) {
    skg_scan_file_release(&a->file);
    skg_plan_release(&a->plan);
    skg_motion_release(&a->motion);
    cli_close_session(&a->session);
    free(a->only);
    free(a->shard_place);
    free(a->stem);
    free(a->grey);
    lag_close(a);
}
