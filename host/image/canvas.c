#include "image/canvas.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"

cdl_Status canvas_create(const cdl_Log *log, int width, int height, Canvas *canvas) {
  const size_t values = (size_t)width * (size_t)height * 3;
  *canvas = (Canvas){width, height, malloc(values * sizeof(float))};
  if (!canvas->rgb)
    return log_fail(log, CDL_OUTPUT, "not enough memory for a picture of %dx%d", width, height);
  for (size_t i = 0; i < values; i++) canvas->rgb[i] = 1;
  return CDL_OK;
}

void canvas_free(Canvas *canvas) {
  free(canvas->rgb);
  *canvas = (Canvas){0};
}

static void blend(Canvas *canvas, int x, int y, double coverage, const float color[3]) {
  float *pixel = canvas->rgb + 3 * ((size_t)y * (size_t)canvas->width + (size_t)x);
  for (int c = 0; c < 3; c++) pixel[c] += (float)coverage * (color[c] - pixel[c]);
}

static int clamp(double value, int most) {
  return value < 0 ? 0 : value > most ? most : (int)value;
}

void canvas_line(Canvas *canvas, double x0, double y0, double x1, double y1, double width,
                 const float color[3]) {
  const double dx = x1 - x0, dy = y1 - y0, length2 = dx * dx + dy * dy, reach = 0.5 * width + 0.5;
  const int left = clamp(fmin(x0, x1) - reach, canvas->width);
  const int right = clamp(fmax(x0, x1) + reach + 1, canvas->width);
  const int top = clamp(fmin(y0, y1) - reach, canvas->height);
  const int bottom = clamp(fmax(y0, y1) + reach + 1, canvas->height);
  for (int y = top; y < bottom; y++)
    for (int x = left; x < right; x++) {
      const double px = x + 0.5 - x0, py = y + 0.5 - y0;
      double t = length2 > 0 ? (px * dx + py * dy) / length2 : 0;
      t = fmin(fmax(t, 0), 1);
      const double coverage = reach - hypot(px - t * dx, py - t * dy);
      if (coverage > 0) blend(canvas, x, y, fmin(coverage, 1), color);
    }
}

void canvas_circle(Canvas *canvas, double x, double y, double radius, double from_degrees,
                   double to_degrees, const float color[3]) {
  enum { PIECES = 90 };
  const double from = from_degrees * M_PI / 180, step = (to_degrees - from_degrees) * M_PI / 180;
  for (int i = 0; i < PIECES; i++) {
    const double a = from + step * i / PIECES, b = from + step * (i + 1) / PIECES;
    canvas_line(canvas, x + radius * cos(a), y - radius * sin(a), x + radius * cos(b),
                y - radius * sin(b), 1, color);
  }
}

/* --- Letters: five columns of seven bits, the top bit first. */

static const char letters[] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ.,:;+-/()=";

static const unsigned char columns[][5] = {
    {0x3e, 0x45, 0x49, 0x51, 0x3e}, {0x00, 0x21, 0x7f, 0x01, 0x00}, {0x21, 0x43, 0x45, 0x49, 0x31},
    {0x42, 0x41, 0x51, 0x69, 0x46}, {0x0c, 0x14, 0x24, 0x7f, 0x04}, {0x72, 0x51, 0x51, 0x51, 0x4e},
    {0x1e, 0x29, 0x49, 0x49, 0x06}, {0x40, 0x47, 0x48, 0x50, 0x60}, {0x36, 0x49, 0x49, 0x49, 0x36},
    {0x30, 0x49, 0x49, 0x4a, 0x3c}, {0x3f, 0x44, 0x44, 0x44, 0x3f}, {0x7f, 0x49, 0x49, 0x49, 0x36},
    {0x3e, 0x41, 0x41, 0x41, 0x22}, {0x7f, 0x41, 0x41, 0x22, 0x1c}, {0x7f, 0x49, 0x49, 0x49, 0x41},
    {0x7f, 0x48, 0x48, 0x48, 0x40}, {0x3e, 0x41, 0x49, 0x49, 0x2f}, {0x7f, 0x08, 0x08, 0x08, 0x7f},
    {0x00, 0x41, 0x7f, 0x41, 0x00}, {0x02, 0x01, 0x41, 0x7e, 0x40}, {0x7f, 0x08, 0x14, 0x22, 0x41},
    {0x7f, 0x01, 0x01, 0x01, 0x01}, {0x7f, 0x20, 0x18, 0x20, 0x7f}, {0x7f, 0x10, 0x08, 0x04, 0x7f},
    {0x3e, 0x41, 0x41, 0x41, 0x3e}, {0x7f, 0x48, 0x48, 0x48, 0x30}, {0x3e, 0x41, 0x45, 0x42, 0x3d},
    {0x7f, 0x48, 0x4c, 0x4a, 0x31}, {0x31, 0x49, 0x49, 0x49, 0x46}, {0x40, 0x40, 0x7f, 0x40, 0x40},
    {0x7e, 0x01, 0x01, 0x01, 0x7e}, {0x7c, 0x02, 0x01, 0x02, 0x7c}, {0x7e, 0x01, 0x0e, 0x01, 0x7e},
    {0x63, 0x14, 0x08, 0x14, 0x63}, {0x70, 0x08, 0x07, 0x08, 0x70}, {0x43, 0x45, 0x49, 0x51, 0x61},
    {0x00, 0x03, 0x03, 0x00, 0x00}, {0x00, 0x05, 0x06, 0x00, 0x00}, {0x00, 0x36, 0x36, 0x00, 0x00},
    {0x00, 0x35, 0x36, 0x00, 0x00}, {0x08, 0x08, 0x3e, 0x08, 0x08}, {0x08, 0x08, 0x08, 0x08, 0x08},
    {0x02, 0x04, 0x08, 0x10, 0x20}, {0x00, 0x1c, 0x22, 0x41, 0x00}, {0x00, 0x41, 0x22, 0x1c, 0x00},
    {0x14, 0x14, 0x14, 0x14, 0x14},
};

static void draw_letter(Canvas *canvas, int x, int y, const unsigned char *letter,
                        const float color[3]) {
  for (int column = 0; column < 5; column++)
    for (int row = 0; row < CANVAS_LETTER_HEIGHT; row++) {
      const int px = x + column, py = y + row, set = letter[column] >> (6 - row) & 1;
      if (set && px >= 0 && py >= 0 && px < canvas->width && py < canvas->height)
        blend(canvas, px, py, 1, color);
    }
}

void canvas_text(Canvas *canvas, double x, double y, const char *text, const float color[3]) {
  for (int i = 0; text[i]; i++) {
    const char *at = strchr(letters, toupper((unsigned char)text[i]));
    if (at && *at)
      draw_letter(canvas, (int)x + CANVAS_LETTER_WIDTH * i, (int)y, columns[at - letters], color);
  }
}
