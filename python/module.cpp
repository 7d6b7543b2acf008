// The compiled half of the Python module: puts host/api into objects of Python. What users call is
// python/stromboli/__init__.py, which has the documentation.
#include "host/api/named_materials.hpp"
#include "host/api/named_settings.hpp"
#include "host/api/picture_session.hpp"
#include "host/api/scene_maker.hpp"
#include "host/check/cross_check.hpp"
#include "host/compare/comparison.hpp"
#include "host/core/error.hpp"
#include "host/core/json.hpp"
#include "host/denoise/denoiser.hpp"
#include "host/engine/load_scene.hpp"
#include "host/engine/render_session.hpp"
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"
#include "host/version/version.hpp"
#include "host/vulkan/device.hpp"

#include <nlohmann/json.hpp>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <exception>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace stromboli {
namespace {

// --- Values --------------------------------------------------------------------------------------

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Bytes = py::array_t<uint8_t, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<uint32_t, py::array::c_style | py::array::forcecast>;

template <class Array>
auto spanOf(const Array& array) {
    return std::span(array.data(), size_t(array.size()));
}

/// Words and numbers as they are, yes and no as 1 and 0, and whatever numpy makes numbers of.
api::Value valueOf(const py::handle& object) {
    if (py::isinstance<py::str>(object)) return object.cast<std::string>();
    const Doubles numbers = Doubles::ensure(object);
    if (!numbers)
        throw UsageError("expected a word or numbers, not " + py::repr(object).cast<std::string>());
    return std::vector<double>(numbers.data(), numbers.data() + numbers.size());
}

template <class Set>
void forEach(const py::dict& settings, const Set& set) {
    for (const auto& [name, value] : settings)
        set(py::cast<std::string>(name), valueOf(value));
}

DeviceRequest deviceOf(const py::dict& settings) {
    DeviceRequest request;
    forEach(settings, [&](const std::string& name, const api::Value& value) {
        api::setDevice(request, name, value);
    });
    return request;
}

RenderRequest requestOf(const py::dict& settings) {
    api::PictureSettings all;
    forEach(settings,
            [&](const std::string& name, const api::Value& value) { all.set(name, value); });
    return all.request();
}

py::dict dictOf(const std::vector<api::NamedThing>& names) {
    py::dict result;
    for (const api::NamedThing& thing : names)
        result[py::str(thing.name)] = thing.meaning;
    return result;
}

py::object objectOf(const Json& json) {
    return py::module_::import("json").attr("loads")(json.dump());
}

// --- Pictures ------------------------------------------------------------------------------------

py::dict channelsOf(const FloatImage& image) {
    py::dict result;
    for (const auto& [name, values] : image.channels) {
        Floats array({py::ssize_t(image.height), py::ssize_t(image.width)});
        std::copy(values.begin(), values.end(), array.mutable_data());
        result[py::str(name)] = array;
    }
    return result;
}

FloatImage imageOf(const py::dict& channels, uint32_t branches) {
    FloatImage image;
    for (const auto& [name, values] : channels) {
        const Floats array = Floats::ensure(values);
        if (!array || array.ndim() != 2)
            throw UsageError("a channel of a picture is an array of height x width numbers");
        const auto height = uint32_t(array.shape(0)), width = uint32_t(array.shape(1));
        if (image.channels.empty()) image = FloatImage(width, height);
        if (width != image.width || height != image.height)
            throw UsageError("the channels of a picture have different sizes");
        image.channel(name.cast<std::string>()).assign(array.data(), array.data() + array.size());
    }
    if (image.channels.empty() || image.width == 0 || image.height == 0)
        throw UsageError("a picture without pixels");
    image.branches = branches;
    return image;
}

py::object noiseOf(const PictureNoise& noise) {
    if (!noise.known()) return py::none();
    return py::make_tuple(noise.estimate, noise.least, noise.most);
}

// --- Scenes --------------------------------------------------------------------------------------

/// A scene as Python holds it.
struct SceneHandle {
    std::shared_ptr<const Scene> scene;
};

const Material& materialOf(const std::vector<Material>& materials, uint32_t number) {
    if (number >= materials.size())
        throw UsageError("there is no material " + std::to_string(number));
    return materials[number];
}

py::dict valuesOf(const Material& material) {
    py::dict result;
    result["name"] = material.name;
    result["kind"] = std::string(api::kindOf(material));
    for (const api::NamedThing& row : api::materialParameters(api::kindOf(material))) {
        const std::vector<double> values = api::materialValue(material, row.name);
        result[py::str(row.name)] =
            values.size() == 1 ? py::object(py::float_(values[0])) : py::object(py::cast(values));
    }
    return result;
}

py::dict reportOf(const LoadReport& report) {
    py::dict result;
    result["warnings"] = report.warnings;
    result["forgiven"] = report.forgiven;
    result["ignored"] = report.ignored;
    result["assumed"] = report.assumed;
    return result;
}

SceneHandle load(const std::string& source, const py::dict& settings) {
    SceneRequest request;
    request.source = source;
    forEach(settings, [&](const std::string& name, const api::Value& value) {
        api::setReading(request, name, value);
    });
    const py::gil_scoped_release others;
    return {loadScene(request).scene};
}

void addMesh(api::SceneMaker& maker, const std::string& name, const Doubles& positions,
             const Indices& triangles, uint32_t material, const Doubles& normals,
             const Doubles& uvs, const Doubles& toWorld) {
    api::MeshArrays mesh;
    mesh.name = name;
    mesh.positions = spanOf(positions), mesh.triangles = spanOf(triangles);
    mesh.normals = spanOf(normals), mesh.uvs = spanOf(uvs);
    mesh.material = material;
    if (toWorld.size() == 16)
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                mesh.toWorld[column][row] = toWorld.data()[4 * row + column];
    maker.addMesh(mesh);
}

glm::dvec3 vectorOf(const std::array<double, 3>& v) {
    return {v[0], v[1], v[2]};
}
using Triple = std::array<double, 3>;

void addLight(api::SceneMaker& maker, const std::string& kind, const std::string& name,
              const Triple& color, const Triple& position, const Triple& direction,
              const std::array<double, 2>& size, double angle, std::optional<double> inner) {
    maker.addLight({kind,
                    name,
                    vectorOf(color),
                    vectorOf(position),
                    vectorOf(direction),
                    {size[0], size[1]},
                    angle,
                    inner});
}

void addCamera(api::SceneMaker& maker, const std::string& name, const Triple& from,
               const Triple& at, const Triple& up, double fov, double aperture, double focus) {
    maker.addCamera({name, vectorOf(from), vectorOf(at), vectorOf(up), fov, aperture, focus});
}

// --- Sessions ------------------------------------------------------------------------------------

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

void changeMaterials(SessionHandle& handle, const std::map<uint32_t, py::dict>& changes) {
    std::map<uint32_t, api::MaterialChange> all;
    for (const auto& [number, values] : changes)
        forEach(values, [&, n = number](const std::string& name, const api::Value& value) {
            all[n].emplace_back(name, value);
        });
    api::PictureSession& session = idle(handle);
    const Working working(handle);
    const py::gil_scoped_release others;
    session.changeMaterials(all);
}

// --- Judging -------------------------------------------------------------------------------------

py::dict compareImages(const py::dict& reference, uint32_t referenceBranches,
                       const py::dict& picture, uint32_t branches, double exposure,
                       double familyError) {
    const FloatImage r = imageOf(reference, referenceBranches), p = imageOf(picture, branches);
    compare::CompareSettings settings;
    settings.exposure = exposure;
    settings.familyError = familyError;
    compare::Comparison found;
    std::vector<double> errors;
    {
        const py::gil_scoped_release others;
        const compare::Picture of = compare::pictureOf(r, "the reference"),
                               with = compare::pictureOf(p, "the picture");
        found = compare::comparePictures(of, with, settings);
        errors = compare::relativeErrorMap(of, with);
    }
    const auto map = [&](const std::vector<double>& values) {
        Floats array({py::ssize_t(r.height), py::ssize_t(r.width)});
        std::copy(values.begin(), values.end(), array.mutable_data());
        return array;
    };
    py::dict result;
    result["figures"] = objectOf(compare::toJson(found));
    result["text"] = compare::toText(found);
    result["flip_map"] = map(found.flipMap);
    result["error_map"] = map(errors);
    return result;
}

/// The device against the reference.
py::dict check(const SceneHandle& scene, const py::dict& settings, const py::dict& device,
               double familyError, const py::object& progress) {
    RenderRequest request = requestOf(settings);
    request.budget.mostPathsPerPixel = request.budget.pathsPerPixel();
    request.budget.meanPathsPerPixel = 0; // z-tests need fixed counts
    request.budget.pathsPerBlock = 0;
    if (!request.branches) request.branches = 1;
    if (!request.size) request.size = {160, 120};
    DeviceRequest here = deviceOf(device), host = here;
    here.maybeSeveral = false;
    host.backend = BackendChoice::Reference;
    Watcher watcher(progress);
    CheckResult found;
    std::string first, second;
    {
        const py::gil_scoped_release others;
        RenderSession onDevice(here), onHost(host);
        SessionEvents events;
        events.progress = [&](const RenderProgress& state) { return watcher(state); };
        bool isWhole = true;
        for (RenderSession* session : {&onDevice, &onHost}) {
            if (!isWhole) break;
            session->begin(scene.scene, request);
            const RenderResult result = session->run(events);
            if (result.bands > 1)
                throw UsageError("the films of the picture do not fit the memory: make it smaller");
            isWhole = !result.cancelled;
        }
        if (isWhole) {
            CheckSettings how;
            how.familyError = familyError;
            found = crossCheck(onDevice.film(), onHost.film(), how);
            first = onDevice.result().backend, second = onHost.result().backend;
        }
    }
    watcher.rethrow();
    if (first.empty()) throw UsageError("the check was cancelled");
    const char* const verdicts[] = {"agree", "different", "undecided"};
    py::dict result;
    result["verdict"] = verdicts[size_t(found.verdict())];
    result["text"] = fmt::format("A: {}\nB: {}\n{}", first, second, formatCheck(found));
    result["z"] = py::make_tuple(found.channels[0].z, found.channels[1].z, found.channels[2].z);
    result["limit"] = found.channelLimit;
    return result;
}

py::dict denoiseImage(const py::dict& channels, uint32_t branches, const std::string& which,
                      const std::string& device, const std::string& backend) {
    const FloatImage image = imageOf(channels, branches);
    const auto denoiser = valueNamed<Denoiser>(which);
    if (!denoiser || *denoiser == Denoiser::Off)
        throw UsageError("denoiser: expected on or oidn, not '" + which + "'");
    FloatImage clean(image.area);
    PictureNoise noise;
    {
        const py::gil_scoped_release others;
        denoise::requireUsable(*denoiser);
        const denoise::NoisyPicture noisy = denoise::noisyPictureOf(image, "the picture");
        vulkan::OpenDevice open;
        if (*denoiser == Denoiser::On && backend != "reference") open = vulkan::openDevice(device);
        const denoise::DenoisedPicture denoised =
            denoise::denoisePicture(noisy, *denoiser, open.device.get());
        for (int c = 0; c < 3; ++c) {
            std::vector<float>& channel = clean.channel(kColorChannels[c]);
            for (size_t i = 0; i < channel.size(); ++i)
                channel[i] = denoised.mean[i][c];
        }
        denoise::addChannels(clean, noisy, denoised);
        noise = denoised.summary.noise;
    }
    py::dict result;
    result["channels"] = channelsOf(clean);
    result["noise"] = noiseOf(noise);
    return result;
}

// --- Files ---------------------------------------------------------------------------------------

void save(const std::string& file, const py::dict& channels, uint32_t branches,
          const std::string& view, const py::object& exposure) {
    const FloatImage image = imageOf(channels, branches);
    if (formatOf(file) == PictureFormat::Exr) return writeExr(file, image);
    PictureOptions options;
    const auto chosen = valueNamed<View>(view);
    if (!chosen) throw UsageError("view: expected " + allNames<View>() + ", not '" + view + "'");
    options.tone.view = *chosen;
    if (py::isinstance<py::str>(exposure)) {
        if (exposure.cast<std::string>() != "auto")
            throw UsageError("exposure: expected stops or auto");
        options.tone.metersExposure = true;
    } else {
        options.tone.curve.exposure = exposure.cast<double>();
    }
    if (image.channels.contains(kAlphaChannel)) options.channels.emplace_back(kAlphaChannel);
    const py::gil_scoped_release others;
    writeToneMapped(file, image, options);
}

py::tuple readImage(const std::string& file) {
    const FloatImage image = readExr(file);
    return py::make_tuple(channelsOf(image), image.branches);
}

// --- Errors --------------------------------------------------------------------------------------

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
} // namespace stromboli

PYBIND11_MODULE(_stromboli, m) {
    using namespace stromboli;
    py::register_exception_translator(&translate);
    m.def("version", &version);
    m.def("picture_settings", [] { return dictOf(api::PictureSettings::names()); });
    m.def("device_settings", [] { return dictOf(api::deviceNames()); });
    m.def("reading_settings", [] { return dictOf(api::readingNames()); });
    m.def("material_kinds", &api::materialKinds);
    m.def("material_parameters",
          [](const std::string& kind) { return dictOf(api::materialParameters(kind)); });

    py::class_<SceneHandle>(m, "Scene")
        .def_property_readonly("file", [](const SceneHandle& s) { return s.scene->file; })
        .def_property_readonly("triangle_count",
                               [](const SceneHandle& s) { return s.scene->placedTriangles(); })
        .def_property_readonly("material_count",
                               [](const SceneHandle& s) { return s.scene->materials.size(); })
        .def("material",
             [](const SceneHandle& s, uint32_t number) {
                 return valuesOf(materialOf(s.scene->materials, number));
             })
        .def_property_readonly("cameras",
                               [](const SceneHandle& s) {
                                   std::vector<std::string> names;
                                   for (const FileCamera& camera : s.scene->cameras)
                                       names.push_back(camera.name);
                                   return names;
                               })
        .def_property_readonly("bounds",
                               [](const SceneHandle& s) {
                                   const Bounds b = s.scene->bounds();
                                   const glm::dvec3 lo = glm::dvec3(b.lo) + s.scene->origin,
                                                    hi = glm::dvec3(b.hi) + s.scene->origin;
                                   return py::make_tuple(py::make_tuple(lo.x, lo.y, lo.z),
                                                         py::make_tuple(hi.x, hi.y, hi.z));
                               })
        .def_property_readonly("report",
                               [](const SceneHandle& s) { return reportOf(s.scene->report); });
    m.def("load", &load);

    py::class_<api::SceneMaker>(m, "SceneMaker")
        .def(py::init<std::string>())
        .def("material",
             [](api::SceneMaker& maker, const std::string& kind, const std::string& name,
                const py::dict& parameters) {
                 Material material = api::makeMaterial(kind, name);
                 forEach(parameters, [&](const std::string& parameter, const api::Value& value) {
                     api::setMaterial(material, parameter, value);
                 });
                 return maker.addMaterial(std::move(material));
             })
        .def("texture",
             [](api::SceneMaker& maker, const Bytes& image, bool srgb) {
                 if (image.ndim() != 3)
                     throw UsageError("a texture is an array of height x width x 3 or 4 bytes");
                 return maker.addTexture(uint32_t(image.shape(1)), uint32_t(image.shape(0)),
                                         spanOf(image), srgb);
             })
        .def("use_texture", &api::SceneMaker::useTexture)
        .def("mesh", &addMesh)
        .def("sphere",
             [](api::SceneMaker& maker, const std::string& name, const Triple& center,
                double radius,
                uint32_t material) { maker.addSphere(name, vectorOf(center), radius, material); })
        .def("light", &addLight)
        .def("camera", &addCamera)
        .def("environment",
             [](api::SceneMaker& maker, const Floats& radiance, double strength, double rotation) {
                 if (radiance.ndim() != 3)
                     throw UsageError("an environment is an array of height x width x 3 radiances");
                 maker.setEnvironment(uint32_t(radiance.shape(1)), uint32_t(radiance.shape(0)),
                                      spanOf(radiance), strength, rotation);
             })
        .def("finish", [](api::SceneMaker& maker) { return SceneHandle{maker.finish()}; });

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
        .def("change_materials", &changeMaterials)
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

    m.def("compare", &compareImages);
    m.def("check", &check);
    m.def("denoise", &denoiseImage);
    m.def("save", &save);
    m.def("read", &readImage);
}
