#pragma once

#include "host/api/named_values.hpp"
#include "host/engine/load_scene.hpp"
#include "host/engine/render_request.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli::api {

/// What is known by a name: for documentation and messages.
struct NamedThing {
    std::string name, meaning;
};

/// A picture as a program asks for it, name by name. What is not named is as `stromboli render`
/// has it.
class PictureSettings {
  public:
    /// Throws UsageError, which says what is expected, for names and values that make no sense.
    void set(std::string_view name, const Value& value);
    /// Throws UsageError if settings contradict each other.
    RenderRequest request() const;

    /// All names, with what they mean and the values they take.
    static std::vector<NamedThing> names();

    // What was asked for, before it is known what it means together with the rest.
    struct Asked {
        RenderRequest request;
        std::optional<uint32_t> samples, width, height;
        bool even = false, hasBounces = false, hasFilter = false, hasIntegrator = false;
    };

  private:
    Asked asked_;
};

/// Changes what a camera is asked for: the names of PictureSettings that are about cameras. Throws
/// UsageError.
void setCamera(CameraRequest& camera, std::string_view name, const Value& value);

/// What takes the samples, name by name: "backend", "device", "scheduler", "threads",
/// "film_memory". Throws UsageError.
void setDevice(DeviceRequest& device, std::string_view name, const Value& value);
std::vector<NamedThing> deviceNames();

/// Where a scene comes from and how it is read, name by name. Throws UsageError.
void setReading(SceneRequest& scene, std::string_view name, const Value& value);
std::vector<NamedThing> readingNames();

} // namespace stromboli::api
