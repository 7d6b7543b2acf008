#pragma once

#include "host/core/json.hpp"
#include "host/film/film.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/sampling_session.hpp"
#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/ray_types.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace stromboli::stress {

// --- The subject ---------------------------------------------------------------------------------

using Ray = gpu::TracedRay;

/// Where a ray ends that hits nothing.
inline constexpr float kMissed = 3.402823466e38f;

/// Traces rays through one scene.
class RayTracer {
  public:
    virtual ~RayTracer() = default;
    /// How many of the rays hit something. anyHit: stop at the first hit, as shadow rays do.
    virtual uint64_t countHits(std::span<const Ray> rays, bool anyHit) = 0;
    /// The distance of each ray's closest hit, in lengths of its direction, or kMissed.
    virtual std::vector<float> distances(std::span<const Ray> rays) = 0;
};

struct Picture {
    Film film;
    uint64_t rays = 0; ///< traced for it
};

/// Four counters (pixel, sample, block, seed), and what the hash makes of them.
using Words = std::array<uint32_t, 4>;
struct RandomBlock {
    Words words;
    std::array<float, 4> numbers; ///< in [0, 1)
};

/// Two floats, and what arithmetic makes of them.
struct FloatPair {
    float a, b;
};
struct FloatFacts {
    std::array<float, 4> results{}; ///< a + b, a - b, a b, -a
    /// A bit each, from the lowest: a < b, a <= b, a > b, a >= b, a == b, a != b, not a < b.
    uint32_t comparisons = 0;
};

/// What the cases put to the test. The product is DeviceSubject; tests put naive code in its
/// place, to see that a case can fail.
class Subject {
  public:
    virtual ~Subject() = default;
    virtual std::unique_ptr<RayTracer> tracer(const Scene& scene) = 0;
    /// `tuning` says how to work, and must not change the picture.
    virtual Picture render(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                           const KernelTuning& tuning, const ProgressCallback& progress) = 0;
    virtual std::vector<RandomBlock> randomBlocks(std::span<const Words> counters) = 0;
    virtual std::vector<FloatFacts> floatFacts(std::span<const FloatPair> pairs) = 0;
};

// --- A run ---------------------------------------------------------------------------------------

enum class Amount {
    Quick, ///< enough to find gross faults, in a second or two a case
    Full,
};

/// Thrown out of a case when the user wants it to stop.
struct Interrupted {};

/// What a case works with.
class Run {
  public:
    /// `goOn` is asked often; false from it ends the case.
    Run(Subject& subject, Amount amount, std::function<bool()> goOn = {})
        : subject_(subject), amount_(amount), goOn_(std::move(goOn)) {}

    Subject& subject() const { return subject_; }
    bool quick() const { return amount_ == Amount::Quick; }
    template <class T>
    T amount(T whenQuick, T whenFull) const {
        return quick() ? whenQuick : whenFull;
    }

    /// Throws Interrupted if the user wants no more.
    void goOn() const {
        if (goOn_ && !goOn_()) throw Interrupted{};
    }
    /// Throws Interrupted.
    Picture render(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                   const KernelTuning& tuning = {}) const;

  private:
    Subject& subject_;
    Amount amount_;
    std::function<bool()> goOn_;
};

// --- Cases ---------------------------------------------------------------------------------------

/// What a case found.
struct Finding {
    double measured = 0;
    double bound = 0;
    uint64_t trials = 0;
    std::string where; ///< what was worst; may be empty

    bool passed() const { return measured <= bound; } ///< NaN does not
};

/// A hard case: a property that naive code lacks.
struct Case {
    std::string name;
    std::string numbers;  ///< in docs/hard_cases.md
    std::string property; ///< what holds if it passes
    std::string measure;  ///< what `measured` is
    std::string trial;    ///< what `trials` counts
    Finding (*run)(Run& run);
};

/// All of them, in the order of docs/hard_cases.md. A file holds the groups of one theme.
const std::vector<Case>& allCases();

std::vector<Case> edgeCases();         ///< rays at edges and corners
std::vector<Case> intersectionCases(); ///< primitives and hierarchies that are hard to hit
std::vector<Case> closedCases();       ///< rays that leave surfaces, many times over
std::vector<Case> offsetCases();       ///< where rays start and end
std::vector<Case> scaleCases();        ///< scenes of any size, anywhere
std::vector<Case> randomCases();
std::vector<Case> furnaceCases();    ///< pictures that are one colour
std::vector<Case> estimatorCases();  ///< ways to the same mean
std::vector<Case> filmCases();       ///< sums of samples, and how the work is cut
std::vector<Case> agreementCases();  ///< device against reference, of scenesThatAgree()
std::vector<Case> arithmeticCases(); ///< what is taken for granted of floats
std::vector<Case> environmentCases();
std::vector<Case> materialCases(); ///< parameters at their ends, layers, nested volumes
std::vector<Case> mediumCases();   ///< densities, borders and grids of media
std::vector<Case> instanceCases(); ///< meshes met through placements
std::vector<Case> textureCases();
std::vector<Case> tangentCases(); ///< normal maps without a frame

/// The bundled scenes for which some samples of the reference are enough to compare with. Throws
/// SceneError where the bundled scenes are not there.
std::vector<std::string> scenesThatAgree();

// --- Reports -------------------------------------------------------------------------------------

/// What became of a case.
struct Outcome {
    Case which;
    Finding finding;
    std::string error; ///< why there is no finding; empty: there is one

    bool passed() const { return error.empty() && finding.passed(); }
};

/// Lines of a table, as wide as a terminal but for the property, which comes last.
std::string tableHead();
std::string tableRow(const Outcome& outcome);
/// For --list.
std::string listRow(const Case& which);

/// What a file of results says of the circumstances.
struct Circumstances {
    std::string device, driver, version;
    Amount amount = Amount::Full;
};

/// A number that is not finite becomes null.
Json toJson(const Circumstances& circumstances, const std::vector<Outcome>& outcomes);

} // namespace stromboli::stress
