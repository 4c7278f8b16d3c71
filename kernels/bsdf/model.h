/* model.h: the one model that a shading kernel is built for, under names that do not say which.
 * CDL_SHADE_LIT: it has lobes that a sampled light can hit. CDL_SHADE_TRANSMITS: paths can cross
 * it. CDL_SHADE_ENERGY: it takes the tables of energy.h. CDL_SHADE_ENTERS: `transmitted` means that
 * the path goes under the surface; CDL_SHADE_LEAVES: it comes out from there. CDL_SHADE_WALKS: what
 * goes in, or stays in, is on a walk that counts as one event with that of coming out. */
#ifndef CDL_BSDF_MODEL_H
#define CDL_BSDF_MODEL_H

#include "abi/material.h"

#if CDL_SHADE_MODEL == CDL_MODEL_MIRROR
#include "bsdf/mirror.h"
#define CDL_SHADE_LIT 0
#define CDL_SHADE_TRANSMITS 0
#define BsdfParams MirrorParams
#define bsdf_params mirror_params
#define bsdf_evaluate mirror_evaluate
#define bsdf_sample_model mirror_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_DIELECTRIC
#include "bsdf/dielectric.h"
#define CDL_SHADE_LIT 0
#define CDL_SHADE_TRANSMITS 1
#if CDL_DISPERSION
#define CDL_SHADE_DISPERSES 1
#endif
#define BsdfParams DielectricParams
#define bsdf_params dielectric_params
#define bsdf_evaluate dielectric_evaluate
#define bsdf_sample_model dielectric_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_DIFFUSE
#include "bsdf/diffuse.h"
#define CDL_SHADE_LIT 1
#define CDL_SHADE_TRANSMITS 0
#define BsdfParams DiffuseParams
#define bsdf_params diffuse_params
#define bsdf_evaluate diffuse_evaluate
#define bsdf_sample_model diffuse_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_CONDUCTOR
#include "bsdf/conductor.h"
#define CDL_SHADE_ENERGY 1
#define CDL_SHADE_LIT 1
#define CDL_SHADE_TRANSMITS 0
#define BsdfParams ConductorParams
#define bsdf_params conductor_params
#define bsdf_evaluate conductor_evaluate
#define bsdf_sample_model conductor_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_RETROREFLECTOR
#include "bsdf/retroreflector.h"
#define CDL_SHADE_LIT 1
#define CDL_SHADE_TRANSMITS 0
#define BsdfParams RetroreflectorParams
#define bsdf_params retroreflector_params
#define bsdf_evaluate retroreflector_evaluate
#define bsdf_sample_model retroreflector_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_GLTF
#include "bsdf/gltf.h"
#define CDL_SHADE_LIT 1
#define CDL_SHADE_TRANSMITS 0
#define BsdfParams GltfParams
#define bsdf_params gltf_params
#define bsdf_evaluate gltf_evaluate
#define bsdf_sample_model gltf_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_OREN_NAYAR
#include "bsdf/oren_nayar.h"
#define CDL_SHADE_LIT 1
#define CDL_SHADE_TRANSMITS 0
#define BsdfParams OrenNayarParams
#define bsdf_params oren_nayar_params
#define bsdf_evaluate oren_nayar_evaluate
#define bsdf_sample_model oren_nayar_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_DISNEY
#include "bsdf/disney.h"
#define CDL_SHADE_LIT 1
#define CDL_SHADE_TRANSMITS 1
#define BsdfParams DisneyParams
#define bsdf_params disney_params
#define bsdf_evaluate disney_evaluate
#define bsdf_sample_model disney_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_PLASTIC
#include "bsdf/plastic.h"
#define CDL_SHADE_LIT 1
#define CDL_SHADE_TRANSMITS 0
#define BsdfParams PlasticParams
#define bsdf_params plastic_params
#define bsdf_evaluate plastic_evaluate
#define bsdf_sample_model plastic_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_ROUGH_DIELECTRIC
#include "bsdf/rough_dielectric.h"
#define CDL_SHADE_ENERGY 1
#define CDL_SHADE_LIT 1
#define CDL_SHADE_TRANSMITS 1
#if CDL_DISPERSION
#define CDL_SHADE_DISPERSES 1
#endif
#define BsdfParams RoughDielectricParams
#define bsdf_params rough_dielectric_params
#define bsdf_evaluate rough_dielectric_evaluate
#define bsdf_sample_model rough_dielectric_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_GLTF_LAYERED
#include "bsdf/gltf_layered.h"
#define CDL_SHADE_LIT 1
#define CDL_SHADE_TRANSMITS GLTF_TRANSMITS
#ifdef CDL_GLTF_CLEARCOAT
#define CDL_SHADE_COATED 1
#endif
#ifdef CDL_GLTF_DISPERSION
#define CDL_SHADE_DISPERSES 1
#endif
#define BsdfParams GltfLayeredParams
#define bsdf_params gltf_layered_params
#define bsdf_evaluate gltf_layered_evaluate
#define bsdf_sample_model gltf_layered_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_BODY
#include "bsdf/body.h"
#define CDL_SHADE_LIT 1
#define CDL_SHADE_TRANSMITS 1
#define CDL_SHADE_WALKS 1
#define BsdfParams BodyParams
#define bsdf_params body_params
#define bsdf_evaluate body_evaluate
#define bsdf_sample_model body_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_SUBSURFACE
#include "bsdf/subsurface.h"
#define CDL_SHADE_LIT 1
#define CDL_SHADE_TRANSMITS 0
#define CDL_SHADE_ENTERS 1
#define BsdfParams SubsurfaceParams
#define bsdf_params subsurface_params
#define bsdf_evaluate subsurface_evaluate
#define bsdf_sample_model subsurface_sample
#elif CDL_SHADE_MODEL == CDL_MODEL_SUBSURFACE_EXIT
#include "bsdf/subsurface.h"
#define CDL_SHADE_LIT 1
#define CDL_SHADE_TRANSMITS 0
#define CDL_SHADE_LEAVES 1
#define BsdfParams SubsurfaceExitParams
#define bsdf_params subsurface_exit_params
#define bsdf_evaluate subsurface_exit_evaluate
#define bsdf_sample_model subsurface_exit_sample
#else
#error "CDL_SHADE_MODEL names no material model that scatters light"
#endif

#endif
