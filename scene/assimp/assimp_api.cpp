#include "scene/assimp/assimp_api.hpp"

#include <dlfcn.h>

namespace stromboli::assimp {
namespace {

constexpr const char* kLibrary = "libassimp.so.5";

AssimpApi load() {
    AssimpApi api;
    void* library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        api.missing =
            std::string(kLibrary) + " is not installed; on Debian: apt install libassimp5";
        return api;
    }
    const auto find = [&](auto& function, const char* name) {
        function =
            reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
        if (!function) api.missing = std::string(kLibrary) + " has no " + name;
    };
    find(api.importFile, "aiImportFile");
    find(api.releaseImport, "aiReleaseImport");
    find(api.errorString, "aiGetErrorString");
    find(api.materialColor, "aiGetMaterialColor");
    find(api.materialFloats, "aiGetMaterialFloatArray");
    find(api.materialString, "aiGetMaterialString");
    return api;
}

} // namespace

const AssimpApi& assimpApi() {
    static const AssimpApi api = load();
    return api;
}

} // namespace stromboli::assimp
