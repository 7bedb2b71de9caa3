//! Changing one value of a scene from outside its file: `--set KEY=VALUE`.

use toml::de::DeTable;
use toml::{Table, Value};

use super::check::{MAX_POINTS, check};
use super::read::{self, keys_of};
use super::source::syntax_error;
use super::suggest::{did_you_mean, shortened};
use super::types::{Body, Scene};
use crate::error::{Code, Error, Result};

/// Parts that a key may have: more than any scene has levels, and few enough to walk down one by one.
const MOST_STEPS: usize = 32;

/// Keys that stand for the same key in every group of springs and every joint.
const SHORTHANDS: [&str; 3] = ["stiffness", "damping", "rest_scale"];

impl Scene {
    /// Changes one value. The key is a path such as `dt`, `plane.y` or `body.jelly.springs.0.stiffness`; where there are
    /// several of a thing, the next part may be an index (from 0), a body's name, or be left out to mean all of them.
    /// `stiffness`, `damping` and `rest_scale` alone mean those of all springs, after a body (`body.jelly.stiffness`) those
    /// of all its springs, a net's too. Cloth and soft bodies are of a material with units of its own: there `stiffness` and
    /// `damping` alone are refused, and `body.towel.cloth.stiffness` says what is meant. The value is written as in a scene
    /// file; a single word needs no quotes.
    ///
    /// ```
    /// # use sprung::scene::Scene;
    /// let mut scene = Scene::builtin("jelly")?;
    /// scene.set("gravity", "[0, -1.62, 0]")?;
    /// scene.set("body.jelly.springs.stiffness", "500")?;
    /// assert_eq!(scene.bodies[0].springs[0].stiffness, 500.0);
    /// # Ok::<(), sprung::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`parse`](Self::parse), with `--set KEY=VALUE` as the place; the scene then stays as it was.
    pub fn set(&mut self, key: &str, value: &str) -> Result<()> {
        let argument = format!("--set {}={}", shortened(key), shortened(value));
        self.changed(key, value, &argument)
            .map(|scene| *self = scene)
            .map_err(|error| error.in_file(argument))
    }

    fn changed(&self, key: &str, value: &str, argument: &str) -> Result<Self> {
        let value = parse_value(value).map_err(|error| match error.code() {
            Code::OutOfRange => error.at_field(shortened(key)),
            _ => error,
        })?;
        let mut table = Table::try_from(self).map_err(|error| {
            Error::new(Code::Unsupported, format!("the scene cannot be changed: {error}"))
        })?;
        let mut fields = Vec::new();
        let steps: Vec<&str> = key.split('.').collect();
        if steps.len() > MOST_STEPS {
            let sentence =
                format!("has a key of {} parts, and there may be at most {MOST_STEPS}", steps.len());
            return Err(Error::new(Code::TooLarge, sentence));
        }
        match steps[..] {
            _ if steps.iter().any(|step| step.is_empty()) => {
                let sentence = "needs a key, a name such as dt or names joined by dots such as plane.y";
                return Err(Error::new(Code::Syntax, sentence));
            }
            [key] if SHORTHANDS.contains(&key) => {
                self.refuse_for_materials(key, None)?;
                let _ = put_in_springs(&mut table, &["body"], key, &value, &mut fields)?;
                match put_in_table(&mut table, &["joint", key], &value, "", &mut fields) {
                    Err(error) if error.code() != Code::NotFound => return Err(error),
                    _ => {} // a scene without joints, say
                }
            }
            ["body", key] if SHORTHANDS.contains(&key) => {
                self.refuse_for_materials(key, None)?;
                put_in_springs(&mut table, &["body"], key, &value, &mut fields)?.map_or(Ok(()), Err)?;
            }
            ["body", which, key] if SHORTHANDS.contains(&key) && self.is_body(which) => {
                self.refuse_for_materials(key, Some(which))?;
                put_in_springs(&mut table, &["body", which], key, &value, &mut fields)?
                    .map_or(Ok(()), Err)?;
            }
            [key] if !keys_of::<Self>().contains(&key) => return Err(unknown_key(key)),
            _ => put_in_table(&mut table, &steps, &value, "", &mut fields)?,
        }
        if fields.is_empty() {
            return Err(
                Error::new(Code::NotFound, "the scene has nothing of that name").at_field(shortened(key))
            );
        }
        // Read back as a file is read, so that every check is made and every error is worded the same.
        let text = toml::to_string(&table).map_err(|error| Error::new(Code::Syntax, error.to_string()))?;
        let document = DeTable::parse(&text).map_err(|error| syntax_error(&error, &text))?;
        let mut scene: Self = read::from_document(&document).map_err(read::ReadError::into_error)?;
        scene.keep_meshes(self)?;
        check(&scene, MAX_POINTS)?;
        scene.origin = self.origin.with_overrides(&fields, argument);
        Ok(scene)
    }

    /// Whether a step after `body` is an index or a body's name.
    fn is_body(&self, step: &str) -> bool {
        step.parse::<usize>().is_ok() || self.bodies.iter().any(|body| body.name == step)
    }

    /// A material's stiffness and damping have other units than those of springs: one number cannot be meant for both.
    fn refuse_for_materials(&self, key: &str, which: Option<&str>) -> Result<()> {
        if key == "rest_scale" {
            return Ok(());
        }
        let is_meant = |index: usize, body: &Body| match which.map(|step| (step, step.parse::<usize>())) {
            None => true,
            Some((_, Ok(wanted))) => index == wanted,
            Some((name, Err(_))) => body.name == name,
        };
        let found = self.bodies.iter().enumerate().find_map(|(index, body)| {
            let unit = match (&body.cloth, &body.soft, key) {
                (None, None, _) => return None,
                (.., "damping") => "s",
                (Some(_), ..) => "N/m of a strip as wide as long",
                _ => "Pa",
            };
            is_meant(index, body).then(|| (body, body.material_key(), unit))
        });
        let Some((body, kind, unit)) = found else { return Ok(()) };
        let name = shortened(&body.name);
        let sentence =
            format!("is that of springs, and \"{name}\" is {kind}, a material with a {key} in {unit}");
        let fix = format!(
            "write body.{name}.{kind}.{key} for it, and body.springs.{key} or joint.{key} for springs"
        );
        Err(Error::new(Code::Conflict, sentence).with_fix(fix).at_field(shortened(key)))
    }
}

/// Puts a value into all springs of the bodies that `owner` leads to, those that meshes make too. Gives what is missing if
/// there are none.
fn put_in_springs(
    table: &mut Table,
    owner: &[&str],
    key: &str,
    value: &Value,
    fields: &mut Vec<String>,
) -> Result<Option<Error>> {
    let (before, mut nothing) = (fields.len(), None);
    // A net's values are those of its springs; of a material only the scale of rest lengths is.
    let tables: &[&str] =
        if key == "rest_scale" { &["springs", "net", "cloth", "soft"] } else { &["springs", "net"] };
    for &of_springs in tables {
        match put_in_table(table, &[owner, &[of_springs, key]].concat(), value, "", fields) {
            Err(error) if error.code() == Code::NotFound => nothing = nothing.or(Some(error)),
            done => done?,
        }
    }
    Ok(nothing.filter(|_| fields.len() == before))
}

/// What may stand alone: the scene's own keys and the shorthands.
fn unknown_key(key: &str) -> Error {
    let allowed = [keys_of::<Scene>(), &SHORTHANDS].concat();
    let error =
        Error::new(Code::UnknownKey, format!("is not a known key; allowed here are {}", allowed.join(", ")));
    let error = error.at_field(shortened(key));
    match did_you_mean(key, allowed.iter().copied()) {
        Some(fix) => error.with_fix(fix),
        None => error,
    }
}

/// A value in TOML syntax. A shell takes quotes away, so a single word counts as text.
fn parse_value(text: &str) -> Result<Value> {
    let is_word = !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c));
    // A number too large for a float is not TOML, but it is no word either.
    let is_number = text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    if is_number && text.parse::<f64>().is_ok_and(f64::is_infinite) {
        let sentence = format!("is {}, and must be a finite number", shortened(text));
        return Err(Error::new(Code::OutOfRange, sentence));
    }
    match text.parse::<Value>() {
        Ok(value) => Ok(value),
        Err(_) if is_word => Ok(Value::String(text.to_owned())),
        Err(error) => Err(syntax_error(&error, text)
            .with_fix("write the value as in a scene file, such as 0.5 or [0, 1, 0]")),
    }
}

/// Puts a value where the steps lead, and notes the fields it went to.
fn put_in_table(
    table: &mut Table,
    steps: &[&str],
    value: &Value,
    path: &str,
    fields: &mut Vec<String>,
) -> Result<()> {
    let Some((&step, rest)) = steps.split_first() else { return Ok(()) };
    let name = shortened(step);
    let field = if path.is_empty() { name } else { format!("{path}.{name}") };
    if rest.is_empty() {
        table.insert(step.to_owned(), value.clone());
        fields.push(field);
        return Ok(());
    }
    match table.get_mut(step) {
        Some(inner) => put(inner, rest, value, &field, fields),
        None if ["plane", "joint", "springs", "pins", "cloth", "soft", "net"].contains(&step) => {
            Err(match path {
                "" => Error::new(Code::NotFound, format!("this scene has no {step}")),
                _ => Error::new(Code::NotFound, format!("has no {step}")).at_field(path),
            })
        }
        None => {
            // A table that the scene leaves out, such as rotation; the reader refuses it if there is no such key.
            let mut inner = Table::new();
            put_in_table(&mut inner, rest, value, &field, fields)?;
            table.insert(step.to_owned(), Value::Table(inner));
            Ok(())
        }
    }
}

fn put(here: &mut Value, steps: &[&str], value: &Value, path: &str, fields: &mut Vec<String>) -> Result<()> {
    let Some((&step, rest)) = steps.split_first() else {
        *here = value.clone();
        fields.push(path.to_owned());
        return Ok(());
    };
    match here {
        Value::Table(table) => put_in_table(table, steps, value, path, fields),
        Value::Array(list) => {
            let count = list.len();
            if path == "body" {
                check_body_step(list, step)?;
            }
            let named = |entry: &Value| entry.get("name").and_then(Value::as_str) == Some(step);
            let index = step.parse().ok().or_else(|| list.iter().position(named));
            if let Some(index) = index {
                let Some(entry) = list.get_mut::<usize>(index) else {
                    let sentence = format!(
                        "there is no entry {index} here; entries are 0 to {}",
                        count.saturating_sub(1)
                    );
                    return Err(Error::new(Code::NotFound, sentence).at_field(path));
                };
                return put(entry, rest, value, &format!("{path}[{index}]"), fields);
            }
            // All of them; some may have nothing of that name, such as a body without springs, but not every one.
            let (before, mut nothing) = (fields.len(), None);
            for (index, entry) in list.iter_mut().enumerate() {
                match put(entry, steps, value, &format!("{path}[{index}]"), fields) {
                    Err(error) if error.code() == Code::NotFound => nothing = nothing.or(Some(error)),
                    done => done?,
                }
            }
            nothing.filter(|_| fields.len() == before).map_or(Ok(()), Err)
        }
        _ => Err(Error::new(Code::WrongType, "is a single value, and has nothing inside").at_field(path)),
    }
}

/// After `body` comes an index, a body's name or a key.
fn check_body_step(bodies: &[Value], step: &str) -> Result<()> {
    let names = || bodies.iter().filter_map(|body| body.get("name").and_then(Value::as_str));
    let keys = keys_of::<Body>();
    if step.parse::<usize>().is_ok()
        || names().any(|name| name == step)
        || [keys, &SHORTHANDS].concat().contains(&step)
    {
        return Ok(());
    }
    let all = names().collect::<Vec<_>>().join(", ");
    let sentence =
        format!("is neither a body's name nor a key of bodies; the bodies are {}", shortened(&all));
    let error = Error::new(Code::UnknownKey, sentence).at_field(format!("body.{}", shortened(step)));
    Err(match did_you_mean(step, names().chain(keys.iter().copied())) {
        Some(fix) => error.with_fix(fix),
        None => error,
    })
}
