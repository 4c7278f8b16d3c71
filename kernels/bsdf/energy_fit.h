/* energy_fit.h: written by scripts/fit_energy.py; energy.h says what the functions are and what
 * they take. Each is a network of two layers of units z / (1 + |z|): sums of ridge functions in
 * straight-line code, where the gathers of a table would not vectorise. */
#ifndef CDL_BSDF_ENERGY_FIT_H
#define CDL_BSDF_ENERGY_FIT_H

#include "lib/math.h"

/* Taken off what the fits give, so that surfaces return no more than they get. */
#define ENERGY_FIT_BIAS 0.0045f

typedef struct Energy4 {
  float a, b, c, d, pad; /* larger than 16 bytes, see vec.h */
} Energy4;

CDL_INLINE Energy4 energy4(float a, float b, float c, float d) {
  Energy4 x;
  x.a = a;
  x.b = b;
  x.c = c;
  x.d = d;
  x.pad = 0.0f;
  return x;
}

CDL_INLINE float energy_dot4(Energy4 x, float a, float b, float c, float d, float sum) {
  return fma(a, x.a, fma(b, x.b, fma(c, x.c, fma(d, x.d, sum))));
}

CDL_INLINE float energy_unit(float z) { return z / (1.0f + math_abs(z)); }

/* 1 - E of white metal */
CDL_INLINE float energy_fit_metal(float g1, float t, float cosine, float along, float across,
                                  float cut, float beckmann, float separable) {
  Energy4 x0 = energy4(g1, t, cosine, along);
  Energy4 x1 = energy4(across, cut, beckmann, separable);
  float u0 = energy_unit(
      energy_dot4(x1, 0.526528f, -0.541085f, 0.657652f, 0.0056608f,
                  energy_dot4(x0, -0.894855f, 1.48433f, 0.0294271f, -0.266303f, -0.166953f)));
  float u1 = energy_unit(energy_dot4(
      x1, 0.324453f, -0.984415f, -0.681524f, -0.00449002f,
      energy_dot4(x0, -0.340737f, 0.20091f, -0.229654f, -0.0572579f, math_after(u0, 1.37823f))));
  float u2 = energy_unit(energy_dot4(
      x1, -0.0220456f, -0.0200068f, 1.01661f, 0.00267062f,
      energy_dot4(x0, -0.14984f, -0.0443664f, -0.367017f, -0.64187f, math_after(u1, -0.0589891f))));
  float u3 = energy_unit(energy_dot4(
      x1, 0.155312f, -0.116611f, -0.128581f, 0.00151878f,
      energy_dot4(x0, -0.0238499f, -0.067f, 0.302016f, 0.449732f, math_after(u2, -0.319204f))));
  float u4 = energy_unit(energy_dot4(
      x1, -0.801262f, -0.203946f, -1.00765f, 0.00258253f,
      energy_dot4(x0, -0.0567951f, 0.416486f, -0.117947f, 0.415045f, math_after(u3, -0.460657f))));
  float u5 = energy_unit(energy_dot4(x1, 0.0125787f, 0.607328f, -0.157004f, -0.00486348f,
                                     energy_dot4(x0, -0.00965016f, -0.0574043f, 0.0195088f,
                                                 -0.0727332f, math_after(u4, -0.150476f))));
  float u6 = energy_unit(energy_dot4(
      x1, 0.0410165f, 0.175794f, -0.928765f, 0.719437f,
      energy_dot4(x0, 1.85038f, -7.99898f, -0.38067f, 0.0406691f, math_after(u5, -0.873822f))));
  float u7 = energy_unit(energy_dot4(
      x1, 0.15526f, -0.0721693f, 0.319495f, -0.00466044f,
      energy_dot4(x0, 0.288323f, -0.567128f, -0.0964883f, 0.0460161f, math_after(u6, -0.285991f))));
  float u8 = energy_unit(energy_dot4(
      x1, 0.0186709f, 0.00972642f, 0.199919f, 0.0298545f,
      energy_dot4(x0, 1.03394f, -2.04528f, -0.0818266f, 0.121614f, math_after(u7, -0.130949f))));
  float u9 = energy_unit(energy_dot4(
      x1, -0.761976f, 0.218956f, -0.00169914f, 0.00118624f,
      energy_dot4(x0, -0.0598309f, 0.871653f, -0.196798f, 0.23355f, math_after(u8, -0.0156334f))));
  float u10 = energy_unit(energy_dot4(
      x1, 0.112378f, -0.0475575f, -0.0906057f, -0.00129736f,
      energy_dot4(x0, 0.206072f, -0.875239f, -0.0316483f, -0.0669449f, math_after(u9, 0.487392f))));
  float u11 = energy_unit(energy_dot4(
      x1, 0.0161992f, 0.0490729f, 2.14216f, -0.0392399f,
      energy_dot4(x0, -1.63011f, -1.72631f, 0.335535f, 0.15381f, math_after(u10, -0.0679087f))));
  float u12 = energy_unit(energy_dot4(x1, -0.293829f, 0.0315089f, 0.0671884f, -0.000774218f,
                                      energy_dot4(x0, 0.0188101f, -0.0285418f, -0.0629349f,
                                                  -0.0702043f, math_after(u11, 0.228944f))));
  float u13 = energy_unit(energy_dot4(
      x1, -0.693399f, -0.0910387f, -0.154438f, -0.00170897f,
      energy_dot4(x0, -1.09851f, -0.461387f, 0.0260675f, 0.0975242f, math_after(u12, 1.89557f))));
  float u14 = energy_unit(energy_dot4(
      x1, -0.222518f, 0.47444f, 0.465393f, 0.00144211f,
      energy_dot4(x0, 0.394743f, 0.29213f, 0.449474f, 0.661353f, math_after(u13, -2.27094f))));
  float u15 = energy_unit(energy_dot4(
      x1, 0.1532f, 0.0847482f, 2.33036f, -0.0293319f,
      energy_dot4(x0, -2.10306f, -2.15379f, 1.35669f, 0.165151f, math_after(u14, -0.310067f))));
  float u16 = energy_unit(energy_dot4(x1, -0.383235f, -0.0427127f, 0.0717361f, 0.00202134f,
                                      energy_dot4(x0, -0.0188679f, 0.339036f, 0.0169549f,
                                                  -0.0320699f, math_after(u15, -0.284911f))));
  float u17 = energy_unit(energy_dot4(
      x1, -0.210991f, 0.0823036f, -0.0202853f, 0.0133527f,
      energy_dot4(x0, 0.478902f, -1.53221f, 0.882175f, -0.928306f, math_after(u16, 0.182299f))));
  float u18 = energy_unit(energy_dot4(x1, -0.0156697f, 0.257357f, 0.551407f, -0.00181423f,
                                      energy_dot4(x0, 0.0237604f, 0.404594f, -0.00399538f,
                                                  0.0490982f, math_after(u17, -0.326084f))));
  float u19 = energy_unit(energy_dot4(
      x1, 0.179277f, -0.171099f, 0.033346f, -0.0195865f,
      energy_dot4(x0, 0.18055f, -0.791723f, -0.00189843f, 0.145508f, math_after(u18, 0.0310032f))));
  Energy4 y0 = energy4(u0, u1, u2, u3);
  Energy4 y1 = energy4(u4, u5, u6, u7);
  Energy4 y2 = energy4(u8, u9, u10, u11);
  Energy4 y3 = energy4(u12, u13, u14, u15);
  Energy4 y4 = energy4(u16, u17, u18, u19);
  float v0 = energy_unit(energy_dot4(
      y4, -0.0658878f, -0.17756f, 0.716043f, 0.350086f,
      energy_dot4(y3, 1.33825f, 0.0334806f, 0.672215f, -0.200299f,
                  energy_dot4(y2, -0.500998f, -0.218387f, 0.138537f, -0.28238f,
                              energy_dot4(y1, -0.431663f, -0.296963f, 0.54991f, -0.121669f,
                                          energy_dot4(y0, 0.179326f, 0.218161f, -0.375414f,
                                                      0.458347f, math_after(u19, -0.267765f)))))));
  float v1 = energy_unit(energy_dot4(
      y4, 0.905908f, -0.0948598f, -0.153974f, -0.163279f,
      energy_dot4(y3, 0.164533f, 0.0545383f, 0.128104f, -0.0438102f,
                  energy_dot4(y2, 0.0221647f, -0.0902672f, 0.58083f, 0.0846562f,
                              energy_dot4(y1, -0.471929f, 0.0825388f, -0.0580633f, -0.235702f,
                                          energy_dot4(y0, -0.0323679f, -0.00900769f, 0.152206f,
                                                      0.0516705f, math_after(v0, -0.142853f)))))));
  float v2 = energy_unit(energy_dot4(
      y4, 0.156914f, 0.000442797f, -0.00491305f, 0.139024f,
      energy_dot4(y3, 1.96629f, -0.0824406f, 0.337378f, -0.0356457f,
                  energy_dot4(y2, -0.995931f, -0.181738f, -0.278628f, -0.616044f,
                              energy_dot4(y1, -1.04373f, -0.128638f, 0.842406f, 1.53513f,
                                          energy_dot4(y0, -0.00862503f, -0.143591f, -0.494155f,
                                                      0.341132f, math_after(v1, -0.117207f)))))));
  float v3 = energy_unit(energy_dot4(
      y4, -0.328503f, -0.0728082f, -3.12989f, 0.455439f,
      energy_dot4(y3, 0.0949418f, -1.0705f, 0.189356f, -0.800895f,
                  energy_dot4(y2, 0.0588229f, 0.443443f, -0.111231f, 0.85246f,
                              energy_dot4(y1, 1.22527f, 0.717607f, -0.462767f, -0.437436f,
                                          energy_dot4(y0, 0.63606f, -0.645226f, 0.857577f, 1.0614f,
                                                      math_after(v2, 1.0456f)))))));
  float v4 = energy_unit(energy_dot4(
      y4, -0.70729f, 0.148781f, 0.137756f, 0.13949f,
      energy_dot4(y3, -0.353282f, -0.282192f, 0.19419f, 0.225759f,
                  energy_dot4(y2, 0.0924943f, 0.390147f, -0.269064f, -0.132392f,
                              energy_dot4(y1, 0.344231f, -0.243635f, -0.154965f, 0.0627845f,
                                          energy_dot4(y0, 0.324089f, 0.0497396f, -0.0446852f,
                                                      0.0256782f, math_after(v3, -0.201631f)))))));
  float v5 = energy_unit(energy_dot4(
      y4, 0.997977f, 0.0191399f, 0.299459f, 0.439185f,
      energy_dot4(y3, -0.26165f, -0.468637f, -0.135097f, 0.0559046f,
                  energy_dot4(y2, 0.378296f, 0.446851f, 0.799444f, -0.00741621f,
                              energy_dot4(y1, -0.401535f, -0.04022f, -0.153288f, -2.00593f,
                                          energy_dot4(y0, 0.0363029f, 0.708472f, 0.324439f, 0.5268f,
                                                      math_after(v4, -0.688603f)))))));
  float v6 = energy_unit(energy_dot4(
      y4, 1.53525f, 0.180772f, 0.853989f, 2.19911f,
      energy_dot4(y3, -0.0293191f, -0.114066f, -0.133724f, 0.269971f,
                  energy_dot4(y2, -0.764432f, 0.0507206f, 1.14661f, -0.888595f,
                              energy_dot4(y1, 0.149234f, 0.0201588f, 1.27386f, -0.52482f,
                                          energy_dot4(y0, 0.172713f, -0.886445f, -0.357352f,
                                                      -0.604537f, math_after(v5, 1.07915f)))))));
  float v7 = energy_unit(energy_dot4(
      y4, -0.7646f, -0.373112f, -1.86834f, -0.798125f,
      energy_dot4(y3, -0.413125f, 0.962826f, -0.942035f, 1.37367f,
                  energy_dot4(y2, -0.754817f, 0.239589f, -0.384501f, -1.58594f,
                              energy_dot4(y1, -0.258905f, 0.413875f, -0.106251f, -0.127651f,
                                          energy_dot4(y0, 0.103519f, -0.855999f, 0.301958f,
                                                      0.383244f, math_after(v6, -1.19477f)))))));
  float v8 = energy_unit(energy_dot4(
      y4, 0.469821f, 0.181104f, -0.190222f, -0.213221f,
      energy_dot4(y3, 1.82285f, 0.12045f, 0.150509f, -0.0362455f,
                  energy_dot4(y2, -1.26751f, -0.352352f, -0.99715f, -0.735219f,
                              energy_dot4(y1, -1.4561f, 0.24287f, 1.17498f, 3.013f,
                                          energy_dot4(y0, 0.134164f, 0.0170433f, -0.918719f,
                                                      -0.0532831f, math_after(v7, -0.102338f)))))));
  float v9 = energy_unit(energy_dot4(
      y4, 0.878644f, 0.144861f, 0.825492f, 0.594911f,
      energy_dot4(y3, -0.137838f, -0.0896762f, 0.175198f, -0.359823f,
                  energy_dot4(y2, 0.768974f, -0.189634f, 0.392727f, 0.800458f,
                              energy_dot4(y1, 0.188819f, -0.126027f, -0.252645f, -1.26438f,
                                          energy_dot4(y0, 0.353802f, 0.0550788f, -0.0592101f,
                                                      -0.395555f, math_after(v8, 0.426763f)))))));
  Energy4 z0 = energy4(v0, v1, v2, v3);
  Energy4 z1 = energy4(v4, v5, v6, v7);
  return energy_dot4(z1, 2.07074f, -1.05489f, 0.820895f, -1.40848f,
                     energy_dot4(z0, 2.5306f, 3.62623f, -4.89829f, 0.281125f,
                                 fma(-3.13899f, v9, fma(1.7119f, v8, 0.832912f))));
}

/* The logarithm of its mean over the cosine */
CDL_INLINE float energy_fit_metal_mean(float mean, float root, float sqrt_mean, float bend,
                                       float beckmann, float separable) {
  Energy4 x0 = energy4(mean, root, sqrt_mean, bend);
  float u0 =
      energy_unit(energy_dot4(x0, -0.856524f, 0.0730665f, 0.925691f, 1.3681f,
                              fma(-1.48357f, separable, fma(-0.880134f, beckmann, 0.758364f))));
  float u1 = energy_unit(
      energy_dot4(x0, -0.0939863f, 0.470917f, -3.30799f, 0.719572f,
                  fma(0.626397f, separable, fma(-2.0677f, beckmann, math_after(u0, 2.18656f)))));
  float u2 = energy_unit(energy_dot4(
      x0, -9.67241f, 9.7588f, -7.61264f, 2.6821f,
      fma(-0.149034f, separable, fma(-0.123952f, beckmann, math_after(u1, 0.213727f)))));
  float u3 = energy_unit(energy_dot4(
      x0, -0.930412f, -0.614188f, 2.90831f, -0.453059f,
      fma(-0.491244f, separable, fma(-0.899906f, beckmann, math_after(u2, 0.0990196f)))));
  float u4 = energy_unit(
      energy_dot4(x0, -16.4121f, 6.69429f, -0.884494f, 0.850545f,
                  fma(-0.0862691f, separable, fma(0.0342f, beckmann, math_after(u3, -0.079137f)))));
  float u5 = energy_unit(energy_dot4(
      x0, -0.276923f, 0.398717f, -0.549828f, 0.349751f,
      fma(0.0519625f, separable, fma(0.183766f, beckmann, math_after(u4, 0.0763194f)))));
  float u6 = energy_unit(energy_dot4(
      x0, -49.1973f, 96.1626f, 4.91029f, -4.58299f,
      fma(-0.0870971f, separable, fma(0.144919f, beckmann, math_after(u5, -1.07886f)))));
  float u7 = energy_unit(
      energy_dot4(x0, -6.34577f, -0.973373f, 12.3662f, -3.20564f,
                  fma(9.69407f, separable, fma(-8.05921f, beckmann, math_after(u6, -2.01252f)))));
  float u8 = energy_unit(
      energy_dot4(x0, -0.780994f, 0.649588f, 1.20326f, -0.428461f,
                  fma(-0.214055f, separable, fma(1.97525f, beckmann, math_after(u7, -0.158041f)))));
  float u9 = energy_unit(energy_dot4(
      x0, -4.45886f, 2.38127f, 5.10586f, 0.244218f,
      fma(-0.0622419f, separable, fma(0.000705381f, beckmann, math_after(u8, -2.67365f)))));
  Energy4 y0 = energy4(u0, u1, u2, u3);
  Energy4 y1 = energy4(u4, u5, u6, u7);
  float v0 = energy_unit(
      energy_dot4(y1, 0.163247f, 0.472899f, -0.0150404f, 0.220697f,
                  energy_dot4(y0, 0.162336f, -1.91926f, -0.544944f, 0.155021f,
                              fma(-0.610118f, u9, fma(0.703936f, u8, math_after(u9, 0.678188f))))));
  float v1 = energy_unit(
      energy_dot4(y1, 0.491547f, 0.81614f, 0.0656167f, -3.50095f,
                  energy_dot4(y0, 0.992874f, 6.57253f, 1.60303f, -12.9884f,
                              fma(5.49324f, u9, fma(-4.98024f, u8, math_after(v0, -0.408235f))))));
  float v2 = energy_unit(
      energy_dot4(y1, -21.5828f, 194.182f, -0.042823f, 19.1352f,
                  energy_dot4(y0, -93.9104f, -15.6534f, 15.6111f, 103.529f,
                              fma(4.27682f, u9, fma(-79.3841f, u8, math_after(v1, 6.5684f))))));
  float v3 = energy_unit(
      energy_dot4(y1, 172.407f, 6.14801f, -36.3386f, -2.03287f,
                  energy_dot4(y0, 9.58952f, 26.5847f, -28.4577f, -38.421f,
                              fma(33.3167f, u9, fma(-10.0355f, u8, math_after(v2, 2.96742f))))));
  float v4 = energy_unit(
      energy_dot4(y1, -3.00739f, -1.00479f, 0.00311409f, -0.0322471f,
                  energy_dot4(y0, 0.529095f, 0.0865142f, 2.26647f, -1.19766f,
                              fma(0.365417f, u9, fma(0.027184f, u8, math_after(v3, -0.278348f))))));
  float v5 = energy_unit(
      energy_dot4(y1, 8.89905f, 5.40081f, 0.00467437f, 0.939813f,
                  energy_dot4(y0, 1.40257f, -1.76299f, -6.36369f, 0.160722f,
                              fma(0.504461f, u9, fma(-0.485687f, u8, math_after(v4, 0.591491f))))));
  Energy4 z0 = energy4(v0, v1, v2, v3);
  return energy_dot4(z0, -2.99253f, -4.18338f, -0.248509f, 4.59913f,
                     fma(1.08187f, v5, fma(-2.57004f, v4, 3.18985f)));
}

/* 1 - E of a dielectric boundary that is rough alike in all directions */
CDL_INLINE float energy_fit_glass(float base, float g1_beyond, float t, float reflected,
                                  float beyond, float cosine, float alpha, float critical,
                                  float dense, float past, float beckmann, float separable) {
  Energy4 x0 = energy4(base, g1_beyond, t, reflected);
  Energy4 x1 = energy4(beyond, cosine, alpha, critical);
  Energy4 x2 = energy4(dense, past, beckmann, separable);
  float u0 = energy_unit(energy_dot4(
      x2, -0.954425f, -0.95858f, -0.474717f, 0.208027f,
      energy_dot4(x1, -0.777477f, -1.30215f, 0.207089f, 0.00672519f,
                  energy_dot4(x0, 0.577411f, 1.64912f, -2.35778f, -1.04241f, -0.475106f))));
  float u1 =
      energy_unit(energy_dot4(x2, -0.0741867f, -1.34292f, 0.0602193f, -0.0251879f,
                              energy_dot4(x1, 0.384427f, 0.462548f, -0.0271263f, -0.494432f,
                                          energy_dot4(x0, 0.0172665f, -0.548837f, -0.106955f,
                                                      0.29056f, math_after(u0, 0.886331f)))));
  float u2 =
      energy_unit(energy_dot4(x2, 1.35098f, -4.01602f, 0.141408f, -0.053755f,
                              energy_dot4(x1, 0.393542f, 0.24542f, -0.00542459f, 0.0380993f,
                                          energy_dot4(x0, -0.246094f, -0.726586f, 0.267735f,
                                                      0.298817f, math_after(u1, 0.0508789f)))));
  float u3 =
      energy_unit(energy_dot4(x2, 0.129321f, 0.0918724f, 0.0831968f, 0.0250599f,
                              energy_dot4(x1, -0.769124f, 0.21324f, 0.0502477f, 0.0503938f,
                                          energy_dot4(x0, 0.389444f, 0.727239f, 1.07026f,
                                                      -0.200114f, math_after(u2, -0.630991f)))));
  float u4 =
      energy_unit(energy_dot4(x2, -0.919017f, 0.0947062f, 0.376773f, 0.00323836f,
                              energy_dot4(x1, 0.704594f, 0.0665528f, 0.146629f, -0.0429736f,
                                          energy_dot4(x0, 1.10545f, -0.0702282f, 3.05733f,
                                                      0.0257589f, math_after(u3, -2.82878f)))));
  float u5 =
      energy_unit(energy_dot4(x2, -0.280146f, -0.234746f, 0.33654f, 0.00993519f,
                              energy_dot4(x1, -0.228772f, 0.220843f, 0.00790265f, -0.158574f,
                                          energy_dot4(x0, -0.00493167f, 0.31066f, -0.414453f,
                                                      -0.0833309f, math_after(u4, -0.26129f)))));
  float u6 =
      energy_unit(energy_dot4(x2, 0.342783f, 1.08328f, 0.0100805f, -0.0138836f,
                              energy_dot4(x1, 0.445784f, 0.0423378f, -0.113539f, 0.211285f,
                                          energy_dot4(x0, 0.872013f, 0.186822f, -1.04496f,
                                                      -0.037683f, math_after(u5, -0.24065f)))));
  float u7 =
      energy_unit(energy_dot4(x2, 0.854809f, -0.757005f, 0.287325f, 0.021941f,
                              energy_dot4(x1, 0.020553f, -0.831575f, -0.300668f, -0.861218f,
                                          energy_dot4(x0, -1.06965f, -2.39598f, -0.985234f,
                                                      -0.364636f, math_after(u6, 3.38775f)))));
  float u8 =
      energy_unit(energy_dot4(x2, -0.988517f, 4.50887f, -0.373859f, -0.0763582f,
                              energy_dot4(x1, -2.24757f, 1.32711f, 0.293374f, 0.722645f,
                                          energy_dot4(x0, 0.112674f, 1.92041f, 1.6084f, 2.31822f,
                                                      math_after(u7, -3.54921f)))));
  float u9 =
      energy_unit(energy_dot4(x2, 0.873193f, 0.0949584f, -0.507507f, 0.0119325f,
                              energy_dot4(x1, -0.155562f, -1.78413f, 0.0580755f, -1.60735f,
                                          energy_dot4(x0, 0.611082f, -0.659749f, 2.73397f,
                                                      -0.0776303f, math_after(u8, 2.32936f)))));
  float u10 =
      energy_unit(energy_dot4(x2, -2.13424f, 1.88107f, -0.0371998f, 0.0163114f,
                              energy_dot4(x1, -0.971006f, -0.0860422f, 0.0281917f, -1.29985f,
                                          energy_dot4(x0, 0.259602f, 0.296812f, -0.0869273f,
                                                      -0.343874f, math_after(u9, 0.499118f)))));
  float u11 =
      energy_unit(energy_dot4(x2, -10.144f, -2.80953f, -12.1769f, -0.00611359f,
                              energy_dot4(x1, 2.51703f, 3.6393f, -1.4624f, -1.06647f,
                                          energy_dot4(x0, 0.202123f, 11.5969f, -3.43117f,
                                                      -0.931562f, math_after(u10, 0.507392f)))));
  float u12 =
      energy_unit(energy_dot4(x2, 2.39824f, 2.9697f, -1.46512f, 0.0178867f,
                              energy_dot4(x1, 0.0996289f, -1.32802f, -0.169326f, 0.437629f,
                                          energy_dot4(x0, 1.15273f, 0.0633591f, -0.166198f,
                                                      0.467582f, math_after(u11, 0.0237954f)))));
  float u13 =
      energy_unit(energy_dot4(x2, 1.12251f, 0.171877f, 0.37814f, 0.162177f,
                              energy_dot4(x1, 3.07133f, 4.50391f, -0.137724f, -0.103639f,
                                          energy_dot4(x0, 0.710931f, -1.64188f, 1.98822f, -1.1136f,
                                                      math_after(u12, 0.562868f)))));
  float u14 =
      energy_unit(energy_dot4(x2, -1.36243f, -2.20956f, 0.956735f, -0.00566863f,
                              energy_dot4(x1, 3.067f, 3.37367f, -1.50413f, -2.46908f,
                                          energy_dot4(x0, -8.38544f, -5.85878f, -3.56496f, -11.178f,
                                                      math_after(u13, 5.15672f)))));
  float u15 =
      energy_unit(energy_dot4(x2, -0.67401f, 0.384828f, 0.492274f, 0.00527851f,
                              energy_dot4(x1, 0.276921f, 1.02359f, -0.0254478f, -0.61026f,
                                          energy_dot4(x0, 0.0409453f, 0.769595f, -1.73084f,
                                                      -0.377469f, math_after(u14, -1.10116f)))));
  Energy4 y0 = energy4(u0, u1, u2, u3);
  Energy4 y1 = energy4(u4, u5, u6, u7);
  Energy4 y2 = energy4(u8, u9, u10, u11);
  Energy4 y3 = energy4(u12, u13, u14, u15);
  float v0 = energy_unit(
      energy_dot4(y3, -0.171929f, -0.844309f, 0.0424011f, -0.627935f,
                  energy_dot4(y2, -0.263997f, 0.114203f, 0.435711f, 0.214713f,
                              energy_dot4(y1, 0.169292f, 2.18462f, 0.671865f, -0.129703f,
                                          energy_dot4(y0, -1.47796f, -0.919134f, 0.667725f,
                                                      -0.359498f, math_after(u15, 0.351234f))))));
  float v1 = energy_unit(
      energy_dot4(y3, 0.151659f, -0.0490133f, 0.0122253f, 0.553707f,
                  energy_dot4(y2, 0.0542957f, -0.132225f, -0.0487451f, -0.154866f,
                              energy_dot4(y1, -0.0154235f, -1.10977f, -0.120931f, 0.0352379f,
                                          energy_dot4(y0, 0.0613002f, -0.155836f, -0.11729f,
                                                      0.145083f, math_after(v0, 0.00387044f))))));
  float v2 = energy_unit(
      energy_dot4(y3, 0.278726f, -0.719982f, 0.0993487f, -0.75245f,
                  energy_dot4(y2, 0.0419669f, -0.409028f, 0.250695f, 0.232109f,
                              energy_dot4(y1, 0.447858f, 2.61185f, 0.390049f, 0.419762f,
                                          energy_dot4(y0, -0.381878f, -0.381205f, 0.344881f,
                                                      -0.0384094f, math_after(v1, 0.968577f))))));
  float v3 = energy_unit(
      energy_dot4(y3, 0.378987f, 3.28217f, 1.31503f, -3.17273f,
                  energy_dot4(y2, 2.88953f, -5.33285f, 6.45688f, -0.353163f,
                              energy_dot4(y1, 3.19827f, -0.424294f, -1.41064f, 0.0523946f,
                                          energy_dot4(y0, 1.08123f, -1.56881f, 5.21633f, -2.23682f,
                                                      math_after(v2, 8.78919f))))));
  float v4 = energy_unit(
      energy_dot4(y3, 0.0141512f, 0.536574f, 0.0184838f, -0.969219f,
                  energy_dot4(y2, -0.0680606f, 0.0940587f, 0.0670065f, 0.156123f,
                              energy_dot4(y1, 0.125743f, 1.85856f, 0.350274f, -0.00554828f,
                                          energy_dot4(y0, -0.317177f, 0.102273f, 0.112859f,
                                                      -0.519974f, math_after(v3, -0.572306f))))));
  float v5 = energy_unit(
      energy_dot4(y3, -0.0854778f, 0.334294f, 0.0278921f, -0.723217f,
                  energy_dot4(y2, -0.00643172f, 0.0499895f, 0.0748549f, 0.123814f,
                              energy_dot4(y1, 0.0431837f, 1.15148f, 0.0546538f, -0.0420236f,
                                          energy_dot4(y0, -0.188323f, 0.236716f, 0.0503677f,
                                                      -0.258352f, math_after(v4, -0.385342f))))));
  float v6 = energy_unit(
      energy_dot4(y3, 0.719852f, 0.472608f, 1.99842f, -0.123583f,
                  energy_dot4(y2, -1.11026f, -0.887426f, 2.9898f, -1.44792f,
                              energy_dot4(y1, 2.66419f, -5.79514f, -3.21165f, -1.97005f,
                                          energy_dot4(y0, 0.675426f, -1.74854f, 2.21494f, -4.2459f,
                                                      math_after(v5, 6.09807f))))));
  float v7 = energy_unit(
      energy_dot4(y3, -0.158509f, 0.046465f, -0.0890119f, -0.532771f,
                  energy_dot4(y2, -0.135285f, 0.250394f, -0.0391042f, 0.192265f,
                              energy_dot4(y1, 0.0346848f, 1.37977f, 0.324593f, -0.0106421f,
                                          energy_dot4(y0, 0.0290091f, 0.0110205f, 0.19446f,
                                                      -0.237343f, math_after(v6, 0.14862f))))));
  Energy4 z0 = energy4(v0, v1, v2, v3);
  Energy4 z1 = energy4(v4, v5, v6, v7);
  return energy_dot4(z1, 4.50192f, -10.4527f, -0.649637f, -5.13537f,
                     energy_dot4(z0, -0.424944f, -11.2661f, -0.674052f, 1.51641f, -0.592838f));
}

/* The logarithm of its mean over the cosine */
CDL_INLINE float energy_fit_glass_mean(float alpha, float root, float bend, float contrast,
                                       float critical, float dense, float beckmann,
                                       float separable) {
  Energy4 x0 = energy4(alpha, root, bend, contrast);
  Energy4 x1 = energy4(critical, dense, beckmann, separable);
  float u0 = energy_unit(
      energy_dot4(x1, -3.40621f, -0.266001f, 2.07158f, 0.185115f,
                  energy_dot4(x0, 0.197005f, -0.117606f, 0.407629f, -0.910437f, -0.193847f)));
  float u1 = energy_unit(energy_dot4(
      x1, -3.73405f, -1.4739f, -0.233117f, 0.0573405f,
      energy_dot4(x0, -1.14732f, 2.13918f, 0.338174f, -0.668353f, math_after(u0, 0.769375f))));
  float u2 = energy_unit(energy_dot4(
      x1, -1.81398f, 1.43705f, 0.365356f, -0.00715858f,
      energy_dot4(x0, 0.412441f, -0.335571f, -1.24734f, -1.04807f, math_after(u1, 0.115351f))));
  float u3 = energy_unit(energy_dot4(
      x1, 5.75218f, -0.347022f, -3.34374f, -0.0149041f,
      energy_dot4(x0, 1.40171f, -4.8298f, 0.285726f, -0.259712f, math_after(u2, 3.54412f))));
  float u4 = energy_unit(energy_dot4(
      x1, -4.00208f, -1.93787f, 1.97876f, -0.0809054f,
      energy_dot4(x0, 0.2095f, 2.37003f, 3.40308f, -0.791884f, math_after(u3, -3.66329f))));
  float u5 = energy_unit(energy_dot4(x1, 0.436831f, -0.386011f, 1.14921f, -0.0249173f,
                                     energy_dot4(x0, -0.168809f, -0.525468f, -0.118331f, -0.516456f,
                                                 math_after(u4, -0.00857649f))));
  float u6 = energy_unit(energy_dot4(
      x1, 5.5776f, 0.214431f, 0.364445f, -0.0805203f,
      energy_dot4(x0, 1.62228f, -6.63558f, 0.854794f, 0.153179f, math_after(u5, 0.325351f))));
  float u7 = energy_unit(energy_dot4(
      x1, 0.285967f, 0.126683f, -0.413951f, 0.000190391f,
      energy_dot4(x0, 0.687563f, 1.44299f, 0.450694f, 0.459102f, math_after(u6, -0.0542619f))));
  float u8 = energy_unit(energy_dot4(
      x1, -249.621f, -6656.35f, -16405.6f, -4103.31f,
      energy_dot4(x0, 1193.93f, 2448.4f, 3205.92f, -1783.39f, math_after(u7, -3429.63f))));
  float u9 = energy_unit(energy_dot4(
      x1, 2.65962f, -1.3111f, 0.138178f, -0.022535f,
      energy_dot4(x0, 1.58243f, -5.10195f, -2.12347f, 1.62159f, math_after(u8, 0.868731f))));
  float u10 = energy_unit(energy_dot4(
      x1, 0.911315f, -1.12444f, -2.15374f, -0.0536353f,
      energy_dot4(x0, 0.0691718f, 0.465464f, 0.504611f, 1.74832f, math_after(u9, -0.354089f))));
  float u11 = energy_unit(energy_dot4(
      x1, 1.281f, 2.67341f, 0.345969f, 2.90122f,
      energy_dot4(x0, -0.785407f, 0.813233f, -1.94324f, 2.60273f, math_after(u10, -0.0192466f))));
  float u12 = energy_unit(energy_dot4(
      x1, -0.316459f, 131.027f, -4.20285f, 0.179595f,
      energy_dot4(x0, 9.84535f, 21.891f, -3.36354f, 4.80044f, math_after(u11, 5.36605f))));
  float u13 = energy_unit(energy_dot4(
      x1, -1.3267f, 2.59181f, -1.84172f, -0.00964211f,
      energy_dot4(x0, -0.425279f, -0.0768417f, 1.69385f, -0.358277f, math_after(u12, -0.361227f))));
  Energy4 y0 = energy4(u0, u1, u2, u3);
  Energy4 y1 = energy4(u4, u5, u6, u7);
  Energy4 y2 = energy4(u8, u9, u10, u11);
  float v0 = energy_unit(energy_dot4(
      y2, 83.6503f, -527.795f, -714.659f, 98.8924f,
      energy_dot4(
          y1, -772.521f, -1104.53f, 528.912f, -487.968f,
          energy_dot4(y0, 433.115f, -106.425f, -852.298f, -757.608f,
                      fma(125.608f, u13, fma(-298.967f, u12, math_after(u13, -21.5505f)))))));
  float v1 = energy_unit(energy_dot4(
      y2, 0.82034f, 3.97685f, -4.24477f, -0.0224408f,
      energy_dot4(
          y1, -4.06363f, 6.85024f, -7.43262f, 0.152287f,
          energy_dot4(y0, 0.114941f, -4.32695f, 4.92226f, 0.298397f,
                      fma(-0.876475f, u13, fma(4.66486f, u12, math_after(v0, -4.29959f)))))));
  float v2 = energy_unit(energy_dot4(
      y2, 0.0225391f, 0.732144f, -0.793005f, -0.0406093f,
      energy_dot4(
          y1, 0.127753f, -0.734091f, 0.365655f, -1.29973f,
          energy_dot4(y0, -0.671447f, 0.643701f, -0.472983f, -0.0962602f,
                      fma(-0.969734f, u13, fma(2.63358f, u12, math_after(v1, -0.382025f)))))));
  float v3 = energy_unit(energy_dot4(
      y2, 3.57317f, -27.327f, 314.33f, 14.6675f,
      energy_dot4(y1, -20.8347f, 292.497f, 46.9613f, -59.8562f,
                  energy_dot4(y0, -107.215f, 298.737f, 1039.25f, 104.124f,
                              fma(-397.622f, u13, fma(22.248f, u12, math_after(v2, 491.754f)))))));
  float v4 = energy_unit(energy_dot4(
      y2, -0.134849f, 0.166939f, 0.459275f, -0.0365648f,
      energy_dot4(
          y1, -0.822574f, 2.80936f, -0.731739f, -0.710424f,
          energy_dot4(y0, 1.42076f, -0.25504f, 2.63163f, 1.0572f,
                      fma(0.111868f, u13, fma(1.47862f, u12, math_after(v3, -1.14339f)))))));
  float v5 = energy_unit(energy_dot4(
      y2, -0.070925f, 1.4902f, -0.71498f, -0.159346f,
      energy_dot4(y1, 0.139039f, -5.64287f, -1.1801f, -7.90555f,
                  energy_dot4(y0, -0.427427f, -1.60728f, -4.83124f, -3.8536f,
                              fma(1.79238f, u13, fma(1.31361f, u12, math_after(v4, 2.56632f)))))));
  Energy4 z0 = energy4(v0, v1, v2, v3);
  return energy_dot4(z0, 0.0115776f, -0.468171f, -5.7012f, -0.0156631f,
                     fma(-1.92943f, v5, fma(-1.50627f, v4, -0.161301f)));
}

#endif
