use kestirim_scalar::Scalar;

use crate::Error;

/// Power and energy model of a rotorcraft (the thesis' section 2.2.4).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Rotor<T> {
    /// Weight m·g, N.
    pub weight: T,
    /// Density of the air ρ, kg/m³.
    pub air_density: T,
    /// Area of the rotor disc `A_d`, m².
    pub disc_area: T,
    /// Drag coefficient times reference area `C_ds`, m².
    pub drag_area: T,
    /// Power k₀ required by the blades' profile drag in hover, W.
    pub profile_power: T,
    /// Tip speed of the blades `v_t`, m/s.
    pub tip_speed: T,
}

impl<T: Scalar> Rotor<T> {
    /// The thesis' drone base station (Table 2.6): 5 kg, g = 10 m/s².
    pub fn base_station() -> Self {
        Self {
            weight: T::from_f64(50.0),
            air_density: T::from_f64(1.225),
            disc_area: T::from_f64(0.25),
            drag_area: T::from_f64(0.4),
            profile_power: T::from_f64(570.0),
            tip_speed: T::from_f64(100.0),
        }
    }

    /// Power at an air speed (m/s), W: the sum of induced, parasitic and profile power (eq. 2.12).
    ///
    /// # Errors
    /// [`Error::NotFinite`] if the result is not finite (Q16.16 reaches 43 m/s with the thesis' drone).
    pub fn power(&self, speed: T) -> Result<T, Error> {
        let induced = self.weight * self.induced_speed(speed)?;
        let square = speed * speed;
        let parasitic = T::HALF * self.air_density * self.drag_area * square * speed.abs();
        let advance = speed / self.tip_speed;
        let profile = self.profile_power * (T::ONE + T::from_f64(3.0) * advance * advance);
        finite(induced + parasitic + profile)
    }

    /// Speed with which the rotor accelerates the air downwards, m/s (eq. 2.15).
    ///
    /// # Errors
    /// [`Error::NotFinite`] if the result is not finite.
    pub fn induced_speed(&self, speed: T) -> Result<T, Error> {
        let square = speed * speed;
        let loading = self.weight / (self.air_density * self.disc_area);
        finite(((square.hypot(loading) - square) * T::HALF).max(T::ZERO).sqrt())
    }

    /// Energy of a flight plan, J: flying `distance` (m) at `speed` (m/s), and hovering for `hover` (s) (eqs 2.16,
    /// 2.17).
    ///
    /// # Errors
    /// [`Error::NotFinite`] if the result is not finite (Q16.16 ends at 32 kJ); [`Error::NotPositive`] for a speed
    /// that is not positive.
    pub fn energy(&self, distance: T, speed: T, hover: T) -> Result<T, Error> {
        if speed <= T::ZERO {
            return Err(Error::NotPositive);
        }
        let flying = distance / speed * self.power(speed)?;
        finite(flying + hover * self.power(T::ZERO)?)
    }
}

fn finite<T: Scalar>(value: T) -> Result<T, Error> {
    if value.is_finite() { Ok(value) } else { Err(Error::NotFinite) }
}
