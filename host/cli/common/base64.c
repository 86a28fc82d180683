/* Bytes as text, by base64 (RFC 4648). */
#include "common/encode.h"

#include <stdlib.h>
#include <string.h>

char *cli_base64(const char *head, const void *bytes, size_t count) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const size_t length = strlen(head);
    const unsigned char *from = bytes;
    char *text = malloc(length + 4 * ((count + 2) / 3) + 1);
    if (!text) return NULL;
    strcpy(text, head);
    char *at = text + length;
    for (size_t i = 0; i < count; i += 3) {
        unsigned group = (unsigned)from[i] << 16;
        if (i + 1 < count) group |= (unsigned)from[i + 1] << 8;
        if (i + 2 < count) group |= from[i + 2];
        *at++ = digits[group >> 18];
        *at++ = digits[group >> 12 & 63];
        *at++ = i + 1 < count ? digits[group >> 6 & 63] : '=';
        *at++ = i + 2 < count ? digits[group & 63] : '=';
    }
    *at = '\0';
    return text;
}
