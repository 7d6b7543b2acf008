#include "host/bench/bench_scene.hpp"

#include "scene/find_scene.hpp"
#include "scene/read_scene.hpp"

namespace stromboli::bench {

BenchScene loadBenchScene(const std::string& name) {
    return {name, sceneFile(name), readScene(name)};
}

} // namespace stromboli::bench
