#include "scene/collada/corner_attributes.hpp"

#include "scene/collada/numbers.hpp"
#include "scene/collada/sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::collada {

template <int size, typename Values>
CornerAttributes::Channel<Values>
CornerAttributes::channel(const Element* input, uint32_t vertexOffset,
                          std::map<const Element*, Values>& read) const {
    if (!input) return {};
    const Document& document = context_.document;
    const Element& source = document.resolve(*input, "source", "source");
    const auto [found, isNew] = read.try_emplace(&source);
    // Exporters write NaN here too; combine() says so.
    if (isNew) found->second = readVectors<size>(document, source, NonFinite::Allow);
    return {&found->second, readCountOr(document, *input, "offset", vertexOffset)};
}

void CornerAttributes::begin(const TexcoordInputs& texcoords, const Element* color,
                             uint32_t vertexOffset) {
    known_.clear();
    for (size_t i = 0; i < 2; ++i)
        texcoords_[i] = channel<2>(texcoords[i], vertexOffset, texcoordSources_);
    colors_ = channel<3>(color, vertexOffset, colorSources_);
}

uint32_t CornerAttributes::of(const uint32_t* indices, const Element& p) {
    if (!texcoords_[0].values && !texcoords_[1].values && !colors_.values) return kNoAttributes;
    const auto check = [&](const auto& channel, const char* what) -> uint32_t {
        if (!channel.values) return 0;
        const uint32_t index = indices[channel.offset];
        if (index >= channel.values->size())
            context_.document.fail(p, fmt::format("{} index {} is out of range: there are {}", what,
                                                  index, channel.values->size()));
        return index;
    };
    const std::array<uint32_t, 3> key = {check(texcoords_[0], "texture coordinate"),
                                         check(texcoords_[1], "texture coordinate"),
                                         check(colors_, "colour")};
    const auto [found, isNew] = known_.try_emplace(key, uint32_t(attributes_.size()));
    if (isNew) attributes_.push_back(combine(key));
    return found->second;
}

float CornerAttributes::finite(double value) {
    const auto rounded = float(value);
    if (std::isfinite(rounded)) return rounded;
    context_.report.warn("texture coordinates or colours that are not finite become 0");
    return 0;
}

VertexAttributes CornerAttributes::combine(const std::array<uint32_t, 3>& indices) {
    VertexAttributes attributes;
    for (size_t i = 0; i < 2; ++i) {
        if (!texcoords_[i].values) continue;
        const glm::dvec2 st = (*texcoords_[i].values)[indices[i]];
        // COLLADA counts t from the picture's lower edge, the scene v from its upper one.
        attributes.uv[i] = {finite(st.x), finite(1 - st.y)};
    }
    if (colors_.values)
        for (int k = 0; k < 3; ++k)
            attributes.color[k] = std::max(finite((*colors_.values)[indices[2]][k]), 0.0f);
    return attributes;
}

} // namespace stromboli::collada
