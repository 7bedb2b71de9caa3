//! All regions: into how many the points are divided, and how states go in and out.

mod certify;
mod march;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::{DVec3, Vec3};

use self::certify::Certifier;
use self::march::{Border, Taken, for_each, receive};
use super::aligned::Arrays;
use super::energy::{KineticSurvey, Sums, Survey};
use super::integrate::Field;
use super::laws::Laws;
use super::level::{Checked, Level};
use super::loose::LooseMotions;
use super::plan::Plan;
use super::region::Region;
use super::sweep::{Purpose, Push, PushKind, Sweep};
use super::{BLOCK, GROUP};
use crate::energy::Energy;
use crate::model::Model;
use crate::params::{Grab, Params};
use crate::state::{Snapshot, State};
use crate::workers::Workers;

/// When it is worth while to call on another thread.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worth {
    /// Springs that each region has: handing over takes about as long as 20,000.
    pub springs: usize,
    /// Blocks that each region has for every one that it sweeps for its neighbour: that must be little beside its own. At
    /// least two, or a neighbour would need more than a region has.
    pub blocks_per_border: usize,
}

impl Default for Worth {
    fn default() -> Self {
        Self { springs: 65_536, blocks_per_border: 4 }
    }
}

/// The points of a model in the hidden order, packed springs, and the threads that step them.
#[derive(Debug)]
pub(crate) struct Team {
    plan: Arc<Plan>,
    laws: Arc<Laws>,
    level: Checked,
    worth: Worth,
    regions: Vec<Mutex<Region>>,
    /// What regions left for their neighbours at the last step, and where they leave it at the next; none for one region alone.
    borders: [Vec<Mutex<Border>>; 2],
    /// How many steps each region has taken, while they take some.
    taken: Vec<Taken>,
    /// Whether regions have yet to copy what their neighbours left.
    are_behind: bool,
    loose: LooseMotions,
    pushes: Vec<Push>,
    /// Whether the state that is [kept](Self::keep) is the current one; if not, it is in the regions' other arrays.
    are_kept_here: bool,
    certifier: Certifier,
}

impl Clone for Team {
    fn clone(&self) -> Self {
        let regions = self.regions.iter().map(|region| Mutex::new(lock(region).clone())).collect();
        let borders = self
            .borders
            .each_ref()
            .map(|set| set.iter().map(|border| Mutex::new(lock(border).clone())).collect());
        Self {
            plan: self.plan.clone(),
            laws: self.laws.clone(),
            level: self.level,
            worth: self.worth,
            taken: self.regions.iter().map(|_| Taken::default()).collect(),
            regions,
            borders,
            are_behind: self.are_behind,
            loose: self.loose.clone(),
            pushes: self.pushes.clone(),
            are_kept_here: self.are_kept_here,
            certifier: Certifier::default(),
        }
    }
}

impl Team {
    pub fn new(model: &Model, params: &Params) -> Self {
        let plan = Plan::new(model);
        let laws = Laws::new(&plan, model, params);
        let mut team = Self {
            loose: LooseMotions::new(&plan),
            plan: Arc::new(plan),
            laws: Arc::new(laws),
            level: Checked::new(Level::best()),
            worth: Worth::default(),
            regions: Vec::new(),
            borders: [Vec::new(), Vec::new()],
            taken: Vec::new(),
            are_behind: false,
            pushes: Vec::new(),
            are_kept_here: false,
            certifier: Certifier::default(),
        };
        team.divide(1);
        team.set_masses(model, params);
        team
    }

    /// Uses these vector instructions, if the processor has them.
    pub fn set_level(&mut self, level: Level) {
        self.level = Checked::new(level);
    }

    /// Divides models that are too small for it: whatever is divided, the bits are the same.
    #[cfg(test)]
    pub(super) fn set_worth(&mut self, worth: Worth) {
        self.worth = worth;
    }

    /// How many regions there are now.
    #[cfg(test)]
    pub fn region_count(&self) -> usize {
        self.regions.len()
    }

    /// Stiffness, damping, rest lengths or cuts have changed.
    pub fn set_laws(&mut self, model: &Model, params: &Params) {
        Arc::make_mut(&mut self.laws).fill(&self.plan, model, params);
        self.certifier.forget_laws();
    }

    /// Masses or pins have changed.
    pub fn set_masses(&mut self, model: &Model, params: &Params) {
        for region in &mut self.regions {
            let region = own(region);
            for place in region.blocks.start * BLOCK..self.plan.points.min(region.blocks.end * BLOCK) {
                region.set_mass(region.index(place), params, model.point_at(place));
            }
        }
    }

    /// One point's mass or pin has changed, or a hand has taken or left it.
    pub fn set_mass(&mut self, model: &Model, params: &Params, point: usize) {
        let place = model.place_of(point);
        let region = own(self.region_of(place));
        region.set_mass(region.index(place), params, point);
    }

    /// Takes over positions and velocities.
    pub fn load(&mut self, model: &Model, state: &State) {
        for region in &mut self.regions {
            let region = own(region);
            if self.are_kept_here {
                region.swap();
            }
            let first = region.first_block * BLOCK;
            let places = first..self.plan.points.min(first + region.points.len());
            write(
                &mut region.points,
                places.clone().map(|place| {
                    let point = model.point_at(place);
                    [state.position[point], state.velocity[point]]
                }),
            );
            write(
                &mut region.low,
                places.map(|place| {
                    let point = model.point_at(place);
                    [state.position_low[point], state.velocity_low[point]]
                }),
            );
        }
        (self.are_behind, self.are_kept_here) = (false, false);
    }

    /// Hands out positions and velocities, in the user's order.
    pub fn store(&self, model: &Model, state: &mut State) {
        for region in &self.regions {
            let region = lock(region);
            self.hand_out_all(model, &region, [&region.points, &region.low], state);
        }
    }

    /// Hands out positions and velocities without what rounding dropped, in the user's order.
    pub fn fill(&self, model: &Model, snapshot: &mut Snapshot) {
        let Snapshot { positions, velocities, .. } = snapshot;
        for vectors in [&mut *positions, &mut *velocities] {
            vectors.resize(self.plan.points, Vec3::ZERO);
        }
        for region in &self.regions {
            let region = lock(region);
            self.hand_out(model, &region, &region.points, [positions, velocities]);
        }
    }

    /// Keeps positions and velocities of now, in place of those kept before. Nothing is copied: the next step leaves them where
    /// they are and moves the points in other arrays. Takes memory only where the points have been divided anew since.
    pub fn keep(&mut self) {
        self.regions.iter_mut().for_each(|region| own(region).prepare_to_keep());
        self.are_kept_here = true;
    }

    /// Hands out the positions and velocities that were kept last, in the user's order; leaves the state as it is if none were.
    pub fn store_kept(&self, model: &Model, state: &mut State) {
        for region in &self.regions {
            let region = lock(region);
            let here = [&region.points, &region.low];
            let there = region.other.as_ref().map(|other| other.each_ref());
            if let Some(arrays) = if self.are_kept_here { Some(here) } else { there } {
                self.hand_out_all(model, &region, arrays, state);
            }
        }
    }

    /// The energies of this state, without the ledger's sums; the same bits for any number of threads.
    pub fn energy(&mut self, params: &Params, workers: &dyn Workers) -> Energy {
        let Self { plan, regions, .. } = self;
        for_neighbours(regions, |region, next| region.look_ahead(plan, next));
        let Self { plan, laws, level, regions, .. } = self;
        let (gravity, planes) = (params.gravity, &params.planes[..]);
        for_each(regions.len(), workers, &|index| {
            level.run(Survey { region: &mut lock(&regions[index]), plan, laws, gravity, planes });
        });
        let mut sums = self.sums();
        for (loose, law) in self.plan.loose.iter().zip(&self.laws.loose) {
            let Some(law) = *law else { continue };
            sums.add_spring(law, loose.ends.map(|place| self.motion_at(place as usize)[0]));
        }
        sums.energy()
    }

    /// The kinetic energy of this state, J, with the very bits of [`energy`](Self::energy).
    pub fn kinetic_energy(&mut self, workers: &dyn Workers) -> f64 {
        let Self { level, regions, .. } = self;
        for_each(regions.len(), workers, &|index| level.run(KineticSurvey(&mut lock(&regions[index]))));
        self.sums().kinetic
    }

    /// The sums of all blocks' energies, from the first to the last.
    fn sums(&mut self) -> Sums {
        let mut sums = Sums::default();
        for region in &mut self.regions {
            own(region).energies.iter().for_each(|block| sums.add(block));
        }
        sums
    }

    /// Stops every point where it is, in the middle of a step of `dt` (s): see [`Region::stop`].
    pub fn stop(&mut self, dt: f64) {
        for index in 0..self.regions.len() {
            let mut region = lock(&self.regions[index]);
            if self.are_behind {
                receive(&mut region, &self.borders[0], index);
            }
            if self.are_kept_here {
                region.move_away();
            }
            region.stop(dt);
        }
        let Self { plan, regions, .. } = self;
        for_neighbours(regions, |region, next| {
            next.look_back(region);
            region.look_ahead(plan, next);
        });
        (self.are_behind, self.are_kept_here) = (false, false);
    }

    /// Position and velocity of one point in float64, with what rounding dropped.
    pub fn motion64(&self, model: &Model, point: usize) -> [DVec3; 2] {
        self.motion_at(model.place_of(point))
    }

    fn motion_at(&self, place: usize) -> [DVec3; 2] {
        let region = lock(&self.regions[self.region_index(place)]);
        let at = region.index(place);
        let [x, y, z, u, v, w] = std::array::from_fn(|part| {
            f64::from(region.points.all()[part][at]) + f64::from(region.low.all()[part][at])
        });
        [DVec3::new(x, y, z), DVec3::new(u, v, w)]
    }

    /// The force on each point at this state, N, in the user's order, as the next step would use it, weight included.
    pub fn forces(&mut self, model: &Model, params: &Params, into: &mut Vec<Vec3>) {
        self.gather_pushes(model, params);
        into.clear();
        into.resize(self.plan.points, Vec3::ZERO);
        let field = Field { gravity: params.gravity, planes: &params.planes, dt: params.dt as f32 };
        let mut forces = Vec::new();
        for index in 0..self.regions.len() {
            let mut region = lock(&self.regions[index]);
            if self.are_behind {
                receive(&mut region, &self.borders[0], index);
            }
            let places = region.blocks.start * BLOCK..self.plan.points.min(region.blocks.end * BLOCK);
            forces.resize(places.len(), Vec3::ZERO);
            self.level.run(Sweep {
                region: &mut region,
                plan: &self.plan,
                laws: &self.laws,
                field,
                pushes: &self.pushes,
                purpose: Purpose::Forces(&mut forces),
            });
            for (place, force) in places.zip(&forces) {
                let point = model.point_at(place);
                into[point] = *force + params.gravity * params.point_mass[point];
            }
        }
        self.are_behind = false;
    }

    /// The forces on single points, by place.
    fn gather_pushes(&mut self, model: &Model, params: &Params) {
        let Self { plan, laws, regions, loose, pushes, .. } = self;
        pushes.clear();
        for (&point, &force) in &params.external_forces {
            pushes.push(Push { place: model.place_of(point), kind: PushKind::Constant(force) });
        }
        for grab in &params.grabs {
            let Grab { point, target, stiffness, damping } = *grab;
            let kind = PushKind::Grab { target, stiffness, damping };
            pushes.push(Push { place: model.place_of(point), kind });
        }
        pushes.sort_by_key(|push| push.place);
        if !plan.loose.is_empty() {
            loose.read(plan, regions.iter_mut().map(|region| &*own(region)));
            loose.merge_into(pushes, plan, laws);
        }
    }

    /// How many regions so many threads are best given.
    fn wanted_regions(&self, threads: usize) -> usize {
        let Worth { springs, blocks_per_border } = self.worth;
        let by_blocks = self.plan.blocks.len() / (blocks_per_border * self.plan.border_blocks()).max(1);
        threads.min(self.plan.springs / springs).min(by_blocks).max(1)
    }

    fn redivide(&mut self, model: &Model, params: &Params, threads: usize) {
        let zeros = vec![Vec3::ZERO; self.plan.points];
        let mut state = State::new(zeros.clone(), zeros);
        let is_kept_there = !self.are_kept_here && own(&mut self.regions[0]).other.is_some();
        let kept = is_kept_there.then(|| {
            let mut kept = state.clone();
            self.store_kept(model, &mut kept);
            kept
        });
        self.store(model, &mut state);
        let are_kept_here = self.are_kept_here;
        self.divide(threads);
        self.set_masses(model, params);
        if let Some(kept) = kept {
            self.load(model, &kept);
            self.keep();
        }
        self.load(model, &state);
        if are_kept_here {
            self.keep();
        }
    }

    /// Hands out a region's own points, and what rounding dropped of them, from these arrays, in the user's order.
    fn hand_out_all(&self, model: &Model, region: &Region, [high, low]: [&Arrays<6>; 2], state: &mut State) {
        let State { position, velocity, position_low, velocity_low, .. } = state;
        self.hand_out(model, region, high, [position, velocity]);
        self.hand_out(model, region, low, [position_low, velocity_low]);
    }

    /// Hands out one of the two.
    fn hand_out(
        &self,
        model: &Model,
        region: &Region,
        arrays: &Arrays<6>,
        [positions, velocities]: [&mut [Vec3]; 2],
    ) {
        let arrays = arrays.all();
        for place in region.blocks.start * BLOCK..self.plan.points.min(region.blocks.end * BLOCK) {
            let (at, point) = (region.index(place), model.point_at(place));
            let [x, y, z, u, v, w] = arrays.map(|array| array[at]);
            (positions[point], velocities[point]) = (Vec3::new(x, y, z), Vec3::new(u, v, w));
        }
    }

    /// Divides the points into regions of about the same work.
    fn divide(&mut self, threads: usize) {
        let (count, blocks) = (self.wanted_regions(threads), self.plan.blocks.len());
        let border = if count > 1 { self.plan.border_blocks() } else { 0 };
        // All but the first sweep their neighbour's last blocks as well.
        let work = blocks + (count - 1) * border;
        let end = |region: usize| match region {
            0 => 0,
            _ if region == count => blocks,
            _ => (work * region / count - (region - 1) * border).next_multiple_of(GROUP),
        };
        let ranges = (0..count).map(|region| end(region)..end(region + 1));
        let borders = || {
            let borders = ranges.clone().map(|blocks| Mutex::new(Border::new(&self.plan, &blocks, border)));
            if count > 1 { borders.collect() } else { Vec::new() }
        };
        self.borders = [borders(), borders()];
        self.taken = ranges.clone().map(|_| Taken::default()).collect();
        self.regions = ranges.map(|blocks| Mutex::new(Region::new(&self.plan, blocks))).collect();
        (self.are_behind, self.are_kept_here) = (false, false);
        self.certifier.forget_regions();
    }

    fn region_index(&self, place: usize) -> usize {
        self.regions.partition_point(|region| lock(region).blocks.end * BLOCK <= place)
    }

    fn region_of(&mut self, place: usize) -> &mut Mutex<Region> {
        let index = self.region_index(place);
        &mut self.regions[index]
    }
}

/// Writes pairs of vectors, the first three arrays and the last three.
fn write(arrays: &mut Arrays<6>, vectors: impl Iterator<Item = [Vec3; 2]>) {
    let mut arrays = arrays.all_mut();
    for (at, [a, b]) in vectors.enumerate() {
        for (array, value) in arrays.iter_mut().zip([a.x, a.y, a.z, b.x, b.y, b.z]) {
            array[at] = value;
        }
    }
}

/// A lock that is hardly ever waited for. If another thread panicked, so does the caller of the step: nobody reads on.
/// Calls `look` with each region and the one after it.
fn for_neighbours(regions: &mut [Mutex<Region>], mut look: impl FnMut(&mut Region, &mut Region)) {
    for after in 1..regions.len() {
        let (before, rest) = regions.split_at_mut(after);
        if let (Some(region), Some(next)) = (before.last_mut(), rest.first_mut()) {
            look(own(region), own(next));
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What is in a lock that nobody else can hold.
fn own<T>(mutex: &mut Mutex<T>) -> &mut T {
    mutex.get_mut().unwrap_or_else(PoisonError::into_inner)
}
