#include "host/bench/embree_api.hpp"

#include <dlfcn.h>

namespace stromboli::bench {
namespace {

constexpr const char* kLibrary = "libembree3.so.3";

EmbreeApi load() {
    EmbreeApi api;
    void* library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        api.missing = std::string(kLibrary) + " is not installed; on Debian: apt install "
                                              "libembree3-3";
        return api;
    }
    const auto find = [&](const char* name) {
        void* function = dlsym(library, name);
        if (!function) api.missing = std::string(kLibrary) + " has no " + name;
        return function;
    };
#define STROMBOLI_EMBREE_FIND(name) api.name = reinterpret_cast<decltype(api.name)>(find(#name));
    STROMBOLI_EMBREE_FUNCTIONS(STROMBOLI_EMBREE_FIND)
#undef STROMBOLI_EMBREE_FIND
    return api;
}

} // namespace

const EmbreeApi& embreeApi() {
    static const EmbreeApi api = load();
    return api;
}

} // namespace stromboli::bench
