/* schema_members.h: short forms for the rows of the schema tables. */
#ifndef CANDELA_SCENE_SCHEMA_MEMBERS_H
#define CANDELA_SCENE_SCHEMA_MEMBERS_H

#include <math.h>

#include "scene/schema.h"

/* Integers stay exact in a double up to 2^53. */
#define MOST 0x1p53
#define ENDED 0xffffffffu

#define NUMBER(n, f, lo, hi)                                                                       \
  { .name = n, .type = MEMBER_NUMBER, .flags = f, .min = lo, .max = hi }
#define ANY_NUMBER(n, f) NUMBER(n, f, -INFINITY, INFINITY)
#define NUMBERS(n, f, few, many, lo, hi)                                                           \
  {                                                                                                \
    .name = n, .type = MEMBER_NUMBER, .flags = (f) | ARRAY, .shortest = few, .longest = many,      \
    .min = lo, .max = hi                                                                           \
  }
#define COLOUR(n, f, hi) NUMBERS(n, f, 3, 3, 0, hi)
#define INTEGER(n, f, lo, hi)                                                                      \
  { .name = n, .type = MEMBER_INTEGER, .flags = f, .min = lo, .max = hi }
#define CODES(n, f, list)                                                                          \
  { .name = n, .type = MEMBER_INTEGER, .flags = (f) | LISTED, .max = MOST, .values = list }
#define FLAG(n)                                                                                    \
  { .name = n, .type = MEMBER_BOOL }
#define STRING(n, f)                                                                               \
  { .name = n, .type = MEMBER_STRING, .flags = f }
#define STRINGS(n, f)                                                                              \
  { .name = n, .type = MEMBER_STRING, .flags = (f) | ARRAY, .shortest = 1 }
#define CHOICE(n, f, list)                                                                         \
  { .name = n, .type = MEMBER_STRING, .flags = f, .choices = list }
#define OBJECT(n, f, s)                                                                            \
  { .name = n, .type = MEMBER_OBJECT, .flags = f, .schema = s }
#define OBJECTS(n, f, s)                                                                           \
  { .name = n, .type = MEMBER_OBJECT, .flags = (f) | ARRAY, .shortest = 1, .schema = s }
#define INDEX(n, f, t)                                                                             \
  { .name = n, .type = MEMBER_INDEX, .flags = f, .target = t }
#define INDICES(n, f, t)                                                                           \
  { .name = n, .type = MEMBER_INDEX, .flags = (f) | ARRAY | UNIQUE, .shortest = 1, .target = t }
#define INDEX_MAP(n, f, t)                                                                         \
  { .name = n, .type = MEMBER_INDEX_MAP, .flags = f, .target = t }
#define NAME STRING("name", 0)
#define END                                                                                        \
  { .name = NULL }
#define SCHEMA(symbol, title, rows) const Schema symbol = {title, rows}

#endif
