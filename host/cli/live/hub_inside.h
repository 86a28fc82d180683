/* The members of the hub, for pages.c and post.c. */
#ifndef CLI_LIVE_HUB_INSIDE_H
#define CLI_LIVE_HUB_INSIDE_H

#include "live/hub.h"
#include "live/mail.h"

#include <pthread.h>

enum { UNTAKEN_MAX = 2 }; /* frames under way to a page: while it shows one, the next is sent */

/* A frame and its number. */
typedef struct {
    skg_live_letter *letter;
    int64_t number;
} live_framed;

struct live_client {
    live_hub *hub;
    void *connection;
    pthread_t sender;
    int sends, leaves; /* leaves: the sender ends */
    int is_busy;       /* the sender sends */
    int64_t order;     /* the page that was greeted first may change the scene */
    int64_t sent[UNTAKEN_MAX];
    int untaken;
    live_framed frame;
    skg_live_letter *picture;
    int64_t look_order; /* of its look among those of all pages */
    skg_live_message *look;
    live_mail mail;
};

struct live_hub {
    pthread_mutex_t lock;
    pthread_cond_t asked, sent; /* a page asked for something; something is to be sent */
    live_send send;
    live_client *clients[LIVE_PAGES_MAX];
    int64_t greeted, looks;
    live_asked waiting;
    double active_ms;
    char *page;
    live_framed last; /* for pages that begin, as are: */
    skg_live_letter *greeting, *shot,
        *radiograph; /* texts of scene and last frame; the radiograph, if there is one */
};

/* Under the lock: the page that may change the scene; NULL: there is no page. */
live_client *live_hub_owner(const live_hub *hub);

/* Under the lock: whether a frame waits that the page has room for. */
int live_client_can_take(const live_client *client);

#endif
