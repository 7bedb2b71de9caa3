//! Points and springs from arrays, and the shapes that the engine knows.

use std::collections::HashMap;
use std::sync::Arc;

use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use sprung::build::{
    Lattice, Material, ModelBuilder, SpringKind, estimated_bytes, pairs_between, pairs_within,
};
use sprung::scene::MAX_POINTS;
use sprung::{Code, DVec3, Error, Params, Result, State, SurfaceKind, Vec3};

use crate::errors::raised;
use crate::numbers;

/// A model with the parameters and the state that it begins with. It never changes.
#[pyclass(frozen, subclass, module = "sprung._engine")]
pub struct Model {
    pub model: Arc<sprung::Model>,
    pub params: Params,
    pub state: State,
    /// What it is called.
    ///
    /// >>> import sprung
    /// >>> sprung.Model([[0, 0, 0]], 1, title="A stone").title
    /// 'A stone'
    #[pyo3(get)]
    pub title: String,
}

#[pymethods]
impl Model {
    /// Points and springs by their arrays; `bodies` are names and numbers of points.
    #[new]
    #[pyo3(signature = (
        positions, mass, springs, *, stiffness, damping, rest_lengths, velocities, pinned, triangles, bodies, title
    ))]
    #[allow(clippy::too_many_arguments, reason = "called by our own Python")]
    fn new(
        py: Python<'_>,
        positions: &Bound<'_, PyAny>,
        mass: &Bound<'_, PyAny>,
        springs: &Bound<'_, PyAny>,
        stiffness: &Bound<'_, PyAny>,
        damping: &Bound<'_, PyAny>,
        rest_lengths: Option<&Bound<'_, PyAny>>,
        velocities: Option<&Bound<'_, PyAny>>,
        pinned: Option<&Bound<'_, PyAny>>,
        triangles: Option<&Bound<'_, PyAny>>,
        bodies: Vec<(String, usize)>,
        title: String,
    ) -> PyResult<Self> {
        let positions = numbers::vectors("positions", positions, None)?;
        let points = positions.len();
        let springs = numbers::index_rows::<2>("springs", springs)?;
        let for_springs = |field: &str, given| numbers::for_each(field, given, springs.len());
        let arrays = Arrays {
            mass: numbers::for_each("mass", mass, points)?,
            stiffness: for_springs("stiffness", stiffness)?,
            damping: for_springs("damping", damping)?,
            rest_lengths: rest_lengths.map(|given| for_springs("rest_lengths", given)).transpose()?,
            velocities: velocities
                .map(|given| numbers::vectors("velocities", given, Some(points)))
                .transpose()?,
            pinned: pinned
                .map(|given| numbers::selection("pinned", given, points))
                .transpose()?
                .unwrap_or_default(),
            triangles: triangles
                .map(|given| numbers::index_rows::<3>("triangles", given))
                .transpose()?
                .unwrap_or_default(),
            bodies,
            positions,
            springs,
        };
        let (model, params, state) = py.detach(|| arrays.build()).map_err(raised)?;
        Ok(Self { model: Arc::new(model), params, state, title })
    }

    /// How many points there are.
    ///
    /// >>> import sprung
    /// >>> sprung.Model([[0, 0, 0], [1, 0, 0]], 1).point_count
    /// 2
    #[getter]
    fn point_count(&self) -> usize {
        self.model.point_count()
    }

    /// How many springs there are.
    ///
    /// >>> import sprung
    /// >>> sprung.Model([[0, 0, 0], [1, 0, 0]], 1, [[0, 1]], stiffness=5).spring_count
    /// 1
    #[getter]
    fn spring_count(&self) -> usize {
        self.model.spring_count()
    }
}

struct Arrays {
    positions: Vec<Vec3>,
    mass: Vec<f32>,
    springs: Vec<[usize; 2]>,
    stiffness: Vec<f32>,
    damping: Vec<f32>,
    rest_lengths: Option<Vec<f32>>,
    velocities: Option<Vec<Vec3>>,
    pinned: Vec<usize>,
    triangles: Vec<[usize; 3]>,
    bodies: Vec<(String, usize)>,
}

impl Arrays {
    fn build(self) -> Result<(sprung::Model, Params, State)> {
        let points = self.positions.len();
        let together: usize = self.bodies.iter().map(|(_, count)| count).sum();
        if together != points {
            let sentence = format!("have {together} points together, and there are {points}");
            return Err(Error::new(Code::Conflict, sentence).at_field("bodies"));
        }
        sprung_cli::memory::check(estimated_bytes(points as u64, self.springs.len() as u64), "the model")?;
        let mut builder = ModelBuilder::new();
        builder.allow_springs(self.springs.len());
        builder.reserve(points, self.springs.len());
        let mut next = 0;
        for (name, count) in &self.bodies {
            builder.begin_body(name).map_err(|error| error.at_field("bodies"))?;
            let first = builder.point_count();
            for point in first..first + count {
                let added = builder.add_point(self.positions[point], self.mass[point]);
                added.map_err(|error| error.within(format!("points[{point}]")))?;
            }
            let body = first..first + count;
            while next < self.springs.len() && self.springs[next].iter().all(|end| body.contains(end)) {
                self.add_spring(&mut builder, next)?;
                next += 1;
            }
            self.add_surface(&mut builder, &body)?;
        }
        // What joins bodies comes after them.
        if next < self.springs.len() {
            builder.begin_joint("joint");
            (next..self.springs.len()).try_for_each(|spring| self.add_spring(&mut builder, spring))?;
        }
        for &point in &self.pinned {
            builder.pin(point).map_err(|error| error.at_field("pinned"))?;
        }
        for (point, &velocity) in self.velocities.iter().flatten().enumerate() {
            let set = builder.set_velocity(point, velocity);
            set.map_err(|error| error.within(format!("velocities[{point}]")))?;
        }
        builder.build()
    }

    fn add_spring(&self, builder: &mut ModelBuilder, index: usize) -> Result<()> {
        let [a, b] = self.springs[index];
        let material = Material { stiffness: self.stiffness[index], damping: self.damping[index] };
        let mut add = || {
            let spring = builder.add_spring(a, b, material)?;
            self.rest_lengths
                .as_ref()
                .map_or(Ok(()), |lengths| builder.set_rest_length(spring, lengths[index]))
        };
        add().map_err(|error| error.within(format!("springs[{index}]")))
    }

    /// The triangles whose first corner is one of the body's points: a skin if they are closed, cloth if not.
    fn add_surface(&self, builder: &mut ModelBuilder, body: &std::ops::Range<usize>) -> Result<()> {
        let own = self.triangles.iter().enumerate().filter(|(_, corners)| body.contains(&corners[0]));
        let mut triangles = Vec::new();
        for (index, corners) in own {
            if let Some(other) = corners.iter().find(|corner| !body.contains(corner)) {
                let sentence = format!("has corner {other}, which is not in the body of its first corner");
                let code = if *other < self.positions.len() { Code::Conflict } else { Code::NotFound };
                return Err(Error::new(code, sentence).at_field(format!("triangles[{index}]")));
            }
            triangles.push(corners.map(|corner| corner as u32));
        }
        if triangles.is_empty() {
            return Ok(());
        }
        let kind = if is_closed(&triangles) { SurfaceKind::Skin } else { SurfaceKind::Cloth };
        builder.add_surface(kind, triangles).map_err(|error| error.at_field("triangles"))
    }
}

/// Whether every side belongs to two triangles.
fn is_closed(triangles: &[[u32; 3]]) -> bool {
    let mut sides: HashMap<[u32; 2], u32> = HashMap::new();
    for &[a, b, c] in triangles {
        for [i, j] in [[a, b], [b, c], [c, a]] {
            *sides.entry([i.min(j), i.max(j)]).or_default() += 1;
        }
    }
    sides.values().all(|&count| count == 2)
}

type Positions<'py> = Bound<'py, PyArray2<f64>>;
type Pairs<'py> = Bound<'py, PyArray2<u32>>;
/// Positions, the three kinds of springs, triangles, and the names of sides.
type Shape<'py> = (Positions<'py>, [Pairs<'py>; 3], Pairs<'py>, Vec<String>);

fn table<'py, T: numpy::Element + Copy, const N: usize>(
    py: Python<'py>,
    rows: Vec<[T; N]>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let count = rows.len();
    rows.into_flattened().into_pyarray(py).reshape([count, N])
}

/// Positions (m), structural, shear and bend springs, and triangles of a lattice.
#[pyfunction]
pub fn lattice<'py>(
    py: Python<'py>,
    counts: [i64; 3],
    spacing: f64,
    origin: &Bound<'py, PyAny>,
) -> PyResult<Shape<'py>> {
    let origin = DVec3::from_array(numbers::vector("origin", origin)?);
    let lattice = checked(counts, spacing).map_err(raised)?;
    parts(py, &lattice, origin)
}

/// The points of a side of a lattice, such as "top" or "left-back".
#[pyfunction]
pub fn lattice_side<'py>(
    py: Python<'py>,
    counts: [i64; 3],
    name: &str,
) -> PyResult<Bound<'py, PyArray1<u32>>> {
    let lattice = checked(counts, 1.0).map_err(raised)?;
    let Some(side) = lattice.side(name) else {
        let sentence = format!("there is no side \"{name}\"; there are {}", lattice.side_names().join(", "));
        return Err(raised(Error::new(Code::NotFound, sentence).at_field("side")));
    };
    Ok(lattice.side_points(side).collect::<Vec<u32>>().into_pyarray(py))
}

/// The same of points in a row.
#[pyfunction]
pub fn chain<'py>(
    py: Python<'py>,
    points: i64,
    step: &Bound<'py, PyAny>,
    origin: &Bound<'py, PyAny>,
) -> PyResult<Shape<'py>> {
    let step = DVec3::from_array(numbers::vector("step", step)?);
    let origin = DVec3::from_array(numbers::vector("origin", origin)?);
    if !(step.is_finite() && step != DVec3::ZERO) {
        let sentence = format!("is {step}, and must be finite and not zero");
        return Err(raised(Error::new(Code::OutOfRange, sentence).at_field("step")));
    }
    let points = count("points", points).map_err(raised)?;
    parts(py, &Lattice::chain(points, step), origin)
}

fn parts<'py>(py: Python<'py>, lattice: &Lattice, origin: DVec3) -> PyResult<Shape<'py>> {
    let positions = table(py, lattice.positions().map(|place| (origin + place).to_array()).collect())?;
    let pairs = |kind| table(py, lattice.pairs(kind).collect());
    let kinds = [pairs(SpringKind::Structural)?, pairs(SpringKind::Shear)?, pairs(SpringKind::Bend)?];
    let triangles = lattice.surface().map(|(_, triangles)| triangles).unwrap_or_default();
    Ok((positions, kinds, table(py, triangles)?, lattice.side_names()))
}

fn checked(counts: [i64; 3], spacing: f64) -> Result<Lattice> {
    if !(spacing > 0.0 && spacing.is_finite()) {
        let sentence = format!("is {spacing}, and must be a finite number above 0 m");
        return Err(Error::new(Code::OutOfRange, sentence).at_field("spacing"));
    }
    let mut whole = [0; 3];
    for (whole, given) in whole.iter_mut().zip(counts) {
        *whole = count("points", given)?;
    }
    let lattice = Lattice::new(whole, spacing);
    if lattice.point_count() > MAX_POINTS {
        let sentence =
            format!("makes {} points, and there may be at most {MAX_POINTS}", lattice.point_count());
        return Err(Error::new(Code::TooLarge, sentence).at_field("points"));
    }
    // Positions, and up to 13 + 3 springs for each.
    sprung_cli::memory::check(lattice.point_count() * 200, "the lattice")?;
    Ok(lattice)
}

fn count(field: &str, given: i64) -> Result<u32> {
    u32::try_from(given).ok().filter(|&count| count > 0 && u64::from(count) <= MAX_POINTS).ok_or_else(|| {
        let sentence = format!("is {given}, and must be from 1 to {MAX_POINTS}");
        Error::new(Code::OutOfRange, sentence).at_field(field)
    })
}

/// All pairs of points that are no further apart than `radius` (m).
#[pyfunction]
pub fn connect_within<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    radius: f64,
    most: usize,
) -> PyResult<Pairs<'py>> {
    let positions = numbers::vectors("positions", positions, None)?;
    let pairs = py.detach(|| pairs_within(&positions, radius as f32, most)).map_err(raised)?;
    table(py, pairs.ok_or_else(|| too_many(most))?)
}

/// All pairs of a point of `a` and one of `b` that are no further apart than `radius` (m), by their index in each.
#[pyfunction]
pub fn connect_between<'py>(
    py: Python<'py>,
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    radius: f64,
    most: usize,
) -> PyResult<Pairs<'py>> {
    let (a, b) = (numbers::vectors("a", a, None)?, numbers::vectors("b", b, None)?);
    let pairs = py.detach(|| pairs_between(&a, &b, radius as f32, most)).map_err(raised)?;
    table(py, pairs.ok_or_else(|| too_many(most))?)
}

fn too_many(most: usize) -> PyErr {
    let error = Error::new(Code::TooLarge, format!("makes more than {most} springs")).at_field("radius");
    raised(error.with_fix("use a smaller radius, or allow more with max_springs"))
}
