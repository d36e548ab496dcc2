//! The serialised form of an airframe, with the names of the parameter files of Beard et al.'s book.

use serde::{Deserialize, Serialize};

use crate::{Airframe, Drag, Inertia, Lift, Pitch, Propeller, SideCoefficients, Stall};

#[derive(Deserialize, Serialize)]
#[expect(non_snake_case, reason = "names of the book's files")]
pub(crate) struct Published {
    mass: f64,
    Jx: f64,
    Jy: f64,
    Jz: f64,
    #[serde(default)]
    Jxz: f64,
    S_wing: f64,
    b: f64,
    c: f64,
    #[serde(default = "density")]
    rho: f64,
    #[serde(default = "gravity", alias = "g")]
    gravity: f64,
    S_prop: f64,
    #[serde(default = "one")]
    C_prop: f64,
    k_motor: f64,
    #[serde(default)]
    C_L_0: f64,
    C_L_alpha: f64,
    #[serde(default)]
    C_L_q: f64,
    #[serde(default)]
    C_L_delta_e: f64,
    /// Stall, together with `M`.
    alpha0: Option<f64>,
    M: Option<f64>,
    /// Drag of the first form, together with `e`.
    C_D_p: Option<f64>,
    e: Option<f64>,
    /// Drag of the second form, together with the next three.
    C_D_0: Option<f64>,
    #[serde(alias = "C_D_alpha")]
    C_D_alpha1: Option<f64>,
    C_D_alpha2: Option<f64>,
    C_D_delta_e: Option<f64>,
    #[serde(default)]
    C_m_0: f64,
    C_m_alpha: f64,
    C_m_q: f64,
    C_m_delta_e: f64,
    #[serde(default)]
    C_Y_beta: f64,
    #[serde(default)]
    C_Y_p: f64,
    #[serde(default)]
    C_Y_r: f64,
    #[serde(default)]
    C_Y_delta_a: f64,
    #[serde(default)]
    C_Y_delta_r: f64,
    #[serde(default, alias = "C_l_beta")]
    C_ell_beta: f64,
    #[serde(default, alias = "C_l_p")]
    C_ell_p: f64,
    #[serde(default, alias = "C_l_r")]
    C_ell_r: f64,
    #[serde(default, alias = "C_l_delta_a")]
    C_ell_delta_a: f64,
    #[serde(default, alias = "C_l_delta_r")]
    C_ell_delta_r: f64,
    #[serde(default)]
    C_n_beta: f64,
    #[serde(default)]
    C_n_p: f64,
    #[serde(default)]
    C_n_r: f64,
    #[serde(default)]
    C_n_delta_a: f64,
    #[serde(default)]
    C_n_delta_r: f64,
}

const fn density() -> f64 {
    1.225
}

const fn gravity() -> f64 {
    9.81
}

const fn one() -> f64 {
    1.0
}

#[cfg(feature = "serde")]
impl TryFrom<Published> for Airframe {
    type Error = &'static str;

    fn try_from(it: Published) -> Result<Self, Self::Error> {
        let drag = match (it.C_D_p, it.e, it.C_D_0) {
            (Some(parasitic), Some(efficiency), _) => Drag::Induced { parasitic, efficiency },
            (_, _, Some(zero)) => Drag::Polynomial {
                zero,
                alpha: it.C_D_alpha1.unwrap_or(0.0),
                alpha_squared: it.C_D_alpha2.unwrap_or(0.0),
                elevator_squared: it.C_D_delta_e.unwrap_or(0.0),
            },
            _ => return Err("expected C_D_p and e, or C_D_0"),
        };
        Ok(Self {
            mass: it.mass,
            inertia: Inertia { x: it.Jx, y: it.Jy, z: it.Jz, xz: it.Jxz },
            wing_area: it.S_wing,
            span: it.b,
            chord: it.c,
            air_density: it.rho,
            gravity: it.gravity,
            lift: Lift {
                zero: it.C_L_0,
                alpha: it.C_L_alpha,
                pitch_rate: it.C_L_q,
                elevator: it.C_L_delta_e,
                stall: it.alpha0.zip(it.M).map(|(alpha, sharpness)| Stall { alpha, sharpness }),
            },
            drag,
            pitch: Pitch {
                zero: it.C_m_0,
                alpha: it.C_m_alpha,
                pitch_rate: it.C_m_q,
                elevator: it.C_m_delta_e,
            },
            propeller: Propeller { area: it.S_prop, coefficient: it.C_prop, motor: it.k_motor },
            side_force: SideCoefficients::of([
                it.C_Y_beta,
                it.C_Y_p,
                it.C_Y_r,
                it.C_Y_delta_a,
                it.C_Y_delta_r,
            ]),
            rolling: SideCoefficients::of([
                it.C_ell_beta,
                it.C_ell_p,
                it.C_ell_r,
                it.C_ell_delta_a,
                it.C_ell_delta_r,
            ]),
            yawing: SideCoefficients::of([
                it.C_n_beta,
                it.C_n_p,
                it.C_n_r,
                it.C_n_delta_a,
                it.C_n_delta_r,
            ]),
        })
    }
}

impl From<Airframe> for Published {
    fn from(it: Airframe) -> Self {
        let (induced, polynomial) = match it.drag {
            Drag::Induced { parasitic, efficiency } => (Some([parasitic, efficiency]), None),
            Drag::Polynomial { zero, alpha, alpha_squared, elevator_squared } => {
                (None, Some([zero, alpha, alpha_squared, elevator_squared]))
            }
        };
        Self {
            mass: it.mass,
            Jx: it.inertia.x,
            Jy: it.inertia.y,
            Jz: it.inertia.z,
            Jxz: it.inertia.xz,
            S_wing: it.wing_area,
            b: it.span,
            c: it.chord,
            rho: it.air_density,
            gravity: it.gravity,
            S_prop: it.propeller.area,
            C_prop: it.propeller.coefficient,
            k_motor: it.propeller.motor,
            C_L_0: it.lift.zero,
            C_L_alpha: it.lift.alpha,
            C_L_q: it.lift.pitch_rate,
            C_L_delta_e: it.lift.elevator,
            alpha0: it.lift.stall.map(|stall| stall.alpha),
            M: it.lift.stall.map(|stall| stall.sharpness),
            C_D_p: induced.map(|[parasitic, _]| parasitic),
            e: induced.map(|[_, efficiency]| efficiency),
            C_D_0: polynomial.map(|[zero, ..]| zero),
            C_D_alpha1: polynomial.map(|[_, alpha, ..]| alpha),
            C_D_alpha2: polynomial.map(|[.., squared, _]| squared),
            C_D_delta_e: polynomial.map(|[.., elevator]| elevator),
            C_m_0: it.pitch.zero,
            C_m_alpha: it.pitch.alpha,
            C_m_q: it.pitch.pitch_rate,
            C_m_delta_e: it.pitch.elevator,
            C_Y_beta: it.side_force.sideslip,
            C_Y_p: it.side_force.roll_rate,
            C_Y_r: it.side_force.yaw_rate,
            C_Y_delta_a: it.side_force.aileron,
            C_Y_delta_r: it.side_force.rudder,
            C_ell_beta: it.rolling.sideslip,
            C_ell_p: it.rolling.roll_rate,
            C_ell_r: it.rolling.yaw_rate,
            C_ell_delta_a: it.rolling.aileron,
            C_ell_delta_r: it.rolling.rudder,
            C_n_beta: it.yawing.sideslip,
            C_n_p: it.yawing.roll_rate,
            C_n_r: it.yawing.yaw_rate,
            C_n_delta_a: it.yawing.aileron,
            C_n_delta_r: it.yawing.rudder,
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::string::ToString;

    use super::*;

    #[test]
    fn an_airframe_is_the_same_after_its_file() {
        for airframe in [Airframe::aerosonde(), Airframe::skywalker_x8()] {
            let text = serde_json::to_string(&airframe).unwrap();
            assert!(text.contains("\"C_m_alpha\":"), "{text}");
            assert_eq!(serde_json::from_str::<Airframe>(&text).unwrap(), airframe);
        }
    }

    #[test]
    fn the_books_names_are_read_and_drag_is_required() {
        let file = r#"{"mass": 1, "Jx": 1, "Jy": 1, "Jz": 1, "S_wing": 1, "b": 2, "c": 0.3, "S_prop": 0.1, "k_motor": 30,
            "C_L_alpha": 4, "C_m_alpha": -0.4, "C_m_q": -3, "C_m_delta_e": -0.5, "C_l_beta": -0.1, "C_D_0": 0.03, "C_D_alpha": 0.3}"#;
        let airframe: Airframe = serde_json::from_str(file).unwrap();
        assert_eq!((airframe.air_density, airframe.gravity), (1.225, 9.81));
        assert_eq!(airframe.rolling.sideslip, -0.1);
        let Drag::Polynomial { zero, alpha, .. } = airframe.drag else { panic!() };
        assert_eq!((zero, alpha), (0.03, 0.3));
        let error = serde_json::from_str::<Airframe>(&file.replace("C_D_0", "X")).unwrap_err();
        assert!(error.to_string().contains("C_D_p and e"), "{error}");
    }
}
