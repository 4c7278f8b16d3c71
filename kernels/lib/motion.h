/* motion.h: where things are at the time of a ray.
 *
 * What moves while the shutter is open is known at params->motion_keys times, evenly spaced, and
 * moves along straight lines in between. Programs for scenes that stand still are built without
 * CDL_MOTION: then the macros below are empty and nothing is looked up or carried along. */
#ifndef CDL_LIB_MOTION_H
#define CDL_LIB_MOTION_H

#include "lib/vec.h"

#ifdef CDL_MOTION
/* A time as the key before it, and the part of the way to the next one, [0,1). */
typedef struct MotionTime {
  uint key;
  float fraction;
} MotionTime;

/* The last parameter of functions that depend on the time, and what is handed on for it. */
#define CDL_TIME_PARAM , MotionTime time
#define CDL_TIME(time) , time

/* Between a and b, ends included whatever the rounding: boxes around both hold it. */
CDL_INLINE float motion_mix(float a, float b, float fraction) {
  float low = a < b ? a : b;
  float high = a < b ? b : a;
  float x = fma(fraction, b - a, a);
  x = x < low ? low : x;
  return x > high ? high : x;
}

CDL_INLINE vec3 motion_mix3(vec3 a, vec3 b, float fraction) {
  return v3(motion_mix(a.x, b.x, fraction), motion_mix(a.y, b.y, fraction),
            motion_mix(a.z, b.z, fraction));
}
#else
#define CDL_TIME_PARAM
#define CDL_TIME(time)
#endif

CDL_INLINE vec3 attribute_vec3(CDL_GLOBAL const float *attributes, size_t i) {
  return v3(attributes[i], attributes[i + 1], attributes[i + 2]);
}

/* Three floats of a vertex, of which the keys' values lie `step` floats apart; 0: it stands still.
 */
CDL_INLINE vec3 attribute_at(CDL_GLOBAL const float *attributes, size_t i,
                             size_t step CDL_TIME_PARAM) {
#ifdef CDL_MOTION
  size_t before = i + step * time.key;
  return motion_mix3(attribute_vec3(attributes, before), attribute_vec3(attributes, before + step),
                     time.fraction);
#else
  (void)step;
  return attribute_vec3(attributes, i);
#endif
}

#endif
