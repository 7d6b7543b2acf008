// Sessions: pictures of scenes, one after the other.
#include "python/parts.hpp"

#include <map>
#include <string>

namespace stromboli::python {
namespace {

/// A session as Python holds it.
struct SessionHandle {
    explicit SessionHandle(const DeviceRequest& device) : session(device) {}
    api::PictureSession session;
    bool isBusy = false; ///< a thread takes samples without the GIL
};

/// Throws UsageError while another thread renders: the GIL does not keep it from there.
api::PictureSession& idle(SessionHandle& handle) {
    if (handle.isBusy) throw UsageError("another thread is rendering in this session");
    return handle.session;
}

/// Whose work is done without the GIL, and by nobody else at the same time.
class Working {
  public:
    explicit Working(SessionHandle& handle) : handle_(handle) { handle_.isBusy = true; }
    ~Working() { handle_.isBusy = false; }
    Working(const Working&) = delete;
    Working& operator=(const Working&) = delete;

  private:
    SessionHandle& handle_;
};

bool passes(SessionHandle& handle, const py::object& progress, bool all) {
    api::PictureSession& session = idle(handle);
    Watcher watcher(progress);
    bool hasMore = false;
    {
        const Working working(handle);
        const py::gil_scoped_release others;
        do
            hasMore = session.pass([&](const RenderProgress& state) { return watcher(state); });
        while (hasMore && all);
    }
    watcher.rethrow();
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    const RenderResult result = session.result();
    if (result.lost) throw DeviceLostError(*result.lost);
    return hasMore;
}

py::dict infoOf(const api::PictureSession& session) {
    const RenderResult result = session.result();
    py::dict info;
    info["device"] = result.backend;
    info["build_seconds"] = result.buildSeconds;
    info["prepare_seconds"] = result.prepareSeconds;
    info["render_seconds"] = result.renderSeconds;
    info["paths"] = result.counters.paths;
    info["rays"] = result.counters.rays;
    info["rejected"] = result.samplesRejected;
    info["cancelled"] = result.cancelled;
    info["branches"] = session.settings().estimator.branches;
    info["noise"] = noiseOf(result.denoised ? result.denoised->noise : result.noise);
    info["noise_before_denoising"] = result.denoised ? noiseOf(result.noise) : py::none();
    return info;
}

using NamedChanges = std::map<uint32_t, api::NamedChange>;

NamedChanges changesOf(const std::map<uint32_t, py::dict>& changes) {
    NamedChanges all;
    for (const auto& [number, values] : changes)
        forEach(values, [&, n = number](const std::string& name, const api::Value& value) {
            all[n].emplace_back(name, value);
        });
    return all;
}

/// Changes the scene of a session's picture without the GIL.
template <class Changes>
void change(SessionHandle& handle, void (api::PictureSession::*how)(const Changes&),
            const Changes& changes) {
    api::PictureSession& session = idle(handle);
    const Working working(handle);
    const py::gil_scoped_release others;
    (session.*how)(changes);
}

} // namespace

void defineSessions(py::module_& m) {
    py::class_<SessionHandle>(m, "Session")
        .def(py::init([](const py::dict& device) {
            return std::make_unique<SessionHandle>(deviceOf(device));
        }))
        .def("begin",
             [](SessionHandle& handle, const SceneHandle& scene, const py::dict& settings) {
                 idle(handle).begin(scene.scene, requestOf(settings));
             })
        .def("move_camera",
             [](SessionHandle& handle, const py::dict& settings) {
                 CameraRequest camera = idle(handle).request().camera;
                 forEach(settings, [&](const std::string& name, const api::Value& value) {
                     api::setCamera(camera, name, value);
                 });
                 handle.session.moveCamera(camera);
             })
        .def("change_materials",
             [](SessionHandle& handle, const std::map<uint32_t, py::dict>& changes) {
                 change(handle, &api::PictureSession::changeMaterials, changesOf(changes));
             })
        .def("change_lights",
             [](SessionHandle& handle, const std::map<uint32_t, py::dict>& changes) {
                 change(handle, &api::PictureSession::changeLights, changesOf(changes));
             })
        .def("move_object",
             [](SessionHandle& handle, uint32_t number, const Doubles& motion) {
                 change(handle, &api::PictureSession::moveObjects,
                        std::map<uint32_t, glm::dmat4>{{number, matrixOf(motion)}});
             })
        .def("material",
             [](SessionHandle& handle, uint32_t number) {
                 return valuesOf(materialOf(idle(handle).materials(), number));
             })
        .def("passes", &passes)
        .def("cancel", [](SessionHandle& handle) { handle.session.cancel(); })
        .def_property_readonly("is_over",
                               [](SessionHandle& handle) { return idle(handle).isOver(); })
        .def("channels", [](SessionHandle& handle) { return channelsOf(idle(handle).image()); })
        .def("info", [](SessionHandle& handle) { return infoOf(idle(handle)); })
        .def("messages", [](SessionHandle& handle) {
            py::list lines;
            for (const api::Message& message : handle.session.takeMessages())
                lines.append(py::make_tuple(int(message.severity), message.text));
            return lines;
        });
}

} // namespace stromboli::python
