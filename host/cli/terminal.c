/* Messages, the progress line, and signals. */
#include "cli/cli.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "core/clock.h"
#include "core/log.h"

enum { BAR = 24, REFRESH_HZ = 10 };

int cli_quiet;

static int line_shown;

static int shows_progress(void) {
  static int terminal = -1;
  if (terminal < 0) terminal = isatty(STDERR_FILENO);
  return terminal && !cli_quiet;
}

void cli_progress_erase(void) {
  if (!line_shown) return;
  fputs("\r\033[K", stderr);
  fflush(stderr);
  line_shown = 0;
}

static void write_message(void *user, cdl_LogLevel level, const char *message) {
  (void)user;
  if (level == CDL_LOG_NOTE && cli_quiet) return;
  cli_progress_erase();
  fprintf(stderr, "candela: %s%s\n", level == CDL_LOG_WARNING ? "warning: " : "", message);
}

const cdl_Log cli_log = {write_message, NULL};

cdl_Status cli_flush(void) {
  static int told;
  if (!fflush(stdout) && !ferror(stdout)) return CDL_OK;
  if (!told++)
    log_fail(&cli_log, CDL_OUTPUT, "standard output: could not be written: %s", strerror(errno));
  return CDL_OUTPUT;
}

cdl_Status cli_print(char *text) {
  if (!text) return log_fail(&cli_log, CDL_OUTPUT, "not enough memory for what is to be printed");
  fputs(text, stdout);
  free(text);
  return cli_flush();
}

static void show_line(const char *line) {
  fprintf(stderr, "\r\033[K%s", line);
  fflush(stderr);
  line_shown = 1;
}

void cli_progress_stage(void *user, const char *what, uint64_t done, uint64_t total) {
  char line[80];
  (void)user;
  if (!shows_progress()) return;
  snprintf(line, sizeof line, "%.48s, %llu of %llu", what, (unsigned long long)done,
           (unsigned long long)total);
  show_line(line);
}

static void format_time(double seconds, char text[24]) {
  const unsigned long s = seconds < 3.6e8 ? (unsigned long)(seconds + 0.5) : 359999999ul;
  if (s < 3600)
    snprintf(text, 24, "%lu:%02lu", s / 60, s % 60);
  else
    snprintf(text, 24, "%lu:%02lu:%02lu", s / 3600, s / 60 % 60, s % 60);
}

void cli_progress_samples(uint64_t done, uint64_t total, double seconds, double time_limit) {
  static double last;
  const double now = clock_now();
  if (!shows_progress() || !total || now < last + 1.0 / REFRESH_HZ) return;
  last = now;
  double part = (double)done / (double)total;
  double left = done ? seconds * (1 - part) / part : 0;
  if (time_limit > 0 && seconds / time_limit > part) part = seconds / time_limit;
  if (time_limit > 0 && left > time_limit - seconds) left = time_limit - seconds;
  if (part > 1) part = 1;
  char bar[BAR + 1], time[24], line[100];
  const int filled = (int)(part * BAR);
  memset(bar, '-', BAR);
  memset(bar, '#', (size_t)filled);
  bar[BAR] = 0;
  format_time(left > 0 ? left : 0, time);
  snprintf(line, sizeof line, "%3d %% [%s] %.3g Msamples/s, %s left", (int)(100 * part), bar,
           seconds > 0 ? 1e-6 * (double)done / seconds : 0, done ? time : "?");
  show_line(line);
}

/* Those who stop jobs may send a signal twice, to the program and to its group. */
#define SIGNAL_AGAIN_SECONDS 1

static volatile sig_atomic_t interrupted;

static void on_signal(int number) {
  static struct timespec first;
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (!interrupted) first = now;
  interrupted = number;
  if (now.tv_sec - first.tv_sec <= SIGNAL_AGAIN_SECONDS) return;
  signal(number, SIG_DFL);
  raise(number);
}

void cli_catch_signals(void) {
  signal(SIGINT, on_signal);
  signal(SIGTERM, on_signal);
}

int cli_interrupted(void) { return interrupted != 0; }
