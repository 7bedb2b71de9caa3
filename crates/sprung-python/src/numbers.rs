//! Numbers from Python: whatever NumPy makes an array of, looked over before it is taken.

use numpy::{Element, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sprung::{Code, Error, Vec3};

use crate::errors::raised;

/// Which numbers are wanted.
#[derive(Clone, Copy)]
struct Wanted {
    /// What NumPy calls them.
    dtype: &'static str,
    /// The kinds of NumPy's types that are taken for them.
    kinds: &'static str,
    /// What a person calls them.
    name: &'static str,
}

const REAL: Wanted = Wanted { dtype: "float64", kinds: "buif", name: "real numbers" };
const WHOLE: Wanted = Wanted { dtype: "int64", kinds: "bui", name: "whole numbers" };
const FLAGS: Wanted = Wanted { dtype: "bool", kinds: "b", name: "True and False" };

/// Values in C order, and the shape they came in.
struct Values<T> {
    values: Vec<T>,
    shape: Vec<usize>,
}

fn values<T: Element + Copy>(field: &str, given: &Bound<'_, PyAny>, wanted: Wanted) -> PyResult<Values<T>> {
    let py = given.py();
    let wrong = |found: String| {
        raised(Error::new(Code::WrongType, format!("{found}, and must be {}", wanted.name)).at_field(field))
    };
    let numpy = py.import("numpy")?;
    let array = match numpy.call_method1("asarray", (given,)) {
        Ok(array) => array,
        // A list of lists of different lengths, for instance.
        Err(error) if error.is_instance_of::<pyo3::exceptions::PyValueError>(py) => {
            return Err(wrong("is no array".to_owned()));
        }
        Err(error) => return Err(error),
    };
    let dtype = array.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    // An empty list is float64 to NumPy.
    let is_empty = array.getattr("size")?.extract::<usize>()? == 0;
    if !wanted.kinds.contains(&kind) && !is_empty {
        return Err(wrong(format!("holds {dtype}")));
    }
    let options = PyDict::new(py);
    options.set_item("dtype", wanted.dtype)?;
    let array = numpy.call_method("ascontiguousarray", (&array,), Some(&options))?;
    let array = array.cast_into::<PyArrayDyn<T>>()?;
    let readable = array.try_readonly().map_err(|_| wrong("is being written to".to_owned()))?;
    // What NumPy makes contiguous has at least one axis, of which a single number has had none.
    let shape = if given_is_scalar(given)? { Vec::new() } else { array.shape().to_vec() };
    Ok(Values { values: readable.as_slice()?.to_vec(), shape })
}

fn given_is_scalar(given: &Bound<'_, PyAny>) -> PyResult<bool> {
    given.py().import("numpy")?.call_method1("ndim", (given,))?.extract::<usize>().map(|axes| axes == 0)
}

fn shape_error(field: &str, shape: &[usize], allowed: &str) -> PyErr {
    let found = match shape {
        [] => "is a single number".to_owned(),
        [count] => format!("has shape ({count},)"),
        _ => format!("has shape ({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    };
    raised(Error::new(Code::Conflict, format!("{found}, and must have shape {allowed}")).at_field(field))
}

/// A vector.
pub fn vector(field: &str, given: &Bound<'_, PyAny>) -> PyResult<[f64; 3]> {
    let Values { values, shape } = values::<f64>(field, given, REAL)?;
    <[f64; 3]>::try_from(values)
        .ok()
        .filter(|_| shape.len() == 1)
        .ok_or_else(|| shape_error(field, &shape, "(3,)"))
}

/// The same as the engine keeps it.
pub fn vec3(field: &str, given: &Bound<'_, PyAny>) -> PyResult<Vec3> {
    vector(field, given).map(|[x, y, z]| Vec3::new(x as f32, y as f32, z as f32))
}

/// Any number of vectors, or so many.
pub fn vectors(field: &str, given: &Bound<'_, PyAny>, count: Option<usize>) -> PyResult<Vec<Vec3>> {
    let Values { values, shape } = values::<f64>(field, given, REAL)?;
    let fits = match (&shape[..], count) {
        // An empty list has no second axis.
        ([0], None) => true,
        ([_, 3], None) => true,
        ([found, 3], Some(count)) => *found == count,
        _ => false,
    };
    if !fits {
        let allowed = count.map_or("(n, 3)".to_owned(), |count| format!("({count}, 3)"));
        return Err(shape_error(field, &shape, &allowed));
    }
    let to_vec3 = |[x, y, z]: &[f64; 3]| Vec3::new(*x as f32, *y as f32, *z as f32);
    Ok(values.as_chunks::<3>().0.iter().map(to_vec3).collect())
}

/// One number for all, or one for each of so many.
pub fn for_each(field: &str, given: &Bound<'_, PyAny>, count: usize) -> PyResult<Vec<f32>> {
    each(field, values::<f64>(field, given, REAL)?, count, |number| number as f32)
}

/// True or false for all, or for each of so many.
pub fn flags(field: &str, given: &Bound<'_, PyAny>, count: usize) -> PyResult<Vec<bool>> {
    each(field, values::<bool>(field, given, FLAGS)?, count, |flag| flag)
}

fn each<T: Copy, U: Clone>(
    field: &str,
    Values { values, shape }: Values<T>,
    count: usize,
    convert: impl Fn(T) -> U,
) -> PyResult<Vec<U>> {
    match shape[..] {
        [] => Ok(vec![convert(values[0]); count]),
        [found] if found == count => Ok(values.into_iter().map(convert).collect()),
        _ => Err(shape_error(field, &shape, &format!("({count},), or be a single number"))),
    }
}

/// Rows of so many indices.
pub fn index_rows<const N: usize>(field: &str, given: &Bound<'_, PyAny>) -> PyResult<Vec<[usize; N]>> {
    let Values { values, shape } = values::<i64>(field, given, WHOLE)?;
    match shape[..] {
        [0] => Ok(Vec::new()),
        [_, columns] if columns == N => {
            let indices = whole(field, values)?;
            Ok(indices.as_chunks::<N>().0.to_vec())
        }
        _ => Err(shape_error(field, &shape, &format!("(n, {N})"))),
    }
}

/// Indices, or flags for each of so many, as NumPy selects with either.
pub fn selection(field: &str, given: &Bound<'_, PyAny>, count: usize) -> PyResult<Vec<usize>> {
    if let Ok(mask) = values::<bool>(field, given, FLAGS)
        && !mask.values.is_empty()
    {
        let mask = each(field, mask, count, |flag| flag)?;
        return Ok(mask.iter().enumerate().filter(|(_, chosen)| **chosen).map(|(index, _)| index).collect());
    }
    let Values { values, shape } = values::<i64>(field, given, WHOLE)?;
    match shape.len() {
        0 | 1 => whole(field, values),
        _ => Err(shape_error(field, &shape, "(n,)")),
    }
}

/// An index of one of so many points.
pub fn point(field: &str, given: i64, count: usize) -> PyResult<usize> {
    usize::try_from(given).ok().filter(|&point| point < count).ok_or_else(|| {
        let sentence = format!("there is no point {given}; points are 0 to {}", count - 1);
        raised(Error::new(Code::NotFound, sentence).at_field(field))
    })
}

/// Indices count from 0.
fn whole(field: &str, values: Vec<i64>) -> PyResult<Vec<usize>> {
    let to_index = |value: i64| {
        usize::try_from(value).map_err(|_| {
            let sentence = format!("holds {value}, and indices count from 0");
            raised(Error::new(Code::OutOfRange, sentence).at_field(field))
        })
    };
    values.into_iter().map(to_index).collect()
}
