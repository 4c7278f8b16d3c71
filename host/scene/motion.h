/* motion.h: what moves while the shutter is open. */
#ifndef CANDELA_SCENE_MOTION_H
#define CANDELA_SCENE_MOTION_H

#include "scene/scene.h"

/* Builds the scene as it is at `time`, s; without images and environment unless it is the first. */
typedef struct cdl_MotionSource {
  cdl_Status (*build)(void *user, double time, int first, struct cdl_Scene **scene);
  void *user;
  const cdl_Log *log;
} cdl_MotionSource;

/* Builds the scene at the beginning of the exposure from `open` to `close`, s, and with it, in
 * `later`, at as many later times as its motion needs: between neighbours straight lines err by
 * less than a two-thousandth of the scene. *changes is 1, and there is no motion, where things
 * appear or vanish meanwhile. */
cdl_Status motion_build(const cdl_MotionSource *source, double open, double close, int *changes,
                        struct cdl_Scene **scene);

/* Whether an instance is elsewhere, or of another shape, at a later time of the exposure. */
int motion_moves(const struct cdl_Scene *scene, uint32_t instance);

#endif
