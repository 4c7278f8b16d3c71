#include "scene/matrix.h"

#include <math.h>

Matrix matrix_identity(void) { return (Matrix){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}; }

Matrix matrix_multiply(const Matrix *a, const Matrix *b) {
  Matrix c;
  for (int r = 0; r < 3; r++)
    for (int k = 0; k < 4; k++)
      c.m[4 * r + k] = a->m[4 * r] * b->m[k] + a->m[4 * r + 1] * b->m[4 + k] +
                       a->m[4 * r + 2] * b->m[8 + k] + (k == 3 ? a->m[4 * r + 3] : 0);
  return c;
}

Matrix matrix_from_trs(const double translation[3], const double rotation[4],
                       const double scale[3]) {
  double x = rotation[0], y = rotation[1], z = rotation[2], w = rotation[3];
  double n = x * x + y * y + z * z + w * w, s = n > 0 ? 2 / n : 0;
  double r[9] = {1 - s * (y * y + z * z), s * (x * y - z * w),     s * (x * z + y * w),
                 s * (x * y + z * w),     1 - s * (x * x + z * z), s * (y * z - x * w),
                 s * (x * z - y * w),     s * (y * z + x * w),     1 - s * (x * x + y * y)};
  Matrix a;
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) a.m[4 * i + k] = r[3 * i + k] * scale[k];
    a.m[4 * i + 3] = translation[i];
  }
  return a;
}

Matrix matrix_from_columns(const double columns[16]) {
  Matrix a;
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 4; c++) a.m[4 * r + c] = columns[4 * c + r];
  return a;
}

void matrix_to_float(const Matrix *a, float out[12]) {
  for (int i = 0; i < 12; i++) out[i] = (float)a->m[i];
}

void matrix_apply(const Matrix *a, const double in[3], double w, double out[3]) {
  for (int r = 0; r < 3; r++)
    out[r] = a->m[4 * r] * in[0] + a->m[4 * r + 1] * in[1] + a->m[4 * r + 2] * in[2] +
             a->m[4 * r + 3] * w;
}

void matrix_cofactors(const Matrix *a, double out[9]) {
  const double *m = a->m;
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) {
      int r1 = 4 * ((r + 1) % 3), r2 = 4 * ((r + 2) % 3), c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      out[3 * r + c] = m[r1 + c1] * m[r2 + c2] - m[r1 + c2] * m[r2 + c1];
    }
}

int matrix_invert(const Matrix *a, Matrix *inverse) {
  double cofactors[9], determinant = 0;
  matrix_cofactors(a, cofactors);
  for (int c = 0; c < 3; c++) determinant += a->m[c] * cofactors[c];
  *inverse = (Matrix){{0}};
  if (!isnormal(determinant)) return 0;
  for (int r = 0; r < 3; r++) {
    double moved = 0;
    for (int c = 0; c < 3; c++) {
      inverse->m[4 * r + c] = cofactors[3 * c + r] / determinant;
      moved -= inverse->m[4 * r + c] * a->m[4 * c + 3];
    }
    inverse->m[4 * r + 3] = moved;
  }
  return 1;
}
