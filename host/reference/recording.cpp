// What a path notes of itself where it is recorded.
#include "host/reference/integrator.hpp"

namespace stromboli::reference {

void PathSample::noteArrival(const Ray& ray, bool hits, const glm::dvec3& light) {
    if (record_ == nullptr) return;
    RecordedVertex vertex;
    vertex.branch = branch_;
    vertex.direction = ray.direction;
    vertex.throughput = throughput_;
    vertex.light = light;
    if (hits) {
        const bool isSurface = surface_.medium == nullptr;
        vertex.met = isSurface ? RecordedVertex::Met::Surface : RecordedVertex::Met::Medium;
        vertex.primitive = surface_.primitive;
        vertex.position = surface_.position;
        vertex.distance = glm::length(surface_.position - ray.origin);
    }
    if (settings_.roulette.mode == Roulette::Mode::Fixed)
        vertex.goesOn = 1 - settings_.roulette.terminationProbability;
    record_->vertices.push_back(std::move(vertex));
}

void PathSample::noteLight(const LightSample& light, RecordedLight::Fate fate,
                           const glm::dvec3& brings) {
    if (record_ == nullptr) return;
    RecordedLight noted;
    noted.primitive = light.primitive;
    noted.direction = light.direction;
    if (!light.infinite) noted.distance = glm::length(light.target - litPoint(lit_));
    noted.fate = fate;
    noted.light = brings;
    record_->vertices.back().lights.push_back(std::move(noted));
}

void PathSample::noteBounce(const BsdfSample& next, double goesOn, bool survives) {
    if (record_ == nullptr) return;
    record_->vertices.back().bounce = {
        next.direction, next.lobe, next.isDelta() ? 0 : next.pdf, throughput_, goesOn, survives, 1};
}

void PathSample::noteReturn() {
    if (record_ == nullptr) return;
    RecordedVertex again;
    for (const RecordedVertex& vertex : record_->vertices)
        if (vertex.branch == 0) again = vertex;
    again.branch = branch_;
    again.returns = true;
    again.light = glm::dvec3(0.0);
    again.lights.clear();
    again.bounce.reset();
    record_->vertices.push_back(std::move(again));
}

} // namespace stromboli::reference
