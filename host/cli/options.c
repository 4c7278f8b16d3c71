/* Arguments: what argp leaves to its users, said in one line. */
#include "cli/cli.h"

#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *program = "candela";

void cli_usage(const char *format, ...) {
  va_list args;
  fprintf(stderr, "%s: ", program);
  va_start(args, format);
  vfprintf(stderr, format, args);
  va_end(args);
  fputc('\n', stderr);
  exit(CDL_USAGE);
}

/* Edit distance (Levenshtein), good enough for names below 32 letters. */
static unsigned distance(const char *a, const char *b) {
  unsigned row[33];
  const size_t n = strlen(a), m = strlen(b);
  if (n > 32 || m > 32) return 99;
  for (size_t j = 0; j <= m; j++) row[j] = (unsigned)j;
  for (size_t i = 1; i <= n; i++) {
    unsigned diagonal = row[0];
    row[0] = (unsigned)i;
    for (size_t j = 1; j <= m; j++) {
      const unsigned replace = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = (row[j] < row[j - 1] ? row[j] : row[j - 1]) + 1;
      if (replace < row[j]) row[j] = replace;
    }
  }
  return row[m];
}

const char *cli_closest(const char *text, const char *const *names) {
  const char *best = NULL;
  unsigned least = (unsigned)strlen(text) / 3 + 2;
  for (; *names; names++) {
    const unsigned d = distance(text, *names);
    if (d < least) {
      least = d;
      best = *names;
    }
  }
  return best;
}

/* --- Options, before argp sees them: its own complaints take two lines and no cure. */

static const char *const help_names[] = {"help", "usage", "version"};
enum { HELP_NAMES = 3, MAX_OPTIONS = 64 };

static int has_prefix(const char *name, const char *text, size_t length) {
  return !strncmp(name, text, length);
}

static void refuse_option(const struct argp_option *table, const char *argument, size_t length) {
  const char *names[MAX_OPTIONS + HELP_NAMES + 1];
  char name[40];
  int count = 0;
  for (; table->name && count < MAX_OPTIONS; table++) names[count++] = table->name;
  for (int i = 0; i < HELP_NAMES; i++) names[count++] = help_names[i];
  names[count] = NULL;
  snprintf(name, sizeof name, "%.*s", (int)length, argument + 2);
  const char *closest = cli_closest(name, names);
  cli_usage("there is no option '--%s'; %s%s%s", name, closest ? "did you mean --" : "see ",
            closest ? closest : program, closest ? "?" : " --help");
}

/* A long option, or the start of one and only one; NULL for those that argp adds. */
static const struct argp_option *find_long(const struct argp_option *table, const char *argument) {
  const char *text = argument + 2;
  const size_t length = strcspn(text, "=");
  const struct argp_option *found = NULL;
  int matches = 0;
  for (const struct argp_option *o = table; o->name; o++) {
    if (!has_prefix(o->name, text, length)) continue;
    if (strlen(o->name) == length) return o;
    found = o;
    matches++;
  }
  for (int i = 0; i < HELP_NAMES; i++)
    if (has_prefix(help_names[i], text, length)) matches++;
  if (matches == 0) refuse_option(table, argument, length);
  if (matches > 1 && found)
    cli_usage("'%s' is the start of several options; see %s --help", argument, program);
  return found;
}

static const struct argp_option *find_short(const struct argp_option *table, char letter) {
  if (letter == '?' || letter == 'V') return NULL; /* argp's own */
  for (const struct argp_option *o = table; o->name; o++)
    if (o->key == letter) return o;
  cli_usage("there is no option '-%c'; see %s --help", letter, program);
}

/* Whether the option takes the next argument as its value. */
static int check_long(const struct argp_option *table, char **argument) {
  const struct argp_option *o = find_long(table, *argument);
  const char *value = strchr(*argument, '=');
  if (!o) return 0;
  if (value && !o->arg) cli_usage("--%s takes no value", o->name);
  if (o->arg && !value && !argument[1]) cli_usage("--%s needs a value: %s", o->name, o->arg);
  return o->arg && !value;
}

static int check_short(const struct argp_option *table, char **argument) {
  for (const char *letter = *argument + 1; *letter; letter++) {
    const struct argp_option *o = find_short(table, *letter);
    if (!o || !o->arg) continue;
    if (!letter[1] && !argument[1]) cli_usage("-%c needs a value: %s", *letter, o->arg);
    return !letter[1];
  }
  return 0;
}

void cli_parse(const struct argp *argp, int argc, char **argv, void *input) {
  program = argv[0];
  for (char **argument = argv + 1; argument < argv + argc; argument++) {
    if (!strcmp(*argument, "--")) break;
    if (!strncmp(*argument, "--", 2))
      argument += check_long(argp->options, argument);
    else if (**argument == '-' && (*argument)[1])
      argument += check_short(argp->options, argument);
  }
  if (argp_parse(argp, argc, argv, 0, NULL, input)) exit(CDL_USAGE);
}

/* --- Values. */

/* strtoul takes signs and blanks, and wraps around. */
static int parse_uint(const char *text, size_t length, uint32_t *value) {
  uint64_t number = 0;
  for (size_t i = 0; i < length; i++) {
    if (!isdigit((unsigned char)text[i])) return 0;
    number = 10 * number + (uint64_t)(text[i] - '0');
    if (number > UINT32_MAX) return 0;
  }
  *value = (uint32_t)number;
  return length > 0;
}

/* strtod takes blanks, "nan", "inf" and hexadecimal digits. */
static int parse_real(const char *text, size_t length, double *value) {
  char copy[64], *end;
  if (length == 0 || length >= sizeof copy) return 0;
  memcpy(copy, text, length);
  copy[length] = 0;
  if (strspn(copy, "0123456789.eE+-") != length) return 0;
  *value = strtod(copy, &end);
  return !*end && isfinite(*value);
}

uint32_t cli_uint(const char *option, const char *text, uint32_t least, uint32_t most) {
  uint32_t value;
  if (!parse_uint(text, strlen(text), &value) || value < least || value > most)
    cli_usage("%s: '%s' is not a whole number from %u to %u", option, text, least, most);
  return value;
}

static void refuse_real(const char *option, const char *text, double least, double most) {
  char upto[32] = "", from[32] = "";
  if (least > -DBL_MAX) snprintf(from, sizeof from, " from %g", least);
  if (most < DBL_MAX) snprintf(upto, sizeof upto, " up to %g", most);
  cli_usage("%s: '%s' is not a number%s%s", option, text, from, upto);
}

double cli_real(const char *option, const char *text, double least, double most) {
  double value;
  if (!parse_real(text, strlen(text), &value) || value < least || value > most)
    refuse_real(option, text, least, most);
  return value;
}

/* The length of the field at `text`, and whether it ends as field `i` of `count` must. */
static size_t field_length(const char *text, char separator, int is_last, int *ok) {
  const char ends[2] = {separator, 0};
  const size_t length = strcspn(text, ends);
  *ok = *ok && (text[length] == 0) == is_last;
  return length;
}

void cli_uints(const char *option, const char *text, char separator, int count, uint32_t *values) {
  const char *at = text;
  int ok = 1;
  for (int i = 0; i < count && ok; i++) {
    const size_t length = field_length(at, separator, i + 1 == count, &ok);
    ok = ok && parse_uint(at, length, &values[i]);
    at += length + 1;
  }
  if (!ok)
    cli_usage("%s: '%s' is not %d whole numbers with '%c' between them", option, text, count,
              separator);
}

void cli_reals(const char *option, const char *text, char separator, int count, double least,
               double most, double *values) {
  const char *at = text;
  int ok = 1;
  for (int i = 0; i < count && ok; i++) {
    const size_t length = field_length(at, separator, i + 1 == count, &ok);
    ok = ok && parse_real(at, length, &values[i]) && values[i] >= least && values[i] <= most;
    at += length + 1;
  }
  if (!ok)
    cli_usage("%s: '%s' is not %d numbers of at least %g with '%c' between them", option, text,
              count, least, separator);
}

int cli_choice(const char *option, const char *text, const char *const *names) {
  char all[256] = "";
  for (int i = 0; names[i]; i++) {
    if (!strcmp(text, names[i])) return i;
    snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s",
             !i             ? ""
             : names[i + 1] ? ", "
                            : " or ",
             names[i]);
  }
  cli_usage("%s: '%s' is not %s", option, text, all);
}
