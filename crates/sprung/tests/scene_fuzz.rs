//! No bytes make the scene parser panic, hang or ask for much memory: random ones, and built-in scenes with a bite taken.

use proptest::prelude::*;
use sprung::scene::{BUILTIN, STARTER, Scene};

fn try_all(bytes: &[u8]) {
    if let Ok(scene) = Scene::from_bytes(bytes, "random") {
        let _ = scene.estimated_bytes();
        let _ = scene.build_within(2_000, 20_000);
        let again =
            Scene::parse(&scene.to_toml(), "again").expect("what was read can be written and read again");
        assert_eq!(scene, again);
    }
}

const WORDS: [&str; 24] = [
    "[[body]]\n",
    "[[body.springs]]\n",
    "[[plane]]\n",
    "[[joint]]\n",
    "name = \"a\"\n",
    "points = ",
    "[[0,0,0],[1,0,0]]\n",
    "chain = ",
    "grid = ",
    "lattice = ",
    "{ points = 3, step = [1,0,0] }\n",
    "{ points = [3,3,3], spacing = 1 }\n",
    "{ points = [3,3], spacing = 1e-9 }\n",
    "radius = ",
    "kinds = [\"bend\"]\n",
    "stiffness = ",
    "pins = ",
    "1e9\n",
    "-1\n",
    "nan\n",
    "[\"left\"]\n",
    "[0, 1]\n",
    "scale = ",
    "dt = ",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn random_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        try_all(&bytes);
    }

    #[test]
    fn random_words(words in prop::collection::vec(prop::sample::select(&WORDS[..]), 0..24)) {
        try_all(words.concat().as_bytes());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn damaged_scenes(
        which in 0..=BUILTIN.len(),
        at in any::<prop::sample::Index>(),
        cut in 0usize..20,
        put in prop_oneof![Just(String::new()), "[0-9e.\\-\\[\\]{}=\",a-z \n#]{0,8}"],
    ) {
        let text = BUILTIN.get(which).map_or(STARTER, |builtin| builtin.text);
        let mut bytes = text.as_bytes().to_vec();
        let start = at.index(bytes.len());
        let end = (start + cut).min(bytes.len());
        bytes.splice(start..end, put.bytes());
        try_all(&bytes);
    }
}
