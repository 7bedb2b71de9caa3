//! Steps: each thread takes its region through many of them.
//!
//! For a step a region needs its neighbours' points as far as springs reach, as they are before it. After a step it leaves
//! its own for them, in one of two sets in turn: one is read while the other is written, as no region is more than one step
//! ahead of its neighbours.
//!
//! It waits for them, awake: a thread that falls asleep at each step finds its caches cold when it wakes, and may wake beside
//! the others on one processor. But it does not wait for long. If a neighbour's thread has been set aside or has something
//! else to do, the region's thread returns, and when all have returned they are called again and go on from where they are.
//! The region that is furthest behind never waits, so that even threads that run one after the other get there.

use std::hint::spin_loop;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::yield_now;

use super::{Team, lock};
use crate::kernel::BLOCK;
use crate::kernel::aligned::Arrays;
use crate::kernel::integrate::Field;
use crate::kernel::plan::Plan;
use crate::kernel::region::Region;
use crate::kernel::sweep::{Purpose, Sweep};
use crate::model::Model;
use crate::params::Params;
use crate::workers::Workers;

/// How often a thread looks whether its neighbours are ready before it returns. Between looks it lets any other thread have the
/// processor: if all of them are needed elsewhere that may take a while, if not some milliseconds in all.
const LOOKS: usize = 10_000;

/// The first of them, where it stays: for some tens of microseconds, in which neighbours of the same size are done.
const EAGER_LOOKS: usize = 1_000;

/// No step has failed.
const NEVER: u64 = u64::MAX;

/// A region's points that its neighbours need.
#[derive(Clone, Debug)]
pub(super) struct Border {
    /// Its first points, where springs of the region before it end.
    first: Arrays<6>,
    /// Its last blocks, whose springs may end in the region after it.
    last: Arrays<6>,
}

/// How many steps a region has taken, on a cache line of its own, and on that beside it, which is fetched along with it.
#[derive(Debug, Default)]
#[repr(align(128))]
pub(super) struct Taken(AtomicU64);

/// So many steps of all regions.
struct March<'a> {
    team: &'a Team,
    field: Field<'a>,
    steps: u64,
    /// The number of the first step that left a position that is not finite; nobody goes further.
    failed: AtomicU64,
}

impl Team {
    /// Takes up to so many steps, and stops after one that leaves a position that is not finite. Returns how many it took and
    /// whether all positions are finite.
    pub fn advance(
        &mut self,
        model: &Model,
        params: &Params,
        steps: u64,
        workers: &dyn Workers,
    ) -> (u64, bool) {
        if self.wanted_regions(workers.count()) != self.regions.len() {
            self.redivide(model, params, workers.count());
        }
        // Loose springs may join any two regions: for each step all have to be where the last one left them.
        let at_once = if self.plan.loose.is_empty() { steps } else { 1 };
        let mut taken = 0;
        while taken < steps {
            let most = at_once.min(steps - taken);
            match self.march(model, params, most, workers) {
                NEVER => taken += most,
                failed => return (taken + failed, false),
            }
        }
        (steps, true)
    }

    /// Takes so many steps, or fewer if one fails: returns its number, from one, or [`NEVER`].
    fn march(&mut self, model: &Model, params: &Params, steps: u64, workers: &dyn Workers) -> u64 {
        self.gather_pushes(model, params);
        self.taken.iter_mut().for_each(|taken| *taken.0.get_mut() = 0);
        let field = Field { gravity: params.gravity, planes: &params.planes, dt: params.dt as f32 };
        let march = March { team: self, field, steps, failed: AtomicU64::new(NEVER) };
        // Once, unless a thread returns before it is done. The region that is the furthest behind never waits.
        while !march.is_done() {
            for_each(self.regions.len(), workers, &|index| march.take_steps(index));
        }
        let failed = march.failed.into_inner();
        if steps % 2 == 1 {
            self.borders.swap(0, 1);
        }
        self.are_behind = self.regions.len() > 1;
        self.are_kept_here = false;
        failed
    }
}

impl March<'_> {
    /// The steps that are to be taken, as far as it is known.
    fn end(&self) -> u64 {
        self.steps.min(self.failed.load(Ordering::Relaxed))
    }

    fn is_done(&self) -> bool {
        self.team.taken.iter().all(|taken| taken.0.load(Ordering::Relaxed) >= self.end())
    }

    /// Takes one region's steps, as far as its neighbours let it.
    fn take_steps(&self, index: usize) {
        let Team { plan, laws, level, regions, pushes, borders, .. } = self.team;
        let mut region = lock(&regions[index]);
        let mut taken = self.team.taken[index].0.load(Ordering::Relaxed);
        while taken < self.end() && self.neighbours_have_taken(taken, index) {
            let is_first = taken == 0;
            let [left, leave] = [taken % 2, 1 - taken % 2].map(|set| &borders[set as usize]);
            if !is_first || self.team.are_behind {
                receive(&mut region, left, index);
            }
            let moves_away = is_first && self.team.are_kept_here;
            let purpose = if moves_away { Purpose::MoveAway } else { Purpose::Move };
            let sweep = Sweep { region: &mut region, plan, laws, field: self.field, pushes, purpose };
            let finite = level.run(sweep);
            if moves_away {
                region.swap();
            }
            taken += 1;
            if !finite {
                self.failed.fetch_min(taken, Ordering::Relaxed);
            }
            if let Some(border) = leave.get(index) {
                lock(border).take(&region);
            }
            self.team.taken[index].0.store(taken, Ordering::Release);
        }
    }

    /// Waits a moment until a region's neighbours have taken so many steps. Returns whether they have.
    fn neighbours_have_taken(&self, steps: u64, index: usize) -> bool {
        let taken = &self.team.taken;
        let around = &taken[index.saturating_sub(1)..taken.len().min(index + 2)];
        (0..LOOKS).any(|look| {
            let are_there = around.iter().all(|taken| taken.0.load(Ordering::Acquire) >= steps);
            match are_there {
                true => {}
                false if look < EAGER_LOOKS => spin_loop(),
                false => yield_now(),
            }
            are_there
        })
    }
}

impl Border {
    /// For a region of these blocks, of which its neighbours sweep so many more.
    pub fn new(plan: &Plan, blocks: &Range<usize>, border_blocks: usize) -> Self {
        Self {
            first: Arrays::new(plan.reach().min(blocks.len() * BLOCK)),
            last: Arrays::new(border_blocks * BLOCK),
        }
    }

    /// Copies what a region's neighbours need of it.
    fn take(&mut self, region: &Region) {
        let begin = (region.blocks.start - region.first_block) * BLOCK;
        let end = (region.blocks.end - region.first_block) * BLOCK;
        for (points, first) in region.points.all().into_iter().zip(self.first.all_mut()) {
            first.copy_from_slice(&points[begin..begin + first.len()]);
        }
        for (points, last) in region.points.all().into_iter().zip(self.last.all_mut()) {
            last.copy_from_slice(&points[end - last.len()..end]);
        }
    }
}

/// Does something for each of so many regions, on the threads that there are.
pub(super) fn for_each(regions: usize, workers: &dyn Workers, job: &(dyn Fn(usize) + Sync)) {
    if regions == 1 {
        return job(0);
    }
    let threads = workers.count().max(1);
    workers.run(&|worker| (worker..regions).step_by(threads).for_each(job));
}

/// Copies what a region's neighbours left for it.
pub(super) fn receive(region: &mut Region, borders: &[Mutex<Border>], index: usize) {
    let end = (region.blocks.end - region.first_block) * BLOCK;
    let before = (region.blocks.start - region.first_block) * BLOCK;
    if let Some(index) = index.checked_sub(1) {
        let border = lock(&borders[index]);
        for (points, last) in region.points.all_mut().into_iter().zip(border.last.all()) {
            points[..before].copy_from_slice(&last[last.len() - before..]);
        }
    }
    if let Some(border) = borders.get(index + 1) {
        let border = lock(border);
        for (points, first) in region.points.all_mut().into_iter().zip(border.first.all()) {
            points[end..end + first.len()].copy_from_slice(first);
        }
    }
}
