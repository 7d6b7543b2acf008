#include "host/denoise/reference_filter.hpp"

#include "host/denoise/taps.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::denoise {
namespace {

constexpr int kCandidates = 3;

struct Pilot {
    glm::dvec3 first{0.0}, second{0.0}; ///< of either half
    double variance = 0;                ///< of either, summed over channels
    double noise = 0;                   ///< mean squared deviation of a pixel, by channel
};

/// What a candidate changes of the mean, and half of what its two halves differ by.
struct Candidate {
    glm::dvec3 change{0.0}, deviation{0.0};
};

/// Sums over pixels, relative to their radiance and noise.
struct Moments {
    std::array<std::array<double, kCandidates>, kCandidates> product{};
    std::array<double, kCandidates> taken{};
    double error = 0, pixels = 0;

    void operator+=(const Moments& other) {
        for (int a = 0; a < kCandidates; ++a) {
            for (int b = 0; b < kCandidates; ++b)
                product[a][b] += other.product[a][b];
            taken[a] += other.taken[a];
        }
        error += other.error;
        pixels += other.pixels;
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
                variance += weight * 2 * squareOf(deviation);
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
        std::array<Sum, kCandidates> first, second;
        const glm::vec3 scales[] = {gpu::DENOISE_SCALE0, gpu::DENOISE_SCALE1, gpu::DENOISE_SCALE2};
        for (const gpu::DenoiseTap& tap : taps_) {
            const int dx = int(tap.dx), dy = int(tap.dy);
            if (!isInside(x + dx, y + dy)) continue;
            const gpu::DenoisePixel& q = picture_.pixels[at(x + dx, y + dy)];
            const Pilot& other = pilots_[at(x + dx, y + dy)];
            const double variance = pilot.variance + other.variance + 1e-30;
            const auto excess = [&](const glm::dvec3& difference) {
                return std::max(squareOf(difference) / variance - 1, 0.0);
            };
            const double a = excess(other.first - pilot.first);
            const double b = excess(other.second - pilot.second);
            const double times = double(q.weight) * tap.times;
            const glm::dvec3 mean(q.mean), deviation(q.deviation);
            for (int c = 0; c < kCandidates; ++c) {
                const double same =
                    double(tap.exponents[c]) + 0.5 * unlike(own, q, dx, dy, scales[c]);
                const double color = gpu::DENOISE_COLOR_SCALE[c];
                first[size_t(c)].add(times * std::exp(-same - color * a), mean + deviation);
                second[size_t(c)].add(times * std::exp(-same - color * b), mean - deviation);
            }
        }
        std::array<Candidate, kCandidates> candidates;
        for (size_t c = 0; c < kCandidates; ++c) {
            const glm::dvec3 f = first[c].mean(), s = second[c].mean();
            candidates[c] = {0.5 * (f + s) - glm::dvec3(own.mean), 0.5 * (f - s)};
        }
        return candidates;
    }

    /// What a squared error counts for in relMSE, by channel.
    glm::dvec3 countOf(size_t pixel) const {
        const glm::dvec3 albedo(picture_.albedo[pixel]);
        const glm::dvec3 radiance =
            (glm::dvec3(picture_.pixels[pixel].mean) + candidates_[pixel][2].change) * albedo;
        return albedo * albedo / (radiance * radiance + floor_);
    }

    double noiseOf(size_t pixel) const {
        return sumOf(countOf(pixel)) * pilots_[pixel].noise + double(gpu::DENOISE_LEAST_NOISE);
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
                const double product =
                    (1 + double(gpu::DENOISE_RIDGE)) * m.product[size_t(a)][size_t(a)] + 1e-30;
                shares[a] = std::clamp(taken / product, 0.0, std::max(room, 0.0));
            }
        return shares;
    }

    ReferenceResult resultOf(size_t pixel, const Moments& window) const {
        const gpu::DenoisePixel& own = picture_.pixels[pixel];
        ReferenceResult result;
        result.shares = sharesOf(window);
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
        const double noise = noiseOf(pixel);
        result.own = moments_[pixel].errorWith(s) * noise / 3.0;
        result.window = window.errorWith(s) / std::max(window.pixels, 1.0) * noise / 3.0;
        result.ownVariance = own.weight * glm::dot(countOf(pixel), left * left) / 3;
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
