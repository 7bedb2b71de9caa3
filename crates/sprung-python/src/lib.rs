//! The engine for Python: scenes, models, simulations and recorded frames as the package `sprung` wraps them.
//!
//! What users see, with its documentation, is in the folder `python/sprung`; here are plain values, NumPy's arrays and
//! sentences. Threads of Python go on while the engine steps.

mod errors;
mod frames;
mod model;
mod numbers;
mod parameters;
mod saving;
mod scene;
mod simulation;
mod tell;
mod threads;
mod views;

use pyo3::prelude::*;

/// Runs the command with these arguments, the program's name first, and gives its exit status.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| sprung_cli::main_with(arguments))
}

/// The package's compiled part.
#[pymodule]
fn _engine(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("EXPORTERS", tell::exporters())?;
    module.add("BUILTIN", scene::builtin())?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<model::Model>()?;
    module.add_class::<simulation::Simulation>()?;
    module.add_class::<frames::Recorder>()?;
    module.add_class::<frames::Frames>()?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(scene::toml_of, module)?)?;
    module.add_function(wrap_pyfunction!(saving::read_checkpoint, module)?)?;
    module.add_function(wrap_pyfunction!(model::lattice, module)?)?;
    module.add_function(wrap_pyfunction!(model::lattice_side, module)?)?;
    module.add_function(wrap_pyfunction!(model::chain, module)?)?;
    module.add_function(wrap_pyfunction!(model::connect_within, module)?)?;
    module.add_function(wrap_pyfunction!(model::connect_between, module)?)?;
    module.add_function(wrap_pyfunction!(threads::after_fork, module)?)
}
