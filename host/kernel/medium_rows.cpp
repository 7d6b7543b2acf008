#include "host/kernel/medium_rows.hpp"

#include "shaders/shared/bsdf_types.h"
#include "shaders/shared/medium_types.h"
#include "shaders/shared/texture_types.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stromboli {
namespace {

float largestOf(const glm::vec3& v) {
    return std::max({v.x, v.y, v.z});
}

bool isRayleigh(const PhaseLobe& lobe) {
    return lobe.phase == PhaseFunction::Rayleigh;
}

/// Of one of the functions of a sum, as the kernel reads it.
float asymmetryOf(const PhaseLobe& lobe) {
    return isRayleigh(lobe) ? gpu::RAYLEIGH_ASYMMETRY : lobe.asymmetry;
}

gpu::PhaseMixture mixtureOf(const Medium& m) {
    std::vector<PhaseLobe> lobes = m.phases();
    lobes.resize(kMostPhases);
    return {asymmetryOf(lobes[1]), lobes[1].share, asymmetryOf(lobes[2]), lobes[2].share};
}

uint32_t closuresOf(const Medium& m) {
    if (!m.scatters()) return 0;
    return gpu::PHASE_FUNCTION |
           (m.isUnderSurface ? gpu::LOBE_DELTA_REFLECTION : gpu::LOBE_DIFFUSE_REFLECTION) |
           (std::ranges::any_of(m.phases(), isRayleigh) ? gpu::PHASE_IS_RAYLEIGH : 0);
}

uint32_t kindsOf(const Medium& m) {
    return gpu::MEDIA_DIM | (m.scatters() ? gpu::MEDIA_SCATTER : 0) |
           (m.emits() ? gpu::MEDIA_SHINE : 0) | (m.varies() ? gpu::MEDIA_VARY : 0) |
           (m.scatters() && !m.otherPhases.empty() ? gpu::MEDIA_MIX : 0) |
           (m.colors.extinction ? gpu::MEDIA_VARY_EXTINCTION : 0) |
           (m.colors.scattering && m.scatters() ? gpu::MEDIA_VARY_SCATTERING : 0) |
           (m.colors.source && m.emits() ? gpu::MEDIA_VARY_SOURCE : 0) |
           (m.colors.glow && m.emits() ? gpu::MEDIA_GLOW : 0) |
           (m.scatters() && m.isUnderSurface ? gpu::MEDIA_UNDER_SURFACE : 0);
}

glm::vec3 albedoOf(const Medium& m) {
    const glm::vec3 extinction = m.extinction();
    glm::vec3 albedo(0);
    for (int c = 0; c < 3; ++c)
        if (extinction[c] > 0) albedo[c] = m.scattering[c] / extinction[c];
    return albedo;
}

/// A value with its neighbours, so that the kernel interpolates with two rows of eight values.
gpu::GridValue valueAt(const DensityGrid& g, glm::uvec3 at) {
    const uint32_t x = std::min(at.x + 1, g.size.x - 1), y = std::min(at.y + 1, g.size.y - 1);
    const auto value = [&](uint32_t i, uint32_t j) {
        return g.values[i + g.size.x * (j + size_t(g.size.y) * at.z)];
    };
    return {{value(at.x, at.y), value(x, at.y), value(at.x, y), value(x, y)}};
}

/// Rows of colours, a cell each.
void appendColors(std::vector<Row>& rows, const std::vector<glm::vec3>& colors) {
    rows.reserve(rows.size() + colors.size());
    for (const glm::vec3& color : colors)
        appendRows(rows, glm::vec4(color, 0));
}

/// Returns the row of the header.
uint32_t appendColorGrid(std::vector<Row>& rows, const ColorGrid& g) {
    const auto header = uint32_t(rows.size());
    appendRows(rows,
               gpu::ColorGridHeader{glm::vec4(g.toUnit[0]), glm::vec4(g.toUnit[1]),
                                    glm::vec4(g.toUnit[2]), g.size.x, g.size.y, g.size.z,
                                    uint32_t(header + sizeof(gpu::ColorGridHeader) / sizeof(Row))});
    appendColors(rows, g.values);
    return header;
}

uint32_t appendGlow(std::vector<Row>& rows, const GlowTable& t) {
    const auto header = uint32_t(rows.size());
    const double first = 1 / double(t.coldest), last = double(t.values.size()) - 1;
    appendRows(rows, gpu::GlowHeader{t.coldest, float(first),
                                     float(last / (1 / double(t.hottest) - first)),
                                     uint32_t(header + sizeof(gpu::GlowHeader) / sizeof(Row)),
                                     float(last), 0, 0, 0});
    for (const glm::vec4& value : t.values)
        appendRows(rows, value);
    return header;
}

gpu::MediumTints appendTints(std::vector<Row>& rows, const Medium& m) {
    gpu::MediumTints tints{};
    const MediumColors& c = m.colors;
    if (c.scattering && m.scatters()) tints.scattering = appendColorGrid(rows, *c.scattering);
    if (c.source && m.emits()) tints.source = appendColorGrid(rows, *c.source);
    if (c.glow && m.emits()) tints.glow = appendGlow(rows, *c.glow);
    tints.kinds = (c.extinction ? gpu::TINT_EXTINCTION : 0) |
                  (c.scatteringIsFactor ? gpu::TINT_SCATTERING_IS_FACTOR : 0);
    return tints;
}

/// colors: the medium's extinction by channel, where it is of several. Returns the row of the
/// header.
uint32_t appendGrid(std::vector<Row>& rows, const DensityGrid& g,
                    const std::optional<ColorGrid>& colors) {
    const DensityBounds bounds = boundDensity(g);
    const auto header = uint32_t(rows.size());
    const auto values = header + uint32_t(sizeof(gpu::GridHeader) / sizeof(Row));
    const size_t count = g.values.size();
    appendRows(rows, gpu::GridHeader{glm::vec4(g.toUnit[0]), glm::vec4(g.toUnit[1]),
                                     glm::vec4(g.toUnit[2]), g.size.x, g.size.y, g.size.z, values,
                                     bounds.blocks.x, bounds.blocks.y, bounds.blocks.z,
                                     uint32_t(values + count)});
    rows.reserve(rows.size() + count);
    glm::uvec3 at;
    if (colors) appendColors(rows, colors->values);
    for (at.z = 0; at.z < g.size.z && !colors; ++at.z)
        for (at.y = 0; at.y < g.size.y; ++at.y)
            for (at.x = 0; at.x < g.size.x; ++at.x)
                appendRows(rows, valueAt(g, at));
    for (size_t i = 0; i < bounds.most.size(); i += 4) {
        glm::vec4 four(0);
        for (size_t k = 0; k < std::min<size_t>(4, bounds.most.size() - i); ++k)
            four[glm::length_t(k)] = bounds.most[i + k];
        appendRows(rows, four);
    }
    return header;
}

} // namespace

/// A block has the values whose interpolation reaches into it, and one more on either side for the
/// rounding of places.
DensityBounds boundDensity(const DensityGrid& g) {
    DensityBounds bounds;
    bounds.blocks = glm::min(g.size, glm::uvec3(gpu::MOST_BLOCKS));
    const auto first = [&](int axis, uint32_t block) {
        const double from = double(block) / bounds.blocks[axis] * g.size[axis] - 0.5;
        return uint32_t(std::max(std::floor(from) - 1, 0.0));
    };
    const auto last = [&](int axis, uint32_t block) {
        const double to = double(block + 1) / bounds.blocks[axis] * g.size[axis] - 0.5;
        return uint32_t(std::min(std::ceil(to) + 1, g.size[axis] - 1.0));
    };
    glm::uvec3 block;
    for (block.z = 0; block.z < bounds.blocks.z; ++block.z)
        for (block.y = 0; block.y < bounds.blocks.y; ++block.y)
            for (block.x = 0; block.x < bounds.blocks.x; ++block.x) {
                float most = 0;
                for (uint32_t z = first(2, block.z); z <= last(2, block.z); ++z)
                    for (uint32_t y = first(1, block.y); y <= last(1, block.y); ++y)
                        for (uint32_t x = first(0, block.x); x <= last(0, block.x); ++x)
                            most =
                                std::max(most, g.values[x + g.size.x * (y + size_t(g.size.y) * z)]);
                bounds.most.push_back(most);
            }
    return bounds;
}

MediumRows appendMedia(std::vector<Row>& rows, std::span<const Medium> media, bool hasDetails) {
    MediumRows packed;
    for (const Medium& m : media) {
        const uint32_t closures = closuresOf(m);
        const size_t first = rows.size();
        packed.firstRow.push_back(uint32_t(first));
        packed.kinds |= kindsOf(m);
        if (closures != 0) packed.closures.push_back(closures);
        appendRows(rows, gpu::MaterialHeader{glm::vec3(0), closures});
        appendRows(rows, gpu::MediumBody{m.extinction(), asymmetryOf(m.phases().front()),
                                         albedoOf(m), 0, m.emission, largestOf(m.extinction())});
        appendRows(rows, mixtureOf(m));
        rows.resize(first + gpu::MATERIAL_DETAIL_ROW);
        if (hasDetails) appendRows(rows, gpu::MaterialDetail{1, 0, 0, 0});
    }
    for (size_t i = 0; i < media.size(); ++i) {
        const Medium& m = media[i];
        if (!m.varies()) continue;
        const uint32_t grid = appendGrid(rows, m.bound(), m.colors.extinction);
        rows[packed.firstRow[i] + gpu::MEDIUM_BODY_ROW + 1][3] = grid;
        const gpu::MediumTints tints = appendTints(rows, m);
        rows[packed.firstRow[i] + gpu::MEDIUM_TINTS_ROW] = std::bit_cast<Row>(tints);
    }
    return packed;
}

void appendFoci(std::vector<Row>& rows, std::span<const Medium> media,
                std::span<const uint32_t> mediumRow, const LightFoci& foci) {
    if (foci.near.empty()) return;
    const auto first = uint32_t(rows.size());
    for (const LightFocus& f : foci.near)
        appendRows(rows, gpu::LightFocus{glm::vec3(f.point), float(f.radius), float(f.intensity),
                                         float(f.radiance), 0, 0});
    for (size_t i = 0; i < media.size(); ++i)
        if (!media[i].varies() && !media[i].isUnderSurface)
            rows[mediumRow[i] + gpu::MEDIUM_FOCI_ROW] =
                std::bit_cast<Row>(gpu::MediumFoci{first, float(foci.others), 0, 0});
}

void nameBorders(std::vector<Row>& rows, std::span<const Material> materials,
                 std::span<const uint32_t> materialRow, std::span<const uint32_t> mediumRow) {
    const auto rowOf = [&](uint32_t medium) {
        return medium == kNoMedium ? gpu::NO_MEDIUM : mediumRow[medium];
    };
    const uint32_t rowsOfMedium = mediumRow.size() > 1 ? mediumRow[1] - mediumRow[0] : 0;
    for (size_t i = 0; i < materials.size(); ++i) {
        const Material& m = materials[i];
        gpu::MediumBorder border{rowOf(m.inside), rowOf(m.outside), 0, 0};
        if (m.boundsMedia) border.isBorder = gpu::BORDER_OF_MEDIA;
        if (m.boundsMedia && m.outsideIsOpen) {
            border.isBorder = gpu::BORDER_OF_VOLUME;
            border.volume = (m.inside + 1) | rowsOfMedium << 8;
        }
        rows[materialRow[i] - gpu::MEDIUM_BORDER_ROWS] = std::bit_cast<Row>(border);
    }
}

} // namespace stromboli
