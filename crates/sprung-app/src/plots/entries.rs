//! The entries of the energy ledger as plots show them: one list for lines, stacks, legend, tooltips and files.

use egui::Color32;
use egui_plot::LineStyle;
use sprung::Energy;

use crate::theme::rgb;

/// An entry of the energy ledger.
pub struct Entry {
    /// What the legend calls it.
    pub name: &'static str,
    /// Its formula.
    pub formula: &'static str,
    /// What it means, in a sentence or two.
    pub meaning: &'static str,
    /// sRGB on a bright and on a dark background. Okabe and Ito's colours, which colour-blind people can tell apart.
    colours: [u32; 2],
    /// Solid is where energy is; dashed is where it went or came from; dotted is the integrator's own.
    pub style: LineStyle,
    /// Whether it has no natural zero, so that it counts from the start of what is shown.
    pub from_start: bool,
    /// Whether it is part of the stack.
    pub stacks: bool,
    /// Its value, J.
    pub value: fn(&Energy) -> f64,
}

impl Entry {
    /// Its colour on the background of a theme.
    pub fn colour(&self, dark: bool) -> Color32 {
        rgb(self.colours[usize::from(dark)])
    }

    /// What its tooltip says.
    pub fn tooltip(&self) -> String {
        format!("{}\n{}", self.formula, self.meaning)
    }

    /// Its value, J, counted from `first` if it has no zero of its own.
    pub fn reading(&self, energy: &Energy, first: &Energy) -> f64 {
        let zero = if self.from_start { (self.value)(first) } else { 0.0 };
        (self.value)(energy) - zero
    }
}

const SOLID: LineStyle = LineStyle::Solid;
const DASHED: LineStyle = LineStyle::Dashed { length: 8.0 };
const DOTTED: LineStyle = LineStyle::Dotted { spacing: 5.0 };

/// All entries, the sum first.
pub static ENTRIES: [Entry; 9] = [
    Entry {
        name: "total",
        formula: "kinetic + gravitational + elastic + contact",
        meaning: "All energy there is now, counted from the start. It falls by what is lost, and rises only by work put in, \
                  or by an error of the integrator.",
        colours: [0x22_2b_36, 0xf2_f2_f2],
        style: SOLID,
        from_start: true,
        stacks: false,
        value: Energy::total,
    },
    Entry {
        name: "kinetic",
        formula: "Σ ½ m v²",
        meaning: "The energy of motion of all points that can move.",
        colours: [0x00_72_b2, 0x4a_a8_e0],
        style: SOLID,
        from_start: false,
        stacks: true,
        value: |energy| energy.kinetic,
    },
    Entry {
        name: "gravitational",
        formula: "−Σ m g·x",
        meaning: "The energy of height. Heights have no natural zero: lines count from the start, stacks from the lowest so \
                  far.",
        colours: [0x00_9e_73, 0x2f_c0_96],
        style: SOLID,
        from_start: true,
        stacks: true,
        value: |energy| energy.gravitational,
    },
    Entry {
        name: "elastic",
        formula: "Σ ½ k_s (ℓ − L)²",
        meaning: "What stretched and squeezed springs store.",
        colours: [0xe6_9f_00, 0xe6_9f_00],
        style: SOLID,
        from_start: false,
        stacks: true,
        value: |energy| energy.elastic,
    },
    Entry {
        name: "contact",
        formula: "Σ ½ k_c p²",
        meaning: "What the ground stores under points that have sunk into it by a depth p.",
        colours: [0xcc_79_a7, 0xdd_8f_bb],
        style: SOLID,
        from_start: false,
        stacks: true,
        value: |energy| energy.contact,
    },
    Entry {
        name: "lost in dampers",
        formula: "Σ k_d ((v_i − v_j)·u)² dt, summed over the steps",
        meaning: "What the springs' dampers have turned to heat since the start.",
        colours: [0xd5_5e_00, 0xee_7b_1e],
        style: DASHED,
        from_start: false,
        stacks: true,
        value: |energy| energy.sums.lost_in_dampers,
    },
    Entry {
        name: "lost in contact",
        formula: "Σ k_c,d v_n² dt, summed over the steps",
        meaning: "What the ground's dampers have turned to heat since the start.",
        colours: [0x8c_4a_8f, 0xb9_77_d1],
        style: DASHED,
        from_start: false,
        stacks: true,
        value: |energy| energy.sums.lost_in_contact,
    },
    Entry {
        name: "work put in",
        formula: "Σ F·(v before + v after) dt/2 of hands and outer forces, and what changed parameters added",
        meaning: "Energy that came from outside: from your hand, a constant force, or a slider.",
        colours: [0x3a_9b_d9, 0xf0_e4_42],
        style: DASHED,
        from_start: false,
        stacks: false,
        value: |energy| energy.sums.work_in,
    },
    Entry {
        name: "integrator's error",
        formula: "Σ (ΔE_pot + work of the conservative forces)",
        meaning: "Energy that the method itself makes (above zero) or loses (below), because a step is not infinitely short. \
                  It halves with dt. When a run blows up, energy comes from here, and from dampers, which then give instead of take.",
        colours: [0x77_7f_88, 0xa9_b2_bd],
        style: DOTTED,
        from_start: false,
        stacks: false,
        value: |energy| energy.sums.integrator_error,
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_colours_differ() {
        for (index, entry) in ENTRIES.iter().enumerate() {
            for other in &ENTRIES[..index] {
                assert_ne!(entry.name, other.name);
                assert_ne!(entry.colours[0], other.colours[0]);
                assert_ne!(entry.colours[1], other.colours[1]);
            }
        }
    }
}
