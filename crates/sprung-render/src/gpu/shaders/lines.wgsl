// Springs, and other straight pieces, as round lines: a ribbon towards the eye, shaded as if it were a cylinder.
// style.size: radius, m; least radius, pixels; 1 if the style's colour is to be taken; opacity.
// style.back.x: 1 if springs that are cut are drawn as well. style.back.y: how far it is moved towards the eye, radii.

struct Ribbon {
    @builtin(position) clip: vec4<f32>,
    // Across from -1 to 1; along from the first end, its length, and the radius, m.
    @location(0) at: vec4<f32>,
    @location(1) side: vec3<f32>,
    @location(2) offset: vec3<f32>,
    @location(3) @interpolate(flat) axis: vec3<f32>,
    @location(4) colour: vec4<f32>,
}

fn nowhere() -> Ribbon {
    var out: Ribbon;
    out.clip = NOWHERE;
    return out;
}

// A corner of the ribbon between two places relative to the eye.
fn ribbon(vertex: u32, from_place: vec3<f32>, to_place: vec3<f32>, colour: vec4<f32>) -> Ribbon {
    var a = from_place;
    var b = to_place;
    let nearest = 1.05 * frame.eye.w;
    let depth_a = dot(a, frame.forward.xyz);
    let depth_b = dot(b, frame.forward.xyz);
    if max(depth_a, depth_b) <= nearest {
        return nowhere();
    }
    // What lies behind the eye is cut off.
    if depth_a < nearest {
        a = mix(a, b, (nearest - depth_a) / (depth_b - depth_a));
    }
    if depth_b < nearest {
        b = mix(b, a, (nearest - depth_b) / (depth_a - depth_b));
    }
    let long = length(b - a);
    let axis = select(frame.right.xyz, (b - a) / max(long, 1e-30), long > 1e-30);
    let at_end = (vertex >> 1u) == 1u;
    let end = select(a, b, at_end);
    let depth = dot(end, frame.forward.xyz);
    let radius = max(style.size.x, style.size.y * pixel_at(depth));
    let across = f32(vertex & 1u) * 2.0 - 1.0;
    let past = select(-radius, radius, at_end);
    var side = cross(axis, end);
    let sine = length(side);
    side = select(frame.up.xyz, side / max(sine, 1e-30), sine > 1e-6 * length(end));

    var out: Ribbon;
    out.at = vec4<f32>(across, select(0.0, long, at_end) + past, long, radius);
    out.side = side;
    out.offset = end + axis * past + side * (across * radius);
    out.axis = axis;
    out.colour = colour;
    let view = view_of(out.offset);
    out.clip = clip_of(view);
    // In front of what it lies on, by so many radii.
    let nearer = clamp(1.0 - style.back.y * radius / max(view.z, 1e-30), 0.2, 1.0);
    out.clip.z = out.clip.z / nearer;
    return out;
}

fn spring_ribbon(vertex: u32, spring: vec3<u32>) -> Ribbon {
    let a = point_at(spring.x);
    let b = point_at(spring.y);
    let constants = textureLoad(springs, cell(spring.z), 0).xy;
    if a.w <= 0.0 || b.w <= 0.0 || (constants.y < 0.0 && style.back.x < 0.5) {
        return nowhere();
    }
    var colour = style.colour.rgb;
    if style.size.z < 0.5 {
        colour = scale_colour(spring_value(length(b.xyz - a.xyz), constants));
    }
    let open = select(a.w, b.w, (vertex >> 1u) == 1u);
    return ribbon(vertex, a.xyz - frame.eye.xyz, b.xyz - frame.eye.xyz, vec4<f32>(colour, open));
}

@vertex
fn vs_spring(@builtin(vertex_index) vertex: u32, @location(0) spring: vec3<u32>) -> Ribbon {
    return spring_ribbon(vertex, spring);
}

// Thousands of lines: they are thin, so their ends need not be round, and shadows on them would not be seen. A processor
// finds their light at the corners alone.
@vertex
fn vs_thin(@builtin(vertex_index) vertex: u32, @location(0) spring: vec3<u32>) -> Ribbon {
    var out = spring_ribbon(vertex, spring);
    if quick && out.at.w > 0.0 {
        let toward = -normalize(out.offset);
        let front = cross(out.side, out.axis);
        let normal = select(-front, front, dot(front, toward) > 0.0);
        let colour = shade(out.colour.rgb, normal, toward, 0.1, 0.35, out.colour.a, 1.0);
        out.colour = vec4<f32>(kept(hazed(colour, dot(out.offset, frame.forward.xyz))), 1.0);
    }
    return out;
}

@vertex
fn vs_segment(
    @builtin(vertex_index) vertex: u32,
    @location(0) from_place: vec3<f32>,
    @location(1) to_place: vec3<f32>,
) -> Ribbon {
    let colour = vec4<f32>(style.colour.rgb, 1.0);
    return ribbon(vertex, from_place - frame.eye.xyz, to_place - frame.eye.xyz, colour);
}

// Round ends: how much of a pixel lies within them.
fn cover_of(in: Ribbon) -> f32 {
    let past = max(max(-in.at.y, in.at.y - in.at.z), 0.0);
    if past <= 0.0 {
        return 1.0;
    }
    let out_of = length(vec2<f32>(past, in.at.x * in.at.w));
    return clamp((in.at.w - out_of) / pixel_at(dot(in.offset, frame.forward.xyz)) + 0.5, 0.0, 1.0);
}

// Of a cylinder, where the ribbon is.
fn normal_of(in: Ribbon, toward: vec3<f32>) -> vec3<f32> {
    let side = normalize(in.side);
    let front = normalize(cross(side, in.axis));
    let across = clamp(in.at.x, -1.0, 1.0);
    return side * across + select(-front, front, dot(front, toward) > 0.0) * sqrt(1.0 - across * across);
}

@fragment
fn fs_main(in: Ribbon) -> @location(0) vec4<f32> {
    var cover = cover_of(in);
    if quick {
        cover = step(0.5, cover); // shares of a pixel take several samples
    }
    if cover <= 0.0 {
        discard;
    }
    let toward = -normalize(in.offset);
    let normal = normal_of(in, toward);
    let depth = dot(in.offset, frame.forward.xyz);
    let lit = lit_on(in.offset + frame.eye.xyz + normal * in.at.w, normal);
    let colour = shade(in.colour.rgb, normal, toward, 0.1, 0.35, in.colour.a, lit);
    return vec4<f32>(kept(hazed(colour, depth)), cover * style.size.w);
}

@fragment
fn fs_thin(in: Ribbon) -> @location(0) vec4<f32> {
    if quick {
        return vec4<f32>(in.colour.rgb * (1.0 - 0.2 * in.at.x * in.at.x), 1.0);
    }
    let toward = -normalize(in.offset);
    let colour = shade(in.colour.rgb, normal_of(in, toward), toward, 0.1, 0.35, in.colour.a, 1.0);
    return vec4<f32>(hazed(colour, dot(in.offset, frame.forward.xyz)), 1.0);
}

// Marks and the like: their own colour, whatever the light.
@fragment
fn fs_flat(in: Ribbon) -> @location(0) vec4<f32> {
    var cover = cover_of(in);
    if style.size.w < 1.0 {
        cover = step(0.5, cover); // as in points.wgsl
    }
    if cover <= 0.0 {
        discard;
    }
    let across = clamp(in.at.x, -1.0, 1.0);
    return vec4<f32>(kept(in.colour.rgb * (1.0 - 0.3 * across * across)), cover * style.size.w);
}

@vertex
fn vs_shadow(@builtin(vertex_index) vertex: u32, @location(0) spring: vec3<u32>) -> @builtin(position) vec4<f32> {
    let a = point_at(spring.x);
    let b = point_at(spring.y);
    let constants = textureLoad(springs, cell(spring.z), 0).xy;
    if a.w <= 0.0 || b.w <= 0.0 || constants.y < 0.0 {
        return NOWHERE;
    }
    let ends = array<vec3<f32>, 2>(light_of(a.xyz), light_of(b.xyz));
    let along = ends[1].xy - ends[0].xy;
    let long = length(along);
    let side = select(vec2<f32>(1.0, 0.0), vec2<f32>(-along.y, along.x) / max(long, 1e-30), long > 1e-12);
    let radius = max(style.size.x, 0.4 * frame.above.w) / frame.light_centre.w;
    let across = f32(vertex & 1u) * 2.0 - 1.0;
    let end = select(ends[0], ends[1], (vertex >> 1u) == 1u);
    return vec4<f32>(end.xy + side * (across * radius), end.z, 1.0);
}
