/* Letters to pages, and the JSON in them. */
#include "live/inside.h"

#include "core/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct skg_live_letter {
    skg_refs refs;
    int32_t is_text;
    int64_t count;
    unsigned char *bytes; /* [count], and a 0 behind them */
};

skg_status skg_live_bytes_letter(int64_t count, skg_live_letter **letter, unsigned char **bytes) {
    skg_live_letter *made = NULL;
    *letter = NULL;
    SKG_TRY(skg_alloc(1, sizeof *made, "letter", &made));
    skg_refs_init(&made->refs);
    made->count = count;
    const skg_status status = skg_alloc(count + 1, 1, "letter", &made->bytes);
    if (status != SKG_OK) skg_free(&made);
    if (status == SKG_OK) *letter = made, *bytes = made->bytes;
    return status;
}

skg_status skg_live_letter_create(int32_t is_text, const void *bytes, int64_t count,
                                  skg_live_letter **letter) {
    unsigned char *to = NULL;
    SKG_NEEDS(letter);
    *letter = NULL;
    SKG_NEEDS(bytes);
    if (count < 0) return skg_fail(SKG_ERR_ARGUMENT, "live: a letter has no less than 0 bytes");
    SKG_TRY(skg_live_bytes_letter(count, letter, &to));
    memcpy(to, bytes, (size_t)count);
    (*letter)->is_text = is_text != 0;
    return SKG_OK;
}

skg_status skg_live_letter_retain(skg_live_letter *letter) {
    SKG_NEEDS(letter);
    skg_ref(&letter->refs);
    return SKG_OK;
}

void skg_live_letter_release(skg_live_letter **letter) {
    if (!letter || !*letter) return;
    skg_live_letter *its = *letter;
    *letter = NULL;
    if (!skg_unref(&its->refs)) return;
    skg_free(&its->bytes);
    skg_free(&its);
}

skg_status skg_live_letter_get(const skg_live_letter *letter, int32_t *is_text, const uint8_t **bytes,
                               int64_t *count) {
    SKG_NEEDS(letter);
    if (is_text) *is_text = letter->is_text;
    if (bytes) *bytes = letter->bytes;
    if (count) *count = letter->count;
    return SKG_OK;
}

skg_status skg_live_text_letter(json_t *object, skg_live_letter **letter) {
    char *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(object);
    *letter = NULL;
    if (!text) return skg_fail(SKG_ERR_MEMORY, "out of host memory for a text of the page");
    const skg_status status = skg_live_letter_create(1, text, (int64_t)strlen(text), letter);
    free(text); /* of Jansson */
    return status;
}

json_t *skg_live_number(double number) {
    return isfinite(number) ? json_real(number) : json_null();
}

json_t *skg_live_numbers(const double *numbers, int64_t count) {
    json_t *list = json_array();
    for (int64_t i = 0; i < count; i++) json_array_append_new(list, skg_live_number(numbers[i]));
    return list;
}

json_t *skg_live_text(const char *text) {
    char *plain = NULL;
    json_t *value = text ? json_string(text) : json_null();
    if (value || skg_copy_text(text, &plain) != SKG_OK) return value ? value : json_null();
    for (char *c = plain; *c; c++)
        if ((unsigned char)*c >= 128) *c = '?';
    value = json_string(plain);
    skg_free(&plain);
    return value;
}

json_t *skg_live_parsed(const char *text) {
    json_t *value = text ? json_loads(text, JSON_DECODE_ANY, NULL) : NULL;
    return value ? value : json_null();
}
