// What the key light sees: how much of it reaches a place.

@group(2) @binding(0) var shadow_map: texture_depth_2d;
@group(2) @binding(1) var shadow_sampler: sampler_comparison;

fn lit_at(uv: vec2<f32>, depth: f32) -> f32 {
    return textureSampleCompareLevel(shadow_map, shadow_sampler, uv, depth);
}

// Where a place is in the shadow map, and its depth there.
fn map_of(place: vec3<f32>) -> vec3<f32> {
    let seen = light_of(place);
    return vec3<f32>(0.5 + 0.5 * seen.x, 0.5 - 0.5 * seen.y, clamp(seen.z, 0.0, 1.0));
}

// Outside of the map nothing casts a shadow.
fn inside_map(at: vec3<f32>) -> f32 {
    let aside = 2.0 * abs(at.xy - 0.5);
    return 1.0 - smoothstep(0.93, 0.99, max(aside.x, aside.y));
}

// The mean of four looks, `gap` texels from the middle.
fn four(at: vec3<f32>, gap: f32) -> f32 {
    let d = gap * 0.5 * frame.above.w / frame.light_centre.w;
    return 0.25
        * (lit_at(at.xy + vec2<f32>(-d, -0.4 * d), at.z)
            + lit_at(at.xy + vec2<f32>(0.4 * d, -d), at.z)
            + lit_at(at.xy + vec2<f32>(d, 0.4 * d), at.z)
            + lit_at(at.xy + vec2<f32>(-0.4 * d, d), at.z));
}

// The share of the key light that reaches a place of a plane: over a wide patch, for a soft edge. Where the patch's rim
// and middle agree there is no edge, and no need for a closer look.
fn soft_light(place: vec3<f32>) -> f32 {
    let at = map_of(place);
    let inside = inside_map(at);
    if inside <= 0.0 {
        return 1.0;
    }
    if quick {
        return mix(1.0, four(at, 1.2), inside);
    }
    let rim = 0.8 * four(at, 4.6) + 0.2 * lit_at(at.xy, at.z);
    if rim <= 0.0 || rim >= 1.0 {
        return mix(1.0, rim, inside);
    }
    let texel = 0.5 * frame.above.w / frame.light_centre.w;
    var sum = 0.0;
    for (var y = -2; y <= 2; y++) {
        for (var x = -2; x <= 2; x++) {
            let weight = f32((3 - abs(x)) * (3 - abs(y)));
            sum += weight * lit_at(at.xy + vec2<f32>(f32(x), f32(y)) * (2.6 * texel), at.z);
        }
    }
    return mix(1.0, sum / 81.0, inside);
}

// The same on a thing, a little off its surface so that it does not shade itself.
fn lit_on(place: vec3<f32>, normal: vec3<f32>) -> f32 {
    // What faces away from the light is dark by itself.
    if frame.light_x.w <= 0.0 || dot(normal, frame.light_z.xyz) > 0.25 {
        return 1.0;
    }
    let away = (1.6 * normal - 1.2 * frame.light_z.xyz) * frame.above.w;
    let at = map_of(place + away);
    if quick {
        return mix(1.0, lit_at(at.xy, at.z), frame.light_x.w);
    }
    return mix(1.0, four(at, 1.1), frame.light_x.w);
}
