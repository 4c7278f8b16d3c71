/* blackbody.h: the colour of what glows. */
#ifndef CANDELA_SCENE_BLACKBODY_H
#define CANDELA_SCENE_BLACKBODY_H

/* Radiance of a black body of `kelvin` >= 0 in linear sRGB, in units of the luminance of one of
 * 1500 K. Colours outside of sRGB, those of faint red heat, lose what is negative. */
void blackbody_radiance(float kelvin, float rgb[3]);

#endif
