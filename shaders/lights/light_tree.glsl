// The choice of one of many lights by what it is likely to bring to a surface: a walk down a tree of
// bounds (Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting",
// HPG 2018). host/kernel/light_tree.hpp builds it.

/// Cosine and sine of max(a - b, 0), angles in [0, pi] given by theirs.
vec2 lessAngle(vec2 a, vec2 b) {
    return a.x >= b.x ? vec2(1.0, 0.0) : vec2(dot(a, b), a.y * b.x - a.x * b.y);
}

vec2 angleOfCosine(float c) { return vec2(c, sqrt(max(1.0 - c * c, 0.0))); }

LightBounds boundsOf(LightNode node) {
    return LightBounds(node.center, radiusOf(node), powerOf(node), decodeNormal(node.axis), angleOfCosine(node.cosSpread), node.flags);
}

bool isGroup(uint group, uint wanted) {
    return (LIGHT_GROUPS & 1u << wanted) != 0u && (LIGHT_GROUPS == 1u << wanted || group == wanted);
}

/// Whether nodes of the tree have cones that are read: of light from infinity, or of finite ones as below.
bool lightsHaveCones() { return (LIGHT_KINDS & ~(1u << LIGHT_POINT | 1u << LIGHT_SPHERE)) != 0u; }

/// Whether some light that is not infinitely far sends more to one side than to another: point lights and spheres do not.
bool finiteLightsHaveCones() {
    const uint infinite = 1u << LIGHT_AMBIENT | 1u << LIGHT_ENVIRONMENT | 1u << LIGHT_DIRECTIONAL;
    return (LIGHT_KINDS & ~(1u << LIGHT_POINT | 1u << LIGHT_SPHERE | infinite)) != 0u;
}

bool hasSeveralGroups() { return (LIGHT_GROUPS & (LIGHT_GROUPS - 1u)) != 0u; }

bool hasGroup(uint group) { return (LIGHT_GROUPS & 1u << group) != 0u; }

/// The largest cosine of a light's normal that the node's lights can turn towards w (unit, from the surface to
/// them), as they are seen within the angle `bound` of it; or whether spot lights can shine there.
float turnedTowards(LightBounds node, vec3 w, vec2 bound) {
    const float towards = -dot(node.axis, w);
    const bool bothSides = (node.flags & LIGHT_NODE_BOTH_SIDES) != 0u;
    const vec2 angle = lessAngle(
        lessAngle(angleOfCosine(bothSides ? abs(towards) : towards), node.spread), bound);
    // An angle that is left is one out of the cone of normals.
    const bool outside = (node.flags & LIGHT_NODE_SHARP) != 0u && angle.x < 1.0;
    return outside ? 0.0 : max(angle.x, 0.0);
}

/// The weight of near lights that send the same to all sides, d away: the power over the squared distance, times
/// (n . d + r) / (|d| + r). That is the cosine itself for a single point, else one between the cosines in the node's
/// sphere, and 0 where all of the sphere is behind the surface; likelyLight()'s bound takes another square root.
float likelyLightWithoutCone(vec3 d, vec3 n, float power, float radius) {
    const float distance2 = dot(d, d), reach = (isNowhere(n) ? sqrt(distance2) : dot(n, d)) + radius;
    const float square = larger(distance2, radius * radius);
    // Beyond the cube root of what floats hold weights are no longer those, but not 0.
    const float cube = smaller(larger((sqrt(distance2) + radius) * square, TINY), INFINITE_DISTANCE);
    return reach > 0.0 ? power * reach / cube : 0.0;
}

/// A bound of the irradiance (luminance) that the node's lights bring to a point with unit normal n. Of
/// near lights: the power over the squared distance, times the largest cosines that light and surface can
/// have anywhere in the node's sphere; within the sphere the distance is its radius, and cosines are 1, as that of a
/// point in a medium is everywhere.
/// 0 only where nothing can arrive.
float likelyLight(LightBounds node, uint group, vec3 p, vec3 n) {
    const float power = node.power, radius = node.radius;
    if (LIGHT_GROUPS == 1u << LIGHT_GROUP_INFINITE)
        return isNowhere(n) ? power : power * max(lessAngle(angleOfCosine(-dot(n, node.axis)), node.spread).x, 0.0);
    if (LIGHT_GROUPS == 1u << LIGHT_GROUP_NEAR && !lightsHaveCones())
        return likelyLightWithoutCone(node.center - p, n, power, radius);
    const bool infinite = isGroup(group, LIGHT_GROUP_INFINITE);
    const vec3 d = infinite ? -node.axis : node.center - p;
    const float distance2 = infinite ? 1.0 : dot(d, d), radius2 = radius * radius;
    const bool within = !infinite && distance2 <= radius2;
    const float scale = infinite ? 1.0 : 1.0 / max(max(distance2, radius2), TINY);
    // Cosine and sine of the angle at which the sphere is seen, both times the distance.
    const float gap = infinite ? node.spread.x : sqrt(max(distance2 - radius2, 0.0));
    const float reach = infinite ? node.spread.y : radius;
    // The least angle between n and a direction to the sphere, as in lessAngle().
    const float towards = dot(n, d);
    const float across = sqrt(max(distance2 - towards * towards, 0.0));
    const float cosine = within || isNowhere(n) || towards >= gap ? 1.0 : (towards * gap + across * reach) * scale;
    float lightCosine = 1.0;
    if (finiteLightsHaveCones() && !infinite && !within) {
        const float inverse = inversesqrt(max(distance2, TINY));
        lightCosine = turnedTowards(node, d * inverse, vec2(gap, reach) * inverse);
    }
    const float falloff = isGroup(group, LIGHT_GROUP_NEAR) ? scale : 1.0;
    return power * lightCosine * max(cosine, 0.0) * falloff;
}

// --- Random choices between two ------------------------------------------------------------------

/// How many of the 2^31 values choose the first of two, whose weights are not negative; 0 and 2^31 only
/// where one of them has no weight.
uint valuesOfFirst(float first, float second) {
    // By the lesser of the two, of which a float has more digits.
    const float lesser = smaller(first, second);
    // At most a half, also where both overflow.
    const int share = clamp(int(2147483648.0 * (lesser / (first + second))), 1, 0x40000000);
    const uint values = lesser > 0.0 ? uint(share) : 0u;
    return first < second ? values : 0x80000000u - values;
}

/// values of 2^31 as a probability.
float shareOf(uint values) { return float(values) * (1.0 / 2147483648.0); }

// --- The walk ---------------------------------------------------------------------------------------
// Walks that choose at random and walks along the trail to a given light are one function, and siblings and
// groups are weighed in loops, so that the code stands in the kernel once: a driver takes it in before it
// knows which of it the scene needs.

struct LightWalk {
    uint group;
    uint lights; ///< of the group
    uint first;  ///< number of the group's first light
    uint node;   ///< where the walk is, as LightNode numbers them
    float probability;
};

bool isLeaf(LightWalk walk) { return walk.node >= walk.lights; }

uint lightsInGroup(const Frame frame, uint group) {
    return group == 0u ? frame.lightsInGroup0
                       : (group == 1u ? frame.lightsInGroup1 : frame.lightsInGroup2);
}

/// The walk at the root of a group.
LightWalk atRoot(const Frame frame, uint group) {
    LightWalk walk = LightWalk(group, lightsInGroup(frame, group), 0u, 1u, 1.0);
    if (group > 0u) walk.first = frame.lightsInGroup0;
    if (group > 1u) walk.first += frame.lightsInGroup1;
    return walk;
}

float likelyLight(const Frame frame, LightWalk walk, uint node, vec3 p, vec3 n) {
    return likelyLight(boundsOf(fetchLightNode(frame, 2u * walk.first + node, lightsHaveCones())), walk.group, p, n);
}

/// Takes the first of two choices, or not, and notes the probability; where neither has any weight, that is 0.
/// follows: goes where `wantsFirst` says, not at random.
bool take(inout float probability, float first, float second, bool follows, bool wantsFirst,
          inout ChoiceNumber c) {
    const uint ofFirst = valuesOfFirst(first, second);
    const bool takesFirst = follows ? wantsFirst : choosesFirst(c, ofFirst);
    const float share = shareOf(takesFirst ? ofFirst : 0x80000000u - ofFirst);
    probability *= first + second > 0.0 ? share : 0.0;
    return takesFirst;
}

/// To the root of a group: the first group against the other two, then the second against the third, of those that the scene has.
LightWalk enterGroup(const Given given, vec3 p, vec3 n, bool follows, LightEntry to, inout ChoiceNumber c) {
    // The only one, if it is: of the bits 1, 2 and 4.
    if (!hasSeveralGroups()) return atRoot(given.frame, LIGHT_GROUPS >> 1u);
    float likely[LIGHT_GROUP_COUNT];
    for (uint group = 0u; group < LIGHT_GROUP_COUNT; ++group) {
        likely[group] = 0.0;
        if (hasGroup(group) && lightsInGroup(given.frame, group) > 0u)
            likely[group] = likelyLight(given.roots.all[group].bounds, group, p, n);
    }
    float probability = 1.0;
    bool isFirst = false, isSecond = hasGroup(1u);
    if (hasGroup(0u)) isFirst = take(probability, likely[0], likely[1] + likely[2], follows, to.group == 0u, c);
    if (hasGroup(1u) && hasGroup(2u) && !isFirst)
        isSecond = take(probability, likely[1], likely[2], follows, to.group == 1u, c);
    const uint group = isFirst ? 0u : (isSecond ? 1u : 2u);
    LightWalk walk = atRoot(given.frame, group);
    walk.probability = probability;
    return walk;
}

/// One step down.
void descend(const Frame frame, inout LightWalk walk, vec3 p, vec3 n, bool follows, bool wantsFirst,
             inout ChoiceNumber c) {
    const uint child = 2u * walk.node;
    float likely[2];
    for (uint i = 0u; i < 2u; ++i)
        likely[i] = likelyLight(frame, walk, child + i, p, n);
    walk.node = take(walk.probability, likely[0], likely[1], follows, wantsFirst, c) ? child : child + 1u;
}

/// From the roots to a light, as seen from p with unit normal n: at random, or to a given one. Returns the
/// light's number; the probability is 0 where no light reaches the point.
uint walkLightTree(const Given given, vec3 p, vec3 n, bool follows, LightEntry to, inout ChoiceNumber c,
                   out float probability) {
    LightWalk walk = enterGroup(given, p, n, follows, to, c);
    for (uint level = 0u; LIGHT_TREES_BRANCH && level < MOST_LIGHT_LEVELS && !isLeaf(walk); ++level)
        descend(given.frame, walk, p, n, follows, (to.trail >> level & 1u) == 0u, c);
    probability = walk.probability;
    return walk.first + walk.node - walk.lights;
}
