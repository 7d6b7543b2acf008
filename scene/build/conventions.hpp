#pragma once

#include "host/core/text.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli {

namespace build {
class FileStore;
}

/// Which normals meshes are shaded with.
enum class VertexNormals {
    FromFile,   ///< those the file states, by the inverse transpose; without any, flat shading
    Recomputed, ///< sums over the triangles around each vertex (scene/build/vertex_normals.hpp)
};

/// Which side of a triangle is its front.
enum class Winding {
    /// The side its normals are on; without normals, the side that it has before transformation,
    /// also where the transformation mirrors it.
    TowardsNormals,
    AsTransformed, ///< the side that its corners give after transformation, in the file's order
};

/// Which material the parts of a mesh have.
enum class MaterialBinding {
    ByPart,       ///< each the one that the file binds to it
    FirstForMesh, ///< all of them the first one that the file binds to any
};

/// What becomes of lights that are rectangles.
enum class AreaLights {
    BecomeGeometry, ///< emissive triangles, or the emissive mesh in the same place: one emitter
    StayLights,     ///< rectangles that are sampled and are not seen
};

/// Whether meshes that a file shows several times share their triangles.
enum class InstanceSharing {
    Automatic, ///< where copies would be many: they are faster to trace, but take memory
    On,        ///< wherever it is possible
    Off,       ///< never: all have copies
};
template <>
inline constexpr auto kNamedValues<InstanceSharing> = std::to_array<NamedValue<InstanceSharing>>({
    {InstanceSharing::Automatic, "auto",
     "share where copies would be more than a million triangles"},
    {InstanceSharing::On, "on", "share"},
    {InstanceSharing::Off, "off", "copy"},
});

/// Which axis of a file points up.
enum class UpAxis { Y, Z };
template <>
inline constexpr auto kNamedValues<UpAxis> = std::to_array<NamedValue<UpAxis>>({
    {UpAxis::Y, "y", "as in most pictures and games"},
    {UpAxis::Z, "z", "as in most of CAD, printing and maps"},
});

/// How a node's matrix aims a directional light.
enum class DirectionalAim {
    NodeAxis, ///< its light travels along the node's -z axis
    /// The point (0, 0, -1) of the node is the direction from the scene to the light: the node's
    /// position counts.
    NodePoint,
};

/// Where ambient light comes from.
enum class AmbientFrom { EveryDirection, UpperHemisphere };

/// Which shading models of a file give a surface its material.
enum class ShadingModels {
    All,
    PhongOnly, ///< the others become mid grey
};

/// A value for a name that a file leaves open.
struct Definition {
    std::string name, value;
};

/// Which of the things that a file holds are shown, where it holds several.
struct FileSelection {
    std::optional<uint32_t> scene; ///< number of the scene, from 0; nothing: the file's own choice
    std::string variant;           ///< name of a set of materials; empty: the plain materials
    std::optional<double> seconds; ///< of the animation; nothing: what stands without it
    bool isFrame = false;          ///< the moment is one of a sequence (--frames)
    std::vector<Definition> definitions; ///< in place of the file's own values of these names
    uint32_t largestTexture = 0;         ///< pictures are halved until no side exceeds it; 0: never

    /// The option of the command line that asks for what only glTF files have; empty if none does.
    std::string_view option() const {
        if (seconds && isFrame) return "--frames";
        return scene ? "--scene" : !variant.empty() ? "--variant" : seconds ? "--at" : "";
    }
};

/// How the statements of a file become a scene, where renderers differ. The default is what the
/// formats' standards and physics say. Loaders and the builder ask for a convention by its name
/// and do not know whose it is.
struct SceneConventions {
    /// The renderer that reads files in this way, as the subject of a sentence; for messages. Empty
    /// for the default.
    std::string renderer;
    std::string option; ///< of the command line that asks for them; for messages

    /// What breaks the rules of a format is an error, also where it is clear what is meant.
    bool strict = false;
    /// Told the name of each material that an OBJ file names and does not state. Such a material is
    /// grey then and has its name, so that whoever reads the file can put another in its place.
    /// Empty: all of them are one, and the file's report says so.
    std::function<void(const std::string&)> onUnknownMaterial;
    /// A scene without any light gets one (scene/model/default_light.hpp).
    bool defaultLight = true;

    InstanceSharing instances = InstanceSharing::Automatic;

    /// What is up in files whose format does not say so (readScene() refuses others).
    UpAxis up = UpAxis::Y;
    /// Lengths are multiplied by the file's unit; otherwise its numbers are taken as metres.
    bool applyUnit = true;
    /// Sizes and depth ranges of cameras are multiplied by the scale of their nodes.
    bool scaleCameras = true;

    FileSelection selection;
    /// Where what is read is kept for the next reading of the file; none: nowhere.
    std::shared_ptr<build::FileStore> kept;

    VertexNormals vertexNormals = VertexNormals::FromFile;
    Winding winding = Winding::TowardsNormals;

    MaterialBinding materialBinding = MaterialBinding::ByPart;
    ShadingModels shadingModels = ShadingModels::All;
    /// A surface whose material states no diffuse colour reflects this fraction.
    float unstatedAlbedo = 0;
    /// Reflected fractions above 1 become 1; otherwise they are kept.
    bool clampReflectedFractions = true;
    /// Pictures and the colours of corners change what surfaces reflect and emit; otherwise not.
    bool textures = true;
    /// Materials emit what their shading model says; otherwise only elements made for it count.
    bool shadingModelsEmit = true;

    AreaLights areaLights = AreaLights::BecomeGeometry;
    DirectionalAim directionalAim = DirectionalAim::NodeAxis;
    AmbientFrom ambientFrom = AmbientFrom::EveryDirection;
    bool attenuation = true; ///< point and spot lights fall off as the file says; otherwise not
    bool spotLights = true;  ///< spot lights shine; otherwise they are left out

    /// Shared triangles have the normals of their own space, on whose side they are.
    bool sharesInstances() const {
        return vertexNormals == VertexNormals::FromFile && winding == Winding::TowardsNormals;
    }

    /// True for those of the default: no other renderer is followed.
    bool areDefault() const { return renderer.empty(); }
};

} // namespace stromboli
