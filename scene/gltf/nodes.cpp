#include "scene/gltf/nodes.hpp"

#include "host/core/error.hpp"
#include "scene/build/vectors.hpp"
#include "scene/gltf/cameras.hpp"
#include "scene/gltf/lights.hpp"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <numeric>

namespace stromboli::gltf {
namespace {

glm::dmat4 composed(const glm::dvec3& translation, const glm::dquat& rotation,
                    const glm::dvec3& scale) {
    return glm::translate(glm::dmat4(1), translation) * glm::mat4_cast(rotation) *
           glm::scale(glm::dmat4(1), scale);
}

/// Files round quaternions; they stand for unit ones.
glm::dquat unitRotation(const Element& at, const glm::dquat& q) {
    const double length = glm::length(q);
    if (length > 0) return q / length;
    at.forgive(build::Shortfall::Word, "rotation", "has no direction");
    return {1, 0, 0, 0};
}

/// KHR_node_visibility.
bool isHidden(const Element& node) {
    const std::optional<Element> visibility = node.extension("KHR_node_visibility");
    return visibility && !visibility->flag("visible", true);
}

} // namespace

Nodes::Nodes(Context& context)
    : context_(context), document_(context.document), meshes_(context),
      animated_(animatedNodes(context)) {
    readNodes();
    findParents();
    findTransforms();
}

void Nodes::readNodes() {
    const size_t count = document_.size("nodes");
    nodes_.resize(count);
    children_.resize(count);
    for (size_t node = 0; node < count; ++node)
        placeOrLeaveOut(build::Shortfall::Node, [&] {
            nodes_[node] = document_.at("nodes", node);
            children_[node] = nodes_[node]->indicesOr("children", count);
        });
}

void Nodes::findParents() {
    constexpr size_t none = size_t(-1);
    std::vector<size_t> parents(nodes_.size(), none);
    for (size_t node = 0; node < parents.size(); ++node)
        std::erase_if(children_[node], [&](size_t child) {
            if (parents[child] == none) {
                parents[child] = node;
                return false;
            }
            document_.root().forgive(
                build::Shortfall::Reference, fmt::format("nodes[{}]", child),
                fmt::format("is a child of nodes[{}] and of nodes[{}], expected one parent",
                            parents[child], node));
            return true;
        });
    for (size_t node = 0; node < parents.size(); ++node)
        if (parents[node] == none) roots_.push_back(node);
}

/// From the roots on, without recursion: a file can nest nodes as deep as it likes.
void Nodes::findTransforms() {
    toWorld_.assign(nodes_.size(), glm::dmat4(1));
    moves_.assign(toWorld_.size(), false);
    std::vector<bool> reached(toWorld_.size(), false);
    std::vector<size_t> open = roots_;
    for (const size_t root : roots_)
        toWorld_[root] = localTransform(root);
    while (!open.empty()) {
        const size_t node = open.back();
        open.pop_back();
        reached[node] = true;
        if (const auto found = animated_.find(node); found != animated_.end())
            moves_[node] = moves_[node] || found->second.isPosed();
        for (const size_t child : children_[node]) {
            toWorld_[child] = toWorld_[node] * localTransform(child);
            moves_[child] = moves_[node];
            open.push_back(child);
        }
    }
    // Each node has at most one parent: what no root reaches is on a circle, or hangs on one.
    for (size_t node = 0; node < reached.size(); ++node)
        if (!reached[node]) {
            document_.root().forgive(build::Shortfall::Node, fmt::format("nodes[{}]", node),
                                     "is on a circle of parents and children");
            nodes_[node].reset();
            children_[node].clear();
        }
}

glm::dmat4 Nodes::localTransform(size_t index) const {
    if (!nodes_[index]) return glm::dmat4(1);
    const Element& node = *nodes_[index];
    const auto found = animated_.find(index);
    const AnimatedNode pose = found == animated_.end() ? AnimatedNode{} : found->second;
    const std::vector<double> m = node.numbersOr("matrix", 16);
    if (!m.empty() && !pose.isPosed()) {
        glm::dmat4 matrix;
        for (int i = 0; i < 16; ++i)
            matrix[i / 4][i % 4] = m[size_t(i)];
        return matrix;
    }
    const std::vector<double> q = node.numbersOr("rotation", 4);
    const glm::dquat stated =
        q.empty() ? glm::dquat(1, 0, 0, 0) : glm::dquat(q[3], q[0], q[1], q[2]);
    return composed(pose.translation.value_or(node.vector("translation", glm::dvec3(0))),
                    unitRotation(node, pose.rotation.value_or(stated)),
                    pose.scale.value_or(node.vector("scale", glm::dvec3(1))));
}

std::vector<size_t> Nodes::rootsOfScene() const {
    const size_t count = document_.size("scenes");
    const std::optional<uint32_t> asked = context_.selection().scene;
    if (asked && *asked >= count)
        document_.root().fail(fmt::format("has no scene {}: there are {}, from 0", *asked, count));
    if (count == 0) {
        context_.report().assume("the file has no scene: all of its nodes are shown");
        return roots_;
    }
    const std::optional<size_t> stated = document_.root().index("scene", count);
    if (count > 1) context_.report().ignore("scenes", "one is shown (--scene N)", count - 1);
    const std::vector<Element> scenes = document_.root().items("scenes");
    if (scenes.size() != count) return roots_; // which has been said
    size_t scene = asked ? *asked : stated.value_or(0);
    // Where the file leaves it open, an empty scene is not what is meant.
    if (!asked && !stated)
        while (scene + 1 < count && scenes[scene].size("nodes") == 0)
            ++scene;
    return scenes[scene].indicesOr("nodes", nodes_.size());
}

void Nodes::place() {
    std::vector<size_t> open = rootsOfScene();
    std::vector<bool> placed(toWorld_.size(), false);
    std::reverse(open.begin(), open.end());
    while (!open.empty()) {
        const size_t node = open.back();
        open.pop_back();
        if (placed[node]) continue; // a scene may name a node and its parent
        placed[node] = true;
        if (!nodes_[node] || isHidden(*nodes_[node])) continue; // and so is what hangs on it
        placeNode(node);
        open.insert(open.end(), children_[node].rbegin(), children_[node].rend());
    }
}

template <class Place>
void Nodes::placeOrLeaveOut(build::Shortfall kind, Place&& place) {
    try {
        place();
    } catch (const SceneError& error) {
        context_.report().replace(error, kind);
    }
}

void Nodes::placeNode(size_t index) {
    const Element& node = *nodes_[index];
    // One mesh never costs the scene, nor does a camera or a light.
    placeOrLeaveOut(build::Shortfall::Geometry, [&] { placeMesh(node, index); });
    placeOrLeaveOut(build::Shortfall::Node, [&] {
        if (const auto camera = document_.follow(node, "camera", "cameras")) {
            const std::string name = node.has("name") ? node.displayName() : camera->displayName();
            placeCamera(context_, *camera, name, toWorld_[index]);
        }
    });
    placeOrLeaveOut(build::Shortfall::Node, [&] { placeLightOf(node, index); });
}

void Nodes::placeLightOf(const Element& node, size_t index) {
    const auto used = node.extension("KHR_lights_punctual");
    if (!used) return;
    const auto stated = document_.root().extension("KHR_lights_punctual");
    const Element which = used->strictly();
    const std::optional<size_t> light = which.index("light", stated ? stated->size("lights") : 0);
    if (!light) which.fail("has no 'light'");
    const Element at = stated->item("lights", *light);
    placeLight(context_, at, node.has("name") ? node.displayName() : at.displayName(),
               toWorld_[index]);
    if (moves_[index]) context_.builder.markMovingLights();
}

void Nodes::placeMesh(const Element& node, size_t index) {
    const std::optional<size_t> mesh = node.index("mesh", document_.size("meshes"));
    if (!mesh) return;
    Deformation deformation;
    const auto found = animated_.find(index);
    deformation.weights = found != animated_.end() && !found->second.weights.empty()
                              ? found->second.weights
                              : node.numbersOr("weights", 0);
    placeOrLeaveOut(build::Shortfall::Attribute, [&] { deformation.joints = jointsOf(node); });
    const std::optional<BuiltMesh> built = meshes_.get(*mesh, deformation);
    if (!built) return;
    // The joints of a skin lead to the world by themselves.
    const bool hasSkin = !deformation.joints.empty();
    const glm::dmat4 toWorld = hasSkin ? glm::dmat4(1) : toWorld_[index];
    const bool moves = isMoved(node, index, hasSkin);
    std::vector<glm::dmat4> places = {toWorld};
    placeOrLeaveOut(build::Shortfall::Attribute, [&] { places = placesOf(node, toWorld); });
    for (const glm::dmat4& place : places) {
        context_.builder.place(node.place(), built->shape, place, built->materials,
                               node.displayName());
        if (moves) context_.builder.markMoving();
    }
}

/// The joints of a skin lead to the world whatever its node does.
bool Nodes::isMoved(const Element& node, size_t index, bool hasSkin) const {
    const auto found = animated_.find(index);
    if (found != animated_.end() && !found->second.weights.empty()) return true;
    if (!hasSkin) return moves_[index];
    const std::vector<size_t> joints =
        document_.follow(node, "skin", "skins")->indices("joints", nodes_.size());
    return std::ranges::any_of(joints, [&](size_t joint) { return moves_[joint]; });
}

/// One place, or those of EXT_mesh_gpu_instancing.
std::vector<glm::dmat4> Nodes::placesOf(const Element& node, const glm::dmat4& toWorld) const {
    const auto extension = node.extension("EXT_mesh_gpu_instancing");
    const auto attributes = extension ? extension->child("attributes") : std::nullopt;
    return attributes ? readPlaces(attributes->strictly(), toWorld) : std::vector{toWorld};
}

std::vector<glm::dmat4> Nodes::readPlaces(const Element& attributes,
                                          const glm::dmat4& toWorld) const {
    std::optional<size_t> count;
    const auto read = [&](const char* name, size_t width) -> std::optional<Values> {
        const auto accessor = attributes.index(name, document_.size("accessors"));
        if (!accessor) return std::nullopt;
        Values values = readValues(document_, *accessor, width);
        if (count && values.count != *count)
            attributes.fail(
                name, fmt::format("has {} elements, another attribute {}", values.count, *count));
        count = values.count;
        return values;
    };
    for (const std::string& name : attributes.names())
        if (name.starts_with('_'))
            context_.report().ignore(fmt::format("attribute '{}' of instances", name),
                                     "instances differ by their places alone");
    const std::optional<Values> translations = read("TRANSLATION", 3),
                                rotations = read("ROTATION", 4), scales = read("SCALE", 3);
    std::vector<glm::dmat4> places;
    for (size_t i = 0; i < count.value_or(0); ++i) {
        const glm::dvec4 q = rotations ? rotations->vec4(i) : glm::dvec4(0, 0, 0, 1);
        places.push_back(toWorld *
                         composed(translations ? translations->vec3(i) : glm::dvec3(0),
                                  unitRotation(attributes, glm::dquat(q.w, q.x, q.y, q.z)),
                                  scales ? scales->vec3(i) : glm::dvec3(1)));
    }
    return places;
}

/// From the mesh's space to the world, for each joint of the node's skin.
std::vector<glm::dmat4> Nodes::jointsOf(const Element& node) const {
    const auto skin = document_.follow(node, "skin", "skins");
    if (!skin) return {};
    std::vector<glm::dmat4> matrices;
    for (const size_t joint : skin->indices("joints", document_.size("nodes")))
        matrices.push_back(toWorld_[joint]);
    const auto accessor = skin->index("inverseBindMatrices", document_.size("accessors"));
    if (!accessor) return matrices;
    const Values inverses = readValues(document_, *accessor, 16);
    if (inverses.count < matrices.size())
        skin->fail("inverseBindMatrices",
                   fmt::format("has {} matrices for {} joints", inverses.count, matrices.size()));
    for (size_t joint = 0; joint < matrices.size(); ++joint) {
        glm::dmat4 inverse;
        for (int i = 0; i < 16; ++i)
            inverse[i / 4][i % 4] = inverses.at(joint)[i];
        matrices[joint] *= inverse;
    }
    return matrices;
}

} // namespace stromboli::gltf
