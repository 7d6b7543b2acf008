#pragma once

#include "host/engine/load_scene.hpp"

#include <functional>
#include <future>
#include <optional>
#include <string>

namespace stromboli::view {

using SceneLoader = std::function<LoadedScene(const SceneRequest&)>;

/// Loads scenes on a thread of its own, one at a time, while another one is shown. What is asked
/// for last counts: what was asked for before and has not come is forgotten.
class SceneLoading {
  public:
    struct Loaded {
        SceneRequest request;
        LoadedScene scene;   ///< without a scene where it failed
        std::string problem; ///< then, what is wrong
    };

    explicit SceneLoading(SceneLoader load) : load_(std::move(load)) {}

    void ask(const SceneRequest& request);
    bool isUnderWay() const { return loading_.valid() || next_; }
    /// Whether take() has something to do.
    bool isReady() const;
    /// What was asked for last, once it has come.
    std::optional<Loaded> take();

  private:
    void begin(const SceneRequest& request);

    SceneLoader load_;
    std::future<Loaded> loading_;
    std::optional<SceneRequest> next_;
};

} // namespace stromboli::view
