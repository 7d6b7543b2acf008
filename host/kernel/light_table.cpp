#include "host/kernel/light_table.hpp"

#include "host/kernel/light_kinds.hpp"
#include "scene/model/emitters.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace stromboli {

// --- The table of lights -------------------------------------------------------------------------

namespace {

/// How far apart surfaces and lights are, more or less: half the diagonal of the scene.
double radiusOf(const Scene& scene) {
    const Bounds bounds = scene.framed();
    const double radius = bounds.empty() ? 0 : 0.5 * glm::length(glm::dvec3(bounds.extent()));
    return radius > 0 ? radius : 1;
}

/// Of more lights it is not asked how much of their light arrives (arriving_light.hpp).
constexpr uint32_t kMostWeighed = 1024;

/// What kernels know of the tree by which lights are picked; of none: an empty one.
void setTree(LightTable& lights, const LightTree& tree) {
    lights.groups = tree.groups;
    lights.lightsInGroup = tree.lightsInGroup;
    lights.levels = tree.levels;
}

/// Collects the lights that are sampled, with what one is picked by.
class Packer {
  public:
    Packer(const Scene& scene, std::span<const uint32_t> placeOf, const LightSelection& selection,
           std::span<const uint32_t> pictures, std::shared_ptr<const EnvironmentTable> environment,
           const std::vector<bool>& isLeft)
        : isLeft_(isLeft), scene_(scene), placeOf_(placeOf), selection_(selection),
          pictures_(pictures), known_(std::move(environment)), sceneRadius_(radiusOf(scene)),
          means_(scene) {
        out_.choice = selection.choice;
    }

    LightTable pack() {
        out_.hasBackdrop = scene_.environment.has_value();
        if (scene_.environment && !scene_.environment->isConstant())
            addEnvironment(*scene_.environment);
        else if (!selection_.everyLightOfTheFile)
            addAmbientLight();
        else if (!selection_.deltaLightsOnly)
            addLights([](const Light& l) { return l.kind == LightKind::Ambient; });
        if (selection_.emitters && !selection_.deltaLightsOnly) addEmitters();
        if (!selection_.deltaLightsOnly)
            addLights([](const Light& l) { return l.kind == LightKind::Area; });
        out_.areaCount = uint32_t(entries_.size());
        addLights([](const Light& l) { return l.isDelta(); });
        // Not a picture, in which a sun may stand.
        if (out_.ambientNumber != gpu::NO_LIGHT && selection_.ambientToBounces &&
            !out_.environment && entries_.size() > 1)
            leaveAmbientToBounces();
        out_.count = uint32_t(entries_.size());
        writeTable();
        return std::move(out_);
    }

  private:
    /// What can bring no light is no light, but in the file, where each may count.
    static bool shines(const LightBounds& bounds) { return bounds.power > 0; }

    uint32_t addRows(const glm::vec3& color, uint32_t kindAndFlags) {
        const auto number = uint32_t(out_.lights.size() / gpu::LIGHT_ROWS);
        appendRows(out_.lights, gpu::LightHeader{color, kindAndFlags});
        return number;
    }

    void fillRows() {
        while (out_.lights.size() % gpu::LIGHT_ROWS != 0)
            out_.lights.push_back({});
    }

    uint32_t addEntry(uint32_t kind, uint32_t reference, const LightBounds& bounds) {
        out_.sampledKinds |= 1u << kind;
        entries_.push_back({reference, 0, 0, bounds.group});
        bounds_.push_back(bounds);
        return uint32_t(entries_.size() - 1);
    }

    template <class Wanted>
    void addLights(Wanted&& wanted) {
        for (const Light& light : scene_.lights)
            if (wanted(light)) addLight(light);
    }

    /// All of the scene's ambient light as one light: the sum of radiances is what arrives.
    void addAmbientLight() {
        Light everywhere, above;
        everywhere.kind = above.kind = LightKind::Ambient;
        everywhere.color = above.color = glm::vec3(0);
        above.upperHemisphereOnly = true;
        for (const Light& l : scene_.lights)
            if (l.kind == LightKind::Ambient)
                (l.upperHemisphereOnly ? above : everywhere).color += l.color;
        if (scene_.environment)
            everywhere.color += scene_.environment->strength * scene_.environment->radiance[0];
        LightBounds bounds = packLight(everywhere, sceneRadius_).bounds;
        const LightBounds fromAbove = packLight(above, sceneRadius_).bounds;
        if (!(bounds.power > 0))
            bounds = fromAbove;
        else
            bounds.power += fromAbove.power;
        if (!(bounds.power > 0)) return;
        out_.hasAmbient = true;
        const uint32_t number = addRows(everywhere.color, gpu::LIGHT_AMBIENT);
        appendRows(out_.lights, gpu::AmbientLight{above.color, 0});
        fillRows();
        if (!selection_.deltaLightsOnly)
            out_.ambientNumber = addEntry(gpu::LIGHT_AMBIENT, number, bounds);
    }

    void addEnvironment(const Environment& environment) {
        known_ = std::make_shared<EnvironmentTable>(known_ ? turned(*known_, environment.rotation)
                                                           : packEnvironment(environment));
        const LightBounds bounds = boundsOfEnvironment(known_->luminance);
        if (!shines(bounds)) return;
        out_.hasAmbient = true;
        out_.environment = known_;
        const uint32_t number = addRows(glm::vec3(environment.strength), gpu::LIGHT_ENVIRONMENT);
        appendRows(out_.lights, known_->light);
        fillRows();
        if (!selection_.deltaLightsOnly)
            out_.ambientNumber = addEntry(gpu::LIGHT_ENVIRONMENT, number, bounds);
    }

    /// It is the first entry.
    void leaveAmbientToBounces() {
        out_.ambientLeftToBounces = true;
        out_.ambientNumber = gpu::NO_LIGHT;
        out_.sampledKinds &= ~(1u << gpu::LIGHT_AMBIENT);
        --out_.areaCount;
        entries_.erase(entries_.begin());
        bounds_.erase(bounds_.begin());
        for (uint32_t& number : out_.numberOf)
            if (number != gpu::NO_LIGHT) --number;
    }

    void addLight(const Light& l) {
        const size_t index = size_t(&l - scene_.lights.data());
        const uint32_t picture = index < pictures_.size() ? pictures_[index] : 0;
        const PackedLight packed = packLight(l, sceneRadius_, picture);
        if (!shines(packed.bounds) && !selection_.everyLightOfTheFile) return;
        const uint32_t number = addRows(l.color, packed.kindAndFlags);
        for (const Row& row : packed.parameters)
            out_.lights.push_back(row);
        fillRows();
        addEntry(packed.kind(), number, packed.bounds);
    }

    void addEmitters() {
        for (const Emitter& e : collectEmitters(scene_)) {
            if (leaves(e)) continue;
            if (e.kind == EmitterKind::Mesh) {
                ++meshes_;
                for (const uint32_t triangle : e.triangles)
                    addTriangle(triangle);
                continue;
            }
            const LightBounds bounds = boundsOfEmitter(scene_, e, means_);
            if (!shines(bounds)) continue;
            const Material& m = scene_.materials[e.material];
            const bool isQuad = e.kind == EmitterKind::Quad;
            const uint32_t kind = isQuad ? gpu::LIGHT_QUAD : gpu::LIGHT_SPHERE;
            const uint32_t number =
                addRows(isQuad ? m.emission : glm::vec3(means_.ofSphere(e.sphere)),
                        kind | (m.emitsBothSides ? gpu::LIGHT_BOTH_SIDES : 0));
            if (isQuad) {
                appendRows(out_.lights, quadLight(e.corner, e.edgeA, e.edgeB));
            } else {
                const Sphere& sphere = scene_.spheres[e.sphere];
                appendRows(out_.lights, gpu::SphereLight{sphere.center, sphere.radius});
            }
            fillRows();
            const uint32_t entry = addEntry(kind, number, bounds);
            for (const uint32_t triangle : e.triangles)
                nameLight(triangle, entry);
            if (!isQuad) nameLight(uint32_t(scene_.triangles.size()) + e.sphere, entry);
        }
    }

    /// Whether the emitter is left to bounces.
    bool leaves(const Emitter& e) {
        if (isLeft_.empty()) return false;
        std::vector<uint32_t> primitives = e.triangles;
        if (e.kind == EmitterKind::Sphere)
            primitives.push_back(uint32_t(scene_.triangles.size()) + e.sphere);
        if (!isLeft_[primitives.front()]) return false;
        out_.leftToBounces.insert(out_.leftToBounces.end(), primitives.begin(), primitives.end());
        return true;
    }

    void addTriangle(uint32_t triangle) {
        const LightBounds bounds = boundsOfTriangle(scene_, triangle, means_);
        if (!shines(bounds)) return;
        nameLight(triangle, addEntry(gpu::LIGHT_TRIANGLE,
                                     placeOf_[triangle] | gpu::LIGHT_IS_TRIANGLE, bounds));
    }

    void nameLight(uint32_t primitive, uint32_t entry) {
        if (out_.numberOf.empty())
            out_.numberOf.assign(scene_.triangles.size() + scene_.spheres.size(), gpu::NO_LIGHT);
        out_.numberOf[primitive] = entry;
    }

    /// docs/results.md, "Few lights", has what was measured: of two lights, both are sampled with
    /// less noise at equal time, unless they are a sky and a lamp; the few triangles of a single
    /// mesh, and lights that are faint beside an environment, are picked as well by their power,
    /// which is quicker.
    LightChoice suitableChoice() const {
        constexpr uint32_t kFewTriangles = 64;
        const bool oneMesh = out_.sampledKinds == 1u << gpu::LIGHT_TRIANGLE && meshes_ == 1 &&
                             out_.count < kFewTriangles;
        if (oneMesh) return LightChoice::Power;
        const bool areSkyAndLamp = out_.environment && out_.areaCount == out_.count;
        if (out_.count == 2) return areSkyAndLamp ? LightChoice::Tree : LightChoice::Each;
        return isMostlyEnvironment() ? LightChoice::Power : LightChoice::Tree;
    }

    /// Whether the other lights are such as bounces can find and together bring less than a
    /// sixteenth of what the environment brings, so that nearly all light samples go to it anyway.
    bool isMostlyEnvironment() const {
        constexpr double kFaint = 1.0 / 16;
        if (!out_.environment || out_.ambientNumber == gpu::NO_LIGHT) return false;
        if (out_.areaCount < entries_.size()) return false;
        double others = 0;
        for (uint32_t i = 0; i < bounds_.size(); ++i)
            if (i != out_.ambientNumber) others += irradianceAcross(bounds_[i], sceneRadius_);
        return others < kFaint * irradianceAcross(bounds_[out_.ambientNumber], sceneRadius_);
    }

    void writeTable() {
        if (out_.choice == LightChoice::Automatic) out_.choice = suitableChoice();
        out_.entries = out_.count;
        const bool isPicked = out_.count > 1 && out_.choice != LightChoice::Each;
        const bool byTree = isPicked && out_.choice == LightChoice::Tree;
        const bool mayPickBy =
            isPicked && selection_.choice == LightChoice::Automatic && out_.count <= kMostWeighed;
        WeighedLights lights;
        if (byTree || mayPickBy) {
            lights.tree = buildLightTree(bounds_);
            renumber(lights.tree);
        }
        lights.entries = std::move(entries_);
        lights.bounds = std::move(bounds_);
        lights.radius = sceneRadius_;
        lights.plain = out_.choice;
        if (out_.choice == LightChoice::Uniform) // as if all brought the same
            lights.bounds.assign(lights.entries.size(), {.power = 1});
        if (isPicked)
            out_.table = tableOf(lights, {out_.choice});
        else
            for (const gpu::LightEntry& entry : lights.entries)
                appendRows(out_.table, entry);
        if (byTree) setTree(out_, lights.tree);
        if (mayPickBy) out_.weighed = std::move(lights);
    }

    /// Numbers the lights as the tree has them.
    void renumber(const LightTree& tree) {
        std::vector<gpu::LightEntry> entries;
        std::vector<LightBounds> bounds;
        std::vector<uint32_t> newNumber(tree.order.size());
        for (const uint32_t number : tree.order) {
            newNumber[number] = uint32_t(entries.size());
            bounds.push_back(bounds_[number]);
            entries.push_back(entries_[number]);
            entries.back().trail = tree.trails[newNumber[number]];
        }
        entries_ = std::move(entries);
        bounds_ = std::move(bounds);
        for (uint32_t& number : out_.numberOf)
            if (number != gpu::NO_LIGHT) number = newNumber[number];
        if (out_.ambientNumber != gpu::NO_LIGHT) out_.ambientNumber = newNumber[out_.ambientNumber];
    }

    const std::vector<bool>& isLeft_;
    const Scene& scene_;
    std::span<const uint32_t> placeOf_;
    LightSelection selection_;
    std::span<const uint32_t> pictures_; ///< by light of the scene, the row of its picture
    std::shared_ptr<const EnvironmentTable> known_; ///< of the environment, once it is packed
    double sceneRadius_;
    MeanEmission means_;
    uint32_t meshes_ = 0;
    LightTable out_;
    std::vector<gpu::LightEntry> entries_;
    std::vector<LightBounds> bounds_;
};

} // namespace

LightSelection lightSelection(const Estimator& settings) {
    const ShadingConventions& conventions = settings.conventions;
    LightSelection selection;
    selection.choice = conventions.everyLightInTurn ? LightChoice::Each : settings.lightChoice;
    selection.deltaLightsOnly =
        !samplesLights(settings.directLight) && !settings.countsLightsForHemisphere();
    selection.ambientToBounces =
        settings.directLight == DirectLight::Mis && conventions.bouncesFindAllLight;
    selection.emitters = conventions.samplesEmitters;
    selection.everyLightOfTheFile = conventions.everyLightInTurn;
    selection.leavesLampsInGlass =
        combinesWithBounces(settings.directLight) && conventions.bouncesFindAllLight;
    return selection;
}

LightTable packLights(const Scene& scene, std::span<const uint32_t> placeOf,
                      const LightSelection& selection, std::span<const uint32_t> pictures,
                      std::shared_ptr<const EnvironmentTable> environment,
                      const std::vector<bool>& isLeft) {
    return Packer(scene, placeOf, selection, pictures, std::move(environment), isLeft).pack();
}

bool pickBy(LightTable& lights, const HowLightsArePicked& how) {
    const bool byTree = how.choice == LightChoice::Tree;
    std::vector<Row> table = tableOf(*lights.weighed, how);
    const bool isOther = !std::ranges::equal(std::as_bytes(std::span(table)),
                                             std::as_bytes(std::span(lights.table)));
    lights.table = std::move(table);
    lights.choice = how.choice;
    lights.isPickedByArrival = !how.factors.empty();
    lights.entries = lights.count + (how.none > 0 ? 1 : 0);
    setTree(lights, byTree ? lights.weighed->tree : LightTree());
    return isOther;
}

/// It is the first of all lights; its parameters are behind its header.
void turnEnvironment(LightTable& lights, float rotation) {
    if (!lights.environment) return;
    lights.environment = std::make_shared<EnvironmentTable>(turned(*lights.environment, rotation));
    std::vector<Row> parameters;
    appendRows(parameters, lights.environment->light);
    std::ranges::copy(parameters, lights.lights.begin() + sizeof(gpu::LightHeader) / sizeof(Row));
}

// --- Samples of direct light ---------------------------------------------------------------------

namespace {

/// Lights are sampled one by one or, in turn, each; a single delta light needs no second sample.
void addLightSamples(const LightTable& lights, uint32_t samples, DirectSampling& direct) {
    const uint32_t deltaLights = lights.count - lights.areaCount;
    direct.perLight = samples;
    if (lights.choice == LightChoice::Each)
        direct.lights = lights.areaCount * samples + deltaLights;
    else
        direct.lights = lights.count > 0 ? samples : 0;
    if (lights.count == 1 && deltaLights == 1) direct.lights = direct.perLight = 1;
}

} // namespace

DirectSampling directSampling(const LightTable& lights, const Estimator& settings) {
    DirectSampling direct;
    const uint32_t samples = settings.lightSamples;
    if (settings.countsLightsForHemisphere()) {
        direct.hemisphere = samples * lights.count;
        return direct;
    }
    if (!samplesLights(settings.directLight) && lights.areaCount > 0)
        throw std::invalid_argument("the lights were packed for another way to find direct light");
    const bool samplesAll =
        samplesLights(settings.directLight) && settings.directLight != DirectLight::Mis;
    if (samplesAll && lights.ambientLeftToBounces)
        throw std::invalid_argument("ambient light was left to bounces, which do not look for it");
    if (settings.directLight == DirectLight::Hemisphere) direct.hemisphere = samples;
    addLightSamples(lights, samples, direct);
    return direct;
}

} // namespace stromboli
