#include "scene/obj/materials.hpp"

#include "scene/obj/load_obj.hpp"
#include "scene/obj/material_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace stromboli::obj {

Materials::Materials(const std::filesystem::path& file, build::SceneBuilder& builder)
    : folder_(file.parent_path()), ownLibrary_(file.stem().string() + ".mtl"), builder_(builder),
      pictures_(folder_, builder) {}

namespace {

std::string_view withoutQuotes(std::string_view name) {
    const bool isQuoted = name.size() > 2 && name.starts_with('"') && name.ends_with('"');
    return isQuoted ? name.substr(1, name.size() - 2) : name;
}

/// What names have in common that stand for one material: no comment behind them, no quotation
/// marks, small letters.
std::string coreOf(std::string_view name) {
    const size_t comment = name.find(" #");
    if (comment != std::string_view::npos && comment > 0) name = name.substr(0, comment);
    while (name.ends_with(' ') || name.ends_with('\t'))
        name.remove_suffix(1);
    return inSmallLetters(withoutQuotes(name));
}

} // namespace

/// The specification separates names by spaces; programs write one name, with spaces in it.
void Materials::addLibraries(const Statements& statement) {
    if (addLibrary(statement.rest(), statement.place()) ||
        addMeantLibrary(statement.rest(), statement.place()))
        return;
    bool foundAll = true;
    for (Words words(statement.rest()); !words.atEnd();)
        foundAll = addLibrary(words.next(), statement.place()) && foundAll;
    if (foundAll && !statement.rest().empty()) return;
    builder_.report().forgive(
        statement.place(),
        fmt::format("'{}' is not in the file's folder", shortened(statement.rest())),
        "its materials are not known");
}

bool Materials::addLibrary(std::string_view name, const build::FilePlace& where) {
    const build::Companion library = build::companion(folder_, name);
    const std::optional<std::filesystem::path>& file = library.path;
    if (!file) return false;
    if (!library.problem.empty())
        builder_.report().forgive(where, library.problem, library.reading);
    if (std::find(libraries_.begin(), libraries_.end(), file->string()) != libraries_.end())
        return true;
    libraries_.push_back(file->string());
    for (MtlMaterial& material : readMtlFile(*file, builder_.report())) {
        const std::string key = material.name;
        const auto [found, isNew] = stated_.try_emplace(key, std::move(material));
        if (!isNew)
            builder_.report().forgive(material.place, "a material of this name is there already",
                                      "the first one counts");
    }
    return true;
}

/// Programs write names in quotation marks, as URIs, or without their ending.
bool Materials::addMeantLibrary(std::string_view written, const build::FilePlace& where) {
    std::string name(withoutQuotes(written));
    for (const std::string_view scheme : {"file://", "file:"})
        if (name.starts_with(scheme)) name.erase(0, scheme.size());
    if (name.empty()) return false;
    for (const std::string& reading : {name, name + ".mtl"}) {
        if (reading == written || !addLibrary(reading, where)) continue;
        builder_.report().forgive(where, fmt::format("'{}' is not there", shortened(written)),
                                  fmt::format("'{}' is taken", shortened(reading)));
        return true;
    }
    return false;
}

/// Files get other names, and the one that an OBJ file names is not there then.
void Materials::addOwnLibrary(const build::FilePlace& where) {
    const std::string name = std::exchange(ownLibrary_, "");
    const size_t before = libraries_.size();
    if (name.empty() || !addLibrary(name, where) || libraries_.size() == before) return;
    builder_.report().forgive(where, "no library that is named has this material",
                              fmt::format("'{}' beside the file is read", shortened(name)));
}

uint32_t Materials::nameNumber(const Statements& statement) {
    const auto [found, isNew] =
        useNumbers_.try_emplace(std::string(statement.rest()), uint32_t(uses_.size()));
    if (isNew) uses_.push_back({found->first, statement.place()});
    return found->second;
}

const BoundMaterial& Materials::unknown(uint32_t name) {
    const auto [grey, isNew] = made_.try_emplace(name);
    if (!isNew) return grey->second;
    Material material = build::greyMaterial();
    material.name = uses_[name].name;
    builder_.conventions().onUnknownMaterial(material.name);
    grey->second.number = builder_.addMaterial(std::move(material));
    return grey->second;
}

/// The stated name that a use stands for; of several ones the first of the alphabet.
std::optional<std::string> Materials::meant(const Use& use) {
    const std::string core = coreOf(use.name);
    std::optional<std::string> found;
    for (const auto& [name, material] : stated_)
        if (coreOf(name) == core && (!found || name < *found)) found = name;
    if (found)
        builder_.report().forgive(
            use.place,
            fmt::format("there is no material '{}', but '{}'", shortened(use.name),
                        shortened(*found)),
            "names are compared without quotation marks, comments and capitals");
    return found;
}

const BoundMaterial& Materials::of(std::optional<uint32_t> name) {
    if (name && !stated_.contains(uses_[*name].name)) addOwnLibrary(uses_[*name].place);
    if (name && !stated_.contains(uses_[*name].name))
        if (std::optional<std::string> found = meant(uses_[*name]))
            uses_[*name].name = std::move(*found);
    if (name && !stated_.contains(uses_[*name].name)) {
        const Use& use = uses_[*name];
        if (builder_.conventions().onUnknownMaterial) return unknown(*name);
        builder_.report().forgive(use.place,
                                  fmt::format("there is no material '{}'", shortened(use.name)),
                                  "such a surface is mid grey");
        name.reset();
    }
    if (!name) {
        if (!standard_) standard_ = BoundMaterial{builder_.defaultMaterial(), false, false};
        return *standard_;
    }
    const auto found = made_.find(*name);
    if (found != made_.end()) return found->second;
    return made_.emplace(*name, make(stated_.at(uses_[*name].name))).first->second;
}

BoundMaterial Materials::make(const MtlMaterial& stated) {
    Material material = materialOf(stated, builder_, pictures_);
    BoundMaterial bound;
    bound.isTextured = !material.textures.empty();
    bound.wantsTangents = material.principled.anisotropy > 0;
    for (const TextureUse& use : material.textures)
        bound.wantsTangents = bound.wantsTangents || use.slot == TextureSlot::Normal;
    bound.number = builder_.addMaterial(std::move(material));
    return bound;
}

} // namespace stromboli::obj
