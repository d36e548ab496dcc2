/// An output y = C x + D u that is measured, in deviations from what it shows in the steady flight.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Output {
    /// Its row of C: what a rad of α, a rad/s of q, a m/s of V and a rad of θ add to it.
    pub row: [f64; 4],
    /// Its row of D: what a rad of δe and full δt add at once.
    pub direct: [f64; 2],
    /// Standard deviation of its noise, in its unit.
    pub sigma: f64,
    /// What it refers to.
    pub reference: Reference,
}

impl Output {
    /// The state of this index by itself: α, q, V, θ.
    pub fn state(index: usize, sigma: f64) -> Self {
        let row = core::array::from_fn(|state| f64::from(u8::from(state == index)));
        Self { row, direct: [0.0; 2], sigma, reference: Reference::Air }
    }
}

/// What an output refers to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Reference {
    /// The air about the aircraft: what a vane, a Pitot tube, a gyroscope measure.
    Air,
    /// The ground: gusts are no part of it, and a head wind is taken from it. A ground speed, a rate of climb.
    Ground,
    /// The air, in proportion to the dynamic pressure: a specific force. With V₀ the airspeed and y₀ the value of the
    /// steady flight, y₀ + y = (V/V₀)² (y₀ + C x + D u − 2 y₀ (V − V₀)/V₀), which is y = C x + D u for small V − V₀.
    Pressure {
        /// y₀, in the output's unit.
        steady: f64,
        /// V₀, m/s.
        airspeed: f64,
    },
}
