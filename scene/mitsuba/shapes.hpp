#pragma once

#include "scene/mitsuba/materials.hpp"
#include "scene/mitsuba/mesh_files.hpp"

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace stromboli::mitsuba {

/// Places the shapes of a scene.
class Shapes {
  public:
    explicit Shapes(Context& context) : context_(context), materials_(context) {}

    /// A shape of the scene: shape groups show nothing until they are instanced.
    void place(const Plugin& shape);

    /// What fills the space between them.
    Media& media() { return materials_.media(); }

  private:
    /// What one plugin shows.
    struct Part {
        const Plugin* plugin = nullptr;
        build::ShapeId shape{};
        glm::dmat4 toWorld{1.0};
        std::vector<uint32_t> materials; ///< of the parts of its mesh
    };

    std::vector<Part> partsOf(const Plugin& shape);
    const std::vector<Part>& group(const Plugin& group);
    std::vector<Part> instance(const Plugin& shape);
    Part single(const Plugin& shape);
    bool isInsideOut(const Plugin& shape);
    Part withOwnMaterials(const Plugin& shape);
    build::Mesh meshOf(const Plugin& shape, const BoundMaterial& material);
    build::Mesh solidOf(const Plugin& shape);
    build::Mesh fileMesh(const Plugin& shape, const BoundMaterial& material);
    void finish(const Plugin& shape, const FileMesh& file, const BoundMaterial& material,
                build::Mesh& mesh);
    const std::string& usableAttribute(const Plugin& shape, const std::string& attribute);
    static void fitTo(const Plugin& shape, const BoundMaterial& material, build::Mesh& mesh);
    /// The shape's file, whose corners have colours by that attribute; empty: they may have none.
    const FileMesh& read(const Plugin& shape, const std::string& attribute);

    Context& context_;
    Materials materials_;
    /// By file, index, mesh attribute, whether materials are wanted and whether colours of vertices
    /// are sRGB (PlyAttribute); nothing: the file cannot be read.
    std::map<std::tuple<std::string, int64_t, std::string, bool, std::optional<bool>>,
             std::optional<FileMesh>>
        files_;
    std::map<const Plugin*, std::vector<Part>> groups_;
};

} // namespace stromboli::mitsuba
