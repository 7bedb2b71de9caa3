//! Points and springs in code: the engine's builder, with lattices that know their sides.

use js_sys::Uint32Array;
use sprung::build::{Lattice, Material, ModelBuilder, SpringKind, estimated_bytes};
use sprung::scene::MAX_POINTS;
use sprung::stability;
use sprung::{Code, DVec3, Error, Result, Simulation, SurfaceKind};
use wasm_bindgen::prelude::*;

use crate::javascript::{Thrown, index, room_for, thrown, vector, whole};
use crate::simulation::EngineSimulation;
use crate::tell;

/// Collects points and springs.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct EngineBuilder {
    builder: ModelBuilder,
    /// Each with its first point.
    lattices: Vec<(usize, Lattice)>,
    /// What errors and front ends call it.
    title: String,
}

#[wasm_bindgen]
impl EngineBuilder {
    /// An empty one.
    #[wasm_bindgen(constructor)]
    pub fn new(title: String) -> Self {
        Self { title, ..Self::default() }
    }

    /// Begins a body.
    pub fn body(&mut self, name: String) -> Thrown {
        self.builder.begin_body(name).map_err(thrown)
    }

    /// Begins a joint between bodies.
    pub fn joint(&mut self, name: String) {
        self.builder.begin_joint(name);
    }

    /// Adds points, three numbers each (m), all of one mass or each of its own (kg); gives the first.
    pub fn points(&mut self, places: &[f64], masses: &[f64]) -> Thrown<usize> {
        self.add_points(places, masses).map_err(thrown)
    }

    /// Adds a lattice of points, with its surface: how many along x, y and z, their distance, where the first lies (m), and
    /// the mass of each (kg). Gives its number.
    pub fn lattice(&mut self, counts: &[f64], spacing: f64, origin: &[f64], mass: f64) -> Thrown<usize> {
        let counts = [0, 1, 2].map(|axis| counts.get(axis).copied().unwrap_or(f64::NAN));
        let lattice = || {
            let mut whole_counts = [0u32; 3];
            for (count, &wanted) in whole_counts.iter_mut().zip(&counts) {
                *count = u32::try_from(whole("points", wanted)?).unwrap_or(u32::MAX);
                if *count == 0 {
                    return Err(
                        Error::new(Code::OutOfRange, "is 0, and must be at least 1").at_field("points")
                    );
                }
            }
            if !(spacing > 0.0 && spacing.is_finite()) {
                let sentence = format!("is {spacing}, and must be a finite number above 0 m");
                return Err(Error::new(Code::OutOfRange, sentence).at_field("spacing"));
            }
            Ok(Lattice::new(whole_counts, spacing))
        };
        lattice().and_then(|lattice| self.add_lattice(lattice, origin, mass)).map_err(thrown)
    }

    /// Adds points in a row: how many, from one to the next (m), the first (m), the mass of each (kg).
    pub fn chain(&mut self, points: f64, step: &[f64], origin: &[f64], mass: f64) -> Thrown<usize> {
        let chain = || {
            let points = u32::try_from(whole("points", points)?).unwrap_or(u32::MAX);
            if points == 0 {
                return Err(Error::new(Code::OutOfRange, "is 0, and must be at least 1").at_field("points"));
            }
            let step = DVec3::from_slice(step);
            if !(step.is_finite() && step != DVec3::ZERO) {
                let sentence = format!("is {step}, and must be finite and not zero");
                return Err(Error::new(Code::OutOfRange, sentence).at_field("step"));
            }
            Ok(Lattice::chain(points, step))
        };
        chain().and_then(|chain| self.add_lattice(chain, origin, mass)).map_err(thrown)
    }

    /// The first point of a lattice.
    pub fn first_of(&self, lattice: usize) -> usize {
        self.lattices[lattice].0
    }

    /// The points of a side of a lattice, by its name.
    pub fn side(&self, lattice: usize, name: &str) -> Thrown<Vec<u32>> {
        let (first, lattice) = &self.lattices[lattice];
        let Some(side) = lattice.side(name) else {
            let sentence =
                format!("there is no side \"{name}\"; there are {}", lattice.side_names().join(", "));
            return Err(thrown(Error::new(Code::NotFound, sentence).at_field("side")));
        };
        Ok(lattice.side_points(side).map(|point| *first as u32 + point).collect())
    }

    /// Joins neighbours in a lattice: those along its axes (1), across squares (2), two apart (4), or several of them; gives the
    /// first spring.
    pub fn connect(&mut self, lattice: usize, kinds: u32, stiffness: f64, damping: f64) -> Thrown<usize> {
        let (first, lattice) = self.lattices[lattice];
        let chosen = [SpringKind::Structural, SpringKind::Shear, SpringKind::Bend];
        let chosen = chosen.into_iter().enumerate().filter(|(bit, _)| kinds & (1 << bit) != 0);
        let begin = self.builder.spring_count();
        for [i, j] in chosen.flat_map(|(_, kind)| lattice.pairs(kind)) {
            let ends = [first + i as usize, first + j as usize];
            self.builder.add_spring(ends[0], ends[1], material(stiffness, damping)).map_err(thrown)?;
        }
        Ok(begin)
    }

    /// Joins all points from one to another (not included) that are no further apart than the radius (m); gives the first
    /// spring.
    pub fn connect_within(
        &mut self,
        first: f64,
        end: f64,
        radius: f64,
        stiffness: f64,
        damping: f64,
    ) -> Thrown<usize> {
        let mut made = || {
            let range = index("points", first)?..index("points", end)?;
            self.builder.connect_within(range, radius as f32, material(stiffness, damping))
        };
        made().map(|springs| springs.start).map_err(thrown)
    }

    /// Joins all points of one range to all of another that are no further apart than the radius (m); gives the first spring.
    pub fn connect_between(
        &mut self,
        ranges: &[f64],
        radius: f64,
        stiffness: f64,
        damping: f64,
    ) -> Thrown<usize> {
        let mut made = || {
            let mut ends = [0; 4];
            for (end, &given) in ends.iter_mut().zip(ranges) {
                *end = index("points", given)?;
            }
            let [a, b] = [ends[0]..ends[1], ends[2]..ends[3]];
            self.builder.connect_between(a, b, radius as f32, material(stiffness, damping))
        };
        made().map(|springs| springs.start).map_err(thrown)
    }

    /// Joins two points; with a rest length (m), or else the one that the spring has now. Gives the spring.
    pub fn spring(
        &mut self,
        a: f64,
        b: f64,
        stiffness: f64,
        damping: f64,
        rest_length: Option<f64>,
    ) -> Thrown<usize> {
        let mut made = || {
            let ends = [index("spring", a)?, index("spring", b)?];
            let spring = self.builder.add_spring(ends[0], ends[1], material(stiffness, damping))?;
            if let Some(length) = rest_length {
                self.builder.set_rest_length(spring, length as f32)?;
            }
            Ok(spring)
        };
        made().map_err(thrown)
    }

    /// Pins a point.
    pub fn pin(&mut self, point: f64) -> Thrown {
        index("pin", point).and_then(|point| self.builder.pin(point)).map_err(thrown)
    }

    /// Gives a point its first velocity, m/s.
    pub fn velocity(&mut self, point: f64, x: f64, y: f64, z: f64) -> Thrown {
        let point = index("velocity", point);
        point.and_then(|point| self.builder.set_velocity(point, vector(x, y, z))).map_err(thrown)
    }

    /// Gives the current body a surface; `skin` says whether it is closed.
    pub fn surface(&mut self, triangles: &Uint32Array, skin: bool) -> Thrown {
        let corners = triangles.to_vec();
        let kind = if skin { SurfaceKind::Skin } else { SurfaceKind::Cloth };
        let triangles = corners.as_chunks().0.to_vec();
        self.builder.add_surface(kind, triangles).map_err(thrown)
    }

    /// How many points there are so far.
    pub fn point_count(&self) -> usize {
        self.builder.point_count()
    }

    /// How many springs there are so far.
    pub fn spring_count(&self) -> usize {
        self.builder.spring_count()
    }

    /// The simulation of what was built: gravity (m/s²), nine numbers for each plane, substeps, and dt (s), or the largest that
    /// is safely stable. What was built stays, to be added to.
    pub fn simulation(
        &self,
        dt: Option<f64>,
        substeps: f64,
        gravity: &[f64],
        planes: &[f64],
    ) -> Thrown<EngineSimulation> {
        let parts = || {
            let (model, mut params, state) = self.builder.clone().build()?;
            params.substeps = u32::try_from(whole("substeps", substeps)?).unwrap_or(u32::MAX);
            params.gravity = DVec3::from_slice(gravity).as_vec3();
            params.planes = tell::planes_from(planes)?;
            params.dt = match dt {
                Some(dt) => dt,
                None => stability::auto_dt(&model, &params).map_err(|error| error.at_field("dt"))?,
            };
            Simulation::new(model, params, state)
        };
        parts().map(|made| EngineSimulation::new(made, self.title.clone(), String::new())).map_err(thrown)
    }
}

impl EngineBuilder {
    fn add_points(&mut self, places: &[f64], masses: &[f64]) -> Result<usize> {
        let places = places.as_chunks::<3>().0;
        let mass = |point: usize| match masses {
            [mass] => Ok(*mass),
            _ => masses.get(point).copied().ok_or_else(|| {
                let sentence = format!("has {} entries, and there are {} points", masses.len(), places.len());
                Error::new(Code::Conflict, sentence).at_field("mass")
            }),
        };
        let first = self.builder.point_count();
        room_for(estimated_bytes(places.len() as u64, 0), "the model")?;
        for (point, &place) in places.iter().enumerate() {
            self.builder.add_point(DVec3::from_array(place).as_vec3(), mass(point)? as f32)?;
        }
        Ok(first)
    }

    fn add_lattice(&mut self, lattice: Lattice, origin: &[f64], mass: f64) -> Result<usize> {
        let count = lattice.point_count();
        if count > MAX_POINTS {
            let sentence = format!("makes {count} points, and there may be at most {MAX_POINTS}");
            return Err(Error::new(Code::TooLarge, sentence).at_field("points"));
        }
        room_for(estimated_bytes(count, 0), "the model")?;
        let (first, origin) = (self.builder.point_count(), DVec3::from_slice(origin));
        for place in lattice.positions() {
            self.builder.add_point((origin + place).as_vec3(), mass as f32)?;
        }
        if let Some((kind, mut triangles)) = lattice.surface() {
            triangles.iter_mut().flatten().for_each(|corner| *corner += first as u32);
            self.builder.add_surface(kind, triangles)?;
        }
        self.lattices.push((first, lattice));
        Ok(self.lattices.len() - 1)
    }
}

fn material(stiffness: f64, damping: f64) -> Material {
    Material { stiffness: stiffness as f32, damping: damping as f32 }
}
