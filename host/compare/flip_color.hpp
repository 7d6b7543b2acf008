#pragma once

#include <glm/glm.hpp>

namespace stromboli::compare {

/// Linear sRGB to YCxCz, the opponent space of iCAM (Moroney 2002; FLIP paper, section 4.1) for
/// the white of sRGB: white has Y = 100, Cx = Cz = 0.
glm::dvec3 yccFromLinear(const glm::dvec3& rgb);
glm::dvec3 linearFromYcc(const glm::dvec3& ycc);

/// CIE L*a*b* of linear sRGB, a and b scaled by L / 100: the Hunt effect, by which colours are
/// less colourful in the dark.
glm::dvec3 huntLabFromLinear(const glm::dvec3& rgb);

/// |dL| + sqrt(da^2 + db^2) (Abasi et al. 2020), a distance for large differences of colour.
double hyAb(const glm::dvec3& a, const glm::dvec3& b);

} // namespace stromboli::compare
