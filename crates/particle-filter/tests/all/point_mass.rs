//! The point-mass filter compared with integrals.

use kestirim_particle_filter::{Error, PointMass, Region};
use kestirim_scalar::{Q16_16, Scalar};

fn bell<T: Scalar>(state: [T; 2], centre: [f64; 2], sigma: [f64; 2]) -> T {
    let sigmas = [0, 1].map(|axis| {
        let distance: T = (state[axis] - T::from_f64(centre[axis])) / T::from_f64(sigma[axis]);
        distance.clamp(T::from_f64(-30.0), T::from_f64(30.0))
    });
    -T::dot(&sigmas, &sigmas) * T::HALF
}

fn check<T: Scalar>(tolerance: f64) -> Result<(), Error> {
    let region = Region::new([T::from_f64(-100.0); 2], [T::from_f64(100.0); 2])?;
    let mut filter = PointMass::<T, 2, 500>::new(&region);
    let (centre, sigma) = ([13.7, -21.3], [3.0, 5.0]);
    let posterior = |point| bell::<T>(point, centre, sigma);
    filter.update(posterior)?;
    // Two refinements, starting from a cell wider than the posterior.
    for _ in 0..2 {
        let Some(finer) = filter.finer(T::from_f64(12.0)) else { break };
        filter = finer;
        filter.update(posterior)?;
    }
    let moments = filter.moments();
    for axis in 0..2 {
        assert!((moments.mean()[axis].to_f64() - centre[axis]).abs() < tolerance);
        assert!((moments.deviation()[axis].to_f64() / sigma[axis] - 1.0).abs() < tolerance);
    }
    assert!(filter.effective().to_f64() > 20.0);
    // The density at the border of the 90 % region of a normal distribution in the plane is a tenth
    // of the largest.
    let level = filter.density_level(T::from_f64(0.9)).to_f64();
    assert!((level - 0.1_f64.ln()).abs() < 0.15, "{level}");
    Ok(())
}

#[test]
fn a_narrow_bell_is_found_and_measured() -> Result<(), Error> {
    check::<f64>(1e-3)?;
    check::<f32>(1e-3)?;
    check::<Q16_16>(0.02)
}

#[test]
fn an_axis_without_width_is_not_refined_for_ever() -> Result<(), Error> {
    let region = Region::new([0.0, 5.0], [1.0, 5.0])?;
    let mut filter = PointMass::<f64, 2, 100>::new(&region);
    assert!(filter.finer(12.0).is_none());
    filter.update(|[x, _]| -0.5 * ((x - 0.3) / 0.01_f64).powi(2))?;
    let finer = filter.finer(12.0).expect("a finer lattice");
    assert!(finer.region().width()[0] < 0.2 && finer.region().width()[1] == 0.0);
    Ok(())
}

#[test]
fn nothing_is_refined_that_fills_the_region() -> Result<(), Error> {
    let region = Region::new([0.0, 0.0], [1.0, 1.0])?;
    let mut filter = PointMass::<f64, 2, 100>::new(&region);
    assert!(filter.finer(12.0).is_none());
    assert_eq!(filter.region(), &region);
    assert_eq!(filter.update(|_| f64::NAN), Err(Error::Degenerate));
    assert!((filter.effective() - 100.0).abs() < 1e-9);
    assert_eq!(filter.point(100), None);
    assert!(filter.point(99).is_some_and(|point| region.contains(&point)));
    Ok(())
}
