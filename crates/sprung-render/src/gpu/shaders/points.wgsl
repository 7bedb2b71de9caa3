// Points as spheres: a square towards the eye for each, and in each pixel the place where its ray meets the sphere.
// style.size: radius, m; least radius, pixels; 1 if the style's colour is to be taken; opacity below 1 for ghosts.

struct Ball {
    @builtin(position) clip: vec4<f32>,
    @location(0) ray: vec3<f32>,
    @location(1) @interpolate(flat) centre: vec4<f32>,
    @location(2) @interpolate(flat) colour: vec4<f32>,
}

fn corner_of(vertex: u32) -> vec2<f32> {
    return vec2<f32>(f32(vertex & 1u), f32(vertex >> 1u)) * 2.0 - 1.0;
}

// 1 for fixed points, and 2 for those that only mark a place on a surface.
fn radius_of(kind: u32) -> f32 {
    return select(style.size.x, 1.25 * style.size.x, kind == 1u);
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32, @location(0) ball: vec2<u32>) -> Ball {
    var out: Ball;
    out.clip = NOWHERE;
    let place = point_at(ball.x);
    let offset = place.xyz - frame.eye.xyz;
    let depth = dot(offset, frame.forward.xyz);
    let kind = ball.y & 255u;
    let least = select(select(style.size.y, 2.2, kind == 1u), 4.5, kind == 2u);
    let radius = max(radius_of(kind), least * pixel_at(depth));
    if place.w <= 0.0 || depth - radius < frame.eye.w {
        return out;
    }
    // The square stands across the ray to the centre, a pixel larger than the outline.
    let distance = length(offset);
    let toward = offset / distance;
    let side = normalize(cross(toward, frame.up.xyz));
    let other = cross(side, toward);
    let outline = radius * distance / sqrt(max(distance * distance - radius * radius, 1e-30));
    let corner = corner_of(vertex) * (outline + 1.5 * pixel_at(distance));
    out.ray = offset + side * corner.x + other * corner.y;
    out.clip = clip_of(view_of(out.ray));
    out.centre = vec4<f32>(offset, radius);
    let own = frame.balls[select(min(ball.y >> 8u, 5u), 6u, kind > 0u)].rgb;
    out.colour = vec4<f32>(mix(own, style.colour.rgb, style.size.z), place.w);
    return out;
}

struct Pixel {
    @location(0) colour: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fs_main(ball: Ball) -> Pixel {
    let ray = normalize(ball.ray);
    let radius = ball.centre.w;
    let middle = dot(ball.centre.xyz, ray);
    let aside = length(ball.centre.xyz - ray * middle);
    var cover = clamp((radius - aside) / pixel_at(middle) + 0.5, 0.0, 1.0);
    if quick || style.size.w < 1.0 {
        cover = step(0.5, cover); // the depth of a ghost, which is drawn first, knows no shares of pixels
    }
    if cover <= 0.0 {
        discard;
    }
    let reach = middle - sqrt(max(radius * radius - aside * aside, 0.0));
    let hit = ray * reach;
    let normal = normalize(hit - ball.centre.xyz);
    let place = hit + frame.eye.xyz;
    let depth = dot(hit, frame.forward.xyz);
    let lit = lit_on(place, normal);
    var colour = shade(ball.colour.rgb, normal, -ray, 0.35, 0.55, ball.colour.a, lit);
    colour = waterline(colour, place, vec3<f32>(0.6 * pixel_at(depth)));
    if style.size.w < 1.0 {
        colour = ball.colour.rgb * (0.8 + 0.2 * dot(normal, -ray)); // a ghost throws back no light
    }
    var out: Pixel;
    out.colour = vec4<f32>(kept(hazed(colour, depth)), cover * style.size.w);
    out.depth = frame.eye.w / depth;
    return out;
}

struct Disc {
    @builtin(position) clip: vec4<f32>,
    @location(0) corner: vec2<f32>,
}

@vertex
fn vs_shadow(@builtin(vertex_index) vertex: u32, @location(0) ball: vec2<u32>) -> Disc {
    var out: Disc;
    out.clip = NOWHERE;
    let place = point_at(ball.x);
    if place.w <= 0.0 {
        return out;
    }
    out.corner = corner_of(vertex);
    let radius = max(radius_of(ball.y & 255u), 0.7 * frame.above.w);
    let seen = light_of(place.xyz);
    out.clip = vec4<f32>(seen.xy + out.corner * radius / frame.light_centre.w, seen.z, 1.0);
    return out;
}

@fragment
fn fs_shadow(disc: Disc) {
    if dot(disc.corner, disc.corner) > 1.0 {
        discard;
    }
}
