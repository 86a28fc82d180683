/* The table of dials: name, place in a setting, reference, sentences; their values and better ones are those of settings.c. And the one
 * query: the cheapest with an error of at most a bar. */
#ifndef CLI_COST_DIAL_H
#define CLI_COST_DIAL_H

#include "cost/study.h"

#include <jansson.h>
#include <stdio.h>

enum { COST_IS_INT32, COST_IS_INT64, COST_IS_REAL };

typedef struct {
    const char *name, *key; /* of points; of a setting in JSON */
    int reference;          /* COST_OF_...: that its points are compared with */
    size_t at;              /* of its value in a setting */
    int kind;               /* COST_IS_... of that value */
    double none;            /* the value that stands for the scene's own */
    /* The value in words where it is one, or another number than the setting's. NULL: the setting's number. */
    const char *(*word)(const cost_study *study, const cost_setting *setting);
    double (*number)(const cost_study *study, const cost_setting *setting);
    /* Formats of printf: by itself, among others, and in a command; flag NULL: command.c. */
    const char *sentence, *listed, *flag;
    const char *column; /* of CSV; NULL: key */
} cost_dial;

extern const cost_dial cost_dials[COST_DIALS];

/* Copies a dial's value from one setting to another. */
void cost_take(int dial, const cost_setting *from, cost_setting *to);

/* Whether the setting has a value of its own. */
int cost_has_value(int dial, const cost_setting *setting);

/* A number of a kind at an address; for JSON; and as a cell of CSV with its comma, which is empty for NaN: not measured. */
double cost_read(int kind, const void *at);
json_t *cost_number_json(int kind, double value);
void cost_put_number(FILE *stream, int kind, double value);

/* The setting's value for JSON, and as a cell of CSV with its comma. */
json_t *cost_value_json(const cost_study *study, const cost_setting *setting, int dial);
void cost_put_value(FILE *stream, const cost_study *study, const cost_setting *setting, int dial);

/* Appends the value in one of the row's sentences. */
void cost_append_value(const cost_study *study, const cost_setting *setting, int dial, const char *format,
                       char *text, size_t size);

/* Something that was measured. error: NaN: it does not count */
typedef struct {
    double error, price;
} cost_offer;
typedef cost_offer (*cost_look)(const cost_study *study, int index, const void *user);

/* The cheapest of `count` with an error of at most `most`; -1: none. best: the one with the least error; may be NULL. The first of
 * several. */
int cost_cheapest(const cost_study *study, int count, cost_look look, const void *user, double most,
                  int *best);

/* Whether no other one is both cheaper and nearer. */
int cost_is_on_frontier(const cost_study *study, int count, cost_look look, const void *user, int index);

/* Price of an image of a point, ms on an idle machine. */
double cost_price_of(const cost_study *study, const cost_point *point);

#endif
