/* params.h: what a render keeps constant (cdl_Params), and what changes from wave to wave
 * (cdl_Wave). */
#ifndef CDL_ABI_PARAMS_H
#define CDL_ABI_PARAMS_H

#include "abi/types.h"

#define CDL_BLOCK_SAMPLES 16u /* samples of a pixel that make one partial film */

typedef struct cdl_CameraParams {
  float to_world[12]; /* 3x4, row-major; looks along -Z */
  float scale[2]; /* half width and height of the image: at distance 1, or in m if orthographic */
  float lens_radius;   /* m; 0: pinhole */
  float inverse_focus; /* 1 / m; 0: focused at infinity */
  uint orthographic;
  uint blades;                /* of the aperture, at least 1; below 3: round */
  float blade_cos, blade_sin; /* of half a blade's angle */
} cdl_CameraParams;
CDL_ABI_SIZE(cdl_CameraParams, 80);

typedef struct cdl_EnvironmentParams {
  uint width, height; /* texels; 1 x 1 for a constant one */
  uint columns,
      rows;       /* cells of the importance table; each divides the sphere like the texels do */
  float scale[3]; /* strength */
  float rotation_cos, rotation_sin; /* about +Y, counter-clockwise seen from above */
  float select_pdf;                 /* probability that light sampling chooses it */
  uint pad[2];
} cdl_EnvironmentParams;
CDL_ABI_SIZE(cdl_EnvironmentParams, 48);

typedef struct cdl_Params {
  cdl_CameraParams camera;
  cdl_EnvironmentParams environment;
  uint width, height;  /* of the full image, pixels */
  uint crop_x, crop_y; /* what is rendered of it */
  uint crop_width, crop_height;
  uint seed;
  uint max_depth;      /* scattering events after the camera ray */
  uint roulette_depth; /* events before Russian roulette begins */
  uint light_count;
  uint top_root;         /* of the bounding volume hierarchy */
  uint scene_medium;     /* index into the media */
  float scene_center[3]; /* sphere around the world's bounds */
  float scene_radius;
  uint pass_limit;  /* surfaces that a path may go straight through, all in all */
  uint motion_keys; /* times at which moving things are known; below 2: nothing moves */
  uint camera_keys; /* where the camera's matrices at those times lie in the attributes */
  uint pad;
} cdl_Params;
CDL_ABI_SIZE(cdl_Params, 208);

/* A wave: a rectangle of pixels, and `sample_count` samples of each from `first_sample`.
 * Slot of a path = sample in wave x pixels + pixel in wave, row by row. At most 2^20 paths. */
typedef struct cdl_Wave {
  uint x, y, width, height; /* pixels of the full image */
  uint first_sample, sample_count;
  uint path_count;
  uint stride;   /* words between two fields of a path's state */
  uint slots;    /* words between two fields that are indexed by slot */
  uint live;     /* entries of the path state in use, pads included */
  uint channels; /* of the film */
  uint pad;
} cdl_Wave;
CDL_ABI_SIZE(cdl_Wave, 48);

#endif
