#pragma once

#include "host/api/picture_session.hpp"
#include "host/core/error.hpp"
#include "python/values.hpp"
#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

#include <exception>
#include <memory>
#include <utility>
#include <vector>

namespace stromboli::python {

// Each defines its part of the module.

void defineScenes(py::module_& m);
void defineSessions(py::module_& m);
void defineJudging(py::module_& m); ///< comparisons, checks, denoising; files of pictures

// --- What parts have in common -------------------------------------------------------------------

/// A scene as Python holds it.
struct SceneHandle {
    std::shared_ptr<const Scene> scene;
};

/// A matrix of 16 numbers, row after row, as numpy has it; of none: the identity.
glm::dmat4 matrixOf(const Doubles& numbers);
/// Throws UsageError if there is none of this number.
const Material& materialOf(const std::vector<Material>& materials, uint32_t number);
/// Its name, its kind and its parameters.
py::dict valuesOf(const Material& material);

/// Tells Python how far a picture is, and hears whether it is to go on: called without the GIL.
class Watcher {
  public:
    explicit Watcher(py::object progress) : progress_(std::move(progress)) {}

    Next operator()(const RenderProgress& state) {
        const py::gil_scoped_acquire locked;
        if (failed_) return Next::Cancel;
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set(); // Ctrl-C
            if (progress_.is_none()) return Next::GoOn;
            const py::object answer = progress_(state.share, state.samplesDone);
            return answer.is(py::bool_(false)) ? Next::Cancel : Next::GoOn;
        } catch (...) {
            failed_ = std::current_exception();
            return Next::Cancel;
        }
    }
    /// Throws what Python has thrown meanwhile; the caller holds the GIL.
    void rethrow() {
        if (failed_) std::rethrow_exception(std::exchange(failed_, {}));
    }

  private:
    py::object progress_;
    std::exception_ptr failed_;
};

} // namespace stromboli::python
