/* Partial films into one picture. */
#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "render/job.h"
#include "render/parts.h"
#include "render/picture.h"
#include "render/statistics.h"

static int by_first_block(const void *a, const void *b) {
  const cdl_Part *p = a, *q = b;
  if (p->first != q->first) return p->first < q->first ? -1 : 1;
  return strcmp(p->path, q->path);
}

/* All parts of one job, sorted by block. */
static cdl_Status read_parts(const cdl_Log *log, const char *const *paths, size_t count,
                             cdl_Part *parts) {
  for (size_t i = 0; i < count; i++) {
    cdl_Status status = part_read(log, paths[i], &parts[i], NULL);
    if (!status && i) status = job_check(log, paths[i], parts[i].job, paths[0], parts[0].job);
    if (status) return status;
  }
  qsort(parts, count, sizeof *parts, by_first_block);
  return CDL_OK;
}

/* Names what is missing as render takes it. */
static cdl_Status missing(const cdl_Log *log, uint32_t first, uint32_t end, uint32_t samples) {
  const uint32_t from = first * CDL_FILM_BLOCK;
  const uint64_t to = (uint64_t)end * CDL_FILM_BLOCK;
  return log_fail(log, CDL_BAD_INPUT,
                  "the parts lack samples %u to %u; render them with --samples %u:%u", from,
                  (uint32_t)((to < samples ? to : samples) - 1), from,
                  (uint32_t)((to < samples ? to : samples) - from));
}

static cdl_Status check_cover(const cdl_Log *log, const cdl_Part *parts, size_t count) {
  const uint32_t samples = job_integer(parts[0].job, "samples");
  const uint32_t blocks = samples / CDL_FILM_BLOCK + (samples % CDL_FILM_BLOCK != 0);
  uint32_t next = 0;
  for (size_t i = 0; i < count; i++) {
    if (parts[i].first < next)
      return log_fail(log, CDL_BAD_INPUT, "%s: overlaps %s: both have samples from %u on",
                      parts[i].path, parts[i - 1].path, parts[i].first * CDL_FILM_BLOCK);
    if (parts[i].first > next) return missing(log, next, parts[i].first, samples);
    next = parts[i].first + parts[i].count;
  }
  return next < blocks ? missing(log, next, blocks, samples) : CDL_OK;
}

/* Each part is read again for its pixels, so that only one of them is in memory at a time. */
static cdl_Status add_parts(const cdl_Log *log, const cdl_Part *parts, size_t count,
                            cdl_Film **film) {
  cdl_Status status = CDL_OK;
  for (size_t i = 0; i < count && !status; i++) {
    cdl_Part again;
    cdl_ExrImage *image = NULL;
    status = part_read(log, parts[i].path, &again, &image);
    if (!status && (again.first != parts[i].first || again.count != parts[i].count))
      status = log_fail(log, CDL_BAD_INPUT, "%s: changed while it was merged", parts[i].path);
    if (!status && !*film)
      status = film_create(log, (uint32_t)image->width, (uint32_t)image->height,
                           job_integer(again.job, "aovs"), 0, film);
    if (!status) status = part_add(log, &again, image, *film);
    image_exr_free(image);
    part_clear(&again);
  }
  return status;
}

/* The first part's header and statistics stand for all, with what the merge changes. */
static cdl_Status describe(const cdl_Part *parts, size_t count, cdl_Picture *picture) {
  uint32_t least, most;
  json_t *header = picture->header = json_incref(parts[0].header);
  json_t *statistics = picture->statistics = json_incref(parts[0].statistics);
  picture->job = json_incref(parts[0].job);
  for (size_t i = 1; i < count; i++) statistics_add(statistics, parts[i].statistics);
  cdl_Status status = statistics_finish(statistics, picture->film);
  if (status) return status;
  film_sample_range(picture->film, &least, &most);
  json_object_set(header, "film_sha256", json_object_get(statistics, "film_sha256"));
  json_object_set_new(header, "samples.least", json_integer(least));
  json_object_set_new(header, "samples.most", json_integer(most));
  json_object_set_new(header, "interrupted", json_integer(0));
  json_object_set_new(statistics, "interrupted", json_false());
  json_object_set_new(statistics, "parts", json_integer((json_int_t)count));
  json_t *settings = json_object_get(statistics, "settings");
  json_object_set_new(settings, "first_sample", json_integer(0));
  json_object_set_new(settings, "sample_count", json_integer(most));
  return CDL_OK;
}

cdl_Status cdl_merge(const cdl_Log *log, const char *const *paths, size_t count,
                     cdl_Picture **picture) {
  *picture = NULL;
  if (!count) return log_fail(log, CDL_USAGE, "there are no parts to merge");
  cdl_Part *parts = calloc(count, sizeof *parts);
  cdl_Picture *merged = calloc(1, sizeof *merged);
  cdl_Status status = CDL_OK;
  if (!parts || !merged) status = log_fail(log, CDL_DEVICE, "not enough memory to merge");
  if (!status) status = read_parts(log, paths, count, parts);
  if (!status) status = check_cover(log, parts, count);
  if (!status) merged->log = log;
  if (!status) status = add_parts(log, parts, count, &merged->film);
  if (!status) status = describe(parts, count, merged);
  if (status)
    cdl_picture_free(merged);
  else
    *picture = merged;
  for (size_t i = 0; parts && i < count; i++) part_clear(&parts[i]);
  free(parts);
  return status;
}
