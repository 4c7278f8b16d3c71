/* cli.h: what the subcommands share. One file per subcommand, each a thin caller of candela.h.
 *
 * Diagnostics go to standard error, data to standard output. The exit status is a cdl_Status. */
#ifndef CANDELA_CLI_CLI_H
#define CANDELA_CLI_CLI_H

#include <argp.h>
#include <stdint.h>

#include "candela.h"

/* The subcommands: argv[0] is "candela NAME"; what they return is the exit status. */
int cli_render(int argc, char **argv);
int cli_devices(int argc, char **argv);
int cli_info(int argc, char **argv);
int cli_merge(int argc, char **argv);
int cli_compare(int argc, char **argv);
int cli_bsdf(int argc, char **argv);

/* Parses a subcommand's arguments. Arguments that the table does not know, or that lack a value,
 * end the program with status 2 and one line that names the closest option; --help prints and ends
 * it with 0. argp->parser is called for the rest and ends the program by cli_usage() itself. */
void cli_parse(const struct argp *argp, int argc, char **argv, void *input);

/* Ends the program with status 2 after the line "candela NAME: message". The names come from the
 * last cli_parse. */
void cli_usage(const char *format, ...) __attribute__((noreturn, format(printf, 1, 2)));

/* Numbers as written in full, and within the range; else cli_usage with the option's name and the
 * value. No signs, blanks, hexadecimal or trailing characters; reals are finite. */
uint32_t cli_uint(const char *option, const char *text, uint32_t least, uint32_t most);
double cli_real(const char *option, const char *text, double least, double most);

/* `count` numbers separated by `separator`: "640x480" or "1,0.5,0". */
void cli_uints(const char *option, const char *text, char separator, int count, uint32_t *values);
void cli_reals(const char *option, const char *text, char separator, int count, double least,
               double most, double *values);

/* The index in `names`, which a NULL ends; else cli_usage with all the names. */
int cli_choice(const char *option, const char *text, const char *const *names);

/* The name that is most like `text`, or NULL if none is close. */
const char *cli_closest(const char *text, const char *const *names);

/* Prints messages to standard error, each on a line "candela: …"; no notes if
 * cli_quiet is set. A progress line is erased first. */
extern const cdl_Log cli_log;
extern int cli_quiet;

/* Makes sure that what was printed on standard output is there: CDL_OUTPUT, reported once, if not.
 */
cdl_Status cli_flush(void);

/* Prints what the library told, a text that is freed here (NULL: memory was short), on standard
 * output. CDL_OUTPUT, reported, if that cannot be written. */
cdl_Status cli_print(char *text);

/* A line on standard error that replaces the one before; nothing is shown where standard error is
 * no terminal or cli_quiet is set. */
void cli_progress_stage(void *user, const char *what, uint64_t done, uint64_t total);
void cli_progress_samples(uint64_t done, uint64_t total, double seconds, double time_limit);
void cli_progress_erase(void);

/* From now on SIGINT and SIGTERM set the flag that cli_interrupted() returns; another one, more
 * than a second later, ends the program at once. */
void cli_catch_signals(void);
int cli_interrupted(void);

#endif
