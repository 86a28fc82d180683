/* Between the thread that computes and the pages: what pages ask for goes in, letters go out. Every page has a thread that sends to it,
 * so that a slow one holds up nothing: it gets the newest frame when it has taken the one before, and the frames between are dropped. */
#ifndef CLI_LIVE_HUB_H
#define CLI_LIVE_HUB_H

#include "live/wish.h"

enum { LIVE_PAGES_MAX = 8, LIVE_FORMATS = 3, LIVE_KINDS = SKG_LIVE_ASKED_RECONSTRUCT + 1 };

typedef struct live_hub live_hub;
typedef struct live_client live_client;

/* Sends to a page. binary: 0: a text. Returns 0 if the page is gone. */
typedef int (*live_send)(void *connection, int binary, const void *bytes, size_t size);

/* NULL without memory. */
live_hub *live_hub_create(live_send send);
void live_hub_free(live_hub *hub);

/* For the server's threads. */

/* Whether there are as many pages as there may be. */
int live_hub_is_full(live_hub *hub);

/* A page begins. NULL: there are LIVE_PAGES_MAX, or no memory. */
live_client *live_hub_join(live_hub *hub, void *connection);

/* From now on the page is sent to. Returns 0 if that cannot be. */
int live_hub_greet(live_client *client);
void live_hub_hear(live_client *client, const char *text, size_t length);
void live_hub_leave(live_client *client);

/* Copies out the page as HTML, which the caller frees; NULL without memory. */
char *live_hub_page_get(live_hub *hub);

/* For the thread that computes. */

/* Messages from pages since the last time. newest: by enum skg_live_asked_kind, but acks, takes and looks; NULL: none */
typedef struct {
    skg_live_message *newest[LIVE_KINDS];
    skg_live_message *takes[LIVE_FORMATS];
    int take_count;
} live_asked;

/* Releases what is left of it. */
void live_asked_free(live_asked *asked);

/* Waits for something asked, for at most `ms`; sees_looks: or for a look. Returns whether there is something but looks. asked: the
 * caller frees it */
int live_hub_wait(live_hub *hub, double ms, int sees_looks, live_asked *asked);

/* Takes the look that has waited longest, which the caller releases; NULL: there is none. page: for live_hub_picture */
skg_live_message *live_hub_look_take(live_hub *hub, int64_t *page);

/* Whether a message of this kind waits. */
int live_hub_has(live_hub *hub, int kind);

/* Whether a page could take a frame now; without one, frames need not be made. */
int live_hub_is_thirsty(live_hub *hub);

/* s since something was last asked for, or a page began. */
double live_hub_idle(live_hub *hub);

/* The page as HTML. Takes over the text. */
void live_hub_page_set(live_hub *hub, char *html);

/* The next functions take over their letter or object. A letter that is NULL, for want of memory, does nothing. */

/* Sends a picture to the page that has asked for it, if it is still there. */
void live_hub_picture(live_hub *hub, int64_t page, skg_live_letter *letter);

/* A radiograph, which each page that begins later is sent. */
void live_hub_radiograph_set(live_hub *hub, skg_live_letter *letter);

/* Sets the scene, which each new page is told first. is_new: the pages that are there, too. */
void live_hub_scene_tell(live_hub *hub, skg_live_letter *letter, int is_new);

/* Tells all pages something; text that waits behind too much other text is dropped. */
void live_hub_tell(live_hub *hub, skg_live_letter *letter);
void live_hub_tell_json(live_hub *hub, json_t *object);

/* Tells all pages that something is refused. */
void live_hub_refuse(live_hub *hub, const char *sentence);

/* Tells all pages of a frame, and those that begin later. */
void live_hub_shot_tell(live_hub *hub, skg_live_letter *letter);

/* Shows all pages a frame. */
void live_hub_show(live_hub *hub, int64_t number, skg_live_letter *letter);

/* Sends a file to the page that may change the scene. */
void live_hub_give(live_hub *hub, skg_live_letter *letter);

#endif
