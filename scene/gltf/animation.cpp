#include "scene/gltf/animation.hpp"

#include "host/core/error.hpp"
#include "scene/gltf/accessors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace stromboli::gltf {
namespace {

/// Two key frames and how far the time is from the first to the second, in [0, 1].
struct Moment {
    size_t before = 0, after = 0;
    double share = 0, seconds = 0; ///< seconds: between the two
};

/// Before the first key frame and after the last, the pose stands still.
Moment momentAt(const Values& times, double seconds) {
    const auto first = times.numbers.begin();
    const auto after = size_t(std::upper_bound(first, times.numbers.end(), seconds) - first);
    if (after == 0) return {0, 0, 0, 0};
    if (after == times.count) return {after - 1, after - 1, 0, 0};
    const double span = times.numbers[after] - times.numbers[after - 1];
    return {after - 1, after, (seconds - times.numbers[after - 1]) / span, span};
}

using Numbers = std::vector<double>;

glm::dquat quaternionOf(const Numbers& v) {
    return {v[3], v[0], v[1], v[2]};
}

Numbers slerped(const Numbers& a, const Numbers& b, double share) {
    const glm::dquat q =
        glm::slerp(glm::normalize(quaternionOf(a)), glm::normalize(quaternionOf(b)), share);
    return {q.x, q.y, q.z, q.w};
}

/// glTF 2.0, appendix C: a cubic Hermite spline, whose tangents are by the second.
Numbers spline(const Numbers& a, const Numbers& leaving, const Numbers& arriving, const Numbers& b,
               const Moment& m) {
    const double t = m.share, t2 = t * t, t3 = t2 * t;
    Numbers value(a.size());
    for (size_t i = 0; i < a.size(); ++i)
        value[i] = (2 * t3 - 3 * t2 + 1) * a[i] + m.seconds * (t3 - 2 * t2 + t) * leaving[i] +
                   (3 * t2 - 2 * t3) * b[i] + m.seconds * (t3 - t2) * arriving[i];
    return value;
}

class SamplerReader {
  public:
    SamplerReader(const Document& document, const Element& at) : at_(at) {
        const size_t count = document.size("accessors");
        const std::optional<size_t> input = at.index("input", count),
                                    output = at.index("output", count);
        if (!input || !output) at.fail("lacks 'input' or 'output'");
        times_ = readValues(document, *input, 1);
        values_ = readValues(document, *output, 0);
        mode_ = at.text("interpolation", "LINEAR");
        if (mode_ != "LINEAR" && mode_ != "STEP" && mode_ != "CUBICSPLINE")
            at.fail("interpolation",
                    fmt::format("is '{}', expected LINEAR, STEP or CUBICSPLINE", mode_));
        if (times_.count == 0) at.fail("input", "has no key frames");
        for (size_t i = 0; i + 1 < times_.count; ++i)
            if (!(times_.numbers[i] < times_.numbers[i + 1])) at.fail("input", "does not grow");
    }

    /// `width`: numbers of a key frame; 0: whatever there is (weights).
    Numbers at(double seconds, size_t width, bool isRotation) const {
        const size_t triple = mode_ == "CUBICSPLINE" ? 3 : 1, frames = times_.count * triple;
        const size_t found = values_.numbers.size() / frames;
        if (values_.numbers.size() % frames != 0 || found == 0 || (width != 0 && found != width))
            at_.fail("output", fmt::format("has {} numbers for {} key frames",
                                           values_.numbers.size(), times_.count));
        const auto frame = [&](size_t i) {
            const auto first = values_.numbers.begin() + ptrdiff_t(i * found);
            return Numbers(first, first + ptrdiff_t(found));
        };
        const Moment m = momentAt(times_, seconds);
        if (triple == 3)
            return m.before == m.after ? frame(3 * m.before + 1)
                                       : spline(frame(3 * m.before + 1), frame(3 * m.before + 2),
                                                frame(3 * m.after), frame(3 * m.after + 1), m);
        if (mode_ == "STEP" || m.before == m.after) return frame(m.before);
        const Numbers a = frame(m.before), b = frame(m.after);
        if (isRotation) return slerped(a, b, m.share);
        Numbers mixed(found);
        for (size_t i = 0; i < found; ++i)
            mixed[i] = a[i] + m.share * (b[i] - a[i]);
        return mixed;
    }

  private:
    const Element at_;
    Values times_, values_;
    std::string mode_;
};

void animate(Context& context, const Element& animation, const Element& channel, double seconds,
             std::map<size_t, AnimatedNode>& nodes) {
    const std::optional<Element> target = channel.child("target");
    if (!target) channel.fail("has no 'target'");
    const std::optional<size_t> node = target->index("node", context.document.size("nodes"));
    const std::optional<size_t> number = channel.index("sampler", animation.size("samplers"));
    if (!number) channel.fail("has no 'sampler'");
    if (!node) return; // targets without a node belong to extensions, or to nothing
    const SamplerReader sampler(context.document, animation.strictly().item("samplers", *number));
    const std::string path = target->text("path");
    AnimatedNode& pose = nodes[*node];
    if (path == "translation" || path == "scale") {
        const Numbers v = sampler.at(seconds, 3, false);
        (path == "scale" ? pose.scale : pose.translation) = glm::dvec3(v[0], v[1], v[2]);
    } else if (path == "rotation") {
        pose.rotation = quaternionOf(sampler.at(seconds, 4, true));
    } else if (path == "weights") {
        pose.weights = sampler.at(seconds, 0, false);
    } else {
        context.report().ignore(fmt::format("animation of '{}'", path), "nodes have no such part");
    }
}

/// The nodes that an animation moves. What is wrong with it is said by whoever shows it.
std::set<size_t> nodesOf(const Document& document, const Element& animation) {
    std::set<size_t> nodes;
    for (const Element& channel : animation.items("channels"))
        try {
            const auto target = channel.strictly().child("target");
            const auto node = target ? target->index("node", document.size("nodes")) : std::nullopt;
            if (node) nodes.insert(*node);
        } catch (const SceneError&) {
        }
    return nodes;
}

/// The first animation, and those of other nodes than the ones before: programs write one for each
/// object that moves, and others for what one object may do.
std::vector<Element> shownTogether(const Document& document) {
    std::vector<Element> shown;
    std::set<size_t> moved;
    for (const Element& animation : document.root().items("animations")) {
        const std::set<size_t> nodes = nodesOf(document, animation);
        const bool isOther =
            std::ranges::none_of(nodes, [&](size_t n) { return moved.contains(n); });
        if (!shown.empty() && (nodes.empty() || !isOther)) continue;
        shown.push_back(animation);
        moved.insert(nodes.begin(), nodes.end());
    }
    return shown;
}

} // namespace

std::map<size_t, AnimatedNode> animatedNodes(Context& context) {
    std::map<size_t, AnimatedNode> nodes;
    const std::vector<Element> animations = context.document.root().items("animations");
    const std::optional<double> seconds = context.selection().seconds;
    if (!seconds) {
        context.report().ignore("animations", "what stands without them is shown (--at SECONDS)",
                                animations.size());
        return nodes;
    }
    if (animations.empty())
        context.document.root().fail(
            fmt::format("has no animation; {} asks for one",
                        context.selection().isFrame ? "--frames" : "--at"));
    const std::vector<Element> shown = shownTogether(context.document);
    context.report().ignore("animations", "the first one of each node is shown",
                            animations.size() - shown.size());
    for (const Element& animation : shown)
        for (const Element& channel : animation.items("channels"))
            try {
                animate(context, animation, channel.strictly(), *seconds, nodes);
            } catch (const SceneError& error) {
                context.report().replace(error, build::Shortfall::Parameter);
            }
    return nodes;
}

double animationEnd(const Document& document) {
    double end = 0;
    for (const Element& animation : shownTogether(document))
        for (const Element& sampler : animation.items("samplers"))
            try {
                const auto input = sampler.index("input", document.size("accessors"));
                if (!input) continue;
                const Values times = readValues(document, *input, 1);
                if (times.count > 0 && std::isfinite(times.numbers.back()))
                    end = std::max(end, times.numbers.back());
            } catch (const SceneError&) { // whoever shows the animation says what is wrong
            }
    return end;
}

} // namespace stromboli::gltf
