#include "scene/collada/parameters.hpp"

#include <cstring>

namespace stromboli::collada {

const Element* findParameter(const Scope& scope, const char* sid) {
    for (const Element* place : {scope.technique, scope.profile, scope.effect})
        for (const Element& parameter : children(*place)) {
            const char* own = parameter.Attribute("sid");
            if (named(parameter, "newparam") && own && std::strcmp(own, sid) == 0)
                return &parameter;
        }
    return nullptr;
}

} // namespace stromboli::collada
