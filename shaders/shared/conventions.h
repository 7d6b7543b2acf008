// Rules of shading by which renderers differ and that the kernel follows: one table, from which GLSL has a constant for
// each, C++ the bits of those that do not hold (host/kernel/kernel_features.cpp), and `stromboli info` their lines.
#ifndef STROMBOLI_SHARED_CONVENTIONS_H
#define STROMBOLI_SHARED_CONVENTIONS_H

// CONVENTION(bit, member, name, otherwise):
//   bit        of DEPARTURES (features.h), set where the rule does not hold
//   member     of ShadingConventions (host/render/estimator.hpp), which says what the rule is
//   name       of its constant in GLSL, true where the rule holds
//   otherwise  what `info` calls a kernel in which it does not
#define CONVENTION_LIST(CONVENTION) \
    CONVENTION(1u, facesForward, FACES_FORWARD, "normals as they are stored") \
    CONVENTION(2u, testsGeometricSide, TESTS_GEOMETRIC_SIDE, "light on either side of the flat surface") \
    CONVENTION(4u, exactFresnel, EXACT_FRESNEL, "approximations of Fresnel's equations") \
    CONVENTION(8u, exactLambda, EXACT_LAMBDA, "another Lambda of Beckmann's facets") \
    CONVENTION(16u, compressesRadiance, COMPRESSES_RADIANCE, "refraction divides radiance") \
    CONVENTION(32u, bouncesFindAllLight, BOUNCES_FIND_ALL_LIGHT, "bounces find emission after mirrors and glass alone") \
    CONVENTION(64u, inverseSquareFalloff, INVERSE_SQUARE_FALLOFF, "area lights fall off with the distance") \
    CONVENTION(128u, ambientAboutNormal, AMBIENT_ABOUT_NORMAL, "ambient light from above alone")

#endif
