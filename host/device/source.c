#include "device/source.h"

#include "core/log.h"
#include "device/source_tree.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_DEPTH = 64, MAX_FILES = 512, MAX_PATH = 256 };

/* Text inside #if of unknown outcome must not count as seen: a header put in there may be compiled
 * out and be needed later. Headers with a guard are dropped when seen for sure; anything else is
 * put in at each include, as a preprocessor would. */
typedef struct Flattener {
  const cdl_Log *log;
  FILE *out;
  char seen[MAX_FILES][MAX_PATH];
  size_t seen_count;
  const char *stack[MAX_DEPTH];
  int depth;
} Flattener;

typedef struct SourceFile {
  const char *path;
  int line;
  int nesting; /* of #if */
  int base;    /* nesting that is certain to be compiled: 1 inside an include guard */
  int certain; /* the file itself is certain to be compiled */
  int comment; /* inside a block comment */
} SourceFile;

static cdl_Status flatten(Flattener *f, const char *path, const char *text, int certain);

static int was_seen(const Flattener *f, const char *path) {
  for (size_t i = 0; i < f->seen_count; i++)
    if (!strcmp(f->seen[i], path)) return 1;
  for (int i = 0; i < f->depth; i++)
    if (!strcmp(f->stack[i], path)) return 1;
  return 0;
}

/* The directive of a line: "include", "ifndef", …; *rest is what follows. NULL for other lines. */
static const char *directive(const char *line, char word[16], const char **rest) {
  while (*line == ' ' || *line == '\t') line++;
  if (*line++ != '#') return NULL;
  while (*line == ' ' || *line == '\t') line++;
  size_t n = 0;
  while (n < 15 && isalpha((unsigned char)line[n])) n++;
  memcpy(word, line, n);
  word[n] = 0;
  line += n;
  while (*line == ' ' || *line == '\t') line++;
  *rest = line;
  return word;
}

/* Whether the line ends inside a block comment. Quotes are not looked at: no include path and no
 * kernel has a comment mark in a string. */
static int comment_after(const char *line, const char *end, int inside) {
  for (; line + 1 < end; line++) {
    if (!inside && line[0] == '/' && line[1] == '/') return 0;
    if (!inside && line[0] == '/' && line[1] == '*')
      inside = 1, line++;
    else if (inside && line[0] == '*' && line[1] == '/')
      inside = 0, line++;
  }
  return inside;
}

/* A file is guarded if its first directive is #ifndef and its second defines the same name. */
static int has_guard(const char *text) {
  char word[16], name[2][MAX_PATH] = {"", ""};
  const char *rest;
  int found = 0;
  for (const char *line = text; line && found < 2; line = strchr(line, '\n')) {
    if (*line == '\n') line++;
    if (!directive(line, word, &rest)) continue;
    if (strcmp(word, found ? "define" : "ifndef")) return 0;
    sscanf(rest, "%255[A-Za-z0-9_]", name[found++]);
  }
  return found == 2 && *name[0] && !strcmp(name[0], name[1]);
}

static cdl_Status include(Flattener *f, SourceFile *file, const char *rest) {
  char path[MAX_PATH];
  if (*rest != '"' || sscanf(rest, "\"%255[^\"\n]\"", path) != 1)
    return log_fail(f->log, CDL_BAD_INPUT, "%s:%d: a kernel's #include needs a \"path\"",
                    file->path, file->line);
  if (was_seen(f, path)) {
    fputc('\n', f->out);
    return CDL_OK;
  }
  char *text = source_find(path);
  if (!text)
    return log_fail(f->log, CDL_BAD_INPUT,
                    "%s:%d: includes \"%s\", which is not in the kernels folder", file->path,
                    file->line, path);
  cdl_Status status = flatten(f, path, text, file->certain && file->nesting == file->base);
  free(text);
  fprintf(f->out, "#line %d \"%s\"\n", file->line + 1, file->path);
  return status;
}

static cdl_Status flatten_line(Flattener *f, SourceFile *file, const char *line, const char *end) {
  char word[16];
  const char *rest;
  int is_directive = !file->comment && directive(line, word, &rest);
  file->comment = comment_after(line, end, file->comment);
  if (is_directive && !strcmp(word, "include") && *rest != '<') return include(f, file, rest);
  if (is_directive && !strncmp(word, "if", 2)) file->nesting++;
  if (is_directive && !strcmp(word, "endif")) file->nesting--;
  fwrite(line, 1, end - line, f->out);
  fputc('\n', f->out);
  return CDL_OK;
}

static cdl_Status flatten(Flattener *f, const char *path, const char *text, int certain) {
  if (f->depth == MAX_DEPTH)
    return log_fail(f->log, CDL_BAD_INPUT, "%s: includes nested more than %d deep", path,
                    MAX_DEPTH);
  int guarded = has_guard(text);
  if (certain && guarded && f->seen_count < MAX_FILES)
    snprintf(f->seen[f->seen_count++], MAX_PATH, "%s", path);
  f->stack[f->depth++] = path;
  SourceFile file = {.path = path, .line = 1, .base = guarded, .certain = certain};
  fprintf(f->out, "#line 1 \"%s\"\n", path);
  cdl_Status status = CDL_OK;
  for (const char *line = text; *line && !status; file.line++) {
    const char *end = line + strcspn(line, "\n");
    status = flatten_line(f, &file, line, end);
    line = *end ? end + 1 : end;
  }
  f->depth--;
  return status;
}

cdl_Status source_flatten_text(const cdl_Log *log, const char *label, const char *source,
                               char **text) {
  *text = NULL;
  cdl_Status status = CDL_DEVICE;
  size_t size = 0;
  Flattener *f = calloc(1, sizeof *f);
  if (!f || !(f->out = open_memstream(text, &size))) {
    log_fail(log, status, "%s: not enough memory to prepare this kernel source", label);
    goto done;
  }
  f->log = log;
  status = flatten(f, label, source, 1);
done:
  if (f && f->out) fclose(f->out);
  free(f);
  if (status) {
    free(*text);
    *text = NULL;
  }
  return status;
}

cdl_Status source_flatten(const cdl_Log *log, const char *path, char **text) {
  char *source = NULL;
  *text = NULL;
  cdl_Status status = source_read(log, path, &source);
  if (!status) status = source_flatten_text(log, path, source, text);
  free(source);
  return status;
}
