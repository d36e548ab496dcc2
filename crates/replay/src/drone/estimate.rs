use super::Cloud;

/// Where the user is after a measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Which measurement, counted from 0.
    pub stop: usize,
    /// As x and y of the measurements, m.
    pub place: [f64; 2],
    /// Root mean square distance that the filter expects, m.
    pub sd_m: f64,
    /// The transmitter's level, if it is estimated, dB.
    pub level_db: Option<f64>,
    /// By how much all losses are larger than those that the environment's channel expects, where that is estimated, dB.
    pub off_db: f64,
    /// Whether the 90 % region holds the true place, if that is known.
    pub covered: Option<bool>,
    /// Where one more measurement is expected to tell most, of the last estimate over open ground.
    pub next: Option<Next>,
    /// All that is believed of the place, if that is wanted.
    pub cloud: Option<Cloud>,
}

/// Where to measure next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Next {
    /// As x and y of the measurements, m.
    pub place: [f64; 2],
    /// Height above the user, m.
    pub height: f64,
    /// The deviation that is expected after one measurement there, m.
    pub sd_m: f64,
}

impl Estimate {
    /// The mean of all that is believed.
    pub fn of_cloud(stop: usize, cloud: Cloud) -> Self {
        let (place, sd_m) = (cloud.mean, cloud.spread());
        Self {
            stop,
            place,
            sd_m,
            level_db: None,
            off_db: 0.0,
            covered: None,
            next: None,
            cloud: Some(cloud),
        }
    }

    /// Effective number of particles or points, if it is known.
    pub fn effective(&self) -> Option<f64> {
        self.cloud.as_ref().map(|cloud| cloud.effective)
    }
}
