/* all_layers.h: glTF's material with all its layers, for what looks at one material alone. */
#ifndef CDL_BSDF_ALL_LAYERS_H
#define CDL_BSDF_ALL_LAYERS_H

#define CDL_GLTF_ANISOTROPY
#define CDL_GLTF_CLEARCOAT
#define CDL_GLTF_SHEEN
#define CDL_GLTF_IRIDESCENCE
#define CDL_GLTF_TRANSMISSION
#define CDL_GLTF_DIFFUSE_TRANSMISSION
#define CDL_GLTF_RETROREFLECTION
#define CDL_GLTF_DISPERSION

#endif
