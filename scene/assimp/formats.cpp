#include "scene/assimp/load_assimp.hpp"

#include <algorithm>
#include <array>

namespace stromboli {
namespace {

/// The importers of Assimp 5.2 that make meshes.
constexpr auto kSuffixes = std::to_array<std::string_view>(
    {".3d",   ".3ds",    ".3mf",     ".ac",  ".ac3d", ".acc",     ".amf",  ".ase", ".ask",
     ".b3d",  ".blend",  ".bvh",     ".cob", ".csm",  ".dxf",     ".enff", ".fbx", ".hmp",
     ".ifc",  ".ifczip", ".iqm",     ".irr", ".lwo",  ".irrmesh", ".lws",  ".lxo", ".m3d",
     ".md2",  ".md3",    ".md5mesh", ".mdc", ".mdl",  ".ms3d",    ".ndo",  ".nff", ".off",
     ".ogex", ".pk3",    ".pmx",     ".q3o", ".q3s",  ".raw",     ".scn",  ".sib", ".smd",
     ".stl",  ".ter",    ".uc",      ".vta", ".x",    ".x3d",     ".xgl",  ".zgl"});

} // namespace

bool isAssimpFormat(const std::string& suffix) {
    return std::ranges::find(kSuffixes, suffix) != kSuffixes.end();
}

} // namespace stromboli
