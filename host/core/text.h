/* text.h: strings of others, made fit for JSON and for file headers. */
#ifndef CANDELA_CORE_TEXT_H
#define CANDELA_CORE_TEXT_H

#include <jansson.h>
#include <stddef.h>

/* Copies at most `size` - 1 bytes and ends them with a 0. Each byte that is not part of a UTF-8
 * character becomes '?', and no character is cut. `size` >= 1; a `from` of NULL is empty. */
void text_copy(char *to, size_t size, const char *from);

/* The same of a whole string, in memory that the caller frees; NULL if memory is short. */
char *text_duplicate(const char *from);

/* JSON as people like to read it, with a newline at its end, in memory that the caller frees; NULL
 * if memory is short or `json` is NULL. */
char *text_of_json(const json_t *json);

#endif
