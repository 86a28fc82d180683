/* The server: one page and one WebSocket, for those who know the token. */
#ifndef CLI_LIVE_SERVER_H
#define CLI_LIVE_SERVER_H

#include "live/hub.h"

enum { LIVE_TOKEN = 33 };

/* Whether this build has a server. */
extern const int live_has_server;

typedef struct live_server live_server;

typedef struct {
    const char *address; /* that it listens on */
    int port;            /* 0: any that is free */
    const char *token;   /* without it every answer is 403 */
    const char *nonce;   /* of the page's own scripts; the browser runs no other */
} live_server_options;

/* Starts the server. Returns an exit status and prints the error. */
int live_server_start(const live_server_options *options, live_hub *hub, live_server **server);

/* The port that it listens on. */
int live_server_port(const live_server *server);

/* Ends all connections. */
void live_server_stop(live_server **server);

/* A live_send. */
int live_server_send(void *connection, int binary, const void *bytes, size_t size);

#endif
