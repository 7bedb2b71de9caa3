//! What each scene shows and what to try with it, in plain words.

/// A scene in plain words.
pub struct SceneText {
    /// The built-in scene; empty for the text of all others.
    pub scene: &'static str,
    /// What one sees, and why it is so.
    pub see: &'static str,
    /// Things to try.
    pub tries: &'static [&'static str],
}

/// The text of a scene; of one that is not built in, the general one.
pub fn of(scene: &str) -> &'static SceneText {
    TEXTS.iter().find(|text| text.scene == scene).unwrap_or(&GENERAL)
}

static GENERAL: SceneText = SceneText {
    scene: "",
    see: "Points with mass, joined by springs. Each spring wants to be as long as it was built, and pulls or pushes its two \
          points until it is. Out of nothing but this come cloth, ropes and jelly.",
    tries: &[
        "Pull at a point, and let go.",
        "Choose a spring and press N: the step goes by, stage by stage, with that spring's numbers.",
        "Raise dt until the stability meter is nearly full, and a little further.",
    ],
};

/// The texts of all built-in scenes.
pub static TEXTS: &[SceneText] = &[
    SceneText {
        scene: "spring",
        see: "The smallest system there is: one mass, one spring. It was pushed sideways, so it swings; its spring is not \
              stretched yet and cannot carry it, so it falls, and bounces. The bouncing dies away, since the damper brakes whatever changes the \
              spring's length. The swinging hardly does: turning is not stretching.",
        tries: &[
            "In the plots, under Formula: pull it straight down and let go. The motion lies on its exact solution.",
            "Take the damping away: it bounces for ever.",
            "Make it swing gently, and compare its period with that of a pendulum.",
        ],
    },
    SceneText {
        scene: "chain",
        see: "Fifteen points in a row, held at one end and let go. The upper springs carry all points below them and are \
              stretched the most; the last spring carries one point only.",
        tries: &[
            "In the plots, under Formula: bring it to rest, and compare every spring's stretch with what it carries.",
            "Cut a spring with the scissors (C).",
            "Halve the stiffness: at rest every stretch doubles.",
        ],
    },
    SceneText {
        scene: "jelly",
        see: "A thousand points and 7,560 springs between neighbours, straight and diagonal. Without the diagonals the cube \
              would fold up like a cardboard box. It lands on an edge, wobbles, and comes to rest below the plane: that is no \
              mistake, see \"The ground\" below.",
        tries: &[
            "Pull at a corner. The wave that runs through the cube is carried from spring to spring.",
            "Set dt to 0.0125 s, and watch where the energy comes from. The lesson \"Make it explode\" explains it.",
            "Make the contact ten times stiffer: it sinks to a tenth of the depth.",
        ],
    },
    SceneText {
        scene: "cloth",
        see: "A net of 400 points, held at two corners. Springs along the threads carry it; those across, from corner to corner of \
              each square, keep the squares from folding flat. Nothing resists bending, so it drapes like silk.",
        tries: &[
            "Unpin a corner by a double click.",
            "Cut along a line with the scissors (C).",
            "Halve gravity: it falls as on another planet, and hangs less stretched.",
        ],
    },
    SceneText {
        scene: "flag",
        see: "A fine cloth held along its pole. The finer the net, the lighter its points and the faster its waves: the step must be \
              much shorter than that of the coarse cloth.",
        tries: &[
            "Pull its loose corner up and let go.",
            "Look at the stability meter, and compare it with the cloth's.",
        ],
    },
    SceneText {
        scene: "bridge",
        see: "Several bodies, tied together by joints: two posts that never move, a deck, two handrails. The gust pushes the deck to \
              the side; the ropes bring it back, again and again, a little less each time.",
        tries: &["Cut one of its ropes.", "Pull the deck down in the middle, and let go."],
    },
    SceneText {
        scene: "pile",
        see: "Three cubes glued together, the softest at the bottom. It carries the other two, and is squashed by them. The ground \
              here only pushes: nothing sticks to it.",
        tries: &[
            "Make all springs equally stiff.",
            "Watch the energy: how much of the fall ends up in dampers, how much in the ground?",
        ],
    },
    SceneText {
        scene: "trampoline",
        see: "A net held along its rim, and a block tied to its middle. All springs of the net are a tenth too short, so it is tight \
              before anything lands: a tight net swings faster than a slack one.",
        tries: &[
            "Plot the height of a point of the block against time.",
            "Double every mass, and read off the new period.",
        ],
    },
    SceneText {
        scene: "valley",
        see: "Four cubes that differ only in stiffness tumble down two slopes. The softest, at the front, bends the most on \
              its way; the stiffest rolls almost like a box.",
        tries: &[
            "Tilt gravity, and the valley seems to turn.",
            "Compare the energy lost in dampers with that lost in contact.",
        ],
    },
    SceneText {
        scene: "beam",
        see: "A beam clamped at its left end. Springs above are stretched, springs below are squeezed, those in the middle are neither: \
              that is what bending is. A thicker beam has longer levers and bends much less.",
        tries: &[
            "Colour the springs by strain: above and below differ in sign.",
            "Bring it to rest, and read off how far the tip hangs down. Half the gravity, half the sag.",
        ],
    },
    SceneText {
        scene: "cloth512",
        see: "The hanging cloth with 262,144 points and a million springs. It is here to measure speed: look at how many seconds one \
              simulated second takes.",
        tries: &["Pause before you pull.", "Wait: with so many points a wave takes long from edge to edge."],
    },
    SceneText {
        scene: "jelly64",
        see: "The cube of jelly with 262,144 points and over two million springs. The springs and masses are those of the small jelly, \
              so this large cube is much softer in relation to its weight.",
        tries: &[
            "Watch its bottom layers, which carry all the others.",
            "Compare its stability meter with the small jelly's.",
        ],
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::scene::BUILTIN;

    #[test]
    fn every_built_in_scene_has_a_text() {
        for builtin in BUILTIN {
            let text = of(builtin.name);
            assert_eq!(text.scene, builtin.name);
            assert!(!text.tries.is_empty());
        }
        assert_eq!(TEXTS.len(), BUILTIN.len());
        assert_eq!(of("a file of mine").scene, "");
    }
}
