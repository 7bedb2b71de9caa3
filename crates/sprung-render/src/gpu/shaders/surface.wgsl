// Cloths and skins: triangles with smooth normals, found at each corner from the triangles around it.
// style.colour, style.back: colours of the two sides; style.size.x: 1 if the springs' values colour it; w: opacity.

struct Corner {
    @builtin(position) clip: vec4<f32>,
    @location(0) offset: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // The springs' colour, and 1 where the point exists.
    @location(2) tint: vec4<f32>,
}

// Twice the area of the triangles around a point, along their normals, m².
fn normal_at(place: vec3<f32>, rim: vec4<u32>) -> vec3<f32> {
    var normal = vec3<f32>(0.0);
    for (var index = rim.x; index < rim.x + rim.y; index++) {
        let pair = textureLoad(fans, cell(index), 0).xy;
        let b = point_at(pair.x);
        let c = point_at(pair.y);
        if b.w > 0.0 && c.w > 0.0 {
            normal += cross(b.xyz - place, c.xyz - place);
        }
    }
    return normal;
}

// The mean over a point's springs of what colours mean.
fn value_at(place: vec3<f32>, rim: vec4<u32>) -> f32 {
    var sum = 0.0;
    var count = 0.0;
    for (var index = rim.z; index < rim.z + rim.w; index++) {
        let spoke = textureLoad(spokes, cell(index), 0).xy;
        let other = point_at(spoke.x);
        let spring = textureLoad(springs, cell(spoke.y), 0).xy;
        if other.w > 0.0 && spring.y >= 0.0 {
            sum += spring_value(length(other.xyz - place), spring);
            count += 1.0;
        }
    }
    return sum / max(count, 1.0);
}

@vertex
fn vs_main(@builtin(vertex_index) point: u32) -> Corner {
    var out: Corner;
    let place = point_at(point);
    let rim = textureLoad(rims, cell(point), 0);
    // Triangles with a corner that does not exist are left out pixel by pixel; the corner itself may be anywhere.
    out.offset = place.xyz - frame.eye.xyz;
    out.clip = clip_of(view_of(out.offset));
    let sum = normal_at(place.xyz, rim);
    let size = length(sum);
    out.normal = select(-frame.forward.xyz, sum / max(size, 1e-30), size > 1e-30);
    out.tint = vec4<f32>(0.0, 0.0, 0.0, select(0.0, 1.0, place.w > 0.0));
    if style.size.x > 0.5 {
        out.tint = vec4<f32>(scale_colour(value_at(place.xyz, rim)), out.tint.w);
    }
    return out;
}

@fragment
fn fs_main(in: Corner, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let depth = dot(in.offset, frame.forward.xyz);
    let place = in.offset + frame.eye.xyz;
    // From pixel to pixel; at outlines, where it moves fast, the line must not spread.
    let pixel = pixel_at(depth);
    let moved = clamp(fwidth(place), vec3<f32>(0.3 * pixel), vec3<f32>(1.6 * pixel));
    if in.tint.w < 0.999 {
        discard;
    }
    let toward = -normalize(in.offset);
    var normal = normalize(in.normal);
    // The side that is seen; a smooth normal may just turn away from the eye at an outline.
    normal = select(-normal, normal, front);
    var base = select(style.back.rgb, style.colour.rgb, front);
    if style.size.x > 0.5 {
        base = in.tint.rgb;
    }
    let lit = lit_on(place, normal);
    var colour = shade(base, normal, toward, 0.06, 0.25, 1.0, lit);
    colour = waterline(colour, place, moved);
    if style.size.w < 1.0 {
        colour = base * (0.8 + 0.2 * dot(normal, toward)); // a ghost throws back no light
    }
    return vec4<f32>(kept(hazed(colour, depth)), style.size.w);
}

struct Cast {
    @builtin(position) clip: vec4<f32>,
    @location(0) exists: f32,
}

@vertex
fn vs_shadow(@builtin(vertex_index) point: u32) -> Cast {
    let place = point_at(point);
    var out: Cast;
    out.clip = vec4<f32>(light_of(place.xyz), 1.0);
    out.exists = select(0.0, 1.0, place.w > 0.0);
    return out;
}

@fragment
fn fs_shadow(in: Cast) {
    if in.exists < 0.999 {
        discard;
    }
}
