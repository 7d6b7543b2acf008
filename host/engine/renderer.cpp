#include "host/engine/renderer.hpp"

#include "host/checkpoint/scene_identity.hpp"
#include "host/core/error.hpp"
#include "host/core/system.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/block_backend.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <ranges>
#include <tuple>
#include <utility>

namespace stromboli {
namespace {

bool sameSelection(const LightSelection& a, const LightSelection& b) {
    const auto all = [](const LightSelection& s) {
        return std::tie(s.choice, s.deltaLightsOnly, s.ambientToBounces, s.emitters,
                        s.everyLightOfTheFile);
    };
    return all(a) == all(b);
}

std::vector<vulkan::OpenDevice> openAll(const DeviceRequest& request, const Listener& listener) {
    if (request.maybeSeveral) return vulkan::openDevices(request.device, listener.message);
    std::vector<vulkan::OpenDevice> one;
    one.push_back(vulkan::openDevice(request.device, listener.message));
    return one;
}

} // namespace

RenderDevices::RenderDevices(const DeviceRequest& request, Listener listener)
    : request_(request), listener_(std::move(listener)),
      opening_(std::async(std::launch::async, openAll, request, listener_)) {}

void RenderDevices::open() {
    if (whyNotOpen_) std::rethrow_exception(whyNotOpen_);
    if (!opening_.valid()) return;
    try {
        for (vulkan::OpenDevice& open : opening_.get())
            seats_.push_back({std::move(open), nullptr});
    } catch (...) { // each picture that is asked for ends with the reason
        whyNotOpen_ = std::current_exception();
        throw;
    }
    sayWhich();
}

void RenderDevices::reopen() {
    team_.reset();
    seats_.clear();
    for (vulkan::OpenDevice& open : openAll(request_, listener_))
        seats_.push_back({std::move(open), nullptr});
}

void RenderDevices::sayWhich() const {
    for (const Seat& seat : seats_)
        listener_.detail(fmt::format("device {}: {} ({})", seat.open.choice.index,
                                     seat.open.device->description().name(),
                                     seat.open.choice.reason));
}

/// Once, of the first picture.
void RenderDevices::sayHow() {
    if (std::exchange(howIsSaid_, true)) return;
    for (const std::string& line : describe(seats_.front().backend->features()))
        listener_.detail(fmt::format("kernel: {}", line));
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
                                      uint64_t hostBytes, uint64_t bytesPerPixel) const {
    uint64_t onDevice = ~uint64_t(0);
    for (const Seat& seat : seats_)
        onDevice = std::min(onDevice,
                            filmPixelsThatFit(seat.open.device->description(), scene, estimator));
    return std::min(hostBytes / (bytesPerPixel + hostBytesPerPixel()), onDevice);
}

uint64_t RenderDevices::hostBytesOfScene(const GpuScene& scene) const {
    constexpr uint64_t kDriver = uint64_t(96) << 20; // its compiler and kernels, measured
    uint64_t bytes = 0;
    for (const Seat& seat : seats_) {
        if (!seat.open.device->description().isCpu()) continue;
        bytes += kDriver;
        const bool readsHost = seat.open.device->description().readsHostPages;
        for (const vulkan::BufferPlan& plan : planSceneBuffers(scene, {}))
            if (!(readsHost && plan.isInPages)) bytes += plan.bytes;
    }
    return bytes;
}

uint64_t RenderDevices::hostBytesPerPixel() const {
    uint64_t bytes = 0;
    for (const Seat& seat : seats_)
        if (seat.open.device->description().isCpu()) bytes += sizeof(gpu::PixelState);
    return seats_.size() > 1 ? bytes + sizeof(gpu::PixelState) : bytes;
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

void RenderDevices::sceneHasChanged(std::span<const uint32_t> bindings) {
    leaveOutWhoDroppedOut();
    for (Seat& seat : seats_)
        if (seat.backend) seat.backend->sceneHasChanged(bindings);
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
                                                   KernelTuning{.scheduler = request_.scheduler});
}

/// At the same time on all of them: compiling the kernel takes seconds on some. A pixel has the
/// strands that suit the first one.
void RenderDevices::prepareAll(const Camera& camera, const RenderSettings& asked) {
    RenderSettings settings = asked;
    if (settings.strands == 0)
        settings.strands = tuningFor({.scheduler = request_.scheduler}, *seats_.front().open.device,
                                     *scene_, asked.area, 0)
                               .strands;
    std::vector<std::future<void>> ready;
    for (Seat& seat : seats_)
        ready.push_back(std::async(std::launch::async, [&] { prepare(seat, camera, settings); }));
    std::vector<size_t> failed;
    std::exception_ptr why;
    for (size_t i = 0; i < ready.size(); ++i) {
        try {
            ready[i].get();
        } catch (const DeviceError& error) {
            why = std::current_exception();
            failed.push_back(i);
            listener_.warn(fmt::format("{} takes no samples: {}",
                                       seats_[i].open.device->description().name(), error.what()));
        }
    }
    for (const size_t i : failed | std::views::reverse)
        seats_.erase(seats_.begin() + std::ptrdiff_t(i));
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
    team_ = std::make_shared<TeamBackend>(
        std::move(members), settings.area,
        [listener = listener_](const std::string& line) { listener.warn(line); });
    return team_;
}

Viewer* RenderDevices::viewer() {
    if (seats_.empty()) return nullptr;
    if (!team_) return seats_.front().backend.get();
    const std::vector<size_t> present = team_->present();
    return present.empty() ? nullptr : seats_[present.front()].backend.get();
}

const vulkan::Device* RenderDevices::first() const {
    return seats_.empty() ? nullptr : seats_.front().open.device.get();
}

void RenderDevices::requireNoValidationMessages() const {
    for (const Seat& seat : seats_)
        vulkan::requireNoValidationMessages(seat.open);
}

Renderer::Renderer(const DeviceRequest& request, Listener listener)
    : request_(request), listener_(std::move(listener)) {
    if (request_.backend == BackendChoice::Vulkan) devices_.emplace(request_, listener_);
}

void Renderer::begin(std::shared_ptr<const Scene> scene, const ResolvedPicture& picture,
                     size_t channels) {
    scene_ = std::move(scene);
    camera_ = picture.camera;
    settings_ = picture.settings;
    channels_ = channels;
    buildSeconds_ = 0;
    samplersHaveIt_ = false;
    resident_ = residentMemory();
    if (!devices_) {
        name_ = "CPU reference (double precision)";
        return;
    }
    const bool isThere = built_ && builtOf_ == scene_ &&
                         sameSelection(builtFor_, lightSelection(settings_.estimator));
    if (!isThere && scene_ != movedTo_) gatheredRows_ = kUsualGatheredRows;
    if (!isThere) build(settings_.estimator);
    devices_->open(); // began while the scene was built
    if (!isThere && gatheredRows_ > 0 && !devices_->haveRoomForTextures(built_->gpu)) {
        gatheredRows_ = 0;
        build(settings_.estimator);
    }
    fitToPicture();
    name_ = devices_->name();
    samplersHaveIt_ = isThere;
    resident_ = residentMemory();
}

/// Portals are found anew for each camera: it may stand in another room than the one before.
void Renderer::fitToPicture() {
    GpuScene& scene = built_->gpu;
    const std::vector<uint32_t> changed =
        stromboli::fitToPicture(scene, *scene_, camera_, settings_.estimator);
    if (!changed.empty()) devices_->sceneHasChanged(changed);
    kept_.ofRay = scene.ofRay;
    kept_.looksAtOccluders = scene.looksAtOccluders;
    kept_.looksAtShadowMap = scene.looksAtShadowMap;
    const bool areStated = !scene_->portals.empty();
    if (const size_t count = scene.portals.all.size(); count > 0)
        listener_.detail(fmt::format("light samples aim at {} {} that the sky is seen through{}",
                                     count, count == 1 ? "rectangle" : "rectangles",
                                     areStated ? "" : " (found: --portals off leaves them out)"));
    if (scene.lights.isPickedByArrival)
        listener_.detail("light samples pick lights by how much of their light arrives "
                         "(--light-choice tree or power: by power and place alone)");
    if (lightsThroughGlass(scene, settings_.estimator))
        listener_.detail("light samples go on where they meet clear glass");
    if (aimsBounces(scene, settings_.estimator))
        listener_.detail("some bounces aim at what lamps light from near by (--gap-proposal off "
                         "leaves that out)");
}

void Renderer::build(const Estimator& estimator) {
    const bool hasMoved = std::exchange(movedTo_, nullptr) == scene_;
    auto built = std::make_unique<BuiltScene>(
        buildScene(*scene_, estimator, listener_, scene_->isMoment() ? &kept_ : nullptr,
                   gatheredRows_, hasMoved ? &built_->gpu : nullptr));
    builtOf_ = nullptr; // until the devices have this one
    devices_->setScene(built->gpu);
    built_ = std::move(built);
    builtOf_ = scene_;
    builtFor_ = lightSelection(estimator);
    buildSeconds_ = built_->seconds;
}

void Renderer::sceneHasChanged(const std::shared_ptr<const Scene>& before,
                               const std::shared_ptr<const Scene>& scene,
                               const SceneChange& change) {
    if (!devices_ || !built_) return; // it is built when it is asked for
    if (builtOf_ != before) return;
    const bool isOfRows = !change.materials.empty() || !change.lights.empty();
    if (!change.motions.empty() ||
        (isOfRows && wantsOtherTextures(built_->gpu, *scene, gatheredRows_))) {
        builtOf_ = nullptr;
        movedTo_ = scene;
        return;
    }
    if (isOfRows || change.environment) {
        devices_->sceneHasChanged(
            repackMaterials(built_->gpu, *scene, builtFor_, change.environment != nullptr));
    } else if (change.rotation) {
        devices_->sceneHasChanged(turnEnvironment(built_->gpu, *change.rotation));
    }
    builtOf_ = scene;
    scene_ = scene;
}

std::shared_ptr<Backend> Renderer::backend(const RenderSettings& settings, bool again) {
    if (devices_) {
        if (again) devices_->reopen();
        return devices_->backendFor(camera_, settings);
    }
    auto made = std::make_shared<ReferenceBackend>(*scene_, camera_, settings, request_.threads);
    referenceViewer_ = made.get();
    reference_ = made;
    return made;
}

Viewer* Renderer::viewer() {
    return devices_ ? devices_->viewer() : referenceViewer_;
}

/// What a film and all that belongs to it may take.
uint64_t Renderer::bytesForFilms() const {
    const uint64_t asked =
        request_.filmMebibytes ? uint64_t(*request_.filmMebibytes) << 20 : physicalMemory() / 2;
    if (!request_.mostMebibytes) return asked;
    const auto most = uint64_t(*request_.mostMebibytes * 0x1p20);
    const uint64_t others = resident_ + bytesOfScene();
    return std::min(asked, most > others ? most - others : 0);
}

/// Of what is still to be made of it.
uint64_t Renderer::bytesOfScene() const {
    if (samplersHaveIt_) return 0;
    return devices_ ? devices_->hostBytesOfScene(built_->gpu) : referenceBytes(*scene_);
}

MemoryNeed Renderer::memoryNeeded(uint64_t pixels) const {
    const uint64_t onDevices = devices_ ? devices_->hostBytesPerPixel() : 0;
    return {resident_, bytesOfScene(), pixels * (bytesPerPixel() + onDevices)};
}

void Renderer::requireMemory(uint64_t pixels) const {
    const MemoryNeed need = memoryNeeded(pixels);
    const auto mebibytes = [](uint64_t bytes) { return (bytes + (1u << 20) - 1) >> 20; };
    const std::string parts =
        fmt::format("{} MiB: {} so far, {} for the scene, {} for the film", mebibytes(need.all()),
                    mebibytes(need.soFar), mebibytes(need.scene), mebibytes(need.film));
    if (!request_.mostMebibytes) return listener_.detail("memory: about " + parts);
    if (double(need.all()) > *request_.mostMebibytes * 0x1p20)
        throw UsageError(fmt::format("--max-memory allows {:.0f} MiB, and the render needs about "
                                     "{}",
                                     *request_.mostMebibytes, parts));
    listener_.info("memory: about " + parts);
}

uint64_t Renderer::bytesPerPixel() const {
    return hostBytesPerPixel(settings_.budget.isInBlocks()) + channels_ * sizeof(float);
}

uint64_t Renderer::mostPixels() const {
    if (!devices_) return bytesForFilms() / bytesPerPixel();
    return devices_->pixelsThatFit(built_->gpu, settings_.estimator, bytesForFilms(),
                                   bytesPerPixel());
}

RenderIdentity Renderer::identity() const {
    return {version(),
            renderingCode(),
            scene_->file,
            sceneIdentity(*scene_, camera_),
            std::string(nameOf(request_.backend)),
            name_};
}

void Renderer::requireNoValidationMessages() const {
    if (devices_) devices_->requireNoValidationMessages();
}

} // namespace stromboli
