//! What is kept from one start to the next. Settings that cannot be read are as if there were none.

use std::ops::RangeInclusive;

use eframe::Storage;
use serde::{Deserialize, Serialize};
use sprung_render::appearance::{Appearance, Theme};

use crate::files::Origin;
use crate::panel::{COLOUR_BY, POINTS, SPRINGS, SURFACES};
use crate::state::{AppState, Shown};

/// The name they are kept under.
const KEY: &str = "settings";

/// How much larger everything may be made: as far as egui's own keys go.
pub(crate) const ZOOM: RangeInclusive<f32> = 0.2..=5.0;

/// The settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// The last scene.
    pub scene: Option<Origin>,
    /// The hint at the first start has done its work.
    pub hint_taken: bool,
    pub(crate) dark: bool,
    pub(crate) background: Option<[u8; 3]>,
    pub(crate) points: String,
    pub(crate) springs: String,
    pub(crate) surfaces: String,
    pub(crate) colour_by: String,
    pub(crate) full_scale: f32,
    pub(crate) velocity_arrows: f32,
    pub(crate) force_arrows: f32,
    pub(crate) ground: bool,
    pub(crate) shadows: bool,
    pub(crate) controls: bool,
    pub(crate) plots: bool,
    pub(crate) explain: bool,
    pub(crate) zoom: f32,
}

impl Default for Settings {
    fn default() -> Self {
        let shown = Shown { controls: true, plots: false, explain: false, help: false, presentation: false };
        Self { hint_taken: false, ..Self::from_parts(&Appearance::default(), shown, None, 1.0) }
    }
}

impl Settings {
    /// The settings of the last time, or the first ones.
    pub fn load(storage: Option<&dyn Storage>) -> Self {
        let kept: Self = storage.and_then(|storage| eframe::get_value(storage, KEY)).unwrap_or_default();
        kept.checked()
    }

    /// With every number where it may be: who edits the file, or a disk that fails, must not keep the window from opening.
    fn checked(self) -> Self {
        let usual = Self::default();
        let within = |value: f32, low: f32, high: f32, usual: f32| {
            if value.is_finite() { value.clamp(low, high) } else { usual }
        };
        Self {
            full_scale: within(self.full_scale, 1e-9, 1e12, usual.full_scale),
            velocity_arrows: within(self.velocity_arrows, 0.0, 1e9, usual.velocity_arrows),
            force_arrows: within(self.force_arrows, 0.0, 1e9, usual.force_arrows),
            // Nobody has made it what no key makes it.
            zoom: if ZOOM.contains(&self.zoom) { self.zoom } else { usual.zoom },
            ..self
        }
    }

    /// Keeps them.
    pub fn save(&self, storage: &mut dyn Storage) {
        eframe::set_value(storage, KEY, self);
    }

    /// Those of the moment.
    pub fn of(state: &AppState, zoom: f32) -> Self {
        let scene = match &state.files.origin {
            // What a page opened or saved is gone with it; but a link holds the scene itself, with what was changed.
            _ if cfg!(target_arch = "wasm32") => state.kept_link.clone().map(Origin::Link),
            // There is no way back to what has neither name nor path.
            Origin::Other(_) => None,
            origin => Some(origin.clone()),
        };
        Self { hint_taken: !state.hint, ..Self::from_parts(&state.appearance, state.shown, scene, zoom) }
    }

    fn from_parts(look: &Appearance, shown: Shown, scene: Option<Origin>, zoom: f32) -> Self {
        Self {
            scene,
            hint_taken: true,
            dark: look.theme == Theme::Dark,
            background: look.background,
            points: name_of(look.points, &POINTS),
            springs: name_of(look.springs, &SPRINGS),
            surfaces: name_of(look.surfaces, &SURFACES),
            colour_by: name_of(look.colour_by, &COLOUR_BY),
            full_scale: look.full_scale,
            velocity_arrows: look.velocity_arrows,
            force_arrows: look.force_arrows,
            ground: look.ground,
            shadows: look.shadows,
            controls: shown.controls,
            plots: shown.plots,
            explain: shown.explain,
            zoom,
        }
    }

    /// How the scene is to look.
    pub fn appearance(&self) -> Appearance {
        Appearance {
            theme: if self.dark { Theme::Dark } else { Theme::Light },
            background: self.background,
            points: named(&self.points, &POINTS),
            springs: named(&self.springs, &SPRINGS),
            surfaces: named(&self.surfaces, &SURFACES),
            colour_by: named(&self.colour_by, &COLOUR_BY),
            full_scale: self.full_scale,
            velocity_arrows: self.velocity_arrows,
            force_arrows: self.force_arrows,
            ground: self.ground,
            shadows: self.shadows,
        }
    }

    /// Which parts of the window are shown.
    pub fn shown(&self) -> Shown {
        let Self { controls, plots, explain, .. } = *self;
        Shown { controls, plots, explain, help: false, presentation: false }
    }

    /// How much larger everything is.
    pub fn zoom(&self) -> f32 {
        self.zoom
    }
}

fn name_of<T: PartialEq + Copy>(value: T, all: &[(T, &str)]) -> String {
    all.iter().find(|(choice, _)| *choice == value).map_or_else(String::new, |(_, name)| (*name).to_owned())
}

/// The choice of this name; the usual one if there is none, as in settings of another version.
fn named<T: Default + Copy>(name: &str, all: &[(T, &str)]) -> T {
    all.iter().find(|(_, known)| *known == name).map_or_else(T::default, |(choice, _)| *choice)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[derive(Default)]
    struct Memory(BTreeMap<String, String>);

    impl Storage for Memory {
        fn get_string(&self, key: &str) -> Option<String> {
            self.0.get(key).cloned()
        }

        fn set_string(&mut self, key: &str, value: String) {
            self.0.insert(key.to_owned(), value);
        }

        fn remove_string(&mut self, key: &str) {
            self.0.remove(key);
        }

        fn flush(&mut self) {}
    }

    #[test]
    fn what_is_kept_comes_back() {
        let (mut looks, mut storage) = (Vec::new(), Memory::default());
        for (points, _) in POINTS {
            for (springs, _) in SPRINGS {
                for (surfaces, _) in SURFACES {
                    for (colour_by, _) in COLOUR_BY {
                        let theme = Theme::Dark;
                        let look =
                            Appearance { theme, points, springs, surfaces, colour_by, ..Default::default() };
                        looks.push(Appearance { background: Some([1, 2, 3]), full_scale: 0.25, ..look });
                    }
                }
            }
        }
        let shown = Shown { controls: false, plots: true, explain: true, help: false, presentation: false };
        for look in looks {
            let scene = Some(Origin::File("some where/ä.toml".into()));
            let kept = Settings::from_parts(&look, shown, scene, 1.5);
            kept.save(&mut storage);
            let back = Settings::load(Some(&storage));
            assert_eq!(back, kept);
            assert_eq!((back.appearance(), back.shown(), back.zoom()), (look, shown, 1.5));
        }
    }

    #[test]
    fn what_cannot_be_read_is_as_if_there_was_none() {
        let mut storage = Memory::default();
        assert_eq!(Settings::load(None), Settings::default());
        for text in ["", "(", "(zoom:\"big\")", "\u{0}\u{1}", "(dark:1e999,", "[[[[[[[[[["] {
            storage.set_string(KEY, text.to_owned());
            assert_eq!(Settings::load(Some(&storage)), Settings::default(), "{text:?}");
        }
    }

    #[test]
    fn settings_of_another_version_are_taken_as_far_as_they_are_known() {
        let mut storage = Memory::default();
        storage.set_string(KEY, "(dark:true,points:\"cubes\",full_scale:NaN,zoom:inf)".to_owned());
        let settings = Settings::load(Some(&storage));
        let look = settings.appearance();
        assert_eq!(look.theme, Theme::Dark);
        assert_eq!(look.points, Default::default());
        assert!(look.full_scale > 0.0);
        assert_eq!(settings.zoom(), 1.0);
    }

    #[test]
    fn no_number_is_taken_that_the_window_cannot_live_with() {
        let mut storage = Memory::default();
        for value in ["1e9", "-1e9", "1e300", "0", "NaN", "inf", "-inf", "1e-40"] {
            let text = format!(
                "(zoom:{value},full_scale:{value},velocity_arrows:{value},force_arrows:{value},dark:true)"
            );
            storage.set_string(KEY, text);
            let settings = Settings::load(Some(&storage));
            assert!(ZOOM.contains(&settings.zoom()), "{value}");
            let look = settings.appearance();
            assert_eq!(look.theme, Theme::Dark, "the rest of {value} is taken");
            assert!((1e-9..=1e12).contains(&look.full_scale), "{value}");
            for length in [look.velocity_arrows, look.force_arrows] {
                assert!((0.0..=1e9).contains(&length), "{value}");
            }
        }
    }
}
