#include "host/manual/proposals.hpp"

#include "scene/find_scene.hpp"
#include "scene/generate/generated_scene.hpp"

#include <fmt/format.h>

namespace stromboli {

Words proposalsOf(const CommandOption& o) {
    Words words = o.proposals;
    if (o.proposed != Proposed::Scenes) return words;
    const Words bundled = librarySceneNames();
    words.insert(words.end(), bundled.begin(), bundled.end());
    for (const std::string_view made : kGeneratedScenes)
        words.push_back(fmt::format("{}{}", kGeneratePrefix, made));
    return words;
}

} // namespace stromboli
