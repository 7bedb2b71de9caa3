// What is behind everything: a soft gradient, a little darker towards the corners, or one colour.
// style.size.x: 1 for one colour, which is then exact.

struct Corner {
    @builtin(position) clip: vec4<f32>,
    @location(0) at: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> Corner {
    // One triangle that covers the picture; infinitely far away.
    let at = vec2<f32>(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    var out: Corner;
    out.at = 2.0 * at - 1.0;
    out.clip = vec4<f32>(out.at, 0.0, 1.0);
    return out;
}

@fragment
fn fs_main(in: Corner) -> @location(0) vec4<f32> {
    if style.size.x > 0.5 {
        let light = frame.backdrop_top.rgb;
        if quick {
            let bright = 1.055 * pow(light, vec3<f32>(1.0 / 2.4)) - 0.055;
            return vec4<f32>(select(bright, 12.92 * light, light <= vec3<f32>(0.0031308)), 1.0);
        }
        return vec4<f32>(light, 1.0);
    }
    let height = 0.5 - 0.5 * in.at.y;
    let share = height * height * (3.0 - 2.0 * height);
    var colour = mix(frame.backdrop_top.rgb, frame.backdrop_bottom.rgb, share);
    colour *= 1.0 - frame.backdrop_top.w * dot(in.at, in.at);
    // A step of noise, so that the gradient shows no bands.
    let noise = fract(52.9829189 * fract(dot(in.clip.xy, vec2<f32>(0.06711056, 0.00583715)))) - 0.5;
    let step = (0.05 + 2.1 * sqrt(colour)) / 255.0;
    return vec4<f32>(kept(colour + noise * step), 1.0);
}
