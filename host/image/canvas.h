/* canvas.h: lines and small letters on a picture, for plots. */
#ifndef CANDELA_IMAGE_CANVAS_H
#define CANDELA_IMAGE_CANVAS_H

#include "candela.h"

typedef struct Canvas {
  int width, height;
  float *rgb; /* height x width x 3, linear, rows from the top */
} Canvas;

enum { CANVAS_LETTER_WIDTH = 6, CANVAS_LETTER_HEIGHT = 7 }; /* pixels, the gap behind included */

/* White; free with canvas_free(). CDL_OUTPUT if memory is short. */
cdl_Status canvas_create(const cdl_Log *log, int width, int height, Canvas *canvas);
void canvas_free(Canvas *canvas);

/* A line of `width` pixels with soft edges; what lies beyond the picture is left out. x goes right,
 * y down, pixel centres at halves. */
void canvas_line(Canvas *canvas, double x0, double y0, double x1, double y1, double width,
                 const float color[3]);

void canvas_circle(Canvas *canvas, double x, double y, double radius, double from_degrees,
                   double to_degrees, const float color[3]);

/* Letters, figures and . , : ; + - / ( ) = in capitals, blanks for all others; x, y is the upper
 * left corner. */
void canvas_text(Canvas *canvas, double x, double y, const char *text, const float color[3]);

#endif
