//! Bodies made from a mesh file: what a scene says of them, and the mesh once it has been read.
//!
//! The engine reads no files. [`Scene::load_meshes`] asks for each mesh that the scene names, and keeps what it was given, so
//! that from then on the scene is built as any other.

use std::fmt;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::check::{MAX_POINTS, check};
use super::choices::Numbers;
use super::suggest::shortened;
use super::types::{Body, Exception, Scene, unscaled};
use crate::build::mesh::{
    ClothMaterial, Mesh, MeshBody, NetMaterial, SoftMaterial, cloth, net, soft_body_within,
};
use crate::error::{Code, Error, Result};

/// A mesh file, by its path from the folder of the scene file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeshFile {
    /// The path, with `/` between folders.
    pub file: String,
    /// Vertices closer than this are one point, m (after `scale`). Default: a millionth of the mesh's diagonal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub merge: Option<f64>,
}

/// The table form of [`MeshFile`].
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MeshTable {
    file: String,
    merge: Option<f64>,
}

impl<'de> Deserialize<'de> for MeshFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(MeshVisitor)
    }
}

struct MeshVisitor;

impl<'de> Visitor<'de> for MeshVisitor {
    type Value = MeshFile;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of a mesh file, or { file = …, merge = … }")
    }

    fn visit_str<E: serde::de::Error>(self, file: &str) -> Result<MeshFile, E> {
        if file.is_empty() {
            return Err(E::custom("is empty, and must be the name of a mesh file"));
        }
        Ok(MeshFile { file: file.to_owned(), merge: None })
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<MeshFile, A::Error> {
        let MeshTable { file, merge } = MeshTable::deserialize(MapAccessDeserializer::new(table))?;
        if file.is_empty() {
            return Err(A::Error::custom("has an empty file, and must name a mesh file"));
        }
        Ok(MeshFile { file, merge })
    }
}

impl JsonSchema for MeshFile {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "MeshFile".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A mesh file, by its path from the folder of the scene file.",
            "anyOf": [
                { "type": "string", "minLength": 1 },
                {
                    "type": "object",
                    "properties": {
                        "file": { "type": "string", "minLength": 1, "description": "The path, with / between folders." },
                        "merge": {
                            "type": "number",
                            "minimum": 0,
                            "description": "Vertices closer than this are one point, m (after `scale`). Default: a millionth of the mesh's diagonal."
                        }
                    },
                    "required": ["file"],
                    "additionalProperties": false
                }
            ]
        })
    }
}

/// A mesh as cloth: its material, from which springs follow that make a finer mesh hang the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cloth {
    /// Mass of a square metre, kg/m². Say this or the body's `body_mass` or `point_mass`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density: Option<f64>,
    /// Stretching stiffness, N/m: the force that would stretch a square piece to double length.
    #[schemars(range(min = 0))]
    pub stiffness: f64,
    /// Bending stiffness of a strip one metre wide, N·m. Default: 0.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub bending: f64,
    /// Radius of the folds in which the cloth has this bending stiffness, m. Default: a tenth of the mesh's diagonal.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub bending_radius: Option<f64>,
    /// Damping time, s: each spring's damping is its stiffness times this. Default: 0.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub damping: f64,
    /// Rest length of the springs, as a multiple of that in the mesh: below 1 they start stretched. Default: 1.
    #[serde(default = "unscaled")]
    #[schemars(range(min = 0))]
    pub rest_scale: f64,
    /// Springs that are cut, by their numbers (from 0): a number, or [first, last]. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cut: Vec<Numbers>,
    /// Springs that are unlike the material. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub except: Vec<Exception>,
}

/// A closed mesh as a soft body: filled with points, as stiff as its material however finely it is filled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Soft {
    /// Distance of neighbouring points, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spacing: f64,
    /// Mass of a cubic metre, kg/m³. Say this or the body's `body_mass` or `point_mass`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density: Option<f64>,
    /// Young's modulus, Pa. Poisson's ratio is 1/4.
    #[schemars(range(min = 0))]
    pub stiffness: f64,
    /// Damping time, s: each spring's damping is its stiffness times this. Default: 0.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub damping: f64,
    /// Rest length of the springs, as a multiple of that in the mesh. Default: 1.
    #[serde(default = "unscaled")]
    #[schemars(range(min = 0))]
    pub rest_scale: f64,
    /// Springs that are cut, by their numbers (from 0): a number, or [first, last]. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cut: Vec<Numbers>,
    /// Springs that are unlike the material. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub except: Vec<Exception>,
}

/// A mesh as a net: exactly its edges as springs, all alike.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Net {
    /// Stiffness of each spring, N/m.
    #[schemars(range(min = 0))]
    pub stiffness: f64,
    /// Damping of each spring, N·s/m. Default: 0.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub damping: f64,
    /// Rest length of the springs, as a multiple of that in the mesh. Default: 1.
    #[serde(default = "unscaled")]
    #[schemars(range(min = 0))]
    pub rest_scale: f64,
    /// Springs that are cut, by their numbers (from 0): a number, or [first, last]. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cut: Vec<Numbers>,
    /// Springs that are unlike the others. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub except: Vec<Exception>,
}

/// The mesh that was read for a body, and what was made of it. No part of what the scene says: any two are equal.
#[derive(Clone, Default)]
pub(super) struct Loaded(Option<Arc<Read>>);

struct Read {
    mesh: Arc<Mesh>,
    /// What `made` follows from besides the mesh.
    recipe: Recipe,
    made: MeshBody,
}

impl Loaded {
    /// What was made of it.
    pub fn made(&self) -> Option<&MeshBody> {
        self.0.as_ref().map(|read| &read.made)
    }
}

impl PartialEq for Loaded {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Whether there is one; a mesh is too long to be shown.
impl fmt::Debug for Loaded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Loaded" } else { "NotLoaded" })
    }
}

/// How a body is made of its mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Recipe {
    scale: f64,
    material: Material,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Material {
    Cloth(ClothMaterial),
    Soft(SoftMaterial),
    Net(NetMaterial),
}

impl Recipe {
    fn of(body: &Body) -> Option<Self> {
        let merge = body.mesh.as_ref()?.merge;
        // Where the body's mass is given, the mesh only shares it out.
        let material = match (&body.cloth, &body.soft, &body.net) {
            (Some(cloth), ..) => Material::Cloth(ClothMaterial {
                density: cloth.density.unwrap_or(1.0),
                stiffness: cloth.stiffness,
                bending: cloth.bending,
                bending_radius: cloth.bending_radius,
                damping: cloth.damping,
                merge,
            }),
            (_, Some(soft), _) => Material::Soft(SoftMaterial {
                spacing: soft.spacing,
                density: soft.density.unwrap_or(1.0),
                stiffness: soft.stiffness,
                damping: soft.damping,
                merge,
            }),
            (.., Some(net)) => {
                Material::Net(NetMaterial { stiffness: net.stiffness, damping: net.damping, merge })
            }
            _ => return None,
        };
        Some(Self { scale: body.scale, material })
    }

    fn make(&self, mesh: &Mesh, most_springs: u64) -> Result<MeshBody> {
        let scaled;
        let mesh = if self.scale == 1.0 {
            mesh
        } else {
            scaled = mesh.clone().scaled(self.scale);
            &scaled
        };
        match &self.material {
            Material::Cloth(material) => cloth(mesh, material),
            Material::Soft(material) => soft_body_within(mesh, material, most_springs),
            Material::Net(material) => net(mesh, material),
        }
    }
}

impl Body {
    /// Whether the body is made from a mesh that has not been read.
    pub(super) fn waits_for_mesh(&self) -> bool {
        self.mesh.is_some() && self.loaded.0.is_none()
    }

    /// What was made of the mesh.
    pub(super) fn made(&self) -> Option<&MeshBody> {
        self.mesh.as_ref()?;
        self.loaded.made()
    }

    /// The mesh as it was read.
    pub(super) fn read_mesh(&self) -> Option<&Mesh> {
        self.mesh.as_ref()?;
        self.loaded.0.as_ref().map(|read| &*read.mesh)
    }

    /// The key of the table that says what the mesh becomes.
    pub(super) fn material_key(&self) -> &'static str {
        match self {
            Self { cloth: Some(_), .. } => "cloth",
            Self { soft: Some(_), .. } => "soft",
            _ => "net",
        }
    }

    /// What is said of the springs that the mesh makes: scale of rest lengths, cuts, exceptions.
    pub(super) fn mesh_springs(&self) -> Option<(f64, &[Numbers], &[Exception])> {
        match self {
            Self { cloth: Some(cloth), .. } => Some((cloth.rest_scale, &cloth.cut, &cloth.except)),
            Self { soft: Some(soft), .. } => Some((soft.rest_scale, &soft.cut, &soft.except)),
            Self { net: Some(net), .. } => Some((net.rest_scale, &net.cut, &net.except)),
            _ => None,
        }
    }

    /// The same, to be changed.
    pub(super) fn mesh_springs_mut(&mut self) -> Option<(&mut f64, &mut Vec<Numbers>, &mut Vec<Exception>)> {
        match self {
            Self { cloth: Some(cloth), .. } => {
                Some((&mut cloth.rest_scale, &mut cloth.cut, &mut cloth.except))
            }
            Self { soft: Some(soft), .. } => Some((&mut soft.rest_scale, &mut soft.cut, &mut soft.except)),
            Self { net: Some(net), .. } => Some((&mut net.rest_scale, &mut net.cut, &mut net.except)),
            _ => None,
        }
    }

    /// Makes of a mesh what the body says now, in a scene of so many springs at most.
    fn load(&mut self, path: &str, mesh: &Arc<Mesh>, most_springs: u64) -> Result<()> {
        let (Some(recipe), Some(file)) = (Recipe::of(self), &self.mesh) else { return Ok(()) };
        let made = recipe.make(mesh, most_springs).map_err(|error| {
            // Either a value of the material will not do, or the mesh is at fault.
            let at_fault = match error.place().field.as_deref() {
                Some(key) => Error::new(error.code(), error.sentence())
                    .at_field(format!("{path}.{}.{key}", self.material_key())),
                None => {
                    let sentence = format!("\"{}\" {}", shortened(&file.file), error.sentence());
                    Error::new(error.code(), sentence).at_field(format!("{path}.mesh"))
                }
            };
            match error.fix() {
                Some(fix) => at_fault.with_fix(fix),
                None => at_fault,
            }
        })?;
        self.loaded = Loaded(Some(Arc::new(Read { mesh: Arc::clone(mesh), recipe, made })));
        Ok(())
    }

    /// Whether what was made of the mesh is not what the body says now.
    fn is_out_of_date(&self) -> bool {
        self.loaded.0.as_ref().is_some_and(|read| Some(read.recipe) != Recipe::of(self))
    }
}

impl Scene {
    /// Whether bodies of the scene are made from mesh files that have not been read: [`load_meshes`](Self::load_meshes) first.
    pub fn waits_for_meshes(&self) -> bool {
        self.bodies.iter().any(Body::waits_for_mesh)
    }

    /// Reads the meshes of all bodies made from one: `read` is given each file's name as the scene has it, once. Gives what is
    /// odd about the meshes, a sentence each; they are kept in the scene, and can be used nevertheless.
    ///
    /// ```
    /// use sprung::build::{Mesh, mesh::Faces};
    /// use sprung::scene::Scene;
    ///
    /// let text = r#"
    ///     [[body]]
    ///     name = "patch"
    ///     mesh = "patch.obj"
    ///     cloth = { density = 0.2, stiffness = 100 }
    /// "#;
    /// let mut scene = Scene::parse(text, "patch.toml")?;
    /// scene.load_meshes(&mut |_file| {
    ///     let mut mesh = Mesh::default();
    ///     mesh.positions = vec![sprung::DVec3::ZERO, sprung::DVec3::X, sprung::DVec3::Z];
    ///     mesh.faces.push(&[0, 1, 2]);
    ///     Ok(mesh)
    /// })?;
    /// assert_eq!(scene.build()?.0.spring_count(), 3);
    /// # Ok::<(), sprung::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of `read`; a mesh of which the body cannot be made, and all that [`parse`](Self::parse) could not yet check: points
    /// and groups by name or number, lists for each point.
    pub fn load_meshes(&mut self, read: &mut dyn FnMut(&str) -> Result<Mesh>) -> Result<Vec<String>> {
        self.load_shared(&mut |file| read(file).map(Arc::new))
    }

    /// The meshes that were read, each with the name of its file as the scene has it, once.
    pub fn meshes(&self) -> Vec<(String, Arc<Mesh>)> {
        let mut meshes: Vec<(String, Arc<Mesh>)> = Vec::new();
        for body in &self.bodies {
            if let (Some(file), Some(read)) = (&body.mesh, &body.loaded.0)
                && meshes.iter().all(|(name, _)| *name != file.file)
            {
                meshes.push((file.file.clone(), Arc::clone(&read.mesh)));
            }
        }
        meshes
    }

    /// What is odd about the meshes that were read and was mended or left out, a sentence each that names body and file.
    pub fn mesh_warnings(&self) -> Vec<String> {
        let of = |body: &Body| -> Vec<String> {
            let (Some(MeshFile { file, .. }), Some(made)) = (&body.mesh, body.made()) else {
                return Vec::new();
            };
            let named = |sentence: &String| format!("{} ({}): {sentence}", body.name, shortened(file));
            made.warnings.iter().map(named).collect()
        };
        self.bodies.iter().flat_map(of).collect()
    }

    /// As [`load_meshes`](Self::load_meshes), with meshes that were read before: those that [`meshes`](Self::meshes) gave.
    ///
    /// # Errors
    /// [`Code::NotFound`] for one that is not among them, and as [`load_meshes`](Self::load_meshes).
    pub fn take_meshes(&mut self, meshes: &[(String, Arc<Mesh>)]) -> Result<()> {
        let find = |file: &str| {
            let found = meshes.iter().find(|(name, _)| name == file);
            found.map(|(_, mesh)| Arc::clone(mesh)).ok_or_else(|| {
                Error::new(Code::NotFound, format!("the mesh \"{}\" is not there", shortened(file)))
            })
        };
        self.load_shared(&mut |file| find(file)).map(|_| ())
    }

    fn load_shared(&mut self, read: &mut dyn FnMut(&str) -> Result<Arc<Mesh>>) -> Result<Vec<String>> {
        let mut meshes: Vec<(String, Arc<Mesh>)> = Vec::new();
        let (origin, most_springs) = (self.origin.clone(), self.spring_limit());
        for (index, body) in self.bodies.iter_mut().enumerate() {
            let Some(MeshFile { file, .. }) = body.mesh.clone() else { continue };
            let mesh = match meshes.iter().find(|(name, _)| *name == file) {
                Some((_, mesh)) => Arc::clone(mesh),
                None => {
                    let mesh = read(&file)?;
                    meshes.push((file.clone(), Arc::clone(&mesh)));
                    mesh
                }
            };
            body.load(&format!("body[{index}]"), &mesh, most_springs)
                .map_err(|error| origin.locate(error))?;
        }
        check(self, MAX_POINTS).map_err(|error| origin.locate(error))?;
        Ok(self.mesh_warnings())
    }

    /// Takes over the meshes of the scene that this one was before a change.
    pub(super) fn keep_meshes(&mut self, before: &Self) -> Result<()> {
        for (body, old) in self.bodies.iter_mut().zip(&before.bodies) {
            let file = |body: &Body| body.mesh.as_ref().map(|mesh| mesh.file.clone());
            if file(body) == file(old) {
                body.loaded = old.loaded.clone();
            }
        }
        self.remake_meshes()
    }

    /// The scene with what follows from its meshes made anew, if something that it follows from has changed.
    pub(super) fn up_to_date(&self) -> Result<Option<Self>> {
        if !self.bodies.iter().any(Body::is_out_of_date) {
            return Ok(None);
        }
        let mut scene = self.clone();
        scene.remake_meshes()?;
        Ok(Some(scene))
    }

    fn remake_meshes(&mut self) -> Result<()> {
        let most_springs = self.spring_limit();
        for (index, body) in self.bodies.iter_mut().enumerate().filter(|(_, body)| body.is_out_of_date()) {
            let read = std::mem::take(&mut body.loaded);
            if let Some(read) = read.0 {
                body.load(&format!("body[{index}]"), &read.mesh, most_springs)?;
            }
        }
        Ok(())
    }
}
