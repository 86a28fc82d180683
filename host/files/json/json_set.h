/* Settings KEY=VALUE that change a JSON file once it is read. Private. */
#ifndef SKG_JSON_SET_H
#define SKG_JSON_SET_H

#include "json/json_file.h"

/* Applies one setting "KEY=VALUE" with a dotted path; elements of arrays by number or by their Label. The
 * value is JSON, or a string where it does not parse. SKG_ERR_ARGUMENT. */
skg_status skg_json_set(skg_json_file *file, const char *setting);

#endif
