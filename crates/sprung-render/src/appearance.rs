//! How a scene is to look: what is shown, and what colours mean. Chosen by the user, the same for every moment.

use glam::Vec3;
use serde::{Deserialize, Serialize};
use sprung::{Model, Params};

use crate::colour::{Colour, diverging, srgb};
use crate::ground::nice_step;

/// Springs looked at for the colour scale; of more, an even selection.
const SPRINGS_SAMPLED: usize = 100_000;

/// How points are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Points {
    /// Shaded spheres where there are few enough, else none.
    #[default]
    Auto,
    /// Shaded spheres.
    Spheres,
    /// Not at all.
    Hidden,
}

impl Points {
    /// All of them, for menus.
    pub const ALL: [Self; 3] = [Self::Auto, Self::Spheres, Self::Hidden];

    /// Its name in a menu.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "automatic",
            Self::Spheres => "spheres",
            Self::Hidden => "hidden",
        }
    }
}

/// How springs are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Springs {
    /// Coils where there are few, lines where there are more, nothing where a surface covers them.
    #[default]
    Auto,
    /// Round lines.
    Lines,
    /// Coils that stretch; lines where there are thousands.
    Coils,
    /// Not at all.
    Hidden,
}

impl Springs {
    /// All of them, for menus.
    pub const ALL: [Self; 4] = [Self::Auto, Self::Lines, Self::Coils, Self::Hidden];

    /// Its name in a menu.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "automatic",
            Self::Lines => "lines",
            Self::Coils => "coils",
            Self::Hidden => "hidden",
        }
    }
}

/// How cloths and skins are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Surfaces {
    /// Filled for cloths and for large skins.
    #[default]
    Auto,
    /// Filled, with smooth normals.
    Filled,
    /// Filled, with the edges of the triangles.
    Wireframe,
    /// Not at all.
    Hidden,
}

impl Surfaces {
    /// All of them, for menus.
    pub const ALL: [Self; 4] = [Self::Auto, Self::Filled, Self::Wireframe, Self::Hidden];

    /// Its name in a menu.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "automatic",
            Self::Filled => "filled",
            Self::Wireframe => "with edges",
            Self::Hidden => "hidden",
        }
    }
}

/// What the colour of a spring means; of a surface, the mean over the springs of each point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ColourBy {
    /// One colour for all.
    Plain,
    /// (ℓ − L)/L.
    Strain,
    /// k_s(ℓ − L), N.
    #[default]
    Tension,
    /// ½k_s(ℓ − L)², J.
    Energy,
}

impl ColourBy {
    /// All of them, for menus.
    pub const ALL: [Self; 4] = [Self::Plain, Self::Strain, Self::Tension, Self::Energy];

    /// Its name in a menu.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Strain => "strain",
            Self::Tension => "tension",
            Self::Energy => "energy",
        }
    }

    /// The unit of its values; empty for none.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Plain | Self::Strain => "",
            Self::Tension => "N",
            Self::Energy => "J",
        }
    }

    /// Whether its values are negative for springs that are pushed together; then the scale has two arms.
    pub fn is_signed(self) -> bool {
        matches!(self, Self::Strain | Self::Tension)
    }

    /// What a spring has to say, in this unit: `stiffness` in N/m, lengths in m.
    pub fn value(self, stiffness: f32, length: f32, rest_length: f32) -> f32 {
        let longer = length - rest_length;
        match self {
            Self::Plain => 0.0,
            Self::Strain => longer / rest_length.max(1e-12),
            Self::Tension => stiffness * longer,
            Self::Energy => 0.5 * stiffness * longer * longer,
        }
    }
}

/// Light or dark surroundings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Theme {
    /// Dark things on a bright background.
    #[default]
    Light,
    /// Bright things on a dark background.
    Dark,
}

impl Theme {
    /// All of them, for menus.
    pub const ALL: [Self; 2] = [Self::Light, Self::Dark];

    /// Its name in a menu.
    pub fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Dark => "dark",
        }
    }
}

/// All of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Appearance {
    /// Light or dark.
    pub theme: Theme,
    /// The background, sRGB, or the theme's own.
    pub background: Option<[u8; 3]>,
    /// Points.
    pub points: Points,
    /// Springs.
    pub springs: Springs,
    /// Cloths and skins.
    pub surfaces: Surfaces,
    /// What colours mean.
    pub colour_by: ColourBy,
    /// The value at which the colour scale ends (in the unit of `colour_by`).
    pub full_scale: f32,
    /// An arrow at each point along its velocity; how long it is for 1 m/s, m. Zero: none.
    pub velocity_arrows: f32,
    /// An arrow at each point along the force on it; how long it is for 1 N, m. Zero: none.
    pub force_arrows: f32,
    /// Ground planes with their grid.
    pub ground: bool,
    /// Shadows.
    pub shadows: bool,
}

impl Default for Appearance {
    fn default() -> Self {
        Self {
            theme: Theme::Light,
            background: None,
            points: Points::Auto,
            springs: Springs::Auto,
            surfaces: Surfaces::Auto,
            colour_by: ColourBy::Tension,
            full_scale: 1.0,
            velocity_arrows: 0.0,
            force_arrows: 0.0,
            ground: true,
            shadows: true,
        }
    }
}

impl Appearance {
    /// A round value for `full_scale`, in the unit of `colour_by`: all but the strongest hundredth of the springs stay
    /// below it. 1 if there is nothing to go by.
    pub fn full_scale_for(model: &Model, params: &Params, positions: &[Vec3], colour_by: ColourBy) -> f32 {
        let stride = model.spring_count().div_ceil(SPRINGS_SAMPLED).max(1);
        let value = |spring: usize| {
            let [i, j] = model.springs()[spring];
            let (a, b) = (positions.get(i as usize)?, positions.get(j as usize)?);
            let (stiffness, rest) = (params.spring_stiffness[spring], params.spring_rest_length[spring]);
            let value = colour_by.value(stiffness, (*a - *b).length(), rest).abs();
            (value.is_finite() && !params.spring_cut[spring]).then_some(value)
        };
        let mut values: Vec<f32> = (0..model.spring_count()).step_by(stride).filter_map(value).collect();
        let Some(last) = values.len().checked_sub(1) else { return 1.0 };
        nice_above(*values.select_nth_unstable_by(last - last / 100, f32::total_cmp).1)
    }

    /// The colour of the scale at a share of its full value, for legends: from -1 to 1 if it is signed, else from 0 to 1.
    /// It is the one that springs and surfaces have before light falls on them.
    pub fn scale_colour(&self, share: f32) -> Colour {
        if self.colour_by.is_signed() { diverging(share) } else { sequential(self.theme, share) }
    }
}

/// The smallest of 1, 2, 5, 10, … (and their fractions) that is not below a value; 1 where there is none.
fn nice_above(value: f32) -> f32 {
    if !(value > 1e-6 && value < 1e12) {
        return 1.0;
    }
    let step = nice_step(value);
    if step >= value * 0.999 { step } else { nice_step(2.1 * step).max(nice_step(2.6 * step)) }
}

/// From nothing (near the background) to much (far from it), through colours whose lightness changes evenly, so that
/// every kind of colour sight puts them in the same order.
fn sequential(theme: Theme, share: f32) -> Colour {
    let stops: [u32; 5] = match theme {
        Theme::Light => [0xd9_dd_e0, 0xf0_c5_5c, 0xe0_7b_39, 0xa8_32_42, 0x4a_14_48],
        Theme::Dark => [0x55_66_7c, 0x8a_5c_a8, 0xd8_5a_6c, 0xf5_a0_48, 0xfc_f3_ac],
    };
    let at = share.clamp(0.0, 1.0) * (stops.len() - 1) as f32;
    let low = (at as usize).min(stops.len() - 2);
    srgb(stops[low]).lerp(srgb(stops[low + 1]), at - low as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::{Material, ModelBuilder};

    #[test]
    fn names_in_a_menu_differ() {
        fn differ<const N: usize>(mut names: [&str; N]) {
            names.sort_unstable();
            assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
        }
        differ(Points::ALL.map(Points::name));
        differ(Springs::ALL.map(Springs::name));
        differ(Surfaces::ALL.map(Surfaces::name));
        differ(ColourBy::ALL.map(ColourBy::name));
        differ(Theme::ALL.map(Theme::name));
    }

    #[test]
    fn a_colour_scale_ends_at_a_round_value() {
        let mut builder = ModelBuilder::new();
        builder.add_point(Vec3::ZERO, 1.0).expect("allowed");
        builder.add_point(2.0 * Vec3::X, 1.0).expect("allowed");
        builder.add_spring(0, 1, Material { stiffness: 60.0, damping: 0.0 }).expect("allowed");
        let (model, params, _) = builder.build().expect("sound");
        // Stretched from 2 m to 2.6 m: strain 0.3, tension 36 N, energy 10.8 J.
        let stretched = [Vec3::ZERO, 2.6 * Vec3::X];
        let found = ColourBy::ALL.map(|by| Appearance::full_scale_for(&model, &params, &stretched, by));
        assert_eq!(found, [1.0, 0.5, 50.0, 20.0]);
        let missing = Appearance::full_scale_for(&model, &params, &[], ColourBy::Tension);
        assert_eq!(missing, 1.0);
    }

    #[test]
    fn energy_gets_steadily_farther_from_the_background() {
        let lightness = |theme, share| sequential(theme, share).dot(Vec3::new(0.2126, 0.7152, 0.0722));
        for step in 0..20 {
            let (a, b) = (step as f32 / 20.0, (step + 1) as f32 / 20.0);
            assert!(lightness(Theme::Light, a) > lightness(Theme::Light, b), "{a}");
            assert!(lightness(Theme::Dark, a) < lightness(Theme::Dark, b), "{a}");
        }
    }
}
