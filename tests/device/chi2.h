/* chi2.h: does a sampler follow its density? Pearson's chi-squared test, shared by device tests. */
#ifndef CANDELA_TESTS_CHI2_H
#define CANDELA_TESTS_CHI2_H

#include <stddef.h>

/* Probability of a statistic at least as large with that many degrees of freedom. */
double chi2_p_value(double statistic, int degrees);

/* p-value of observed counts against expected ones, both summing to the same; cells are pooled, the
 * smallest first, until each expects at least 5. 0 where something was seen that cannot be; 1 where
 * fewer than two cells are left. */
double chi2_test(const double *observed, const double *expected, size_t cells);

/* The least p-value that passes where `tests` of them are made and all must pass, with a chance of
 * 1 % for a false alarm (Sidak). */
double chi2_threshold(size_t tests);

/* Integral of a density over [x0,x1] x [y0,y1], refined until it changes by less than `tolerance`.
 */
typedef double (*Chi2Density)(const void *context, double x, double y);
double chi2_integrate(Chi2Density density, const void *context, const double x[2],
                      const double y[2], double tolerance);

#endif
