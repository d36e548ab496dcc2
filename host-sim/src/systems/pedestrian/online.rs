//! A walk, followed as firmware follows it.

use std::fmt::Debug;
use std::marker::PhantomData;

use kestirim_imu_calibration::Calibration;
use kestirim_pedestrian::detector::StanceDetector;
use kestirim_pedestrian::{Ekf, Estimate, Lite, Navigator, Tracker};
use kestirim_replay::pedestrian::{
    Options, TrackerKind, WithDetector, imu_sample, sentences, with_detector,
};
use kestirim_replay::{Number, Stored};
use kestirim_scalar::{Components, Q12_20, Scalar};
use kestirim_telemetry::{Imu, Message};

use super::Sample;
use super::recording::calibration;
use crate::Error;
use crate::system::{Online, Outcome, Plan, ScalarKind};

/// What is known beforehand.
#[derive(Debug, Clone, Copy)]
pub(super) struct Walking {
    pub(super) options: Options,
    /// What the IMU measures wrong, if that is known.
    pub(super) calibration: Option<Calibration<f64>>,
}

impl Plan for Walking {
    fn build(&self) -> Result<Box<dyn Online>, Error> {
        Ok(match self.options.scalar {
            ScalarKind::F32 => self.with_scalar::<f32>(),
            ScalarKind::F64 => self.with_scalar::<f64>(),
            ScalarKind::Fixed => self.with_scalar::<Q12_20>(),
        })
    }
}

impl Walking {
    fn with_scalar<T: Number + 'static>(&self) -> Box<dyn Online> {
        let options = &self.options;
        match options.tracker {
            TrackerKind::Lite => with_detector(options, Built::<Lite<T>>(self, PhantomData)),
            TrackerKind::Ekf => with_detector(options, Built::<Ekf<T>>(self, PhantomData)),
        }
    }
}

/// Builds a tracker around a detector.
struct Built<'a, N>(&'a Walking, PhantomData<N>);

impl<T: Number + 'static, N: Navigator<T> + Stored + Debug + 'static> WithDetector<T>
    for Built<'_, N>
{
    type Output = Box<dyn Online>;

    fn with<D: StanceDetector<T> + Stored + Debug + 'static>(self, detector: D) -> Box<dyn Online> {
        let tracker = Tracker::<T, N, D>::with_detector(self.0.options.config(), detector);
        let calibration = self.0.calibration.as_ref().map(calibration::cast);
        Box::new(Walker { tracker, calibration, last: None, strides: 0 })
    }
}

/// A causal tracker.
#[derive(Debug)]
struct Walker<T: Scalar, N, D> {
    tracker: Tracker<T, N, D>,
    calibration: Option<Calibration<T>>,
    last: Option<Estimate<T>>,
    strides: u32,
}

impl<T: Number, N: Navigator<T> + Stored + Debug, D: StanceDetector<T> + Stored + Debug> Online
    for Walker<T, N, D>
{
    fn take(&mut self, message: &Message) -> Outcome {
        let Message::Imu(Imu { time_us, specific_force, angular_rate }) = *message else {
            return Outcome::NotMine;
        };
        let [specific_force, angular_rate] =
            [specific_force, angular_rate].map(|axes| axes.map(f64::from));
        let mut sample = imu_sample(&Sample { time_us, specific_force, angular_rate });
        if let Some(calibration) = &self.calibration {
            (sample.specific_force, sample.angular_rate) =
                calibration.apply(&sample.specific_force, &sample.angular_rate);
        }
        let Ok(estimate) = self.tracker.update(&sample) else { return Outcome::Refused };
        self.strides += u32::from(estimate.stride.is_some());
        self.last = Some(estimate);
        Outcome::Taken
    }

    fn finish(&mut self) -> Result<(), Error> {
        self.strides += u32::from(self.tracker.finish().is_some());
        Ok(())
    }

    fn position(&self) -> Option<[f64; 3]> {
        self.last.as_ref().map(|estimate| estimate.position.as_array().map(T::to_f64))
    }

    fn is_still(&self) -> bool {
        self.last.as_ref().is_some_and(|estimate| estimate.stance)
    }

    fn path_length_m(&self) -> Option<f64> {
        Some(self.tracker.path_length().to_f64())
    }

    fn facts(&self) -> Vec<(String, String)> {
        let length = format!("{:.2} m", self.tracker.path_length().to_f64());
        let mut facts = vec![
            ("path length".to_owned(), length),
            ("strides".to_owned(), self.strides.to_string()),
        ];
        if self.strides == 0 {
            let guide = "fasten the sensor to the instep so that it cannot wobble, any way up, stand still for 1 s, and walk";
            facts.push(("what to do".to_owned(), guide.to_owned()));
        }
        facts
    }

    fn warnings(&self) -> Vec<String> {
        // Whether a foot ever stood is not known before it did.
        if self.last.is_some() { sentences(self.tracker.warnings()) } else { Vec::new() }
    }

    fn snapshot(&self) -> Result<Vec<u8>, String> {
        let tracker = self.tracker.stored().ok_or("this tracker cannot be stored")?;
        Ok([&self.strides.to_le_bytes()[..], &tracker].concat())
    }

    fn restore(&mut self, snapshot: &[u8]) -> Option<()> {
        let (strides, tracker) = snapshot.split_first_chunk()?;
        self.tracker = Stored::restored(tracker)?;
        // The next sample has the next estimate.
        (self.strides, self.last) = (u32::from_le_bytes(*strides), None);
        Some(())
    }
}
