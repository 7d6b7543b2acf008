#include "host/view/scene_loading.hpp"

#include <chrono>
#include <exception>
#include <utility>

namespace stromboli::view {

void SceneLoading::ask(const SceneRequest& request) {
    if (loading_.valid())
        next_ = request;
    else
        begin(request);
}

void SceneLoading::begin(const SceneRequest& request) {
    loading_ = std::async(std::launch::async, [load = load_, request]() -> Loaded {
        try {
            return {request, load(request), ""};
        } catch (const std::exception& error) {
            return {request, {}, error.what()};
        }
    });
}

bool SceneLoading::isReady() const {
    return loading_.valid() &&
           loading_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

std::optional<SceneLoading::Loaded> SceneLoading::take() {
    if (!isReady()) return std::nullopt;
    Loaded loaded = loading_.get();
    if (!next_) return loaded;
    begin(*std::exchange(next_, std::nullopt));
    return std::nullopt;
}

} // namespace stromboli::view
