//! Errors of the likelihood in single precision and in fixed point relative to double precision.

use kestirim_air_to_ground::{Channel, Environment, Error, Measurement, Rotor};
use kestirim_scalar::{Q16_16, Scalar};

/// Sorted errors over distances, heights, environments and losses.
fn errors<T: Scalar>() -> Result<Vec<f64>, Error> {
    let exact: [Environment<f64>; 4] = [
        Environment::suburban(),
        Environment::urban(),
        Environment::dense_urban(),
        Environment::high_rise(),
    ];
    let ours: [Environment<T>; 4] = [
        Environment::suburban(),
        Environment::urban(),
        Environment::dense_urban(),
        Environment::high_rise(),
    ];
    let mut errors = Vec::new();
    for (exact, ours) in exact.iter().zip(&ours) {
        let exact = Channel::new(exact, 0.15)?;
        let ours = Channel::new(ours, T::from_f64(0.15))?;
        for height in [50.0, 120.0, 200.0, 500.0, 1000.0, 1500.0] {
            for distance in (0..60).map(|step| f64::from(step) * 50.0 + 3.0) {
                let expected = exact.path_loss(distance, height)?;
                for sigmas in -10..=10 {
                    let loss = expected.mean() + f64::from(sigmas) * expected.sigma() / 2.0;
                    // Numbers that are exact in every format, so that only the likelihood has an error.
                    let loss = (loss.clamp(-250.0, 250.0) * 64.0).round() / 64.0;
                    let want = exact.log_likelihood(
                        &Measurement::new([-500.0, 250.0], height, loss)?,
                        [distance - 500.0, 250.0],
                    );
                    let number = T::from_f64;
                    let got = ours.log_likelihood(
                        &Measurement::new(
                            [number(-500.0), number(250.0)],
                            number(height),
                            number(loss),
                        )?,
                        [number(distance - 500.0), number(250.0)],
                    );
                    errors.push((got.to_f64() - want).abs() / want.abs().max(5.0));
                }
            }
        }
    }
    errors.sort_by(f64::total_cmp);
    Ok(errors)
}

fn check<T: Scalar>(median: f64, largest: f64) -> Result<(), Error> {
    let errors = errors::<T>()?;
    let (middle, last) = (errors[errors.len() / 2], errors[errors.len() - 1]);
    println!("median {middle:.2e}, largest {last:.2e}");
    assert!(middle < median && last < largest, "{middle} {last}");
    Ok(())
}

#[test]
fn single_precision() -> Result<(), Error> {
    check::<f32>(1e-5, 1e-3)
}

#[test]
fn fixed_point() -> Result<(), Error> {
    check::<Q16_16>(1e-3, 2e-2)
}

#[test]
fn what_is_impossible_is_very_unlikely_but_still_a_number() -> Result<(), Error> {
    fn check<T: Scalar>() -> Result<(), Error> {
        let channel = Channel::new(&Environment::urban(), T::from_f64(0.15))?;
        for loss in [-300.0, 300.0] {
            let measurement =
                Measurement::new([T::ZERO; 2], T::from_f64(1400.0), T::from_f64(loss))?;
            let likelihood = channel.log_likelihood(&measurement, [T::ZERO; 2]).to_f64();
            assert!((-8100.0..-1000.0).contains(&likelihood), "{likelihood}");
        }
        Ok(())
    }
    check::<f32>()?;
    check::<f64>()?;
    check::<Q16_16>()
}

#[test]
fn power_in_fixed_point() -> Result<(), Error> {
    let (fixed, exact) = (Rotor::<Q16_16>::base_station(), Rotor::<f64>::base_station());
    for speed in [0.0, 1.0, 11.111, 20.0, 40.0] {
        let power = fixed.power(Q16_16::from_f64(speed))?.to_f64();
        assert!((power / exact.power(speed)? - 1.0).abs() < 1e-3, "{speed}");
    }
    assert_eq!(fixed.power(Q16_16::from_f64(200.0)), Err(Error::NotFinite));
    Ok(())
}
