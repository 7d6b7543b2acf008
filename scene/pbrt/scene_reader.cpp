#include "scene/pbrt/scene_reader.hpp"

#include "scene/build/tolerate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace stromboli::pbrt {
namespace {

/// Which kind of shortfall a statement is that cannot be carried out.
build::Shortfall shortfallOf(std::string_view directive) {
    if (directive == "Shape" || directive == "ObjectInstance") return build::Shortfall::Geometry;
    if (directive == "NamedMaterial") return build::Shortfall::Reference;
    if (directive == "Texture") return build::Shortfall::Picture;
    return build::Shortfall::Node;
}

} // namespace

/// The points that control all curves.
static size_t pointsOfCurves(const std::vector<Statement>& statements) {
    size_t numbers = 0;
    for (const Statement& s : statements)
        if (s.directive() == "Shape" && s.words.front() == "curve")
            for (const Parameter& p : s.parameters)
                if (p.name == "P") numbers += p.numbers.size();
    return numbers / 3;
}

void SceneReader::read(std::vector<Statement> statements) {
    const size_t points = pointsOfCurves(statements);
    context_.tubes = build::tubeDetail(points);
    if (points > build::kMostDetailedPoints)
        context_.report().assume("hair of so many curves has tubes of three sides");
    state_.material = materialOf(context_.isV3() ? "matte" : "diffuse",
                                 Parameters(Statement{}, context_.report()));
    for (const Statement& statement : statements)
        if (statement.directive() == "MakeNamedMaterial")
            definitions_.try_emplace(statement.words.front(), &statement);
    for (Statement& statement : statements) {
        build::tolerate(context_.report(), shortfallOf(statement.directive()),
                        [&] { carryOut(statement); });
        statement.parameters = {}; // which may be large
    }
    shapes_.finishCurves(openObject());
    if (!isInWorld_) beginWorld();
    lights_.finish();
}

void SceneReader::carryOut(const Statement& s) {
    const std::string& directive = s.directive();
    if (transforms_.apply(s) || changeState(s)) return;
    using Handler = void (SceneReader::*)(const Statement&);
    static constexpr std::pair<std::string_view, Handler> kHandlers[] = {
        {"Shape", &SceneReader::addShape},
        {"Material", &SceneReader::setMaterial},
        {"MakeNamedMaterial", &SceneReader::nameMaterial},
        {"NamedMaterial", &SceneReader::useMaterial},
        {"Texture", &SceneReader::defineTexture},
        {"AreaLightSource", &SceneReader::setAreaLight},
        {"LightSource", &SceneReader::placeLight},
        {"ObjectBegin", &SceneReader::beginObject},
        {"ObjectEnd", &SceneReader::endObject},
        {"ObjectInstance", &SceneReader::placeObject},
        {"MakeNamedMedium", &SceneReader::defineMedium},
        {"MediumInterface", &SceneReader::setMedia},
        {"Volume", &SceneReader::sayVolume},
        {"Camera", &SceneReader::readView},
        {"Film", &SceneReader::readView},
        {"PixelFilter", &SceneReader::readView},
        {"Integrator", &SceneReader::readView},
        {"SurfaceIntegrator", &SceneReader::readView},
    };
    const auto* found =
        std::ranges::find(kHandlers, directive, [](const auto& h) { return h.first; });
    if (found != std::end(kHandlers)) return (this->*found->second)(s);
    if (directive == "Option")
        context_.report().ignore("Option", "options of pbrt have no meaning here");
    // Accelerators and samplers change how a picture is made, and not which.
}

bool SceneReader::changeState(const Statement& s) {
    const std::string& directive = s.directive();
    if (directive == "AttributeBegin") {
        begin("AttributeEnd");
    } else if (directive == "TransformBegin") {
        begin("TransformEnd");
    } else if (directive == "AttributeEnd" || directive == "TransformEnd") {
        end(s);
    } else if (directive == "ReverseOrientation") {
        state_.isReversed = !state_.isReversed;
    } else if (directive == "WorldBegin") {
        beginWorld();
    } else if (directive == "TransformTimes") {
        context_.report().ignore("TransformTimes", "things stand where they are at the start");
    } else if (directive == "ColorSpace") {
        if (!rec709From(s.words.front()))
            s.place.fail(fmt::format("is '{}', expected srgb, dci-p3, rec2020 or aces2065-1",
                                     s.words.front()));
        state_.colorSpace = s.words.front();
    } else if (directive == "Attribute") {
        std::vector<Parameter>& list = state_.attributes[s.words.front()];
        list.insert(list.begin(), s.parameters.begin(), s.parameters.end());
    } else {
        return false;
    }
    return true;
}

void SceneReader::begin(std::string_view end) {
    constexpr size_t kMostLevels = 100'000;
    if (saved_.size() < kMostLevels) saved_.push_back({state_, transforms_.current, end});
}

void SceneReader::end(const Statement& s) {
    if (saved_.empty() || saved_.back().by != s.directive())
        s.place.fail("ends what has not begun");
    Saved saved = std::move(saved_.back());
    saved_.pop_back();
    transforms_.current = saved.transforms;
    if (s.directive() == "TransformEnd") return;
    // In pbrt-v4 names are those of the whole scene.
    if (!context_.isV3()) {
        saved.state.textures = state_.textures;
        saved.state.materials = state_.materials;
    }
    state_ = std::move(saved.state);
}

void SceneReader::beginWorld() {
    isInWorld_ = true;
    view_.finish();
    transforms_.current = Transforms();
    transforms_.name("world", transforms_.current);
}

void SceneReader::readView(const Statement& s) {
    const std::string& kind = s.words.front();
    Parameters parameters(s, context_.report());
    parameters.setKind(kind);
    if (isInWorld_) s.place.fail("stands after WorldBegin");
    if (s.directive() == "Film") {
        view_.readFilm(kind, parameters);
    } else if (s.directive() == "PixelFilter") {
        view_.readFilter(kind, parameters);
    } else if (s.directive() == "Camera") {
        const Transforms& t = transforms_.current;
        if (t.isMoving())
            parameters.replace(build::Shortfall::Model, "moves", "its place at the start");
        view_.setCamera(kind, parameters, t.start, state_.media.outside);
        Transforms camera = t;
        camera.start = glm::inverse(t.start);
        camera.end = glm::inverse(t.end);
        transforms_.name("camera", camera);
    } else {
        view_.readIntegrator(kind, parameters);
    }
}

Parameters SceneReader::parametersOf(const Statement& s, const char* sort) {
    Parameters parameters(s, context_.report());
    const auto found = state_.attributes.find(sort);
    if (found != state_.attributes.end()) parameters.append(found->second);
    if (state_.colorSpace == "srgb") return parameters;
    Statement converted = s;
    converted.parameters = parameters.all();
    const glm::dmat3 matrix = *rec709From(state_.colorSpace);
    for (Parameter& parameter : converted.parameters) {
        if (parameter.type != "rgb") continue;
        for (size_t i = 0; i + 2 < parameter.numbers.size(); i += 3) {
            double* n = &parameter.numbers[i];
            const glm::dvec3 color = glm::max(matrix * glm::dvec3(n[0], n[1], n[2]), 0.0);
            for (const int c : {0, 1, 2})
                n[c] = color[c];
        }
    }
    return {converted, context_.report()};
}

std::shared_ptr<const MaterialStatement> SceneReader::materialOf(std::string kind,
                                                                 Parameters parameters) {
    parameters.setKind(kind);
    return std::make_shared<const MaterialStatement>(MaterialStatement{
        kind, std::move(parameters), state_.textures,
        kind == "mix" ? state_.materials : nullptr}); // of which there may be many
}

void SceneReader::setMaterial(const Statement& s) {
    state_.material = materialOf(s.words.front(), parametersOf(s, "material"));
}

void SceneReader::nameMaterial(const Statement& s) {
    const Parameters parameters = parametersOf(s, "material");
    const std::optional<std::string> kind = parameters.text("type");
    if (!kind) s.place.fail("has no 'type', expected that of the material");
    auto table = std::make_shared<MaterialTable>(*state_.materials);
    (*table)[s.words.front()] = materialOf(*kind, parameters);
    state_.materials = std::move(table);
}

void SceneReader::useMaterial(const Statement& s) {
    const std::string& name = s.words.front();
    // In pbrt-v4 its definition may stand behind.
    if (const auto later = definitions_.find(name);
        later != definitions_.end() && !context_.isV3() && !state_.materials->contains(name))
        nameMaterial(*later->second);
    const auto found = state_.materials->find(name);
    if (found == state_.materials->end())
        s.place.fail(fmt::format("names the material '{}', which is not there", name));
    state_.material = found->second;
}

void SceneReader::defineTexture(const Statement& s) {
    const std::string &name = s.words[0], &kind = s.words[2];
    const bool isNumber = s.words[1] == "float";
    if (!isNumber && s.words[1] != "spectrum" && s.words[1] != "color")
        s.place.fail(
            fmt::format("'{}' is of the type '{}', expected float or spectrum", name, s.words[1]));
    Parameters parameters = parametersOf(s, "texture");
    parameters.setKind(kind);
    auto table = std::make_shared<TextureTable>(*state_.textures);
    (*table)[{isNumber, name}] =
        textures_.make(kind, isNumber, parameters, *state_.textures, transforms_.current.start);
    state_.textures = std::move(table);
}

void SceneReader::setAreaLight(const Statement& s) {
    Parameters parameters = parametersOf(s, "light");
    parameters.setKind(s.words.front());
    state_.light = std::make_shared<const AreaLightStatement>(
        AreaLightStatement{s.words.front(), std::move(parameters)});
}

glm::dmat4 SceneReader::worldFromObject(const Statement& s) {
    if (transforms_.current.isMoving())
        context_.report().replace(s.place, build::Shortfall::Model, "moves",
                                  "its place at the start");
    return transforms_.current.start;
}

void SceneReader::placeLight(const Statement& s) {
    Parameters parameters = parametersOf(s, "light");
    parameters.setKind(s.words.front());
    lights_.place(s.words.front(), parameters, worldFromObject(s));
}

void SceneReader::addShape(const Statement& s) {
    if (!isInWorld_) s.place.fail("stands before WorldBegin");
    Parameters parameters = parametersOf(s, "shape");
    parameters.setKind(s.words.front());
    shapes_.add(s.words.front(), parameters,
                {worldFromObject(s), state_.isReversed, state_.material, state_.light,
                 state_.textures, state_.materials, state_.media},
                openObject());
}

/// An object keeps the state, as AttributeBegin does.
void SceneReader::beginObject(const Statement& s) {
    if (!objectName_.empty()) s.place.fail("is inside of another object");
    shapes_.finishCurves(nullptr);
    begin("ObjectEnd");
    objectName_ = "." + s.words.front();
    objects_[objectName_].clear();
}

void SceneReader::endObject(const Statement& s) {
    if (objectName_.empty()) s.place.fail("ends what has not begun");
    shapes_.finishCurves(openObject());
    objectName_.clear();
    while (!saved_.empty() && saved_.back().by != "ObjectEnd")
        saved_.pop_back();
    end(s);
}

void SceneReader::placeObject(const Statement& s) {
    const auto found = objects_.find("." + s.words.front());
    if (found == objects_.end())
        s.place.fail(fmt::format("names the object '{}', which is not there", s.words.front()));
    if (!objectName_.empty()) s.place.fail("is inside of an object");
    const glm::dmat4 toWorld = worldFromObject(s);
    for (Part part : found->second) {
        part.place = s.place;
        part.worldFromObject = toWorld * part.worldFromObject;
        part.name = s.words.front();
        shapes_.place(part);
    }
}

void SceneReader::defineMedium(const Statement& s) {
    Parameters parameters = parametersOf(s, "medium");
    parameters.setKind(s.words.front());
    media_.define(s.words.front(), parameters, worldFromObject(s));
}

void SceneReader::setMedia(const Statement& s) {
    state_.media = media_.between(s);
}

/// The Volume statement of pbrt-v1 and v2, a medium that fills a box.
void SceneReader::sayVolume(const Statement& s) {
    context_.report().replace(s.place, build::Shortfall::Medium, "is a medium");
}

} // namespace stromboli::pbrt
