//! Constants of the trackers.

use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::Huber;
use kestirim_uwb_tracker::Config;

/// The constants of a tracker that can be changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tuning {
    /// Initial standard deviation of a range, m.
    pub range_sigma_m: f64,
    /// Power spectral density of the acceleration, m²/s³.
    pub acceleration_density: f64,
    /// The number of standard deviations beyond which a range is rejected; `None` rejects none.
    pub gate_sigmas: Option<f64>,
    /// The numbers of standard deviations beyond which a range that is too long, or too short, has less weight; `None`
    /// for full weight always.
    pub huber_sigmas: Option<[f64; 2]>,
    /// Time constant with which a velocity decays, s; `None` for no decay.
    pub decay_time_s: Option<f64>,
    /// Whether each anchor's variance is learnt.
    pub learns: bool,
}

impl Default for Tuning {
    /// The constants of the default tracker.
    fn default() -> Self {
        let config = Config::<f64>::uncalibrated(0.0);
        Self {
            range_sigma_m: config.range_sigma,
            acceleration_density: config.acceleration_density,
            gate_sigmas: config.gate.map(f64::sqrt),
            huber_sigmas: config.huber.map(|huber| [huber.long, huber.short]),
            decay_time_s: config.decay_time,
            learns: config.learning.is_some(),
        }
    }
}

impl Tuning {
    /// Sets the noises, which every Kalman filter has.
    pub fn of_any<T: Scalar>(&self, config: Config<T>) -> Config<T> {
        Config {
            range_sigma: T::from_f64(self.range_sigma_m),
            acceleration_density: T::from_f64(self.acceleration_density),
            ..config
        }
    }

    /// Sets the noises and the constants that make a filter robust.
    pub fn of_the_robust<T: Scalar>(&self, config: Config<T>) -> Config<T> {
        let huber = self.huber_sigmas.map(|sigmas| sigmas.map(T::from_f64));
        Config {
            gate: self.gate_sigmas.map(|sigmas| T::from_f64(sigmas * sigmas)),
            huber: huber.map(|[long, short]| Huber { long, short }),
            decay_time: self.decay_time_s.map(T::from_f64),
            learning: config.learning.filter(|_| self.learns),
            ..self.of_any(config)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_turned_changes_nothing() {
        for config in [Config::<f32>::uncalibrated(1.0), Config::calibrated(1.0)] {
            assert_eq!(Tuning::default().of_the_robust(config), config);
        }
        let plain = Config::<f32>::plain(1.0);
        assert_eq!(Tuning::default().of_any(plain), plain);
    }
}
