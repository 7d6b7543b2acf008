#include "scene/collada/joints.hpp"

#include <algorithm>
#include <string_view>

namespace stromboli::collada {

std::string firstWord(const Element& element) {
    const char* text = element.GetText();
    std::string_view word = text ? text : "";
    const char* spaces = " \t\r\n";
    word.remove_prefix(std::min(word.find_first_not_of(spaces), word.size()));
    return std::string(word.substr(0, word.find_first_of(spaces)));
}

/// Numbers the nodes below an element in document order. Recursion is bounded by the parser's limit
/// on nesting.
void Joints::number(const Element& parent) {
    for (const Element& node : children(parent)) {
        if (!named(node, "node")) continue;
        const uint32_t first = count_++;
        if (const char* sid = node.Attribute("sid")) bySid_[sid].push_back(&node);
        number(node);
        numbers_[&node] = {first, count_ - 1};
    }
}

void Joints::numberNodes() {
    if (numbered_) return;
    numbered_ = true;
    for (const Element& library : children(document_.root()))
        if (named(library, "library_visual_scenes"))
            for (const Element& scene : children(library))
                number(scene);
}

const Element* Joints::find(const JointName& joint, const Element& instance) {
    if (joint.isId) return document_.find("node", "#" + joint.name);
    numberNodes();
    const auto found = bySid_.find(joint.name);
    if (found == bySid_.end()) return nullptr;
    const std::vector<const Element*>& nodes = found->second;
    for (const Element& child : children(instance)) {
        const Element* root =
            named(child, "skeleton") ? document_.find("node", firstWord(child)) : nullptr;
        const auto below = root ? numbers_.find(root) : numbers_.end();
        if (below == numbers_.end()) continue;
        const auto node = std::lower_bound(
            nodes.begin(), nodes.end(), below->second.first,
            [&](const Element* a, uint32_t least) { return numbers_.at(a).first < least; });
        if (node != nodes.end() && numbers_.at(*node).first <= below->second.last) return *node;
    }
    return nodes.front();
}

} // namespace stromboli::collada
