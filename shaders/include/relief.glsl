// Tangents, and what normal maps and heights make of the shading normal (docs/theory/surfaces.md, "Textures").

/// Along the tangent at a point of a surface with shading normal n (faced forward), perpendicular to n, of no certain
/// length; w: the bitangent is along w (n x tangent), 0: there is none. Seen from behind, the normal is turned and w with
/// it, so that the bitangent is the same.
vec4 alongTangent(SurfacePoint s, vec3 n) {
    if (s.skipPrimitive == NO_PRIMITIVE) return vec4(0.0);
    const uvec4 row = tangentRow(s.primitive);
    vec3 t0 = cornerTangent(row, 0u), t1 = cornerTangent(row, 1u), t2 = cornerTangent(row, 2u);
    float side = bitangentSide(row);
    if (HAS_PLACEMENTS) {
        const Placing placing = placingOf(s.placement);
        t0 = tangentInWorld(placing, t0);
        t1 = tangentInWorld(placing, t1);
        t2 = tangentInWorld(placing, t2);
        side = placing.mirrors ? -side : side;
    }
    const vec3 sum = (1.0 - s.weights.x - s.weights.y) * t0 + s.weights.x * t1 + s.weights.y * t2;
    const bool isTurned = FACES_FORWARD && !s.outside;
    return vec4(sum - dot(sum, n) * n, isTurned ? -side : side);
}

/// The unit tangent perpendicular to n, and the side of the bitangent; 0 where there is no tangent.
vec4 tangentAt(SurfacePoint s, vec3 n) {
    const vec4 t = alongTangent(s, n);
    const float length2 = dot(t.xyz, t.xyz);
    return length2 > TINY ? vec4(t.xyz * inversesqrt(length2), t.w) : vec4(0.0);
}

/// Unit, or instead of a vector without a direction this one.
vec3 unitOr(vec3 v, vec3 instead) {
    const float length2 = dot(v, v);
    return length2 > TINY ? v * inversesqrt(length2) : instead;
}

/// Turns n, of any length, until the mirror direction of wo is not below the geometric surface: a normal beyond that would
/// make a black rim, as light from there cannot be. Keller et al. 2017, "The Iray Light Transport Simulation and Rendering
/// System", A.3: the mirror direction 2 (n . wo) n - wo is pulled up along n to the horizon, and the normal is halfway
/// between what that gives and wo. It is n (g . wo) - wo (n . g), but for its length; for a normal that is below the
/// horizon itself the limit of that, n's own direction along the horizon. g: unit geometric normal, on the side of wo.
vec3 bentNormal(vec3 n, vec3 g, vec3 wo) {
    const float along = dot(n, g), height = dot(wo, g);
    if (along > 0.0 && 2.0 * dot(n, wo) * along >= height * dot(n, n)) return n;
    const vec3 level = n - min(along, 0.0) * g;
    const vec3 grazing = level * height - wo * max(along, 0.0);
    return wo * length(grazing) + grazing;
}

/// A normal, of any length, that a map has made of n, as the material's MATERIAL_RELIEF_ bits have it: where it faces away
/// from the viewer its tilt against n is turned round (Schuessler et al. 2017, "Microfacet-based Normal Mapping for Robust
/// Monte Carlo Path Tracing", 4.1), it stays, or it is bent. Unit.
vec3 settledNormal(vec3 mapped, vec3 n, SurfacePoint s, bool bends, uint rules) {
    vec3 settled = mapped;
    const bool flips = RELIEF_RULES && (rules & MATERIAL_RELIEF_FLIPS) != 0u;
    const bool blackens = RELIEF_RULES && (rules & MATERIAL_RELIEF_BLACKENS) != 0u;
    if (FACES_FORWARD && bends && !flips && !blackens) settled = bentNormal(mapped, s.geometric, s.wo);
    if (FACES_FORWARD && flips && !(dot(mapped, s.wo) > 0.0)) settled = 2.0 * dot(mapped, n) * n - mapped;
    return unitOr(settled, s.geometric);
}

/// Raises a surface that is faced forward by heights over it (Blinn 1978). Its derivatives p_u and p_v along the texture
/// coordinates, with their parts along the normal n replaced by n times those of the height, span the raised surface; its
/// normal is n (n . p_u x p_v) + h_v (p_u x n) + h_u (n x p_v). How n changes is left out, as usual. All is times the
/// determinant of the texture's edges, which would divide p_u and p_v. mirrors: light goes where the view decides, and would
/// be lost below the surface; Lambert's law needs no view. rules: the material's MATERIAL_RELIEF_ bits.
void applyHeights(inout SurfacePoint s, vec2 slope, bool mirrors, uint rules) {
    PlacedPrimitive p = fetchPlace(s.skipPrimitive);
    if (HAS_PLACEMENTS) p = inWorld(placingOf(s.placement), p);
    const uint row = attributeRow(s.primitive, ATTRIBUTE_UV0);
    const vec4 first = uintBitsToFloat(ROW(detailRows, row));
    const vec2 d1 = first.zw - first.xy, d2 = uintBitsToFloat(ROW(detailRows, row + 1u).xy) - first.xy;
    const vec3 e1 = p.v1 - p.v0, e2 = p.v2 - p.v0, n = shadingNormal(s);
    const float facing = dot(n, cross(e1, e2));
    // Seen from behind, a bump is a dent.
    const vec2 h = FACES_FORWARD && !s.outside ? -slope : slope;
    vec3 raised = facing * n + h.y * cross(d2.y * e1 - d1.y * e2, n) + h.x * cross(n, d1.x * e2 - d2.x * e1);
    raised *= facing < 0.0 ? -1.0 : 1.0;
    // Small triangles have squares that floats do not.
    const float size = max(max(abs(raised.x), abs(raised.y)), abs(raised.z));
    const bool hasNormal = d1.x * d2.y != d1.y * d2.x && facing != 0.0 && size > 0.0 && size < INFINITE_DISTANCE;
    if (!hasNormal) return;
    s.shading = settledNormal(raised / size, n, s, mirrors, rules);
}

/// Along a map's vector in the frame of a surface, faced forward, with normal n: times the length of t, which is along the
/// tangent. Seen from behind, a bump is a dent: the vector is the front's, turned round with the normal.
vec3 turnedByMap(SurfacePoint s, vec3 n, vec4 t, vec3 mapped) {
    const float turned = FACES_FORWARD && !s.outside ? -1.0 : 1.0;
    const vec3 bitangent = t.w * cross(n, t.xyz);
    return turned * (mapped.x * t.xyz + mapped.y * bitangent) + mapped.z * length(t.xyz) * n;
}

/// Whether that has a direction other than n's. t: as above; sum: what turnedByMap() has made of them.
bool turnsNormal(vec4 t, vec3 mapped, vec3 sum) {
    return t.w != 0.0 && dot(sum, sum) > TINY && (mapped.x != 0.0 || mapped.y != 0.0);
}

/// The normal of the clear coat of a surface that is faced forward and has its shading normal: glTF's is not turned by
/// the base's map, but by its own.
vec3 coatNormal(SurfacePoint s) {
    const MaterialDetail detail = fetchDetail(s.material);
    if ((detail.flags & DETAIL_COAT_HAS_NORMAL) == 0u) return shadingNormal(s);
    const vec3 n = unmappedNormal(s);
    if (!sceneHasSlot(TEXTURE_CLEARCOAT_NORMAL)) return n;
    const uint number = detail.looseTextures >> DETAIL_COAT_NORMAL_SHIFT;
    const TextureUse use = fetchTextureUse(s.material, number);
    const vec3 mapped = mappedNormal(lookUp(use, coordinatesOf(use, attributesOf(s))), use.scale);
    const vec4 t = alongTangent(s, n);
    const vec3 sum = turnedByMap(s, n, t, mapped);
    const bool maps = number != 0u && turnsNormal(t, mapped, sum);
    return maps ? unitOr(bentNormal(sum, s.geometric, s.wo), s.geometric) : n;
}

/// Replaces the shading normal of a surface that is faced forward by what maps say, and sets the tangent. mirrors, rules: as
/// applyHeights() has them.
void applyRelief(inout SurfacePoint s, Relief relief, bool mirrors, uint rules) {
    if (hasHeights() && relief.slope != vec2(0.0) && s.skipPrimitive != NO_PRIMITIVE)
        applyHeights(s, relief.slope, mirrors, rules);
    if (!hasAttribute(ATTRIBUTE_TANGENT)) {
        if (sceneHasCoatNormals()) s.coat = shadingNormal(s); // no map can be read
        return;
    }
    if (hasNormalMaps()) {
        const vec3 n = shadingNormal(s), mapped = relief.mapped;
        const vec4 t = alongTangent(s, n);
        const vec3 sum = turnedByMap(s, n, t, mapped);
        if (turnsNormal(t, mapped, sum)) s.shading = settledNormal(sum, n, s, true, rules);
    }
    if (TANGENT_FRAMES) s.tangent = tangentAt(s, shadingNormal(s));
    if (sceneHasCoatNormals()) s.coat = coatNormal(s);
}
