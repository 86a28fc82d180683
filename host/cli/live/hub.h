/* Between the thread that computes and the pages: what pages ask for goes in, frames and sentences go out. Every page has a
 * thread that sends to it, so that a slow one holds up nothing: it gets the newest frame when it has taken the one before,
 * and the frames between are dropped. */
#ifndef CLI_LIVE_HUB_H
#define CLI_LIVE_HUB_H

#include "live/wish.h"

enum { LIVE_PAGES_MAX = 8, LIVE_FORMATS = 3 };

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

/* What pages have asked for since the last time; of each kind the newest. */
typedef struct {
    int has_wish, has_probe, has_measure, has_register, has_reconstruct;
    live_wish wish; /* the caller frees it if has_wish */
    double probe[2];
    int64_t part;           /* to register; -1: what is under way ends */
    live_switches switches; /* of the slice to reconstruct */
    char takes[LIVE_FORMATS][8];
    int take_count;
} live_asked;

/* Waits for something asked, for at most `ms`; sees_looks: or for a look. Returns whether there is something but looks. */
int live_hub_wait(live_hub *hub, double ms, int sees_looks, live_asked *asked);

/* Takes the look that has waited longest, which the caller frees. page: for live_hub_picture. Returns whether there was one. */
int live_hub_look_take(live_hub *hub, live_look *look, int64_t *page);

/* Sends a picture to the page that has asked for it, if it is still there. Takes over the bytes. */
void live_hub_picture(live_hub *hub, int64_t page, unsigned char *bytes, size_t size);

/* Whether a newer wish waits. */
int live_hub_has_news(live_hub *hub);

/* Whether another slice is to be reconstructed, or none. */
int live_hub_has_other_slice(live_hub *hub);

/* Whether a page could take a frame now; without one, frames need not be made. */
int live_hub_is_thirsty(live_hub *hub);

/* s since something was last asked for, or a page began. */
double live_hub_idle(live_hub *hub);

/* The page as HTML. Takes over the text. */
void live_hub_page_set(live_hub *hub, char *html);

/* A radiograph, which each page that begins later is sent. Takes over the bytes. */
void live_hub_radiograph_set(live_hub *hub, unsigned char *bytes, size_t size);

/* What each new page is told first: the scene. */
void live_hub_greeting_set(live_hub *hub, const char *text);

/* Tells all pages something; text that waits behind too much other text is dropped. */
void live_hub_tell(live_hub *hub, const char *text);
void live_hub_tell_json(live_hub *hub, json_t *object); /* releases the object */

/* Tells all pages of a frame, and those that begin later; releases the object. */
void live_hub_shot_tell(live_hub *hub, json_t *object);

/* Shows all pages a frame. Takes over the bytes. */
void live_hub_show(live_hub *hub, int64_t number, unsigned char *bytes, size_t size);

/* Sends a file to the page that may change the scene. */
void live_hub_give(live_hub *hub, const void *bytes, size_t size);

#endif
