#include "host/stress/run.hpp"

namespace stromboli::stress {

Picture Run::render(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                    const KernelTuning& tuning) const {
    Picture picture = subject_.render(scene, camera, settings, tuning,
                                      [this](const RenderProgress&) { return !goOn_ || goOn_(); });
    goOn(); // a picture that was cut short is no picture
    return picture;
}

} // namespace stromboli::stress
