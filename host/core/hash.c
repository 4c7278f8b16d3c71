#include "core/hash.h"

#include <stddef.h>

void hash_hex(struct sha256_ctx *hash, char hex[CDL_HASH_HEX]) {
  static const char digits[] = "0123456789abcdef";
  uint8_t bytes[SHA256_DIGEST_SIZE];
  sha256_digest(hash, sizeof bytes, bytes);
  for (size_t i = 0; i < sizeof bytes; i++) {
    hex[2 * i] = digits[bytes[i] >> 4];
    hex[2 * i + 1] = digits[bytes[i] & 15];
  }
  hex[CDL_HASH_HEX - 1] = 0;
}
