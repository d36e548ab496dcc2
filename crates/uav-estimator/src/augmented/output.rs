/// A measured output y = C x + D u, as a deviation from its value in the steady flight.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Output {
    /// Row of C: the contributions per rad of α, rad/s of q, m/s of V and rad of θ.
    pub row: [f64; 4],
    /// Row of D: the direct contributions per rad of δe and of full δt.
    pub direct: [f64; 2],
    /// Standard deviation of its noise, in its unit.
    pub sigma: f64,
    /// Frame or quantity to which the output is relative.
    pub reference: Reference,
}

impl Output {
    /// An output that equals the state of this index: α, q, V, θ.
    pub fn state(index: usize, sigma: f64) -> Self {
        let row = core::array::from_fn(|state| f64::from(u8::from(state == index)));
        Self { row, direct: [0.0; 2], sigma, reference: Reference::Air }
    }
}

/// What an output is relative to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Reference {
    /// The surrounding air, as for a vane, a pitot tube or a gyroscope.
    Air,
    /// The ground, as for a ground speed or a rate of climb: gusts are not part of it, and a head wind is subtracted.
    Ground,
    /// The air, and proportional to the dynamic pressure, as for a specific force. With the airspeed V₀ and the value
    /// y₀ in the steady flight, y₀ + y = (V/V₀)² (y₀ + C x + D u − 2 y₀ (V − V₀)/V₀), which is y = C x + D u for
    /// small V − V₀.
    Pressure {
        /// The value y₀ in the steady flight, in the output's unit.
        steady: f64,
        /// The airspeed V₀ of the steady flight, m/s.
        airspeed: f64,
    },
}
