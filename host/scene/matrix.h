/* matrix.h: affine 3x4 matrices in double, row-major, the last column the translation. */
#ifndef CANDELA_SCENE_MATRIX_H
#define CANDELA_SCENE_MATRIX_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct Matrix {
  double m[12];
} Matrix;

Matrix matrix_identity(void);

/* a b: b is applied first. */
Matrix matrix_multiply(const Matrix *a, const Matrix *b);

/* From glTF's translation, rotation (a quaternion x, y, z, w of any length but 0) and scale. */
Matrix matrix_from_trs(const double translation[3], const double rotation[4],
                       const double scale[3]);

/* From glTF's 16 numbers, column-major; the last row is left out. */
Matrix matrix_from_columns(const double columns[16]);

void matrix_to_float(const Matrix *a, float out[12]);

/* A point, or (w = 0) a direction. */
void matrix_apply(const Matrix *a, const double in[3], double w, double out[3]);

/* The inverse transpose of the linear part, times the determinant: turns normals, and needs no
 * division, so that flat transforms have one, too. Row-major 3x3. */
void matrix_cofactors(const Matrix *a, double out[9]);

/* 0, and all zeros, where the linear part has no inverse. */
int matrix_invert(const Matrix *a, Matrix *inverse);

#ifdef __cplusplus
}
#endif
#endif
