#include "scene/collada/controllers.hpp"

#include "scene/build/vectors.hpp"
#include "scene/collada/numbers.hpp"
#include "scene/collada/transforms.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace stromboli::collada {
namespace {

/// A skin may be that of a morphed mesh, and the other way round; so many that follow one another
/// are a circle.
constexpr int kMostInARow = 100;

/// The source of an input of <joints>; null where there is none.
const Element* jointSource(const Document& document, const Element& skin,
                           std::string_view semantic) {
    const Element* joints = skin.FirstChildElement("joints");
    if (!joints) return nullptr;
    for (const Element& input : children(*joints)) {
        const char* own = input.Attribute("semantic");
        if (named(input, "input") && own && semantic == own)
            return &document.resolve(input, "source", "source");
    }
    return nullptr;
}

JointName firstJoint(const Document& document, const Element& skin) {
    const Element* source = jointSource(document, skin, "JOINT");
    if (!source) return {};
    const Element* ids = source->FirstChildElement("IDREF_array");
    const Element* names = ids ? ids : source->FirstChildElement("Name_array");
    if (!names) return {};
    return {firstWord(*names), ids != nullptr};
}

std::optional<glm::dmat4> firstInverseBindMatrix(const Document& document, const Element& skin) {
    const Element* source = jointSource(document, skin, "INV_BIND_MATRIX");
    const Element* array = source ? source->FirstChildElement("float_array") : nullptr;
    if (!array) return std::nullopt;
    const std::vector<double> numbers = readNumbers(document, *array);
    if (numbers.size() < 16) return std::nullopt;
    return matrixOfRows(numbers);
}

/// The matrix of a node by those of the nodes that it is in.
glm::dmat4 nodeToFile(const Document& document, const Element& node) {
    glm::dmat4 matrix(1);
    for (const Element* at = &node; at && named(*at, "node");
         at = at->Parent() ? at->Parent()->ToElement() : nullptr)
        matrix = nodeTransform(document, *at) * matrix;
    return matrix;
}

} // namespace

const Element* Controllers::geometryBehind(const Element& form) const {
    const Document& document = context_.document;
    const Element* at = &form;
    for (int steps = 0; steps < kMostInARow; ++steps) {
        const std::string source = document.requireAttribute(*at, "source");
        if (const Element* geometry = document.find("geometry", source)) return geometry;
        const Element& controller = document.resolve(*at, "source", "controller");
        at = controller.FirstChildElement("skin");
        if (!at) at = &document.require(controller, "morph");
    }
    document.fail(form, "contains itself through 'source'");
}

Controllers::Binding Controllers::readBinding(const Element& skin) const {
    const Document& document = context_.document;
    Binding binding;
    if (const Element* shape = skin.FirstChildElement("bind_shape_matrix"))
        binding.shape = matrixOfRows(readNumbers(document, *shape, 16));
    binding.joint = firstJoint(document, skin);
    binding.toJoint = firstInverseBindMatrix(document, skin);
    return binding;
}

const Controllers::Controller& Controllers::read(const Element& element) {
    const auto [found, isNew] = read_.try_emplace(&element);
    Controller& controller = found->second;
    if (!isNew) return controller;
    const Element* skin = element.FirstChildElement("skin");
    controller.form = skin ? skin : element.FirstChildElement("morph");
    if (controller.form) controller.geometry = geometryBehind(*controller.form);
    if (skin) controller.binding = readBinding(*skin);
    return controller;
}

/// Where the shape in which the skin was bound stands now. As long as all joints stand to each
/// other as they did then, the first one tells the place of all.
glm::dmat4 Controllers::boundToWorld(const Controller& controller, const Element& instance,
                                     const glm::dmat4& nodeToWorld) {
    const Document& document = context_.document;
    const Binding& binding = *controller.binding;
    const Element* joint = joints_.find(binding.joint, instance);
    if (joint && binding.toJoint)
        return fileToWorld_ * nodeToFile(document, *joint) * *binding.toJoint * binding.shape;
    document.forgive(*controller.form,
                     "its first joint, or the inverse bind matrix of it, is not there",
                     "the skin stands where its node does");
    return nodeToWorld * binding.shape;
}

RestPose Controllers::restPose(const Element& instance, const glm::dmat4& nodeToWorld) {
    const Document& document = context_.document;
    const Element& element = document.resolve(instance, "url", "controller");
    const Controller& controller = read(element);
    if (!controller.form) {
        document.forgive(element, "has neither <skin> nor <morph>",
                         "nothing is shown in the controller's place");
        return {};
    }
    context_.report.ignore(fmt::format("<{}>", controller.form->Name()), "its rest pose is shown");
    RestPose pose{controller.geometry, nodeToWorld};
    if (controller.binding) pose.toWorld = boundToWorld(controller, instance, nodeToWorld);
    if (!build::isFinite(pose.toWorld)) document.fail(instance, "its transformation overflows");
    return pose;
}

} // namespace stromboli::collada
