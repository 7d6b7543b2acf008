#pragma once

#include "host/bench/measuring.hpp"
#include "host/bench/report.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/backend.hpp"
#include "host/render/settings.hpp"
#include "scene/model/scene.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stromboli::bench {

/// A renderer and the picture it goes on with from measurement to measurement.
class Painter {
  public:
    /// What a measurement is divided by.
    enum class Item { Path, Ray };

    Painter(std::string name, std::unique_ptr<Backend> backend, const RenderSettings& settings,
            Item item = Item::Path);

    const std::string& name() const { return name_; }
    const Film& film() const { return film_; }
    const Backend& backend() const { return *backend_; }
    /// Takes as many more samples of every pixel as the settings say.
    Work goOn();

  private:
    double deviceSeconds() const;

    std::string name_;
    std::unique_ptr<Backend> backend_;
    RenderSettings settings_;
    Item item_;
    uint32_t samples_ = 0;
    Film film_;
};

/// In turn, each measurement as long as it is, so that all pictures have the same samples.
std::vector<Series> race(std::vector<Painter>& painters, AlternatePlan plan);

/// The scene with the mean of each texture in its place: of base colours and metallic-roughness;
/// other textures are left out. A surface whose opacity has a texture blends with its mean opacity,
/// also where it is a mask, which by a mean would be there everywhere or nowhere.
Scene withMeans(Scene scene);

/// Whole paths by the kernel that renders use. A measurement takes samplesPerPixel more samples of
/// every pixel, film and all; what the scene needs on the device is there already.
PathReport benchPaths(const Arena& arena, const GpuScene& gpu);

/// A form of the kernel to compare with the default one.
struct KernelVariant {
    std::string name;
    KernelTuning tuning;
};

/// The forms that are of interest: with all features left in.
std::vector<KernelVariant> kernelVariants(const GpuScene& scene);

/// ourName: of the kernel that renders use.
VariantReport benchVariants(const Arena& arena, const GpuScene& gpu,
                            const std::vector<KernelVariant>& variants,
                            const std::string& ourName = "specialised");

bool hasTextures(const Scene& scene);

/// What textures cost: the scene, and the same one with the mean of each texture in its place
/// (withMeans()), by ray. Both are lit by the bundled sky; what emits by a texture emits in
/// neither, since with a mean all of it would be a light.
TextureReport benchTextures(const Arena& arena);

} // namespace stromboli::bench
