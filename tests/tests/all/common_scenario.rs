//! The common scenario on which filters are compared: a tag moves on an ellipse among four anchors, and its position
//! and velocity are tracked from four ranges every 0.1 s.

use anyhow::Result;
use host_sim::random::{normal, stream};
use kestirim_scalar::{Q8_24, Q12_20, Q16_16, Scalar};
use kestirim_tests::common_scenario::Ekf;
use target_bench::streams::{ANCHORS, Common};

/// The largest distance between the positions and the reference, m.
fn apart<T: Scalar>(ranges: &[[f64; 4]], reference: &[[f64; 4]]) -> f64 {
    let mut filter = Ekf::<T>::new(0.1);
    let distance = |(ranges, theirs): (&[f64; 4], &[f64; 4])| {
        let ours = filter.step(ranges);
        (ours[0] - theirs[0]).hypot(ours[1] - theirs[1])
    };
    ranges.iter().zip(reference).map(distance).fold(0.0, f64::max)
}

#[test]
fn the_reference_is_met() -> Result<()> {
    let common = Common::read()?;
    let Some(reference) = common.reference else { return Ok(()) };
    let most = [
        ("f64", apart::<f64>(&common.ranges, &reference.states), 1e-9),
        ("f32", apart::<f32>(&common.ranges, &reference.states), 2e-5),
        ("q8.24", apart::<Q8_24>(&common.ranges, &reference.states), 0.5e-3),
        ("q12.20", apart::<Q12_20>(&common.ranges, &reference.states), 0.5e-3),
        ("q16.16", apart::<Q16_16>(&common.ranges, &reference.states), 5e-3),
    ];
    for (scalar, apart, _) in most {
        println!("{scalar}: at most {apart:.2e} m from the reference in double precision");
    }
    for (scalar, apart, most) in most {
        assert!(apart <= most, "{scalar}: {apart} m");
    }
    Ok(())
}

/// The root mean square error of the position over `steps` steps, m.
fn rmse<T: Scalar>(sigma: f64, steps: u32) -> f64 {
    let mut rng = stream(7, 0);
    let mut filter = Ekf::<T>::new(sigma);
    let mut square = |step: u32| {
        let angle = 0.04 * f64::from(step);
        let [x, y] = [5.0 + 3.0 * angle.cos(), 4.0 + 2.0 * angle.sin()];
        let ranges = ANCHORS.map(|[a, b]| (x - a).hypot(y - b) + normal(&mut rng, sigma));
        let [px, py, ..] = filter.step(&ranges);
        (px - x).powi(2) + (py - y).powi(2)
    };
    ((1..=steps).map(&mut square).sum::<f64>() / f64::from(steps)).sqrt()
}

#[test]
fn numbers_lose_little_over_a_hundred_thousand_steps() {
    for sigma in [0.01, 0.03, 0.1, 0.3] {
        let reference = rmse::<f64>(sigma, 100_000);
        let loss = |rmse: f64| rmse / reference - 1.0;
        let [single, wide, fine] =
            [rmse::<f32>, rmse::<Q12_20>, rmse::<Q8_24>].map(|rmse| loss(rmse(sigma, 100_000)));
        let coarse = loss(rmse::<Q16_16>(sigma, 100_000));
        println!(
            "σ = {sigma} m: f64 {reference:.5} m; f32 {single:+.1e}, q8.24 {fine:+.1e}, q12.20 {wide:+.1e}, q16.16 {coarse:+.1e}"
        );
        assert!(wide < 0.005, "σ = {sigma} m: Q12.20 loses {wide}");
        assert!(single < 1e-4, "σ = {sigma} m: f32 loses {single}");
        assert!(fine < 0.0005, "σ = {sigma} m: Q8.24 loses {fine}");
        // The resolution of Q16.16, 15 µm, is coarse relative to a hundredth of a metre.
        assert!(coarse < 0.08, "σ = {sigma} m: Q16.16 loses {coarse}");
    }
}
