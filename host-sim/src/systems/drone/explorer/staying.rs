//! A user who stays.

use super::super::film::Frame;
use super::super::options::ResamplerKind;
use super::super::static_user::{Geometry, Paper, Shown, film};
use super::super::trajectory::{SIDE_M, Trajectory};
use super::figures::Film;
use super::remembered::Remembered;
use super::{common, environment, resampler, resampling};
use crate::Error;
use crate::explore::{Answer, Control, Explorer, Settings};

/// Speed between measurements, km/h.
const SPEED_KMH: f64 = 40.0;

/// A drone on a circle or a grid.
#[derive(Debug, Default)]
pub(super) struct Staying {
    last: Remembered<(Geometry, Shown, u64), Vec<Frame>>,
}

impl Explorer for Staying {
    fn controls(&self) -> Vec<Control> {
        let mut controls = vec![
            Control::playable("step", "measurement", "", [1.0, 40.0, 1.0], 12.0),
            Control::choice(
                "filter",
                "filter",
                &[("best", "ours: a lattice"), ("paper", "the thesis': a cloud")],
            ),
            resampling(),
            Control::choice(
                "trajectory",
                "way of the drone",
                &[
                    ("circle", "circle (b)"),
                    ("grid", "grid (a)"),
                    ("small", "grid as long as the circle (c)"),
                ],
            ),
            Control::slider("radius", "radius of the circle", "m", [100.0, 1000.0, 10.0], 670.0),
            Control::slider("measurements", "measurements T", "", [4.0, 40.0, 1.0], 12.0),
        ];
        controls.extend(common(500.0, 800.0));
        controls
    }

    fn answer(&self, settings: &Settings) -> Result<Answer, Error> {
        let stops = settings.number("measurements") as u32;
        let trajectory = match settings.choice("trajectory") {
            "grid" => Trajectory::grid(stops),
            "small" => Trajectory::small_grid(stops),
            _ => Trajectory::Circle { radius_m: settings.number("radius") },
        };
        let environment = environment(settings);
        let height_m = settings.number("height");
        let geometry = Geometry { stops, per_stop: 1, height_m, trajectory, environment };
        let particles = settings.number("particles") as usize;
        let shown = if settings.choice("filter") == "paper" {
            let resampler: ResamplerKind = resampler(settings);
            Shown::Paper(Paper { particles, resampler: resampler.into() })
        } else {
            Shown::Best(particles)
        };
        let key = (geometry, shown, settings.number("seed") as u64);
        let run = |&(geometry, shown, seed): &_| Ok::<_, Error>(film(&geometry, shown, seed, 0));
        let frames = self.last.of(key, run)?;
        let mut answer = Answer::default();
        Film::new(&frames, settings.number("step"), SIDE_M, environment).tell(&mut answer);
        let energy = geometry.energy_j(SPEED_KMH) / 1e3;
        answer.fact("energy of the flight", format!("{energy:.0} kJ at {SPEED_KMH} km/h"));
        Ok(answer)
    }
}
