//! The engine's errors as exceptions, with the same sentence and all its parts.

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sprung::{BlowUp, Cause, Code, Error};

/// The exception that an error becomes: one of the classes in `sprung.errors`.
pub fn raised(error: Error) -> PyErr {
    if error.code() == Code::Interrupted {
        return PyKeyboardInterrupt::new_err(());
    }
    Python::attach(|py| exception(py, &error).map_or_else(|failure| failure, PyErr::from_value))
}

fn exception<'py>(py: Python<'py>, error: &Error) -> PyResult<Bound<'py, PyAny>> {
    let place = error.place();
    let (line, column) = place.line_column.unzip();
    let parts = PyDict::new(py);
    parts.set_item("code", snake_case(&format!("{:?}", error.code())))?;
    parts.set_item("sentence", error.sentence())?;
    parts.set_item("file", &place.file)?;
    parts.set_item("line", line)?;
    parts.set_item("column", column)?;
    parts.set_item("field", &place.field)?;
    parts.set_item("fix", error.fix())?;
    let class = match error.blow_up() {
        Some(blow_up) => {
            add_blow_up(&parts, blow_up)?;
            "BlowUp"
        }
        None => "Error",
    };
    py.import("sprung.errors")?.getattr(class)?.call((error.to_string(),), Some(&parts))
}

fn add_blow_up(parts: &Bound<'_, PyDict>, blow_up: &BlowUp) -> PyResult<()> {
    let (cause, excess) = match blow_up.cause {
        Cause::NotFinite => ("not_finite", None),
        Cause::EnergyFromNowhere { excess } => ("energy_from_nowhere", Some(excess)),
    };
    parts.set_item("cause", cause)?;
    parts.set_item("excess", excess)?;
    parts.set_item("step", blow_up.step)?;
    parts.set_item("time", blow_up.time)?;
    parts.set_item("good_step", blow_up.good_step)?;
    parts.set_item("good_time", blow_up.good_time)?;
    parts.set_item("spring", blow_up.spring)?;
    parts.set_item("points", &blow_up.points)?;
    parts.set_item("place", &blow_up.place)?;
    parts.set_item("dt", blow_up.dt)?;
    parts.set_item("certified_limit", blow_up.dt_limit_certified)?;
    parts.set_item("every_configuration_limit", blow_up.dt_limit_every_configuration)?;
    parts.set_item("suggested_dt", blow_up.suggested_dt())?;
    parts.set_item("suggested_damping_scale", blow_up.suggested_damping_scale())
}

/// `OutOfRange` as `out_of_range`.
fn snake_case(name: &str) -> String {
    let mut snake = String::new();
    for (index, letter) in name.char_indices() {
        if letter.is_uppercase() && index > 0 {
            snake.push('_');
        }
        snake.extend(letter.to_lowercase());
    }
    snake
}
