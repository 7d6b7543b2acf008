#include "scene/collada/load_collada.hpp"
#include "scene/collada/zae.hpp"
#include "scene/xml/root_element.hpp"

namespace stromboli {

bool looksLikeCollada(std::string_view beginning) {
    return xml::hasRootElement(beginning, "COLLADA");
}

bool looksLikeColladaArchive(std::string_view beginning) {
    return collada::isArchive(beginning);
}

} // namespace stromboli
