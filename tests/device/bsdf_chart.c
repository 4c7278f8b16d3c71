#include "tests/device/bsdf_chart.h"

#include <math.h>

enum { MAX_DEPTH = 6 };

void bsdf_chart_init(BsdfChart *chart, const double middle[3], double width) {
  double length = sqrt(middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2]);
  double z[3] = {middle[0] / length, middle[1] / length, middle[2] / length};
  double t = hypot(z[0], z[1]), x[3] = {t > 0 ? -z[1] / t : 1, t > 0 ? z[0] / t : 0, 0};
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    chart->axes[0][i] = x[i];
    chart->axes[1][i] = z[j] * x[k] - z[k] * x[j];
    chart->axes[2][i] = z[i];
  }
  chart->aspect = fmin(fmax(z[2], width), 1);
  double least = width * fmax(z[2], 1e-3); /* where it grazes, it is narrow near the horizon */
  chart->spread = fmin(2 * least * least, 1);
  chart->range = log1p((1 + t) / chart->spread); /* the farthest point of the horizon */
}

BsdfChartSetup bsdf_chart_setup(const BsdfChart *chart) {
  BsdfChartSetup setup = {.spread = (float)chart->spread,
                          .inverse_aspect = (float)(1 / chart->aspect),
                          .inverse_range = (float)(1 / chart->range)};
  for (int i = 0; i < 9; i++) setup.axes[i] = (float)chart->axes[i / 3][i % 3];
  return setup;
}

/* The direction at a chart's angle, from upwards, on a ring; returns the angle's Jacobian. */
static double direction(const BsdfChart *c, double s, double angle, double w[3]) {
  double sine = c->aspect * sin(angle), cosine = cos(angle), side2 = sine * sine + cosine * cosine;
  double scale = sqrt(fmax(s * (2 - s), 0) / side2);
  double l[3] = {-scale * sine, scale * cosine, 1 - s};
  for (int i = 0; i < 3; i++)
    w[i] = l[0] * c->axes[0][i] + l[1] * c->axes[1][i] + l[2] * c->axes[2][i];
  if (c->below) w[2] = -w[2];
  return c->aspect / side2;
}

static double density_at(const BsdfChart *c, double s, double angle) {
  double w[3], jacobian = direction(c, s, angle, w);
  return c->density(c->context, w) * (c->spread + s) * jacobian;
}

static const double nodes[4] = {-0.861136311594053, -0.339981043584856, 0.339981043584856,
                                0.861136311594053};
static const double weights[4] = {0.347854845137454, 0.652145154862546, 0.652145154862546,
                                  0.347854845137454};

static double distance(const BsdfChart *c, double x) { return c->spread * expm1(x * c->range); }

/* Where a ring meets the horizon, +-the angle: 0 if it is below, pi if above. */
static double horizon(const BsdfChart *c, double s) {
  double radius = sqrt(fmax(s * (2 - s), 0));
  double rise = radius * c->axes[1][2], level = (1 - s) * c->axes[2][2];
  if (level <= -rise) return 0;
  if (fabs(level) >= rise) return M_PI;
  double cosine = -level / rise;
  return atan2(sqrt(1 - cosine * cosine), c->aspect * cosine);
}

static double angle_of(double y) { return 2 * M_PI * (y - 0.5); }

/* Whether the horizon runs through a cell, which is on one side of y = 1/2. */
static int has_horizon(const BsdfChart *c, double x0, double x1, double y0, double y1) {
  double a = fabs(angle_of(y0)), b = fabs(angle_of(y1));
  double e0 = horizon(c, distance(c, x0)), e1 = horizon(c, distance(c, x1));
  return fmax(e0, e1) > fmin(a, b) && fmin(e0, e1) < fmax(a, b);
}

/* Gauss and Legendre, 4 x 4 points; x in [0,1], y in turns. */
static double gauss(const BsdfChart *c, double x0, double x1, double y0, double y1) {
  double hx = 0.5 * (x1 - x0), sum = 0;
  for (int i = 0; i < 4; i++) {
    double s = distance(c, x0 + hx * (1 + nodes[i])), line = 0;
    double end = horizon(c, s);
    double low = fmax(angle_of(y0), -end), high = fmin(angle_of(y1), end);
    double hy = 0.5 * (high - low);
    if (hy <= 0) continue;
    for (int j = 0; j < 4; j++) line += weights[j] * density_at(c, s, low + hy * (1 + nodes[j]));
    sum += weights[i] * hy * line;
  }
  return sum * hx * c->range;
}

/* Whether the chart's edge runs through a cell, as far as nine of its points tell. */
static int has_edge(const BsdfChart *c, double x0, double x1, double y0, double y1) {
  int above = 0;
  for (int i = 0; i < 9; i++) {
    double x = x0 + 0.5 * (i % 3) * (x1 - x0), y = y0 + 0.5 * (int)(i / 3) * (y1 - y0), w[3];
    direction(c, distance(c, x), angle_of(y), w);
    above += w[0] * c->edge[0] + w[1] * c->edge[1] + w[2] * c->edge[2] > 0;
  }
  return above > 0 && above < 9;
}

static int is_cut(const BsdfChart *c, double x0, double x1, double y0, double y1) {
  return has_horizon(c, x0, x1, y0, y1) || (c->edge[2] > 0 && has_edge(c, x0, x1, y0, y1));
}

static double refine(const BsdfChart *c, double x0, double x1, double y0, double y1, double whole,
                     int depth) {
  double xs[3] = {x0, 0.5 * (x0 + x1), x1}, ys[3] = {y0, 0.5 * (y0 + y1), y1};
  double parts[4], sum = 0;
  for (int i = 0; i < 4; i++)
    sum += parts[i] = gauss(c, xs[i & 1], xs[(i & 1) + 1], ys[i >> 1], ys[(i >> 1) + 1]);
  int done = fabs(sum - whole) <= fmax(3e-4 * sum, 2e-7);
  if (depth == MAX_DEPTH || (done && !(depth < c->horizon_depth && is_cut(c, x0, x1, y0, y1))))
    return sum;
  sum = 0;
  for (int i = 0; i < 4; i++)
    sum += refine(c, xs[i & 1], xs[(i & 1) + 1], ys[i >> 1], ys[(i >> 1) + 1], parts[i], depth + 1);
  return sum;
}

static double piece(const BsdfChart *c, double x0, double x1, double y0, double y1) {
  return refine(c, x0, x1, y0, y1, gauss(c, x0, x1, y0, y1), 0);
}

double bsdf_chart_integrate(const BsdfChart *chart, double cells[BSDF_CELLS]) {
  double total = 0;
  /* The ring that touches the horizon divides the cells that it runs through. */
  double touch = log1p((1 - chart->axes[1][2]) / chart->spread) / chart->range;
#pragma omp parallel for schedule(dynamic, 16) reduction(+ : total)
  for (unsigned i = 0; i < BSDF_CELLS; i++) {
    double x0 = (double)(i / BSDF_CELLS_Y) / BSDF_CELLS_X, x1 = x0 + 1.0 / BSDF_CELLS_X;
    double y0 = (double)(i % BSDF_CELLS_Y) / BSDF_CELLS_Y, y1 = y0 + 1.0 / BSDF_CELLS_Y;
    double middle = touch > x0 && touch < x1 ? touch : x1;
    cells[i] = piece(chart, x0, middle, y0, y1);
    if (middle < x1) cells[i] += piece(chart, middle, x1, y0, y1);
    total += cells[i];
  }
  return total;
}
