#include "scene/ply/vertices.hpp"

#include "scene/build/read_file.hpp"
#include "scene/model/srgb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace stromboli::ply {
namespace {

/// What a property of a vertex says.
enum Role { X, Y, Z, Nx, Ny, Nz, U, V, Red, Green, Blue, Alpha, kRoleCount, None = kRoleCount };

struct RoleName {
    std::string_view name;
    Role role;
};
constexpr RoleName kRoles[] = {{"x", X},
                               {"y", Y},
                               {"z", Z},
                               {"nx", Nx},
                               {"ny", Ny},
                               {"nz", Nz},
                               {"u", U},
                               {"s", U},
                               {"tx", U},
                               {"tu", U},
                               {"texcoord_u", U},
                               {"texture_u", U},
                               {"texture_s", U},
                               {"v", V},
                               {"t", V},
                               {"ty", V},
                               {"tv", V},
                               {"texcoord_v", V},
                               {"texture_v", V},
                               {"texture_t", V},
                               {"red", Red},
                               {"green", Green},
                               {"blue", Blue},
                               {"alpha", Alpha},
                               {"r", Red},
                               {"g", Green},
                               {"b", Blue},
                               {"a", Alpha},
                               {"diffuse_red", Red},
                               {"color_0", Red}, // as Mitsuba names them
                               {"color_1", Green},
                               {"color_2", Blue},
                               {"diffuse_green", Green},
                               {"diffuse_blue", Blue}};

Role roleOf(const Property& property) {
    if (property.countType) return None;
    const std::string name = inSmallLetters(property.name);
    for (const RoleName& row : kRoles)
        if (name == row.name) return row.role;
    return None;
}

std::optional<int> channelNamed(const Property& property, const std::string& name) {
    if (property.countType) return std::nullopt;
    if (name == "color") {
        const Role role = roleOf(property);
        return role >= Red && role <= Blue ? std::optional(role - Red) : std::nullopt;
    }
    const std::string_view text = property.name;
    if (text.size() < 3 || text[text.size() - 2] != '_') return std::nullopt;
    const std::string_view stem = text.substr(0, text.size() - 2);
    const size_t color = std::string_view("rgb").find(text.back());
    if (color != std::string_view::npos)
        return std::string(stem) + "_color" == name ? std::optional(int(color)) : std::nullopt;
    const size_t number = std::string_view("012").find(text.back());
    const size_t axis = std::string_view("xyz").find(text.back());
    const size_t channel = std::min(number, axis);
    if (stem != name || channel == std::string_view::npos) return std::nullopt;
    return int(channel);
}

bool isWhole(ScalarType type) {
    return type != ScalarType::Float32 && type != ScalarType::Float64;
}

/// Which numbers the colours of a file are. Programs write bytes as numbers of any type.
struct ColorRange {
    ScalarType type = ScalarType::Float32;
    float most = 0;
    bool areWhole = true;

    void add(float value) {
        most = std::max(most, value);
        areWhole = areWhole && value == std::floor(value);
    }
    /// The number that stands for 1.
    double one() const {
        constexpr double byte = 255;
        const double full = fullScale(type);
        if (full > byte && most <= 1) return 1;
        const bool areBytes =
            most > 1 && most <= byte && areWhole && (full > byte || !isWhole(type));
        return areBytes ? byte : full;
    }
};

class VertexReader {
  public:
    VertexReader(const Element& element, Body& body, build::SceneBuilder& builder,
                 const std::string& colors, const PlyAttribute& stated)
        : element_(element), body_(body), builder_(builder), areSrgb_(stated.areSrgb),
          mayBeBytes_(stated.mayBeBytes), isColor_(colors == "color") {
        for (const Property& property : element.properties) {
            Role role = roleOf(property);
            if (!isColor_ && role >= Red && role <= Alpha) role = None;
            if (const std::optional<int> channel = channelNamed(property, colors))
                role = Role(Red + *channel);
            if (role != None && has_[role]) role = None; // another name for the same
            if (role == None)
                builder.report().ignore(
                    "properties of vertices",
                    "they are no position, normal, texture coordinate or colour");
            else
                has_[role] = true;
            roles_.push_back(role);
            if (role >= Red && role <= Blue) colors_.type = property.type;
            if (role == Alpha) alphas_.type = property.type;
        }
        if (!has_[X] || !has_[Y] || !has_[Z]) body.fail("vertices have no x, y and z");
        hasNormals_ = has_[Nx] && has_[Ny] && has_[Nz];
        hasUv_ = has_[U] && has_[V];
        hasColors_ = has_[Red] && (!isColor_ || (has_[Green] && has_[Blue])) &&
                     builder.conventions().textures;
    }

    Vertices read() {
        found_.hasColors = hasColors_;
        found_.hasUv = hasUv_;
        // Twice: here and in the scene.
        build::requireMemory(body_.place().file,
                             2 * element_.count *
                                 ((hasNormals_ ? 2 : 1) * sizeof(glm::dvec3) +
                                  (hasUv_ || hasColors_ ? sizeof(VertexAttributes) : 0)));
        found_.positions.reserve(element_.count);
        if (hasNormals_) found_.normals.reserve(element_.count);
        if (hasUv_ || hasColors_) found_.attributes.reserve(element_.count);
        for (uint64_t i = 0; i < element_.count; ++i) {
            body_.beginElement(i);
            for (size_t p = 0; p < roles_.size(); ++p)
                if (roles_[p] == None)
                    body_.skip(element_.properties[p]);
                else
                    values_[roles_[p]] = body_.number(element_.properties[p].type);
            keep();
            body_.endElement();
        }
        if (hasColors_) finishColors();
        return std::move(found_);
    }

  private:
    void keep() {
        const glm::dvec3 position(values_[X], values_[Y], values_[Z]);
        found_.positions.push_back(position);
        if (hasNormals_) found_.normals.emplace_back(values_[Nx], values_[Ny], values_[Nz]);
        if (!hasUv_ && !hasColors_) return;
        VertexAttributes& a = found_.attributes.emplace_back();
        // On the renderer's pictures v grows downwards.
        if (hasUv_) a.uv[0] = {finite(values_[U]), finite(1 - values_[V])};
        if (hasColors_) a.color = colorOf();
    }

    /// As the file states it.
    glm::vec4 colorOf() {
        glm::vec4 color(1);
        if (!isColor_) {
            for (int i = 0; i < 3; ++i)
                color[i] = finite(values_[has_[Blue] ? Red + i : Red]);
            return color;
        }
        for (int i = 0; i < 3; ++i)
            colors_.add(color[i] = std::max(finite(values_[Red + i]), 0.0f));
        if (has_[Alpha]) alphas_.add(color.w = std::max(finite(values_[Alpha]), 0.0f));
        return color;
    }

    /// What the numbers mean can be told from all of them alone.
    void finishColors() {
        if (!isColor_) return;
        const double scale = mayBeBytes_ ? colors_.one() : fullScale(colors_.type);
        const bool isLinear = !areSrgb_.value_or(scale != 1 || isWhole(colors_.type));
        if (!areSrgb_) {
            if (scale != fullScale(colors_.type) && isWhole(colors_.type))
                builder_.report().assume(fmt::format(
                    "colours of vertices are fractions of {}, as none is above it", scale));
            else if (scale != fullScale(colors_.type))
                builder_.report().replace({body_.place().file, 0, "vertex"},
                                          build::Shortfall::ByteColor,
                                          fmt::format("the colours go up to {}", colors_.most));
            builder_.report().assume(isLinear
                                         ? "colours of vertices are linear, as floats are"
                                         : "colours of vertices are sRGB, as whole numbers are");
        }
        const double alphaScale = mayBeBytes_ ? alphas_.one() : fullScale(alphas_.type);
        for (VertexAttributes& a : found_.attributes) {
            for (int i = 0; i < 3; ++i) {
                const double value = double(a.color[i]) / scale;
                a.color[i] = float(isLinear ? value : srgbToLinear(std::min(value, 1.0)));
            }
            if (has_[Alpha]) a.color.w = float(std::min(a.color.w / alphaScale, 1.0));
            found_.hasAlpha = found_.hasAlpha || a.color.w < 1;
        }
    }

    float finite(double value) {
        const auto rounded = float(value);
        if (std::isfinite(rounded)) return rounded;
        builder_.report().warn("texture coordinates or colours that are not finite become 0");
        return 0;
    }

    const Element& element_;
    Body& body_;
    build::SceneBuilder& builder_;
    Vertices found_;
    std::vector<Role> roles_; ///< one for each property
    std::array<bool, kRoleCount> has_{};
    std::array<double, kRoleCount> values_{};
    std::optional<bool> areSrgb_; ///< said by whoever reads the file
    bool mayBeBytes_;
    bool isColor_; ///< what colours are read from, and no other attribute
    ColorRange colors_, alphas_;
    bool hasNormals_ = false, hasUv_ = false, hasColors_ = false;
};

} // namespace

std::optional<int> channelOfAttribute(const Property& property, const std::string& name) {
    return channelNamed(property, name);
}

double fullScale(ScalarType type) {
    switch (type) {
    case ScalarType::Int8:
        return std::numeric_limits<int8_t>::max();
    case ScalarType::UInt8:
        return std::numeric_limits<uint8_t>::max();
    case ScalarType::Int16:
        return std::numeric_limits<int16_t>::max();
    case ScalarType::UInt16:
        return std::numeric_limits<uint16_t>::max();
    case ScalarType::Int32:
        return std::numeric_limits<int32_t>::max();
    case ScalarType::UInt32:
        return std::numeric_limits<uint32_t>::max();
    case ScalarType::Int64:
        return double(std::numeric_limits<int64_t>::max());
    case ScalarType::UInt64:
        return double(std::numeric_limits<uint64_t>::max());
    default:
        return 1;
    }
}

Vertices readVertices(const Element& element, Body& body, build::SceneBuilder& builder,
                      const std::string& colors, const PlyAttribute& stated) {
    return VertexReader(element, body, builder, colors, stated).read();
}

} // namespace stromboli::ply
