/* The server of live: its page, its socket, and who may come in. */
#define _GNU_SOURCE /* gethostname */
#include "live/server.h"

#include "common/say.h"

#include <civetweb.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

const int live_has_server = 1;

enum { FIN = 0x80, OPCODE = 0x0f, CODE_CONTINUATION = 0, CODE_TEXT = 1, CODE_BINARY = 2, CODE_CLOSE = 8 };
enum { MESSAGE_MAX = 1 << 20 };

/* Connections that say nothing take a thread each, for 2 s. */
enum { SILENT_MAX = 128 };

struct live_server {
    struct mg_context *context;
    live_hub *hub;
    char token[LIVE_TOKEN], nonce[LIVE_TOKEN];
    char names[5][256]; /* under which it may be asked, without ports; the rest is empty */
    int is_any;         /* it listens on every address of the machine */
    char address[256];  /* at which it listens */
};

static live_server *server_of(const struct mg_connection *connection) {
    return mg_get_user_data(mg_get_context(connection));
}

int live_server_send(void *connection, int binary, const void *bytes, size_t size) {
    return mg_websocket_write(connection, binary ? MG_WEBSOCKET_OPCODE_BINARY : MG_WEBSOCKET_OPCODE_TEXT,
                              bytes, size) > 0;
}

/* Compares tokens in a time that tells nothing of the right one. */
static int is_token(const live_server *server, const char *given) {
    unsigned difference = strlen(given) != strlen(server->token);
    for (size_t i = 0; i < LIVE_TOKEN - 1 && given[i]; i++)
        difference |= (unsigned)(given[i] ^ server->token[i]);
    return difference == 0;
}

static int has_token(const live_server *server, const struct mg_request_info *request) {
    char given[2 * LIVE_TOKEN];
    const char *query = request->query_string;
    return query && mg_get_var(query, strlen(query), "token", given, sizeof given) > 0 &&
           is_token(server, given);
}

/* A page of another site may not use the socket: browsers name the site, and the page's own is that of the address asked for. */
static int is_same_origin(const struct mg_connection *connection) {
    const char *origin = mg_get_header(connection, "Origin"), *host = mg_get_header(connection, "Host");
    if (!origin) return 1;
    const char *named = strstr(origin, "://");
    return host && named && strcasecmp(named + 3, host) == 0;
}

/* A site may let its name lead to this machine, and would then be the page's own: only the name that was bound is answered, by
 * any port, which a tunnel changes. Of the addresses of a machine that listens on all, each. */
static int is_own_host(const live_server *server, const struct mg_connection *connection) {
    const char *host = mg_get_header(connection, "Host");
    if (!host) return 0;
    const char *close = *host == '[' ? strchr(host, ']') : NULL;
    const size_t length = close ? (size_t)(close + 1 - host) : strcspn(host, ":");
    for (int k = 0; k < 5; k++)
        if (strlen(server->names[k]) == length && strncasecmp(server->names[k], host, length) == 0 && length)
            return 1;
    return server->is_any && (close || (length > 0 && strspn(host, "0123456789.") == length));
}

/* The names of a loopback address are all of them; a machine that listens on every address has its own, too. */
static void take_names(live_server *server, const char *address) {
    static const char *const own[] = {"localhost", "127.0.0.1", "[::1]"};
    const int is_own =
        strcasecmp(address, own[0]) == 0 || strcmp(address, own[2]) == 0 || strncmp(address, "127.", 4) == 0;
    server->is_any = strcmp(address, "0.0.0.0") == 0 || strcmp(address, "[::]") == 0;
    snprintf(server->names[0], sizeof server->names[0], "%s", address);
    for (int k = 0; (is_own || server->is_any) && k < 3; k++)
        snprintf(server->names[k + 1], sizeof server->names[0], "%s", own[k]);
    if (server->is_any && gethostname(server->names[4], sizeof server->names[4] - 1) != 0)
        server->names[4][0] = '\0';
}

static int answer(struct mg_connection *connection, int status, const char *reason, const char *sentence) {
    mg_printf(connection,
              "HTTP/1.1 %d %s\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: %zu\r\n"
              "Cache-Control: no-store\r\nConnection: close\r\n\r\n%s",
              status, reason, strlen(sentence), sentence);
    return status;
}

static int answer_page(live_server *server, struct mg_connection *connection) {
    char *page = live_hub_page_get(server->hub);
    if (!page) return answer(connection, 503, "Service Unavailable", "There is no page yet.\n");
    mg_printf(
        connection,
        "HTTP/1.1 200 OK\r\nContent-Type: text/html; charset=utf-8\r\nContent-Length: %zu\r\n"
        "Content-Security-Policy: default-src 'none'; script-src 'nonce-%s'; style-src 'unsafe-inline'; "
        "img-src data: blob:; connect-src 'self' ws://%s; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'self'\r\n"
        "X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCache-Control: no-store\r\n"
        "Connection: close\r\n\r\n",
        strlen(page), server->nonce,
        mg_get_header(connection, "Host") ? mg_get_header(connection, "Host") : "localhost");
    mg_write(connection, page, strlen(page));
    free(page);
    return 200;
}

/* Every request comes by here, that for the socket too. 0: the request goes on. */
static int begin_request(struct mg_connection *connection) {
    live_server *server = server_of(connection);
    const struct mg_request_info *request = mg_get_request_info(connection);
    if (!is_own_host(server, connection))
        return answer(connection, 421, "Misdirected Request",
                      "This server answers by the name that it was bound to (--bind) only.\n");
    if (!has_token(server, request))
        return answer(connection, 403, "Forbidden",
                      "The address needs the token that skiagraph live has printed.\n");
    if (!is_same_origin(connection))
        return answer(connection, 403, "Forbidden", "Pages of other sites may not use this server.\n");
    if (strcmp(request->request_method, "GET") != 0)
        return answer(connection, 405, "Method Not Allowed", "This server answers GET only.\n");
    if (strcmp(request->local_uri, "/") == 0) return answer_page(server, connection);
    if (strcmp(request->local_uri, "/socket") == 0 && mg_get_header(connection, "Upgrade"))
        return live_hub_is_full(server->hub) ? answer(connection, 503, "Service Unavailable",
                                                      "As many pages as there may be are open.\n")
                                             : 0;
    return answer(connection, 404, "Not Found", "There is one page here: /\n");
}

static int connect_page(const struct mg_connection *connection, void *user) {
    const live_server *server = user;
    /* the handshake has not been answered yet, and the connection stays this one */
    live_client *client = live_hub_join(server->hub, (void *)(uintptr_t)connection);
    mg_set_user_connection_data(connection, client);
    return client ? 0 : 1;
}

static void greet_page(struct mg_connection *connection, void *user) {
    live_client *client = mg_get_user_connection_data(connection);
    (void)user;
    if (client && !live_hub_greet(client))
        mg_websocket_write(connection, MG_WEBSOCKET_OPCODE_CONNECTION_CLOSE, "", 0);
}

static int hear_page(struct mg_connection *connection, int bits, char *text, size_t length, void *user) {
    live_client *client = mg_get_user_connection_data(connection);
    const int code = bits & OPCODE;
    (void)user;
    if (!client || code == CODE_CLOSE || length > MESSAGE_MAX) return 0;
    if (code != CODE_TEXT && code != CODE_BINARY && code != CODE_CONTINUATION) return 1; /* ping and pong */
    if (code == CODE_TEXT && bits & FIN)
        live_hub_hear(client, text, length);
    else
        live_hub_hear(client, "[]",
                      2); /* in pieces, or binary: refused as any other message that is no object */
    return 1;
}

static void lose_page(const struct mg_connection *connection, void *user) {
    live_client *client = mg_get_user_connection_data(connection);
    (void)user;
    mg_set_user_connection_data(connection, NULL);
    if (client) live_hub_leave(client);
}

/* Drops CivetWeb's log: its sentences concern single connections, and nobody waits for them. */
static int drop_sentence(const struct mg_connection *connection, const char *sentence) {
    (void)connection;
    (void)sentence;
    return 1;
}

int live_server_start(const live_server_options *options, live_hub *hub, live_server **server) {
    char listens[300], threads[16];
    static const char requests[] = "2000", silent[] = "3600000";
    snprintf(listens, sizeof listens, "%s:%d", options->address, options->port);
    snprintf(threads, sizeof threads, "%d", LIVE_PAGES_MAX + SILENT_MAX);
    const char *const words[] = {"listening_ports",
                                 listens,
                                 "num_threads",
                                 threads,
                                 "request_timeout_ms",
                                 requests,
                                 "websocket_timeout_ms",
                                 silent,
                                 "tcp_nodelay",
                                 "1",
                                 NULL};
    const struct mg_callbacks callbacks = {.begin_request = begin_request, .log_message = drop_sentence};
    live_server *made = *server = calloc(1, sizeof *made);
    if (!made) return cli_error(CLI_DEVICE, "out of host memory");
    made->hub = hub;
    snprintf(made->address, sizeof made->address, "%s", options->address);
    take_names(made, options->address);
    snprintf(made->token, sizeof made->token, "%s", options->token);
    snprintf(made->nonce, sizeof made->nonce, "%s", options->nonce);
    mg_init_library(0);
    made->context = mg_start(&callbacks, made, (const char **)(uintptr_t)words);
    if (!made->context) {
        mg_exit_library();
        free(made);
        *server = NULL;
        return cli_error(
            CLI_DEVICE,
            "live: cannot listen on %s; another process may have this port (--port 0 takes a free "
            "one), or the address is none of this machine's",
            listens);
    }
    mg_set_websocket_handler(made->context, "/socket", connect_page, greet_page, hear_page, lose_page, made);
    return CLI_DONE;
}

int live_server_port(const live_server *server) {
    struct mg_server_port port;
    return mg_get_server_ports(server->context, 1, &port) == 1 ? port.port : 0;
}

typedef struct {
    struct mg_context *context;
    atomic_int stopped;
} stopping;

static void *stop_context(void *user) {
    stopping *s = user;
    mg_stop(s->context);
    atomic_store(&s->stopped, 1);
    return NULL;
}

/* CivetWeb looks every two seconds whether it is to stop, or when somebody calls: so it is called until it has stopped. */
static void stop_at_once(live_server *server) {
    stopping s = {.context = server->context};
    char reason[128];
    const int port = live_server_port(server);
    pthread_t thread;
    atomic_init(&s.stopped, 0);
    if (pthread_create(&thread, NULL, stop_context, &s) != 0) {
        mg_stop(server->context);
        return;
    }
    while (!atomic_load(&s.stopped)) {
        struct mg_connection *call = mg_connect_client(server->address, port, 0, reason, sizeof reason);
        if (call) mg_close_connection(call);
        usleep(10000);
    }
    pthread_join(thread, NULL);
}

void live_server_stop(live_server **server) {
    if (!*server) return;
    stop_at_once(*server);
    mg_exit_library();
    free(*server);
    *server = NULL;
}
