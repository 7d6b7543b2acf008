#pragma once

namespace stromboli {

struct Scene;

/// Where volumes whose borders do not say what is outside (Material::outsideIsOpen) may overlap
/// each other or what borders bound that say it, puts their media first in the scene, that of the
/// smallest volume last: of those in which a place is, the last one counts. A clear one gets a
/// medium that does nothing. Elsewhere, or where there are more than can be told apart, what
/// surrounds the scene is outside of each. They may overlap if boxes around them do: one for each
/// object and material of volumes, and for each pair of media that others have on both sides.
void orderVolumes(Scene& scene);

} // namespace stromboli
