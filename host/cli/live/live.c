/* The verb live. */
#define _GNU_SOURCE /* gethostname */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/interrupt.h"
#include "common/say.h"
#include "common/values.h"
#include "live/browser.h"
#include "live/loop.h"
#include "live/server.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <unistd.h>

static const char own_address[] = "127.0.0.1";

/* 128 bits that nobody can guess, in hexadecimal. */
static int make_token(char token[LIVE_TOKEN]) {
    unsigned char bytes[(LIVE_TOKEN - 1) / 2];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return cli_error(CLI_DEVICE, "live: the system has no random numbers for the token: %s",
                         strerror(errno));
    for (size_t i = 0; i < sizeof bytes; i++) snprintf(token + 2 * i, 3, "%02x", bytes[i]);
    return CLI_DONE;
}

/* The name under which other machines know this one; that it was bound to, where it is one of many. */
static void name_host(const char *address, char *host, size_t size) {
    const int is_any = strcmp(address, "0.0.0.0") == 0 || strcmp(address, "[::]") == 0;
    snprintf(host, size, "%s", address);
    if (is_any && gethostname(host, size) != 0) snprintf(host, size, "%s", address);
    host[size - 1] = '\0';
}

/* Names of the machine itself, which others do not reach. */
static int is_own(const char *address) {
    return strncmp(address, "127.", 4) == 0 || strcmp(address, "localhost") == 0 ||
           strcmp(address, "[::1]") == 0;
}

/* The first line on standard output is the address, for programs that read it. */
static int announce(const cli_arguments *arguments, const char *address, int port, const char *token,
                    char *file) {
    char host[256], url[400];
    int exit_status = CLI_DONE;
    name_host(address, host, sizeof host);
    snprintf(url, sizeof url, "http://%s:%d/?token=%s", host, port, token);
    if (cli_given(arguments, "--json")) {
        json_t *object = json_object();
        json_object_set_new(object, "url", cli_json_text(url));
        json_object_set_new(object, "port", json_integer(port));
        json_object_set_new(object, "token", cli_json_text(token));
        exit_status = cli_json_print(object);
    } else {
        printf("%s\n", url);
    }
    fflush(stdout);
    if (!is_own(address))
        cli_warn(
            "live: --bind %s: whoever has this address can see and change the scene, from other machines too, "
            "and nothing that is sent is encrypted; ssh -L %d:localhost:%d does without --bind",
            address, port, port);
    cli_note("live: open the address in a browser; Ctrl-C ends");
    if (exit_status == CLI_DONE && !cli_given(arguments, "--no-open")) live_browser_open(url, file);
    return exit_status;
}

typedef struct {
    const char *address;
    int64_t port;
    double idle; /* s; 0: without end */
} flags;

static int read_flags(const cli_arguments *arguments, flags *given) {
    const char *address = cli_value(arguments, "--bind");
    *given = (flags){.address = address ? address : own_address};
    int exit_status = cli_integer(arguments, "--port", 0, 65535, &given->port);
    if (exit_status == CLI_DONE) exit_status = cli_number(arguments, "--idle", 0.1, 1e7, &given->idle);
    if (exit_status == CLI_DONE && address &&
        (!*address || strlen(address) > 200 || address[strcspn(address, ", /;@?#\"\\")]))
        return cli_error(CLI_USAGE, "--bind %s is no address such as 0.0.0.0", address);
    if (exit_status == CLI_DONE && strcmp(arguments->operands[0], "-") == 0)
        return cli_error(
            CLI_USAGE,
            "live: a scene from standard input cannot be read again when it changes; give its file");
    return exit_status;
}

/* Serves the scene until it ends. */
static int serve(const cli_arguments *arguments, const flags *given, live_loop *loop) {
    char token[LIVE_TOKEN], nonce[LIVE_TOKEN], file[LIVE_BROWSER_PATH] = "";
    live_server *server = NULL;
    const live_server_options options = {
        .address = given->address, .port = (int)given->port, .token = token, .nonce = nonce};
    int exit_status = make_token(token);
    if (exit_status == CLI_DONE) exit_status = make_token(nonce);
    if (exit_status == CLI_DONE) exit_status = live_loop_begin(loop, nonce);
    cli_stop_gently(); /* from now on a signal is the end that was meant */
    if (exit_status == CLI_DONE) exit_status = live_server_start(&options, loop->hub, &server);
    if (exit_status == CLI_DONE)
        exit_status = announce(arguments, given->address, live_server_port(server), token, file);
    if (exit_status == CLI_DONE) live_loop_run(loop, given->idle);
    live_server_stop(&server);
    live_browser_end(file);
    return exit_status;
}

int cli_live(const cli_arguments *arguments) {
    live_loop loop = {.base = {.arguments = arguments, .path = arguments->operands[0], .precision = -1}};
    flags given;
    skg_device_info device;
    live_server *none = NULL;
    int exit_status = read_flags(arguments, &given);
    if (exit_status == CLI_DONE && !live_has_server) return live_server_start(NULL, NULL, &none);
    if (exit_status == CLI_DONE) exit_status = cli_choice(arguments, "--precision", &loop.base.precision);
    if (exit_status == CLI_DONE) exit_status = cli_open_context(arguments, &loop.base.context, &device);
    if (exit_status == CLI_DONE) {
        loop.hub = live_hub_create(live_server_send);
        exit_status =
            loop.hub ? serve(arguments, &given, &loop) : cli_error(CLI_DEVICE, "out of host memory");
    }
    if (loop.base.context) (void)skg_context_log_set(loop.base.context, cli_log, NULL);
    live_loop_end(&loop);
    skg_context_release(&loop.base.context);
    return exit_status;
}
