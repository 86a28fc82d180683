/* Drivers of OpenCL in child processes. */
#define _GNU_SOURCE /* strsignal */
#include "common/probe.h"

#include "common/child.h"
#include "common/say.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { PATIENCE_MS = 30000, STEP_MS = 50 };

static int64_t now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

static int start(const char *const *words, cli_probe *probe) {
    int answers[2], output[2];
    *probe = (cli_probe){0};
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, answers) != 0) return errno;
    int reason = pipe2(output, O_CLOEXEC) == 0 ? 0 : errno;
    if (reason) {
        close(answers[0]), close(answers[1]);
        return reason;
    }
    fcntl(output[0], F_SETFL, O_NONBLOCK);
    reason = cli_process_start(words, answers[1], output[1], output[1], &probe->process);
    close(answers[1]), close(output[1]);
    probe->answers = answers[0];
    probe->output = output[0];
    if (reason) {
        close(answers[0]), close(output[0]);
        probe->process = 0;
    }
    return reason;
}

int cli_probe_test(const char *config, int64_t device, int64_t first, cli_probe *probe) {
    char numbers[2][32];
    snprintf(numbers[0], sizeof numbers[0], "%lld", (long long)device);
    snprintf(numbers[1], sizeof numbers[1], "%lld", (long long)first);
    return start((const char *const[]){"/proc/self/exe", CLI_PROBE_WORD, "test", config ? config : "",
                                       numbers[0], numbers[1], NULL},
                 probe);
}

/* Takes what the child has printed, and keeps the start of the last line that is not empty. A driver that prints without end does
 * not hold this process up. */
static int drain(cli_probe *probe) {
    char text[4096];
    size_t at = strlen(probe->line);
    ssize_t n = 0;
    for (int times = 0; times < 64 && (n = read(probe->output, text, sizeof text)) > 0; times++)
        for (ssize_t k = 0; k < n; k++) {
            const int blank = (unsigned char)text[k] <= ' ' || text[k] > '~';
            if (text[k] == '\n') probe->line_ended = 1;
            if (text[k] == '\n' || (blank && (at == 0 || probe->line_ended))) continue;
            if (probe->line_ended) at = 0, probe->line_ended = 0;
            if (at + 1 < sizeof probe->line) probe->line[at++] = blank ? ' ' : text[k];
            probe->line[at] = '\0';
        }
    return n != 0; /* 0: nobody can print any more */
}

static int has_exited(const cli_probe *probe) {
    siginfo_t ended = {0};
    return waitid(P_PID, (id_t)probe->process, &ended, WEXITED | WNOWAIT | WNOHANG) == 0 && ended.si_pid != 0;
}

/* Also ends what the driver has started. */
static int finish(cli_probe *probe) {
    kill(-probe->process, SIGKILL);
    const int status = cli_process_end(probe->process);
    drain(probe);
    close(probe->answers), close(probe->output);
    probe->process = 0;
    return status;
}

static void describe(cli_probe *probe, int hangs) {
    const int status = finish(probe);
    char how[64], line[CLI_PROBE_LINE + 8] = "";
    if (probe->line[0]) snprintf(line, sizeof line, " (\"%s\")", probe->line);
    if (hangs)
        snprintf(how, sizeof how, "gave no answer within %d s", PATIENCE_MS / 1000);
    else if (status < 0)
        snprintf(how, sizeof how, "ended the process by signal %d, %s", -status, strsignal(-status));
    else
        snprintf(how, sizeof how, "ended the process with exit status %d", status);
    probe->status = hangs ? -SIGKILL : status;
    snprintf(probe->ended, sizeof probe->ended, "the driver %s%s", how, line);
}

int cli_probe_next(cli_probe *probe, cli_probe_answer *answer) {
    const int64_t end = now_ms() + PATIENCE_MS;
    struct pollfd ends[2] = {{.fd = probe->answers, .events = POLLIN},
                             {.fd = probe->output, .events = POLLIN}};
    while (probe->process > 0) {
        const int exited = has_exited(probe); /* before the answers are read: none comes after it */
        if (poll(ends, 2, exited ? 0 : STEP_MS) < 0 && errno != EINTR) break;
        if (ends[1].revents && !drain(probe)) ends[1].fd = -1;
        const ssize_t n = recv(probe->answers, answer, sizeof *answer, MSG_DONTWAIT);
        if (n == (ssize_t)sizeof *answer) return 1;
        if (n == 0) ends[0].fd = -1;
        if (exited || now_ms() > end) describe(probe, !exited);
    }
    return 0;
}

void cli_probe_end(cli_probe *probe) {
    if (probe->process > 0) finish(probe);
}

int cli_probe_all(const char *config, int64_t *count) {
    cli_probe probe;
    cli_probe_answer answer;
    int32_t untested = 0;
    const int reason = start(
        (const char *const[]){"/proc/self/exe", CLI_PROBE_WORD, "list", config ? config : "", NULL}, &probe);
    if (reason)
        return cli_error(CLI_DEVICE, "no process can be started that lists all devices: %s",
                         strerror(reason));
    const int answered = cli_probe_next(&probe, &answer);
    cli_probe_end(&probe);
    if (!answered)
        return cli_error(
            CLI_DEVICE,
            "a process that listed all devices was lost: %s. OCL_ICD_VENDORS=FILE.icd restricts OpenCL to "
            "one driver",
            probe.ended);
    if (answer.kind == CLI_PROBE_REFUSED)
        return cli_error(cli_exit_status(answer.status), "%s", answer.sentence);
    skg_status status = skg_device_untested(config, &untested); /* opens the driver, as the child has done */
    if (status == SKG_OK) status = skg_device_count(count);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* Opens a device and waits for the end of the child: a driver may also fail when it is released. */
static int open_device(cli_probe *probe, cli_probe_answer *answer, skg_device_info *device) {
    int opened = 0;
    device->size = 0;
    while (cli_probe_next(probe, answer)) {
        if (answer->kind == CLI_PROBE_FOUND) *device = answer->device;
        if (answer->kind == CLI_PROBE_REFUSED) return 0;
        opened |= answer->kind == CLI_PROBE_OPENED;
    }
    return opened && probe->status == 0;
}

int cli_probe_device(const char *config, const char *words, char refused[CLI_REFUSED]) {
    cli_probe probe;
    cli_probe_answer answer = {0};
    skg_device_info device;
    skg_device_test verdict;
    char number[64];
    refused[0] = '\0';
    const int reason = start((const char *const[]){"/proc/self/exe", CLI_PROBE_WORD, "open",
                                                   config ? config : "", words ? words : "", NULL},
                             &probe);
    if (reason) {
        snprintf(refused, CLI_REFUSED, "no process can be started that tests the device: %s",
                 strerror(reason));
        return CLI_DEVICE;
    }
    if (open_device(&probe, &answer, &device)) return CLI_DONE;
    cli_probe_end(&probe);
    if (answer.kind == CLI_PROBE_REFUSED) {
        snprintf(refused, CLI_REFUSED, "%s", answer.sentence);
        return cli_exit_status(answer.status);
    }
    if (!device.size) {
        snprintf(refused, CLI_REFUSED, "a process that asked for %s was lost: %s",
                 words && *words ? words : "a device", probe.ended);
        return CLI_DEVICE;
    }
    skg_device_test_init(&verdict);
    verdict.verdict = SKG_TEST_FAILED;
    snprintf(verdict.reason, sizeof verdict.reason, "%s", probe.ended);
    snprintf(number, sizeof number, "device=%d:%d", device.platform, device.device);
    skg_device_test_keep(number, 0, &verdict); /* what cannot be kept is tested again */
    snprintf(refused, CLI_REFUSED, "%s (%s, driver %s) was tested in a process of its own: %s", device.name,
             device.platform_name, device.driver, probe.ended);
    return CLI_DEVICE;
}
