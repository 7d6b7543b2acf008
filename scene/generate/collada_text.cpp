#include "scene/generate/collada_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace stromboli {

namespace {
constexpr int kNormalDecimals = 3;
constexpr size_t kVectorsPerLine = 8;
} // namespace

std::string compactNumber(double value, int decimals) {
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') text.pop_back();
    }
    return text == "-0" ? "0" : text;
}

static std::string vectorText(const glm::dvec3& v, int decimals) {
    return fmt::format("{} {} {}", compactNumber(v.x, decimals), compactNumber(v.y, decimals),
                       compactNumber(v.z, decimals));
}

static std::string sourceText(const std::string& id, const std::vector<glm::dvec3>& vectors,
                              int decimals) {
    std::string numbers;
    for (size_t i = 0; i < vectors.size(); ++i)
        numbers += vectorText(vectors[i], decimals) + ((i + 1) % kVectorsPerLine ? ' ' : '\n');
    return fmt::format(R"(        <source id="{0}">
          <float_array id="{0}-array" count="{1}">
{2}
          </float_array>
          <technique_common>
            <accessor source="#{0}-array" count="{3}" stride="3">
              <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
            </accessor>
          </technique_common>
        </source>
)",
                       id, 3 * vectors.size(), numbers, vectors.size());
}

static std::string stripsText(const std::string& vertices, const std::string& material,
                              const std::vector<Strip>& strips) {
    std::string text =
        fmt::format("        <tristrips material=\"{}\" count=\"{}\">\n"
                    "          <input semantic=\"VERTEX\" source=\"#{}\" offset=\"0\"/>\n",
                    material, strips.size(), vertices);
    for (const Strip& strip : strips)
        text += fmt::format("<p>{}</p>\n", fmt::join(strip, " "));
    return text + "        </tristrips>\n";
}

std::string geometryText(const std::string& id, const StripMesh& mesh, int decimals) {
    std::string text = fmt::format("    <geometry id=\"{0}\" name=\"{0}\">\n      <mesh>\n", id);
    text += sourceText(id + "-positions", mesh.positions, decimals);
    text += sourceText(id + "-normals", mesh.normals, kNormalDecimals);
    text += fmt::format(R"(        <vertices id="{0}-vertices">
          <input semantic="POSITION" source="#{0}-positions"/>
          <input semantic="NORMAL" source="#{0}-normals"/>
        </vertices>
)",
                        id);
    for (const auto& [material, strips] : mesh.strips)
        text += stripsText(id + "-vertices", material, strips);
    return text + "      </mesh>\n    </geometry>\n";
}

std::string quadText(const std::string& id, const glm::dvec3 (&corners)[4],
                     const std::string& material) {
    std::string numbers;
    for (const glm::dvec3& corner : corners)
        numbers += (numbers.empty() ? "" : "  ") + vectorText(corner, 0);
    return fmt::format(R"(    <geometry id="{0}" name="{0}">
      <mesh>
        <source id="{0}-positions">
          <float_array id="{0}-array" count="12">{1}</float_array>
          <technique_common>
            <accessor source="#{0}-array" count="4" stride="3">
              <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
            </accessor>
          </technique_common>
        </source>
        <vertices id="{0}-vertices"><input semantic="POSITION" source="#{0}-positions"/></vertices>
        <polylist material="{2}" count="1">
          <input semantic="VERTEX" source="#{0}-vertices" offset="0"/>
          <vcount>4</vcount>
          <p>0 1 2 3</p>
        </polylist>
      </mesh>
    </geometry>
)",
                       id, numbers, material);
}

std::string effectText(const std::string& name, const glm::dvec3& albedo,
                       const glm::dvec3& emission) {
    std::string light;
    if (emission != glm::dvec3(0))
        light = fmt::format("<emission><color>{} 1</color></emission>", vectorText(emission, 3));
    return fmt::format(R"(    <effect id="{0}-effect">
      <profile_COMMON><technique sid="common"><lambert>
        {1}<diffuse><color>{2} 1</color></diffuse>
      </lambert></technique></profile_COMMON>
    </effect>
)",
                       name, light, vectorText(albedo, 3));
}

std::string materialText(const std::string& name) {
    return fmt::format("    <material id=\"{0}\" name=\"{0}\">"
                       "<instance_effect url=\"#{0}-effect\"/></material>\n",
                       name);
}

std::string nodeText(const std::string& id, const std::vector<std::string>& materials) {
    std::string bindings;
    for (const std::string& material : materials)
        bindings += fmt::format("          <instance_material symbol=\"{0}\" target=\"#{0}\"/>\n",
                                material);
    return fmt::format(R"(      <node id="{0}-node" name="{0}">
        <instance_geometry url="#{0}"><bind_material><technique_common>
{1}        </technique_common></bind_material></instance_geometry>
      </node>
)",
                       id, bindings);
}

} // namespace stromboli
