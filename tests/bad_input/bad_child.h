/* bad_child.h: loads a scene in a process of its own that may take 5 s and 1 GiB, and tells how it
 * ended. The 5 s are of processor time, so that other work on the machine does not count; a process
 * that waits instead is ended after a minute. Included after cmocka.h. */
#ifndef CANDELA_TESTS_BAD_CHILD_H
#define CANDELA_TESTS_BAD_CHILD_H

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scene/scene.h"

#define LIMIT_SECONDS 5
#define LIMIT_WAITING 60
#define LIMIT_BYTES ((rlim_t)1 << 30)

typedef struct Outcome {
  int status; /* of scene_load, or -signal */
  int errors; /* lines reported */
  char error[2048];
} Outcome;

static void child_log(void *user, cdl_LogLevel level, const char *message) {
  Outcome *outcome = user;
  if (level != CDL_LOG_ERROR) return;
  outcome->errors++;
  snprintf(outcome->error, sizeof outcome->error, "%s", message);
}

/* Sanitizers reserve terabytes of address space and are slow; there only waiting is limited. */
static void limit_child(void) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  struct rlimit bytes = {LIMIT_BYTES, LIMIT_BYTES}, seconds = {LIMIT_SECONDS, LIMIT_SECONDS};
  setrlimit(RLIMIT_AS, &bytes);
  setrlimit(RLIMIT_CPU, &seconds);
#endif
  alarm(LIMIT_WAITING);
}

static void __attribute__((noreturn)) run_child(const char *path, int to) {
  Outcome outcome = {0};
  cdl_Log log = {child_log, &outcome};
  struct cdl_Scene *scene = NULL;
  cdl_SceneOptions options = {.time = 0.5};
  limit_child();
  outcome.status = scene_load(&log, path, &options, &scene);
  scene_free(scene);
  if (write(to, &outcome, sizeof outcome) != sizeof outcome) _exit(99);
  _exit(0);
}

static Outcome load_in_child(const char *path) {
  Outcome outcome = {0};
  int ends[2], status = 0;
  assert_int_equal(pipe(ends), 0);
  pid_t child = fork();
  if (child == 0) run_child(path, ends[1]);
  close(ends[1]);
  ssize_t got = read(ends[0], &outcome, sizeof outcome);
  close(ends[0]);
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status))
    outcome.status = -WTERMSIG(status);
  else if (WEXITSTATUS(status) || got != sizeof outcome)
    outcome.status = -1;
  return outcome;
}

/* Whether a file was refused as it must be: one line, with a code when one is asked for. */
static inline int is_refused(const char *path, const char *code) {
  Outcome outcome = load_in_child(path);
  char wanted[128];
  snprintf(wanted, sizeof wanted, ": %s: ", code ? code : "");
  int named = strstr(outcome.error, path) && (!code || strstr(outcome.error, wanted));
  if (outcome.status == CDL_BAD_INPUT && outcome.errors == 1 && named) return 1;
  print_message("%s: status %d, %d errors, %s: %s\n", path, outcome.status, outcome.errors,
                code ? code : "any code", outcome.error);
  return 0;
}

static inline int is_accepted(const char *path) {
  Outcome outcome = load_in_child(path);
  if (outcome.status == CDL_OK && outcome.errors == 0) return 1;
  print_message("%s: status %d: %s\n", path, outcome.status, outcome.error);
  return 0;
}

#endif
