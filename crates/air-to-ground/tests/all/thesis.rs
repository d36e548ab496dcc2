//! The channel against the equations as printed on the card, and the energies of the thesis.

use kestirim_air_to_ground::{Channel, Environment, Error, Measurement, Rotor};
use std::f64::consts::PI;

/// The published equations, one by one.
fn density(environment: &Environment<f64>, distance: f64, height: f64, loss: f64) -> f64 {
    let theta = (height / distance).atan().to_degrees();
    let slant = (height * height + distance * distance).sqrt();
    let p = 1.0 / (1.0 + environment.a * (-environment.b * (theta - environment.a)).exp());
    let free_space = 20.0 * (4.0 * PI * slant * 2e9 / 3e8).log10();
    let normal = |mean: f64, sigma: f64| {
        (-((loss - mean) / sigma).powi(2) / 2.0).exp() / (sigma * (2.0 * PI).sqrt())
    };
    let near = environment.line_of_sight;
    let far = environment.obstructed;
    p * normal(free_space + near.excess_loss, near.sigma * (-near.sigma_decay * theta).exp())
        + (1.0 - p)
            * normal(free_space + far.excess_loss, far.sigma * (-far.sigma_decay * theta).exp())
}

fn environments() -> [Environment<f64>; 4] {
    [
        Environment::suburban(),
        Environment::urban(),
        Environment::dense_urban(),
        Environment::high_rise(),
    ]
}

#[test]
fn the_likelihood_is_that_of_the_equations() -> Result<(), Error> {
    for environment in environments() {
        let channel = Channel::new(&environment, 0.15)?;
        for (distance, height) in [(1.0, 50.0), (300.0, 500.0), (1400.0, 200.0), (2800.0, 1400.0)] {
            let expected = channel.path_loss(distance, height)?;
            for step in -8..=8 {
                let loss = expected.mean() + f64::from(step) * expected.sigma() / 2.0;
                let exact = density(&environment, distance, height, loss);
                if exact < 1e-290 {
                    continue;
                }
                let measurement = Measurement::new([100.0, -70.0], height, loss)?;
                let user = [100.0 + 0.6 * distance, -70.0 + 0.8 * distance];
                let ours = channel.log_likelihood(&measurement, user);
                assert!((ours - exact.ln()).abs() < 1e-10 * exact.ln().abs().max(1.0), "{ours}");
            }
        }
    }
    Ok(())
}

#[test]
fn the_density_integrates_to_one_with_the_stated_moments() -> Result<(), Error> {
    for environment in environments() {
        let channel = Channel::new(&environment, 0.15)?;
        for (distance, height) in [(50.0, 500.0), (700.0, 500.0), (1500.0, 200.0)] {
            let expected = channel.path_loss(distance, height)?;
            let (mut sum, mut mean, mut square) = (0.0, 0.0, 0.0);
            for step in 0..600_000 {
                let loss = -290.0 + f64::from(step) * 0.001 * 0.98;
                let measurement = Measurement::new([0.0, 0.0], height, loss)?;
                let weight =
                    channel.log_likelihood(&measurement, [distance, 0.0]).exp() * 0.001 * 0.98;
                sum += weight;
                mean += weight * loss;
                square += weight * (loss - expected.mean()).powi(2);
            }
            assert!((sum - 1.0).abs() < 1e-4, "{sum}");
            assert!((mean - expected.mean()).abs() < 0.05, "{mean}");
            assert!((square.sqrt() / expected.sigma() - 1.0).abs() < 2e-3);
        }
    }
    Ok(())
}

#[test]
fn bad_measurements_have_their_errors() {
    let new = |height, loss| Measurement::new([0.0, 0.0], height, loss);
    assert_eq!(new(500.0, f64::NAN), Err(Error::NotFinite));
    assert_eq!(new(500.0, f64::INFINITY), Err(Error::NotFinite));
    assert_eq!(new(f64::NEG_INFINITY, 90.0), Err(Error::NotFinite));
    assert_eq!(new(500.0, 1e6), Err(Error::ImplausibleLoss));
    assert_eq!(new(-1.0, 90.0), Err(Error::NotPositive));
    assert_eq!(Measurement::new([f64::NAN, 0.0], 500.0, 90.0), Err(Error::NotFinite));
    let channel = |environment, wavelength| Channel::new(&environment, wavelength);
    assert_eq!(channel(Environment::urban(), 0.0), Err(Error::NotPositive));
    assert_eq!(channel(Environment::urban(), f64::NAN), Err(Error::NotFinite));
    let huge = Environment { a: 1e3, b: 10.0, ..Environment::urban() };
    assert_eq!(channel(huge, 0.15), Err(Error::NotFinite));
}

/// Distance (m) and hovering time (s) of a circle of radius D/3 with T points (eq. 2.16).
fn circle(points: f64, stop_s: f64) -> (f64, f64) {
    let chord = 2_f64.sqrt() * 2000.0 / 3.0 * (1.0 - (2.0 * PI / points).cos()).sqrt();
    ((points - 1.0) * chord, points * stop_s)
}

#[test]
fn the_energies_follow_from_the_published_formulas() -> Result<(), Error> {
    let rotor = Rotor::<f64>::base_station();
    let speed = 40.0 / 3.6;
    assert!((rotor.power(0.0)? - 1021.75).abs() < 0.01);
    assert!((rotor.power(speed)? - 1245.8).abs() < 0.1);
    let (distance, hover) = circle(4.0, 5.0);
    assert!((rotor.energy(distance, speed, hover)? - 337_600.0).abs() < 100.0);
    assert_eq!(rotor.energy(1.0, 0.0, 0.0), Err(Error::NotPositive));
    assert_eq!(rotor.energy(f64::NAN, 1.0, 0.0), Err(Error::NotFinite));
    Ok(())
}

#[test]
fn the_published_energies_follow_from_three_other_numbers() {
    const POWER: f64 = 1125.0;
    const STOP: f64 = 6314.0;
    let circles =
        [(4.0, 312e3, 500.0), (9.0, 426e3, 500.0), (16.0, 496e3, 500.0), (25.0, 564e3, 500.0)];
    for (points, published, rounding) in circles {
        let energy = circle(points, 5.0).0 / (40.0 / 3.6) * POWER + points * STOP;
        assert!((energy - published).abs() <= rounding, "circle {points}: {energy}");
    }
    for (points, published, rounding) in
        [(4.0_f64, 329e3, 500.0), (9.0, 597e3, 500.0), (16.0, 860e3, 500.0), (25.0, 1130e3, 5000.0)]
    {
        let spacing = 2000.0 / points.sqrt();
        let energy = (points - 1.0) * spacing / (40.0 / 3.6) * POWER + points * STOP;
        assert!((energy - published).abs() <= rounding, "grid {points}: {energy}");
    }
}
