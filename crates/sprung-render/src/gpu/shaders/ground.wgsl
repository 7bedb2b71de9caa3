// A plane: a translucent sheet with a grid and the shadows of what is above, fading away from its middle.
// style.origin: its middle, m, and how far it reaches; along_u, along_v: its axes; along_u.w: distance of the grid's
// lines, m. style.colour: the sheet and its opacity; line: the grid and its opacity; dark: the shadow and its opacity.

struct Sheet {
    @builtin(position) clip: vec4<f32>,
    @location(0) offset: vec3<f32>,
    @location(1) away: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> Sheet {
    var out: Sheet;
    out.away = vec2<f32>(f32(vertex & 1u), f32(vertex >> 1u)) * 2.0 - 1.0;
    let across = (style.along_u.xyz * out.away.x + style.along_v.xyz * out.away.y) * style.origin.w;
    out.offset = style.origin.xyz + across - frame.eye.xyz;
    out.clip = clip_of(view_of(out.offset));
    return out;
}

// Lines of an even width; where they come closer than a few pixels they fade instead of shimmering.
fn lines_at(place: vec2<f32>, width: vec2<f32>, gap: f32) -> f32 {
    let distance = abs(place - round(place / gap) * gap) / width;
    let crowd = clamp(1.5 - 5.0 * width / gap, vec2<f32>(0.0), vec2<f32>(1.0));
    let line = clamp(1.1 - distance, vec2<f32>(0.0), vec2<f32>(1.0)) * crowd;
    return max(line.x, line.y);
}

fn over(below: vec4<f32>, colour: vec3<f32>, alpha: f32) -> vec4<f32> {
    let total = alpha + below.a * (1.0 - alpha);
    return vec4<f32>(mix(below.rgb, colour, alpha / max(total, 1e-6)), total);
}

@fragment
fn fs_main(in: Sheet) -> @location(0) vec4<f32> {
    let place = in.offset + frame.eye.xyz;
    let at = vec2<f32>(dot(place, style.along_u.xyz), dot(place, style.along_v.xyz));
    let width = max(fwidth(at), vec2<f32>(1e-12));
    let far = length(in.away);
    if far >= 1.0 {
        discard;
    }
    let near = clamp((1.0 - far) / 0.85, 0.0, 1.0);
    let fade = near * near * (3.0 - 2.0 * near);
    let gap = style.along_u.w;
    let lines = max(0.55 * lines_at(at, width, gap), lines_at(at, width, 5.0 * gap));
    var out = vec4<f32>(style.colour.rgb, style.colour.a * fade);
    out = over(out, style.line.rgb, style.line.a * lines * fade);
    if frame.light_y.w > 0.0 {
        let dark = 1.0 - soft_light(place - frame.light_z.xyz * frame.above.w);
        out = over(out, style.dark.rgb, style.dark.a * dark * frame.light_y.w);
    }
    if quick {
        // Numbers are mixed here, not light; on the background it shall come to the same.
        let behind = 0.5 * (frame.backdrop_top.rgb + frame.backdrop_bottom.rgb);
        let mixed = kept(mix(behind, out.rgb, out.a));
        let from_behind = kept(behind);
        return vec4<f32>(from_behind + (mixed - from_behind) / max(out.a, 1e-3), out.a);
    }
    return out;
}
