#include "profile/profile.h"
#include "profile/rows.h"

#include <stdlib.h>
#include <string.h>

static int name_width(const cdl_Profile *profile) {
  size_t width = strlen("compilation");
  for (size_t i = 0; i < profile->count; i++)
    if (profile->rows[i].launches && strlen(profile->names[i]) > width)
      width = strlen(profile->names[i]);
  return (int)width;
}

static int longer_first(const void *a, const void *b) {
  const cdl_KernelStats *x = a, *y = b;
  return (x->total_s < y->total_s) - (x->total_s > y->total_s);
}

/* Kernels that ran, longest first; the caller frees. NULL: memory is short. */
static cdl_KernelStats *sorted_stats(const cdl_Profile *profile, size_t *count) {
  cdl_KernelStats *stats = calloc(profile->count + 1, sizeof *stats);
  *count = 0;
  if (!stats) return NULL;
  for (size_t i = 0; i < profile->count; i++)
    if (profile->rows[i].launches) profile_stats(profile, i, &stats[(*count)++]);
  qsort(stats, *count, sizeof *stats, longer_first);
  return stats;
}

static double share(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

static void print_kernel(FILE *out, int width, const cdl_KernelStats *s, double wall_s) {
  fprintf(out, "%-*s%c %8llu %13llu %10.2f %9.3f %9.3f %9.3f %9.2f %6.1f", width, s->name,
          s->host_timed ? '*' : ' ', (unsigned long long)s->launches, (unsigned long long)s->items,
          1e3 * s->total_s, 1e3 * s->min_s, 1e3 * s->median_s, 1e3 * s->max_s, 1e3 * s->first_s,
          share(s->total_s, wall_s));
  if (s->rays && s->total_s > 0) fprintf(out, " %8.2f", 1e-6 * s->rays / s->total_s);
  fputc('\n', out);
}

static void print_part(FILE *out, int width, const char *name, double seconds, double wall_s) {
  fprintf(out, "%-*s %*s %10.2f %*s %6.1f\n", width + 1, name, 22, "", 1e3 * seconds, 39, "",
          share(seconds, wall_s));
}

/* What is left when the named parts are taken off is the host: its own work, and waiting. Kernels
 * and copies do not overlap it in an in-order queue, but timers may: never print less than nothing.
 */
static void print_rest(FILE *out, int width, const cdl_Profile *profile, double kernels_s,
                       double wall_s) {
  double host_s = wall_s - kernels_s - profile->rest.compile_s - profile->rest.transfer_s;
  print_part(out, width, "all kernels", kernels_s, wall_s);
  print_part(out, width, "compilation", profile->rest.compile_s, wall_s);
  print_part(out, width, "transfers", profile->rest.transfer_s, wall_s);
  print_part(out, width, "host", host_s > 0 ? host_s : 0, wall_s);
  print_part(out, width, "wall time", wall_s, wall_s);
}

void profile_table(FILE *out, const cdl_Profile *profile, double wall_s) {
  size_t count;
  int width = name_width(profile), host_timed = 0;
  cdl_KernelStats *stats = sorted_stats(profile, &count);
  fprintf(out, "%-*s  %8s %13s %10s %9s %9s %9s %9s %6s %8s\n", width, "kernel", "launches",
          "items", "total ms", "min ms", "median ms", "max ms", "first ms", "share%", "Mray/s");
  for (size_t i = 0; stats && i < count; i++) {
    print_kernel(out, width, &stats[i], wall_s);
    host_timed |= stats[i].host_timed;
  }
  print_rest(out, width, profile, profile_kernel_seconds(profile), wall_s);
  if (host_timed)
    fprintf(out, "* the driver's timers are stubs: timed by the host, one launch at a time\n");
  free(stats);
}

static json_t *kernel_json(const cdl_KernelStats *s) {
  json_t *row = json_pack("{s:s, s:I, s:I, s:f, s:f, s:f, s:f, s:f}", "name", s->name, "launches",
                          (json_int_t)s->launches, "items", (json_int_t)s->items, "total_s",
                          s->total_s, "min_s", s->min_s, "median_s", s->median_s, "max_s", s->max_s,
                          "first_s", s->first_s);
  if (row && s->host_timed) json_object_set_new(row, "host_timed", json_true());
  if (row && s->rays) {
    json_object_set_new(row, "rays", json_integer((json_int_t)s->rays));
    if (s->total_s > 0)
      json_object_set_new(row, "mrays_per_s", json_real(1e-6 * s->rays / s->total_s));
  }
  return row;
}

json_t *profile_json(const cdl_Profile *profile) {
  json_t *rows = json_array();
  for (size_t i = 0; rows && i < profile->count; i++) {
    if (!profile->rows[i].launches) continue;
    cdl_KernelStats stats;
    profile_stats(profile, i, &stats);
    if (json_array_append_new(rows, kernel_json(&stats))) {
      json_decref(rows);
      return NULL;
    }
  }
  return rows;
}
