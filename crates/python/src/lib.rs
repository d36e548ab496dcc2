//! `kestirim._kestirim`: the functions that Python calls. It feeds the systems' crates and the building blocks from
//! `NumPy` arrays and contains no estimator itself; the package around it, `python/kestirim`, checks shapes.
//!
//! Every function reads its arrays in place, lets other Python threads run while it computes, and returns its results
//! without a copy.
#![allow(
    unsafe_code,
    reason = "PyO3's macros write the functions that the interpreter calls; none is written by hand"
)]

mod arrays;
mod blocks;
mod drone;
mod error;
mod gnss;
mod logs;
mod pedestrian;
mod robot;
mod stack;
mod uav;

use pyo3::prelude::*;

/// The Python module `kestirim._kestirim`.
#[pymodule]
mod _kestirim {
    use super::{Bound, PyModule, PyModuleMethods, PyResult};

    #[pymodule_export]
    use super::blocks::attitude::attitude;
    #[pymodule_export]
    use super::blocks::design::{c2d, dare, place};
    #[pymodule_export]
    use super::blocks::filters::Filter;
    #[pymodule_export]
    use super::blocks::observer::Observer;
    #[pymodule_export]
    use super::blocks::particles::Cloud;
    #[pymodule_export]
    use super::drone::drone;
    #[pymodule_export]
    use super::error::KestirimError;
    #[pymodule_export]
    use super::gnss::gnss;
    #[pymodule_export]
    use super::logs::read_imu;
    #[pymodule_export]
    use super::pedestrian::pedestrian;
    #[pymodule_export]
    use super::robot::robot;
    #[pymodule_export]
    use super::uav::{uav, uav_model};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
