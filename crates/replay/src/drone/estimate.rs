use super::Cloud;

/// The estimated place of the user after a measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// The index of the newest measurement, from 0.
    pub stop: usize,
    /// The index of the oldest one that it was made from.
    pub first: usize,
    /// The place, in the coordinates of the measurements, m.
    pub place: [f64; 2],
    /// The root mean square error that the filter expects, m.
    pub sd_m: f64,
    /// The transmitter's level, if it is estimated, dB.
    pub level_db: Option<f64>,
    /// How much larger all losses are than those that the environment's channel predicts, if that is estimated, dB.
    pub off_db: f64,
    /// Whether the 90 % region holds the true place, if that is known.
    pub covered: Option<bool>,
    /// The place where one more measurement is expected to be most informative, for the last estimate over open ground.
    pub next: Option<Next>,
    /// The whole distribution of the place, if that was requested.
    pub cloud: Option<Cloud>,
}

/// A proposal where to measure next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Next {
    /// The place, in the coordinates of the measurements, m.
    pub place: [f64; 2],
    /// Height above the user, m.
    pub height: f64,
    /// The standard deviation that is expected after one measurement there, m.
    pub sd_m: f64,
}

impl Estimate {
    /// The estimate given by the mean of a cloud.
    pub fn of_cloud(stop: usize, cloud: Cloud) -> Self {
        let (place, sd_m) = (cloud.mean, cloud.spread());
        Self {
            stop,
            first: 0,
            place,
            sd_m,
            level_db: None,
            off_db: 0.0,
            covered: None,
            next: None,
            cloud: Some(cloud),
        }
    }

    /// The effective number of particles or points, if it is known.
    pub fn effective(&self) -> Option<f64> {
        self.cloud.as_ref().map(|cloud| cloud.effective)
    }
}
