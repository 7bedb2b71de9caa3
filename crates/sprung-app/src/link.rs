//! A link is a scene: what is open, with all parameters as they are now, and from where it is seen, as the part of an address
//! behind `#`.
//!
//! ```text
//! v=0.1.0&scene=jelly&view=0,5,0,40,0.76,0.39          a built-in scene as it comes
//! v=0.1.0&name=jelly&toml=q1YKSS0uUbJ…&view=…           any other: its text, deflated (RFC 1951), in base64 for addresses (RFC 4648)
//! ```
//!
//! A view is the target's x, y and z, the distance (m), azimuth and elevation (rad).

use std::fmt::Write;

use sprung::scene::Scene;
use sprung::{Code, Error, Result, Vec3};
use sprung_driver::{Report, Source};
use sprung_io::link as packing;
use sprung_render::turntable::Turntable;

use crate::files::{Origin, scene_text};

/// This program's version.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The most characters of a link that are looked at.
const MOST_READ: usize = 1 << 20;

/// A scene to open, and how to look at it.
#[derive(Clone, Debug)]
pub struct Link {
    /// The scene.
    pub source: Source,
    /// Where it comes from.
    pub origin: Origin,
    /// From where it is seen.
    pub view: Option<Turntable>,
    /// The version of the program that made the link, where that is not this one: the motion may be another.
    pub other_version: Option<String>,
}

/// What is open now, with all parameters as they are, as a link.
///
/// # Errors
/// [`Code::Unsupported`] for what a link cannot hold, such as a mesh; [`Code::TooLarge`] if it would be too long.
pub fn link(report: &Report, view: &Turntable) -> Result<String> {
    let (opened, name) = (&report.opened, &report.opened.name);
    // As it comes: nothing has to be built to know that.
    let is_untouched =
        *report.params == *opened.params && Origin::of(name, &opened.scene) == Origin::Builtin(name.clone());
    let mut link = format!("v={VERSION}");
    // Writing to a String cannot fail.
    let _ = if is_untouched {
        write!(link, "&scene={name}")
    } else {
        packing::check_scene(&opened.scene)?;
        write!(link, "&{}", packing::parts(name, &scene_text(report)?))
    };
    let Turntable { target: Vec3 { x, y, z }, distance, azimuth, elevation } = *view;
    let _ = write!(link, "&view={x},{y},{z},{distance},{azimuth},{elevation}");
    packing::check_length(&link)?;
    Ok(link)
}

/// What a link holds; `None` if there is nothing behind the `#`.
///
/// # Errors
/// Whatever is wrong with it: it may come from anybody.
pub fn read(fragment: &str) -> Result<Option<Link>> {
    if fragment.is_empty() {
        return Ok(None);
    }
    parsed(fragment)
        .map(Some)
        .map_err(|error| if error.place().file.is_some() { error } else { error.in_file("the link") })
}

fn parsed(fragment: &str) -> Result<Link> {
    if fragment.len() > MOST_READ {
        let sentence = format!("has {} characters, and at most {MOST_READ} are read", fragment.len());
        return Err(Error::new(Code::TooLarge, sentence));
    }
    let [mut version, mut scene, mut name, mut toml, mut view] = [None; 5];
    for part in fragment.split('&') {
        let (key, value) = part.split_once('=').unwrap_or((part, ""));
        let place = match key {
            "v" => &mut version,
            "scene" => &mut scene,
            "name" => &mut name,
            "toml" => &mut toml,
            "view" => &mut view,
            _ => {
                let sentence =
                    format!("says \"{}\", and a link may say v, scene, name, toml and view", shortened(key));
                return Err(Error::new(Code::UnknownKey, sentence));
            }
        };
        if place.replace(value).is_some() {
            return Err(Error::new(Code::Duplicate, format!("says {key} twice")));
        }
    }
    let (source, origin) = match (scene, toml) {
        (Some(builtin), None) => {
            let scene = Scene::builtin(builtin)?;
            (Source { name: builtin.to_owned(), scene }, Origin::Builtin(builtin.to_owned()))
        }
        (None, Some(packed)) => {
            let name = packing::plain(name.unwrap_or("linked"));
            let scene = Scene::parse(&packing::unpacked(packed)?, &format!("{name}.toml"))?;
            if let Some(mesh) = mesh_of(&scene) {
                let sentence = format!("has the mesh {}, and a link holds no files", shortened(mesh));
                return Err(Error::new(Code::Unsupported, sentence));
            }
            (Source { name: name.clone(), scene }, Origin::Other(name))
        }
        (Some(_), Some(_)) => {
            return Err(Error::new(Code::Conflict, "has two scenes: one by name and one as text"));
        }
        (None, None) => return Err(Error::new(Code::MissingField, "has no scene")),
    };
    let view = view.map(read_view).transpose()?;
    let other_version = version.filter(|version| *version != VERSION).map(shortened);
    Ok(Link { source, origin, view, other_version })
}

/// The file of a mesh that a scene has.
fn mesh_of(scene: &Scene) -> Option<&str> {
    scene.bodies.iter().find_map(|body| Some(body.mesh.as_ref()?.file.as_str()))
}

fn read_view(text: &str) -> Result<Turntable> {
    let numbers: Vec<f32> = text.split(',').filter_map(|number| number.parse().ok()).collect();
    let refused = || {
        let sentence = format!(
            "has the view {}, which must be six numbers: a target, a distance above 0, two angles",
            shortened(text)
        );
        Error::new(Code::OutOfRange, sentence)
    };
    let [x, y, z, distance, azimuth, elevation] = numbers[..] else { return Err(refused()) };
    let view = Turntable { target: Vec3::new(x, y, z), distance, azimuth, elevation };
    if text.split(',').count() == 6 && view.is_sane() { Ok(view) } else { Err(refused()) }
}

/// What somebody else wrote, as far as one wants to read it.
fn shortened(text: &str) -> String {
    let mut short: String = text.chars().filter(|c| !c.is_control()).take(40).collect();
    if text.chars().count() > 40 {
        short.push('…');
    }
    short
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use sprung::Change;
    use sprung_driver::{Command, Driver, Edit};

    use super::*;

    const VIEW: Turntable =
        Turntable { target: Vec3::new(0.1, -2.0, 3.5), distance: 12.25, azimuth: 0.7, elevation: -0.3 };

    fn opened(name: &str) -> Driver {
        let scene = Scene::builtin(name).expect("it is built in");
        Driver::new(Source { name: name.to_owned(), scene }).expect("it can be built")
    }

    #[test]
    fn a_built_in_scene_is_named() {
        let link = link(&opened("jelly").report(), &VIEW).expect("it is short");
        assert_eq!(link, format!("v={VERSION}&scene=jelly&view=0.1,-2,3.5,12.25,0.7,-0.3"));
        let read = read(&link).expect("it is ours").expect("it is a link");
        assert_eq!((read.source.name.as_str(), read.view, read.other_version), ("jelly", Some(VIEW), None));
        assert_eq!(read.origin, Origin::Builtin("jelly".to_owned()));
    }

    /// Every scene, with changed parameters: the same motion comes out of the link, bit for bit.
    #[test]
    fn a_link_gives_the_same_motion() {
        for builtin in sprung::scene::BUILTIN.iter().filter(|it| it.kind != sprung::scene::Kind::Benchmark) {
            let mut driver = opened(builtin.name);
            let changes = vec![Change::Gravity(Vec3::new(0.5, -3.0, 0.0)), Change::Substeps(3)];
            driver.obey(Command::Edit(Edit::new("some", changes)));
            let report = driver.report();
            let link = link(&report, &VIEW).expect("it is short");
            assert!(link.len() < 4000, "{} has {} characters", builtin.name, link.len());
            let read = read(&link).expect("it is ours").expect("it is a link");
            let mut from_link = read.source.scene.simulation().expect("it can be built");
            let mut here = report.opened.scene.simulation().expect("it can be built");
            here.change(Change::Gravity(Vec3::new(0.5, -3.0, 0.0))).expect("it is allowed");
            here.change(Change::Substeps(3)).expect("it is allowed");
            for simulation in [&mut from_link, &mut here] {
                simulation.steps(50).expect("it is stable");
            }
            assert_eq!(from_link.state_hash(), here.state_hash(), "{}", builtin.name);
        }
    }

    #[test]
    fn another_version_is_noticed() {
        let read = read("v=9.9.9&scene=chain").expect("it can be read").expect("it is a link");
        assert_eq!(read.other_version.as_deref(), Some("9.9.9"));
    }

    #[test]
    fn what_is_wrong_with_a_link_is_said() {
        let bomb = packing::parts("bomb", &" ".repeat(packing::MOST_TEXT + 1));
        let cases: [(&str, &str); 12] = [
            ("v=1", "the link: has no scene"),
            ("scene=jelly&scene=chain", "the link: says scene twice"),
            (
                "scene=jelly&evil=1",
                "the link: says \"evil\", and a link may say v, scene, name, toml and view",
            ),
            ("scene=jely", "the link: there is no built-in scene \"jely\""),
            ("scene=jelly&toml=AA", "the link: has two scenes: one by name and one as text"),
            ("toml=%%%", "the link: is cut or changed: its scene cannot be unpacked"),
            ("toml=AAAA", "the link: is cut or changed: its scene cannot be unpacked"),
            (&bomb, "the link: is cut or changed: its scene cannot be unpacked"),
            (&packing::parts("a/b", "dt = -1"), "a-b.toml:1:6: dt: "),
            ("scene=jelly&view=1,2,3", "the link: has the view 1,2,3, which must be six numbers"),
            (
                "scene=jelly&view=1,2,3,-4,0,0",
                "the link: has the view 1,2,3,-4,0,0, which must be six numbers",
            ),
            (
                "scene=jelly&view=nan,2,3,4,0,0",
                "the link: has the view nan,2,3,4,0,0, which must be six numbers",
            ),
        ];
        for (link, said) in cases {
            let error = read(link).expect_err(link);
            assert!(error.to_string().starts_with(said), "{link:.60}: {error}");
        }
        assert!(read("").expect("there is none").is_none());
    }

    proptest! {
        #[test]
        fn any_link_is_read_or_refused(link in "(v|scene|name|toml|view|&|=|,|[a-zA-Z0-9_.%-]|\\PC){0,60}") {
            let _ = read(&link);
        }

        #[test]
        fn a_changed_link_is_read_or_refused(at in 0usize..200, with in 0u8..128) {
            let mut driver = opened("chain");
            driver.obey(Command::Edit(Edit::new("dt", vec![Change::Dt(0.003)])));
            let mut link = link(&driver.report(), &VIEW).expect("it is short").into_bytes();
            let at = at % link.len();
            link[at] = with;
            let _ = read(&String::from_utf8(link).expect("it is ASCII"));
        }
    }
}
