//! A calibration followed while it is recorded: which positions are missing, what to do next, and the file at the end.

use std::path::PathBuf;

use kestirim_import::inertial::stands;
use kestirim_imu_calibration::{AccelerometerModel, GyroscopeModel, Side};
use kestirim_telemetry::{Imu, Message};

use super::found::{self, Found, HOLD_S, Refusal, SHORTEST_S};
use super::{edges, in_words, sentence, turns};
use crate::system::{Online, Outcome, Plan};
use crate::systems::pedestrian::Sample;
use crate::systems::pedestrian::recording::calibration;
use crate::{Error, output};

/// The maximum number of samples that are used: half an hour at 500 Hz.
const MOST_SAMPLES: usize = 900_000;
/// The minimum interval between two evaluations (s), which grows with the number of samples.
const LOOK_S: f64 = 0.25;
/// The time from the end of a stand to the last sample up to which it counts as still going on (s), as its end is cut
/// off.
const GOES_ON_S: f64 = 0.5;

/// The plan of a calibration, with the path of its file.
#[derive(Debug)]
pub(super) struct Watching {
    pub(super) to: PathBuf,
}

impl Plan for Watching {
    fn build(&self) -> Result<Box<dyn Online>, Error> {
        let (to, samples) = (self.to.clone(), Vec::new());
        Ok(Box::new(Watch { to, samples, looked_at: 0, seen: Seen::default() }))
    }
}

/// The samples so far and their evaluation.
#[derive(Debug)]
struct Watch {
    to: PathBuf,
    samples: Vec<Sample>,
    /// The number of samples at the last evaluation.
    looked_at: usize,
    seen: Seen,
}

/// The evaluation of the samples so far.
#[derive(Debug, Default)]
struct Seen {
    /// The time for which the sensor has been held still (s); `None` while it moves.
    held_s: Option<f64>,
    found: Option<Result<Found, Refusal>>,
}

impl Seen {
    fn of(samples: &[Sample]) -> Self {
        let held_s = stands(samples, SHORTEST_S).last().and_then(|stand| {
            let (end, last) = (samples.get(stand.samples.end.checked_sub(1)?)?, samples.last()?);
            let since_s = last.time_us.checked_sub(end.time_us)? as f64 * 1e-6;
            (since_s <= GOES_ON_S).then_some(stand.seconds)
        });
        Self { held_s, found: Some(found::find(samples)) }
    }

    fn poses(&self) -> usize {
        match &self.found {
            Some(Ok(found)) => found.poses,
            Some(Err(refusal)) => refusal.poses,
            None => 0,
        }
    }

    fn missing(&self) -> &[Side] {
        match &self.found {
            Some(Ok(Found { missing, .. }) | Err(Refusal { missing, .. })) => missing,
            None => &[],
        }
    }

    /// The instruction what to do next.
    fn advice(&self) -> String {
        if self.poses() == 0 {
            return format!(
                "switch the sensor on some minutes before, set the ranges that you walk with, and hold it still for {HOLD_S:.0} s"
            );
        }
        if let Some(held_s) = self.held_s.filter(|&held_s| held_s < HOLD_S) {
            return format!("hold it still: {held_s:.1} s of {HOLD_S:.0} s");
        }
        let next = self.missing().get(..1).and_then(in_words);
        match (next, &self.found) {
            (Some(next), _) => next,
            (None, Some(Err(refusal))) => sentence(refusal),
            (None, Some(Ok(found))) if found.accelerometer != AccelerometerModel::Full => edges(),
            (None, Some(Ok(found))) if found.gyroscope != Some(GyroscopeModel::Full) => turns(),
            _ => "all is shown: end the stream; then fasten the sensor to the instep so that it cannot wobble, any way up, \
                  stand for 1 s before the first step, and walk"
                .to_owned(),
        }
    }
}

impl Online for Watch {
    fn take(&mut self, message: &Message) -> Outcome {
        let Message::Imu(Imu { time_us, specific_force, angular_rate }) = *message else {
            return Outcome::NotMine;
        };
        let [specific_force, angular_rate] =
            [specific_force, angular_rate].map(|axes| axes.map(f64::from));
        let is_finite = specific_force.iter().chain(&angular_rate).all(|axis| axis.is_finite());
        let is_later = self.samples.last().is_none_or(|last| last.time_us < time_us);
        if !is_finite || !is_later || self.samples.len() >= MOST_SAMPLES {
            return Outcome::Refused;
        }
        self.samples.push(Sample { time_us, specific_force, angular_rate });
        Outcome::Taken
    }

    fn settle(&mut self) {
        let new = self.samples.get(self.looked_at..).unwrap_or_default();
        let (Some(first), Some(last)) = (new.first(), new.last()) else { return };
        let is_enough = (last.time_us - first.time_us) as f64 * 1e-6 >= LOOK_S;
        if is_enough && new.len() * 50 >= self.samples.len() {
            self.seen = Seen::of(&self.samples);
            self.looked_at = self.samples.len();
        }
    }

    fn finish(&mut self) -> Result<(), Error> {
        self.seen = Seen::of(&self.samples);
        let found = match &self.seen.found {
            Some(Ok(found)) => found,
            Some(Err(refusal)) => {
                return Err(Error::Usage(format!("no calibration: {}", sentence(refusal))));
            }
            None => return Ok(()),
        };
        let parameters = calibration::parameters(&found.calibration, found.sigmas);
        calibration::write(&self.to, &parameters)?;
        output::warn(&format!("calibration of {} positions: {}", found.poses, self.to.display()));
        Ok(())
    }

    fn is_still(&self) -> bool {
        self.seen.held_s.is_some()
    }

    fn facts(&self) -> Vec<(String, String)> {
        let fact = |name: &str, value: String| (name.to_owned(), value);
        let sides = 6 - self.seen.missing().len().min(6);
        let sides = if self.seen.found.is_some() { sides } else { 0 };
        let state = match self.seen.held_s {
            Some(held_s) => format!("held still for {held_s:.1} s"),
            None => "moving".to_owned(),
        };
        let known = match &self.seen.found {
            Some(Ok(found)) => {
                format!("{:.3} m/s² left of {} positions", found.residual, found.poses)
            }
            _ => "not yet".to_owned(),
        };
        vec![
            fact("what to do", self.seen.advice()),
            fact("sensor", state),
            fact("positions", self.seen.poses().to_string()),
            fact("sides shown", format!("{sides} of 6")),
            fact("calibration", known),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of a sensor held for 3 s with each of these axes up, and turned within a second in between.
    fn shown(ups: &[(usize, f64)]) -> Vec<Imu> {
        let axes = |(axis, sign): (usize, f64)| {
            let mut up = [0.0; 3];
            up[axis] = sign * 9.8;
            up
        };
        let mut samples = Vec::new();
        for (place, &up) in ups.iter().enumerate() {
            let next = axes(*ups.get(place + 1).unwrap_or(&up));
            for step in 0..400_u32 {
                let share = f64::from(step.saturating_sub(300)) / 100.0;
                let noise = 0.02 * (f64::from(step * 7919 % 100) / 100.0 - 0.5);
                let force: [f32; 3] = std::array::from_fn(|axis| {
                    let (from, to) = (axes(up)[axis], next[axis]);
                    (from + share * (to - from) + noise) as f32
                });
                let rate = if step > 300 { 1.6 } else { 0.01 };
                samples.push(Imu {
                    time_us: samples.len() as u64 * 10_000,
                    specific_force: force,
                    angular_rate: [rate, 0.0, 0.0],
                });
            }
        }
        samples
    }

    fn fact(watch: &dyn Online, name: &str) -> String {
        let facts = watch.facts();
        facts.into_iter().find(|(known, _)| known == name).map(|(_, said)| said).unwrap()
    }

    #[test]
    fn what_is_missing_is_told_while_it_is_done() {
        let folder = tempfile::tempdir().unwrap();
        let to = folder.path().join("calibration.csv");
        let mut watch = Watching { to: to.clone() }.build().unwrap();
        assert!(fact(watch.as_ref(), "what to do").contains("switch the sensor on"));
        let ups = [(2, 1.0), (0, 1.0), (1, 1.0), (2, -1.0), (0, -1.0), (1, -1.0)];
        let samples = shown(&ups);
        let mut told = Vec::new();
        for (place, sample) in samples.iter().enumerate() {
            watch.take(&(*sample).into());
            watch.settle();
            // In the middle of each position, and during the turn to the next one.
            if place % 400 == 180 || place % 400 == 398 {
                told.push(fact(watch.as_ref(), "what to do"));
            }
        }
        assert!(told[0].starts_with("hold it still: 1."), "{told:?}");
        assert!(told[1].contains("so that x points up"), "{told:?}");
        assert!(told[3].contains("so that x points down"), "{told:?}");
        assert_eq!(fact(watch.as_ref(), "sides shown"), "6 of 6");
        watch.finish().unwrap();
        assert!(calibration::read(&to).is_ok());
    }

    #[test]
    fn too_few_positions_are_refused_and_nothing_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let to = folder.path().join("calibration.csv");
        let mut watch = Watching { to: to.clone() }.build().unwrap();
        for sample in shown(&[(2, 1.0), (0, 1.0)]) {
            watch.take(&sample.into());
        }
        let refused = watch.finish().unwrap_err().to_string();
        assert!(refused.starts_with("no calibration: expected at least 6"), "{refused}");
        assert!(!to.exists());
    }
}
