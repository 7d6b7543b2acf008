#version 460
#extension GL_GOOGLE_include_directive : require
// Writes back every field of every structure of shaders/shared, in the order of its declaration;
// the index of each is 1, so that the stride counts too.
#include "prelude.glsl"
#include "include/film.glsl"

layout(set = 0, binding = BINDING_STATUS, std430) buffer StatusBuffer { DispatchStatus status; };
layout(set = 0, binding = BINDING_ANSWERS, std430) buffer AnswerBuffer { uint words[]; };

uint written = 0u;
void put(uint x) { words[written++] = x; }
void put(float x) { put(floatBitsToUint(x)); }
void put(vec3 v) {
    put(v.x);
    put(v.y);
    put(v.z);
}

void put(vec4 v) {
    put(v.xyz);
    put(v.w);
}

/// As enterChildren takes a node apart.
void putNode(Record r) {
    put(r.r0.x), put(r.r0.y), put(r.r0.z), put(r.r0.w);
    put(r.r1.x), put(r.r1.y), put(r.r1.z), put(r.r1.w);
    put(r.r2.x), put(r.r2.y), put(r.r2.z), put(r.r2.w);
    put(r.r3.x), put(r.r3.y), put(r.r3.z), put(r.r3.w);
}

/// As testLeaf takes a leaf apart.
void putLeaf(Record r) {
    const LeafPoints p = leafPoints(r);
    put(p.p0), put(r.r0.w), put(p.p1), put(r.r1.w), put(p.p3), put(r.r2.w), put(p.p2);
    put(leafRadius(r));
}

void putPlace(PlacedPrimitive p) {
    put(p.v0), put(p.v1), put(p.v2), put(p.radius), put(p.isSphere ? 1u : 0u), put(p.primitive);
    put(p.light);
}

void putPlacement() {
    const PlacementRecord p = fetchPlacement(1u);
    put(p.root), put(p.transform), put(p.placement), put(p.kind);
    put(p.toPrototype0), put(p.toPrototype1), put(p.toPrototype2);
    const TransformRecord t = fetchTransform(2u);
    put(t.toWorld0), put(t.toWorld1), put(t.toWorld2), put(t.reach);
    put(t.unused0), put(t.unused1), put(t.unused2);
}

void putMaterial(Material m) {
    put(emissionOf(m)), put(m.header.w);
    const StatedParameters stated = statedParameters(m);
    const PrincipledParameters principled = principledParameters(m);
    const BurleyParameters burley = burleyParameters(m);
#define PUT_STATED(type, name, row, place, value) put(stated.name);
#define PUT_PRINCIPLED(type, name, row, place, value) put(principled.name);
#define PUT_BURLEY(type, name, row, place, value) put(burley.name);
    STATED_PARAMETERS(PUT_STATED)
    PRINCIPLED_PARAMETERS(PUT_PRINCIPLED)
    BURLEY_PARAMETERS(PUT_BURLEY)
}

void putLight(LightRows l) {
    put(colorOf(l)), put(l.header.w);
#define PUT_FIELD(type, name, row, place) put(light.name);
#define PUT_LIGHT(structure, function, fields, met, sample_) \
    {                                                        \
        const structure light = function(l);                 \
        fields(PUT_FIELD)                                    \
    }
    LIGHT_STRUCTURES(PUT_LIGHT)
}

void putScene() {
    putNode(fetchRecord(1u));
    putLeaf(fetchRecord(2u));
    putPlace(fetchPlace(4u));
    putPlace(fetchPlace(5u));
    putPlacement();
    const Primitive p = fetchPrimitive(1u);
    put(p.material), put(p.n0), put(p.n1), put(p.n2);
    putMaterial(fetchMaterial(9u)); // nine rows each
    putLight(fetchLightRows(1u));
    const LightEntry e = fetchLightEntry(1u);
    put(e.light), put(e.trail), put(e.probability), put(e.group);
    const AliasColumn c = fetchAliasColumn(frame, 0u);
    put(c.threshold), put(c.alias), put(c.unused0), put(c.unused1);
    const LightNode n = fetchLightNode(frame, 0u, true);
    put(n.center), put(n.radiusAndPower), put(n.axis), put(n.cosSpread), put(n.flags), put(n.unused);
}

void putFrame() {
    put(frame.cameraPosition), put(frame.width), put(frame.cameraRight), put(frame.height);
    put(frame.cameraUp), put(frame.firstSample), put(frame.cameraBack), put(frame.keepsValue);
    put(frame.nearDistance), put(frame.farDistance), put(frame.gapWidth), put(frame.seed);
    put(frame.minBounce), put(frame.maxBounces), put(frame.terminationProbability);
    put(frame.lightCount), put(frame.areaLights), put(frame.hemisphereSamples);
    put(frame.lightSamples), put(frame.branches), put(frame.ambientLight);
    put(frame.lightsInGroup0), put(frame.lightsInGroup1), put(frame.lightsInGroup2);
    put(frame.lensRadius), put(frame.focusDistance), put(frame.cameraMedium);
    put(frame.portalShare), put(frame.litCells), put(frame.leastFall), put(frame.unused0), put(frame.unused1);
    put(frame.shadowAcross), put(frame.shadowAlong), put(frame.shadowTowards), put(frame.shadowMap);
    for (uint i = 0u; i < PORTAL_ROWS * MOST_PORTALS; ++i)
        put(frame.portals[i]);
    for (uint i = 0u; i < OCCLUDER_ROWS * MOST_OCCLUDERS; ++i)
        put(frame.occluders[i]);
}

void putWork() {
    put(dispatch.itemCount), put(dispatch.segmentBase), put(dispatch.softIterations);
    put(dispatch.hardIterations), put(dispatch.laneCount);
    put(dispatch.groupsPerThread), put(dispatch.sharedIterations), put(dispatch.beginsNoSample);
    put(dispatch.rayQueue), put(dispatch.framePlace), put(dispatch.unused0), put(dispatch.unused1);
    const WorkItem w = fetchWorkItem(1u);
    put(w.pixel), put(w.target), put(w.column), put(w.row);
    const PixelState s = fetchPixel(1u);
    put(s.sum), put(s.count), put(s.sumError), put(s.rejected), put(s.m2), put(s.firstRejected);
    put(s.m2Error), put(s.samplesBefore);
    put(status.unfinishedItems), put(status.overflowedItems), put(status.rays);
    put(status.samples), put(status.nextItem), put(status.busySteps), put(status.allSteps);
    put(status.iterations);
}

void main() {
    if (gl_GlobalInvocationID.x != 0u) return;
    putScene();
    putFrame();
    putWork();
    storePixel(2u, fetchPixel(1u)); // as the kernel stores whole structures
}
