//! The studio's colours and lights, in the light and in the dark: of the graphics card's pictures, of the software ones (the
//! light studio's colours) and of what the window writes over its scene.

use sprung_io::export::geometry::{BODY_COLOURS, SPRING_COLOUR};

use crate::appearance::Theme;

/// Colours, sRGB as `0xRRGGBB`, and lights, linear.
pub struct Palette {
    /// Light from above.
    pub sky: [f32; 3],
    /// Light from below.
    pub floor: [f32; 3],
    /// The key light.
    pub sun: [f32; 3],
    /// The background at the top and at the bottom, and how much darker its corners are.
    pub backdrop: ([u32; 2], f32),
    /// What far things fade into, and how far they do.
    pub haze: (u32, f32),
    /// Points of the bodies, in turn.
    pub balls: [u32; 6],
    /// Fixed points.
    pub fixed: u32,
    /// Front and back of cloths with springs drawn on them, and without.
    pub cloth_pale: [u32; 2],
    /// Front and back of cloths alone.
    pub cloth_rich: [u32; 2],
    /// Outside and inside of skins.
    pub skin: [u32; 2],
    /// Springs when colours mean nothing, and edges of triangles.
    pub wire: u32,
    /// Edges of triangles.
    pub edge: u32,
    /// A plane, its grid and its shadows, with their opacities.
    pub sheet: (u32, f32),
    /// The grid.
    pub grid: (u32, f32),
    /// Shadows.
    pub shadow: (u32, f32),
    /// The line where things cross a plane.
    pub waterline: (u32, f32),
    /// An earlier run, and how opaque it is.
    pub ghost: (u32, f32),
    /// What is selected.
    pub selected: u32,
    /// What is under the cursor.
    pub hovered: u32,
    /// What sets the limit or blew up.
    pub alarm: u32,
    /// Pulls.
    pub pull: u32,
    /// Arrows of velocities.
    pub velocity: u32,
    /// Arrows of forces.
    pub force: u32,
}

/// A bright studio. The software renderer takes its colours; lights of its own, as it has no ambient shadow.
pub static LIGHT: Palette = Palette {
    sky: [0.68, 0.69, 0.70],
    floor: [0.42, 0.41, 0.41],
    sun: [0.66, 0.63, 0.58],
    backdrop: ([0xf6_f8_fa, 0xd8_df_e6], 0.03),
    haze: (0xe4_ea_f0, 0.26),
    balls: BODY_COLOURS,
    fixed: 0x1f_24_2b,
    cloth_pale: [0xe8_d4_b4, 0xa4_c4_d2],
    cloth_rich: [0x1f_8f_94, 0xec_9a_50],
    skin: [0x2a_a3_90, 0x18_58_4e],
    wire: SPRING_COLOUR,
    edge: 0x3d_4a_58,
    sheet: (0xfb_fc_fd, 0.42),
    grid: (0x4a_58_68, 0.36),
    shadow: (0x26_2f_3c, 0.5),
    waterline: (0x2b_3a_4c, 0.75),
    ghost: (0x6d_7f_99, 0.34),
    selected: 0x7a_35_d2,
    hovered: 0x22_2b_36,
    alarm: 0xe0_00_5c,
    pull: 0x7a_35_d2,
    velocity: 0x1b_7f_3b,
    force: 0xa0_1f_6e,
};

/// The same studio with the lights on the things alone.
pub static DARK: Palette = Palette {
    sky: [0.50, 0.53, 0.58],
    floor: [0.20, 0.21, 0.23],
    sun: [0.74, 0.72, 0.68],
    backdrop: ([0x22_28_31, 0x12_16_1c], 0.12),
    haze: (0x1a_20_28, 0.34),
    balls: [0x35_b6_c6, 0xa6_84_e0, 0x86_c2_52, 0xe2_88_ac, 0xc8_a4_58, 0x6a_98_e6],
    fixed: 0xee_f1_f4,
    cloth_pale: [0x3c_46_52, 0x2c_40_4c],
    cloth_rich: [0x2b_a7_ac, 0xf0_a2_5a],
    skin: [0x35_b5_a0, 0x1d_66_5a],
    wire: 0x93_9e_ab,
    edge: 0x10_18_20,
    sheet: (0x36_41_4e, 0.5),
    grid: (0x9f_b2_c6, 0.20),
    shadow: (0x05_07_0a, 0.7),
    waterline: (0xd6_e4_f2, 0.7),
    ghost: (0xa9_bb_d2, 0.26),
    selected: 0xc9_9b_ff,
    hovered: 0xff_ff_ff,
    alarm: 0xff_4d_8d,
    pull: 0xc9_9b_ff,
    velocity: 0x5f_d9_84,
    force: 0xf0_86_c4,
};

/// The palette of a theme.
pub fn palette(theme: Theme) -> &'static Palette {
    match theme {
        Theme::Light => &LIGHT,
        Theme::Dark => &DARK,
    }
}
