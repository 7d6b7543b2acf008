// The choice of one of many emissive triangles, by what it is likely to bring to a surface: a walk down a
// tree of bounds (Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting", HPG 2018). host/kernel/light_tree.hpp builds it.

/// scene/model/emitters.hpp: trianglePower(), per unit of area.
float trianglePower(Material m) {
    return dot(m.emission, vec3(0.2126, 0.7152, 0.0722)) * (m.emitsBothSides != 0u ? 2.0 : 1.0);
}

/// Cosine and sine of max(a - b, 0), angles in [0, pi] given by theirs.
vec2 lessAngle(vec2 a, vec2 b) {
    return a.x >= b.x ? vec2(1.0, 0.0) : vec2(dot(a, b), a.y * b.x - a.x * b.y);
}

vec2 angleOfCosine(float c) { return vec2(c, sqrt(max(1.0 - c * c, 0.0))); }

/// A bound of the light that reaches a point with normal n: the power, over the squared distance, times the
/// largest cosines that lamp and surface can have anywhere in the node's sphere. Within the sphere
/// its radius is the distance, and cosines are 1. 0 only where nothing can arrive.
float likelyLight(LightNode node, vec3 p, vec3 n) {
    const vec3 d = node.center - p;
    const float distance2 = dot(d, d), radius2 = node.radius * node.radius;
    const vec3 w = d * inversesqrt(max(distance2, TINY));
    const float sin2Bound = min(radius2 / max(distance2, TINY), 1.0);
    const vec2 bound = vec2(sqrt(1.0 - sin2Bound), sqrt(sin2Bound));
    const float towards = -dot(decodeNormal(node.axis), w);
    const bool bothSides = (node.child & LIGHT_NODE_BOTH_SIDES) != 0u;
    const vec2 lamp = lessAngle(lessAngle(angleOfCosine(bothSides ? abs(towards) : towards),
                                          angleOfCosine(node.cosSpread)), bound);
    const vec2 surface = lessAngle(angleOfCosine(dot(n, w)), bound);
    const float cosines = distance2 > radius2 ? max(lamp.x, 0.0) * max(surface.x, 0.0) : 1.0;
    return node.power * cosines / max(max(distance2, radius2), TINY);
}

struct PickedLeaf {
    uint firstEntry, entryCount;
    float power;       ///< of the leaf
    float probability; ///< 0: no light reaches the point
    float u;           ///< what is left of the random number: uniform, independent of the choice
};

/// The walk takes its first ten steps, which use up some ten bits each way, with u.x, the rest with u.y.
const uint STEPS_OF_FIRST_NUMBER = 10u;
/// More levels than any tree has: 2^24 triangles.
const uint MOST_LIGHT_LEVELS = 24u;

PickedLeaf walkLightTree(uint root, vec3 p, vec3 n, vec2 numbers) {
    LightNode node = fetchLightNode(root, 0u);
    float probability = 1.0, u = numbers.x;
    for (uint level = 0u; level < MOST_LIGHT_LEVELS && (node.child & LIGHT_NODE_IS_LEAF) == 0u;
         ++level) {
        const uint child = node.child & LIGHT_NODE_CHILD_MASK;
        const LightNode a = fetchLightNode(root, child), b = fetchLightNode(root, child + 1u);
        const float ofA = likelyLight(a, p, n), sum = ofA + likelyLight(b, p, n);
        const float share = sum > 0.0 ? ofA / sum : 0.5;
        if (!(sum > 0.0)) probability = 0.0;
        if (level == STEPS_OF_FIRST_NUMBER) u = numbers.y;
        const bool first = u < share;
        if (first) node = a;
        else node = b;
        probability *= first ? share : 1.0 - share;
        u = first ? u / share : (u - share) / (1.0 - share);
        u = min(u, 1.0 - UNIT_ROUNDOFF);
    }
    return PickedLeaf(node.child & LIGHT_NODE_CHILD_MASK,
                      (node.child >> LIGHT_NODE_COUNT_SHIFT) & LIGHT_NODE_MOST_TRIANGLES,
                      node.power, probability, u);
}
