/* generate: starts the paths of a wave at the camera. */
#include "lib/stage.h"

#include "abi/params.h"
#include "lib/camera.h"
#include "lib/dimensions.h"
#include "lib/state.h"

CDL_FUNCTION void generate_strip(size_t first, CDL_CONSTANT cdl_Params *restrict params,
                                 CDL_CONSTANT cdl_Wave *restrict wave,
                                 CDL_GLOBAL const float *restrict attributes,
                                 CDL_GLOBAL const uint *restrict camera_media,
                                 CDL_GLOBAL uint *path, CDL_GLOBAL uint *work,
                                 CDL_GLOBAL uint *slots) {
  CDL_FOR_STRIP(i, first) {
    size_t stride = wave->stride;
    int used = i < wave->path_count;
    PathRandom random = path_random(params, wave, (uint)i);
    float film_u, film_v, lens_u, lens_v;
    rng_2d(random.key, random.sample, CDL_PAIR_FILM, &film_u, &film_v);
    rng_2d(random.key, random.sample, CDL_PAIR_LENS, &lens_u, &lens_v);
    float x = ((float)(int)random.x + film_u) / (float)(int)params->width;
    float y = ((float)(int)random.y + film_v) / (float)(int)params->height;
#ifdef CDL_MOTION
    MotionTime time = path_time(params, wave, (uint)i);
#endif
    Transform to_world = camera_to_world(params, attributes CDL_TIME(time));
    CameraRay ray = camera_ray(&params->camera, to_world, x, y, lens_u, lens_v);

    state_set_vec3(path, CDL_PATH_ORIGIN, stride, i, ray.origin);
    state_set_vec3(path, CDL_PATH_DIRECTION, stride, i, ray.direction);
    state_set_vec3(path, CDL_PATH_THROUGHPUT, stride, i, v3_all(used ? 1.0f : 0.0f));
    state_set_float(path, CDL_PATH_PDF, stride, i, 0.0f);
    state_set_float(path, CDL_PATH_PASSED, stride, i, 0.0f);
    state_set_uint(path, CDL_PATH_SLOT, stride, i, (uint)i);
    state_set_uint(path, CDL_PATH_COUNTS, stride, i, 0u);
    state_set_uint(path, CDL_PATH_MEDIA, stride, i, camera_media[0]);
    state_set_uint(path, CDL_PATH_MEDIA + 1, stride, i, camera_media[1]);
    state_set_uint(work, CDL_WORK_QUEUE, stride, i, used ? CDL_QUEUE_LIVE : CDL_QUEUE_DEAD);
    state_set_uint(work, CDL_WORK_SHADOW_COUNT, stride, i, 0u);
    state_set_vec3(slots, CDL_SLOT_RADIANCE, wave->slots, i, v3_all(0.0f));
  }
}

__kernel void generate(CDL_CONSTANT cdl_Params *restrict params,
                       CDL_CONSTANT cdl_Wave *restrict wave,
                       CDL_GLOBAL const float *restrict attributes,
                       CDL_GLOBAL const uint *restrict camera_media, CDL_GLOBAL uint *path,
                       CDL_GLOBAL uint *work, CDL_GLOBAL uint *slots) {
  generate_strip(get_global_id(0) * CDL_STRIP, params, wave, attributes, camera_media, path, work,
                 slots);
}
