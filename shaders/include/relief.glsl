// Tangents, and what normal maps and heights make of the shading normal (docs/estimator.md, "Textures").

/// The tangent at a point of a surface with shading normal n (faced forward), perpendicular to n; w: the bitangent is
/// w (n x tangent), 0: there is none. Seen from behind, the normal is turned and w with it, so that the bitangent is the
/// same.
vec4 tangentAt(SurfacePoint s, vec3 n) {
    if (s.skipPrimitive == NO_PRIMITIVE) return vec4(0.0);
    const uvec4 r = ROW(detailRows, attributeRow(s.primitive, ATTRIBUTE_TANGENT));
    const uvec3 sides = uvec3(r.w) >> uvec3(0u, 2u, 4u) & 3u;
    if (sides.x == 0u || sides.y == 0u || sides.z == 0u) return vec4(0.0);
    vec3 t0 = decodeNormal(r.x), t1 = decodeNormal(r.y), t2 = decodeNormal(r.z);
    float side = sides.x == 1u ? 1.0 : -1.0;
#ifdef PLACEMENTS
    if (HAS_PLACEMENTS) {
        const Placing placing = placingOf(s.placement);
        t0 = tangentInWorld(placing, t0);
        t1 = tangentInWorld(placing, t1);
        t2 = tangentInWorld(placing, t2);
        side = placing.mirrors ? -side : side;
    }
#endif
    const vec3 sum = (1.0 - s.weights.x - s.weights.y) * t0 + s.weights.x * t1 + s.weights.y * t2;
    const vec3 across = sum - dot(sum, n) * n;
    const float length2 = dot(across, across);
    const bool isTurned = FACES_FORWARD && !s.outside;
    return length2 > 0.0 ? vec4(across * inversesqrt(length2), isTurned ? -side : side) : vec4(0.0);
}

/// Turns n until the mirror direction of wo is not below the geometric surface: a normal beyond that would make a
/// black rim, as light from there cannot be. Keller et al. 2017, "The Iray Light Transport Simulation and Rendering
/// System", A.3: the mirror direction 2 (n . wo) n - wo is pulled up along n to the horizon, and the normal is halfway
/// between what that gives and wo. It is n (g . wo) - wo (n . g), but for its length; for a normal that is below the
/// horizon itself the limit of that, n's own direction along the horizon. g: unit geometric normal, on the side of wo.
vec3 bentNormal(vec3 n, vec3 g, vec3 wo) {
    const float along = dot(n, g), height = dot(wo, g);
    if (along > 0.0 && 2.0 * dot(n, wo) * along >= height) return n;
    const vec3 level = n - min(along, 0.0) * g;
    const vec3 grazing = level * height - wo * max(along, 0.0);
    const float size2 = dot(grazing, grazing);
    const vec3 sum = size2 > 0.0 ? wo + grazing * inversesqrt(size2) : g;
    const float length2 = dot(sum, sum);
    return length2 > 0.0 ? sum * inversesqrt(length2) : g;
}

/// A normal that a map has made of n, as the material's MATERIAL_RELIEF_ bits have it: where it faces away from the
/// viewer its tilt against n is turned round (Schuessler et al. 2017, "Microfacet-based Normal Mapping for Robust Monte
/// Carlo Path Tracing", 4.1), it stays, or it is bent.
vec3 settledNormal(vec3 mapped, vec3 n, SurfacePoint s, bool bends, uint rules) {
    if (!FACES_FORWARD) return mapped;
    if (RELIEF_RULES && (rules & MATERIAL_RELIEF_FLIPS) != 0u)
        return dot(mapped, s.wo) > 0.0 ? mapped : 2.0 * dot(mapped, n) * n - mapped;
    if (RELIEF_RULES && (rules & MATERIAL_RELIEF_BLACKENS) != 0u) return mapped;
    return bends ? bentNormal(mapped, s.geometric, s.wo) : mapped;
}

/// Raises a surface that is faced forward by heights over it (Blinn 1978). Its derivatives p_u and p_v along the texture
/// coordinates, with their parts along the normal n replaced by n times those of the height, span the raised surface; its
/// normal is n (n . p_u x p_v) + h_v (p_u x n) + h_u (n x p_v). How n changes is left out, as usual. All is times the
/// determinant of the texture's edges, which would divide p_u and p_v. mirrors: light goes where the view decides, and would
/// be lost below the surface; Lambert's law needs no view. rules: the material's MATERIAL_RELIEF_ bits.
void applyHeights(inout SurfacePoint s, vec2 slope, bool mirrors, uint rules) {
    PlacedPrimitive p = fetchPlace(s.skipPrimitive);
#ifdef PLACEMENTS
    if (HAS_PLACEMENTS) p = inWorld(placingOf(s.placement), p);
#endif
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
    s.shading = settledNormal(unit(raised / size), n, s, mirrors, rules);
}

/// A map's vector in the frame of a surface, faced forward, with normal n and tangent t: not unit. Seen from behind, a
/// bump is a dent: the vector is the front's, turned round with the normal.
vec3 turnedByMap(SurfacePoint s, vec3 n, vec4 t, vec3 mapped) {
    const float turned = FACES_FORWARD && !s.outside ? -1.0 : 1.0;
    const vec3 bitangent = t.w * cross(n, t.xyz);
    return mapped.x * turned * t.xyz + mapped.y * turned * bitangent + mapped.z * n;
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
    const vec4 t = tangentAt(s, n);
    const vec3 sum = turnedByMap(s, n, t, mapped);
    const float length2 = dot(sum, sum);
    const bool maps =
        number != 0u && t.w != 0.0 && length2 > 0.0 && (mapped.x != 0.0 || mapped.y != 0.0);
    return maps ? bentNormal(sum * inversesqrt(length2), s.geometric, s.wo) : n;
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
    const vec3 mapped = relief.mapped;
    vec4 t = tangentAt(s, shadingNormal(s));
    if (hasNormalMaps()) {
        const vec3 n = shadingNormal(s), sum = turnedByMap(s, n, t, mapped);
        const float length2 = dot(sum, sum);
        const bool maps = t.w != 0.0 && length2 > 0.0 && (mapped.x != 0.0 || mapped.y != 0.0);
        if (maps) s.shading = settledNormal(sum * inversesqrt(length2), n, s, true, rules);
    }
    if (TANGENT_FRAMES) s.tangent = tangentAt(s, shadingNormal(s));
    if (sceneHasCoatNormals()) s.coat = coatNormal(s);
}
