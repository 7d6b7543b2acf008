#include "host/cli/render_devices.hpp"

#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/vulkan/open_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace stromboli {

RenderDevices::RenderDevices(const std::string& wanted, PathScheduler scheduler)
    : wanted_(wanted), scheduler_(scheduler),
      opening_(std::async(std::launch::async, vulkan::openDevices, wanted)) {}

void RenderDevices::open() {
    if (!opening_.valid()) return;
    for (vulkan::OpenDevice& open : opening_.get())
        seats_.push_back({std::move(open), nullptr});
    sayWhich();
}

void RenderDevices::reopen() {
    team_.reset();
    seats_.clear();
    for (vulkan::OpenDevice& open : vulkan::openDevices(wanted_))
        seats_.push_back({std::move(open), nullptr});
}

void RenderDevices::sayWhich() const {
    for (const Seat& seat : seats_)
        logging::debug(fmt::format("device {}: {} ({})", seat.open.choice.index,
                                   seat.open.device->description().name(),
                                   seat.open.choice.reason));
}

/// Once, of the first picture.
void RenderDevices::sayHow() {
    if (std::exchange(howIsSaid_, true)) return;
    for (const std::string& line : describe(seats_.front().backend->features()))
        logging::debug(fmt::format("kernel: {}", line));
}

std::string RenderDevices::name() const {
    std::vector<std::string> names;
    for (const Seat& seat : seats_) {
        std::string name = seat.open.device->description().name();
        if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
    }
    return fmt::format("{}", fmt::join(names, " and "));
}

uint64_t RenderDevices::pixelsThatFit(const GpuScene& scene, const Estimator& estimator,
                                      uint64_t hostBytes, uint64_t hostBytesPerPixel) const {
    uint64_t onDevice = ~uint64_t(0), perPixel = hostBytesPerPixel;
    for (const Seat& seat : seats_) {
        const vulkan::DeviceDescription& description = seat.open.device->description();
        onDevice = std::min(onDevice, filmPixelsThatFit(description, scene, estimator));
        if (description.isCpu()) perPixel += sizeof(gpu::PixelState);
    }
    if (seats_.size() > 1) perPixel += sizeof(PixelSums);
    return std::min(hostBytes / perPixel, onDevice);
}

bool RenderDevices::haveRoomForTextures(const GpuScene& scene) const {
    return std::ranges::all_of(seats_, [&](const Seat& seat) {
        return stromboli::haveRoomForTextures(seat.open.device->description(), scene);
    });
}

void RenderDevices::setScene(const GpuScene& scene) {
    leaveOutWhoDroppedOut();
    scene_ = &scene;
    for (Seat& seat : seats_)
        if (seat.backend) seat.backend->setScene(scene);
}

void RenderDevices::leaveOutWhoDroppedOut() {
    if (!team_) return;
    const std::vector<size_t> present = team_->present();
    team_.reset(); // it has backends in hand, which must not outlive their devices
    std::vector<Seat> left;
    for (const size_t i : present)
        left.push_back(std::move(seats_[i]));
    seats_ = std::move(left);
}

void RenderDevices::prepare(Seat& seat, const Camera& camera,
                            const RenderSettings& settings) const {
    if (seat.backend) {
        seat.backend->setPicture(camera, settings);
        return;
    }
    seat.backend = std::make_shared<VulkanBackend>(*seat.open.device, *scene_, camera, settings,
                                                   KernelTuning{.scheduler = scheduler_});
}

/// At the same time on all of them: compiling the kernel takes seconds on some.
void RenderDevices::prepareAll(const Camera& camera, const RenderSettings& settings) {
    std::vector<std::future<void>> ready;
    for (Seat& seat : seats_)
        ready.push_back(std::async(std::launch::async, [&] { prepare(seat, camera, settings); }));
    std::vector<Seat> left;
    std::exception_ptr why;
    for (size_t i = 0; i < ready.size(); ++i) {
        try {
            ready[i].get();
            left.push_back(std::move(seats_[i]));
        } catch (const DeviceError& error) {
            why = std::current_exception();
            logging::warn(fmt::format("{} takes no samples: {}",
                                      seats_[i].open.device->description().name(), error.what()));
        }
    }
    seats_ = std::move(left);
    if (seats_.empty()) std::rethrow_exception(why);
}

std::shared_ptr<Backend> RenderDevices::backendFor(const Camera& camera,
                                                   const RenderSettings& settings) {
    leaveOutWhoDroppedOut();
    if (seats_.empty()) throw DeviceLostError("no device is left");
    if (seats_.size() == 1)
        prepare(seats_.front(), camera, settings);
    else
        prepareAll(camera, settings);
    sayHow();
    if (seats_.size() == 1) return seats_.front().backend;
    std::vector<TeamMember> members;
    for (const Seat& seat : seats_)
        members.push_back({seat.open.device->description().name(), seat.backend});
    team_ = std::make_shared<TeamBackend>(std::move(members), settings.area,
                                          [](const std::string& line) { logging::warn(line); });
    return team_;
}

Viewer* RenderDevices::viewer() {
    if (seats_.empty()) return nullptr;
    if (!team_) return seats_.front().backend.get();
    const std::vector<size_t> present = team_->present();
    return present.empty() ? nullptr : seats_[present.front()].backend.get();
}

void RenderDevices::requireNoValidationMessages() const {
    for (const Seat& seat : seats_)
        vulkan::requireNoValidationMessages(seat.open);
}

} // namespace stromboli
