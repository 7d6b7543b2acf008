#pragma once

#include "scene/collada/document.hpp"

namespace stromboli::collada {

/// Where a shading model's parameter can be defined, innermost first.
struct Scope {
    const Element *technique, *profile, *effect;
};

/// The <newparam> with that sid; null where there is none.
const Element* findParameter(const Scope& scope, const char* sid);

} // namespace stromboli::collada
