#pragma once

#include "scene/build/mesh.hpp"
#include "scene/collada/context.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace stromboli::collada {

/// The inputs of a primitive whose texture coordinates are the two of its corners (null: none).
using TexcoordInputs = std::array<const Element*, 2>;

/// What the corners of a mesh have beside position and normal: texture coordinates and colour. Each
/// combination that a primitive has is there once.
class CornerAttributes {
  public:
    /// `attributes`, which must outlive this, gets them.
    CornerAttributes(Context& context, std::vector<VertexAttributes>& attributes)
        : context_(context), attributes_(attributes) {}

    /// Begins a primitive; `vertexOffset` is where corners have the index of inputs of <vertices>.
    /// `color` is null where it has none. Throws SceneError for sources that make no sense.
    void begin(const TexcoordInputs& texcoords, const Element* color, uint32_t vertexOffset);

    /// The number of a corner's attributes by its indices, of which <p> holds one for each offset;
    /// kNoAttributes where the primitive has none. Throws SceneError, at `p`, for indices out of
    /// range.
    uint32_t of(const uint32_t* indices, const Element& p);

  private:
    using Texcoords = std::vector<glm::dvec2>;
    using Colors = std::vector<glm::dvec3>;
    template <typename Values>
    struct Channel {
        const Values* values = nullptr; ///< null: the primitive has none
        uint32_t offset = 0;
    };

    template <int size, typename Values>
    Channel<Values> channel(const Element* input, uint32_t vertexOffset,
                            std::map<const Element*, Values>& read) const;
    VertexAttributes combine(const std::array<uint32_t, 3>& indices);
    float finite(double value);

    Context& context_;
    std::vector<VertexAttributes>& attributes_;
    std::map<const Element*, Texcoords> texcoordSources_;
    std::map<const Element*, Colors> colorSources_;
    std::array<Channel<Texcoords>, 2> texcoords_;
    Channel<Colors> colors_;
    std::map<std::array<uint32_t, 3>, uint32_t> known_; ///< by indices, of this primitive
};

} // namespace stromboli::collada
