// Directional albedos of the lobes of the principled material: how much of the light that arrives from
// everywhere with radiance 1 a lobe sends towards wo. They are polynomials, fitted to integrals by
// tools of numerical analysis; since the material's layers are defined by them, kernel and reference
// share this text. tests/reference/principled_test.cpp integrates the lobes and states the errors.
// Notation: mu is the cosine of wo, alpha the roughness parameter of the lobe.
#ifndef STROMBOLI_SHARED_ALBEDO_FITS_H
#define STROMBOLI_SHARED_ALBEDO_FITS_H

#include "language.h"

SHARED_BEGIN

#ifdef __cplusplus
#define SHARED_FUNCTION inline
using Real = double;
using std::max;
using std::sqrt;
#else
#define SHARED_FUNCTION
#define Real float
#endif

/// Of isotropic GGX, height-correlated Smith, whose microfacets reflect everything. alpha in [1e-4, 1];
/// relative error below 0.0041. It is 1 at grazing views, and for alpha 0; the variable keeps the shape of
/// the dip between the two, which is at mu near alpha.
SHARED_FUNCTION Real ggxAlbedo(Real mu, Real alpha) {
    const Real x = mu / (mu + 0.5f * alpha);
    const Real c0 = 0.063645441f + alpha * (0.57462054f + alpha * (-5.7744486f + alpha * (3.9777363f + alpha * (-1.2535292f))));
    const Real c1 = -2.6934253f + alpha * (-6.1303902f + alpha * (34.117205f + alpha * (-21.722344f + alpha * (5.0063511f))));
    const Real c2 = 11.302412f + alpha * (20.477148f + alpha * (-110.70828f + alpha * (34.219395f + alpha * (9.6885666f))));
    const Real c3 = -21.311791f + alpha * (-26.562658f + alpha * (140.9631f + alpha * (20.652422f + alpha * (-56.442199f))));
    const Real c4 = 12.775418f + alpha * (12.239065f + alpha * (-71.008846f + alpha * (-48.557171f + alpha * (54.844075f))));
    const Real p = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4))));
    return 1.0f + x * (1.0f - x) * p;
}

/// The mean of (1 - cos)^5 over what that lobe reflects, cos being that of wo and the half vector: with
/// Schlick's Fresnel term the lobe's albedo is ggxAlbedo * (f0 + (f90 - f0) schlickShare). Absolute error
/// below 0.0066. The polynomial is of the cosine whose fifth power does, over sqrt(mu^2 + alpha^2).
SHARED_FUNCTION Real schlickShare(Real mu, Real alpha) {
    const Real x = mu / (mu + alpha);
    const Real s = sqrt(alpha);
    const Real c0 = 4.8348754f + s * (-17.764184f + s * (33.290202f + s * (-30.696014f + s * (10.804122f))));
    const Real c1 = -2.0165408f + s * (13.459109f + s * (-30.422638f + s * (29.884974f + s * (-10.24853f))));
    const Real c2 = -5.2056841f + s * (16.932336f + s * (2.5533094f + s * (-34.555632f + s * (17.093255f))));
    const Real c3 = 0.5832923f + s * (-14.804025f + s * (1.875059f + s * (17.515711f + s * (9.0192016f))));
    const Real c4 = 2.786188f + s * (2.847079f + s * (-7.1991678f + s * (17.631278f + s * (-36.403325f))));
    const Real p = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4))));
    const Real left = max(1.0f - sqrt(mu * mu + alpha * alpha) * p, Real(0.0f));
    const Real square = left * left;
    return square * square * left;
}

/// Of the sheen of colour 1. alpha in [LEAST_SHEEN_ALPHA, 1], mu >= LEAST_SHEEN_COSINE; above the truth
/// by no more than 0.032 and never below it by more than 1e-3, so that what is beneath never makes the sum exceed 1.
SHARED_FUNCTION Real sheenAlbedo(Real mu, Real alpha) {
    const Real x = sqrt(mu);
    const Real s = sqrt(alpha);
    const Real c0 = 2.1081554f + s * (-7.4667158f + s * (13.571806f + s * (-9.7279823f + s * (2.3356077f))));
    const Real c1 = 2.629073f + s * (-1.9987176f + s * (6.0893018f + s * (-4.1467677f + s * (0.35596779f))));
    const Real c2 = -48.441958f + s * (165.41924f + s * (-331.68401f + s * (277.29171f + s * (-82.796769f))));
    const Real c3 = 110.63096f + s * (-393.06508f + s * (796.93714f + s * (-680.53233f + s * (209.61713f))));
    const Real c4 = -97.27201f + s * (329.58732f + s * (-670.70359f + s * (573.66096f + s * (-176.91895f))));
    const Real c5 = 30.440276f + s * (-92.951898f + s * (186.74505f + s * (-156.7779f + s * (47.258045f))));
    const Real p = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * (c5)))));
    return max(p, Real(0.0f));
}

#ifndef __cplusplus
#undef Real
#endif

SHARED_END

#endif
