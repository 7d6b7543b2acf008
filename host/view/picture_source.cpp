#include "host/view/picture_source.hpp"

#include "host/core/color.hpp"
#include "host/core/error.hpp"
#include "host/core/json.hpp"
#include "host/core/text.hpp"
#include "host/film/image_formats.hpp"
#include "host/film/shown_film.hpp"
#include "host/render/sampling_plan.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

namespace stromboli::view {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, for a file that is read back and forgotten.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::random_device random;
        path_ = fs::temp_directory_path() /
                fmt::format("stromboli-view-{:08x}{:08x}", random(), random());
        if (!fs::create_directory(path_))
            throw OutputError(fmt::format("{}: is there already", path_.string()));
        fs::permissions(path_, fs::perms::owner_all);
    }
    ~TemporaryFolder() {
        std::error_code failed;
        fs::remove_all(path_, failed);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// The relative standard error of a pixel's luminance, by the spread of its own samples; infinite
/// where fewer than two are known or none has met light.
float noiseOf(const PixelStatistics& pixel) {
    const glm::dvec3 variance = pixel.varianceOfMean();
    const double mean = luminance(pixel.mean);
    if (pixel.count < 2 || !(mean > 0)) return INFINITY;
    // Channels of a pixel vary together: the error of the sum is at most the sum of their errors.
    const double error = luminance(glm::sqrt(variance));
    return float(error / mean);
}

/// Calls `set` for each pixel with the place in the raster and the pixel that is shown there.
template <class Set>
Raster ofFilm(const Film& film, uint32_t channels, const Set& set) {
    Raster raster{film.width, film.height, channels, {}};
    raster.values.resize(film.pixels.size() * channels);
    tbb::parallel_for(0u, film.height, [&](uint32_t y) {
        for (uint32_t x = 0; x < film.width; ++x)
            set(&raster.values[(size_t(y) * film.width + x) * channels],
                shownPixel(film, x, y, NoisePlan::kCoarsest));
    });
    return raster;
}

Raster ofChannels(const FloatImage& image, Layer layer) {
    const std::vector<std::string> names = channelsOf(layer);
    Raster raster{image.width, image.height, uint32_t(names.size()), {}};
    raster.values.resize(size_t(image.width) * image.height * names.size());
    for (size_t c = 0; c < names.size(); ++c) {
        const std::vector<float>& channel = image.channels.at(names[c]);
        for (size_t i = 0; i < channel.size(); ++i)
            raster.values[i * names.size() + c] = channel[i];
    }
    return raster;
}

Json numbers(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

/// JSON has no infinity.
Json finite(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// The name of an object or material by its number, from 1; null: nothing is there.
template <class Names>
Json nameIn(const Names& names, float number) {
    const auto place = size_t(number);
    if (place == 0 || place > names.size()) return nullptr;
    return names[place - 1];
}

} // namespace

ToneMapping toneOf(const ToneWords& words) {
    ToneMapping tone;
    const std::optional<View> view = valueNamed<View>(words.view);
    if (!view)
        throw UsageError(fmt::format("view is '{}'; expected {}", words.view, allNames<View>()));
    tone.view = *view;
    if (words.exposure == "auto") {
        tone.metersExposure = true;
        return tone;
    }
    const std::optional<double> stops = realNumber(words.exposure);
    if (!stops || std::abs(*stops) > 100)
        throw UsageError(fmt::format("exposure is '{}'; expected auto or a number from -100 to 100",
                                     words.exposure));
    tone.curve.exposure = *stops;
    return tone;
}

const FloatImage& PictureSource::layers() {
    if (!layers_)
        layers_ = session_.layers(
            {Layer::Albedo, Layer::Normal, Layer::Depth, Layer::Object, Layer::Material});
    return *layers_;
}

Raster PictureSource::raster(Shown what, const std::function<bool()>& isUnwanted) {
    const Film& film = session_.film();
    const auto set3 = [](float* to, const glm::dvec3& from) {
        for (int c = 0; c < 3; ++c)
            to[c] = float(from[c]);
    };
    switch (what) {
    case Shown::Denoised: {
        const denoise::DenoisedPicture* const denoised = session_.denoisedUnless(isUnwanted);
        if (!denoised) return {};
        const denoise::DenoisedPicture& clean = *denoised;
        Film shown = film;
        for (size_t i = 0; i < clean.mean.size(); ++i)
            shown.pixels[i].mean = clean.mean[i];
        session_.putBackgroundBehind(shown);
        Raster raster{clean.width, clean.height, 3, {}};
        raster.values.resize(clean.mean.size() * 3);
        for (size_t i = 0; i < clean.mean.size(); ++i)
            set3(&raster.values[i * 3], shown.pixels[i].mean);
        return raster;
    }
    case Shown::Albedo:
        return ofChannels(layers(), Layer::Albedo);
    case Shown::Normal:
        return ofChannels(layers(), Layer::Normal);
    case Shown::Depth:
        return ofChannels(layers(), Layer::Depth);
    case Shown::Noise:
        return ofFilm(film, 1, [&](float* to, size_t from) { *to = noiseOf(film.pixels[from]); });
    case Shown::Samples:
        return ofFilm(film, 1, [&](float* to, size_t from) {
            *to = float(film.pixels[from].taken()) * float(film.branches);
        });
    case Shown::Picture:
        break;
    }
    Film shown = film;
    session_.putBackgroundBehind(shown);
    return ofFilm(shown, 3, [&](float* to, size_t from) { set3(to, shown.pixels[from].mean); });
}

std::string PictureSource::probe(uint32_t x, uint32_t y) {
    const Film& film = session_.film();
    if (x >= film.width || y >= film.height)
        throw UsageError(fmt::format("pixel {} {} is not in the picture of {} x {}", x, y,
                                     film.width, film.height));
    const PixelStatistics& pixel = film.pixels[shownPixel(film, x, y, NoisePlan::kCoarsest)];
    const FloatImage& seen = layers();
    const size_t i = size_t(y) * film.width + x;
    const auto vectorOf = [&](Layer layer) {
        glm::dvec3 v(0);
        const std::vector<std::string> names = channelsOf(layer);
        for (size_t c = 0; c < names.size() && c < 3; ++c)
            v[int(c)] = seen.channels.at(names[c])[i];
        return v;
    };
    const Scene& scene = session_.scene();
    std::vector<std::string> materials;
    for (const Material& material : scene.materials)
        materials.push_back(material.name);
    const Json answer = {
        {"x", film.area.rendered().x + x},
        {"y", film.area.rendered().y + y},
        {"radiance", numbers(pixel.mean)},
        {"standardError", numbers(glm::sqrt(pixel.varianceOfMean()))},
        {"noise", finite(noiseOf(pixel))},
        {"samples", uint64_t(pixel.taken()) * film.branches},
        {"albedo", numbers(vectorOf(Layer::Albedo))},
        {"normal", numbers(vectorOf(Layer::Normal))},
        {"depth", finite(vectorOf(Layer::Depth).x)},
        {"object", nameIn(scene.instances, float(vectorOf(Layer::Object).x))},
        {"material", nameIn(materials, float(vectorOf(Layer::Material).x))},
    };
    return answer.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string PictureSource::file(const SaveRequest& request, const PictureNotes& notes) {
    const bool isPng = request.format == SaveRequest::Format::Png;
    const TemporaryFolder folder;
    const fs::path path = folder.path() / (isPng ? "picture.png" : "picture.exr");
    PictureOptions options;
    options.tone = toneOf(request.tone);
    Film film = session_.film();
    if (request.denoised) {
        const denoise::DenoisedPicture& clean = session_.denoised();
        for (size_t i = 0; i < film.pixels.size(); ++i)
            film.pixels[i].mean = clean.mean[i];
    } else {
        showNeighbours(film, NoisePlan::kCoarsest);
    }
    session_.putBackgroundBehind(film);
    PictureFile file(path, film.area, options);
    file.place(film);
    file.write(notes);
    return bytesOf(path);
}

} // namespace stromboli::view
