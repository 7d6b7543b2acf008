#include "host/view/showing.hpp"

#include "host/core/json.hpp"
#include "host/film/metering.hpp"

#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace stromboli::view {
namespace {

Json vectorOf(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

Json poseJson(const Pose& pose) {
    return {{"from", vectorOf(pose.from)},
            {"at", vectorOf(pose.at)},
            {"fov", pose.fieldOfView},
            {"aperture", pose.aperture},
            {"focus", pose.focus}};
}

Json noiseJson(const PictureNoise& noise) {
    if (!noise.known()) return nullptr;
    return {{"estimate", noise.estimate}, {"least", noise.least}, {"most", noise.most}};
}

double meteredOf(const Raster& raster) {
    std::vector<glm::vec3> colors(raster.values.size() / 3);
    for (size_t i = 0; i < colors.size(); ++i)
        colors[i] = {raster.values[i * 3], raster.values[i * 3 + 1], raster.values[i * 3 + 2]};
    return meteredExposure(colors);
}

/// Mean and largest number of paths of a pixel.
std::array<double, 2> samplesOf(const Film& film) {
    uint64_t sum = 0;
    uint32_t most = 0;
    for (const PixelStatistics& pixel : film.pixels) {
        sum += pixel.taken();
        most = std::max(most, pixel.taken());
    }
    const double pixels = double(std::max<size_t>(film.pixels.size(), 1));
    return {double(sum) * film.branches / pixels, double(most) * film.branches};
}

} // namespace

bool Cadence::isDue(double seconds) const {
    if (!last_) return true;
    const double pause =
        std::max(std::clamp(*last_ / 8, kSoonest, kLatest), cost_ / kShareOfTime - cost_);
    return seconds >= *last_ + pause;
}

void Cadence::made(double seconds, double cost) {
    last_ = seconds;
    cost_ = cost;
}

void Showing::beginPicture() {
    watch_ = {};
    cadence_.beginPicture();
    source_.beginPicture();
}

std::string Showing::textOf(Shown what, const ShownState& state, const Raster& raster,
                            int exponent) {
    const Film& film = session_.film();
    const RenderResult result = session_.result();
    const auto [mean, most] = samplesOf(film);
    const Scene& scene = session_.scene();
    const ResolvedPicture& picture = session_.picture();
    Json cameras = Json::array();
    for (const FileCamera& camera : scene.cameras)
        cameras.push_back(camera.name);
    const auto orNull = [](const std::optional<double>& value) {
        return value ? Json(*value) : Json(nullptr);
    };
    const bool isRadiance = what == Shown::Picture || what == Shown::Denoised;
    const Json text = {
        {"number", number_},
        {"epoch", state.epoch},
        {"shown", nameOf(what)},
        {"width", raster.width},
        {"height", raster.height},
        {"channels", raster.channels},
        {"exponent", exponent},
        {"fullWidth", state.fullWidth},
        {"fullHeight", state.fullHeight},
        {"coarse", state.coarse},
        {"state", state.state},
        {"paused", state.paused},
        {"biased", picture.settings.estimator.limitsLight()},
        {"share", state.share},
        {"samples", mean},
        {"mostSamples", most},
        {"noise", noiseJson(result.noise)},
        {"denoisedNoise",
         what == Shown::Denoised ? noiseJson(session_.denoised().summary.noise) : Json(nullptr)},
        {"seconds", secondsOfPicture()},
        {"raysPerSecond", state.raysPerSecond},
        {"exposureAuto", isRadiance ? Json(meteredOf(raster)) : Json(nullptr)},
        {"scene", state.scene},
        {"device", result.backend},
        {"cameras", cameras},
        {"difference",
         isRadiance && reference_ ? differenceJson(*reference_, raster) : Json(nullptr)},
        {"readOnly", state.readOnly},
        {"problem", state.problem},
        {"turn", orNull(state.turn)},
        {"sun",
         state.sun ? Json::array({state.sun->azimuth, state.sun->elevation}) : Json(nullptr)},
        {"variants", scene.variants},
        {"variant", state.variant},
        {"animationSeconds", scene.animationSeconds},
        {"atSeconds", orNull(state.seconds)},
        {"isStated", state.pose.has_value()},
        {"pose", poseJson(state.pose.value_or(poseOf(picture.camera, scene)))},
    };
    return text.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void Showing::show(const ShownState& state, bool isLast, const std::function<bool()>& isUnwanted) {
    const Stopwatch watch;
    auto awaited = exchange_.awaited();
    if (isLast) awaited[size_t(Shown::Picture)] = true;
    exchange_.forgetFrames();
    ++number_;
    for (size_t i = 0; i < awaited.size(); ++i) {
        if (!awaited[i]) continue;
        const Shown what = kNamedValues<Shown>[i].value;
        const Raster raster = source_.raster(what, isUnwanted);
        if (raster.values.empty()) continue;
        const int exponent = exponentFor(raster.values);
        exchange_.publish(what, number_,
                          std::make_shared<const std::string>(encodeFrame(
                              textOf(what, state, raster, exponent), raster, exponent)));
    }
    cadence_.made(watch_.seconds(), watch.seconds());
}

Pose poseOf(const Camera& camera, const Scene& scene) {
    const Bounds bounds = scene.framed();
    Pose pose;
    pose.from = camera.position + scene.origin;
    double distance = 1;
    if (!bounds.empty()) {
        const glm::dvec3 low(bounds.lo), high(bounds.hi);
        distance = glm::dot(0.5 * (low + high) - camera.position, -camera.back);
        if (distance < 0.05 * glm::length(high - low)) distance = 0.25 * glm::length(high - low);
        if (!(distance > 0)) distance = 1;
    }
    pose.at = pose.from - distance * camera.back;
    if (!camera.orthographic)
        pose.fieldOfView =
            std::clamp(2 * std::atan(camera.halfHeight) * 180 / glm::pi<double>(), 1e-6, 179.999);
    if (camera.lensRadius > 0) {
        pose.aperture = 2 * camera.lensRadius;
        pose.focus = camera.focusDistance;
    }
    return pose;
}

} // namespace stromboli::view
