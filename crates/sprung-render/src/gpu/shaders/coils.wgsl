// Springs as coils: a tube along a helix whose turns stay when it is stretched, with straight leads at both ends.
// style.size: radius of the points, m; least radius of the wire, pixels; 1 if the style's colour is to be taken;
// the median rest length, m. The index buffer knows SEGMENTS and SIDES as well.

const SEGMENTS = 265u;
const SIDES = 8u;
const TAU = 6.2831853;

struct Tube {
    @builtin(position) clip: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) offset: vec3<f32>,
    @location(2) @interpolate(flat) colour: vec3<f32>,
}

struct Helix {
    a: vec3<f32>,
    b: vec3<f32>,
    along: vec3<f32>,
    side: vec3<f32>,
    other: vec3<f32>,
    turns: f32,
    radius: f32,
    lead: f32,
    length: f32,
}

fn helix_between(a: vec3<f32>, b: vec3<f32>, rest: f32) -> Helix {
    var helix: Helix;
    helix.a = a;
    helix.b = b;
    helix.length = length(b - a);
    helix.along = select(vec3<f32>(0.0, 1.0, 0.0), (b - a) / max(helix.length, 1e-30), helix.length > 1e-30);
    let helper = select(vec3<f32>(0.0, 0.0, 1.0), vec3<f32>(1.0, 0.0, 0.0), abs(helix.along.z) > 0.9);
    helix.side = normalize(cross(helix.along, helper));
    helix.other = cross(helix.along, helix.side);
    // A longer spring has more turns of the same size.
    let typical = max(style.size.w, 1e-30);
    helix.turns = clamp(round(11.0 * rest / typical), 4.0, 20.0);
    helix.radius = 0.11 * clamp(rest, 0.2 * typical, typical);
    helix.lead = min(1.4 * style.size.x, 0.25 * helix.length);
    return helix;
}

fn angle_at(helix: Helix, share: f32) -> f32 {
    return fract(share * helix.turns) * TAU;
}

fn helix_at(helix: Helix, share: f32) -> vec3<f32> {
    // The first and last turn grow out of the axis.
    let swell = clamp(min(share, 1.0 - share) * helix.turns, 0.0, 1.0);
    let angle = angle_at(helix, share);
    let out_of = (helix.side * cos(angle) + helix.other * sin(angle)) * (helix.radius * swell);
    return helix.a + helix.along * (helix.lead + (helix.length - 2.0 * helix.lead) * share) + out_of;
}

struct Skin {
    place: vec3<f32>,
    normal: vec3<f32>,
    colour: vec3<f32>,
    found: bool,
}

// A place on the tube, m, and its normal; `least` is the least radius of the wire, m.
fn skin_at(vertex: u32, spring: vec3<u32>, pixels: f32) -> Skin {
    var out: Skin;
    let a = point_at(spring.x);
    let b = point_at(spring.y);
    let constants = textureLoad(springs, cell(spring.z), 0).xy;
    if a.w <= 0.0 || b.w <= 0.0 || constants.y < 0.0 {
        return out;
    }
    out.found = true;
    let helix = helix_between(a.xyz, b.xyz, constants.y);
    let segment = vertex / SIDES;
    let share = clamp((f32(segment) - 1.0) / f32(SEGMENTS - 2u), 0.0, 1.0);
    var centre = helix_at(helix, share);
    if segment == 0u {
        centre = helix.a;
    }
    if segment == SEGMENTS {
        centre = helix.b;
    }
    let angle = angle_at(helix, share);
    let radial = helix.side * cos(angle) + helix.other * sin(angle);
    // Along the wire, from its neighbours; the leads run along the axis.
    let hair = 0.5 / f32(SEGMENTS);
    let before = helix_at(helix, max(share - hair, 0.0));
    let after = helix_at(helix, min(share + hair, 1.0));
    let step = after - before;
    let is_lead = segment == 0u || segment == SEGMENTS || length(step) < 1e-30;
    let tangent = select(step / max(length(step), 1e-30), helix.along, is_lead);
    let across = normalize(radial - tangent * dot(radial, tangent));
    let turn = f32(vertex % SIDES) * TAU / f32(SIDES);
    out.normal = across * cos(turn) + cross(tangent, across) * sin(turn);
    let depth = max(dot(centre - frame.eye.xyz, frame.forward.xyz), frame.eye.w);
    let radius = max(0.155 * helix.radius, pixels * pixel_at(depth));
    out.place = centre + out.normal * radius;
    out.colour = style.colour.rgb;
    if style.size.z < 0.5 {
        out.colour = scale_colour(spring_value(helix.length, constants));
    }
    return out;
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32, @location(0) spring: vec3<u32>) -> Tube {
    let skin = skin_at(vertex, spring, style.size.y);
    var out: Tube;
    out.clip = NOWHERE;
    if skin.found {
        out.offset = skin.place - frame.eye.xyz;
        out.normal = skin.normal;
        out.colour = skin.colour;
        out.clip = clip_of(view_of(out.offset));
    }
    return out;
}

@fragment
fn fs_main(in: Tube) -> @location(0) vec4<f32> {
    let normal = normalize(in.normal);
    let toward = -normalize(in.offset);
    let lit = lit_on(in.offset + frame.eye.xyz, normal);
    let colour = shade(in.colour, normal, toward, 0.3, 0.35, 1.0, lit);
    return vec4<f32>(kept(hazed(colour, dot(in.offset, frame.forward.xyz))), 1.0);
}

@vertex
fn vs_shadow(@builtin(vertex_index) vertex: u32, @location(0) spring: vec3<u32>) -> @builtin(position) vec4<f32> {
    let skin = skin_at(vertex, spring, 0.0);
    return select(NOWHERE, vec4<f32>(light_of(skin.place), 1.0), skin.found);
}
