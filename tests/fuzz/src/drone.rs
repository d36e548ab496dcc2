//! Feeds arbitrary path losses to a drone's filter, in three number types: each is refused, or the position stays
//! finite.

use arbitrary::{Result, Unstructured};
use kestirim_air_to_ground::{Channel, Environment, Measurement};
use kestirim_particle_filter::Region;
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_user_locator::Locator;

use super::number;

fn feed_in<T: Scalar>(bytes: &[u8]) -> Result<()> {
    let channel = Channel::new(&Environment::<T>::urban(), T::from_f64(0.15)).expect("a channel");
    let side = T::from_f64(2000.0);
    let region = Region::new([T::ZERO; 2], [side; 2]).expect("a square");
    let mut locator = Locator::<T, 100, 10>::new(channel, &region);
    let mut bytes = Unstructured::new(bytes);
    while !bytes.is_empty() {
        let place = [number(&mut bytes, 2000.0)?, number(&mut bytes, 2000.0)?].map(T::from_f64);
        let height = T::from_f64(number(&mut bytes, 1000.0)?);
        let loss = T::from_f64(100.0 + number(&mut bytes, 50.0)?);
        if let Ok(measurement) = Measurement::new(place, height, loss) {
            // A measurement that no point explains is refused.
            let _ = locator.measure(&measurement);
        }
        let moments = locator.moments();
        assert!(moments.mean().iter().all(|x| x.is_finite()) && moments.spread().is_finite());
    }
    Ok(())
}

/// Feeds these bytes.
pub fn feed(bytes: &[u8]) {
    let _ = feed_in::<f32>(bytes);
    let _ = feed_in::<f64>(bytes);
    let _ = feed_in::<Q16_16>(bytes);
}
