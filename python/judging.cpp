// Pictures that are compared, checked, denoised, written and read.
#include "host/check/cross_check.hpp"
#include "host/compare/comparison.hpp"
#include "host/denoise/denoiser.hpp"
#include "host/engine/render_session.hpp"
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"
#include "host/vulkan/device.hpp"
#include "python/parts.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace stromboli::python {
namespace {

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

} // namespace

void defineJudging(py::module_& m) {
    m.def("compare", &compareImages);
    m.def("check", &check);
    m.def("denoise", &denoiseImage);
    m.def("save", &save);
    m.def("read", &readImage);
}

} // namespace stromboli::python
