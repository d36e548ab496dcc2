//! A user who walks a circle.

use super::super::film::Frame;
use super::super::moving_user::{Outcome, Policy, SIDE_M, Walk, film};
use super::figures::Film;
use super::remembered::Remembered;
use super::{common, environment, resampler, resampling};
use crate::Error;
use crate::explore::{Answer, Control, Explorer, Settings};

/// Most steps of a walk.
const MOST_STEPS: f64 = 1000.0;

/// A drone that follows.
#[derive(Debug, Default)]
pub(super) struct Moving {
    last: Remembered<(Walk, u64), (Vec<Frame>, Outcome)>,
}

impl Explorer for Moving {
    fn controls(&self) -> Vec<Control> {
        let mut controls = vec![
            Control::playable("step", "step", "", [1.0, MOST_STEPS, 1.0], 50.0),
            Control::choice(
                "flight",
                "the drone",
                &[
                    ("orbit", "circles the estimate (ours)"),
                    ("low", "the same, 100 to 1000 m high"),
                    ("hover", "hovers over it (thesis' filter)"),
                ],
            ),
            resampling(),
            Control::slider(
                "user_radius",
                "radius of the user's circle",
                "m",
                [0.0, 2000.0, 50.0],
                1000.0,
            ),
            Control::slider("end_time", "steps of the walk", "", [100.0, MOST_STEPS, 20.0], 500.0),
            Control::slider(
                "noise",
                "noise that the filter does not know of",
                "dB",
                [0.0, 5.0, 0.1],
                0.0,
            ),
            Control::slider("speed", "speed of the drone", "km/h", [20.0, 80.0, 5.0], 40.0),
        ];
        controls.extend(common(1000.0, 500.0));
        controls
    }

    fn answer(&self, settings: &Settings) -> Result<Answer, Error> {
        let policy = match settings.choice("flight") {
            "hover" => Policy::Hover(resampler(settings).into()),
            "low" => Policy::OrbitLow,
            _ => Policy::Orbit,
        };
        let environment = environment(settings);
        let walk = Walk {
            particles: settings.number("particles") as usize,
            height_m: settings.number("height"),
            user_radius_m: settings.number("user_radius"),
            end_time: settings.number("end_time") as u32,
            environment,
            unknown_noise_db: settings.number("noise"),
            ..Walk::thesis(policy)
        };
        let key = (walk, settings.number("seed") as u64);
        let run = |&(walk, seed): &(Walk, u64)| Ok::<_, Error>(film(&walk, seed, 0));
        let run = self.last.of(key, run)?;
        let (frames, outcome) = &*run;
        let mut answer = Answer::default();
        Film::new(frames, settings.number("step"), SIDE_M, environment).tell(&mut answer);
        let speed = settings.number("speed");
        let energy = outcome.energy_j(speed) / 1e3;
        answer.fact("way of the drone", format!("{:.1} km", outcome.way_m / 1e3));
        answer.fact("energy of the flight", format!("{energy:.0} kJ at {speed} km/h"));
        Ok(answer)
    }
}
