/* The child process that tests a driver. */
#include "common/probe.h"

#include "common/say.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

/* Without a parent that listens there is nothing to do. */
static void say(const cli_probe_answer *answer) {
    if (send(STDIN_FILENO, answer, sizeof *answer, MSG_NOSIGNAL) != (ssize_t)sizeof *answer)
        _exit(CLI_CHECK_FAILED);
}

static int end(skg_status status) {
    cli_probe_answer answer = {.kind = CLI_PROBE_OPENED};
    if (status != SKG_OK) {
        answer.kind = CLI_PROBE_REFUSED;
        answer.status = status;
        snprintf(answer.sentence, sizeof answer.sentence, "%s", skg_last_error());
        answer.sentence[strcspn(answer.sentence, "\n")] = '\0'; /* the first line of a build log */
    }
    say(&answer);
    return CLI_DONE;
}

/* A driver that the words name is opened, so that its devices are in the list. */
static skg_status open_driver(const char *config) {
    int32_t untested = 0;
    return skg_device_untested(*config ? config : NULL, &untested);
}

static int list(const char *config) {
    int64_t count = 0;
    skg_status status = open_driver(config);
    if (status == SKG_OK) status = skg_device_count(&count);
    for (int64_t k = 0; k < count && status == SKG_OK; k++) {
        skg_device_info info;
        skg_device_info_init(&info);
        status = skg_device_get(k, &info);
    }
    return end(status);
}

static int open_device(const char *config, const char *words) {
    cli_probe_answer answer = {.kind = CLI_PROBE_FOUND};
    skg_context *context = NULL;
    skg_device_info_init(&answer.device);
    words = *words ? words : NULL;
    skg_status status = open_driver(config);
    if (status == SKG_OK) status = skg_device_find(words, &answer.device);
    if (status != SKG_OK) return end(status);
    say(&answer);
    status = skg_context_create(words, &context);
    skg_context_release(&context);
    return end(status);
}

static int test(const char *config, int64_t device, int64_t first) {
    int64_t count = 0;
    skg_status status = open_driver(config);
    if (status == SKG_OK) status = skg_device_test_count(&count);
    for (int64_t k = first; k < count && status == SKG_OK; k++) {
        cli_probe_answer answer = {.kind = CLI_PROBE_RESULT};
        skg_device_test_init(&answer.result);
        status = skg_device_test_run(device, k, &answer.result);
        if (status == SKG_OK) say(&answer);
    }
    return end(status);
}

int cli_probe_child(int count, char **words) {
    const struct rlimit none = {0, 0};
    prctl(PR_SET_PDEATHSIG, SIGKILL); /* it does not outlive its parent */
    setrlimit(RLIMIT_CORE, &none);
    if (count == 2 && strcmp(words[0], "list") == 0) return list(words[1]);
    if (count == 3 && strcmp(words[0], "open") == 0) return open_device(words[1], words[2]);
    if (count == 4 && strcmp(words[0], "test") == 0)
        return test(words[1], strtoll(words[2], NULL, 10), strtoll(words[3], NULL, 10));
    return CLI_USAGE;
}
