/* Bytes as text (RFC 4648), for pages. */
#ifndef SKG_CLI_BASE64_H
#define SKG_CLI_BASE64_H

#include <stddef.h>

/* `head` followed by the bytes in base 64, which the caller frees; NULL if memory is exhausted. */
char *cli_base64(const char *head, const void *bytes, size_t count);

#endif
