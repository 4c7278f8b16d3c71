/* param_fields.h: the parameters of each material model, word by word, as surfaces hand them to
 * shading (CDL_WORK_PARAM) and as the host stores them (cdl_Material.param): CDL_<MODEL>_<NAME> is
 * the first word, CDL_<MODEL>_PARAMS how many there are. Base colour, opacity and emission are not
 * among them: all models have those. */
#ifndef CDL_ABI_PARAM_FIELDS_H
#define CDL_ABI_PARAM_FIELDS_H

#define CDL_PARAM_MAX 40u /* words of the largest model, at the most */

#define CDL_PARAM(model, name, words)                                                              \
  CDL_##model##_##name, CDL_##model##_##name##_END = CDL_##model##_##name + (words)-1

/* Index of refraction, inside over outside, > 0, at 587.6 nm; Abbe's number, 0: no dispersion. */
enum { CDL_PARAM(DIELECTRIC, IOR, 1), CDL_PARAM(DIELECTRIC, ABBE, 1), CDL_DIELECTRIC_PARAMS };

/* Microfacet alpha along tangent and bitangent; the others as above. */
enum {
  CDL_PARAM(ROUGH_DIELECTRIC, ALPHA, 2),
  CDL_PARAM(ROUGH_DIELECTRIC, IOR, 1),
  CDL_PARAM(ROUGH_DIELECTRIC, ABBE, 1),
  CDL_ROUGH_DIELECTRIC_PARAMS
};

/* Microfacet alpha along tangent and bitangent; complex index eta + i k, per channel. */
enum {
  CDL_PARAM(CONDUCTOR, ALPHA, 2),
  CDL_PARAM(CONDUCTOR, ETA, 3),
  CDL_PARAM(CONDUCTOR, K, 3),
  CDL_CONDUCTOR_PARAMS
};

/* As above; the coat's index. */
enum {
  CDL_PARAM(RETROREFLECTOR, ALPHA, 2),
  CDL_PARAM(RETROREFLECTOR, IOR, 1),
  CDL_RETROREFLECTOR_PARAMS
};

/* glTF's factors, [0,1]: alpha is the square of roughness. */
enum {
  CDL_PARAM(GLTF, METALLIC, 1),
  CDL_PARAM(GLTF, ROUGHNESS, 1),
  CDL_PARAM(GLTF, IOR, 1),
  CDL_GLTF_PARAMS
};

/* The same three and those of the extensions, [0,1] unless it says otherwise: colours of three
 * words; ROTATION is the cosine and sine of the angle, DIRECTION a vector of any length in the
 * tangent plane; indices > 0, thickness of the film in nm, THICKNESS > 0 where the surface bounds a
 * volume; DISPERSION is 20 over Abbe's number. */
enum {
  CDL_PARAM(GLTF_LAYERED, METALLIC, 1),
  CDL_PARAM(GLTF_LAYERED, ROUGHNESS, 1),
  CDL_PARAM(GLTF_LAYERED, IOR, 1),
  CDL_PARAM(GLTF_LAYERED, SPECULAR, 1),
  CDL_PARAM(GLTF_LAYERED, SPECULAR_COLOR, 3), /* >= 0 */
  CDL_PARAM(GLTF_LAYERED, ANISOTROPY_STRENGTH, 1),
  CDL_PARAM(GLTF_LAYERED, ANISOTROPY_ROTATION, 2),
  CDL_PARAM(GLTF_LAYERED, ANISOTROPY_DIRECTION, 2),
  CDL_PARAM(GLTF_LAYERED, CLEARCOAT, 1),
  CDL_PARAM(GLTF_LAYERED, CLEARCOAT_ROUGHNESS, 1),
  CDL_PARAM(GLTF_LAYERED, SHEEN_COLOR, 3),
  CDL_PARAM(GLTF_LAYERED, SHEEN_ROUGHNESS, 1),
  CDL_PARAM(GLTF_LAYERED, IRIDESCENCE, 1),
  CDL_PARAM(GLTF_LAYERED, IRIDESCENCE_IOR, 1),
  CDL_PARAM(GLTF_LAYERED, IRIDESCENCE_THICKNESS, 1),
  CDL_PARAM(GLTF_LAYERED, TRANSMISSION, 1),
  CDL_PARAM(GLTF_LAYERED, THICKNESS, 1),
  CDL_PARAM(GLTF_LAYERED, DISPERSION, 1),
  CDL_PARAM(GLTF_LAYERED, DIFFUSE_TRANSMISSION, 1),
  CDL_PARAM(GLTF_LAYERED, DIFFUSE_TRANSMISSION_COLOR, 3),
  CDL_PARAM(GLTF_LAYERED, RETROREFLECTION, 1),
  CDL_GLTF_LAYERED_PARAMS
};

/* [0,1] */
enum { CDL_PARAM(OREN_NAYAR, ROUGHNESS, 1), CDL_OREN_NAYAR_PARAMS };

/* Microfacet alpha of the coat along tangent and bitangent; its index, [1,3]. */
enum { CDL_PARAM(PLASTIC, ALPHA, 2), CDL_PARAM(PLASTIC, IOR, 1), CDL_PLASTIC_PARAMS };

/* As plastic's. */
enum { CDL_PARAM(BODY, ALPHA, 2), CDL_PARAM(BODY, IOR, 1), CDL_BODY_PARAMS };

/* As plastic's; mean free paths in m. What profiles have found from them and from the albedo,
 * filled in by shading: bsdf/profile.h. */
enum {
  CDL_PARAM(SUBSURFACE, ALPHA, 2),
  CDL_PARAM(SUBSURFACE, IOR, 1),
  CDL_PARAM(SUBSURFACE, RADIUS, 3),
  CDL_PARAM(SUBSURFACE, SLOPE, 3),
  CDL_PARAM(SUBSURFACE, REACH, 3),
  CDL_SUBSURFACE_PARAMS
};

/* Burley's names and ranges: all [0,1] but IOR > 0 and DIFF_TRANS [0,2]; THIN is 0 or 1. */
enum {
  CDL_PARAM(DISNEY, METALLIC, 1),
  CDL_PARAM(DISNEY, ROUGHNESS, 1),
  CDL_PARAM(DISNEY, ANISOTROPIC, 1),
  CDL_PARAM(DISNEY, SPECULAR, 1),
  CDL_PARAM(DISNEY, SPECULAR_TINT, 1),
  CDL_PARAM(DISNEY, SHEEN, 1),
  CDL_PARAM(DISNEY, SHEEN_TINT, 1),
  CDL_PARAM(DISNEY, CLEARCOAT, 1),
  CDL_PARAM(DISNEY, CLEARCOAT_GLOSS, 1),
  CDL_PARAM(DISNEY, SUBSURFACE, 1),
  CDL_PARAM(DISNEY, SPEC_TRANS, 1),
  CDL_PARAM(DISNEY, IOR, 1),
  CDL_PARAM(DISNEY, DIFF_TRANS, 1),
  CDL_PARAM(DISNEY, FLATNESS, 1),
  CDL_PARAM(DISNEY, THIN, 1),
  CDL_DISNEY_PARAMS
};

#undef CDL_PARAM

#endif
