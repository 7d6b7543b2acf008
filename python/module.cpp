// The compiled half of the Python module: puts host/api into objects of Python. What users call is
// python/stromboli/__init__.py, which has the documentation.
#include "host/api/named_materials.hpp"
#include "host/version/version.hpp"
#include "python/parts.hpp"

#include <exception>
#include <string>

namespace stromboli::python {
namespace {

/// The class of Python that an error has, from python/stromboli/errors.py.
py::object classOf(ErrorKind kind) {
    const char* names[] = {"UsageError", "SceneError", "DeviceError", "DeviceLostError",
                           "OutputError"};
    return py::module_::import("stromboli.errors").attr(names[size_t(kind)]);
}

void translate(std::exception_ptr thrown) {
    try {
        if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
        PyErr_SetString(classOf(error.kind()).ptr(), error.what());
    }
}

} // namespace
} // namespace stromboli::python

PYBIND11_MODULE(_stromboli, m) {
    using namespace stromboli;
    using namespace stromboli::python;
    py::register_exception_translator(&translate);
    m.def("version", &version);
    m.def("picture_settings", [] { return dictOf(api::PictureSettings::names()); });
    m.def("device_settings", [] { return dictOf(api::deviceNames()); });
    m.def("reading_settings", [] { return dictOf(api::readingNames()); });
    m.def("material_kinds", &api::materialKinds);
    m.def("material_parameters",
          [](const std::string& kind) { return dictOf(api::materialParameters(kind)); });

    defineScenes(m);
    defineSessions(m);
    defineJudging(m);
}
