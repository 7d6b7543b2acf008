#pragma once

namespace stromboli {

struct Scene;

/// Where volumes whose borders do not say what is outside (Material::outsideIsOpen) may overlap,
/// puts their media first in the scene, that of the smallest volume last: of those in which a place
/// is, the last one counts. A clear one gets a medium that does nothing. Elsewhere, or where there
/// are more than can be told apart, what surrounds the scene is outside of each. Volumes may
/// overlap if the boxes around two of them do: one for each object and material.
void orderVolumes(Scene& scene);

} // namespace stromboli
