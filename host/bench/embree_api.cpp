#include "host/bench/embree_api.hpp"

#include "host/core/system.hpp"

namespace stromboli::bench {
namespace {

EmbreeApi load() {
    EmbreeApi api;
    SharedLibrary library("libembree3.so.3", "libembree3-3");
#define STROMBOLI_EMBREE_FIND(name) library.find(api.name, #name);
    STROMBOLI_EMBREE_FUNCTIONS(STROMBOLI_EMBREE_FIND)
#undef STROMBOLI_EMBREE_FIND
    api.missing = library.missing();
    return api;
}

} // namespace

const EmbreeApi& embreeApi() {
    static const EmbreeApi api = load();
    return api;
}

} // namespace stromboli::bench
