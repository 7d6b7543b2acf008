// Floating-point facts the kernel relies on (docs/theory/numerics.md has the derivations).

const float PI = 3.14159265358979;
const float INV_PI = 0.318309886183791;
/// Unit round-off of float: 2^-24.
const float UNIT_ROUNDOFF = 5.9604644775390625e-8;
/// Below this a divisor is taken for none: 2^-120.
const float TINY = 7.52316384526264e-37;
/// Farther than any hit: rays without an end.
const float INFINITE_DISTANCE = 3.402823466e38;

/// Knuth's TwoSum: sum + error is a + b exactly.
void twoSum(vec3 a, vec3 b, out vec3 sum, out vec3 error) {
    precise vec3 s = a + b;
    precise vec3 bRounded = s - a;
    precise vec3 e = (a - (s - bRounded)) + (b - bRounded);
    sum = s;
    error = e;
}

/// Adds x to the two-float sum (high, low). The low part takes over what rounding left and hands
/// what has grown above the rounding of the high part back to it: summed on its own it would drift
/// as any float sum does (by 0.2 % in 1e7 samples of 0.1).
void addCompensated(inout vec3 high, inout vec3 low, vec3 x) {
    vec3 sum, error;
    twoSum(high, x, sum, error);
    precise vec3 rest = low + error;
    precise vec3 newHigh = sum + rest; // Dekker's FastTwoSum: |rest| is below |sum|
    precise vec3 newLow = rest - (newHigh - sum);
    high = newHigh;
    low = newLow;
}

#include "robust/origin_offset.glsl"

/// Moves p that far, to the side of w.
vec3 offsetOrigin(vec3 p, float error, vec3 n, vec3 w) {
    const float distance = offsetLength(error, n);
    return p + (dot(n, w) < 0.0 ? -distance : distance) * n;
}

/// The larger and the smaller of two numbers that are not negative, and no NaN: patterns of bits compare as the
/// numbers do (docs/theory/kernel.md, "Arithmetic").
float larger(float a, float b) {
    return intBitsToFloat(max(floatBitsToInt(a), floatBitsToInt(b)));
}
float smaller(float a, float b) {
    return intBitsToFloat(min(floatBitsToInt(a), floatBitsToInt(b)));
}

/// The largest component of a vector whose components are not negative.
float largestComponent(vec3 v) { return larger(v.x, larger(v.y, v.z)); }

/// Bound of the error of a point interpolated from corners whose weighted magnitudes sum to `sum`,
/// and of the distance at which a neighbouring triangle's test finds it. The test mixes the
/// components, so the largest one counts for all of them: a plane through a zero coordinate has no
/// error of its own there (docs/theory/numerics.md).
float interpolationError(vec3 sum) { return 32.0 * UNIT_ROUNDOFF * largestComponent(sum); }

/// Bound of the error of a point put on a sphere: that of its unit normal, times the radius, and that of the sum.
float sphereError(vec3 center, float radius) {
    return (16.0 * UNIT_ROUNDOFF) * radius + (4.0 * UNIT_ROUNDOFF) * largestComponent(abs(center));
}

/// Cosine and sine of x quarter turns, x in [0, 4]; absolute error below 2^-23 on any device, where Vulkan
/// promises 2^-11 of cos() and sin(). Near-minimax polynomials, fitted for this, in the square of the
/// distance to the nearest quarter turn: relative error 3.3e-9 (sine), absolute 3.3e-8 (cosine).
vec2 cosSin(float x) {
    const float turns = floor(x + 0.5), r = x - turns, q = r * r;
    const float odd =
        r * (1.57079632 + q * (-0.64596346 + q * (0.079680033 + q * -0.0046016579)));
    const float even = 1.0 + q * (-1.23369795 + q * (0.253606361 + q * -0.0204262489));
    const uint n = uint(int(turns));
    const bool swaps = (n & 1u) != 0u;
    const uvec2 sign = uvec2(n + 1u, n) << 30u & 0x80000000u;
    return uintBitsToFloat(floatBitsToUint(swaps ? vec2(odd, even) : vec2(even, odd)) ^ sign);
}

/// x / d and x % d, for x below 2^31 and quotients below 2^21: by floats, as lavapipe divides integers lane by lane. The
/// quotient of floats is off by less than 1, so that one correction makes it exact.
uvec2 quotientAndRest(uint x, uint d) {
    const int divisor = int(d), guess = int(float(int(x)) / float(divisor)), rest = int(x) - guess * divisor;
    const int off = rest < 0 ? -1 : (rest >= divisor ? 1 : 0);
    return uvec2(guess + off, rest - off * divisor);
}

/// v / |v|, within 4 ulp: one division, where normalize() is compiled into three.
vec3 unit(vec3 v) { return v * inversesqrt(dot(v, v)); }

/// v times a power of two, exactly, such that its largest component is in [1, 2).
vec3 scaledToOne(vec3 v) {
    const uint exponent = floatBitsToUint(largestComponent(abs(v))) >> 23u;
    return v * uintBitsToFloat((254u - exponent) << 23u);
}

/// Unit normal of the plane of edges a and b. Scaled first: the cross product of edges above 1e9 or
/// below 1e-9 would leave the range in which a length can be squared.
/// Divided by the length, not unit(): the normal of a plane along two axes is exact then.
vec3 planeNormal(vec3 a, vec3 b) { return normalize(cross(scaledToOne(a), scaledToOne(b))); }

/// Orthonormal frame about unit n (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
struct ShadingFrame {
    vec3 x, y, z;
};

ShadingFrame makeFrame(vec3 n) {
    const float s = n.z >= 0.0 ? 1.0 : -1.0;
    const float a = -1.0 / (s + n.z);
    const float b = n.x * n.y * a;
    return ShadingFrame(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x),
                        vec3(b, s + n.y * n.y * a, -n.y), n);
}

vec3 toWorld(ShadingFrame f, vec3 v) { return v.x * f.x + v.y * f.y + v.z * f.z; }
vec3 toLocal(ShadingFrame f, vec3 v) { return vec3(dot(v, f.x), dot(v, f.y), dot(v, f.z)); }
