//! The quantities that can be plotted: one list for the chooser, the axes, tooltips and files.

use sprung_driver::Probe;

use crate::state::Pick;

/// A quantity of a point or of a spring.
pub struct Quantity {
    /// Its symbol.
    pub symbol: &'static str,
    /// What it is called.
    pub name: &'static str,
    /// Its unit; empty if it has none.
    pub unit: &'static str,
    /// Formula and meaning.
    pub explanation: &'static str,
    /// Its probe at a point or a spring; `None` where it has none.
    pub probe: fn(Pick) -> Option<Probe>,
}

macro_rules! quantity {
    ($pick:ident, $symbol:literal, $name:literal, $unit:literal, $explanation:literal, $probe:expr) => {
        Quantity {
            symbol: $symbol,
            name: $name,
            unit: $unit,
            explanation: $explanation,
            probe: |pick| match pick {
                Pick::$pick(index) => Some($probe(index)),
                _ => None,
            },
        }
    };
}

/// All of them: those of a point, then those of a spring.
pub static QUANTITIES: &[Quantity] = &[
    quantity!(Point, "y", "height", "m", "The coordinate y of x: how high the point is.", |i| {
        Probe::Position(i, 1)
    }),
    quantity!(Point, "x", "place along x", "m", "The coordinate x: to the right.", |i| Probe::Position(i, 0)),
    quantity!(Point, "z", "place along z", "m", "The coordinate z: towards you.", |i| Probe::Position(i, 2)),
    quantity!(Point, "v_y", "velocity upwards", "m/s", "The component of v = dx/dt along y.", |i| {
        Probe::Velocity(i, 1)
    }),
    quantity!(Point, "v_x", "velocity along x", "m/s", "The component of v = dx/dt along x.", |i| {
        Probe::Velocity(i, 0)
    }),
    quantity!(Point, "v_z", "velocity along z", "m/s", "The component of v = dx/dt along z.", |i| {
        Probe::Velocity(i, 2)
    }),
    quantity!(Point, "|v|", "speed", "m/s", "|v| = √(v_x² + v_y² + v_z²).", Probe::Speed),
    quantity!(Point, "f_y", "force upwards", "N", "The component along y of all forces together.", |i| {
        Probe::Force(i, 1)
    }),
    quantity!(Point, "f_x", "force along x", "N", "The component along x of all forces together.", |i| {
        Probe::Force(i, 0)
    }),
    quantity!(Point, "f_z", "force along z", "N", "The component along z of all forces together.", |i| {
        Probe::Force(i, 2)
    }),
    quantity!(Spring, "ℓ", "length", "m", "ℓ = |x_i − x_j|, from end to end.", Probe::Length),
    quantity!(
        Spring,
        "(ℓ − L)/L",
        "strain",
        "",
        "(ℓ − L)/L: by which part of its rest length L the spring is stretched.",
        Probe::Strain
    ),
    quantity!(
        Spring,
        "k_s(ℓ − L)",
        "tension",
        "N",
        "k_s(ℓ − L): how hard the spring pulls; below zero it pushes.",
        Probe::Tension
    ),
    quantity!(
        Spring,
        "½k_s(ℓ − L)²",
        "energy",
        "J",
        "½k_s(ℓ − L)²: the work it took to stretch or squeeze the spring.",
        Probe::Energy
    ),
];

/// The quantities of a point or a spring.
pub fn of(pick: Pick) -> impl Iterator<Item = &'static Quantity> {
    QUANTITIES.iter().filter(move |quantity| (quantity.probe)(pick).is_some())
}

/// What a probe looks at.
pub fn place(probe: Probe) -> Pick {
    match probe {
        Probe::Position(point, _)
        | Probe::Velocity(point, _)
        | Probe::Force(point, _)
        | Probe::Speed(point) => Pick::Point(point),
        Probe::Length(spring) | Probe::Strain(spring) | Probe::Tension(spring) | Probe::Energy(spring) => {
            Pick::Spring(spring)
        }
    }
}

/// The quantity that a probe is of.
pub fn quantity(probe: Probe) -> Option<&'static Quantity> {
    QUANTITIES.iter().find(|quantity| (quantity.probe)(place(probe)) == Some(probe))
}

/// A probe in words: `v_y of point 3`.
pub fn name(probe: Probe) -> String {
    let symbol = quantity(probe).map_or("?", |quantity| quantity.symbol);
    match place(probe) {
        Pick::Point(point) => format!("{symbol} of point {point}"),
        Pick::Spring(spring) => format!("{symbol} of spring {spring}"),
    }
}

/// The unit of a probe; empty if it has none.
pub fn unit(probe: Probe) -> &'static str {
    quantity(probe).map_or("", |quantity| quantity.unit)
}

/// A probe in words with its unit, for an axis.
pub fn axis(probe: Probe) -> String {
    match unit(probe) {
        "" => name(probe),
        unit => format!("{} ({unit})", name(probe)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_finds_itself() {
        for pick in [Pick::Point(3), Pick::Spring(7)] {
            for found in of(pick) {
                let probe = (found.probe)(pick).expect("it is one of them");
                assert_eq!(place(probe), pick);
                assert_eq!(quantity(probe).map(|q| q.name), Some(found.name));
                assert!(name(probe).starts_with(found.symbol));
            }
        }
        assert_eq!(of(Pick::Point(0)).count() + of(Pick::Spring(0)).count(), QUANTITIES.len());
        assert_eq!(axis(Probe::Tension(4)), "k_s(ℓ − L) of spring 4 (N)");
    }
}
