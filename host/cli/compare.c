/* candela compare: how far a picture is from a reference. */
#include "cli/cli.h"

#include <float.h>
#include <jansson.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEY_JSON = 256, KEY_FAIL_OVER, KEY_LAYER };

/* What --fail-over takes. A picture fails when it is worse: over the limit where large is bad,
 * below it where large is good. */
static const struct {
  const char *name;
  size_t at;
  int large_is_good;
} metrics[] = {{"mse", offsetof(cdl_Difference, mse), 0},
               {"rmse", offsetof(cdl_Difference, rmse), 0},
               {"relmse", offsetof(cdl_Difference, relative_mse), 0},
               {"max", offsetof(cdl_Difference, max_abs), 0},
               {"bias", offsetof(cdl_Difference, bias), 0},
               {"psnr", offsetof(cdl_Difference, psnr), 1},
               {"ssim", offsetof(cdl_Difference, ssim), 1}};
enum { METRICS = sizeof metrics / sizeof *metrics };

typedef struct Options {
  const char *paths[2];
  int path_count;
  const char *layer;
  int json;
  int limited; /* some limit was given */
  int has_limit[METRICS];
  double limit[METRICS];
} Options;

static const struct argp_option option_list[] = {
    {"json", KEY_JSON, NULL, 0, "Print JSON", 0},
    {"layer", KEY_LAYER, "NAME", 0, "Compare this layer of two .exr files: albedo, normal, …", 0},
    {"fail-over", KEY_FAIL_OVER, "METRIC=VALUE", 0,
     "Fail only if this metric is worse: mse, rmse, relmse, max, bias, psnr or ssim; may be "
     "repeated",
     0},
    {0}};

static void parse_limit(const char *text, Options *o) {
  const char *names[METRICS + 1] = {NULL};
  char name[16];
  const char *equals = strchr(text, '=');
  if (!equals) cli_usage("--fail-over: '%s' is not METRIC=VALUE, such as rmse=0.01", text);
  for (int i = 0; i < METRICS; i++) names[i] = metrics[i].name;
  snprintf(name, sizeof name, "%.*s", (int)(equals - text), text);
  const int metric = cli_choice("--fail-over", name, names);
  o->limit[metric] = cli_real("--fail-over", equals + 1, 0, DBL_MAX);
  o->has_limit[metric] = o->limited = 1;
}

static error_t parse_option(int key, char *value, struct argp_state *state) {
  Options *o = state->input;
  switch (key) {
  case KEY_JSON:
    o->json = 1;
    return 0;
  case KEY_LAYER:
    o->layer = value;
    return 0;
  case KEY_FAIL_OVER:
    parse_limit(value, o);
    return 0;
  case ARGP_KEY_ARG:
    if (o->path_count == 2) cli_usage("two pictures at a time: '%s' is one too many", value);
    o->paths[o->path_count++] = value;
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const struct argp parser = {
    option_list,
    parse_option,
    "A B",
    "Compares picture A with the reference B, in linear light.\v"
    "Means are over the pixels that are finite in both. relmse divides each square by B squared "
    "plus 0.01; psnr is against a peak of 1; ssim is of the sRGB-encoded luminance.\n\n"
    "Exit status: 0 if they are the same, or within the limits of --fail-over where some are given "
    "(pixels that are not finite in one alone fail always); 1 if not; 2 usage; 3 a picture cannot "
    "be read.",
    NULL,
    NULL,
    NULL};

static double metric_value(const cdl_Difference *d, int metric) {
  double value;
  memcpy(&value, (const char *)d + metrics[metric].at, sizeof value);
  return value;
}

/* A metric that is not a number is worse than any limit. */
static cdl_Status judge(const Options *o, const cdl_Difference *d) {
  if (d->identical) return CDL_OK;
  if (!o->limited || d->nonfinite[0] != d->nonfinite[1] || !d->finite_pixels) return CDL_DIFFERENT;
  for (int i = 0; i < METRICS; i++) {
    const double value = metric_value(d, i);
    const int good = metrics[i].large_is_good ? value >= o->limit[i] : fabs(value) <= o->limit[i];
    if (o->has_limit[i] && !good) return CDL_DIFFERENT;
  }
  return CDL_OK;
}

static json_t *real(double value) { return isfinite(value) ? json_real(value) : json_null(); }

static void print_json(const cdl_Difference *d, cdl_Status verdict) {
  json_t *json =
      json_pack("{s:b, s:b, s:I, s:I, s:[I,I], s:[o,o], s:[i,i]}", "identical", d->identical,
                "accepted", verdict == CDL_OK, "pixels", (json_int_t)d->pixels, "finite_pixels",
                (json_int_t)d->finite_pixels, "nonfinite", (json_int_t)d->nonfinite[0],
                (json_int_t)d->nonfinite[1], "mean", real(d->mean[0]), real(d->mean[1]), "max_at",
                (int)d->max_x, (int)d->max_y);
  for (int i = 0; i < METRICS; i++)
    json_object_set_new(json, metrics[i].name, real(metric_value(d, i)));
  json_dumpf(json, stdout, JSON_INDENT(2));
  putchar('\n');
  json_decref(json);
}

static void print_text(const Options *o, const cdl_Difference *d, cdl_Status verdict) {
  if (d->identical) printf("identical, bit for bit\n");
  printf("mean    %.6g against %.6g\n", d->mean[0], d->mean[1]);
  for (int i = 0; i < METRICS; i++) {
    printf("%-7s %.6g", metrics[i].name, metric_value(d, i));
    if (metrics[i].at == offsetof(cdl_Difference, max_abs)) printf(" at %u,%u", d->max_x, d->max_y);
    if (o->has_limit[i]) printf(" (limit %g)", o->limit[i]);
    putchar('\n');
  }
  if (d->nonfinite[0] || d->nonfinite[1])
    printf("values that are not finite: %llu and %llu\n", (unsigned long long)d->nonfinite[0],
           (unsigned long long)d->nonfinite[1]);
  if (o->limited) puts(verdict ? "not within the limits" : "within the limits");
}

int cli_compare(int argc, char **argv) {
  Options o = {0};
  cdl_Difference difference;
  cli_parse(&parser, argc, argv, &o);
  if (o.path_count < 2) cli_usage("two pictures are needed: candela compare A B");
  cdl_Status status = cdl_compare(&cli_log, o.paths[0], o.paths[1], o.layer, &difference);
  if (status) return status;
  const cdl_Status verdict = judge(&o, &difference);
  if (o.json)
    print_json(&difference, verdict);
  else
    print_text(&o, &difference, verdict);
  const cdl_Status printed = cli_flush();
  return printed ? printed : verdict;
}
