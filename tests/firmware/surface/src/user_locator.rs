//! Calls everything of `kestirim-user-locator`.

use core::fmt::Debug;

use kestirim_air_to_ground::{
    Channel, Contaminated, Environment, FreeSpace, Heading, LevelPrior, Likelihood, Measurement,
    OpenGround,
};
use kestirim_particle_filter::{Region, Resampler};
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_user_locator::{
    Area, Beacon, BeaconEstimate, BeaconSearch, ByPlace, Error, GroundSearch, Height, LevelStep,
    Locator, Motion, Orbit, PublishedLocator, PublishedSettings, Thinned, TrackEstimate, Tracker,
    Within,
};

use super::values::{
    AnyRng, LONG_FORM, any, call_each, keep, maybe, number, numbers, one_of, option, rounds, slice,
    try_on, whole, yes_or_no,
};

fn region<T: Scalar, const D: usize>() -> Option<Region<T, D>> {
    any(Region::new(numbers(), numbers()).ok())
}

fn measurement<T: Scalar>() -> Option<Measurement<T>> {
    any(Measurement::new(numbers(), number(), number()).ok())
}

fn channel<T: Scalar>() -> Option<Channel<T>> {
    any(Channel::new(&any(Environment::urban()), number()).ok())
}

fn locates<
    T: Scalar,
    C: Likelihood<T> + Copy + Debug,
    const L: usize,
    const M: usize,
    const D: usize,
>(
    channel: C,
) -> Option<()> {
    let (region, measurement) = (region()?, measurement()?);
    keep(Locator::<T, L, M, D, C>::new(channel, &region));
    let locator = Locator::<T, L, M, D, C>::with_count(whole(), channel, &region);
    let mut locator = any(locator).ok()?;
    for _ in 0..rounds() {
        try_on(&mut locator, |locator| Locator::measure(locator, &measurement));
    }
    keep(Locator::moments(&locator));
    keep(Locator::posterior(&locator));
    keep(Locator::log_posterior(&locator, &numbers()));
    keep(Locator::credible(&locator, &numbers(), number()));
    keep(Locator::health(&locator));
    Some(())
}

fn levels<T: Scalar, const L: usize, const M: usize>() -> Option<()> {
    let mut locator = any(Locator::<T, L, M, 3>::new(channel()?, &region()?));
    let measurement = measurement()?;
    for _ in 0..rounds() {
        try_on(&mut locator, |locator| Locator::measure(locator, &measurement));
    }
    keep(Locator::log_posterior_of_levels(&locator, numbers(), &numbers::<T, 5>()));
    Some(())
}

fn locators<T: Scalar, const L: usize, const M: usize, const D: usize>() {
    let Some(channel) = channel::<T>() else { return };
    keep(locates::<T, _, L, M, D>(channel));
    let Ok(doubted) = any(Contaminated::new(channel, number())) else { return };
    keep(locates::<T, _, L, M, D>(doubted));
    keep(publishes::<T, L>(channel));
    keep(levels::<T, L, M>());
}

fn publishes<T: Scalar, const L: usize>(channel: Channel<T>) -> Option<()> {
    let (region, measurement) = (region()?, measurement()?);
    let settings = any(PublishedSettings::thesis());
    let settings = any(PublishedSettings {
        resampler: one_of([Resampler::Multinomial, Resampler::Systematic]),
        ..settings
    });
    keep(PublishedLocator::<T, L>::new(channel, &region, settings, &mut AnyRng));
    let (count, rng) = (whole(), &mut AnyRng);
    let published = PublishedLocator::<T, L>::with_count(count, channel, &region, settings, rng);
    let mut published = any(published).ok()?;
    for _ in 0..rounds() {
        try_on(&mut published, |published| PublishedLocator::measure(published, &measurement, rng));
    }
    keep(PublishedLocator::moments(&published));
    keep(PublishedLocator::particles(&published));
    Some(())
}

fn finds<T: Scalar, const M: usize, const L: usize>() -> Option<()> {
    let (region, measurement) = (region()?, measurement()?);
    let mut beacon = any(Beacon::<T, M>::new(FreeSpace::new(maybe(LevelPrior {
        mean: number(),
        sigma: number(),
    }))));
    for _ in 0..rounds() {
        try_on(&mut beacon, |beacon| Beacon::measure(beacon, &measurement));
    }
    let inside = |place: [T; 2]| {
        keep(place);
        yes_or_no()
    };
    let estimate = any(Beacon::estimate::<L>(&beacon, &region, inside)).ok()?;
    keep(BeaconEstimate::moments(&estimate));
    keep(BeaconEstimate::sigma(&estimate));
    keep(Beacon::credible(&beacon, &estimate, numbers(), number(), inside));
    keep(Beacon::health(&beacon, &estimate));
    Some(())
}

fn beacons<T: Scalar, const M: usize, const L: usize>() {
    keep(finds::<T, M, L>());
}

fn areas<T: Scalar, const N: usize>() -> Option<()> {
    let corners = any([(); N].map(|()| numbers::<T, 2>()));
    let area = match any(Area::<T, N>::new(slice(&corners))) {
        Ok(area) => area,
        Err(_) => any(Area::rectangle(&region()?)).ok()?,
    };
    keep(Area::corners(&area));
    keep(Area::region(&area));
    keep(Area::size(&area));
    keep(Area::contains(&area, numbers()));
    let area = any(Area::relative_to(&area, numbers())).ok()?;
    let within = any(Within::new(channel()?, &area));
    keep(Likelihood::log_likelihood(&within, &measurement()?, numbers()));
    keep(Likelihood::log_likelihood_again(&within, &measurement()?, numbers()));
    keep(grounds::<T, N, 9>(area.clone()));
    searches::<T, N, 9>(area)
}

fn searches<T: Scalar, const N: usize, const L: usize>(area: Area<T, N>) -> Option<()> {
    let level = maybe(LevelPrior { mean: number(), sigma: number() });
    let mut search = any(BeaconSearch::<T, 5, N>::new(FreeSpace::new(level), area));
    for _ in 0..rounds() {
        if let Some(measurement) = measurement() {
            BeaconSearch::measure(any(&mut search), &measurement);
        }
    }
    keep(BeaconSearch::measurements(&search));
    keep(BeaconSearch::area(&search));
    let estimate = any(BeaconSearch::estimate::<L>(&search)).ok()?;
    keep(BeaconSearch::credible(&search, &estimate, numbers(), number()));
    keep(BeaconSearch::health(&search, &estimate));
    keep(LevelStep::find(BeaconSearch::measurements(&search), numbers()));
    Some(())
}

fn grounds<T: Scalar, const N: usize, const L: usize>(area: Area<T, N>) -> Option<()> {
    let level = maybe(LevelPrior { mean: number(), sigma: number() });
    let mut search = any(GroundSearch::<T, 5, N>::new(OpenGround::new(level), area));
    keep(ByPlace::<T, 3>::new());
    let mut places = any(<ByPlace<T, 3> as Default>::default());
    for _ in 0..rounds() {
        if let Some(measurement) = measurement() {
            GroundSearch::measure(any(&mut search), &measurement);
            if let Ok(heading) = any(Heading::new(number())) {
                GroundSearch::measure_with_heading(any(&mut search), &measurement, &heading);
                ByPlace::push(any(&mut places), &measurement, &heading);
            }
        }
    }
    keep(ByPlace::as_slice(&places));
    keep(ByPlace::headings(&places));
    keep(ByPlace::near(&places));
    keep(GroundSearch::measurements(&search));
    keep(GroundSearch::area(&search));
    let estimate = any(GroundSearch::estimate::<L>(&search)).ok()?;
    keep(GroundSearch::credible(&search, &estimate, numbers(), number()));
    keep(GroundSearch::next_waypoint(&search, &estimate, number()));
    keep(GroundSearch::health(&search, &estimate));
    Some(())
}

fn confined<T: Scalar, const N: usize>() {
    keep(areas::<T, N>());
    keep(Thinned::<T, 3>::new());
    let mut thinned = any(<Thinned<T, 3> as Default>::default());
    for _ in 0..rounds() {
        Thinned::push(any(&mut thinned), number());
    }
    keep(Thinned::as_slice(&thinned));
    keep(Thinned::count(&thinned));
}

fn motion<T: Scalar>() -> Motion<T> {
    keep::<Motion<T>>(Motion::people());
    let motion = any(Motion::people_measured_to(number()));
    any(Motion { speed: number(), least_evidence: option(), ..motion })
}

fn tracks<T: Scalar, C: Likelihood<T> + Copy + Debug, const L: usize>(channel: C) -> Option<()> {
    let (region, measurement, rng) = (region()?, measurement()?, &mut AnyRng);
    keep(Tracker::<T, L, C>::new(channel, motion(), &region, rng));
    let tracker = Tracker::<T, L, C>::with_count(whole(), channel, motion(), &region, rng);
    let mut tracker = any(tracker).ok()?;
    for _ in 0..rounds() {
        try_on(&mut tracker, |tracker| Tracker::predict(tracker, number(), rng));
        try_on(&mut tracker, |tracker| Tracker::measure(tracker, &measurement, rng));
    }
    keep(Tracker::estimate(&tracker));
    keep(Tracker::moments(&tracker));
    keep(Tracker::particles(&tracker));
    Some(())
}

fn trackers<T: Scalar, const L: usize>() {
    let Some(channel) = channel::<T>() else { return };
    keep(tracks::<T, _, L>(channel));
    let Ok(doubted) = any(Contaminated::new(channel, number())) else { return };
    keep(tracks::<T, _, L>(doubted));
}

fn orbits<T: Scalar>() {
    let mut orbit =
        any(Orbit::new(one_of([Height::Fixed(number()), Height::Between(number(), number())])));
    let (place, velocity, spread) = (numbers::<T, 2>(), numbers(), number());
    let estimate = any(TrackEstimate { place, velocity, spread });
    keep(Orbit::next(any(&mut orbit), &estimate, number()));
    keep::<Error>(From::from(any(kestirim_air_to_ground::Error::NotFinite)));
    keep::<Error>(From::from(any(kestirim_particle_filter::Error::NotFinite)));
}

/// The particle filter, from which the sizes come, is called with several by itself.
fn all_of<T: Scalar>() {
    if LONG_FORM {
        call_each([locators::<T, 64, 8, 2>]);
    }
    call_each([
        locators::<T, 9, 3, 3>,
        beacons::<T, 3, 9>,
        confined::<T, 9>,
        trackers::<T, 9>,
        orbits::<T>,
    ]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>]);
    }
    call_each([all_of::<Q16_16>]);
}
