#include "profile/profile.h"
#include "profile/rows.h"

#include <stdlib.h>
#include <string.h>

cdl_Profile *profile_create(const char *const *names, size_t count) {
  cdl_Profile *profile = calloc(1, sizeof *profile);
  if (!profile) return NULL;
  profile->rows = calloc(count ? count : 1, sizeof *profile->rows);
  if (!profile->rows) {
    free(profile);
    return NULL;
  }
  profile->names = names;
  profile->count = count;
  return profile;
}

void profile_reset(cdl_Profile *profile) {
  for (size_t i = 0; i < profile->count; i++) free(profile->rows[i].seconds);
  memset(profile->rows, 0, profile->count * sizeof *profile->rows);
  profile->rest = (cdl_ProfileRest){0};
}

void profile_free(cdl_Profile *profile) {
  if (!profile) return;
  profile_reset(profile);
  free(profile->rows);
  free(profile);
}

/* When memory is short the launch still counts in the sums, only not in the median. */
static void keep_duration(ProfileRow *row, double seconds) {
  if (row->kept == row->room) {
    size_t room = row->room ? 2 * row->room : 64;
    double *more = realloc(row->seconds, room * sizeof *more);
    if (!more) return;
    row->seconds = more;
    row->room = room;
  }
  row->seconds[row->kept++] = seconds;
}

void profile_launch(cdl_Profile *profile, const cdl_LaunchRecord *launch) {
  ProfileRow *row = &profile->rows[launch->kernel];
  if (!row->launches) {
    row->first_s = launch->seconds + launch->compile_seconds;
    row->first_alone_s = launch->seconds;
  }
  if (row->launches || !launch->first) keep_duration(row, launch->seconds);
  row->launches++;
  row->items += launch->items;
  row->total_s += launch->seconds;
  row->host_timed |= launch->host_timed;
  profile->rest.compile_s += launch->compile_seconds;
}

void profile_transfer(cdl_Profile *profile, uint64_t bytes, double seconds) {
  profile->rest.transfer_bytes += bytes;
  profile->rest.transfer_s += seconds;
}

void profile_compile(cdl_Profile *profile, double seconds) { profile->rest.compile_s += seconds; }

void profile_rays(cdl_Profile *profile, size_t kernel, uint64_t rays) {
  profile->rows[kernel].rays = rays;
}

static int compare_seconds(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The order of durations carries nothing, so they are sorted in place. */
static void order_statistics(ProfileRow *row, cdl_KernelStats *stats) {
  size_t n = row->kept;
  if (!n) {
    stats->min_s = stats->median_s = stats->max_s = row->first_alone_s;
    return;
  }
  qsort(row->seconds, n, sizeof *row->seconds, compare_seconds);
  stats->min_s = row->seconds[0];
  stats->max_s = row->seconds[n - 1];
  stats->median_s = 0.5 * (row->seconds[(n - 1) / 2] + row->seconds[n / 2]);
}

void profile_stats(const cdl_Profile *profile, size_t kernel, cdl_KernelStats *stats) {
  ProfileRow *row = &profile->rows[kernel];
  *stats = (cdl_KernelStats){.name = profile->names[kernel],
                             .launches = row->launches,
                             .items = row->items,
                             .total_s = row->total_s,
                             .first_s = row->first_s,
                             .rays = row->rays,
                             .host_timed = row->host_timed};
  order_statistics(row, stats);
}

cdl_ProfileRest profile_rest(const cdl_Profile *profile) { return profile->rest; }

double profile_kernel_seconds(const cdl_Profile *profile) {
  double sum = 0;
  for (size_t i = 0; i < profile->count; i++) sum += profile->rows[i].total_s;
  return sum;
}
