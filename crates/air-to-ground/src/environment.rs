use kestirim_scalar::Scalar;

/// The excess loss and shadowing, beyond free space, of one kind of propagation: with or without a line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Propagation<T> {
    /// Mean excess loss μ over free space, dB.
    pub excess_loss: T,
    /// Standard deviation α of the shadowing at the horizon, dB.
    pub sigma: T,
    /// Decay β of the standard deviation with elevation, per degree: σ(θ) = α·exp(−β·θ) (eqs 2.7, 2.8).
    pub sigma_decay: T,
}

/// Propagation constants of a type of built environment.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Environment<T> {
    /// The parameter a of the line-of-sight probability 1/(1 + a·exp(−b·(θ − a))), θ in degrees (eq. 2.1).
    pub a: T,
    /// The parameter b of the line-of-sight probability, per degree.
    pub b: T,
    /// Propagation with a line of sight.
    pub line_of_sight: Propagation<T>,
    /// Propagation without a line of sight.
    pub obstructed: Propagation<T>,
}

/// Excess losses and shadowing are those of the thesis' Table 2.8 (2 GHz), a and b those of Al-Hourani, Kandeepan and
/// Lardner, "Optimal LAP altitude for maximum coverage", IEEE Wireless Communications Letters 3(6), 2014.
impl<T: Scalar> Environment<T> {
    /// Suburbs and villages.
    #[inline]
    pub fn suburban() -> Self {
        Self::new([4.88, 0.43], [0.1, 11.25, 0.06], [21.0, 32.17, 0.03])
    }

    /// A European city: Table 3.1.
    #[inline]
    pub fn urban() -> Self {
        Self::new([9.61, 0.16], [1.0, 10.39, 0.05], [20.0, 29.6, 0.03])
    }

    /// A city with closely spaced houses.
    #[inline]
    pub fn dense_urban() -> Self {
        Self::new([12.08, 0.11], [1.6, 8.96, 0.04], [23.0, 35.97, 0.04])
    }

    /// A city of skyscrapers.
    #[inline]
    pub fn high_rise() -> Self {
        Self::new([27.23, 0.08], [2.3, 7.37, 0.03], [34.0, 37.08, 0.03])
    }

    #[inline(always)] // So that the constants fold.
    fn new([a, b]: [f64; 2], line_of_sight: [f64; 3], obstructed: [f64; 3]) -> Self {
        Self {
            a: T::from_f64(a),
            b: T::from_f64(b),
            line_of_sight: Propagation::new(line_of_sight),
            obstructed: Propagation::new(obstructed),
        }
    }
}

impl<T: Scalar> Propagation<T> {
    #[inline(always)] // So that the constants fold.
    fn new([excess_loss, sigma, sigma_decay]: [f64; 3]) -> Self {
        Self {
            excess_loss: T::from_f64(excess_loss),
            sigma: T::from_f64(sigma),
            sigma_decay: T::from_f64(sigma_decay),
        }
    }
}
