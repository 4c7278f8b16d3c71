/* hash.h: SHA-256 as text. */
#ifndef CANDELA_CORE_HASH_H
#define CANDELA_CORE_HASH_H

#include <nettle/sha2.h>

enum { CDL_HASH_HEX = 2 * SHA256_DIGEST_SIZE + 1 };

/* Ends the hash: 64 hexadecimal digits and a NUL. */
void hash_hex(struct sha256_ctx *hash, char hex[CDL_HASH_HEX]);

#endif
