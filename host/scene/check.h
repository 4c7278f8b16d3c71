/* check.h: what must hold of a document beyond its schema, before anything is converted.
 *
 * Each check reports the first violation, with the Khronos validator's code, and returns
 * CDL_BAD_INPUT. They run in the order below; each relies on those before it. */
#ifndef CANDELA_SCENE_CHECK_H
#define CANDELA_SCENE_CHECK_H

#include "scene/document.h"

/* asset.version, required extensions. */
cdl_Status check_asset(Document *doc);

/* Fills doc->buffers and doc->views: every view lies within its buffer. */
cdl_Status check_buffers(Document *doc);

/* Fills doc->accessors: every element lies within its view, aligned; sparse indices ascend. */
cdl_Status check_accessors(Document *doc);

/* Nodes form trees of bounded depth, matrices can be taken apart, skins hang together. */
cdl_Status check_nodes(Document *doc);

cdl_Status check_meshes(Document *doc);
cdl_Status check_materials(Document *doc);
cdl_Status check_cameras_and_lights(Document *doc);
cdl_Status check_animations(Document *doc);

/* Values: finite, unit where they must be, within declared bounds, indices below vertex counts. */
cdl_Status check_mesh_data(Document *doc);

/* Joints that a skin has, weights that are not negative, as many of them as morph targets. */
cdl_Status check_deformation(Document *doc);

/* Fills doc->images with encoded bytes of a kind that can be decoded, or none (NULL; of KTX2, which
 * is not decoded, the size is left). */
cdl_Status check_images(Document *doc);

/* Every one of these checks. */
cdl_Status check_document(Document *doc);

#endif
