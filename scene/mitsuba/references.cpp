// What objects of a document refer to others by.

#include "scene/build/tolerate.hpp"
#include "scene/mitsuba/document_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace stromboli::mitsuba {

void DocumentReader::name(const std::string& id, Plugin& plugin, const build::FilePlace& where) {
    const auto [known, isNew] = ids_.try_emplace(id, Named{&plugin, where});
    if (!isNew)
        where.fail(fmt::format("has the id '{}', which is that of {}:{}", id,
                               known->second.place.file, known->second.place.line));
}

void DocumentReader::resolveReferences() {
    for (Plugin& plugin : document_.plugins_)
        std::erase_if(plugin.children(), [&](Plugin::Child& child) {
            if (child.plugin) return false;
            const auto found = ids_.find(child.reference);
            if (found == ids_.end()) {
                report_.replace(
                    child.place, build::Shortfall::Reference,
                    fmt::format("there is no object with the id '{}'", child.reference));
                return true;
            }
            child.plugin = found->second.plugin;
            return false;
        });
    heightOf(*document_.scene_, 0);
}

/// How many objects lie inside each other, references followed. What would make an object lie
/// inside itself, or too many inside each other, is taken out.
size_t DocumentReader::heightOf(Plugin& plugin, size_t depth) {
    const auto known = heights_.find(&plugin);
    if (known != heights_.end() && known->second == 0)
        plugin.fail("lies inside itself, by references");
    if (known != heights_.end()) return known->second;
    if (depth > kMostLevels) plugin.fail(fmt::format("lies more than {} levels deep", kMostLevels));
    heights_[&plugin] = 0;
    size_t height = 0;
    std::erase_if(plugin.children(), [&](const Plugin::Child& child) {
        return !build::tolerate(report_, build::Shortfall::Reference, [&] {
            const size_t inner = heightOf(*child.plugin, depth + 1);
            if (inner >= kMostLevels)
                child.plugin->fail(
                    fmt::format("has more than {} levels of objects in it", kMostLevels));
            height = std::max(height, inner);
        });
    });
    return heights_[&plugin] = height + 1;
}

} // namespace stromboli::mitsuba
