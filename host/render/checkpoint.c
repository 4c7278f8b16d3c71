#include "render/checkpoint.h"

#include <stdlib.h>
#include <string.h>

#include <nettle/sha2.h>

#include "core/log.h"
#include "image/image_file.h"
#include "render/job.h"

#define MAGIC "candela checkpoint 1\n"
#define BYTE_ORDER_MARK 0x01020304u
#define MAX_BYTES ((size_t)1 << 40)
enum { MAGIC_SIZE = sizeof MAGIC - 1, MAX_JSON = 1 << 20, MAX_ARRAYS = 4 };

typedef struct Array {
  void *data;
  size_t size;
} Array;

/* The film's arrays in the order of the file; parts follow. */
static void film_arrays(const cdl_Film *film, Array arrays[MAX_ARRAYS]) {
  const size_t pixels = (size_t)film->width * film->height;
  arrays[0] = (Array){film->sums, pixels * film->channels * sizeof *film->sums};
  arrays[1] = (Array){film->squares, pixels * 3 * sizeof *film->squares};
  arrays[2] = (Array){film->samples, pixels * sizeof *film->samples};
  arrays[3] = (Array){film->blocks, pixels * sizeof *film->blocks};
}

static size_t part_size(const cdl_Film *film) {
  return (size_t)film->width * film->height * film->channels * sizeof(float);
}

static size_t film_size(const cdl_Film *film, size_t parts) {
  Array arrays[MAX_ARRAYS];
  film_arrays(film, arrays);
  size_t size = 0;
  for (int i = 0; i < MAX_ARRAYS; i++) size += arrays[i].size;
  return size + parts * part_size(film);
}

static json_t *film_json(const cdl_Film *film) {
  json_t *parts = json_array();
  for (uint32_t i = 0; i < film->part_count; i++)
    json_array_append_new(
        parts, json_pack("[i,i]", (int)film->parts[i].index, (int)film->parts[i].samples));
  return json_pack("{s:i, s:i, s:i, s:i, s:o}", "width", (int)film->width, "height",
                   (int)film->height, "channels", (int)film->channels, "keep_blocks",
                   film->keep_blocks, "parts", parts);
}

static unsigned char *put(unsigned char *at, const void *data, size_t size) {
  memcpy(at, data, size);
  return at + size;
}

static void digest(const unsigned char *bytes, size_t size, uint8_t hash[SHA256_DIGEST_SIZE]) {
  struct sha256_ctx context;
  sha256_init(&context);
  sha256_update(&context, size, bytes);
  sha256_digest(&context, SHA256_DIGEST_SIZE, hash);
}

static void fill(unsigned char *bytes, const char *json, const cdl_Film *film) {
  const uint32_t words[2] = {BYTE_ORDER_MARK, (uint32_t)strlen(json)};
  Array arrays[MAX_ARRAYS];
  film_arrays(film, arrays);
  unsigned char *at = put(bytes, MAGIC, MAGIC_SIZE);
  at = put(at, words, sizeof words);
  at = put(at, json, words[1]);
  for (int i = 0; i < MAX_ARRAYS; i++) at = put(at, arrays[i].data, arrays[i].size);
  for (uint32_t i = 0; i < film->part_count; i++)
    at = put(at, film->parts[i].sums, part_size(film));
  digest(bytes, (size_t)(at - bytes), at);
}

cdl_Status checkpoint_write(const cdl_Log *log, const char *path, const json_t *job,
                            const json_t *state, const cdl_Film *film) {
  json_t *head = json_pack("{s:O, s:O, s:o}", "job", job, "state", state, "film", film_json(film));
  char *text = head ? json_dumps(head, JSON_COMPACT | JSON_SORT_KEYS) : NULL;
  const size_t size = MAGIC_SIZE + 2 * sizeof(uint32_t) + (text ? strlen(text) : 0) +
                      film_size(film, film->part_count) + SHA256_DIGEST_SIZE;
  unsigned char *bytes = text ? malloc(size) : NULL;
  cdl_Status status;
  if (bytes) {
    fill(bytes, text, film);
    status = image_file_write(log, path, bytes, size);
  } else {
    status = log_fail(log, CDL_OUTPUT, "%s: not enough memory for a checkpoint", path);
  }
  free(bytes);
  free(text);
  json_decref(head);
  return status;
}

/* A checkpoint in memory. */
typedef struct Reader {
  const cdl_Log *log;
  const char *path;
  unsigned char *bytes;
  size_t size;
  json_t *head;
  const unsigned char *arrays;
} Reader;

static cdl_Status damaged(const Reader *r, const char *what) {
  return log_fail(r->log, CDL_BAD_INPUT,
                  "%s: the checkpoint is damaged: %s; start without --resume, or with an older one",
                  r->path, what);
}

static cdl_Status parse(Reader *r) {
  const size_t fixed = MAGIC_SIZE + 2 * sizeof(uint32_t);
  uint8_t hash[SHA256_DIGEST_SIZE];
  uint32_t words[2];
  if (r->size < MAGIC_SIZE || memcmp(r->bytes, MAGIC, MAGIC_SIZE - 2))
    return log_fail(r->log, CDL_BAD_INPUT, "%s: is no checkpoint of Candela", r->path);
  if (memcmp(r->bytes, MAGIC, MAGIC_SIZE))
    return log_fail(r->log, CDL_BAD_INPUT,
                    "%s: is a checkpoint of another version of Candela; start without --resume",
                    r->path);
  if (r->size < fixed + sizeof hash) return damaged(r, "it is too short");
  digest(r->bytes, r->size - sizeof hash, hash);
  if (memcmp(hash, r->bytes + r->size - sizeof hash, sizeof hash))
    return damaged(r, "its checksum does not fit");
  memcpy(words, r->bytes + MAGIC_SIZE, sizeof words);
  if (words[0] != BYTE_ORDER_MARK) return damaged(r, "its byte order is another machine's");
  if (words[1] > MAX_JSON || words[1] > r->size - fixed - sizeof hash)
    return damaged(r, "its header is too long");
  r->head = json_loadb((const char *)r->bytes + fixed, words[1], 0, NULL);
  r->arrays = r->bytes + fixed + words[1];
  return r->head ? CDL_OK : damaged(r, "its header cannot be read");
}

/* Whether the arrays are those of this film. */
static cdl_Status check_film(const Reader *r, const cdl_Film *film) {
  const json_t *json = json_object_get(r->head, "film");
  const size_t parts = json_array_size(json_object_get(json, "parts"));
  const size_t left = (size_t)(r->bytes + r->size - r->arrays) - SHA256_DIGEST_SIZE;
  if (job_integer(json, "width") != film->width || job_integer(json, "height") != film->height ||
      job_integer(json, "channels") != film->channels ||
      job_integer(json, "keep_blocks") != (uint32_t)film->keep_blocks)
    return damaged(r, "its film has another shape");
  if (parts > left || film_size(film, parts) != left) return damaged(r, "its length is wrong");
  if (!json_is_object(json_object_get(r->head, "state"))) return damaged(r, "it has no state");
  return CDL_OK;
}

/* Whether the list of parts is what film_add() makes of the job's samples: blocks in order. */
static cdl_Status check_parts(const Reader *r) {
  const json_t *job = json_object_get(r->head, "job");
  const json_t *list = json_object_get(json_object_get(r->head, "film"), "parts");
  const uint32_t samples = job_integer(job, "samples");
  const uint64_t first = job_integer(job, "first_sample") / CDL_FILM_BLOCK;
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *entry = json_array_get(list, i);
    const uint64_t begin = (first + i) * CDL_FILM_BLOCK;
    const uint64_t left = begin < samples ? samples - begin : 0;
    const uint64_t wanted = left < CDL_FILM_BLOCK ? left : CDL_FILM_BLOCK;
    if (!wanted || json_integer_value(json_array_get(entry, 0)) != (json_int_t)(first + i) ||
        json_integer_value(json_array_get(entry, 1)) != (json_int_t)wanted)
      return damaged(r, "its blocks are not those of its samples");
  }
  return CDL_OK;
}

/* The parts, in memory of their own; *parts stays NULL when there are none. */
static cdl_Status read_parts(const Reader *r, const cdl_Film *film, const unsigned char *at,
                             cdl_FilmBlock **parts, uint32_t *count) {
  const json_t *list = json_object_get(json_object_get(r->head, "film"), "parts");
  const size_t wanted = json_array_size(list), size = part_size(film);
  *count = 0;
  *parts = wanted ? calloc(wanted, sizeof **parts) : NULL;
  for (size_t i = 0; i < wanted; i++) {
    const json_t *entry = json_array_get(list, i);
    float *sums = *parts ? malloc(size) : NULL;
    if (!sums) {
      for (uint32_t k = 0; k < *count; k++) free((*parts)[k].sums);
      free(*parts);
      return log_fail(r->log, CDL_DEVICE, "%s: not enough memory for the checkpoint", r->path);
    }
    memcpy(sums, at + i * size, size);
    (*parts)[i] = (cdl_FilmBlock){(uint32_t)json_integer_value(json_array_get(entry, 0)),
                                  (uint32_t)json_integer_value(json_array_get(entry, 1)), sums};
    (*count)++;
  }
  return CDL_OK;
}

static cdl_Status fill_film(const Reader *r, cdl_Film *film) {
  Array arrays[MAX_ARRAYS];
  film_arrays(film, arrays);
  const unsigned char *at = r->arrays;
  cdl_FilmBlock *parts;
  uint32_t count;
  cdl_Status status = read_parts(r, film, at + film_size(film, 0), &parts, &count);
  if (status) return status;
  for (int i = 0; i < MAX_ARRAYS; i++) {
    memcpy(arrays[i].data, at, arrays[i].size);
    at += arrays[i].size;
  }
  for (uint32_t i = 0; i < film->part_count; i++) free(film->parts[i].sums);
  free(film->parts);
  film->parts = parts;
  film->part_count = count;
  return CDL_OK;
}

cdl_Status checkpoint_read(const cdl_Log *log, const char *path, const json_t *job, cdl_Film *film,
                           cdl_StateCheck check, const void *user, json_t **state) {
  Reader r = {.log = log, .path = path};
  cdl_Status status = image_file_read(log, path, MAX_BYTES, &r.bytes, &r.size);
  if (status) return status;
  status = parse(&r);
  if (!status) status = job_check(log, path, json_object_get(r.head, "job"), "this render", job);
  if (!status) status = check_film(&r, film);
  if (!status) status = check_parts(&r);
  if (!status && check && !check(user, json_object_get(r.head, "state")))
    status = damaged(&r, "it goes on where this render never is");
  if (!status) status = fill_film(&r, film);
  if (!status) *state = json_incref(json_object_get(r.head, "state"));
  json_decref(r.head);
  free(r.bytes);
  return status;
}
