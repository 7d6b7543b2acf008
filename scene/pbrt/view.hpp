#pragma once

#include "scene/pbrt/context.hpp"
#include "scene/pbrt/lenses.hpp"
#include "scene/pbrt/parameters.hpp"

#include <glm/glm.hpp>

#include <array>
#include <optional>
#include <string>

namespace stromboli::pbrt {

/// What stands before WorldBegin: who looks, at which picture, and how it is made.
class View {
  public:
    explicit View(Context& context) : context_(context) {}

    /// Each reads a directive of that name; the last one counts.
    void readFilm(const std::string& kind, const Parameters& film);
    void readFilter(const std::string& kind, const Parameters& filter);
    void readIntegrator(const std::string& kind, const Parameters& integrator);
    /// medium: around the camera.
    void setCamera(const std::string& kind, Parameters camera, const glm::dmat4& cameraFromWorld,
                   uint32_t medium);

    /// Hands over the camera and what the film says; sets Context::imagingRatio.
    void finish();

  private:
    struct CameraRead {
        std::string kind;
        Parameters parameters;
        glm::dmat4 cameraFromWorld{1.0};
        uint32_t medium = kNoMedium;
    };

    void readCrop(const Parameters& film);
    void readSensor(const Parameters& film);
    void placeCamera(const CameraRead& camera);
    double halfShorterSide(const CameraRead& camera) const;
    double halfShorterSideOfFilm() const; ///< metres
    std::optional<ThinLens> lensOf(const CameraRead& camera) const;
    void setLens(const CameraRead& read, const ThinLens& lens, FileCamera& camera,
                 glm::dmat4& pose);

    Context& context_;
    uint32_t width_ = 1280, height_ = 720;
    std::optional<CameraRead> camera_;
    double iso_ = 100, filmScale_ = 1, diagonal_ = 35;
    std::optional<double> exposureTime_;
    double lensLight_ = 1; ///< what the lens lets through, of a film that it matters to
    bool hasFilter_ = false;
};

} // namespace stromboli::pbrt
