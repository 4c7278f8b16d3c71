#include "device/source.h"

#include "core/log.h"
#include "device/source_tree.h"

#include <errno.h>
#include <fts.h>
#include <nettle/sha2.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *source_root(void) {
  const char *root = getenv("CANDELA_KERNELS");
  return root && *root ? root : NULL;
}

/* A path stays inside the tree: no way up, no absolute path. */
static int path_is_plain(const char *path) {
  return *path && *path != '/' && strncmp(path, "../", 3) && !strstr(path, "/../");
}

static char *embedded_text(const char *path) {
  for (const cdl_KernelSource *s = kernel_sources; s->path; s++)
    if (!strcmp(s->path, path)) return strdup(s->text);
  return NULL;
}

/* NULL with errno set. */
static char *file_text(const char *path) {
  FILE *file = fopen(path, "rb");
  if (!file) return NULL;
  char *text = NULL;
  size_t size = 0, got;
  char block[4096];
  FILE *memory = open_memstream(&text, &size);
  while (memory && (got = fread(block, 1, sizeof block, file)) > 0) fwrite(block, 1, got, memory);
  int failed = !memory || ferror(file);
  int error = errno;
  if (memory) failed |= fclose(memory) != 0;
  fclose(file);
  if (!failed) return text;
  free(text);
  errno = error;
  return NULL;
}

char *source_find(const char *path) {
  const char *root = source_root();
  errno = ENOENT;
  if (!path_is_plain(path)) return NULL;
  if (!root) return embedded_text(path);
  char full[4096];
  if (snprintf(full, sizeof full, "%s/%s", root, path) >= (int)sizeof full) return NULL;
  return file_text(full);
}

cdl_Status source_read(const cdl_Log *log, const char *path, char **text) {
  *text = source_find(path);
  if (*text) return CDL_OK;
  const char *root = source_root();
  if (root)
    return log_fail(log, CDL_BAD_INPUT, "%s/%s: %s; CANDELA_KERNELS must name a kernels folder",
                    root, path, strerror(errno));
  return log_fail(log, CDL_BAD_INPUT, "%s: no such kernel source in this program", path);
}

static void hash_file(struct sha256_ctx *sha, const char *path, const char *text, size_t size) {
  char length[32];
  int digits = snprintf(length, sizeof length, "%zu", size);
  sha256_update(sha, strlen(path) + 1, (const uint8_t *)path);
  sha256_update(sha, digits + 1, (const uint8_t *)length);
  sha256_update(sha, size, (const uint8_t *)text);
}

static int is_source(const char *name) {
  const char *dot = strrchr(name, '.');
  return dot && (!strcmp(dot, ".cl") || !strcmp(dot, ".h"));
}

static int compare_paths(const void *a, const void *b) {
  return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Paths below `root`, relative to it, sorted as the embedded ones are; NULL if it cannot be read.
 */
static char **tree_paths(const char *root, size_t *count) {
  char *roots[] = {(char *)root, NULL};
  FTS *tree = fts_open(roots, FTS_LOGICAL | FTS_NOCHDIR, NULL);
  if (!tree) return NULL;
  char **paths = NULL;
  *count = 0;
  for (FTSENT *entry; (entry = fts_read(tree));) {
    if (entry->fts_info != FTS_F || !is_source(entry->fts_name)) continue;
    char **more = realloc(paths, (*count + 1) * sizeof *paths);
    if (!more) break;
    paths = more;
    paths[(*count)++] = strdup(entry->fts_path + strlen(root) + 1);
  }
  fts_close(tree);
  if (paths) qsort(paths, *count, sizeof *paths, compare_paths);
  return paths;
}

static cdl_Status hash_folder(const cdl_Log *log, const char *root, struct sha256_ctx *sha) {
  size_t count = 0;
  char **paths = tree_paths(root, &count);
  if (!paths)
    return log_fail(log, CDL_BAD_INPUT, "%s: no kernel sources; CANDELA_KERNELS must name a folder",
                    root);
  cdl_Status status = CDL_OK;
  for (size_t i = 0; i < count; i++) {
    char *text = NULL;
    if (!status && !(status = source_read(log, paths[i], &text)))
      hash_file(sha, paths[i], text, strlen(text));
    free(text);
    free(paths[i]);
  }
  free(paths);
  return status;
}

cdl_Status source_hash(const cdl_Log *log, char hex[CDL_SHA256_HEX]) {
  struct sha256_ctx sha;
  sha256_init(&sha);
  cdl_Status status = CDL_OK;
  if (source_root())
    status = hash_folder(log, source_root(), &sha);
  else
    for (const cdl_KernelSource *s = kernel_sources; s->path; s++)
      hash_file(&sha, s->path, s->text, s->size);
  uint8_t digest[SHA256_DIGEST_SIZE];
  sha256_digest(&sha, sizeof digest, digest);
  for (size_t i = 0; i < sizeof digest; i++) snprintf(hex + 2 * i, 3, "%02x", digest[i]);
  return status;
}
