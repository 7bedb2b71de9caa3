// Rings around points that are pointed out.
// style.colour: colour and opacity; style.size: radius of a point, m; least radius of the ring, pixels; its width, pixels.

struct Ring {
    @builtin(position) clip: vec4<f32>,
    // From the middle, pixels.
    @location(0) at: vec2<f32>,
    @location(1) @interpolate(flat) radius: f32,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32, @location(0) point: u32) -> Ring {
    var out: Ring;
    out.clip = NOWHERE;
    let place = point_at(point);
    let view = view_of(place.xyz - frame.eye.xyz);
    if place.w <= 0.0 || view.z < frame.eye.w {
        return out;
    }
    let pixel = pixel_at(view.z);
    out.radius = max(1.25 * style.size.x / pixel + 1.5 + style.size.z, style.size.y);
    out.at = (vec2<f32>(f32(vertex & 1u), f32(vertex >> 1u)) * 2.0 - 1.0) * (out.radius + style.size.z + 1.0);
    out.clip = clip_of(view + vec3<f32>(out.at * pixel, 0.0));
    // As near as the nearest part of a sphere would be.
    out.clip.z = out.clip.z / clamp(1.0 - 1.3 * style.size.x / view.z, 0.2, 1.0);
    return out;
}

@fragment
fn fs_main(in: Ring) -> @location(0) vec4<f32> {
    let off = abs(length(in.at) - in.radius) - 0.5 * style.size.z;
    let cover = clamp(0.5 - off, 0.0, 1.0);
    if cover <= 0.0 {
        discard;
    }
    return vec4<f32>(kept(style.colour.rgb), style.colour.a * cover);
}
