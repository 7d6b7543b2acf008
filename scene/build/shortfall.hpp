#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace stromboli::build {

/// What a file lacks or has wrong where a picture can be made of the rest. Loaders do not decide
/// what becomes of it: they hand the kind to Report::replace, and the table below says what is
/// taken instead. docs/guide/replacements.md is the same table for users.
enum class Shortfall : size_t {
    Picture,
    PicturePart,
    Texel,
    ReflectedFraction,
    LightColor,
    Number,
    Word,
    Reference,
    Attribute,
    Normal,
    Vertex,
    Geometry,
    Material,
    Node,
    Extension,
    EnvironmentTexel,
    EnvironmentSize,
    OtherCapitals,
    ByteColor,
    Parameter,
    Model,
    Medium,
};

struct ShortfallKind {
    Shortfall kind;
    std::string_view what;    ///< in a file
    std::string_view instead; ///< the end of the line about it: what is taken
};

inline constexpr auto kShortfalls = std::to_array<ShortfallKind>({
    {Shortfall::Picture, "a picture that is not there or cannot be read",
     "there is no picture on the surface"},
    {Shortfall::PicturePart, "a picture of which some bytes are missing or damaged",
     "what there is of it is shown"},
    {Shortfall::Texel, "a texel that is no number", "it counts as 0"},
    {Shortfall::ReflectedFraction, "a reflected fraction outside [0, 1]", "it is clamped to it"},
    {Shortfall::LightColor, "an amount of light that is negative or no finite number",
     "such channels become 0"},
    {Shortfall::Number, "a number outside its range", "the nearest one in it is taken"},
    {Shortfall::Word, "a word or value that the format does not have", "its default is taken"},
    {Shortfall::Reference, "a reference to what is not there", "it counts as absent"},
    {Shortfall::Attribute, "an attribute of vertices or faces that does not fit them",
     "the mesh is shown without it"},
    {Shortfall::Normal, "a normal that is no number", "such a face is shaded flat"},
    {Shortfall::Vertex, "a vertex whose coordinates are no numbers",
     "triangles with such a vertex are left out"},
    {Shortfall::Geometry, "a mesh, or a part of one, that cannot be read", "it is left out"},
    {Shortfall::Material, "a material that cannot be read", "mid grey takes its place"},
    {Shortfall::Node, "a node, light or camera that cannot be read", "it is left out"},
    {Shortfall::Extension, "an extension that is required and not read",
     "the scene is shown without it"},
    {Shortfall::EnvironmentTexel, "a texel of an environment that is negative or no finite number",
     "it counts as 0"},
    {Shortfall::EnvironmentSize, "an environment with more texels than there is room for",
     "it is shrunk, to means of its light"},
    {Shortfall::OtherCapitals, "a file whose name is written with other capitals",
     "the file with other capitals is taken"},
    {Shortfall::ByteColor, "colours of vertices above 1", "they count as fractions of 255"},
    {Shortfall::Parameter, "a parameter that cannot be read, or that nothing reads",
     "it has no effect"},
    {Shortfall::Model, "a material, texture, light, camera or shape that does not exist here",
     "the nearest one takes its place"},
    {Shortfall::Medium, "a medium that cannot be read, or what scatters under a surface",
     "the scene is shown without it"},
});

constexpr std::string_view insteadOf(Shortfall kind) {
    return kShortfalls[size_t(kind)].instead;
}

/// The table is in the order of the enumeration.
static_assert([] {
    for (size_t i = 0; i < kShortfalls.size(); ++i)
        if (size_t(kShortfalls[i].kind) != i) return false;
    return true;
}());

} // namespace stromboli::build
