//! Calls everything of `kestirim-uwb-ranging`.

use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_ranging::{
    AntennaDelay, Broadcast, Calibration, Channel, ClockOffset, DataRate, DoubleSided, Downlink,
    Heard, HeightSearch, Huber, LevelBias, Observation, Quartiles, Room, Search, SingleSided,
    Solver, Ticks, Timestamp, Trilateration, dilution_of_precision, expected_range, position_error,
    survey, trilaterate, weighted_dilution,
};

use super::values::{
    LONG_FORM, any, call_each, keep, matrix, maybe, number, numbers, one_of, option, rounds, slice,
    try_on, whole,
};

fn timestamp() -> Timestamp {
    any(Timestamp::new(whole()))
}

fn ticks() -> Ticks {
    any(Ticks::new(whole()))
}

fn times() {
    keep(Timestamp::from_le_bytes([(); 5].map(|()| whole())));
    keep(Timestamp::to_le_bytes(timestamp()));
    keep(Timestamp::ticks(timestamp()));
    keep(Timestamp::since(timestamp(), timestamp()));
    keep(Timestamp::after(timestamp(), ticks()));
    keep(Ticks::get(ticks()));
    keep(ClockOffset::to_bits(any(ClockOffset::from_bits(whole()))));
    let channels = [Channel::One, Channel::Two, Channel::Three, Channel::Four, Channel::Five];
    let channel = maybe(one_of(channels)).unwrap_or(Channel::Seven);
    let rate = one_of([DataRate::Kbps110, DataRate::Kbps850OrMore]);
    keep(ClockOffset::from_carrier_integrator(whole(), channel, rate));
    keep(ClockOffset::from_intervals(ticks(), ticks()));
    keep(AntennaDelay::ticks(any(AntennaDelay::new(whole()))));
}

fn exchanges<T: Scalar>() {
    let offset = any(ClockOffset::from_ppm(number::<T>()));
    keep::<T>(ClockOffset::ppm(offset));
    let delay = any(AntennaDelay::of_each(number::<T>()));
    if let Ok(delay) = delay {
        keep::<T>(AntennaDelay::excess(delay, any(delay)));
    }
    keep(AntennaDelay::of_three(number::<T>(), number(), number()));
    let (t, ticks) = (timestamp, ticks);
    let single = any(SingleSided::new(t(), t(), t(), t()));
    keep::<T>(SingleSided::distance(&single, offset));
    keep(DoubleSided::new(t(), t(), t(), t(), t(), t()));
    let double =
        any(DoubleSided { round1: ticks(), reply1: ticks(), round2: ticks(), reply2: ticks() });
    keep(DoubleSided::asymmetric::<T>(&double));
    keep::<T>(DoubleSided::symmetric(&double));
    keep(DoubleSided::clock_offset(&double));
}

fn biases<T: Scalar>() {
    keep::<LevelBias<T, 18>>(LevelBias::aps011_prf64());
    keep::<LevelBias<T, 18>>(LevelBias::aps011_prf16());
    keep::<LevelBias<T, 18>>(LevelBias::dw1000_prf64());
    levels::<T, 2>();
    levels::<T, 9>();
    let mut quartiles = any(Quartiles::<T>::within(number(), number()));
    for _ in 0..rounds() {
        Quartiles::add(any(&mut quartiles), number());
    }
    keep(Quartiles::count(&quartiles));
    keep(Quartiles::median(&quartiles));
    keep(Quartiles::deviation(&quartiles));
}

fn levels<T: Scalar, const K: usize>() {
    let Ok(bias) = any(LevelBias::<T, K>::new([any((number(), number())); K])) else { return };
    keep(LevelBias::bias(&bias, number()));
    keep(LevelBias::corrected(&bias, number(), number()));
}

fn rooms<T: Scalar, const D: usize>() {
    keep(expected_range::<T, D>(&matrix(), number(), &matrix()));
    let room = any(Room::plane(number(), number(), number(), number()));
    let room = any(Room::<T> { low: numbers(), ..room });
    keep(Room::contains::<D>(&room, &matrix(), number()));
    let directions = any([numbers::<T, D>(); 4]);
    keep(dilution_of_precision(slice(&directions).iter().copied()));
    let weighted = any([(numbers::<T, D>(), number::<T>()); 4]);
    keep(weighted_dilution(slice(&weighted).iter().copied()));
    let wrong = any([(numbers::<T, D>(), number::<T>(), number::<T>()); 4]);
    keep(position_error(slice(&wrong).iter().copied()));
}

fn solvers<T: Scalar, const D: usize>() {
    let huber = any(Huber { long: number::<T>(), short: number() });
    keep(Huber::threshold(&huber, number()));
    keep(Solver::<T>::new(number()));
    let room = maybe(Room { low: numbers(), high: numbers() });
    let height = number();
    let solver = any(Solver { height, room, common_bias: option(), huber: maybe(huber) });
    let observation = Observation { anchor: matrix(), range: number(), variance: number() };
    let observations = any([observation; 4]);
    keep(Solver::solve::<D>(&solver, slice(&observations), maybe(matrix())));
    keep(trilaterate::<T, D>(slice(&observations), number()));
    for search in [any(Search::<T, D>::new(maybe(matrix()))), any(Search::near(matrix()))] {
        let mut search = search;
        for _ in 0..rounds() {
            let found = Search::advance(&mut search, &solver, slice(&observations), whole());
            keep(found.map(Option::<&_>::copied));
        }
    }
}

fn anchors<T: Scalar, const A: usize>() {
    keep(survey::<T, A>(&any([[option(); A]; A]), &numbers()));
    let Ok(mut calibration) = any(Calibration::<T, A>::new([matrix(); A])) else { return };
    let medians = any([option(); A]);
    for _ in 0..rounds() {
        try_on(&mut calibration, |calibration| {
            Calibration::add_known(calibration, &matrix(), &medians)
        });
        try_on(&mut calibration, |calibration| {
            Calibration::add_unknown::<2>(calibration, number(), &medians)
        });
        try_on(&mut calibration, |calibration| {
            Calibration::add_unknown::<3>(calibration, number(), &medians)
        });
    }
    keep(Calibration::biases(&calibration));
}

fn heights<T: Scalar, const A: usize>() {
    let anchors = any([matrix(); 4]);
    let search = HeightSearch::<T, A>::new(slice(&anchors), number(), number());
    let Ok(mut search) = any(search) else { return };
    for _ in 0..rounds() {
        let ranges = any([option(); A]);
        try_on(&mut search, |search| HeightSearch::add(search, &ranges));
    }
    keep(HeightSearch::places(&search));
    keep(HeightSearch::height(&search));
}

fn messages<T: Scalar, const A: usize>() {
    let downlink = Downlink::<T, A>::new([matrix(); A], number(), number());
    let Ok(mut downlink) = any(downlink) else { return };
    for _ in 0..rounds() {
        let heard = any([Heard { anchor: whole(), sequence: whole(), received: timestamp() }; 4]);
        let message = Broadcast {
            time_us: whole(),
            anchor: whole(),
            sequence: whole(),
            sent: timestamp(),
            received: timestamp(),
            heard: slice(&heard),
        };
        try_on(&mut downlink, |downlink| Downlink::take(downlink, &message));
    }
    keep(Downlink::clock_offset(&downlink, whole()));
}

fn triangles<T: Scalar, const A: usize, const D: usize>() {
    let Ok(cell) = any(Trilateration::<T, A, D>::new([matrix(); A])) else { return };
    keep(Trilateration::position(&cell, &numbers(), number()));
}

fn all_of<T: Scalar>() {
    call_each([
        exchanges::<T>,
        biases::<T>,
        rooms::<T, 2>,
        rooms::<T, 3>,
        solvers::<T, 2>,
        solvers::<T, 3>,
        anchors::<T, 4>,
        anchors::<T, 9>,
        heights::<T, 4>,
        messages::<T, 4>,
        messages::<T, 9>,
        triangles::<T, 4, 2>,
        triangles::<T, 9, 3>,
    ]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>]);
    }
    call_each([times, all_of::<Q12_20>]);
}
