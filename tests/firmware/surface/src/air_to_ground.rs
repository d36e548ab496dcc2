//! Calls everything of `kestirim-air-to-ground`.

use kestirim_air_to_ground::{
    Channel, Contaminated, Environment, FreeSpace, GroundFit, Heading, LevelPrior, Likelihood,
    Measurement, OpenGround, PathLoss, Propagation, Rotor,
};
use kestirim_scalar::{Q16_16, Scalar};

use super::values::{LONG_FORM, any, call_each, keep, maybe, number, numbers, slice};

fn environment<T: Scalar>() -> Environment<T> {
    let way = || Propagation { excess_loss: number(), sigma: number(), sigma_decay: number() };
    any(Environment { a: number(), b: number(), line_of_sight: way(), obstructed: way() })
}

fn environments<T: Scalar>() {
    keep::<Environment<T>>(Environment::suburban());
    keep::<Environment<T>>(Environment::urban());
    keep::<Environment<T>>(Environment::dense_urban());
    keep::<Environment<T>>(Environment::high_rise());
}

fn measurement<T: Scalar>() -> Option<Measurement<T>> {
    let measurement = any(Measurement::new(numbers(), number(), number()).ok()?);
    keep(Measurement::place(&measurement));
    keep(Measurement::height(&measurement));
    keep(Measurement::loss(&measurement));
    keep(Measurement::less(&measurement, number()));
    keep(Measurement::horizontal_distance(&measurement, numbers()));
    Some(measurement)
}

fn channels<T: Scalar>() {
    let Some(measurement) = measurement::<T>() else { return };
    let Ok(channel) = any(Channel::<T>::new(&environment(), number())) else { return };
    keep(Channel::with_least_sigma(&channel, number()));
    keep(Channel::log_likelihood(&channel, &measurement, numbers()));
    keep(<Channel<T> as Likelihood<T>>::log_likelihood(&channel, &measurement, numbers()));
    keep(<Channel<T> as Likelihood<T>>::log_likelihood_again(&channel, &measurement, numbers()));
    if let Ok(loss) = any(Channel::path_loss(&channel, number(), number())) {
        keep(PathLoss::mean(&loss));
        keep(PathLoss::sigma(&loss));
    }
    let Ok(doubted) = any(Contaminated::new(channel, number())) else { return };
    keep(<Contaminated<T> as Likelihood<T>>::log_likelihood(&doubted, &measurement, numbers()));
}

fn free_space<T: Scalar>() {
    let Some(measurement) = measurement::<T>() else { return };
    let measurements = any([measurement; 4]);
    let measurements = slice(&measurements);
    let prior = maybe(LevelPrior { mean: number(), sigma: number() });
    let channel = any(FreeSpace::<T>::new(prior));
    keep(FreeSpace::fitted(&channel, measurements, numbers()));
    keep(FreeSpace::doubtful(&channel));
    keep(FreeSpace::log_likelihood(&channel, measurements, numbers(), number()));
    keep(FreeSpace::level(&channel, measurements, numbers()));
}

fn heading<T: Scalar>() -> Option<Heading<T>> {
    let heading = any(Heading::new(number()).ok()?);
    keep(Heading::is_known(&heading));
    Some(any(Heading::mean(&heading, &Heading::unknown(), number())))
}

fn open_ground<T: Scalar>() {
    let (Some(measurement), Some(heading)) = (measurement::<T>(), heading()) else { return };
    let headings = any([heading; 4]);
    let headings = slice(&headings);
    let measurements = any([measurement; 4]);
    let measurements = slice(&measurements);
    let prior = maybe(LevelPrior { mean: number(), sigma: number() });
    let channel = any(OpenGround::<T>::new(prior));
    let mut suppositions = any(OpenGround::suppositions(&channel, measurements, headings));
    let Some(first) = suppositions.next() else { return };
    let mut all = any([first; 3]);
    for (room, supposition) in all.iter_mut().zip(suppositions) {
        *room = supposition;
    }
    let all = slice(&all);
    for supposition in all {
        let power = number();
        let fit = OpenGround::fit(&channel, measurements, headings, numbers(), supposition, power);
        keep(GroundFit::expected(&any(fit), supposition, numbers(), numbers(), number()));
    }
    let (place, power) = (numbers(), number());
    let told = |index: usize, log: T| keep((index, log));
    keep(OpenGround::log_likelihood(&channel, measurements, headings, place, power, all, told));
}

fn rotors<T: Scalar>() {
    let rotor = any(Rotor::<T>::base_station());
    let rotor = any(Rotor { weight: number(), ..rotor });
    keep(Rotor::power(&rotor, number()));
    keep(Rotor::induced_speed(&rotor, number()));
    keep(Rotor::energy(&rotor, number(), number(), number()));
}

fn all_of<T: Scalar>() {
    call_each([environments::<T>, channels::<T>, free_space::<T>, open_ground::<T>, rotors::<T>]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>]);
    }
    call_each([all_of::<Q16_16>]);
}
