// Directional albedos of the lobes of the principled material: how much of the light that arrives
// from everywhere with radiance 1 a lobe sends towards wo. They are polynomials, fitted to
// integrals by tools of numerical analysis; since the material's layers are defined by them, kernel
// and reference share this text. tests/reference/principled_test.cpp integrates the lobes and
// states the errors. Notation: mu is the cosine of wo, alpha the roughness parameter of the lobe.
#ifndef STROMBOLI_SHARED_ALBEDO_FITS_H
#define STROMBOLI_SHARED_ALBEDO_FITS_H

#include "language.h"

SHARED_BEGIN

#ifdef __cplusplus
#define FIT_FUNCTION inline
using Real = double;
using std::max;
using std::sqrt;
#else
#define FIT_FUNCTION
#define Real float
#endif

/// The albedo of isotropic GGX, height-correlated Smith, whose microfacets reflect everything.
/// alpha in [1e-4, 1]; relative error below 0.0041. It is 1 at grazing views, and for alpha 0; the
/// variable keeps the shape of the dip between the two, which is at mu near alpha.
FIT_FUNCTION Real ggxAlbedo(Real mu, Real alpha) {
    const Real x = mu / (mu + 0.5f * alpha);
    const Real c0 =
        0.084475523f +
        alpha * (-0.033691581f +
                 alpha * (-2.8230625f + alpha * (-0.20897105f + alpha * (0.56595982f))));
    const Real c1 =
        -3.068398f +
        alpha * (2.4844934f + alpha * (-4.7855223f + alpha * (32.307938f + alpha * (-18.31787f))));
    const Real c2 =
        12.976449f +
        alpha * (-14.007976f + alpha * (39.28505f + alpha * (-171.60414f + alpha * (98.142109f))));
    const Real c3 =
        -23.964021f +
        alpha * (24.855181f + alpha * (-77.974242f + alpha * (319.0075f + alpha * (-184.2964f))));
    const Real c4 =
        14.150874f +
        alpha * (-13.490354f + alpha * (37.192726f + alpha * (-195.44868f + alpha * (117.68722f))));
    const Real p = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4))));
    return 1.0f + x * (1.0f - x) * p;
}

/// The mean of that albedo over all views, weighted with their cosines. Absolute error below
/// 0.0031.
FIT_FUNCTION Real ggxMeanAlbedo(Real alpha) {
    return 1.0f +
           alpha * (-0.03810833f +
                    alpha * (-2.7678619f +
                             alpha * (5.0458974f + alpha * (-4.2274551f + alpha * (1.3983502f)))));
}

/// The mean of Schlick's Fresnel term over the hemisphere, weighted with the cosine, is f0 + (f90 -
/// f0) times this, the integral of 2 x (1 - x)^5.
SHARED_CONST float MEAN_SCHLICK_WEIGHT = 1.0f / 21.0f;

/// The mean of (1 - cos)^5 over what that lobe reflects, cos being that of wo and the half vector:
/// with Schlick's Fresnel term the lobe's albedo is ggxAlbedo * (f0 + (f90 - f0) schlickShare).
/// Absolute error below 0.0075. The polynomial is of the cosine whose fifth power does, over
/// sqrt(mu^2 + alpha^2).
FIT_FUNCTION Real schlickShare(Real mu, Real alpha) {
    const Real x = mu / (mu + alpha);
    const Real s = sqrt(alpha);
    const Real c0 =
        4.9420608f + s * (-18.667707f + s * (35.856884f + s * (-33.666305f + s * (12.007084f))));
    const Real c1 =
        -1.9039975f + s * (10.483066f + s * (-18.27861f + s * (12.755835f + s * (-2.352089f))));
    const Real c2 =
        -6.4413663f + s * (34.770178f + s * (-63.757525f + s * (56.795019f + s * (-25.013748f))));
    const Real c3 =
        1.2302756f + s * (-24.221509f + s * (38.640751f + s * (-31.304544f + s * (29.944734f))));
    const Real c4 =
        3.1426466f + s * (-0.82574003f + s * (-0.81755015f + s * (10.95365f + s * (-29.685334f))));
    const Real p = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4))));
    const Real left = max(1.0f - sqrt(mu * mu + alpha * alpha) * p, Real(0.0f));
    const Real square = left * left;
    return square * square * left;
}

/// The albedo of the sheen of colour 1. alpha in [LEAST_SHEEN_ALPHA, 1], mu >= LEAST_SHEEN_COSINE;
/// above the truth by no more than 0.032 and never below it by more than 1e-3, so that what is
/// beneath never makes the sum exceed 1.
FIT_FUNCTION Real sheenAlbedo(Real mu, Real alpha) {
    const Real x = sqrt(mu);
    const Real s = sqrt(alpha);
    const Real c0 =
        2.1081554f + s * (-7.4667158f + s * (13.571806f + s * (-9.7279823f + s * (2.3356077f))));
    const Real c1 =
        2.629073f + s * (-1.9987176f + s * (6.0893018f + s * (-4.1467677f + s * (0.35596779f))));
    const Real c2 =
        -48.441958f + s * (165.41924f + s * (-331.68401f + s * (277.29171f + s * (-82.796769f))));
    const Real c3 =
        110.63096f + s * (-393.06508f + s * (796.93714f + s * (-680.53233f + s * (209.61713f))));
    const Real c4 =
        -97.27201f + s * (329.58732f + s * (-670.70359f + s * (573.66096f + s * (-176.91895f))));
    const Real c5 =
        30.440276f + s * (-92.951898f + s * (186.74505f + s * (-156.7779f + s * (47.258045f))));
    const Real p = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * (c5)))));
    return max(p, Real(0.0f));
}

#ifndef __cplusplus
#undef Real
#endif

SHARED_END

#endif
