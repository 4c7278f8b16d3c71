/* bsdf_plot.c: polar slices of a material: how much light from each direction goes towards wo. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "image/canvas.h"
#include "image/image_write.h"
#include "render/bsdf.h"

/* Angles of wi are even, and those of directions that were sampled, so that no lobe is too narrow
 * to be seen. */
enum { VIEWS = 4, PLANES = 2, EVEN = 1440, DRAWN = 512, ANGLES = EVEN + DRAWN, DELTAS = 4 };
enum { PANEL = 330, RADIUS = 140, HEAD = 44, CAPTION = 34, DECADES = 4 };

static const double view_degrees[VIEWS] = {0, 30, 60, 80};

typedef struct Slice {
  double angle[ANGLES];       /* of wi from the normal, away from wo, ascending */
  float value[ANGLES + 1][3]; /* f |cos| */
} Slice;

typedef struct Delta {
  double angle;
  float weight[3]; /* share included */
} Delta;

typedef struct View {
  Slice slices[PLANES]; /* along the tangent, across */
  Delta deltas[DELTAS];
  int delta_count;
  float most; /* of all values */
} View;

typedef struct Plot {
  View views[VIEWS];
  int through; /* something comes from below */
} Plot;

static const float black[3] = {0, 0, 0}, grey[3] = {0.3f, 0.3f, 0.3f},
                   pale[3] = {0.75f, 0.75f, 0.75f};

/* A direction in a plane through the normal. */
static void direction(double angle, int plane, float w[3]) {
  w[0] = plane ? 0 : (float)sin(angle);
  w[1] = plane ? (float)sin(angle) : 0;
  w[2] = (float)cos(angle);
}

static int by_value(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void add_delta(View *view, double angle, const float *weight) {
  int i = 0;
  while (i < view->delta_count && fabs(view->deltas[i].angle - angle) > 1e-3) i++;
  if (i == DELTAS) return;
  if (i == view->delta_count) view->deltas[view->delta_count++] = (Delta){.angle = angle};
  for (int c = 0; c < 3; c++) view->deltas[i].weight[c] += weight[c] / DRAWN;
}

/* Where the lobes are. */
static cdl_Status draw(cdl_Bsdf *bsdf, View *view, const float wo[3], int plane, double *angles) {
  static float drawn[DRAWN][8];
  cdl_Status status = cdl_bsdf_sample(bsdf, 1, wo, 0, DRAWN, 1, drawn[0]);
  for (int i = 0; i < DRAWN && !status; i++) {
    const double angle = atan2(drawn[i][plane], drawn[i][2]);
    angles[i] = angle;
    if (plane == 0 && drawn[i][7] > 0) add_delta(view, angle, drawn[i] + 3);
  }
  return status;
}

static cdl_Status slice(cdl_Bsdf *bsdf, View *view, double degrees, int plane) {
  static float pairs[ANGLES][6], values[ANGLES][4];
  Slice *s = &view->slices[plane];
  float wo[3];
  direction(-degrees * M_PI / 180, plane, wo);
  cdl_Status status = draw(bsdf, view, wo, plane, s->angle + EVEN);
  if (status) return status;
  for (int i = 0; i < EVEN; i++) s->angle[i] = ((i + 0.5) / EVEN * 2 - 1) * M_PI;
  qsort(s->angle, ANGLES, sizeof *s->angle, by_value);
  for (int i = 0; i < ANGLES; i++) {
    memcpy(pairs[i], wo, sizeof wo);
    direction(s->angle[i], plane, pairs[i] + 3);
  }
  status = cdl_bsdf_evaluate(bsdf, ANGLES, pairs[0], values[0]);
  for (int i = 0; i < ANGLES && !status; i++)
    for (int c = 0; c < 3; c++) {
      s->value[i][c] = values[i][c] * fabsf(pairs[i][5]);
      if (s->value[i][c] > view->most) view->most = s->value[i][c];
    }
  return status;
}

static int comes_through(const View *view) {
  int through = 0;
  for (int i = 0; i < view->delta_count; i++) through |= fabs(view->deltas[i].angle) > M_PI / 2;
  for (int p = 0; p < PLANES; p++)
    for (int i = 0; i < ANGLES; i++)
      through |= fabs(view->slices[p].angle[i]) > M_PI / 2 && view->slices[p].value[i][1] > 0;
  return through;
}

static cdl_Status measure(cdl_Bsdf *bsdf, Plot *plot) {
  cdl_Status status = CDL_OK;
  for (int v = 0; v < VIEWS && !status; v++) {
    for (int p = 0; p < PLANES && !status; p++)
      status = slice(bsdf, &plot->views[v], view_degrees[v], p);
    plot->through |= comes_through(&plot->views[v]);
  }
  return status;
}

/* --- Drawing. */

typedef struct Panel {
  Canvas *canvas;
  double x, y; /* of the surface's point */
  int logarithmic;
  float most;
} Panel;

static double radius_of(const Panel *panel, float value) {
  if (!(value > 0) || !(panel->most > 0)) return 0;
  const double share = value / (double)panel->most;
  return RADIUS * (panel->logarithmic ? fmax(1 + log10(share) / DECADES, 0) : share);
}

static void draw_slice(const Panel *panel, const Slice *s, int channel, const float color[3]) {
  double x0 = 0, y0 = 0;
  for (int i = 0; i < ANGLES; i++) {
    const double radius = radius_of(panel, s->value[i][channel]);
    const double x = panel->x + radius * sin(s->angle[i]), y = panel->y - radius * cos(s->angle[i]);
    if (i) canvas_line(panel->canvas, x0, y0, x, y, 1.2, color);
    x0 = x;
    y0 = y;
  }
}

/* Across the tangent first and pale, so that it shows where it differs; where channels agree, the
 * last one would hide the others: then all are black. */
static void draw_slices(const Panel *panel, const View *view) {
  for (int p = PLANES - 1; p >= 0; p--) {
    const Slice *s = &view->slices[p];
    float apart = 0;
    for (int i = 0; i < ANGLES; i++)
      apart = fmaxf(apart, fmaxf(fabsf(s->value[i][0] - s->value[i][1]),
                                 fabsf(s->value[i][1] - s->value[i][2])));
    const float dark = p ? 0.75f : 0;
    for (int c = 0; c < 3; c++) {
      float color[3] = {dark, dark, dark};
      if (apart > 1e-3f * panel->most) color[c] = p ? 1 : 0.7f;
      draw_slice(panel, s, c, color);
    }
  }
}

static void draw_arrow(const Panel *panel, double angle, double from, double to, double width,
                       const float color[3]) {
  const double s = sin(angle), c = cos(angle), x = panel->x + to * s, y = panel->y - to * c;
  canvas_line(panel->canvas, panel->x + from * s, panel->y - from * c, x, y, width, color);
  for (int side = -1; side <= 1; side += 2)
    canvas_line(panel->canvas, x, y, x - 9 * sin(angle + side * 0.4),
                y + 9 * cos(angle + side * 0.4), width, color);
}

static void draw_grid(const Panel *panel, int through, double degrees) {
  const double low = through ? -180 : 0, x = panel->x, y = panel->y;
  for (int i = 1; i <= DECADES; i++)
    canvas_circle(panel->canvas, x, y, RADIUS * (double)i / DECADES, low, 180, pale);
  for (int a = -90; a <= 90; a += 30) {
    const double s = sin(a * M_PI / 180) * RADIUS, c = cos(a * M_PI / 180) * RADIUS;
    canvas_line(panel->canvas, x - (through ? s : 0), y + (through ? c : 0), x + s, y - c, 0.6,
                pale);
  }
  canvas_line(panel->canvas, x - RADIUS - 12, y, x + RADIUS + 12, y, 1, grey);
  const float blue[3] = {0.1f, 0.3f, 0.8f};
  draw_arrow(panel, -degrees * M_PI / 180, 0, RADIUS + 12, 1.5, blue);
}

static void draw_deltas(const Panel *panel, const View *view) {
  const float brown[3] = {0.5f, 0.2f, 0};
  for (int i = 0; i < view->delta_count; i++) {
    const Delta *d = &view->deltas[i];
    char text[32];
    draw_arrow(panel, d->angle, 0, RADIUS, 2.5, brown);
    snprintf(text, sizeof text, "%.3f", (double)d->weight[1]);
    canvas_text(panel->canvas, panel->x + (RADIUS - 30) * sin(d->angle) + 6,
                panel->y - (RADIUS - 30) * cos(d->angle), text, brown);
  }
}

static void draw_panel(Canvas *canvas, const Plot *plot, int column, int logarithmic, int height) {
  const View *view = &plot->views[column];
  const double top = HEAD + logarithmic * height;
  Panel panel = {canvas, PANEL * (column + 0.5), top + RADIUS + 20, logarithmic, view->most};
  char text[96];
  draw_grid(&panel, plot->through, view_degrees[column]);
  if (view->most > 0) draw_slices(&panel, view);
  draw_deltas(&panel, view);
  const char *scale = logarithmic ? "4 DECADES UP TO" : "LINEAR UP TO";
  if (view->most > 0)
    snprintf(text, sizeof text, "WO %.0f DEG, %s %.3g", view_degrees[column], scale,
             (double)view->most);
  else
    snprintf(text, sizeof text, "WO %.0f DEG, %s", view_degrees[column],
             view->delta_count ? "DELTA LOBES ALONE" : "BLACK");
  canvas_text(canvas, PANEL * column + 20, top + height - CAPTION + 8, text, black);
}

static void draw_plot(Canvas *canvas, const Plot *plot, const char *name, int height) {
  char text[256];
  snprintf(text, sizeof text,
           "%s: F COS BY DIRECTION OF LIGHT; RED, GREEN, BLUE, OR BLACK WHERE ALIKE; "
           "PALE: ACROSS THE TANGENT; ARROWS: WO, AND DELTA LOBES WITH THEIR WEIGHT",
           *name ? name : "MATERIAL");
  canvas_text(canvas, 20, 16, text, black);
  for (int v = 0; v < VIEWS; v++)
    for (int logarithmic = 0; logarithmic < 2; logarithmic++)
      draw_panel(canvas, plot, v, logarithmic, height);
}

cdl_Status cdl_bsdf_plot(cdl_Bsdf *bsdf, const char *path) {
  const cdl_Log *log = bsdf_log(bsdf);
  Canvas canvas = {0};
  cdl_Status status = cdl_output_check(log, path);
  if (status) return status;
  Plot *plot = calloc(1, sizeof *plot);
  if (!plot) return log_fail(log, CDL_OUTPUT, "%s: not enough memory for a plot", path);
  status = measure(bsdf, plot);
  const int height = 20 + RADIUS * (plot->through ? 2 : 1) + 14 + CAPTION;
  if (!status) status = canvas_create(log, VIEWS * PANEL, HEAD + 2 * height, &canvas);
  if (!status) {
    draw_plot(&canvas, plot, bsdf_name(bsdf), height);
    status = image_write(log, path, canvas.width, canvas.height, canvas.rgb, NULL, NULL, 0);
  }
  canvas_free(&canvas);
  free(plot);
  return status;
}
