#include "host/kernel/light_shares.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stromboli {
namespace {

/// A light's own places count as much on what is known of it as so many places of all lights.
constexpr double kPlacesOfAll = 4;
/// What another segment of a light sample's ray costs, behind glass, by what the first one does.
constexpr double kCostBehindGlass = 2.5;
/// The part of the light samples that stays with the choice by power and place, in case that the
/// rays have missed something.
constexpr double kUnlearned = 0.1;
/// A light is hidden where no more of it arrives, by second moments, and so many places say so: a
/// lamp may be seen from few. By an alias table it keeps so much of its plain share.
constexpr double kHidden = 1.0 / 256;
constexpr size_t kPlacesOfHidden = 256;
constexpr double kShareOfHidden = 1.0 / 32;
/// The noise of a picture that light samples do not make, by the least that they can make, and what
/// a path takes at a surface beside its light sample, by what that takes: as in most rooms.
constexpr double kOtherNoise = 16, kOtherCost = 1.5;
/// Lights that no place is on the bright side of have so much of the largest share.
constexpr double kLeastShare = 0x1p-20;
/// So many lamps that take so much beside a sky are told apart by a tree. It takes a tenth more
/// time.
constexpr size_t kManyLamps = 8;
constexpr double kShareOfManyLamps = 0.25;
/// Fewer samples that take no light are not worth an entry of the table.
constexpr double kLeastNone = 1.0 / 16;
/// Gains below this are not worth a picture of other bytes.
constexpr double kLeastGain = 1.1;

void normalise(std::vector<double>& shares) {
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (double& s : shares)
        s /= sum;
}

/// How often each light is picked without factors: by an alias table as it says, by a tree about in
/// proportion to what it would bring with nothing in the way. All positive.
std::vector<double> plainShares(const WeighedLights& lights, LightChoice choice,
                                std::span<const KnownLight> known) {
    std::vector<double> shares;
    double most = 0;
    for (size_t i = 0; i < known.size(); ++i)
        most = std::max(
            most, shares.emplace_back(choice == LightChoice::Tree
                                          ? std::sqrt(known[i].sent)
                                          : irradianceAcross(lights.bounds[i], lights.radius)));
    for (double& s : shares)
        s = std::max(s, kLeastShare * most);
    normalise(shares);
    return shares;
}

/// Of light samples that pick each light with some probability: the second moment, and the cost by
/// that of one whose ray is not bent.
struct Sampling {
    double moment = 0, cost = 0;
    /// With the rest of a picture: what it takes to the same noise.
    double time(const Sampling& best) const {
        return (moment + kOtherNoise * best.moment) * (cost + kOtherCost);
    }
};

Sampling samplingBy(std::span<const double> shares, std::span<const double> moments,
                    std::span<const double> costs) {
    Sampling s;
    for (size_t i = 0; i < shares.size(); ++i) {
        if (moments[i] > 0) s.moment += moments[i] / shares[i];
        s.cost += shares[i] * costs[i];
    }
    return s;
}

/// The shares with which the picture takes the least time to the same noise, by Lagrange's rule:
/// roots of M / (V c + l), M being a light's moment, V all noise, c its cost by all, and l such
/// that they make up 1.
std::vector<double> bestShares(std::span<const double> moments, std::span<const double> costs) {
    std::vector<double> shares;
    for (const double m : moments)
        shares.push_back(std::sqrt(m));
    normalise(shares);
    const Sampling least = samplingBy(shares, moments, costs);
    for (int round = 0; round < 8; ++round) {
        const Sampling now = samplingBy(shares, moments, costs);
        const double noise = now.moment + kOtherNoise * least.moment, cost = now.cost + kOtherCost;
        const auto with = [&](double l) {
            std::vector<double> p;
            for (size_t i = 0; i < moments.size(); ++i)
                p.push_back(std::sqrt(moments[i] / (noise * costs[i] / cost + l)));
            return p;
        };
        const double cheapest = *std::ranges::min_element(costs);
        double low = -noise * cheapest / cost * (1 - 0x1p-20), high = 4 * least.moment;
        for (int halving = 0; halving < 40; ++halving) {
            const double middle = 0.5 * (low + high);
            const std::vector<double> p = with(middle);
            (std::accumulate(p.begin(), p.end(), 0.0) > 1 ? low : high) = middle;
        }
        shares = with(high);
        normalise(shares);
    }
    return shares;
}

bool isHidden(const KnownLight& light) {
    return light.places >= kPlacesOfHidden && light.arrived <= kHidden * light.sent;
}

/// Where samples of the lights that arrive take long, behind glass, the best shares that add up to
/// 1 leave most samples to a hidden light, whose rays are short. To take no light is cheaper still.
/// Returns how much is taken from the shares of hidden lights.
double takeFromHidden(std::vector<double>& shares, std::span<const double> plain,
                      std::span<const KnownLight> known) {
    double taken = 0;
    for (size_t i = 0; i < shares.size(); ++i) {
        if (!isHidden(known[i])) continue;
        const double kept = std::min(shares[i], kShareOfHidden * plain[i]);
        taken += shares[i] - kept;
        shares[i] = kept;
    }
    return taken;
}

/// To quarters of a power of two.
double rounded(double factor) {
    return std::exp2(std::round(4 * std::log2(factor)) / 4);
}

} // namespace

HowLightsArePicked bestPicks(const WeighedLights& lights, std::span<const KnownLight> known,
                             uint32_t sky) {
    double sent = 0, arrived = 0;
    for (const KnownLight& k : known)
        sent += k.sent, arrived += k.arrived;
    if (!(arrived > 0)) return {lights.plain};
    std::vector<double> moments, costs;
    for (const KnownLight& k : known) {
        const double own = double(k.places) / (double(k.places) + kPlacesOfAll);
        moments.push_back(k.sent *
                          std::lerp(arrived / sent, k.sent > 0 ? k.arrived / k.sent : 0, own));
        costs.push_back(1 + kCostBehindGlass * std::max(k.segments - 1, 0.0));
    }
    const std::vector<double> wanted = bestShares(moments, costs),
                              plain = plainShares(lights, lights.plain, known);
    const Sampling best = samplingBy(wanted, moments, costs);
    const auto timeBy = [&](std::span<const double> shares) {
        return samplingBy(shares, moments, costs).time(best);
    };
    const auto pickedBy = [&](LightChoice choice) {
        HowLightsArePicked how{choice};
        std::vector<double> shares;
        for (size_t i = 0; i < wanted.size(); ++i)
            shares.push_back(std::lerp(wanted[i], plain[i], kUnlearned));
        double none = 0;
        if (choice == LightChoice::Power) none = takeFromHidden(shares, plain, known);
        if (none >= kLeastNone) how.none = rounded(none);
        const std::vector<double> of = plainShares(lights, choice, known);
        for (size_t i = 0; i < of.size(); ++i)
            how.factors.push_back(rounded(shares[i] / of[i]));
        return how;
    };
    const HowLightsArePicked how = pickedBy(lights.plain);
    std::vector<double> shares;
    double sum = how.none;
    for (size_t i = 0; i < plain.size(); ++i)
        sum += shares.emplace_back(plain[i] * how.factors[i]);
    for (double& s : shares)
        s /= sum;
    if (timeBy(plain) < kLeastGain * timeBy(shares)) return {lights.plain};
    const bool areMany = sky != gpu::NO_LIGHT && shares.size() > kManyLamps &&
                         1 - how.none / sum - shares[sky] >= kShareOfManyLamps;
    return areMany ? pickedBy(LightChoice::Tree) : how;
}

} // namespace stromboli
