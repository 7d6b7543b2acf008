// Media as the kernel reads them (scene/model/medium.hpp). A medium is a material of the material buffer whose closure
// is its phase function, so that a point in it is a point where paths scatter like any other; its header is followed by a
// MediumBody. In scenes with media every material has a MediumBorder in front of its header.
#ifndef STROMBOLI_SHARED_MEDIUM_TYPES_H
#define STROMBOLI_SHARED_MEDIUM_TYPES_H

#include "language.h"

SHARED_BEGIN

/// F(name, bit, label): what the media of a scene have (the feature MEDIA); label: what `stromboli info` calls it.
#define MEDIA_LIST(F) \
    F(MEDIA_DIM, 0, "extinction") \
    F(MEDIA_SCATTER, 1, "scattering") \
    F(MEDIA_SHINE, 2, "emission") \
    F(MEDIA_VARY, 3, "grids of densities") \
    F(MEDIA_MIX, 4, "sums of phase functions") \
    F(MEDIA_VARY_EXTINCTION, 5, "extinction of varying colours") \
    F(MEDIA_VARY_SCATTERING, 6, "scattering of varying colours") \
    F(MEDIA_VARY_SOURCE, 7, "emission of varying colours") \
    F(MEDIA_GLOW, 8, "glow by temperature") \
    F(MEDIA_UNDER_SURFACE, 9, "walks under surfaces") \
    F(MEDIA_OVERLAP, 10, "volumes that overlap")

#define NAME_MEDIA(name, bit, label) SHARED_CONST uint name = 1u << bit;
MEDIA_LIST(NAME_MEDIA)
#undef NAME_MEDIA

/// Scatterings of a path under surfaces end with this one: it is in a white medium that it does not leave.
SHARED_CONST uint MOST_UNDER_SURFACE = 65536u;

/// No medium begins at that row.
SHARED_CONST uint NO_MEDIUM = 0xFFFFFFFFu;

/// What is on both sides of a surface.
struct MediumBorder {
    uint inside;  ///< the first row of the medium where the stored normal does not point to, or NO_MEDIUM
    uint outside; ///< likewise, on the other side
    uint isBorder; ///< 0: light that passes the surface stays in its medium; else BORDER_OF_MEDIA or BORDER_OF_VOLUME
    uint volume; ///< of a border of a volume: its number, from 1 to MOST_VOLUMES, and from bit 8 on the rows of a medium
};
/// It says what is on both sides.
SHARED_CONST uint BORDER_OF_MEDIA = 1u;
/// It is of a volume that may overlap others (MEDIA_OVERLAP): of those in which a place is, the one of the largest number
/// counts. Their media lie one after the other, in order.
SHARED_CONST uint BORDER_OF_VOLUME = 2u;
SHARED_CONST uint MOST_VOLUMES = 255u;
SHARED_ROWS(MediumBorder, 1);
SHARED_CONST uint MEDIUM_BORDER_ROWS = 1u;

struct MediumBody {
    vec3 extinction; ///< per metre, times the density
    float asymmetry; ///< of Henyey and Greenstein's function, or RAYLEIGH_ASYMMETRY
    vec3 albedo;     ///< the share of the extinction that is scattering
    uint grid;       ///< the row of its GridHeader; 0: the density is 1 everywhere
    vec3 emission;   ///< radiance per metre, times the density
    float mostExtinction; ///< the largest component, which the bounds of a grid are multiplied by
};
SHARED_ROWS(MediumBody, 3);
SHARED_CONST uint MEDIUM_BODY_ROW = 1u; ///< of a medium, its header counted

/// Where some medium has a sum of phase functions (MEDIA_MIX): two beside that of the body, which has the rest of the
/// shares.
struct PhaseMixture {
    float asymmetry1, share1; ///< share: 0 where there is none
    float asymmetry2, share2;
};
SHARED_ROWS(PhaseMixture, 1);
SHARED_CONST uint MEDIUM_PHASES_ROW = 4u; ///< of a medium, its header counted
/// In place of an asymmetry: Rayleigh's function.
SHARED_CONST float RAYLEIGH_ASYMMETRY = 2.0f;

/// Where colours of some medium vary (MEDIA_VARY_ bits), which of its do: rows of ColorGridHeaders, or 0.
struct MediumTints {
    uint scattering;
    uint source; ///< radiance; with a glow a factor of it and a temperature
    uint glow;   ///< the row of a GlowHeader, or 0
    uint kinds;  ///< TINT_ bits
};
SHARED_ROWS(MediumTints, 1);
SHARED_CONST uint MEDIUM_TINTS_ROW = 5u; ///< of a medium, its header counted
/// The values of the medium's grid are colours, a row each: factors of the extinction.
SHARED_CONST uint TINT_EXTINCTION = 1u;
/// Scattering has factors of the medium's extinction; else shares of that at the place.
SHARED_CONST uint TINT_SCATTERING_IS_FACTOR = 2u;

/// The lamps about which distances are drawn in a medium that is the same everywhere (scene/model/light_foci.hpp), as
/// many as the feature FOCI says.
struct MediumFoci {
    uint first;   ///< row of the first LightFocus; 0: there is none
    float others; ///< radiance that other lights give to surfaces
    uint unused0, unused1;
};
SHARED_ROWS(MediumFoci, 1);
SHARED_CONST uint MEDIUM_FOCI_ROW = 6u; ///< of a medium, its header counted

struct LightFocus {
    vec3 point;
    float radius;    ///< of a sphere that holds the lamp; > 0
    float intensity; ///< luminance of the mean over all directions
    float radiance;  ///< luminance of what its surface sends out
    uint unused0, unused1;
};
SHARED_ROWS(LightFocus, 2);

/// A grid of colours, a row for each cell, x changing fastest.
struct ColorGridHeader {
    vec4 toUnit0, toUnit1, toUnit2; ///< rows of the matrix from the world to the unit cube
    uint sizeX, sizeY, sizeZ;
    uint values; ///< row of the first one
};
SHARED_ROWS(ColorGridHeader, 4);

/// Light of black bodies, at equal steps of 1 / temperature: rows of red, green and blue over the luminance, and its
/// logarithm.
struct GlowHeader {
    float coldest; ///< kelvins
    float start, perInverse; ///< the place in the table is perInverse * (1 / temperature - start)
    uint values; ///< row of the first one
    float last; ///< its number
    uint unused0, unused1, unused2;
};
SHARED_ROWS(GlowHeader, 2);

/// A grid of densities. Between the middles of its cells, which fill the unit cube, densities are interpolated.
struct GridHeader {
    vec4 toUnit0, toUnit1, toUnit2; ///< rows of the matrix from the world to the unit cube
    uint sizeX, sizeY, sizeZ;
    uint values; ///< row of the first GridValue, x changing fastest
    uint blocksX, blocksY, blocksZ; ///< the unit cube in equal blocks
    uint bounds; ///< row of the first four upper bounds of the density in a block, x changing fastest
};
SHARED_ROWS(GridHeader, 5);
/// The density of a cell, and of its neighbours in +x, +y and both; that of the last cell beyond the end.
struct GridValue {
    vec4 corners;
};
SHARED_ROWS(GridValue, 1);
SHARED_CONST uint MOST_BLOCKS = 16u; ///< along an axis
/// Tentative collisions and blocks that a ray is tracked through at a time: a driver may limit what loops take.
SHARED_CONST uint GRID_STEPS = 32u;

SHARED_END

#endif
