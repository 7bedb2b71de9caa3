//! Parameters and snapshots as bytes. The layout is that of version 1 of checkpoints: what is new comes behind it, under
//! another version.

use std::collections::BTreeMap;
use std::sync::Arc;

use sprung::{ContactLaw, Grab, Params, Plane, Result, Snapshot, Vec3};

use super::{Pack, Unpack, damaged};

impl Pack {
    /// All parameters.
    pub fn params(&mut self, params: &Params) -> &mut Self {
        self.short_params(params);
        self.f32s(&params.point_mass).bools(&params.point_pinned);
        self.f32s(&params.spring_stiffness).f32s(&params.spring_damping).f32s(&params.spring_rest_length);
        self.bools(&params.spring_cut)
    }

    /// All of them but the arrays over points and springs.
    pub fn short_params(&mut self, params: &Params) -> &mut Self {
        self.f64(params.dt).u32(params.substeps).vec3(params.gravity);
        self.u64(params.planes.len() as u64);
        for plane in &params.planes {
            let law = match plane.law {
                ContactLaw::Push => 0,
                ContactLaw::Report => 1,
            };
            self.vec3(plane.point).vec3(plane.normal).f32(plane.stiffness).f32(plane.damping).u8(law);
        }
        for vectors in [&params.external_forces, &params.carried] {
            self.u64(vectors.len() as u64);
            vectors.iter().for_each(|(&point, &vector)| {
                self.u64(point as u64).vec3(vector);
            });
        }
        self.u64(params.grabs.len() as u64);
        for grab in &params.grabs {
            self.u64(grab.point as u64).vec3(grab.target).f32(grab.stiffness).f32(grab.damping);
        }
        self
    }

    /// Step, time, positions and velocities.
    pub fn snapshot(&mut self, snapshot: &Snapshot) -> &mut Self {
        let Snapshot { step, time, positions, velocities } = snapshot;
        self.u64(*step).f64(*time).vec3s(positions).vec3s(velocities)
    }
}

impl Unpack<'_> {
    /// All parameters; that they fit a model is to be checked by [`Params::validate`].
    ///
    /// # Errors
    /// [`sprung::Code::Unreadable`].
    pub fn params(&mut self) -> Result<Params> {
        let mut params = self.short_params()?;
        params.point_mass = Arc::new(self.f32s()?);
        params.point_pinned = Arc::new(self.bools()?);
        params.spring_stiffness = Arc::new(self.f32s()?);
        params.spring_damping = Arc::new(self.f32s()?);
        params.spring_rest_length = Arc::new(self.f32s()?);
        params.spring_cut = Arc::new(self.bools()?);
        Ok(params)
    }

    /// All of them but the arrays over points and springs, which are empty.
    pub fn short_params(&mut self) -> Result<Params> {
        let (dt, substeps, gravity) = (self.f64()?, self.u32()?, self.vec3()?);
        // Collected one by one: a count is no reason to take memory.
        let planes = (0..self.u64()?).map(|_| self.plane()).collect::<Result<_>>()?;
        let external_forces = self.vectors()?;
        let carried = self.vectors()?;
        let grabs = (0..self.u64()?).map(|_| self.grab()).collect::<Result<_>>()?;
        Ok(Params {
            dt,
            substeps,
            gravity,
            planes,
            external_forces,
            grabs,
            carried,
            point_mass: Arc::default(),
            point_pinned: Arc::default(),
            spring_stiffness: Arc::default(),
            spring_damping: Arc::default(),
            spring_rest_length: Arc::default(),
            spring_cut: Arc::default(),
        })
    }

    fn plane(&mut self) -> Result<Plane> {
        let (point, normal) = (self.vec3()?, self.vec3()?);
        let (stiffness, damping) = (self.f32()?, self.f32()?);
        let law = match self.u8()? {
            0 => ContactLaw::Push,
            1 => ContactLaw::Report,
            _ => return Err(damaged("names a law of contact that there is not")),
        };
        Ok(Plane { point, normal, stiffness, damping, law })
    }

    fn vectors(&mut self) -> Result<BTreeMap<usize, Vec3>> {
        let mut vectors = BTreeMap::new();
        for _ in 0..self.u64()? {
            let point = self.point()?;
            if vectors.insert(point, self.vec3()?).is_some() {
                return Err(damaged("names a point twice"));
            }
        }
        Ok(vectors)
    }

    fn grab(&mut self) -> Result<Grab> {
        let point = self.point()?;
        Ok(Grab { point, target: self.vec3()?, stiffness: self.f32()?, damping: self.f32()? })
    }

    fn point(&mut self) -> Result<usize> {
        usize::try_from(self.u64()?).map_err(|_| damaged("names a point that there cannot be"))
    }

    /// Step, time, positions and velocities.
    ///
    /// # Errors
    /// [`sprung::Code::Unreadable`].
    pub fn snapshot(&mut self) -> Result<Snapshot> {
        let (step, time) = (self.u64()?, self.f64()?);
        Ok(Snapshot { step, time, positions: self.vec3s()?, velocities: self.vec3s()? })
    }
}
