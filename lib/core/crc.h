/* CRC-32C, the checksum of Castagnoli (RFC 3720, section 12.1): it finds damage, not intent. Private. */
#ifndef SKG_CRC_H
#define SKG_CRC_H

#include <stddef.h>
#include <stdint.h>

/* By the instruction of the processor where there is one. */
uint32_t skg_crc32c(const void *data, size_t bytes);

/* By tables. */
uint32_t skg_crc32c_by_tables(const void *data, size_t bytes);

#endif
