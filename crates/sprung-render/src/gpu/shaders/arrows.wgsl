// Arrows at points, flat towards the eye and shaded as if round.
// style.colour: their colour; style.size: m of length for 1 of the vector; width, m; least width, pixels;
// 0 for velocities, 1 for forces.

struct Arrow {
    @builtin(position) clip: vec4<f32>,
    @location(0) offset: vec3<f32>,
    @location(1) across: f32,
    @location(2) @interpolate(flat) side: vec3<f32>,
    @location(3) @interpolate(flat) front: vec3<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32, @location(0) point: u32) -> Arrow {
    var out: Arrow;
    out.clip = NOWHERE;
    let place = point_at(point);
    var vector = textureLoad(velocities, cell(point), 0);
    if style.size.w > 0.5 {
        vector = textureLoad(forces, cell(point), 0);
    }
    let base = place.xyz - frame.eye.xyz;
    let depth = dot(base, frame.forward.xyz);
    let shaft = vector.xyz * style.size.x;
    let long = length(shaft);
    let pixel = pixel_at(depth);
    if place.w <= 0.0 || vector.w <= 0.0 || depth < frame.eye.w || long < 2.0 * pixel {
        return out;
    }
    let axis = shaft / long;
    let sideways = cross(axis, base);
    let sine = length(sideways);
    let side = select(frame.up.xyz, sideways / max(sine, 1e-30), sine > 1e-4 * length(base));
    // Short arrows are all head.
    let width = max(style.size.y, style.size.z * pixel);
    let head = min(6.0 * width, 0.6 * long);
    let broad = 0.42 * head;
    let thin = min(width, 0.45 * broad);
    var along = 0.0;
    var across = 0.0;
    var half = thin;
    if vertex < 6u {
        let corner = array<u32, 6>(0u, 1u, 2u, 2u, 1u, 3u)[vertex];
        along = select(0.0, long - head, corner > 1u);
        across = select(-1.0, 1.0, (corner & 1u) == 1u);
    } else {
        across = array<f32, 3>(-1.0, 1.0, 0.0)[vertex - 6u];
        along = select(long - head, long, vertex == 8u);
        half = broad;
    }
    out.across = across;
    out.side = side;
    let toward = cross(side, axis);
    out.front = select(-toward, toward, dot(toward, base) < 0.0);
    out.offset = base + axis * along + side * (across * half);
    out.clip = clip_of(view_of(out.offset));
    return out;
}

@fragment
fn fs_main(in: Arrow) -> @location(0) vec4<f32> {
    let across = clamp(in.across, -1.0, 1.0);
    let normal = normalize(in.side * across + in.front * sqrt(1.0 - across * across));
    let colour = shade(style.colour.rgb, normal, -normalize(in.offset), 0.1, 0.3, 1.0, 1.0);
    return vec4<f32>(kept(hazed(colour, dot(in.offset, frame.forward.xyz))), 1.0);
}
