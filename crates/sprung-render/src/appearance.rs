//! How a scene is to look: what is shown, and what colours mean. Chosen by the user, the same for every moment.

/// How points are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Points {
    /// Shaded spheres where there are few enough, else none.
    #[default]
    Auto,
    /// Shaded spheres.
    Spheres,
    /// Not at all.
    Hidden,
}

/// How springs are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Springs {
    /// Coils where there are few, lines where there are more, nothing where a surface covers them.
    #[default]
    Auto,
    /// Round lines.
    Lines,
    /// Coils that stretch.
    Coils,
    /// Not at all.
    Hidden,
}

/// How cloths and skins are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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

/// What the colour of a spring means; of a surface, the mean over the springs of each point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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

/// Light or dark surroundings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// Dark things on a bright background.
    #[default]
    Light,
    /// Bright things on a dark background.
    Dark,
}

/// All of it.
#[derive(Clone, Copy, Debug, PartialEq)]
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
