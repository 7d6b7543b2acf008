#include "host/bench/painter.hpp"

#include "host/kernel/vulkan_backend.hpp"

namespace stromboli::bench {

Painter::Painter(std::string name, std::unique_ptr<Backend> backend, const RenderSettings& settings,
                 Item item)
    : name_(std::move(name)), backend_(std::move(backend)), settings_(settings), item_(item),
      film_(settings.area) {}

Work Painter::goOn() {
    samples_ += settings_.budget.mostSamplesPerPixel;
    std::vector<PixelTarget> targets;
    for (uint32_t pixel = 0; pixel < film_.pixels.size(); ++pixel)
        targets.push_back({pixel, samples_});
    const double secondsBefore = deviceSeconds();
    const uint64_t raysBefore = backend_->counters().rays;
    backend_->sample(targets, film_, {});
    const double items = item_ == Item::Ray
                             ? double(backend_->counters().rays - raysBefore)
                             : double(film_.pixels.size()) * settings_.budget.mostSamplesPerPixel;
    return {items, deviceSeconds() - secondsBefore};
}

double Painter::deviceSeconds() const {
    const auto* vulkan = dynamic_cast<const VulkanBackend*>(backend_.get());
    return vulkan ? vulkan->kernelSeconds() : 0;
}

std::vector<Series> race(std::vector<Painter>& painters, AlternatePlan plan) {
    plan.leastSeconds = 0;
    std::vector<Contestant> contestants;
    for (Painter& p : painters)
        contestants.push_back({p.name(), [&p] { return p.goOn(); }});
    return alternate(contestants, plan);
}

} // namespace stromboli::bench
