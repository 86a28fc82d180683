/* Cells of tables that people open in a spreadsheet. */
#ifndef SKG_CLI_CSV_H
#define SKG_CLI_CSV_H

#include <stdio.h>

/* Writes a text as a cell: in quotes, with quotes in it doubled. A text that a spreadsheet would take for a formula gets an
 * apostrophe before it, which spreadsheets read as "this is text". */
void cli_csv_text(const char *text, FILE *stream);

#endif
