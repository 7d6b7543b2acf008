#include "scene/assimp/assimp_api.hpp"

#include "host/core/system.hpp"

namespace stromboli::assimp {
namespace {

AssimpApi load() {
    AssimpApi api;
    SharedLibrary library("libassimp.so.5", "libassimp5");
    library.find(api.importFile, "aiImportFile");
    library.find(api.importMemory, "aiImportFileFromMemory");
    library.find(api.applySteps, "aiApplyPostProcessing");
    library.find(api.releaseImport, "aiReleaseImport");
    library.find(api.errorString, "aiGetErrorString");
    library.find(api.materialColor, "aiGetMaterialColor");
    library.find(api.materialFloats, "aiGetMaterialFloatArray");
    library.find(api.materialString, "aiGetMaterialString");
    api.missing = library.missing();
    return api;
}

} // namespace

const AssimpApi& assimpApi() {
    static const AssimpApi api = load();
    return api;
}

} // namespace stromboli::assimp
