// Whether a processor draws, and much must stay simple.
override quick: bool = false;

// What every shader shares: the frame, the style of one drawing, the tables, and light.

struct Frame {
    // xyz: the eye, m; w: the nearest distance that is drawn, m.
    eye: vec4<f32>,
    // Unit vectors of the camera's space; w of the first: pixels for 1 m at a distance of 1 m.
    right: vec4<f32>,
    up: vec4<f32>,
    forward: vec4<f32>,
    // Width and height of the picture, and the pixel that the view's axis meets.
    picture: vec4<f32>,
    // Unit vectors of the light's space, the last towards the scene; w: how dark shadows are on things, on planes.
    light_x: vec4<f32>,
    light_y: vec4<f32>,
    light_z: vec4<f32>,
    // xyz: the middle of the shadow map, m; w: half its side, m.
    light_centre: vec4<f32>,
    // Up, against gravity; w: length of a texel of the shadow map, m.
    above: vec4<f32>,
    sky: vec4<f32>,
    floor: vec4<f32>,
    sun: vec4<f32>,
    // rgb: its colour; w: how thick it gets.
    haze: vec4<f32>,
    // Where haze begins and ends, m; number of planes; number of stops of the colour scale in use.
    counts: vec4<f32>,
    // What colours mean (0 plain, 1 strain, 2 tension, 3 energy), the value at the scale's end, whether it is signed.
    scale: vec4<f32>,
    backdrop_top: vec4<f32>,
    backdrop_bottom: vec4<f32>,
    waterline: vec4<f32>,
    stops: array<vec4<f32>, 9>,
    // Points of bodies 0 to 5, then a fixed point.
    balls: array<vec4<f32>, 8>,
    // Unit normal, and its product with any point of the plane.
    planes: array<vec4<f32>, 8>,
}

// What differs from drawing to drawing. Each shader says which it uses.
struct Style {
    colour: vec4<f32>,
    back: vec4<f32>,
    line: vec4<f32>,
    dark: vec4<f32>,
    size: vec4<f32>,
    origin: vec4<f32>,
    along_u: vec4<f32>,
    along_v: vec4<f32>,
}

@group(0) @binding(0) var<uniform> frame: Frame;
// xyz: m; w: 0 if there is no such point, else how much of the sky it sees.
@group(0) @binding(1) var positions: texture_2d<f32>;
// Stiffness, N/m, and rest length, m, of each spring; below zero if it is cut.
@group(0) @binding(2) var springs: texture_2d<f32>;
@group(0) @binding(3) var velocities: texture_2d<f32>;
@group(0) @binding(4) var forces: texture_2d<f32>;
// For each point: first and number of its triangles, first and number of its springs.
@group(0) @binding(5) var rims: texture_2d<u32>;
// The other two corners of each triangle at a point, in order.
@group(0) @binding(6) var fans: texture_2d<u32>;
// The other point of each spring at a point, and the spring.
@group(0) @binding(7) var spokes: texture_2d<u32>;
@group(1) @binding(0) var<uniform> style: Style;

// Tables are textures of this width, row after row.
fn cell(index: u32) -> vec2<i32> {
    return vec2<i32>(i32(index & 2047u), i32(index >> 11u));
}

fn point_at(index: u32) -> vec4<f32> {
    return textureLoad(positions, cell(index), 0);
}

// Outside of every picture: what is not to be drawn goes there.
const NOWHERE = vec4<f32>(2.0, 2.0, 0.5, 1.0);

// A place relative to the eye in the camera's space: right, up, along the view.
fn view_of(offset: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(offset, frame.right.xyz), dot(offset, frame.up.xyz), dot(offset, frame.forward.xyz));
}

// Depth is near/z: 1 at the nearest distance, 0 infinitely far away, and evenly fine in between.
fn clip_of(view: vec3<f32>) -> vec4<f32> {
    let focal = 2.0 * frame.right.w / frame.picture.xy;
    let middle = 2.0 * frame.picture.zw / frame.picture.xy - 1.0;
    return vec4<f32>(
        view.x * focal.x + view.z * middle.x,
        view.y * focal.y - view.z * middle.y,
        frame.eye.w,
        view.z,
    );
}

// The length of a pixel at a distance, m.
fn pixel_at(depth: f32) -> f32 {
    return depth / frame.right.w;
}

// A place in the light's space: across the shadow map from -1 to 1, and its depth from 0 to 1.
fn light_of(place: vec3<f32>) -> vec3<f32> {
    let offset = (place - frame.light_centre.xyz) / frame.light_centre.w;
    return vec3<f32>(
        dot(offset, frame.light_x.xyz),
        dot(offset, frame.light_y.xyz),
        0.5 + 0.5 * dot(offset, frame.light_z.xyz),
    );
}

// What a spring at length `length` has to say: strain, N or J, as chosen.
fn spring_value(length: f32, spring: vec2<f32>) -> f32 {
    let longer = length - spring.y;
    if frame.scale.x < 1.5 {
        return longer / max(spring.y, 1e-12);
    }
    if frame.scale.x < 2.5 {
        return spring.x * longer;
    }
    return 0.5 * spring.x * longer * longer;
}

fn scale_colour(value: f32) -> vec3<f32> {
    let share = clamp(value / frame.scale.y, -1.0, 1.0);
    var along = max(share, 0.0);
    if frame.scale.z > 0.5 {
        along = 0.5 + 0.5 * share;
    }
    let at = along * 8.0;
    let low = min(u32(at), 7u);
    return mix(frame.stops[low].rgb, frame.stops[low + 1u].rgb, at - f32(low));
}

// The light that leaves a thing towards the viewer. `open`: how much of the sky it sees; `lit`: of the key light.
fn shade(base: vec3<f32>, normal: vec3<f32>, toward: vec3<f32>, gloss: f32, edge: f32, open: f32, lit: f32) -> vec3<f32> {
    let key = -frame.light_z.xyz;
    let ambient = mix(frame.floor.rgb, frame.sky.rgb, 0.5 + 0.5 * dot(normal, frame.above.xyz)) * open;
    // Wrapped a little around the terminator, as light from a large soft box is.
    let direct = max((dot(normal, key) + 0.2) / 1.2, 0.0) * lit * (0.4 + 0.6 * open);
    let facing = clamp(dot(normal, toward), 0.0, 1.0);
    let rim = 1.0 - edge * (1.0 - facing) * (1.0 - facing);
    let half = max(dot(normal, normalize(key + toward)), 0.0);
    let half4 = half * half * half * half;
    let half16 = half4 * half4 * half4 * half4;
    let highlight = half16 * half16 * gloss * open * lit;
    return base * (ambient + frame.sun.rgb * direct) * rim + highlight;
}

fn hazed(colour: vec3<f32>, depth: f32) -> vec3<f32> {
    let share = clamp((depth - frame.counts.x) / (frame.counts.y - frame.counts.x), 0.0, 1.0);
    return mix(colour, frame.haze.rgb, frame.haze.w * share);
}

// What is written for light: itself, or its sRGB numbers (within half a step of 255) where a processor draws.
fn kept(light: vec3<f32>) -> vec3<f32> {
    if !quick {
        return light;
    }
    let root = sqrt(clamp(light, vec3<f32>(0.0), vec3<f32>(1.0)));
    let root4 = sqrt(root);
    return 0.585122381 * root + 0.783140355 * root4 - 0.368262736 * sqrt(root4);
}

// Where things cross a plane they bear a line, as at the surface of water; `moved` is how far the place moves from
// pixel to pixel along each axis, m.
fn waterline(colour: vec3<f32>, place: vec3<f32>, moved: vec3<f32>) -> vec3<f32> {
    var found = 0.0;
    for (var index = 0; index < i32(frame.counts.z); index++) {
        let plane = frame.planes[index];
        let height = abs(dot(plane.xyz, place) - plane.w);
        found = max(found, 1.0 - smoothstep(0.7, 1.7, height / max(dot(abs(plane.xyz), moved), 1e-12)));
    }
    return mix(colour, frame.waterline.rgb, found * frame.waterline.w);
}
