#pragma once

#include <vector>

namespace stromboli {

/// A rule for integrals over [0, 1]: the sum of weight[i] f(at[i]).
struct Quadrature {
    std::vector<double> at, weight;
};

/// Gauss and Legendre's rule, which is exact for polynomials of degrees below 2 count. From the
/// greatest place on, each right to a few units of rounding.
Quadrature gaussLegendre(int count);

/// The middles of `count` stretches of one length, likewise from the greatest on.
Quadrature midpoints(int count);

} // namespace stromboli
