use libm::{cos, sin};
use nalgebra::SMatrix;

use crate::Descriptor;

/// Dimensional derivatives of the longitudinal motion (the thesis' eqs 3.4.1 and 3.4.2, after Stevens and
/// Lewis).
///
/// X and Z are accelerations (m/s² per unit of the variable) along the wind axes, M is an angular acceleration
/// (rad/s² per unit of the variable); X is positive forwards, Z downwards. Derivatives with `thrust` are the engine's
/// share.
///
/// Misprints are corrected: what the thesis subtracts in E as Zα and Mα is [`z_alpha_dot`](Self::z_alpha_dot) (m/s)
/// and [`m_alpha_dot`](Self::m_alpha_dot) (1/s); Zα (m/s²) cannot be subtracted from a speed. What it adds to Mα as
/// `M_Te` is [`m_thrust_alpha`](Self::m_thrust_alpha).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LongitudinalDerivatives {
    /// Steady airspeed `V_Te`, m/s.
    pub airspeed: f64,
    /// Gravitational acceleration g, m/s².
    pub gravity: f64,
    /// Steady angle of attack `α_e` plus the installation angle of the engine `α_T`, rad.
    pub thrust_angle: f64,
    /// Steady climb angle `γ_e`, rad.
    pub climb_angle: f64,
    /// Xα: derivative of X with respect to the angle of attack.
    pub x_alpha: f64,
    /// `X_V`: derivative of X with respect to the airspeed.
    pub x_airspeed: f64,
    /// `X_TV`: the engine's share of the derivative of X with respect to the airspeed.
    pub x_thrust_airspeed: f64,
    /// `X_δe`: derivative of X with respect to the elevator.
    pub x_elevator: f64,
    /// `X_δt`: derivative of X with respect to the throttle.
    pub x_throttle: f64,
    /// Zα: derivative of Z with respect to the angle of attack.
    pub z_alpha: f64,
    /// Zα̇: derivative of Z with respect to the rate of the angle of attack, m/s.
    pub z_alpha_dot: f64,
    /// `Z_q`: derivative of Z with respect to the pitch rate, m/s.
    pub z_pitch_rate: f64,
    /// `Z_V`: derivative of Z with respect to the airspeed.
    pub z_airspeed: f64,
    /// `Z_δe`: derivative of Z with respect to the elevator.
    pub z_elevator: f64,
    /// Mα: derivative of M with respect to the angle of attack.
    pub m_alpha: f64,
    /// Mα̇: derivative of M with respect to the rate of the angle of attack, 1/s.
    pub m_alpha_dot: f64,
    /// `M_Tα`: the engine's share of the derivative of M with respect to the angle of attack.
    pub m_thrust_alpha: f64,
    /// `M_q`: derivative of M with respect to the pitch rate, 1/s.
    pub m_pitch_rate: f64,
    /// `M_V`: derivative of M with respect to the airspeed.
    pub m_airspeed: f64,
    /// `M_TV`: the engine's share of the derivative of M with respect to the airspeed.
    pub m_thrust_airspeed: f64,
    /// `M_δe`: derivative of M with respect to the elevator.
    pub m_elevator: f64,
    /// `M_δt`: derivative of M with respect to the throttle.
    pub m_throttle: f64,
}

impl LongitudinalDerivatives {
    /// The descriptor form, with states α, q, V, θ and inputs δe, δt.
    pub fn descriptor(&self) -> Descriptor {
        let (sin_thrust, cos_thrust) = (sin(self.thrust_angle), cos(self.thrust_angle));
        let mut e = SMatrix::identity();
        e[(0, 0)] = self.airspeed - self.z_alpha_dot;
        e[(1, 0)] = -self.m_alpha_dot;
        let mut a = SMatrix::zeros();
        a[(0, 0)] = self.z_alpha;
        a[(0, 1)] = self.airspeed + self.z_pitch_rate;
        a[(0, 2)] = self.z_airspeed - self.x_thrust_airspeed * sin_thrust;
        a[(0, 3)] = -self.gravity * sin(self.climb_angle);
        a[(1, 0)] = self.m_alpha + self.m_thrust_alpha;
        a[(1, 1)] = self.m_pitch_rate;
        a[(1, 2)] = self.m_airspeed + self.m_thrust_airspeed;
        a[(2, 0)] = self.x_alpha;
        a[(2, 2)] = self.x_airspeed + self.x_thrust_airspeed * cos_thrust;
        a[(2, 3)] = -self.gravity * cos(self.climb_angle);
        a[(3, 1)] = 1.0;
        let mut b = SMatrix::zeros();
        b[(0, 0)] = self.z_elevator;
        b[(0, 1)] = -self.x_throttle * sin_thrust;
        b[(1, 0)] = self.m_elevator;
        b[(1, 1)] = self.m_throttle;
        b[(2, 0)] = self.x_elevator;
        b[(2, 1)] = self.x_throttle * cos_thrust;
        Descriptor { e, a, b }
    }
}

/// Dimensional derivatives of the lateral motion (the thesis' eqs 3.4.3 and 3.4.4).
///
/// Y is an acceleration (m/s²), L and N are angular accelerations (rad/s²) with the inertia's coupling resolved
/// (primed in the thesis), all about the stability axes: x along the steady airspeed. Each derivative is a triple in
/// the order Y, L, N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LateralDerivatives {
    /// Steady airspeed `V_Te`, m/s.
    pub airspeed: f64,
    /// Gravitational acceleration g, m/s².
    pub gravity: f64,
    /// Steady pitch angle `θ_e`, rad.
    pub pitch_angle: f64,
    /// Steady climb angle `γ_e`, rad.
    pub climb_angle: f64,
    /// Derivatives with respect to the sideslip angle: Yβ, L'β, N'β.
    pub sideslip: [f64; 3],
    /// Derivatives with respect to the roll rate: `Y_p`, L'p, N'p.
    pub roll_rate: [f64; 3],
    /// Derivatives with respect to the yaw rate: `Y_r`, L'r, N'r.
    pub yaw_rate: [f64; 3],
    /// Derivatives with respect to the aileron: `Y_δa`, L'δa, N'δa.
    pub aileron: [f64; 3],
    /// Derivatives with respect to the rudder: `Y_δr`, L'δr, N'δr.
    pub rudder: [f64; 3],
}

impl LateralDerivatives {
    /// The descriptor form, with states β, φ, p, r (rates about the stability axes) and inputs δa, δr.
    pub fn descriptor(&self) -> Descriptor {
        let mut e = SMatrix::identity();
        e[(0, 0)] = self.airspeed;
        // The row of the bank angle is kinematics; the other rows are forces and moments.
        let of_forces = |[y, l, n]: [f64; 3]| [y, 0.0, l, n];
        let mut a = SMatrix::from([
            of_forces(self.sideslip),
            [0.0; 4],
            of_forces(self.roll_rate),
            of_forces(self.yaw_rate),
        ]);
        let b = SMatrix::from([self.aileron, self.rudder].map(of_forces));
        a[(0, 1)] = self.gravity * cos(self.pitch_angle);
        a[(0, 3)] -= self.airspeed;
        a[(1, 2)] = cos(self.climb_angle) / cos(self.pitch_angle);
        a[(1, 3)] = sin(self.climb_angle) / cos(self.pitch_angle);
        Descriptor { e, a, b }
    }
}
