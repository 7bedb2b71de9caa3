// The last pass: linear light to the sRGB numbers that egui expects in a texture without a colour space.

// Whether a processor draws: then there is one sample for each pixel, and edges are smoothed here.
override quick: bool = false;

@group(0) @binding(0) var drawn: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    let at = vec2<f32>(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    return vec4<f32>(2.0 * at - 1.0, 0.0, 1.0);
}

fn number_at(at: vec2<i32>) -> vec3<f32> {
    return textureLoad(drawn, at, 0).rgb;
}

fn brightness(colour: vec3<f32>) -> f32 {
    return dot(colour, vec3<f32>(0.3, 0.6, 0.1));
}

// The colour of a pixel, smoothed along edges: where its corners differ in brightness, the mean of two places along the
// edge, which runs across the steepest change. After FXAA by Timothy Lottes (NVIDIA, 2009), of which this is the core.
fn smoothed(at: vec2<i32>) -> vec3<f32> {
    let last = vec2<i32>(textureDimensions(drawn)) - 1;
    let low = max(at - 1, vec2<i32>(0));
    let high = min(at + 1, last);
    let here = number_at(at);
    let nw = number_at(low);
    let ne = number_at(vec2<i32>(high.x, low.y));
    let sw = number_at(vec2<i32>(low.x, high.y));
    let se = number_at(high);
    let m = brightness(here);
    let corners = vec4<f32>(brightness(nw), brightness(ne), brightness(sw), brightness(se));
    let most = max(max(max(corners.x, corners.y), max(corners.z, corners.w)), m);
    let least = min(min(min(corners.x, corners.y), min(corners.z, corners.w)), m);
    if most - least < max(0.14 * most, 0.03) {
        return here;
    }
    let slope = vec2<f32>(
        corners.z + corners.w - corners.x - corners.y,
        corners.x + corners.z - corners.y - corners.w,
    );
    let along = clamp(slope / max(min(abs(slope.x), abs(slope.y)), 0.04), vec2<f32>(-1.5), vec2<f32>(1.5));
    let step = vec2<i32>(round(along));
    let one = number_at(clamp(at - step, vec2<i32>(0), last));
    let two = number_at(clamp(at + step, vec2<i32>(0), last));
    return 0.5 * here + 0.25 * (one + two);
}

@fragment
fn fs_main(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(at.xy);
    if quick {
        return vec4<f32>(smoothed(pixel), 1.0);
    }
    let linear = number_at(pixel);
    let low = linear * 12.92;
    let high = 1.055 * pow(linear, vec3<f32>(1.0 / 2.4)) - 0.055;
    return vec4<f32>(select(high, low, linear <= vec3<f32>(0.0031308)), 1.0);
}
