/* pose.h: animations, as changes to the document before anything is built from it. */
#ifndef CANDELA_SCENE_POSE_H
#define CANDELA_SCENE_POSE_H

#include "scene/document.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Writes into doc->root, which must have passed the checks, what the animations say at `time`, s:
 * node transforms, weights of morph targets, and all that KHR_animation_pointer points to. Values
 * are kept within the range that the member allows.
 *
 * `animation` is a name or an index; CDL_USAGE lists what there is. With NULL the first is shown,
 * and each after it that moves nothing that is moved already. */
cdl_Status pose_document(Document *doc, double time, const char *animation);

#ifdef __cplusplus
}
#endif
#endif
