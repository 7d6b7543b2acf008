#pragma once

#include "scene/collada/context.hpp"

namespace stromboli::collada {

/// Adds everything the document's <scene> shows to context.scene. Throws SceneError where the
/// document makes no sense, <instance_node> cycles included.
void readVisualScene(Context& context);

} // namespace stromboli::collada
