//! Tests across crates, one module a subject, in one binary: linking `host-sim` thirty times took longer than most
//! of them. `cargo test -p kestirim-tests --test all robot_table::` runs the tests of one.

mod any_input;
mod apps_on_target;
mod common_scenario;
mod drone_figures;
mod drone_on_target;
mod drone_recordings;
mod drone_thesis;
mod faults;
mod firmware;
mod functions_on_target;
mod gnss_figures;
mod gnss_files;
mod gnss_recordings;
mod panic_free;
mod pedestrian_on_target;
mod pedestrian_recordings;
mod pedestrian_table;
mod ppp_on_target;
mod python;
mod robot_on_target;
mod robot_recordings;
mod robot_robust;
mod robot_sigmas;
mod robot_table;
mod snapshots;
mod surface_is_complete;
mod target_costs;
mod uav_design_cases;
mod uav_design_on_target;
mod uav_experiment;
mod uav_figures;
mod uav_misprints;
mod uav_observers;
mod uav_observers_scalars;
mod uav_on_target;
