#include "host/cs184/cs184.hpp"

namespace stromboli {

SceneConventions cs184Conventions() {
    SceneConventions c;
    c.renderer = "the CS184 renderer";
    c.option = "--cs184";
    c.defaultLight = false;
    c.applyUnit = false;
    c.scaleCameras = false;
    c.vertexNormals = VertexNormals::Recomputed;
    c.winding = Winding::AsTransformed;
    c.materialBinding = MaterialBinding::FirstForMesh;
    c.shadingModels = ShadingModels::PhongOnly;
    c.unstatedAlbedo = 0.5f;
    c.clampReflectedFractions = false;
    c.textures = false;
    c.shadingModelsEmit = false;
    c.areaLights = AreaLights::StayLights;
    c.directionalAim = DirectionalAim::NodePoint;
    c.ambientFrom = AmbientFrom::UpperHemisphere;
    c.attenuation = false;
    c.spotLights = false;
    return c;
}

FramingConventions cs184Framing() {
    return {.pictureSize = PictureSize{800, 600},
            .framesEveryScene = true,
            .lastOfSeveral = true,
            .directionWithoutCamera = {0, 0, 1},
            .fillsPicture = false,
            .clipsFramedViews = true,
            .clipsAlongRay = true};
}

ShadingConventions cs184Shading() {
    return {.facesForward = false,
            .offsetsTerminator = false,
            .testsGeometricSide = false,
            .exactFresnel = false,
            .exactLambda = false,
            .compressesRadiance = false,
            .bouncesFindAllLight = false,
            .inverseSquareFalloff = false,
            .ambientAboutNormal = false,
            .samplesEmitters = false,
            .everyLightInTurn = true,
            .hemispherePerLight = true};
}

} // namespace stromboli
