use kestirim_scalar::Scalar;

use crate::{Environment, Error, Likelihood, Measurement, Propagation};

/// The path loss between a drone and a user on the ground: free-space loss plus the excess loss of buildings, with and
/// without a line of sight (Al-Hourani's model; the thesis' section 2.1).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Channel<T> {
    /// The parameter b, per radian of elevation.
    b: T,
    /// The odds against a line of sight at the horizon: a·exp(a·b).
    odds: T,
    line_of_sight: Shadowing<T>,
    obstructed: Shadowing<T>,
}

/// One kind of propagation, in the form that the likelihood needs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Shadowing<T> {
    /// Mean loss at a distance of one metre, dB.
    loss_at_one_metre: T,
    /// ln 1/α.
    log_inverse_sigma: T,
    /// Logarithm of the normalising factor of the density, for unit standard deviation.
    log_weight: T,
    /// The decay β per radian of elevation.
    decay: T,
    /// Upper limit of ln 1/σ: −ln of the smallest standard deviation.
    most_precise: T,
}

/// Distribution of a measured path loss (eqs 2.1 and 2.7 to 2.10).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PathLoss<T> {
    /// Probability of a line of sight.
    pub line_of_sight_probability: T,
    /// Mean loss with a line of sight, dB.
    pub line_of_sight_mean: T,
    /// Standard deviation with a line of sight, dB.
    pub line_of_sight_sigma: T,
    /// Mean loss without a line of sight, dB.
    pub obstructed_mean: T,
    /// Standard deviation without a line of sight, dB.
    pub obstructed_sigma: T,
}

impl<T: Scalar> PathLoss<T> {
    /// Mean loss over both kinds of propagation, dB.
    pub fn mean(&self) -> T {
        let p = self.line_of_sight_probability;
        self.obstructed_mean + (self.line_of_sight_mean - self.obstructed_mean) * p
    }

    /// Standard deviation over both kinds of propagation, dB.
    pub fn sigma(&self) -> T {
        let p = self.line_of_sight_probability;
        let between = (p * (T::ONE - p)).sqrt() * (self.obstructed_mean - self.line_of_sight_mean);
        // √(p·σ² + …), computed as norms, whose squares do not overflow in fixed point.
        T::norm(&[
            p.sqrt() * self.line_of_sight_sigma,
            (T::ONE - p).sqrt() * self.obstructed_sigma,
            between,
        ])
    }
}

impl<T: Scalar> Channel<T> {
    /// Creates a channel for an environment at a wavelength (m); 0.15 m corresponds to 2 GHz.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::NotPositive`] for a wavelength, a standard deviation or a parameter a that is
    /// not positive.
    #[inline]
    pub fn new(environment: &Environment<T>, wavelength: T) -> Result<Self, Error> {
        let Environment { a, b, line_of_sight, obstructed } = *environment;
        if [a, wavelength, line_of_sight.sigma, obstructed.sigma].iter().any(|x| *x <= T::ZERO) {
            return Err(Error::NotPositive);
        }
        // 20·log₁₀(4π·d/λ) at one metre.
        let free_space = (T::from_f64(4.0) * T::PI / wavelength).ln() * decibels_per_neper::<T>();
        let odds = a * (a * b).exp();
        let channel = Self {
            b: b * degrees_per_radian(),
            odds,
            line_of_sight: Shadowing::new(&line_of_sight, free_space, T::ZERO),
            obstructed: Shadowing::new(&obstructed, free_space, odds.ln()),
        };
        let [near, far] = [&channel.line_of_sight, &channel.obstructed].map(Shadowing::numbers);
        let finite =
            T::all_finite(&[channel.b, odds]) && T::all_finite(&near) && T::all_finite(&far);
        if finite { Ok(channel) } else { Err(Error::NotFinite) }
    }

    /// The same channel with all standard deviations limited to at least `sigma` (dB).
    ///
    /// Directly below the drone, the model's shadowing is a tenth of a decibel, which no radio resolves. A filter that
    /// trusts it diverges at the first decibel of unmodelled error.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::NotPositive`] if `sigma` is not positive.
    #[inline]
    pub fn with_least_sigma(&self, sigma: T) -> Result<Self, Error> {
        if !sigma.is_finite() {
            return Err(Error::NotFinite);
        }
        if sigma <= T::ZERO {
            return Err(Error::NotPositive);
        }
        let limited =
            |shadowing: &Shadowing<T>| Shadowing { most_precise: -sigma.ln(), ..*shadowing };
        let line_of_sight = limited(&self.line_of_sight);
        Ok(Self { line_of_sight, obstructed: limited(&self.obstructed), ..*self })
    }

    /// The path loss at a horizontal distance (m) and a height (m) of the drone relative to the user.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::NotPositive`] for a height that is not positive.
    pub fn path_loss(&self, horizontal_distance: T, height: T) -> Result<PathLoss<T>, Error> {
        if !T::all_finite(&[horizontal_distance, height]) {
            return Err(Error::NotFinite);
        }
        if height <= T::ZERO {
            return Err(Error::NotPositive);
        }
        let (elevation, distance_loss) = geometry(horizontal_distance, height);
        let odds = self.odds * (-self.b * elevation).exp();
        Ok(PathLoss {
            line_of_sight_probability: T::ONE / (T::ONE + odds),
            line_of_sight_mean: self.line_of_sight.loss_at_one_metre + distance_loss,
            line_of_sight_sigma: self.line_of_sight.sigma(elevation),
            obstructed_mean: self.obstructed.loss_at_one_metre + distance_loss,
            obstructed_sigma: self.obstructed.sigma(elevation),
        })
    }

    /// Logarithm of the density (per dB) of the measured loss if the user is at `user` (eq. 2.11).
    ///
    /// It does not decrease any further beyond 127 standard deviations. It has no branches, so that a loop over
    /// particles vectorises, and never underflows, unlike the published sum of densities. The result is not finite if
    /// `user` is not.
    #[inline(always)]
    pub fn log_likelihood(&self, measurement: &Measurement<T>, user: [T; 2]) -> T {
        let distance = measurement.horizontal_distance(user);
        let (elevation, distance_loss) = geometry(distance, measurement.height());
        let excess = measurement.loss() - distance_loss;
        // The two terms of the mixture, each without the common factor P_LoS: P_NLoS = odds · P_LoS.
        let seen = self.line_of_sight.log_density(excess, elevation);
        let fading = self.b * elevation;
        let hidden = self.obstructed.log_density(excess, elevation) - fading;
        let odds = self.odds * (-fading).exp();
        let apart = -(hidden - seen).abs();
        hidden.max(seen) + (T::ONE + apart.exp()).divided_by((T::ONE + odds).divisor()).ln()
    }
}

impl<T: Scalar> Likelihood<T> for Channel<T> {
    #[inline(always)]
    fn log_likelihood(&self, measurement: &Measurement<T>, user: [T; 2]) -> T {
        Self::log_likelihood(self, measurement, user)
    }
}

impl<T: Scalar> Shadowing<T> {
    #[inline(always)]
    fn new(propagation: &Propagation<T>, free_space: T, log_factor: T) -> Self {
        // ln √(2π).
        let log_root_tau = T::from_f64(0.918_938_533_204_672_7);
        Self {
            loss_at_one_metre: free_space + propagation.excess_loss,
            log_inverse_sigma: -propagation.sigma.ln(),
            log_weight: log_factor - log_root_tau,
            decay: propagation.sigma_decay * degrees_per_radian(),
            most_precise: T::MAX,
        }
    }

    fn numbers(&self) -> [T; 4] {
        [self.loss_at_one_metre, self.log_inverse_sigma, self.log_weight, self.decay]
    }

    /// ln 1/σ.
    #[inline(always)]
    fn log_precision(&self, elevation: T) -> T {
        (self.decay * elevation + self.log_inverse_sigma).min(self.most_precise)
    }

    fn sigma(&self, elevation: T) -> T {
        (-self.log_precision(elevation)).exp()
    }

    /// Logarithm of the normal density of the excess of a loss over the distance-dependent part.
    #[inline(always)]
    fn log_density(&self, excess: T, elevation: T) -> T {
        let log_precision = self.log_precision(elevation);
        let sigmas = (excess - self.loss_at_one_metre) * log_precision.exp();
        // 127²/2 is representable in every format that can hold a kilometre.
        let sigmas = sigmas.abs().min(T::from_f64(127.0));
        self.log_weight + log_precision - sigmas * (sigmas * T::HALF)
    }
}

/// Elevation (rad) of the drone above the user's horizon, and 20·log₁₀ of the distance (dB re 1 m).
#[inline(always)]
fn geometry<T: Scalar>(horizontal_distance: T, height: T) -> (T, T) {
    let log_distance = T::ln_norm(&[horizontal_distance, height]);
    (height.atan2(horizontal_distance), log_distance * decibels_per_neper())
}

#[inline(always)]
fn decibels_per_neper<T: Scalar>() -> T {
    T::from_f64(20.0 / core::f64::consts::LN_10)
}

#[inline(always)]
fn degrees_per_radian<T: Scalar>() -> T {
    T::from_f64(180.0 / core::f64::consts::PI)
}
