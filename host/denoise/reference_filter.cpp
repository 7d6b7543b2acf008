#include "host/denoise/reference_filter.hpp"

#include "host/denoise/reference_regression.hpp"
#include "host/denoise/taps.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::denoise {
namespace {

/// A mean that is strict about what it takes for alike, the regression, and a wide mean.
constexpr int kCandidates = 3;
constexpr size_t kStrict = 0, kRegression = 1, kWide = 2;

/// Sums over pixels, relative to their radiance and noise.
struct Moments {
    std::array<std::array<double, kCandidates>, kCandidates> product{};
    std::array<double, kCandidates> taken{};
    double error = 0, pixels = 0, spread = 0;

    void operator+=(const Moments& other) {
        for (int a = 0; a < kCandidates; ++a) {
            for (int b = 0; b < kCandidates; ++b)
                product[a][b] += other.product[a][b];
            taken[a] += other.taken[a];
        }
        error += other.error;
        pixels += other.pixels;
        spread += other.spread;
    }
    /// If these pixels had so many times the noise, and candidates the errors that they have.
    Moments withNoise(double times) const {
        Moments m = *this;
        for (int a = 0; a < kCandidates; ++a) {
            for (int b = 0; b < kCandidates; ++b)
                m.product[a][b] += (times - 1) * (taken[a] + taken[b] - error);
            m.taken[a] *= times;
        }
        m.error *= times;
        return m;
    }
    /// The two parts of the squared error that is left with these shares.
    glm::dvec2 errorWith(const glm::dvec3& shares) const {
        glm::dvec2 left(error, 0);
        for (int a = 0; a < kCandidates; ++a) {
            left.x -= 2 * shares[a] * taken[size_t(a)];
            for (int b = 0; b < kCandidates; ++b)
                left.y += shares[a] * shares[b] * product[size_t(a)][size_t(b)];
        }
        return left;
    }
};

double squareOf(const glm::dvec3& v) {
    return glm::dot(v, v);
}

class HostFilter {
  public:
    explicit HostFilter(const Prepared& picture)
        : picture_(picture), width_(int(picture.width)), height_(int(picture.height)),
          taps_(taps()), pilots_(picture.pixels.size()), candidates_(picture.pixels.size()),
          moments_(picture.pixels.size()) {
        floor_ = picture.floor * picture.floor;
    }

    std::vector<ReferenceResult> run() {
        forEachPixel([&](int x, int y) { pilots_[at(x, y)] = pilotOf(x, y); });
        forEachPixel([&](int x, int y) {
            candidates_[at(x, y)] = candidatesOf(x, y);
            moments_[at(x, y)] = momentsOf(at(x, y));
        });
        std::vector<ReferenceResult> results(moments_.size());
        forEachPixel(
            [&](int x, int y) { results[at(x, y)] = resultOf(at(x, y), windowAround(x, y)); });
        return results;
    }

  private:
    static constexpr int kWindow = gpu::DENOISE_WINDOW_REACH;

    size_t at(int x, int y) const { return size_t(y) * size_t(width_) + size_t(x); }
    bool isInside(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }

    template <class Function>
    void forEachPixel(const Function& function) {
        tbb::parallel_for(0, height_, [&](int y) {
            for (int x = 0; x < width_; ++x)
                function(x, y);
        });
    }

    double unlike(const gpu::DenoisePixel& p, const gpu::DenoisePixel& q, int dx, int dy,
                  const glm::vec3& scale) const {
        const glm::dvec3 differences = featureDifferences(p, q, dx, dy);
        return glm::dot(differences, glm::dvec3(scale));
    }

    Pilot pilotOf(int x, int y) const {
        const gpu::DenoisePixel& own = picture_.pixels[at(x, y)];
        double sum = 0, squares = 0, variance = 0;
        Pilot pilot;
        constexpr int kReachOfPilot = gpu::DENOISE_PILOT_REACH;
        for (int v = y - kReachOfPilot; v <= y + kReachOfPilot; ++v)
            for (int u = x - kReachOfPilot; u <= x + kReachOfPilot; ++u) {
                if (!isInside(u, v)) continue;
                const gpu::DenoisePixel& q = picture_.pixels[at(u, v)];
                const double weight = q.weight * std::exp(-0.5 * unlike(own, q, u - x, v - y,
                                                                        gpu::DENOISE_PILOT_SCALE));
                const glm::dvec3 mean(q.mean), deviation(q.deviation);
                sum += weight, squares += weight * weight;
                pilot.first += weight * (mean + deviation);
                pilot.second += weight * (mean - deviation);
                // A deviation is one number, and may be small by chance; halves know of clumps that
                // samples hide.
                variance += weight * 2 * std::max(squareOf(deviation), double(q.variance));
            }
        if (sum == 0) return {};
        return {pilot.first / sum, pilot.second / sum, variance / sum * squares / (sum * sum),
                variance / sum / 6};
    }

    std::array<Candidate, kCandidates> candidatesOf(int x, int y) const {
        const gpu::DenoisePixel& own = picture_.pixels[at(x, y)];
        const Pilot& pilot = pilots_[at(x, y)];
        struct Sum {
            glm::dvec3 radiance{0.0};
            double weight = 0;
            void add(double w, const glm::dvec3& r) { radiance += w * r, weight += w; }
            glm::dvec3 mean() const { return weight > 0 ? radiance / weight : glm::dvec3(0.0); }
        };
        Sum firstStrict, secondStrict, firstWide, secondWide;
        for (const gpu::DenoiseTap& tap : taps_) {
            const int dx = int(tap.dx), dy = int(tap.dy);
            if (!isInside(x + dx, y + dy)) continue;
            const gpu::DenoisePixel& q = picture_.pixels[at(x + dx, y + dy)];
            const Pilot& other = pilots_[at(x + dx, y + dy)];
            const glm::dvec2 unlikely = excess(pilot, other);
            const double times = double(q.weight) * tap.times;
            const double strict =
                double(tap.strict) + 0.5 * unlike(own, q, dx, dy, gpu::DENOISE_STRICT_SCALE);
            const double wide =
                double(tap.wide) + 0.5 * unlike(own, q, dx, dy, gpu::DENOISE_WIDE_SCALE);
            const glm::dvec2 a = glm::exp(-strict - double(gpu::DENOISE_STRICT_COLOR) * unlikely);
            const glm::dvec2 b = glm::exp(-wide - double(gpu::DENOISE_LOOSE_COLOR) * unlikely);
            const glm::dvec3 mean(q.mean), deviation(q.deviation);
            firstStrict.add(times * a.x, mean + deviation);
            secondStrict.add(times * a.y, mean - deviation);
            firstWide.add(times * b.x, mean + deviation);
            secondWide.add(times * b.y, mean - deviation);
        }
        const auto of = [&](const glm::dvec3& f, const glm::dvec3& s) {
            return Candidate{0.5 * (f + s) - glm::dvec3(own.mean), 0.5 * (f - s)};
        };
        std::array<Candidate, kCandidates> candidates;
        candidates[kStrict] = of(firstStrict.mean(), secondStrict.mean());
        candidates[kRegression] = regressionAt(picture_, pilots_, x, y);
        candidates[kWide] = of(firstWide.mean(), secondWide.mean());
        return candidates;
    }

    /// What a squared error counts for in relMSE, by channel, where this is the radiance over
    /// albedo.
    glm::dvec3 countAt(size_t pixel, const glm::dvec3& radiance) const {
        const glm::dvec3 albedo(picture_.albedo[pixel]);
        return albedo * albedo / (radiance * radiance * albedo * albedo + floor_);
    }

    /// For the choice of shares: by the regression.
    glm::dvec3 countOf(size_t pixel) const {
        return countAt(pixel, glm::dvec3(picture_.pixels[pixel].mean) +
                                  candidates_[pixel][kRegression].change);
    }

    /// For what is said of the error: by what the wide candidate makes of either half, on the mean.
    glm::dvec3 statedCountOf(size_t pixel) const {
        const Candidate& wide = candidates_[pixel][kWide];
        const glm::dvec3 even = glm::dvec3(picture_.pixels[pixel].mean) + wide.change;
        return 0.5 *
               (countAt(pixel, even + wide.deviation) + countAt(pixel, even - wide.deviation));
    }

    double noiseOf(size_t pixel) const {
        return std::sqrt(sumOf(countOf(pixel)) * pilots_[pixel].noise +
                         double(gpu::DENOISE_LEAST_NOISE));
    }

    Moments momentsOf(size_t pixel) const {
        const gpu::DenoisePixel& own = picture_.pixels[pixel];
        const std::array<Candidate, kCandidates>& c = candidates_[pixel];
        const glm::dvec3 counts = double(own.weight) / noiseOf(pixel) * countOf(pixel);
        const glm::dvec3 deviation(own.deviation);
        Moments m;
        for (size_t a = 0; a < kCandidates; ++a) {
            for (size_t b = 0; b < kCandidates; ++b)
                m.product[a][b] = glm::dot(counts, c[a].change * c[b].change);
            m.taken[a] = glm::dot(counts, deviation * (deviation - c[a].deviation));
        }
        m.error = glm::dot(counts, deviation * deviation);
        m.pixels = own.weight;
        m.spread = sumOf(counts) * double(own.variance) / 3;
        return m;
    }

    /// All pixels of the window but the one in its middle.
    Moments windowAround(int x, int y) const {
        Moments window;
        for (int v = y - kWindow; v <= y + kWindow; ++v)
            for (int u = x - kWindow; u <= x + kWindow; ++u)
                if (isInside(u, v) && (u != x || v != y)) window += moments_[at(u, v)];
        return window;
    }

    glm::dvec3 sharesOf(const Moments& m) const {
        glm::dvec3 shares(0.0);
        for (int sweep = 0; sweep < gpu::DENOISE_SWEEPS; ++sweep)
            for (int a = 0; a < kCandidates; ++a) {
                double taken = m.taken[size_t(a)], room = 1;
                for (int b = 0; b < kCandidates; ++b)
                    if (b != a) {
                        taken -= m.product[size_t(a)][size_t(b)] * shares[b];
                        room -= shares[b];
                    }
                // What is left of a product is negative where the candidate follows the noise.
                const double own = m.product[size_t(a)][size_t(a)];
                const double best =
                    own >= 0 ? taken / ((1 + double(gpu::DENOISE_RIDGE)) * own + 1e-30) : 0;
                shares[a] = std::clamp(best, 0.0, std::max(room, 0.0));
            }
        return shares;
    }

    /// By what the pixel's noise exceeds, or falls short of, that of its window; samples that have
    /// met no light say nothing of it.
    double noisinessOf(size_t pixel, const Moments& window) const {
        const gpu::DenoisePixel& own = picture_.pixels[pixel];
        const bool isSilent = own.variance == 0 && own.mean == glm::vec3(0.0f);
        const double around = window.spread / std::max(window.pixels, 1.0);
        if (isSilent || around <= 0) return 1;
        return std::max(std::sqrt(moments_[pixel].spread / around),
                        double(gpu::DENOISE_LEAST_NOISINESS));
    }

    ReferenceResult resultOf(size_t pixel, const Moments& window) const {
        const gpu::DenoisePixel& own = picture_.pixels[pixel];
        ReferenceResult result;
        result.shares = sharesOf(window.withNoise(noisinessOf(pixel, window)));
        glm::dvec3 seen = result.shares;
        if (own.weight == 0) seen.z = 1 - seen.x - seen.y;
        result.mean = own.mean;
        for (int a = 0; a < kCandidates; ++a)
            result.mean += seen[a] * candidates_[pixel][size_t(a)].change;
        // Half of what the blends of the two halves differ by: the noise that is left.
        const glm::dvec3& s = result.shares;
        glm::dvec3 left = (1 - s.x - s.y - s.z) * glm::dvec3(own.deviation);
        for (int a = 0; a < kCandidates; ++a)
            left += s[a] * candidates_[pixel][size_t(a)].deviation;
        const double noise = noiseOf(pixel) * sumOf(statedCountOf(pixel)) / sumOf(countOf(pixel));
        result.own = moments_[pixel].errorWith(s) * noise / 3.0;
        result.window = window.errorWith(s) / std::max(window.pixels, 1.0) * noise / 3.0;
        result.ownVariance = own.weight * glm::dot(statedCountOf(pixel), left * left) / 3;
        return result;
    }

    const Prepared& picture_;
    int width_, height_;
    double floor_;
    std::vector<gpu::DenoiseTap> taps_;
    std::vector<Pilot> pilots_;
    std::vector<std::array<Candidate, kCandidates>> candidates_;
    std::vector<Moments> moments_;
};

} // namespace

std::vector<ReferenceResult> filterOnHost(const Prepared& picture) {
    return HostFilter(picture).run();
}

} // namespace stromboli::denoise
