/* Values as text: JSON, cells of tables, base 64. */
#ifndef CLI_COMMON_ENCODE_H
#define CLI_COMMON_ENCODE_H

#include <jansson.h>
#include <stddef.h>
#include <stdio.h>

/* null if the number is not finite. */
json_t *cli_json_number(double number);

/* Bytes that are not UTF-8 become question marks. */
json_t *cli_json_text(const char *text);

json_t *cli_json_numbers(const double *numbers, int count);

/* The text of an object for a script within a page, which the caller frees; NULL if memory is exhausted. No text in it can
 * end the script or begin a comment: "<" is written as \u003c. */
char *cli_json_for_page(const json_t *object);

/* Prints an object on standard output and releases it. Returns an exit status. */
int cli_json_print(json_t *object);

/* Prints {"error": {"status", "message", "where"}} for the first failure, if there was one and no object has been
 * printed. where: the file, line, key or part that the message begins with, or null. file: the operand, whose name may
 * have blanks; NULL: none. */
void cli_json_print_failure(const char *file);

/* Writes a text as a cell: in quotes, with quotes in it doubled. A text that a spreadsheet would take for a formula gets an
 * apostrophe before it, which spreadsheets read as "this is text". */
void cli_csv_text(const char *text, FILE *stream);

/* Writes a text of a file into a page: labels and names may hold "<", "&" and quotes. */
void cli_html_text(const char *text, FILE *page);

/* `head` followed by the bytes in base 64 (RFC 4648), for pages, which the caller frees; NULL if memory is exhausted. */
char *cli_base64(const char *head, const void *bytes, size_t count);

#endif
