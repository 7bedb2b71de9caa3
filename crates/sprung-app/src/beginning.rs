//! What a window begins with: what was asked for, else what was open last, else the jelly.

use std::path::Path;

use sprung::scene::Scene;
use sprung::{Error, Result};
use sprung_driver::{Beginning, Options, Source};

use crate::files::Origin;
use crate::settings::Settings;

/// The scene at the very first start.
const FIRST_SCENE: &str = "jelly";

/// What to begin with; and why it is not what was open last, where that is gone.
pub(crate) fn first(
    given: Option<Beginning>,
    path: Option<&Path>,
    settings: &Settings,
    limits: &Options,
) -> Result<(Beginning, Origin, Option<Error>)> {
    if let Some(beginning) = given {
        let origin = match (path, &beginning) {
            (Some(path), _) => Origin::file(path),
            (None, Beginning::Scene(source)) => Origin::of(&source.name, &source.scene),
            (None, Beginning::Running(running)) => Origin::Other(running.name.clone()),
        };
        return Ok((beginning, origin, None));
    }
    let mut refused = None;
    if let Some(origin) = &settings.scene {
        match origin.find().and_then(|found| found.begin(limits)) {
            Ok(beginning) => return Ok((beginning, origin.clone(), None)),
            Err(error) => refused = Some(error),
        }
    }
    let source = Source { name: FIRST_SCENE.to_owned(), scene: Scene::builtin(FIRST_SCENE)? };
    Ok((source.into(), Origin::Builtin(FIRST_SCENE.to_owned()), refused))
}

#[cfg(test)]
mod tests {
    use sprung::Code;

    use super::*;

    #[test]
    fn a_scene_that_is_gone_is_said_and_the_jelly_opens() {
        let settings =
            Settings { scene: Some(Origin::File("nowhere/at all.toml".into())), ..Settings::default() };
        let (beginning, origin, refused) =
            first(None, None, &settings, &Default::default()).expect("the jelly is built in");
        let Beginning::Scene(source) = beginning else { panic!("it is a scene") };
        assert_eq!((source.name.as_str(), origin), ("jelly", Origin::Builtin("jelly".to_owned())));
        assert_eq!(refused.map(|error| error.code()), Some(Code::Unreadable));
    }

    #[test]
    fn a_checkpoint_that_was_open_last_is_gone_on_with() {
        let folder = tempfile::tempdir().expect("there is a disk");
        let path = folder.path().join("mine.sprung");
        let scene = Scene::builtin("chain").expect("it is built in");
        let mut simulation = scene.simulation().expect("it can be built");
        simulation.steps(9).expect("it is stable");
        let saved = sprung_io::checkpoint::Saved::new("chain", &scene, &mut simulation);
        sprung_io::checkpoint::Keeper::begin(&path)
            .and_then(|mut it| it.write(&saved))
            .expect("there is room");
        let settings = Settings { scene: Some(Origin::File(path.clone())), ..Settings::default() };
        let begin = || first(None, None, &settings, &Default::default()).expect("something opens");
        let (Beginning::Running(running), origin, None) = begin() else { panic!("it is under way") };
        assert_eq!((running.simulation.now().0, origin), (9, Origin::File(path.clone())));
        std::fs::write(&path, "something else").expect("it is ours");
        let (Beginning::Scene(source), _, Some(error)) = begin() else { panic!("it is no checkpoint") };
        assert_eq!((source.name.as_str(), error.code()), (FIRST_SCENE, Code::Unreadable));
    }

    #[test]
    fn a_scene_that_was_handed_in_is_found_where_it_came_from() {
        let scene = || Scene::builtin("chain").expect("built in");
        let given = || Beginning::from(Source { name: "mine".to_owned(), scene: scene() });
        let path = std::path::absolute("mine.toml").expect("there is a current folder");
        let origin = |path: Option<&Path>| {
            first(Some(given()), path, &Settings::default(), &Default::default()).expect("it is there").1
        };
        assert_eq!(origin(Some(Path::new("mine.toml"))), Origin::File(path));
        assert_eq!(origin(None), Origin::Other("mine".to_owned()));
    }
}
