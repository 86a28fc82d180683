/* A sentence in place of the server, where CivetWeb is missing. */
#include "live/server.h"

#include "common/say.h"

const int live_has_server = 0;

int live_server_start(const live_server_options *options, live_hub *hub, live_server **server) {
    (void)options;
    (void)hub;
    *server = NULL;
    return cli_error(CLI_DEVICE,
                     "live: skiagraph was built without CivetWeb, which serves the page; install it "
                     "(Debian: libcivetweb-dev) and build again");
}

int live_server_port(const live_server *server) {
    (void)server;
    return 0;
}

void live_server_stop(live_server **server) {
    *server = NULL;
}

int live_server_send(void *connection, int binary, const void *bytes, size_t size) {
    (void)connection;
    (void)binary;
    (void)bytes;
    (void)size;
    return 0;
}
