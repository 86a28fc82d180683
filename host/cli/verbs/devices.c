/* The verb `devices`: the OpenCL devices, and what each can do. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/environment.h"
#include "common/probe.h"
#include "common/say.h"
#include "common/values.h"
#include "manual/manual.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *kind_of(const skg_device_info *device) {
    return device->gpu ? "gpu" : device->cpu ? "cpu" : "other";
}

/* refused: why this device cannot be used; "" if it can be, or was not asked for. */
static json_t *device_json(const skg_device_info *device, int chosen, const char *refused) {
    json_t *object = json_object();
    char number[32];
    snprintf(number, sizeof number, "%d:%d", device->platform, device->device);
    json_object_set_new(object, "device", cli_json_text(number));
    json_object_set_new(object, "name", cli_json_text(device->name));
    json_object_set_new(object, "platform", cli_json_text(device->platform_name));
    json_object_set_new(object, "known", json_boolean(device->known));
    json_object_set_new(object, "kind", cli_json_text(kind_of(device)));
    json_object_set_new(object, "chosen", json_boolean(chosen));
    json_object_set_new(object, "refused", refused[0] ? cli_json_text(refused) : json_null());
    json_object_set_new(object, "compute_units", json_integer(device->compute_units));
    json_object_set_new(object, "float_width", json_integer(device->float_width));
    json_object_set_new(object, "has_double", json_boolean(device->double_precision));
    json_object_set_new(object, "correct_division", json_boolean(device->correct_division));
    json_object_set_new(object, "memory_bytes", json_integer(device->memory));
    json_object_set_new(object, "max_allocation_bytes", json_integer(device->max_allocation));
    json_object_set_new(object, "local_memory_bytes", json_integer(device->local_memory));
    json_object_set_new(object, "version", cli_json_text(device->version));
    json_object_set_new(object, "driver", cli_json_text(device->driver));
    return object;
}

static void print_device(const skg_device_info *device, int chosen, const char *refused) {
    static const double gib = 1024.0 * 1024.0 * 1024.0;
    printf("%s %d:%d  %s (%s, %s)\n", chosen ? "*" : " ", device->platform, device->device, device->name,
           kind_of(device), device->platform_name);
    printf("       %d compute units, float vectors of %d; %.1f GiB, %.1f GiB in one buffer, %.0f KiB local\n",
           device->compute_units, device->float_width, (double)device->memory / gib,
           (double)device->max_allocation / gib, (double)device->local_memory / 1024);
    printf("       precision double: %s; division correctly rounded: %s\n",
           device->double_precision ? "yes" : "no (no fp64)",
           device->correct_division ? "yes (same bits as other such devices)"
                                    : "not promised by the driver (bits may differ from other devices)");
    printf("       %s, driver %s\n", device->version, device->driver);
    if (refused[0]) printf("       refused: %s\n", refused);
}

static void print_variables(void) {
    printf("\nenvironment:\n");
    for (const cli_item *variable = cli_environment; variable->name; variable++) {
        const char *value = getenv(variable->name);
        const int is_affinity = strcmp(variable->name, "POCL_AFFINITY") == 0;
        printf("  %-22s %s", variable->name, value ? value : "-");
        if (is_affinity) printf(" (%s)", cli_affinity_reason());
        putchar('\n');
    }
}

static json_t *variables_json(void) {
    json_t *object = json_object();
    for (const cli_item *variable = cli_environment; variable->name; variable++) {
        const char *value = getenv(variable->name);
        json_object_set_new(object, variable->name, value ? cli_json_text(value) : json_null());
    }
    return object;
}

/* Why a device is refused, on one line; "" if it is not. Its tests have been made when no device is left. */
static void ask_device(const skg_device_info *device, char *refused, size_t size) {
    char config[64];
    skg_context *context = NULL;
    snprintf(config, sizeof config, "device=%d:%d", device->platform, device->device);
    refused[0] = '\0';
    if (skg_context_create(config, &context) != SKG_OK) snprintf(refused, size, "%s", skg_last_error());
    refused[strcspn(refused, "\n")] = '\0'; /* of a build log */
    skg_context_release(&context);
}

/* Answers of the children about devices whose platform is not known. */
typedef struct {
    int64_t count;
    char (*refused)[CLI_REFUSED]; /* of each device; "" if it is known, or can be opened */
    int any;                      /* 1: one of them is refused */
} findings;

/* Lists the devices in a child, then opens each that is not known in a child. After that this process may ask all drivers. */
static int ask_children(const char *config, findings *all) {
    const int exit_status = cli_probe_all(config, &all->count);
    if (exit_status != CLI_DONE) return exit_status;
    all->refused = calloc((size_t)all->count + 1, sizeof *all->refused);
    if (!all->refused) return cli_error(CLI_DEVICE, "out of host memory for the list of devices");
    for (int64_t k = 0; k < all->count; k++) {
        skg_device_info info;
        char words[64];
        skg_device_info_init(&info);
        if (skg_device_get(k, &info) != SKG_OK || info.known) continue;
        snprintf(words, sizeof words, "device=%d:%d", info.platform, info.device);
        if (cli_probe_device(config, words, all->refused[k]) != CLI_DONE) all->any = 1;
    }
    return CLI_DONE;
}

/* best: the device that is chosen; NULL if all that were asked for are refused. */
static int list_devices(const findings *all, const skg_device_info *best, int json) {
    json_t *list = json ? json_array() : NULL;
    for (int64_t i = 0; i < all->count; i++) {
        skg_device_info device;
        char *refused = all->refused[i];
        skg_device_info_init(&device);
        skg_status status = skg_device_get(i, &device);
        if (status != SKG_OK) {
            json_decref(list);
            return cli_fail(status);
        }
        const int chosen = best && device.platform == best->platform && device.device == best->device;
        if (!best && device.known) ask_device(&device, refused, CLI_REFUSED);
        if (json)
            json_array_append_new(list, device_json(&device, chosen, refused));
        else
            print_device(&device, chosen, refused);
    }
    if (json) {
        json_t *object = json_object();
        json_object_set_new(object, "devices", list);
        json_object_set_new(object, "environment", variables_json());
        json_object_set_new(object, "affinity", cli_json_text(cli_affinity_reason()));
        return cli_json_print(object);
    }
    print_variables();
    return CLI_DONE;
}

int cli_devices(const cli_arguments *arguments) {
    skg_context *context = NULL;
    skg_device_info best;
    findings all = {0};
    const char *config = cli_value(arguments, "--device");
    const int json = cli_given(arguments, "--json");
    if (cli_given(arguments, "--warm")) return cli_warm(arguments);
    if (cli_given(arguments, "--test")) return cli_device_tests(config, json);
    cli_prepare_environment();
    int exit_status = ask_children(config, &all);
    if (exit_status != CLI_DONE) return exit_status;
    exit_status = cli_open_context(arguments, &context, &best);
    /* There are devices, but they are refused: the sentence has been printed, the list follows. */
    const int refused =
        exit_status == CLI_DEVICE && (all.any || cli_first_failure()->status != SKG_ERR_NO_DEVICE);
    if (exit_status == CLI_DONE || refused) {
        const int listed = list_devices(&all, refused ? NULL : &best, json);
        if (exit_status == CLI_DONE) exit_status = listed;
    }
    free(all.refused);
    skg_context_release(&context);
    return exit_status;
}
