//! From what a body says to its lattice, and to how much memory the scene will take.

use glam::DVec3;

use super::types::{Body, GridPlane, Scene, Springs};
use crate::build::{DEFAULT_MAX_SPRINGS, Lattice, estimated_bytes};

impl Body {
    /// The lattice of a chain, grid or block; `None` for explicit points.
    pub(super) fn shape(&self) -> Option<Lattice> {
        if let Some(chain) = &self.chain {
            return Some(Lattice::chain(chain.points, DVec3::from_array(chain.step)));
        }
        if let Some(grid) = &self.grid {
            let [a, b] = grid.points;
            let counts = match grid.plane {
                GridPlane::Xy => [a, b, 1],
                GridPlane::Xz => [a, 1, b],
                GridPlane::Yz => [1, a, b],
            };
            return Some(Lattice::new(counts, grid.spacing));
        }
        self.lattice.as_ref().map(|block| Lattice::new(block.points, block.spacing))
    }

    /// The key of the shape that the body has.
    pub(super) fn shape_key(&self) -> &'static str {
        match self {
            Self { chain: Some(_), .. } => "chain.points",
            Self { grid: Some(_), .. } => "grid.points",
            Self { lattice: Some(_), .. } => "lattice.points",
            Self { mesh: Some(_), .. } => "mesh",
            _ => "points",
        }
    }

    /// Where the shape's first point lies before scaling, rotation and moving, m.
    pub(super) fn shape_origin(&self) -> DVec3 {
        let chain = self.chain.as_ref().map(|chain| chain.origin);
        let grid = self.grid.as_ref().map(|grid| grid.origin);
        let block = self.lattice.as_ref().map(|block| block.origin);
        chain.or(grid).or(block).map_or(DVec3::ZERO, DVec3::from_array)
    }

    /// How many points the body has; saturates instead of overflowing. Of a mesh that has not been read, none.
    pub fn point_count(&self) -> u64 {
        if let Some(made) = self.made() {
            return made.points.len() as u64;
        }
        let explicit = self.points.as_ref().map_or(0, |points| points.len() as u64);
        self.shape().map_or(explicit, |lattice| lattice.point_count())
    }

    /// At most so many springs a group makes, found without making them; exact but for explicit points, where it takes
    /// all of them to be near enough. Stops counting beyond `enough`.
    pub(super) fn most_springs(&self, springs: &Springs, enough: u64) -> u64 {
        let points = self.point_count();
        // Pairs exactly at the radius are made in spite of rounding, so they count here.
        self.springs_within(springs, 1.0 + 1e-5, enough)
            .unwrap_or_else(|| points.saturating_mul(points.saturating_sub(1)) / 2)
    }

    /// At least so many springs a group makes, found without making them. Stops counting beyond `enough`.
    pub(super) fn fewest_springs(&self, springs: &Springs, enough: u64) -> u64 {
        self.springs_within(springs, 1.0 - 1e-5, enough).unwrap_or(0)
    }

    fn springs_within(&self, springs: &Springs, slack: f64, enough: u64) -> Option<u64> {
        if let Some(pairs) = &springs.pairs {
            return Some(pairs.len() as u64);
        }
        let lattice = self.shape()?;
        Some(match &springs.kinds {
            Some(kinds) => {
                kinds.iter().fold(0, |sum: u64, &kind| sum.saturating_add(lattice.pair_count(kind)))
            }
            None => lattice.pair_count_within(springs.radius.unwrap_or(0.0) / self.scale * slack, enough),
        })
    }
}

impl Scene {
    /// How many points the scene has, without building it; saturates instead of overflowing.
    pub fn point_count(&self) -> u64 {
        self.bodies.iter().fold(0, |sum: u64, body| sum.saturating_add(body.point_count()))
    }

    /// How many springs the scene may have: `max_springs`, or 20 million where it does not say.
    pub fn spring_limit(&self) -> u64 {
        self.max_springs.map_or(DEFAULT_MAX_SPRINGS as u64, u64::from)
    }

    /// About how much memory simulating the scene and finding its limits will take, bytes, without building it: for a
    /// check against what there is before [`build`](Self::build) asks for it. Springs by radius among explicit points or between
    /// bodies are counted as if all points were that near, up to the scene's limit on springs.
    pub fn estimated_bytes(&self) -> u64 {
        let limit = self.spring_limit();
        let mut springs = 0u64;
        for body in &self.bodies {
            springs = springs.saturating_add(body.made().map_or(0, |made| made.springs.len() as u64));
            for group in &body.springs {
                springs = springs.saturating_add(body.most_springs(group, limit));
            }
        }
        for joint in &self.joints {
            let points = |name: &String| {
                self.bodies.iter().find(|body| body.name == *name).map_or(0, |body| body.point_count())
            };
            let all = points(&joint.between[0]).saturating_mul(points(&joint.between[1]));
            springs = springs.saturating_add(joint.pairs.as_ref().map_or(all, |pairs| pairs.len() as u64));
        }
        estimated_bytes(self.point_count(), springs.min(limit))
    }
}
