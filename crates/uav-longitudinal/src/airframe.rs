use crate::Error;
#[cfg(feature = "serde")]
use crate::published::Published;

/// Size, mass and published coefficients of an aircraft with a propeller in front of its centre of mass.
///
/// The coefficients are those of Beard et al., *Small Unmanned Aircraft: Theory and Practice*, 2012, and have the
/// book's names in the serialised form. Those that the book's tables set to zero throughout (drag due to pitch rate,
/// the propeller's torque) are omitted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Published", into = "Published"))]
pub struct Airframe {
    /// Mass m, kg.
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
    /// Gravitational acceleration g, m/s².
    pub gravity: f64,
    /// Lift coefficients.
    pub lift: Lift,
    /// Drag coefficients.
    pub drag: Drag,
    /// Coefficients of the pitching moment.
    pub pitch: Pitch,
    /// Propeller and motor, which produce the thrust.
    pub propeller: Propeller,
    /// Coefficients of the side force `C_Y`.
    pub side_force: SideCoefficients,
    /// Coefficients of the rolling moment `C_ℓ`.
    pub rolling: SideCoefficients,
    /// Coefficients of the yawing moment `C_n`.
    pub yawing: SideCoefficients,
}

/// Moments of inertia about the body axes, kg·m².
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Inertia {
    /// Moment of inertia Jx about the roll axis.
    pub x: f64,
    /// Moment of inertia Jy about the pitch axis.
    pub y: f64,
    /// Moment of inertia Jz about the yaw axis.
    pub z: f64,
    /// Product of inertia Jxz.
    pub xz: f64,
}

/// Lift coefficients: `C_L` = `C_L0` + `C_Lα`·α + `C_Lq`·c/(2V)·q + `C_Lδe`·δe.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lift {
    /// Lift coefficient at zero α, q and δe: `C_L0`.
    pub zero: f64,
    /// Lift slope `C_Lα`, per radian.
    pub alpha: f64,
    /// Coefficient of the pitch rate, `C_Lq`.
    pub pitch_rate: f64,
    /// Coefficient of the elevator, `C_Lδe`, per radian.
    pub elevator: f64,
    /// Stall of the wing; if `None`, the flow stays attached.
    pub stall: Option<Stall>,
}

/// Stall beyond ±α₀, where the wing acts as a flat plate with the lift coefficient 2·sign(α)·sin²α·cos α.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stall {
    /// Stall angle α₀, rad.
    pub alpha: f64,
    /// Sharpness M of the transition, per radian.
    pub sharpness: f64,
}

/// Drag coefficients, in either of the two published forms.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Drag {
    /// Parasitic and induced drag: `C_D` = `C_Dp` + (`C_L0` + `C_Lα`·α)²/(π·e·b²/S).
    Induced {
        /// Parasitic drag coefficient `C_Dp`.
        parasitic: f64,
        /// Oswald's efficiency factor e.
        efficiency: f64,
    },
    /// A polynomial in angle of attack and elevator: `C_D` = `C_D0` + `C_Dα1`·α + `C_Dα2`·α² + `C_Dδe`·δe².
    Polynomial {
        /// Drag coefficient at zero α and δe: `C_D0`.
        zero: f64,
        /// Linear coefficient of α, `C_Dα1`, per radian.
        alpha: f64,
        /// Quadratic coefficient of α, `C_Dα2`, per radian².
        alpha_squared: f64,
        /// Quadratic coefficient of the elevator, `C_Dδe`, per radian²: equal for both directions.
        elevator_squared: f64,
    },
}

/// Pitching-moment coefficients: `C_m` = `C_m0` + `C_mα`·α + `C_mq`·c/(2V)·q + `C_mδe`·δe.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pitch {
    /// Moment coefficient at zero α, q and δe: `C_m0`.
    pub zero: f64,
    /// Coefficient of the angle of attack, `C_mα`, per radian.
    pub alpha: f64,
    /// Coefficient of the pitch rate, `C_mq`.
    pub pitch_rate: f64,
    /// Coefficient of the elevator, `C_mδe`, per radian.
    pub elevator: f64,
}

/// Propeller with the thrust ½·ρ·`S_prop`·`C_prop`·((`k_motor`·δt)² − V²) along the body's x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Propeller {
    /// Swept area `S_prop`, m².
    pub area: f64,
    /// Thrust coefficient `C_prop`.
    pub coefficient: f64,
    /// Speed `k_motor` of the air behind the propeller at full throttle, m/s.
    pub motor: f64,
}

/// Coefficients of a side force or a moment; rates enter multiplied by b/(2V).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SideCoefficients {
    /// Coefficient of the sideslip angle β, per radian.
    pub sideslip: f64,
    /// Coefficient of the dimensionless roll rate p·b/(2·V).
    pub roll_rate: f64,
    /// Coefficient of the dimensionless yaw rate r·b/(2·V).
    pub yaw_rate: f64,
    /// Coefficient of the aileron δa, per radian.
    pub aileron: f64,
    /// Coefficient of the rudder δr, per radian.
    pub rudder: f64,
}

impl Airframe {
    /// The Aerosonde of the book's appendix E, 13.5 kg, with attached flow.
    ///
    /// [`Stall::aerosonde`] changes its model at 40 m/s by a relative 2·10⁻¹⁰.
    pub fn aerosonde() -> Self {
        let [side_force, rolling, yawing] = [
            [-0.98, 0.0, 0.0, 0.0, -0.17],
            [-0.12, -0.26, 0.14, 0.08, 0.105],
            [0.25, 0.022, -0.35, 0.06, -0.032],
        ]
        .map(SideCoefficients::of);
        Self {
            mass: 13.5,
            inertia: Inertia { x: 0.8244, y: 1.135, z: 1.759, xz: 0.1204 },
            wing_area: 0.55,
            span: 2.8956,
            chord: 0.18994,
            air_density: 1.2682,
            gravity: 9.81,
            lift: Lift { zero: 0.28, alpha: 3.45, pitch_rate: 0.0, elevator: -0.36, stall: None },
            drag: Drag::Induced { parasitic: 0.0437, efficiency: 0.9 },
            pitch: Pitch { zero: -0.02338, alpha: -0.38, pitch_rate: -3.6, elevator: -0.5 },
            propeller: Propeller { area: 0.2027, coefficient: 1.0, motor: 80.0 },
            side_force,
            rolling,
            yawing,
        }
    }

    /// The Skywalker X8, a flying wing of 3.364 kg that flies at about 18 m/s.
    ///
    /// The aerodynamics are those of K. Gryte, R. Hann, M. Alam, J. Roháč, T. A. Johansen, T. I. Fossen, *Aerodynamic
    /// modeling of the Skywalker X8 fixed-wing unmanned aerial vehicle*, ICUAS 2018, with the values of its authors'
    /// parameter file: `C_mα`, `C_m0` and `C_mδe` from flights, `C_nr` six times that of the paper. According to the
    /// authors, moments of inertia and thrust (in the form of Beard et al., 2012) are rough.
    pub fn skywalker_x8() -> Self {
        let [side_force, rolling, yawing] = [
            [
                -0.223_872_157_002_540_48,
                -0.137_355_052_631_578_93,
                0.083_868_768_421_052_63,
                0.043_276_402_502_774_876,
                0.0,
            ],
            [
                -0.084_896_286_396_624_17,
                -0.404_197_999_999_999_95,
                0.055_520_6,
                0.120_188_141_257_827_45,
                0.0,
            ],
            [0.0283, 0.004_365_511_578_947_368, -0.072, -0.003_39, 0.0],
        ]
        .map(SideCoefficients::of);
        Self {
            mass: 3.364,
            inertia: Inertia { x: 1.229, y: 0.1702, z: 0.8808, xz: 0.9343 },
            wing_area: 0.75,
            span: 2.1,
            chord: 0.357_142_857_142_857_15,
            air_density: 1.225,
            gravity: 9.81,
            lift: Lift {
                zero: 0.086_735_566_716_107_34,
                alpha: 4.020_328_244_000_679,
                pitch_rate: 3.87,
                elevator: 0.278_073_620_173_471_3,
                stall: None,
            },
            drag: Drag::Polynomial {
                zero: 0.019_700_011_819_150_82,
                alpha: 0.079_091_463_157_662_97,
                alpha_squared: 1.055_469_986_768_084_1,
                elevator_squared: 0.063_347_396_781_802_32,
            },
            pitch: Pitch {
                zero: 0.022_75,
                alpha: -0.4629,
                pitch_rate: -1.301_237_037_037_037_2,
                elevator: -0.2292,
            },
            propeller: Propeller { area: 0.101_787_601_976_309_29, coefficient: 1.0, motor: 40.0 },
            side_force,
            rolling,
            yawing,
        }
    }

    /// Checks that the numbers are finite and, where required, positive.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let Inertia { x, y, z, xz } = self.inertia;
        let Self { mass, wing_area, span, chord, air_density, gravity, drag, propeller, .. } = self;
        let (efficiency, polynomial) = match *drag {
            Drag::Induced { parasitic, efficiency } => (efficiency, [parasitic, 0.0, 0.0, 0.0]),
            Drag::Polynomial { zero, alpha, alpha_squared, elevator_squared } => {
                (1.0, [zero, alpha, alpha_squared, elevator_squared])
            }
        };
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
            efficiency,
            propeller.area,
            propeller.coefficient,
            propeller.motor,
        ];
        let others = polynomial.iter().chain([&xz]);
        if positive.iter().chain(others).any(|number| !number.is_finite()) {
            return Err(Error::NotFinite);
        }
        if positive.iter().any(|number| *number <= 0.0) {
            return Err(Error::NotPositive);
        }
        Ok(())
    }
}

impl SideCoefficients {
    /// Creates the coefficients from those of sideslip, roll rate, yaw rate, aileron and rudder.
    pub(crate) const fn of([sideslip, roll_rate, yaw_rate, aileron, rudder]: [f64; 5]) -> Self {
        Self { sideslip, roll_rate, yaw_rate, aileron, rudder }
    }
}

impl Stall {
    /// The stall of the Aerosonde.
    pub fn aerosonde() -> Self {
        Self { alpha: 0.4712, sharpness: 50.0 }
    }
}
