#pragma once

#include "scene/collada/document.hpp"

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace stromboli::collada {

/// By what a skin names a joint.
struct JointName {
    std::string name;
    bool isId = false; ///< of the document; otherwise a sid, which need not be the only one
};

/// The nodes of the document's visual scenes by their sids.
class Joints {
  public:
    explicit Joints(const Document& document) : document_(document) {}

    /// The node of that name for an <instance_controller>: below one of the nodes that it gives as
    /// <skeleton>, else anywhere. Null if there is none.
    const Element* find(const JointName& joint, const Element& instance);

  private:
    /// The nodes of a subtree have consecutive numbers.
    struct Numbers {
        uint32_t first = 0, last = 0;
    };

    void numberNodes();
    void number(const Element& parent);

    const Document& document_;
    bool numbered_ = false;
    uint32_t count_ = 0;
    std::unordered_map<const Element*, Numbers> numbers_;
    std::unordered_map<std::string, std::vector<const Element*>> bySid_; ///< numbers ascend
};

/// The first word of the element's text; empty if it has none.
std::string firstWord(const Element& element);

} // namespace stromboli::collada
