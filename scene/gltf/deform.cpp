#include "scene/gltf/deform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace stromboli::gltf {
namespace {

/// Tangents have a fourth number, which displacements do not change.
void addDisplacements(Values& values, const std::optional<Values>& displacements, double weight) {
    if (!displacements) return;
    const size_t width = std::min(values.width, displacements->width);
    for (size_t i = 0; i < values.count; ++i)
        for (size_t k = 0; k < width; ++k)
            values.numbers[i * values.width + k] += weight * displacements->at(i)[k];
}

void storeVector(Values& values, size_t i, const glm::dvec3& v) {
    for (int k = 0; k < 3; ++k)
        values.numbers[i * values.width + size_t(k)] = v[k];
}

/// The weighted sum of the joints' matrices. Files round weights; their sum is made 1. Nothing
/// where all are 0.
std::optional<glm::dmat4> blended(const Primitive& p, size_t vertex,
                                  const std::vector<glm::dmat4>& joints, const Element& element) {
    glm::dmat4 sum(0.0);
    double total = 0;
    for (size_t set = 0; set < p.joints.size(); ++set)
        for (size_t k = 0; k < 4; ++k) {
            const double weight = p.weights[set].at(vertex)[k];
            const double joint = p.joints[set].at(vertex)[k];
            if (weight == 0) continue;
            if (!(joint >= 0 && joint < double(joints.size())))
                element.fail(
                    fmt::format("vertex {} names joint {} of {}", vertex, joint, joints.size()));
            sum += weight * joints[size_t(joint)];
            total += weight;
        }
    return total > 0 ? std::optional(sum / total) : std::nullopt;
}

glm::dmat4 ofFirstJoint(const Primitive& p, size_t vertex, const std::vector<glm::dmat4>& joints) {
    const double joint = p.joints[0].at(vertex)[0];
    return joint >= 0 && joint < double(joints.size()) ? joints[size_t(joint)] : joints[0];
}

} // namespace

void applyTargets(Primitive& p, std::span<const double> weights) {
    for (size_t i = 0; i < p.targets.size() && i < weights.size(); ++i) {
        if (weights[i] == 0) continue;
        addDisplacements(p.positions, p.targets[i].positions, weights[i]);
        if (p.normals) addDisplacements(*p.normals, p.targets[i].normals, weights[i]);
        if (p.tangents) addDisplacements(*p.tangents, p.targets[i].tangents, weights[i]);
        for (size_t set = 0; set < 2; ++set)
            if (p.uvs[set]) addDisplacements(*p.uvs[set], p.targets[i].uvs[set], weights[i]);
        if (!p.targets[i].colors) continue;
        addDisplacements(*p.colors, p.targets[i].colors, weights[i]);
        for (double& channel : p.colors->numbers)
            channel = std::clamp(channel, 0.0, 1.0);
    }
}

size_t applySkin(Primitive& p, const std::vector<glm::dmat4>& joints, const Element& element) {
    size_t weightless = 0;
    for (size_t i = 0; i < p.vertexCount; ++i) {
        const std::optional<glm::dmat4> sum = blended(p, i, joints, element);
        weightless += !sum;
        const glm::dmat4 m = sum ? *sum : ofFirstJoint(p, i, joints);
        const glm::dmat3 linear(m);
        storeVector(p.positions, i, m * glm::dvec4(p.positions.vec3(i), 1));
        // The cofactors are the inverse transpose up to a factor, whose sign matters here only.
        const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]),
                                   glm::cross(linear[2], linear[0]),
                                   glm::cross(linear[0], linear[1]));
        const double sign = glm::determinant(linear) < 0 ? -1 : 1;
        if (p.normals) storeVector(*p.normals, i, sign * (cofactors * p.normals->vec3(i)));
        if (p.tangents) {
            storeVector(*p.tangents, i, linear * glm::dvec3(p.tangents->vec4(i)));
            p.tangents->numbers[i * 4 + 3] *= sign;
        }
    }
    return weightless;
}

} // namespace stromboli::gltf
