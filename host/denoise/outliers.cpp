#include "host/denoise/prepare.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace stromboli::denoise {
namespace {

/// Pixels to each side of a pixel that are its neighbours here.
constexpr int kNear = 3;
/// Standard errors above what the neighbours have that a pixel may be. Of normal errors one pixel
/// in 700 is that far off by chance, and nearly all of these have light in both halves.
constexpr double kAllowed = 3;
/// So many neighbours have to count fully for their mean to say anything: where fewer are of the
/// same surface, as at edges, the others count for the rest.
constexpr double kLeastNeighbours = 16;

/// What a pixel gives away.
struct Gift {
    glm::dvec3 light{0.0}; ///< radiance
    double parts = 0;      ///< of it that its neighbours take, the pixel included
    double foreign = 0;    ///< what a neighbour of another surface counts for
    float keeps = 1;       ///< what is left of the pixel's radiance
};

/// Sums over the neighbours of a pixel.
struct Neighbours {
    double weights = 0, squares = 0, radiance = 0, variance = 0;

    void add(double weight, const gpu::DenoisePixel& q) {
        const double error = sumOf(glm::abs(glm::dvec3(q.deviation)));
        weights += weight, squares += weight * weight;
        radiance += weight * sumOf(q.mean);
        variance += weight * error * error;
    }
};

class Limiter {
  public:
    explicit Limiter(Prepared& picture)
        : picture_(picture), width_(int(picture.width)), height_(int(picture.height)),
          gifts_(picture.pixels.size()) {}

    void run() {
        forEachPixel([&](int x, int y) { gifts_[at(x, y)] = giftOf(x, y); });
        forEachPixel([&](int x, int y) { gifts_[at(x, y)].parts = partsAround(x, y); });
        std::vector<glm::vec3> taken(gifts_.size());
        forEachPixel([&](int x, int y) { taken[at(x, y)] = takenBy(x, y); });
        double moved = 0;
        for (size_t i = 0; i < gifts_.size(); ++i) {
            gpu::DenoisePixel& p = picture_.pixels[i];
            const Gift& gift = gifts_[i];
            if (gift.keeps < 1) {
                ++picture_.limitedPixels;
                moved += sumOf(gift.light) / 3;
                p.mean *= gift.keeps;
                p.deviation *= gift.keeps;
            }
            if (taken[i] == glm::vec3(0.0f)) continue;
            p.mean += taken[i];
            for (int c = 0; c < 3; ++c)
                p.deviation[c] =
                    std::copysign(std::hypot(p.deviation[c], taken[i][c]), p.deviation[c]);
        }
        const double light = picture_.meanRadiance * double(gifts_.size());
        picture_.movedLight = light > 0 ? moved / light : 0;
    }

  private:
    size_t at(int x, int y) const { return size_t(y) * size_t(width_) + size_t(x); }

    template <class Function>
    void forEachPixel(const Function& function) {
        tbb::parallel_for(0, height_, [&](int y) {
            for (int x = 0; x < width_; ++x)
                function(x, y);
        });
    }
    template <class Function>
    void forEachNear(int x, int y, const Function& function) const {
        for (int v = std::max(y - kNear, 0); v <= std::min(y + kNear, height_ - 1); ++v)
            for (int u = std::max(x - kNear, 0); u <= std::min(x + kNear, width_ - 1); ++u)
                function(u, v);
    }

    /// How much the pixel at (u, v) is of the surface that the one at (x, y) shows.
    double weightOf(int x, int y, int u, int v) const {
        const gpu::DenoisePixel& q = picture_.pixels[at(u, v)];
        const glm::dvec3 unlike = featureDifferences(picture_.pixels[at(x, y)], q, u - x, v - y);
        return q.weight * std::exp(-0.5 * glm::dot(unlike, glm::dvec3(gpu::DENOISE_PILOT_SCALE)));
    }

    /// The weight where neighbours of other surfaces count for something.
    double weightOf(int x, int y, int u, int v, double foreign) const {
        return glm::mix(weightOf(x, y, u, v), double(picture_.pixels[at(u, v)].weight), foreign);
    }

    Gift giftOf(int x, int y) const {
        const gpu::DenoisePixel& p = picture_.pixels[at(x, y)];
        const double own = sumOf(p.mean), deviation = sumOf(glm::abs(glm::dvec3(p.deviation)));
        Gift gift;
        // Nearly all pixels are told by themselves.
        if (p.weight == 0 || deviation <= 0.5 * own) return gift;
        Neighbours same, all;
        double products = 0;
        forEachNear(x, y, [&](int u, int v) {
            if (u == x && v == y) return;
            const gpu::DenoisePixel& q = picture_.pixels[at(u, v)];
            const double weight = weightOf(x, y, u, v);
            same.add(weight, q);
            all.add(double(q.weight), q);
            products += weight * double(q.weight);
        });
        if (all.weights < kLeastNeighbours) return gift;
        if (same.weights < kLeastNeighbours)
            gift.foreign = (kLeastNeighbours - same.weights) / (all.weights - same.weights);
        // What weightOf(x, y, u, v, gift.foreign) would add up to.
        const double foreign = gift.foreign, familiar = 1 - foreign;
        const double sum = glm::mix(same.weights, all.weights, foreign);
        const double squares = familiar * familiar * same.squares +
                               2 * familiar * foreign * products + foreign * foreign * all.squares;
        const double mean = glm::mix(same.radiance, all.radiance, foreign) / sum;
        const double variance = glm::mix(same.variance, all.variance, foreign) / sum;
        const double limit =
            std::max(mean, 0.0) + kAllowed * std::sqrt(variance * (1 + squares / (sum * sum)));
        if (!(own > limit)) return gift;
        gift.keeps = float(limit / own);
        gift.light =
            (1.0 - gift.keeps) * glm::dvec3(p.mean) * glm::dvec3(picture_.albedo[at(x, y)]);
        return gift;
    }

    /// How much the pixel at (u, v) takes of what the one at (x, y) gives: by its own radiance as
    /// well, so that dark pixels stay dark and all become brighter by the same factor.
    double partOf(int x, int y, int u, int v) const {
        const gpu::DenoisePixel& q = picture_.pixels[at(u, v)];
        const double radiance = sumOf(glm::dvec3(q.mean) * glm::dvec3(picture_.albedo[at(u, v)]));
        return weightOf(x, y, u, v, gifts_[at(x, y)].foreign) * gifts_[at(u, v)].keeps *
               std::max(radiance, 0.0);
    }

    /// The parts of all that take.
    double partsAround(int x, int y) const {
        double sum = 0;
        if (gifts_[at(x, y)].keeps < 1)
            forEachNear(x, y, [&](int u, int v) { sum += partOf(x, y, u, v); });
        return sum;
    }

    /// Radiance over albedo that a pixel gets from those around it.
    glm::vec3 takenBy(int x, int y) const {
        glm::dvec3 taken(0.0);
        forEachNear(x, y, [&](int u, int v) {
            const Gift& gift = gifts_[at(u, v)];
            if (gift.keeps >= 1) return;
            // Where all is black it has its light back.
            const bool isOwn = u == x && v == y;
            taken += gift.parts > 0 ? partOf(u, v, x, y) / gift.parts * gift.light
                                    : (isOwn ? gift.light : glm::dvec3(0.0));
        });
        return taken / glm::dvec3(picture_.albedo[at(x, y)]);
    }

    Prepared& picture_;
    int width_, height_;
    std::vector<Gift> gifts_;
};

} // namespace

void limitOutliers(Prepared& picture) {
    Limiter(picture).run();
}

} // namespace stromboli::denoise
