use crate::{Lean, Motion};
use kestirim_robust_kalman::{
    Adaptive, Block, Descent, Igg3, NoFactor, Order, Reweighting, Robust, Scale, UnitScale, Weight,
};

/// The block of the three coordinates among the states.
pub(crate) const POSITION: Block = Block::new(0, 3);

/// How observations that do not fit are treated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Estimator<R = Robust<f64>> {
    /// The weighting of an epoch's observations: chosen at run time, or fixed by type with less flash ([`Lean`]).
    pub robust: R,
    /// The number of epochs with a rejected phase after which a satellite's ambiguity is reset.
    ///
    /// With `None`, phases are not monitored: only the combinations reveal slips, and no noise is estimated.
    pub patience: Option<u8>,
}

impl Estimator {
    /// GKF, the plain Kalman filter.
    pub fn plain() -> Self {
        Self { robust: Robust::plain(), patience: None }
    }

    /// RKF: IGG III applied to all observations at once.
    pub fn igg3() -> Self {
        Self { robust: Robust::igg3(), patience: None }
    }

    /// SKF: classification by a t-test.
    pub fn t_test() -> Self {
        Self { robust: Robust::t_test(), patience: None }
    }

    /// IKF: IGG III applied to the worst observation, repeatedly.
    pub fn iterative_igg3() -> Self {
        Self { robust: Robust::iterative_igg3(), patience: None }
    }

    /// The published UKF (uyarlı, adaptive): IKF with an adaptive factor on the position.
    pub fn adaptive() -> Self {
        Self { robust: Robust::adaptive(POSITION), patience: None }
    }

    /// The default, of our own design.
    ///
    /// The worst observation is judged first, by the configured variances, because any scale derived from an epoch's
    /// residuals is inflated by the very outliers it is to find or, where few satellites are in view, shrunk by chance.
    /// A phase that jumps and stays away has slipped; one that drifts has not.
    ///
    /// The amount of drift is learnt for each satellite: how good its clock is between samples of its product and,
    /// where the receiver moves, how noisy its phase is. (A receiver at rest averages that noise, and needs its low
    /// satellites to separate height from troposphere.)
    ///
    /// For a moving receiver the prediction is tested first: a step that all satellites show is motion. Each of its
    /// epochs has to find its own outliers, so the thresholds are tighter.
    pub fn guarded(motion: Motion) -> Self {
        let Estimator { robust, patience } = Estimator::at_rest();
        let Robust { weight, reweighting, least_redundancy, .. } = robust;
        let (weight, adaptive) = match motion {
            Motion::Static => (weight, None),
            Motion::Kinematic { .. } => {
                let adaptive = Adaptive {
                    order: Order::BeforeWeights,
                    c0: 2.0,
                    c1: 3.0,
                    floor: 1e-6,
                    ..Adaptive::new(POSITION)
                };
                (Igg3 { k0: 2.5, k1: 6.0, ..weight }, Some(adaptive))
            }
        };
        let (weight, scale) = (Weight::Igg3(weight), Scale::Unit);
        let robust = Robust { weight, scale, reweighting, least_redundancy, adaptive };
        Self { robust, patience }
    }
}

impl Estimator<Lean> {
    /// [`Estimator::guarded`] for a receiver at rest, without the code of the other run-time choices.
    pub fn at_rest() -> Self {
        let robust = Robust {
            weight: Igg3 { k0: 3.5, k1: 8.0, descent: Descent::Squared },
            scale: UnitScale,
            reweighting: Reweighting::WorstFirst { most: usize::MAX },
            least_redundancy: 0.01,
            adaptive: NoFactor,
        };
        Self { robust, patience: Some(3) }
    }
}
