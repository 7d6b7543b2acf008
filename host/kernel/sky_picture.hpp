#pragma once

#include "host/core/random.hpp"
#include "host/kernel/sampling_tables.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace stromboli {

/// Directions to an environment on the host, as light samples of the kernel take them by its weight
/// alone, but for the interpolation of texels. Refers to the table.
class SkyPicture {
  public:
    /// table: of an environment that is not black.
    explicit SkyPicture(const EnvironmentTable& table);

    /// Unit.
    glm::dvec3 sample(Random& random) const;

  private:
    const EnvironmentTable& table_;
    std::vector<double> tiles_; ///< probabilities, summed up
};

} // namespace stromboli
