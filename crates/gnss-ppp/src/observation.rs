//! The ionosphere-free observation model of a satellite.

use crate::constants::SPEED_OF_LIGHT;
use crate::{
    BodyAxes, Carriers, Constellation, Correction, Direction, Pattern, Site, eccentricity_clock,
    sagnac, shapiro_delay, wind_up,
};
use nalgebra::Vector3;

/// The state of a satellite at the time of transmission.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SatelliteState {
    /// The centre of mass, ECEF at the time of transmission, m; with broadcast ephemerides the antenna's phase centre.
    pub position: Vector3<f64>,
    /// The velocity, m/s, inertial or relative to the Earth.
    pub velocity: Vector3<f64>,
    /// Satellite clock minus GPS time, s, without the relativistic effect of the orbit's eccentricity.
    pub clock: f64,
    /// The time between the neighbouring samples of the clock, s (zero: not interpolated).
    pub clock_interval: f64,
    /// The time to the nearer neighbouring sample of the clock, s.
    pub clock_distance: f64,
    /// The standard deviation of a range due to orbit and clock, m: the accuracy in a broadcast ephemeris, zero for
    /// precise products.
    pub accuracy: f64,
}

/// The modelled observation of a satellite.
///
/// P = range + c·dt + m·Z and L = P + `wind_up` + ambiguity with the receiver's clock c·dt, the wet zenith delay
/// Z and its mapping m (published as 1 and 2), all in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// The distance between the phase centres, with all delays of the signal except the receiver's clock, the wet
    /// troposphere and the ambiguity, minus the satellite's clock, m.
    pub range: f64,
    /// The contribution of the wind-up to the ionosphere-free phase, m.
    pub wind_up: f64,
    /// The wind-up in cycles, to be passed on to the next epoch.
    pub wind_up_cycles: f64,
    /// The line of sight, an ECEF unit vector from the receiver to the satellite: minus ∂range/∂position.
    pub sight: Vector3<f64>,
    /// The line of sight to the east, north and up of the receiver: the last component is the sine of the elevation.
    pub local: Vector3<f64>,
    /// The line of sight as azimuth and elevation.
    pub direction: Direction,
    /// ∂P/∂Z, Niell's mapping of the wet delay.
    pub wet_mapping: f64,
}

impl Site<'_> {
    /// The modelled observation of a satellite on two carriers at this site; `None` where it is not finite, for example
    /// for a receiver at the satellite's position.
    pub fn expect(
        &self,
        state: &SatelliteState,
        carriers: Carriers,
        antenna: Option<&[Pattern<'_>; 2]>,
        previous_wind_up: Option<f64>,
    ) -> Option<Expected> {
        let has = |correction| self.receiver.corrections.has(correction);
        let axes = BodyAxes::nominal(&state.position, &self.bodies.sun);
        let line = state.position - self.antenna;
        let distance = line.norm();
        let sight = line / distance;
        let local = self.enu_from_ecef * sight;
        let direction = Direction::of_local(&local);
        let mapping = self.troposphere.mapping_of_sine(local.z);
        let mut clock = state.clock;
        if has(Correction::Relativity) {
            clock += eccentricity_clock(&state.position, &state.velocity);
        }
        let mut range = distance - SPEED_OF_LIGHT * clock;
        if has(Correction::Troposphere) {
            range += mapping.hydrostatic * self.troposphere.zenith_hydrostatic();
        }
        if has(Correction::Sagnac) {
            range += sagnac(&state.position, &self.antenna);
        }
        if has(Correction::Shapiro) {
            range += shapiro_delay(&state.position, &self.antenna);
        }
        if let (Some([first, second]), Some(axes)) = (antenna, &axes)
            && has(Correction::SatelliteAntenna)
        {
            let both = [first.satellite_range(axes, &sight), second.satellite_range(axes, &sight)];
            range += carriers.ionosphere_free(both);
        }
        let own = match carriers.constellation() {
            Constellation::Gps => &self.receiver.antenna,
            Constellation::Galileo => &self.receiver.galileo_antenna,
            Constellation::Glonass => &self.receiver.glonass_antenna,
            Constellation::BeiDou => &self.receiver.beidou_antenna,
        };
        if let Some([first, second]) = own
            && has(Correction::ReceiverAntenna)
        {
            range += carriers.ionosphere_free([
                first.receiver_range_along(direction, &local),
                second.receiver_range_along(direction, &local),
            ]);
        }
        let wind_up_cycles = match &axes {
            Some(axes) if has(Correction::WindUp) => {
                wind_up(axes, &self.enu_from_ecef, &sight, previous_wind_up)
            }
            _ => previous_wind_up.unwrap_or(0.0),
        };
        let expected = Expected {
            range,
            wind_up: carriers.narrow_lane() * wind_up_cycles,
            wind_up_cycles,
            sight,
            local,
            direction,
            wet_mapping: mapping.wet,
        };
        (range + expected.wind_up + expected.wet_mapping).is_finite().then_some(expected)
    }
}
