/* camera.h: which camera, how large an image, and what the kernels need to know of it. */
#ifndef CANDELA_RENDER_CAMERA_H
#define CANDELA_RENDER_CAMERA_H

#include "abi/params.h"
#include "scene/scene.h"

/* The camera of that name, or index; NULL: the first. CDL_USAGE lists what there is. */
cdl_Status camera_find(const cdl_Log *log, const cdl_Scene *scene, const char *name,
                       const cdl_SceneCamera **camera);

/* Fills in a size that is 0 from the other one and the camera's aspect (16:9 where it has none). */
void camera_image_size(const cdl_SceneCamera *camera, uint32_t *width, uint32_t *height);

/* For an image of this size: the camera's height is kept, its width follows the image's. */
void camera_params(const cdl_SceneCamera *camera, uint32_t width, uint32_t height,
                   cdl_CameraParams *params);

#endif
