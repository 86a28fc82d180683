/* Chemical formulas. */
#include "material/material.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The deepest nesting of brackets; formulas of chemistry have two or three. */
enum { DEEPEST = 8 };

/* Reads digits up to `end` with at most one decimal point; without digits the value is 1. strtod would accept signs,
 * exponents and the decimal comma of a locale. */
static double read_number(const char **text, const char *end, int *given) {
    const char *c = *text;
    double value = 0, place = 1;
    int digits = 0;
    for (; c < end && isdigit((unsigned char)*c); c++, digits++) value = 10 * value + (*c - '0');
    if (c < end && *c == '.')
        for (c++; c < end && isdigit((unsigned char)*c); c++, digits++) value += (place /= 10) * (*c - '0');
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
static skg_status close_bracket(const char *formula, const char **text, const char *end, amounts *stack,
                                int *depth, double *sum) {
    int given = 0;
    if (*depth == 0) return fail_at(formula, *text, "a bracket is closed that was not opened");
    ++*text;
    double times = read_number(text, end, &given);
    for (int z = 1; z <= SKG_LAST_ELEMENT; z++)
        stack[*depth - 1].amount[z] += times * stack[*depth].amount[z];
    --*depth;
    if (given) *sum += times;
    return SKG_OK;
}

/* Reads a formula without additions, up to `end`. The message names the whole of it. */
static skg_status read_amounts(const char *formula, const char *text, const char *end, amounts *stack,
                               double *sum) {
    int depth = 0, given = 0;
    stack[0] = (amounts){{0}};
    *sum = 0;
    while (text < end) {
        if (*text == '(') {
            if (++depth == DEEPEST) return fail_at(formula, text, "too many brackets");
            stack[depth] = (amounts){{0}};
            text++;
        } else if (*text == ')') {
            SKG_TRY(close_bracket(formula, &text, end, stack, &depth, sum));
        } else {
            int32_t z = read_symbol(&text);
            if (z == 0) return fail_at(formula, text, "no symbol of an element");
            double amount = read_number(&text, end, &given);
            if (!(amount > 0)) return fail_at(formula, text, "an amount is not above 0");
            stack[depth].amount[z] += amount;
            *sum += amount;
        }
    }
    if (depth > 0) return fail_at(formula, "", "a bracket is not closed");
    return SKG_OK;
}

/* The length in bytes of a dot that only joins compounds: the middle dot (U+00B7), the bullets (U+2219, U+2022), the dot operator
 * (U+22C5) and "*"; 0: none. */
static size_t joint_length(const char *text) {
    static const char *const dots[] = {"*", "\xC2\xB7", "\xE2\x88\x99", "\xE2\x80\xA2", "\xE2\x8B\x85"};
    for (size_t k = 0; k < sizeof dots / sizeof *dots; k++)
        if (strncmp(text, dots[k], strlen(dots[k])) == 0) return strlen(dots[k]);
    return 0;
}

/* Whether a number, or none, and then water stand here, up to the end or another dot. */
static int is_water(const char *text) {
    int given;
    if (isdigit((unsigned char)*text)) read_number(&text, text + strlen(text), &given);
    if (strncmp(text, "H2O", 3) != 0) return 0;
    return text[3] == '\0' || text[3] == '.' || joint_length(text + 3) > 0;
}

/* The digits before a dot. */
static const char *digits_before(const char *formula, const char *dot) {
    const char *first = dot;
    while (first > formula && isdigit((unsigned char)first[-1])) first--;
    return first;
}

/* A plain dot joins compounds if water follows ("CaSO4.2H2O") or no digit does ("CaO.SiO2"). It is a decimal point if no symbol follows
 * its digits ("O1.5"), or the digits before it are a 0 ("Fe0.95O"). Otherwise it may be either: 1 joins, 0 decimal, -1 unknown. */
static int joins(const char *formula, const char *dot) {
    const char *before = digits_before(formula, dot), *after = dot + 1 + strspn(dot + 1, "0123456789");
    if (is_water(dot + 1)) return 1;
    if (after == dot + 1) return isupper((unsigned char)*after) || *after == '(';
    if (!isupper((unsigned char)*after) && *after != '(') return 0;
    return dot - before == 1 && *before == '0' ? 0 : -1;
}

static int has_decimals_below_1(const char *formula) {
    for (const char *dot = strchr(formula, '.'); dot; dot = strchr(dot + 1, '.'))
        if (dot - digits_before(formula, dot) == 1 && dot[-1] == '0' && !is_water(dot + 1)) return 1;
    return 0;
}

/* The first dot that joins compounds, or the end. *length: of the dot. A formula with decimals below 1, such as Lu1.8Y0.2SiO5, has
 * decimals everywhere but before water. */
static skg_status find_joint(const char *formula, const char *text, int by_mass, const char **joint,
                             size_t *length) {
    const int has_decimals = has_decimals_below_1(formula);
    for (*length = 0; *text; text++) {
        *length = joint_length(text);
        if (*length > 0) break;
        if (*text != '.' || by_mass) continue;
        if (text[1] == '.') return fail_at(formula, text, "two dots");
        const int verdict = joins(formula, text);
        if (verdict < 0 && !has_decimals)
            return skg_fail(
                SKG_ERR_MATERIAL,
                "\"%s\" is ambiguous: the dot at \"%s\" is a decimal point or joins two compounds; write a "
                "middle dot or brackets, as in CaSO4(H2O)2, or multiply all amounts, as in Ca15Sr5O20",
                formula, text);
        if (verdict > 0) {
            *length = 1;
            break;
        }
        text += strspn(text + 1, "0123456789");
    }
    *joint = text;
    return SKG_OK;
}

/* Reads compounds that dots join, each with a number in front of it: hydrates. */
static skg_status read_joined(const char *formula, int by_mass, amounts *total, double *sum) {
    amounts stack[DEEPEST];
    const char *text = formula;
    *total = (amounts){{0}};
    *sum = 0;
    for (int part = 0;; part++) {
        const char *end = text;
        size_t length;
        double its = 0, times = 1;
        int given = 0;
        if (part > 0) times = read_number(&text, text + strlen(text), &given);
        SKG_TRY(find_joint(formula, text, by_mass, &end, &length));
        if (!(times > 0) || text >= end)
            return fail_at(formula, text, part ? "no compound behind a dot" : "no compound");
        SKG_TRY(read_amounts(formula, text, end, stack, &its));
        for (int z = 1; z <= SKG_LAST_ELEMENT; z++) total->amount[z] += times * stack[0].amount[z];
        *sum += times * its;
        if (length == 0) return SKG_OK;
        text = end + length;
    }
}

skg_status skg_read_formula(const char *formula, int by_mass, int64_t *count, skg_mass_fraction *parts,
                            double *sum) {
    amounts total;
    SKG_TRY(read_joined(formula, by_mass, &total, sum));
    double mass = 0;
    *count = 0;
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++) {
        double own = total.amount[z] * (by_mass ? 1 : skg_elements[z].weight);
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
