//! The parameters to be estimated, and their priors for any aircraft.

use crate::flight::Reference;
use crate::structure::GRAVITY;

/// Names of the states: angle of attack, pitch rate, airspeed, pitch angle.
pub const STATES: [&str; 4] = ["alpha", "q", "V", "theta"];

/// Number of parameters.
pub(crate) const COUNT: usize = 20;

/// Names and units of the parameters.
pub(crate) const PARAMETERS: [(&str, &str); COUNT] = [
    ("Z_alpha", "1/s"),
    ("Z_q", "1"),
    ("Z_V", "rad/m"),
    ("Z_delta_e", "1/s"),
    ("Z_delta_t", "rad/s"),
    ("M_alpha", "1/s²"),
    ("M_q", "1/s"),
    ("M_V", "rad/(m s)"),
    ("M_delta_e", "1/s²"),
    ("M_delta_t", "rad/s²"),
    ("X_alpha", "m/s²"),
    ("X_V", "1/s"),
    ("X_delta_e", "m/s²"),
    ("X_delta_t", "m/s²"),
    ("accelerometer_x", "m"),
    ("accelerometer_z", "m"),
    ("vane_lead", "s"),
    ("vane_scale", "1"),
    ("gyro_scale", "1"),
    ("delay", "s"),
];

/// Indices into [`PARAMETERS`].
pub(crate) mod at {
    pub(crate) const Z_ALPHA: usize = 0;
    pub(crate) const Z_RATE: usize = 1;
    pub(crate) const Z_SPEED: usize = 2;
    pub(crate) const Z_ELEVATOR: usize = 3;
    pub(crate) const Z_THROTTLE: usize = 4;
    pub(crate) const M_ALPHA: usize = 5;
    pub(crate) const M_RATE: usize = 6;
    pub(crate) const M_SPEED: usize = 7;
    pub(crate) const M_ELEVATOR: usize = 8;
    pub(crate) const M_THROTTLE: usize = 9;
    pub(crate) const X_ALPHA: usize = 10;
    pub(crate) const X_SPEED: usize = 11;
    pub(crate) const X_ELEVATOR: usize = 12;
    pub(crate) const X_THROTTLE: usize = 13;
    pub(crate) const ACCELEROMETER_X: usize = 14;
    pub(crate) const ACCELEROMETER_Z: usize = 15;
    pub(crate) const VANE_LEAD: usize = 16;
    pub(crate) const VANE_SCALE: usize = 17;
    pub(crate) const GYRO_SCALE: usize = 18;
    pub(crate) const DELAY: usize = 19;
}

/// The prior of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Prior {
    pub(crate) mean: f64,
    pub(crate) sigma: f64,
    /// The reason why nothing in the log determines it, so that it stays at its mean.
    pub(crate) fixed: Option<&'static str>,
}

/// Priors for any aircraft that flies at this speed: the lift carries the weight, so that forces are some g, and lift
/// and drag grow with V². Moments may be those of a glider or of a dart.
pub(crate) fn priors(reference: &Reference) -> [Prior; COUNT] {
    let airspeed = reference.state[2];
    let turn = GRAVITY / airspeed;
    let [has_alpha, _, _, _, has_az, has_ax] = reference.has;
    let still = (!reference.throttle_moves).then_some("the throttle does not move");
    let no_az = (!has_az).then_some("no az is logged");
    let no_ax = (!has_ax).then_some("no ax is logged");
    let no_vane = (!(has_az && has_alpha)).then_some("it takes both alpha and az");
    let no_pitch = (!reference.has[3]).then_some("no theta is logged");
    let free = |mean: f64, sigma: f64| Prior { mean, sigma, fixed: None };
    let of = |mean: f64, sigma: f64, fixed| Prior { mean, sigma, fixed };
    [
        free(-10.0 * turn, 20.0 * turn),
        free(0.0, 0.03),
        free(-2.0 * turn / airspeed, turn / airspeed),
        free(0.0, 5.0 * turn),
        of(0.0, turn, still),
        free(-10.0, 100.0),
        free(-2.0, 20.0),
        free(0.0, 20.0 / airspeed),
        free(0.0, 100.0),
        of(0.0, 10.0, still),
        free(0.5 * GRAVITY, GRAVITY),
        free(-0.2 * turn, turn),
        free(0.0, 0.5 * GRAVITY),
        of(0.0, GRAVITY, still),
        of(0.0, 0.5, no_az),
        of(0.0, 0.5, no_ax),
        of(0.0, 0.1, no_vane),
        of(1.0, 0.03, no_vane),
        of(1.0, 0.03, no_pitch),
        free(0.0, 0.05),
    ]
}
