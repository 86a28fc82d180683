/* Reads tables of numbers, a row a line. */
#include "core/files.h"

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

enum { COLUMNS_MAX = 8 };

typedef struct {
    const char *path, *word;
    int64_t least, most; /* numbers of a row */
    int64_t width;       /* of the first row; 0: there is none yet */
    int64_t count, capacity, line;
    double *columns[COLUMNS_MAX];
} reading;

static skg_status add_row(reading *r, int64_t width, const double *numbers) {
    if (r->count == r->capacity) {
        int64_t capacity = r->capacity ? 2 * r->capacity : 256;
        for (int64_t k = 0; k < width; k++)
            SKG_TRY(skg_realloc(capacity, sizeof(double), r->path, &r->columns[k]));
        r->capacity = capacity;
    }
    for (int64_t k = 0; k < width; k++) r->columns[k][r->count] = numbers[k];
    r->count++;
    return SKG_OK;
}

/* Reads up to `most` numbers with blanks, a comma or a semicolon between them. *end points behind the last. */
static int64_t read_numbers(const char *text, int64_t most, double *numbers, const char **end) {
    int64_t width = 0;
    for (*end = text; width < most; width++) {
        const char *start = *end, *behind;
        if (width > 0) {
            while (isspace((unsigned char)*start)) start++;
            if (*start == ',' || *start == ';') start++;
        }
        numbers[width] = skg_read_number(start, &behind);
        if (behind == start || (width > 0 && start == *end)) break;
        *end = behind;
    }
    while (isspace((unsigned char)**end)) ++*end;
    return width;
}

static skg_status check_width(const reading *r, int64_t width, const char *rest) {
    static const char *const words[] = {"no", "one", "two", "three", "four", "five", "six", "seven", "eight"};
    const int more = *rest && *rest != '#';
    if (width < r->least)
        return skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 ": %s numbers were expected", r->path, r->line,
                        words[r->least]);
    if (more)
        return skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 ": there are more than %s numbers", r->path,
                        r->line, words[width]);
    if (r->width && width != r->width)
        return skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 ": there are %s numbers, but %s in the first row",
                        r->path, r->line, words[width], words[r->width]);
    return SKG_OK;
}

static skg_status read_line(reading *r, const char *text) {
    double numbers[COLUMNS_MAX];
    const char *rest;
    while (isspace((unsigned char)*text)) text++;
    if (!*text || *text == '#' || *text == '%') return SKG_OK;
    if (r->word) {
        const char *found = strstr(text, r->word);
        if (!found) return SKG_OK;
        text = found + strlen(r->word);
    } else if (r->count == 0 && isalpha((unsigned char)*text)) {
        return SKG_OK; /* a heading */
    }
    const int64_t width = read_numbers(text, r->most, numbers, &rest);
    SKG_TRY(check_width(r, width, rest));
    r->width = width;
    return add_row(r, width, numbers);
}

static skg_status read_file(reading *r) {
    char text[512];
    skg_status status = SKG_OK;
    FILE *file = NULL;
    SKG_TRY(skg_text_open(r->path, &file));
    while (status == SKG_OK && fgets(text, sizeof text, file)) {
        r->line++;
        if (strlen(text) + 1 == sizeof text)
            status = skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 " is too long", r->path, r->line);
        else
            status = read_line(r, text);
    }
    if (status == SKG_OK && ferror(file))
        status = skg_fail(SKG_ERR_FILE, "%s: cannot be read (%s)", r->path, strerror(errno));
    fclose(file);
    if (status == SKG_OK && r->count == 0)
        status = skg_fail(SKG_ERR_FORMAT, "%s: no line with two numbers%s%s", r->path,
                          r->word ? " after " : "", r->word ? r->word : "");
    for (int k = 0; k < COLUMNS_MAX && status != SKG_OK; k++) skg_free(&r->columns[k]);
    return status;
}

skg_status skg_read_columns(const char *path, const char *word, int64_t *count, double **first,
                            double **second) {
    reading r = {.path = path, .word = word, .least = 2, .most = 2};
    *count = 0;
    *first = *second = NULL;
    SKG_TRY(read_file(&r));
    *count = r.count;
    *first = r.columns[0];
    *second = r.columns[1];
    return SKG_OK;
}

skg_status skg_read_columns_of(const char *path, int64_t least, int64_t most, int64_t *count, int64_t *width,
                               double **columns) {
    reading r = {.path = path, .least = least, .most = most};
    *count = *width = 0;
    for (int64_t k = 0; k < most; k++) columns[k] = NULL;
    SKG_TRY(read_file(&r));
    *count = r.count;
    *width = r.width;
    for (int64_t k = 0; k < most; k++) columns[k] = r.columns[k];
    return SKG_OK;
}

/* Appends the numbers of a line. */
static skg_status read_listed(const char *path, int64_t line, const char *text, int64_t *count,
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
    FILE *file = NULL;
    SKG_TRY(skg_text_open(path, &file));
    for (int64_t line = 1; status == SKG_OK && fgets(text, sizeof text, file); line++) {
        if (strlen(text) + 1 == sizeof text)
            status = skg_fail(SKG_ERR_FORMAT, "%s: line %" PRId64 " is too long", path, line);
        else
            status = read_listed(path, line, text, count, numbers);
    }
    if (status == SKG_OK && ferror(file))
        status = skg_fail(SKG_ERR_FILE, "%s: cannot be read (%s)", path, strerror(errno));
    fclose(file);
    if (status == SKG_OK && *count == 0) status = skg_fail(SKG_ERR_FORMAT, "%s: holds no number", path);
    if (status != SKG_OK) skg_free(numbers);
    return status;
}
