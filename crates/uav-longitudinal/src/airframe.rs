use crate::Error;

/// Size, mass and published coefficients of an aircraft with a propeller in front of its centre of mass.
///
/// Coefficients are those of Beard et al., *Small Unmanned Aircraft: Theory and Practice*, 2012, by their names
/// there; what the book's tables set to zero throughout (drag by pitch rate and by elevator, the propeller's torque) is left
/// out.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Airframe {
    /// m, kg.
    pub mass: f64,
    /// Moments of inertia.
    pub inertia: Inertia,
    /// Wing area S, m².
    pub wing_area: f64,
    /// Wing span b, m.
    pub span: f64,
    /// Mean chord of the wing c, m.
    pub chord: f64,
    /// Density of the air ρ, kg/m³.
    pub air_density: f64,
    /// g, m/s².
    pub gravity: f64,
    /// Lift.
    pub lift: Lift,
    /// Drag.
    pub drag: Drag,
    /// Pitching moment.
    pub pitch: Pitch,
    /// Thrust.
    pub propeller: Propeller,
    /// Side force `C_Y`.
    pub side_force: SideCoefficients,
    /// Rolling moment `C_ℓ`.
    pub rolling: SideCoefficients,
    /// Yawing moment `C_n`.
    pub yawing: SideCoefficients,
}

/// Moments of inertia about the body axes, kg·m².
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Inertia {
    /// Jx.
    pub x: f64,
    /// Jy.
    pub y: f64,
    /// Jz.
    pub z: f64,
    /// Jxz.
    pub xz: f64,
}

/// `C_L` = `C_L0` + `C_Lα`·α + `C_Lq`·c/(2V)·q + `C_Lδe`·δe.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lift {
    /// `C_L0`.
    pub zero: f64,
    /// `C_Lα`, per radian.
    pub alpha: f64,
    /// `C_Lq`.
    pub pitch_rate: f64,
    /// `C_Lδe`, per radian.
    pub elevator: f64,
    /// Stall of the wing; none: the flow stays attached.
    pub stall: Option<Stall>,
}

/// Stall beyond ±α₀, where the wing is a flat plate of lift 2·sign(α)·sin²α·cos α.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stall {
    /// α₀, rad.
    pub alpha: f64,
    /// Sharpness of the transition M, per radian.
    pub sharpness: f64,
}

/// `C_D` = `C_Dp` + (`C_L0` + `C_Lα`·α)²/(π·e·b²/S).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Drag {
    /// `C_Dp`.
    pub parasitic: f64,
    /// Oswald's efficiency e.
    pub efficiency: f64,
}

/// `C_m` = `C_m0` + `C_mα`·α + `C_mq`·c/(2V)·q + `C_mδe`·δe.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pitch {
    /// `C_m0`.
    pub zero: f64,
    /// `C_mα`, per radian.
    pub alpha: f64,
    /// `C_mq`.
    pub pitch_rate: f64,
    /// `C_mδe`, per radian.
    pub elevator: f64,
}

/// Thrust ½·ρ·`S_prop`·`C_prop`·((`k_motor`·δt)² − V²) along the body's x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Propeller {
    /// `S_prop`, m².
    pub area: f64,
    /// `C_prop`.
    pub coefficient: f64,
    /// Speed of the air behind it at full throttle `k_motor`, m/s.
    pub motor: f64,
}

/// Coefficients of a side force or a moment, per radian; rates are multiplied by b/(2V).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SideCoefficients {
    /// Coefficient of the sideslip angle β, per rad.
    pub sideslip: f64,
    /// Coefficient of the roll rate p, of its pure number p·b/(2·V).
    pub roll_rate: f64,
    /// Coefficient of the yaw rate r, of its pure number r·b/(2·V).
    pub yaw_rate: f64,
    /// Coefficient of the aileron δa, per rad.
    pub aileron: f64,
    /// Coefficient of the rudder δr, per rad.
    pub rudder: f64,
}

impl Airframe {
    /// The Aerosonde of the book's appendix E, 13.5 kg, with attached flow.
    ///
    /// With [`Stall::aerosonde`] its model at 40 m/s changes by 2·10⁻¹⁰ of itself.
    pub fn aerosonde() -> Self {
        let [side_force, rolling, yawing] = [
            [-0.98, 0.0, 0.0, 0.0, -0.17],
            [-0.12, -0.26, 0.14, 0.08, 0.105],
            [0.25, 0.022, -0.35, 0.06, -0.032],
        ]
        .map(|[sideslip, roll_rate, yaw_rate, aileron, rudder]| SideCoefficients {
            sideslip,
            roll_rate,
            yaw_rate,
            aileron,
            rudder,
        });
        Self {
            mass: 13.5,
            inertia: Inertia { x: 0.8244, y: 1.135, z: 1.759, xz: 0.1204 },
            wing_area: 0.55,
            span: 2.8956,
            chord: 0.18994,
            air_density: 1.2682,
            gravity: 9.81,
            lift: Lift { zero: 0.28, alpha: 3.45, pitch_rate: 0.0, elevator: -0.36, stall: None },
            drag: Drag { parasitic: 0.0437, efficiency: 0.9 },
            pitch: Pitch { zero: -0.02338, alpha: -0.38, pitch_rate: -3.6, elevator: -0.5 },
            propeller: Propeller { area: 0.2027, coefficient: 1.0, motor: 80.0 },
            side_force,
            rolling,
            yawing,
        }
    }

    /// Whether one can calculate with it.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let Inertia { x, y, z, xz } = self.inertia;
        let Self { mass, wing_area, span, chord, air_density, gravity, drag, propeller, .. } = self;
        let positive = [
            *mass,
            x,
            y,
            z,
            *wing_area,
            *span,
            *chord,
            *air_density,
            *gravity,
            drag.efficiency,
            propeller.area,
            propeller.coefficient,
            propeller.motor,
        ];
        if positive.iter().any(|number| !number.is_finite()) || !xz.is_finite() {
            return Err(Error::NotFinite);
        }
        if positive.iter().any(|number| *number <= 0.0) {
            return Err(Error::NotPositive);
        }
        Ok(())
    }
}

impl Stall {
    /// Stall of the Aerosonde.
    pub fn aerosonde() -> Self {
        Self { alpha: 0.4712, sharpness: 50.0 }
    }
}
