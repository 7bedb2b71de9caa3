//! The scenes that come with the program: one list, which feeds the command's help, menus, tests and documentation.

/// What a built-in scene is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One of the four scenes of the report, with its numbers.
    Report,
    /// One that shows something more.
    Gallery,
    /// A large one, for measuring speed.
    Benchmark,
}

/// A scene that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// Its name, as a command takes it.
    pub name: &'static str,
    /// What it is for.
    pub kind: Kind,
    /// The text of its file.
    pub text: &'static str,
}

/// An entry of the list: the name is that of the file.
macro_rules! builtin {
    ($kind:ident, $name:literal) => {
        Builtin {
            name: $name,
            kind: Kind::$kind,
            text: include_str!(concat!("../../../../scenes/", $name, ".toml")),
        }
    };
}

/// All built-in scenes: those of the report, the gallery, the benchmarks.
pub static BUILTIN: &[Builtin] = &[
    builtin!(Report, "spring"),
    builtin!(Report, "chain"),
    builtin!(Report, "jelly"),
    builtin!(Report, "cloth"),
    builtin!(Gallery, "flag"),
    builtin!(Gallery, "bridge"),
    builtin!(Gallery, "pile"),
    builtin!(Gallery, "trampoline"),
    builtin!(Gallery, "valley"),
    builtin!(Gallery, "beam"),
    builtin!(Benchmark, "cloth512"),
    builtin!(Benchmark, "jelly64"),
];

/// The commented scene that a new file starts from.
pub static STARTER: &str = include_str!("../../../../scenes/starter.toml");
