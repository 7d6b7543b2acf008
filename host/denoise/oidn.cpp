#include "host/denoise/oidn.hpp"

#include "host/core/error.hpp"
#include "host/core/system.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

namespace stromboli::denoise {
namespace {

// The part of Open Image Denoise 2's C interface that is used here. Its headers are in no package
// of Debian 12; these declarations are all that is needed to call it.
struct OidnDevice;
struct OidnFilter;
constexpr int kCpuDevice = 1, kFloat3 = 3, kNoError = 0;

struct OidnApi {
    OidnDevice* (*newDevice)(int type) = nullptr;
    void (*commitDevice)(OidnDevice*) = nullptr;
    int (*deviceError)(OidnDevice*, const char** message) = nullptr;
    void (*releaseDevice)(OidnDevice*) = nullptr;
    OidnFilter* (*newFilter)(OidnDevice*, const char* type) = nullptr;
    void (*setImage)(OidnFilter*, const char* name, void* data, int format, size_t width,
                     size_t height, size_t offset, size_t pixelStride, size_t rowStride) = nullptr;
    void (*setBool)(OidnFilter*, const char* name, bool value) = nullptr;
    void (*commitFilter)(OidnFilter*) = nullptr;
    void (*executeFilter)(OidnFilter*) = nullptr;
    void (*releaseFilter)(OidnFilter*) = nullptr;
    std::string missing;
};

OidnApi load() {
    OidnApi api;
    SharedLibrary library("libOpenImageDenoise.so.2", "libopenimagedenoise2");
    library.find(api.newDevice, "oidnNewDevice");
    library.find(api.commitDevice, "oidnCommitDevice");
    library.find(api.deviceError, "oidnGetDeviceError");
    library.find(api.releaseDevice, "oidnReleaseDevice");
    library.find(api.newFilter, "oidnNewFilter");
    library.find(api.setImage, "oidnSetSharedFilterImage");
    library.find(api.setBool, "oidnSetFilterBool");
    library.find(api.commitFilter, "oidnCommitFilter");
    library.find(api.executeFilter, "oidnExecuteFilter");
    library.find(api.releaseFilter, "oidnReleaseFilter");
    if (!library.missing().empty())
        api.missing =
            "Open Image Denoise 2 cannot be used: libOpenImageDenoise.so.2 is not there or "
            "lacks a function (openimagedenoise.org has it; LD_LIBRARY_PATH says where it "
            "lies)";
    return api;
}

const OidnApi& oidnApi() {
    static const OidnApi api = load();
    return api;
}

/// A picture of three floats a pixel.
using Image = std::vector<glm::vec3>;

/// Its device on the CPU: on a GPU the same picture has other numbers.
class Device {
  public:
    Device() : device_(oidnApi().newDevice(kCpuDevice)) {
        if (device_) oidnApi().commitDevice(device_);
        check();
    }
    ~Device() {
        if (device_) oidnApi().releaseDevice(device_);
    }
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    OidnDevice* handle() const { return device_; }
    void check() const {
        const char* message = nullptr;
        if (oidnApi().deviceError(device_, &message) != kNoError)
            throw UsageError(
                fmt::format("Open Image Denoise: {}", message ? message : "it does not say why"));
    }

  private:
    OidnDevice* device_;
};

/// Its filter for ray tracing, with images that must outlive it.
class Filter {
  public:
    Filter(const Device& device, uint32_t width, uint32_t height)
        : device_(device), filter_(oidnApi().newFilter(device.handle(), "RT")), width_(width),
          height_(height) {}
    ~Filter() {
        if (filter_) oidnApi().releaseFilter(filter_);
    }
    Filter(const Filter&) = delete;
    Filter& operator=(const Filter&) = delete;

    void set(const char* name, Image& image) const {
        oidnApi().setImage(filter_, name, image.data(), kFloat3, width_, height_, 0, 0, 0);
    }
    void set(const char* name, bool value) const { oidnApi().setBool(filter_, name, value); }
    void run() const {
        oidnApi().commitFilter(filter_);
        oidnApi().executeFilter(filter_);
        device_.check();
    }

  private:
    const Device& device_;
    OidnFilter* filter_;
    uint32_t width_, height_;
};

float finiteOr0(float value) {
    return std::isfinite(value) ? value : 0.0f;
}

Image finite(const Image& image) {
    Image result;
    result.reserve(image.size());
    for (const glm::vec3& v : image)
        result.emplace_back(finiteOr0(v.x), finiteOr0(v.y), finiteOr0(v.z));
    return result;
}

/// A layer without its own noise.
Image prefiltered(const Device& device, const char* name, const NoisyPicture& picture,
                  const Image& layer) {
    Image noisy = finite(layer), result(layer.size());
    const Filter filter(device, picture.width, picture.height);
    filter.set(name, noisy);
    filter.set("output", result);
    filter.run();
    return result;
}

} // namespace

const std::string& oidnMissing() {
    return oidnApi().missing;
}

OidnHalves runOidn(const NoisyPicture& picture) {
    if (!oidnMissing().empty()) throw UsageError(oidnMissing());
    const Device device;
    Image albedo, normal;
    if (!picture.albedo.empty()) {
        albedo = prefiltered(device, "albedo", picture, picture.albedo);
        if (!picture.normal.empty())
            normal = prefiltered(device, "normal", picture, picture.normal);
    }
    const auto half = [&](float sign) {
        Image color(picture.mean.size()), result(picture.mean.size());
        for (size_t i = 0; i < color.size(); ++i)
            color[i] = picture.mean[i] + sign * picture.deviation[i];
        color = finite(color); // what is unknown is black to it
        const Filter filter(device, picture.width, picture.height);
        filter.set("color", color);
        if (!albedo.empty()) filter.set("albedo", albedo);
        if (!normal.empty()) filter.set("normal", normal); // it takes none without albedo
        filter.set("output", result);
        filter.set("hdr", true);
        filter.set("cleanAux", !albedo.empty());
        filter.run();
        return result;
    };
    return {half(1), half(-1)};
}

} // namespace stromboli::denoise
