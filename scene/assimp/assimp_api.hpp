#pragma once

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <string>

namespace stromboli::assimp {

/// Assimp's functions, found in its library when they are first wanted.
struct AssimpApi {
    decltype(&::aiImportFile) importFile = nullptr;
    decltype(&::aiImportFileFromMemory) importMemory = nullptr;
    decltype(&::aiApplyPostProcessing) applySteps = nullptr;
    decltype(&::aiReleaseImport) releaseImport = nullptr;
    decltype(&::aiGetErrorString) errorString = nullptr;
    decltype(&::aiGetMaterialColor) materialColor = nullptr;
    decltype(&::aiGetMaterialFloatArray) materialFloats = nullptr;
    decltype(&::aiGetMaterialString) materialString = nullptr;

    std::string missing; ///< why Assimp cannot be used; empty: it can
};

/// Loaded at the first call and never unloaded.
const AssimpApi& assimpApi();

} // namespace stromboli::assimp
