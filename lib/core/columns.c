#include "core/columns.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Adds digits to the mantissa and moves the exponent of ten. Digits beyond the 19 that 64 bits hold only move the
 * exponent: they do not change the double that results. places: 1 behind the decimal point. */
static const char *read_digits(const char *c, uint64_t *mantissa, int *exponent, int *digits, int places) {
    for (; isdigit((unsigned char)*c); c++, ++*digits) {
        if (*mantissa < UINT64_MAX / 10 - 1) {
            *mantissa = 10 * *mantissa + (uint64_t)(*c - '0');
            *exponent -= places;
        } else if (!places) {
            ++*exponent;
        }
    }
    return c;
}

double skg_read_number(const char *text, const char **end) {
    const char *c = text;
    uint64_t mantissa = 0;
    int exponent = 0, digits = 0, negative = 0;
    *end = text;
    while (isspace((unsigned char)*c)) c++;
    if (*c == '-' || *c == '+') negative = *c++ == '-';
    c = read_digits(c, &mantissa, &exponent, &digits, 0);
    if (*c == '.') c = read_digits(c + 1, &mantissa, &exponent, &digits, 1);
    if (!digits) return 0;
    if (*c == 'e' || *c == 'E') {
        const char *e = c + 1;
        int down = 0, value = 0, given = 0;
        if (*e == '-' || *e == '+') down = *e++ == '-';
        for (; isdigit((unsigned char)*e); e++, given = 1)
            if (value < 100000) value = 10 * value + (*e - '0');
        if (given) {
            exponent += down ? -value : value;
            c = e;
        }
    }
    *end = c;
    /* The result is exact where mantissa and power of ten are exact doubles (below 2^53, up to 1e22); elsewhere it is
     * within one unit in the last place. */
    double value =
        mantissa < (UINT64_C(1) << 53) && exponent >= -22 && exponent <= 22
            ? exponent < 0 ? (double)mantissa / pow(10, -exponent) : (double)mantissa * pow(10, exponent)
            : (double)((long double)mantissa * powl(10, exponent));
    return negative ? -value : value;
}

typedef struct {
    const char *path, *word;
    int64_t count, capacity, line;
    double *first, *second;
} columns;

static skg_status add_row(columns *c, double a, double b) {
    if (c->count == c->capacity) {
        int64_t capacity = c->capacity ? 2 * c->capacity : 256;
        SKG_TRY(skg_realloc(capacity, sizeof(double), c->path, &c->first));
        SKG_TRY(skg_realloc(capacity, sizeof(double), c->path, &c->second));
        c->capacity = capacity;
    }
    c->first[c->count] = a;
    c->second[c->count++] = b;
    return SKG_OK;
}

static skg_status read_line(columns *c, const char *text) {
    while (isspace((unsigned char)*text)) text++;
    if (!*text || *text == '#' || *text == '%') return SKG_OK;
    if (c->word) {
        const char *found = strstr(text, c->word);
        if (!found) return SKG_OK;
        text = found + strlen(c->word);
    } else if (c->count == 0 && isalpha((unsigned char)*text)) {
        return SKG_OK; /* a heading */
    }
    const char *middle, *end;
    double a = skg_read_number(text, &middle);
    const char *second = middle;
    while (isspace((unsigned char)*second)) second++;
    if (*second == ',' || *second == ';') second++;
    double b = skg_read_number(second, &end);
    if (middle == text || end == second || second == middle)
        return skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 ": two numbers were expected", c->path, c->line);
    while (isspace((unsigned char)*end)) end++;
    if (*end && *end != '#')
        return skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 ": there are more than two numbers", c->path,
                        c->line);
    return add_row(c, a, b);
}

skg_status skg_read_columns(const char *path, const char *word, int64_t *count, double **first,
                            double **second) {
    columns c = {.path = path, .word = word};
    char text[512];
    skg_status status = SKG_OK;
    *count = 0;
    *first = *second = NULL;
    FILE *file = fopen(path, "r");
    if (!file) return skg_fail(SKG_ERR_FILE, "%s: cannot be read (%s)", path, strerror(errno));
    while (status == SKG_OK && fgets(text, sizeof text, file)) {
        c.line++;
        if (strlen(text) + 1 == sizeof text)
            status = skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 " is too long", path, c.line);
        else
            status = read_line(&c, text);
    }
    if (status == SKG_OK && ferror(file))
        status = skg_fail(SKG_ERR_FILE, "%s: cannot be read (%s)", path, strerror(errno));
    fclose(file);
    if (status == SKG_OK && c.count == 0)
        status = skg_fail(SKG_ERR_FORMAT, "%s: no line with two numbers%s%s", path, word ? " after " : "",
                          word ? word : "");
    if (status != SKG_OK) {
        skg_free(&c.first);
        skg_free(&c.second);
        return status;
    }
    *count = c.count;
    *first = c.first;
    *second = c.second;
    return SKG_OK;
}

/* Appends the numbers of a line. */
static skg_status read_numbers(const char *path, int64_t line, const char *text, int64_t *count,
                               double **numbers) {
    static const char separators[] = " \t\r\n,;";
    for (text += strspn(text, separators); *text && *text != '#' && *text != '%';
         text += strspn(text, separators)) {
        const char *end = NULL;
        const double number = skg_read_number(text, &end);
        if (end == text || (*end && !strchr(separators, *end)))
            return skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 ": \"%.20s\" is no number", path, line, text);
        SKG_TRY(skg_realloc(*count + 1, sizeof **numbers, path, numbers));
        (*numbers)[(*count)++] = number;
        text = end;
    }
    return SKG_OK;
}

skg_status skg_read_list(const char *path, int64_t *count, double **numbers) {
    char text[4096];
    skg_status status = SKG_OK;
    *count = 0;
    *numbers = NULL;
    FILE *file = fopen(path, "r");
    if (!file) return skg_fail(SKG_ERR_FILE, "%s: cannot be read (%s)", path, strerror(errno));
    for (int64_t line = 1; status == SKG_OK && fgets(text, sizeof text, file); line++) {
        if (strlen(text) + 1 == sizeof text)
            status = skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 " is too long", path, line);
        else
            status = read_numbers(path, line, text, count, numbers);
    }
    if (status == SKG_OK && ferror(file))
        status = skg_fail(SKG_ERR_FILE, "%s: cannot be read (%s)", path, strerror(errno));
    fclose(file);
    if (status == SKG_OK && *count == 0) status = skg_fail(SKG_ERR_FORMAT, "%s: holds no number", path);
    if (status != SKG_OK) skg_free(numbers);
    return status;
}
