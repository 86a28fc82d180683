/* Chemical formulas. */
#include "material/material.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The deepest nesting of brackets; formulas of chemistry have two or three. */
enum { DEEPEST = 8 };

/* Reads digits with at most one decimal point; without digits the value is 1. strtod would accept signs,
 * exponents and the decimal comma of a locale. */
static double read_number(const char **text, int *given) {
    const char *c = *text;
    double value = 0, place = 1;
    int digits = 0;
    for (; isdigit((unsigned char)*c); c++, digits++) value = 10 * value + (*c - '0');
    if (*c == '.')
        for (c++; isdigit((unsigned char)*c); c++, digits++) value += (place /= 10) * (*c - '0');
    *given = digits > 0;
    if (!digits) return 1;
    *text = c;
    return value;
}

/* Reads the symbol of an element: a capital letter and the small one that follows, if any. Returns 0 if there is no
 * such element. */
static int32_t read_symbol(const char **text) {
    char symbol[3] = {(*text)[0], 0, 0};
    if (!isupper((unsigned char)symbol[0])) return 0;
    size_t length = islower((unsigned char)(*text)[1]) ? 2 : 1;
    if (length == 2) symbol[1] = (*text)[1];
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++)
        if (strcmp(skg_elements[z].symbol, symbol) == 0) {
            *text += length;
            return z;
        }
    return 0;
}

typedef struct {
    double amount[SKG_LAST_ELEMENT + 1];
} amounts;

static skg_status fail_at(const char *formula, const char *at, const char *why) {
    return skg_fail(SKG_ERR_MATERIAL, "\"%s\" is no formula: %s at \"%s\"", formula, why, at);
}

/* Ends a bracket: its amounts times the number that follows are added to those of the level around it. */
static skg_status close_bracket(const char *formula, const char **text, amounts *stack, int *depth,
                                double *sum) {
    int given = 0;
    if (*depth == 0) return fail_at(formula, *text, "a bracket is closed that was not opened");
    ++*text;
    double times = read_number(text, &given);
    for (int z = 1; z <= SKG_LAST_ELEMENT; z++)
        stack[*depth - 1].amount[z] += times * stack[*depth].amount[z];
    --*depth;
    if (given) *sum += times;
    return SKG_OK;
}

static skg_status read_amounts(const char *formula, amounts *stack, double *sum) {
    const char *text = formula;
    int depth = 0, given = 0;
    stack[0] = (amounts){{0}};
    *sum = 0;
    while (*text) {
        if (*text == '(') {
            if (++depth == DEEPEST) return fail_at(formula, text, "too many brackets");
            stack[depth] = (amounts){{0}};
            text++;
        } else if (*text == ')') {
            SKG_TRY(close_bracket(formula, &text, stack, &depth, sum));
        } else {
            int32_t z = read_symbol(&text);
            if (z == 0) return fail_at(formula, text, "no symbol of an element");
            double amount = read_number(&text, &given);
            if (!(amount > 0)) return fail_at(formula, text, "an amount is not above 0");
            stack[depth].amount[z] += amount;
            *sum += amount;
        }
    }
    if (depth > 0) return fail_at(formula, "", "a bracket is not closed");
    return SKG_OK;
}

skg_status skg_read_formula(const char *formula, int by_mass, int64_t *count, skg_mass_fraction *parts,
                            double *sum) {
    amounts stack[DEEPEST];
    SKG_TRY(read_amounts(formula, stack, sum));
    double mass = 0;
    *count = 0;
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++) {
        double own = stack[0].amount[z] * (by_mass ? 1 : skg_elements[z].weight);
        if (!(own > 0)) continue;
        parts[*count] = (skg_mass_fraction){z, own};
        ++*count;
        mass += own;
    }
    if (*count == 0) return skg_fail(SKG_ERR_MATERIAL, "\"%s\" is no formula: it names no element", formula);
    if (!isfinite(mass)) return skg_fail(SKG_ERR_MATERIAL, "\"%s\" is no formula: too large", formula);
    for (int64_t i = 0; i < *count; i++) parts[i].fraction /= mass;
    return SKG_OK;
}
