#include "tests/device/bsdf_lobes.h"

#include <math.h>

#include "bsdf/dispersion.h"

/* cosine and azimuth */
static const double views[BSDF_VIEWS][2] = {{1, 0},    {0.8, 0.4}, {0.4, 2.1},
                                            {0.08, 4}, {0.6, 5.2}, {0.0017453, 1.1}};

double bsdf_view_cosine(size_t view) { return views[view][0]; }

/* Slopes that single precision tells apart, in widths of the lobe. */
static double graininess(const BsdfCase *c, double cosine) { return 3e-8 / (cosine * c->width); }

vec3 bsdf_view(const BsdfCase *c, size_t view) {
  double sine = sqrt(1 - views[view][0] * views[view][0]), rounded = (float)sine;
  if (graininess(c, views[view][0]) > 0.005)
    return v3((float)sine, 0, (float)sqrt(1 - rounded * rounded));
  return v3((float)(sine * cos(views[view][1])), (float)(sine * sin(views[view][1])),
            (float)views[view][0]);
}

/* Cauchy's two terms through the index of line d and Abbe's number of d, F and C, at the wavelength
 * in um that the number in [0,1) stands for. */
static double dispersed(double ior, double abbe, double wavelength) {
  double blue = 1 / (0.4861327 * 0.4861327), red = 1 / (0.6562725 * 0.6562725);
  double slope = (ior - 1) / abbe / (blue - red);
  return ior + slope * (1 / (wavelength * wavelength) - 1 / (0.5875618 * 0.5875618));
}

double bsdf_eta_of(const BsdfCase *c) {
  double ior = c->eta <= 0 ? 1 : (double)c->eta;
  if (c->abbe > 0)
    ior = dispersed(ior, c->abbe, (double)dispersion_wavelength(c->channel, c->wavelength));
  return c->inside ? 1 / ior : ior;
}

static double density(const void *context, const double w[3]) {
  const BsdfLobes *l = context;
  vec3 wi = v3((float)w[0], (float)w[1], (float)w[2]);
  return l->model->evaluate(l->params, l->wo, wi).pdf;
}

/* Cubic, through 4 values at 0 to 3. */
static double cubic(const double f[4], double t) {
  double a = t * (t - 1), b = (t - 2) * (t - 3);
  return (t - 1) * b * f[0] / -6 + t * b * f[1] / 2 - a * (t - 3) * f[2] / 2 +
         a * (t - 2) * f[3] / 6;
}

/* Where the half vector of a narrow lobe is a small difference along X, rounding of x blurs it by a
 * part of its width. So its logarithm is interpolated between directions whose x single precision
 * holds exactly; y and z are small, and precise as they are. */
static double narrow_density(const void *context, const double w[3]) {
  const double step = ldexp(1, -24); /* between floats below 1 */
  double at = (1 - fabs(w[0])) / step, logs[4];
  double first = floor(at) - 1, horizon = w[1] * w[1] / (2 * step);
  if (fabs(w[0]) < 0.99 || first <= horizon) return density(context, w);
  for (int i = 0; i < 4; i++) {
    double x = 1 - (first + i) * step;
    double near[3] = {copysign(x, w[0]), w[1], sqrt(fmax(1 - x * x - w[1] * w[1], 0))};
    double pdf = density(context, near);
    if (!(pdf > 0)) return density(context, w);
    logs[i] = log(pdf);
  }
  return exp(cubic(logs, at - first));
}

/* Where the middle of the lobe is reflected totally, what gets through are its outskirts, along the
 * horizon opposite of wo. Views that graze pass straight through facets that stand upright as well,
 * in a strip as thin as they graze. */
static void init_below(BsdfChart *chart, const BsdfCase *c, vec3 wo) {
  double eta = bsdf_eta_of(c), z2 = 1 - (1 - (double)wo.z * wo.z) / (eta * eta);
  double through[3] = {-wo.x / eta, -wo.y / eta, z2 > 0 ? sqrt(z2) : 0.1};
  double bend = fmin(fmax(fabs(eta - 1) / fmax(eta, 1), 0.01), 1);
  double width = c->width * (eta == 1 ? 1 : bend);
  bsdf_chart_init(chart, through, z2 > 0 ? width : 0.3);
}

void bsdf_lobes_init(BsdfLobes *l, const BsdfCase *c, BsdfPoint point, vec3 wo) {
  l->model = &bsdf_models[c->model];
  l->model->prepare(l->params, point, (const uint *)c->words);
  l->wo = wo;
  const double middles[3][3] = {{-wo.x, -wo.y, wo.z}, {0, 0, 1}, {wo.x, wo.y, wo.z}};
  bsdf_chart_init(&l->charts[0], middles[c->center], c->width);
  init_below(&l->charts[1], c, wo);
  const double coat[3] = {point.coat_normal.x, point.coat_normal.y, point.coat_normal.z};
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < 3 && coat[2] < 1; k++) l->charts[i].edge[k] = coat[k];
    l->charts[i].density = i == 0 && graininess(c, wo.z) > 0.05 ? narrow_density : density;
    l->charts[i].context = l;
    l->charts[i].below = i;
    l->charts[i].horizon_depth = i == 1 && bsdf_eta_of(c) < 1 && wo.z < 0.01f ? 6 : 3;
  }
}
