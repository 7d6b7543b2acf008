#include "scene/assimp/views.hpp"

#include "scene/assimp/vectors.hpp"

#include <cmath>

namespace stromboli::assimp {
namespace {

/// Something at a point that looks along its own -z axis, in its node's space.
glm::dmat4 lookingAlong(const glm::dvec3& at, const glm::dvec3& direction, const glm::dvec3& up) {
    const glm::dvec3 back =
        glm::length(direction) > 0 ? -glm::normalize(direction) : glm::dvec3(0, 0, 1);
    glm::dvec3 right = glm::cross(up, back);
    if (!(glm::length(right) > 1e-6)) // looks along what is to be up
        right =
            glm::cross(std::abs(back.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1), back);
    right = glm::normalize(right);
    return {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
            glm::dvec4(at, 1)};
}

} // namespace

void placeLight(const aiLight& file, const glm::dmat4& toWorld, double unit,
                bool decaysFromOneMetre, build::SceneBuilder& builder) {
    Light light;
    light.name = file.mName.C_Str();
    light.color = builder.lightColor(
        "a light's colour", {file.mColorDiffuse.r, file.mColorDiffuse.g, file.mColorDiffuse.b});
    switch (file.mType) {
    case aiLightSource_DIRECTIONAL:
        light.kind = LightKind::Directional;
        break;
    case aiLightSource_POINT:
        light.kind = LightKind::Point;
        break;
    case aiLightSource_SPOT:
        light.kind = LightKind::Spot;
        light.falloffAngle = std::clamp(file.mAngleOuterCone, 1e-3f, 3.14159f);
        if (file.mAngleInnerCone < light.falloffAngle)
            light.innerAngle = std::max(file.mAngleInnerCone, 0.0f);
        break;
    case aiLightSource_AMBIENT:
        light.kind = LightKind::Ambient;
        light.color = {file.mColorAmbient.r, file.mColorAmbient.g, file.mColorAmbient.b};
        break;
    default:
        return builder.report().ignore("lights of other kinds", "give no light");
    }
    light.constantAttenuation = file.mAttenuationConstant;
    light.linearAttenuation = float(file.mAttenuationLinear / unit);
    light.quadraticAttenuation = float(file.mAttenuationQuadratic / (unit * unit));
    if (decaysFromOneMetre) {
        light.linearAttenuation = light.linearAttenuation > 0 ? 1.0f : 0.0f;
        light.quadraticAttenuation = light.quadraticAttenuation > 0 ? 1.0f : 0.0f;
        light.constantAttenuation = 0; // 1 below, where it does not fade
    }
    const bool fades = light.constantAttenuation > 0 || light.linearAttenuation > 0 ||
                       light.quadraticAttenuation > 0;
    if (!fades) light.constantAttenuation = 1;
    builder.placeLight(light, toWorld * lookingAlong(vectorOf(file.mPosition),
                                                     vectorOf(file.mDirection), {0, 1, 0}));
}

void placeCamera(const aiCamera& file, const glm::dmat4& toWorld, build::SceneBuilder& builder) {
    FileCamera camera;
    camera.name = file.mName.C_Str();
    const bool isOrthographic = file.mOrthographicWidth > 0;
    camera.projection = isOrthographic ? Projection::Orthographic : Projection::Perspective;
    // Assimp's documents have the angle from the middle of the view to its border; its readers give
    // what their formats state, as FBX does, which is that between both borders.
    camera.halfWidth = isOrthographic
                           ? double(file.mOrthographicWidth)
                           : std::tan(std::clamp(double(file.mHorizontalFOV) / 2, 1e-3, 1.5));
    if (file.mAspect > 0) camera.halfHeight = *camera.halfWidth / double(file.mAspect);
    builder.placeCamera(camera, toWorld * lookingAlong(vectorOf(file.mPosition),
                                                       vectorOf(file.mLookAt), vectorOf(file.mUp)));
}

} // namespace stromboli::assimp
