#include "core/text.h"

#include <stdlib.h>
#include <string.h>

/* Bytes of the UTF-8 character at `s`; 0 if there is none. By the table of well-formed sequences
 * of the Unicode Standard (3.9): no overlong ones, no surrogates, nothing above U+10FFFF. */
static size_t character_length(const unsigned char *s) {
  if (s[0] < 0x80) return 1;
  const size_t length = s[0] < 0xc2 || s[0] > 0xf4 ? 0 : s[0] < 0xe0 ? 2 : s[0] < 0xf0 ? 3 : 4;
  for (size_t i = 1; i < length; i++)
    if ((s[i] & 0xc0) != 0x80) return 0;
  if ((s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xed && s[1] > 0x9f)) return 0;
  if ((s[0] == 0xf0 && s[1] < 0x90) || (s[0] == 0xf4 && s[1] > 0x8f)) return 0;
  return length;
}

void text_copy(char *to, size_t size, const char *from) {
  const unsigned char *s = (const unsigned char *)(from ? from : "");
  size_t used = 0;
  while (*s) {
    const size_t length = character_length(s), taken = length ? length : 1;
    if (used + taken >= size) break;
    memcpy(to + used, s, taken);
    if (!length) to[used] = '?';
    used += taken;
    s += taken;
  }
  to[used] = 0;
}

char *text_duplicate(const char *from) {
  const size_t size = strlen(from ? from : "") + 1;
  char *copy = malloc(size);
  if (copy) text_copy(copy, size, from);
  return copy;
}

char *text_of_json(const json_t *json) {
  char *text = json ? json_dumps(json, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
  const size_t size = text ? strlen(text) : 0;
  char *ended = text ? realloc(text, size + 2) : NULL;
  if (ended)
    memcpy(ended + size, "\n", 2);
  else
    free(text);
  return ended;
}
