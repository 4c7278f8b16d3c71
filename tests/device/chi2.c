#include "tests/device/chi2.h"

#include <math.h>
#include <stdlib.h>

enum { MIN_EXPECTED = 5, MAX_DEPTH = 10 };

/* Upper regularised incomplete gamma function Q(a, x): series below a + 1, continued fraction
 * (modified Lentz) above. */
static double gamma_q(double a, double x) {
  double scale = exp(a * log(x) - x - lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10000 && term > 1e-15 * sum; n++) sum += term *= x / (a + n);
    return 1 - scale * sum;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int n = 1; n < 10000; n++) {
    double an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= c * d;
    if (fabs(c * d - 1) < 1e-15) break;
  }
  return scale * h;
}

double chi2_p_value(double statistic, int degrees) {
  return statistic > 0 ? gamma_q(0.5 * degrees, 0.5 * statistic) : 1;
}

typedef struct Cell {
  double observed, expected;
} Cell;

static int by_expected(const void *a, const void *b) {
  double x = ((const Cell *)a)->expected, y = ((const Cell *)b)->expected;
  return (x > y) - (x < y);
}

double chi2_test(const double *observed, const double *expected, size_t cells) {
  Cell *sorted = calloc(cells, sizeof *sorted);
  if (!sorted) return 0;
  for (size_t i = 0; i < cells; i++) sorted[i] = (Cell){observed[i], fmax(expected[i], 0)};
  qsort(sorted, cells, sizeof *sorted, by_expected);
  double statistic = 0;
  int used = 0;
  Cell pool = {0, 0};
  for (size_t i = 0; i < cells; i++) {
    pool.observed += sorted[i].observed;
    pool.expected += sorted[i].expected;
    if (pool.expected < MIN_EXPECTED) continue;
    double difference = pool.observed - pool.expected;
    statistic += difference * difference / pool.expected;
    used++;
    pool = (Cell){0, 0};
  }
  free(sorted);
  return used < 2 ? 1 : chi2_p_value(statistic, used - 1);
}

double chi2_threshold(size_t tests) { return 1 - pow(0.99, 1.0 / (double)tests); }

/* Gauss and Legendre, 4 x 4 points */
static double gauss(Chi2Density density, const void *context, const double x[2],
                    const double y[2]) {
  static const double nodes[4] = {-0.861136311594053, -0.339981043584856, 0.339981043584856,
                                  0.861136311594053};
  static const double weights[4] = {0.347854845137454, 0.652145154862546, 0.652145154862546,
                                    0.347854845137454};
  double hx = 0.5 * (x[1] - x[0]), hy = 0.5 * (y[1] - y[0]), sum = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      sum += weights[i] * weights[j] *
             density(context, x[0] + hx * (1 + nodes[i]), y[0] + hy * (1 + nodes[j]));
  return sum * hx * hy;
}

/* Whether the edge of the density's support cuts the cell, as far as its corners tell. */
static int has_edge(Chi2Density density, const void *context, const double x[2],
                    const double y[2]) {
  int inside = 0;
  for (int i = 0; i < 4; i++) inside += density(context, x[i & 1], y[i >> 1]) > 0;
  return inside > 0 && inside < 4;
}

/* Nodes may all lie on one side of an edge, so a cell with one is cut until its mass is nothing. */
static double refine(Chi2Density density, const void *context, const double x[2], const double y[2],
                     double whole, double tolerance, int depth) {
  double mx = 0.5 * (x[0] + x[1]), my = 0.5 * (y[0] + y[1]);
  double xs[2][2] = {{x[0], mx}, {mx, x[1]}}, ys[2][2] = {{y[0], my}, {my, y[1]}};
  double parts[4], sum = 0;
  for (int i = 0; i < 4; i++) sum += parts[i] = gauss(density, context, xs[i & 1], ys[i >> 1]);
  if (depth == MAX_DEPTH || sum + whole < tolerance) return sum;
  if (fabs(sum - whole) < tolerance && !has_edge(density, context, x, y)) return sum;
  sum = 0;
  for (int i = 0; i < 4; i++)
    sum += refine(density, context, xs[i & 1], ys[i >> 1], parts[i], tolerance, depth + 1);
  return sum;
}

double chi2_integrate(Chi2Density density, const void *context, const double x[2],
                      const double y[2], double tolerance) {
  return refine(density, context, x, y, gauss(density, context, x, y), tolerance, 0);
}
