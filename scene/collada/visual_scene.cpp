#include "scene/collada/visual_scene.hpp"

#include "scene/build/shortfall.hpp"
#include "scene/build/vectors.hpp"
#include "scene/collada/cameras.hpp"
#include "scene/collada/cgl_dialect.hpp"
#include "scene/collada/controllers.hpp"
#include "scene/collada/lights.hpp"
#include "scene/collada/materials.hpp"
#include "scene/collada/primitives.hpp"
#include "scene/collada/transforms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace stromboli::collada {
namespace {

/// References to nodes can be nested so deep...
constexpr size_t kDeepestNode = 1000;
/// ...and repeat so many nodes, before a file of a few lines fills any memory.
constexpr size_t kMostRepeatedNodes = size_t(1) << 20;

/// A <geometry>, read once for all its instances...
struct Geometry {
    std::optional<double> sphereRadius;
    const Element* mesh = nullptr; ///< null: it has none, or is a sphere
    std::vector<Primitive> primitives;
    /// ...whose textures use the same texture coordinates of each primitive.
    std::map<std::vector<TexcoordInputs>, build::ShapeId> shapes;
};

class SceneWalk {
  public:
    explicit SceneWalk(Context& context)
        : context_(context), materials_(context),
          fileToWorld_(fileToWorld(context.document, context.conventions.applyUnit)),
          controllers_(context, fileToWorld_) {}

    void run(const Element& visualScene) {
        for (const Element& child : children(visualScene)) {
            if (named(child, "node"))
                visitNode(child, fileToWorld_);
            else if (!isMetadata(child))
                ignore(child, "has no effect on the picture");
        }
    }

  private:
    static bool isMetadata(const Element& element) {
        return named(element, "asset") || named(element, "extra");
    }

    void ignore(const Element& element, const std::string& why) {
        context_.report.ignore(fmt::format("<{}>", element.Name()), why);
    }

    /// What a node cannot show costs that node, or that child of it, and no more.
    void visitNode(const Element& node, const glm::dmat4& parentToWorld) {
        try {
            showNode(node, parentToWorld);
        } catch (const SceneError& error) {
            if (hasTooMany_) throw;
            context_.report.replace(error, build::Shortfall::Node);
        }
    }

    void showNode(const Element& node, const glm::dmat4& parentToWorld) {
        const Document& document = context_.document;
        if (std::find(path_.begin(), path_.end(), &node) != path_.end())
            document.fail(node, fmt::format("'{}' contains itself through <instance_node>",
                                            displayName(node)));
        if (path_.size() >= kDeepestNode)
            document.fail(node, fmt::format("nodes are nested more than {} deep", kDeepestNode));
        hasTooMany_ = ++visited_ > document.elementCount() + kMostRepeatedNodes;
        if (hasTooMany_)
            document.fail(node, fmt::format("<instance_node> repeats more than {} nodes",
                                            kMostRepeatedNodes));
        const glm::dmat4 toWorld = parentToWorld * nodeTransform(document, node);
        if (!build::isFinite(toWorld)) document.fail(node, "its transformation overflows");
        path_.push_back(&node);
        for (const Element& child : children(node)) {
            try {
                visitChild(node, child, toWorld);
            } catch (const SceneError& error) {
                if (hasTooMany_) throw;
                context_.report.replace(error, shortfallOf(child));
            }
        }
        path_.pop_back();
    }

    /// What is said of a child that cannot be shown.
    static build::Shortfall shortfallOf(const Element& child) {
        const std::string_view kind = child.Name();
        return kind == "instance_geometry" || kind == "instance_controller"
                   ? build::Shortfall::Geometry
                   : build::Shortfall::Node;
    }

    void visitChild(const Element& node, const Element& child, const glm::dmat4& toWorld) {
        const Document& document = context_.document;
        const std::string_view kind = child.Name();
        if (kind == "node") {
            visitNode(child, toWorld);
        } else if (kind == "instance_node") {
            visitNode(document.resolve(child, "url", "node"), toWorld);
        } else if (kind == "instance_geometry") {
            placeGeometry(node, child, document.resolve(child, "url", "geometry"), toWorld);
        } else if (kind == "instance_controller") {
            const RestPose pose = controllers_.restPose(child, toWorld);
            if (pose.geometry) placeGeometry(node, child, *pose.geometry, pose.toWorld);
        } else if (kind == "instance_light") {
            if (const Element* light = document.resolveOr(child, "url", "light", kNoLight))
                placeLight(context_, *light, toWorld);
        } else if (kind == "instance_camera") {
            if (const Element* camera = document.resolveOr(child, "url", "camera", kNoCamera))
                placeCamera(context_, *camera, toWorld);
        } else if (!isTransform(child) && !isMetadata(child)) {
            ignore(child, "has no effect on the picture");
        }
    }

    /// `instance` binds the materials.
    void placeGeometry(const Element& node, const Element& instance, const Element& element,
                       const glm::dmat4& toWorld) {
        Geometry& geometry = read(element);
        const BoundMaterials bound(context_, materials_, instance);
        std::vector<uint32_t> materials;
        std::vector<TexcoordInputs> texcoords;
        if (geometry.sphereRadius) materials.push_back(bound.first());
        for (const Primitive& primitive : geometry.primitives) {
            const PartMaterial part = bound.of(primitive);
            materials.push_back(part.number);
            texcoords.push_back(part.texcoords);
        }
        context_.builder.place(context_.document.place(instance),
                               shapeOf(element, geometry, texcoords), toWorld, materials,
                               displayName(node));
    }

    Geometry& read(const Element& element) {
        const auto found = geometries_.find(&element);
        if (found != geometries_.end()) return found->second;
        Geometry geometry;
        geometry.sphereRadius = readCglSphere(context_, element);
        for (const Element& child : children(element)) {
            const bool isMesh = named(child, "mesh");
            if (isMesh && geometry.sphereRadius)
                ignore(child, "the geometry's <sphere> takes its place");
            else if (isMesh)
                geometry.mesh = &child;
            else if (!isMetadata(child))
                ignore(child, "only <mesh> and spheres are rendered");
        }
        if (geometry.mesh) geometry.primitives = primitivesOf(*geometry.mesh);
        return geometries_.emplace(&element, std::move(geometry)).first->second;
    }

    build::ShapeId shapeOf(const Element& element, Geometry& geometry,
                           const std::vector<TexcoordInputs>& texcoords) {
        const auto found = geometry.shapes.find(texcoords);
        if (found != geometry.shapes.end()) return found->second;
        const build::ShapeId shape = makeShape(displayName(element), geometry, texcoords);
        return geometry.shapes.emplace(texcoords, shape).first->second;
    }

    build::ShapeId makeShape(const std::string& name, const Geometry& geometry,
                             const std::vector<TexcoordInputs>& texcoords) {
        if (geometry.sphereRadius) return context_.builder.addSphere(name, *geometry.sphereRadius);
        build::Mesh mesh;
        if (geometry.mesh) mesh = MeshReader(context_).read(*geometry.mesh, texcoords);
        return context_.builder.addMesh(name, std::move(mesh));
    }

    Context& context_;
    Materials materials_;
    glm::dmat4 fileToWorld_;
    Controllers controllers_;
    std::unordered_map<const Element*, Geometry> geometries_;
    std::vector<const Element*> path_; ///< the nodes from the root to the one being visited
    size_t visited_ = 0;
    bool hasTooMany_ = false; ///< nodes to go on with: an error ends the walk
};

/// Counts the contents of libraries nothing here reads, and what <scene> shows besides.
void reportUnread(Context& context) {
    for (const Element& library : children(context.document.root())) {
        const std::string_view kind = library.Name();
        if (kind == "scene") {
            for (const Element& instance : children(library))
                if (!named(instance, "instance_visual_scene") && !named(instance, "extra"))
                    context.report.ignore(fmt::format("<{}>", instance.Name()),
                                          "has no effect on the picture");
            continue;
        }
        const bool isRead = kind == "asset" || kind == "extra" || kind == "library_cameras" ||
                            kind == "library_lights" || kind == "library_effects" ||
                            kind == "library_materials" || kind == "library_geometries" ||
                            kind == "library_controllers" || kind == "library_nodes" ||
                            kind == "library_visual_scenes" ||
                            (kind == "library_images" && context.conventions.textures);
        if (isRead) continue;
        for (const Element& element : children(library))
            if (!named(element, "asset") && !named(element, "extra"))
                context.report.ignore(fmt::format("<{}>", element.Name()), "not supported");
    }
}

/// The first <visual_scene> of the document; null if it has none.
const Element* firstVisualScene(const Document& document) {
    for (const Element& library : children(document.root()))
        if (named(library, "library_visual_scenes"))
            if (const Element* scene = library.FirstChildElement("visual_scene")) return scene;
    return nullptr;
}

/// The <visual_scene> that the document's <scene> names; where it names none, the first.
const Element& shownScene(const Document& document) {
    const Element* scene = document.root().FirstChildElement("scene");
    const Element* instance = scene ? scene->FirstChildElement("instance_visual_scene") : nullptr;
    const Element* first = firstVisualScene(document);
    if (instance || !first)
        return document.resolve(
            document.require(document.require(document.root(), "scene"), "instance_visual_scene"),
            "url", "visual_scene");
    document.forgive(scene ? *scene : document.root(),
                     "no <instance_visual_scene> says what is shown",
                     "the first <visual_scene> is");
    return *first;
}

} // namespace

void readVisualScene(Context& context) {
    SceneWalk(context).run(shownScene(context.document));
    reportUnread(context);
}

} // namespace stromboli::collada
