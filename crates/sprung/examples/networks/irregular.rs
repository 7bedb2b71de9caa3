//! A network without any order, for measuring: the worst that the step can be given.

use sprung::{Material, ModelBuilder, Result, Simulation, Vec3};

/// Neighbours of a point, on average.
const NEIGHBOURS: f32 = 16.0;

/// So many points strewn over a cube, each joined to about 16 others, every rest length, stiffness and damping different.
///
/// # Errors
/// As [`ModelBuilder::connect_within`] and [`Simulation::new`]: if there are no points, or too many.
pub fn irregular(points: usize) -> Result<Simulation> {
    let mut random = Random(3);
    let side = (points as f32).cbrt();
    let mut builder = ModelBuilder::new();
    for _ in 0..points {
        builder.add_point(random.point() * side, 1.0)?;
    }
    let sphere = 4.0 / 3.0 * std::f32::consts::PI;
    let radius = side * (NEIGHBOURS / (sphere * points as f32)).cbrt();
    builder.connect_within(0..points, radius, Material { stiffness: 100.0, damping: 1.0 })?;
    let (model, mut params, state) = builder.build()?;
    let mut vary =
        |values: &[f32]| values.iter().map(|value| value * (0.5 + random.unit())).collect::<Vec<f32>>();
    params.spring_stiffness = vary(&params.spring_stiffness).into();
    params.spring_damping = vary(&params.spring_damping).into();
    Simulation::new(model, params, state)
}

/// Random numbers from splitmix64 (Steele, Lea, Flood 2014): the same numbers on every machine.
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 to 1.
    pub fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u32 << 24) as f32
    }

    /// In the unit cube.
    pub fn point(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit())
    }

    /// From 0 to `count` − 1.
    #[allow(dead_code)] // not every program that measures needs it
    pub fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }
}
