#pragma once

#include "host/compare/picture.hpp"

namespace stromboli::compare {

/// Mean structural similarity (Wang et al. 2004) of the grey of two pictures' sRGB signals at an
/// exposure of `stops`: Gaussian window of 11 x 11 pixels with sigma 1.5, K1 = 0.01, K2 = 0.03,
/// range 1; windows over the edge repeat the nearest pixel. 1 for equal pictures. Pictures have
/// the same size.
double ssim(const Picture& reference, const Picture& picture, double stops = 0);

} // namespace stromboli::compare
