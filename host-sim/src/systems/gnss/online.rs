//! Follows the live stream of a receiver, in UBX or RTCM 3.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use kestirim_gnss_ppp::Geodetic;
use kestirim_replay::gnss::{Live, Now, Pass, Paths, Shelf};
use kestirim_telemetry::Message;
use nalgebra::Vector3;

use super::recording::error;
use super::settings::{Choice, Setup};
use crate::Error;
use crate::system::{Files, Online, Outcome, Plan, Settings};

/// The name of the stream where files have theirs.
const STREAM: &str = "stream";

/// The health shown for a position that is not from the latest epoch.
const STALE: &str = "no solution since then";
/// The minimum interval between two evaluations on a line that never pauses.
const EVERY: Duration = Duration::from_secs(1);
/// The minimum interval between two evaluations, in multiples of the duration of an evaluation.
const SELDOM: u32 = 4;

/// The settings and products from which positions are computed.
#[derive(Debug, Clone)]
pub(super) struct Receiving {
    setup: Setup,
    files: Files,
    shelf: Arc<Shelf>,
}

impl Receiving {
    /// A plan with the products in files.
    ///
    /// # Errors
    /// Errors in the settings and files.
    pub(super) fn new(settings: &Settings, files: &Files) -> Result<Self, Error> {
        let setup = Setup::of(settings);
        if setup.filter == Choice::All {
            return Err(Error::Usage("a stream is followed by one filter: --filter".to_owned()));
        }
        if !files.all("sp3").is_empty() {
            files.required("antex")?;
        }
        let receiving = Self { setup, files: files.clone(), shelf: files.shared.of::<Shelf>() };
        receiving.shelf.fill(&receiving.paths()).map_err(error)?;
        Ok(receiving)
    }

    fn paths(&self) -> Paths<'_> {
        Paths {
            obs: Path::new(STREAM),
            sp3: self.files.all("sp3"),
            nav: self.files.all("nav"),
            antex: self.files.all("antex"),
            clk: self.files.all("clk"),
            bias: self.files.all("bias"),
            blq: None,
            erp: self.files.one("erp"),
        }
    }
}

impl Plan for Receiving {
    fn build(&self) -> Result<Box<dyn Online>, Error> {
        let Setup { systems, method, corrections, .. } = self.setup;
        let pass = Pass { systems, method, ..Pass::default() };
        let live = Live::new(self.setup.config(self.setup.main()), pass, corrections);
        Ok(Box::new(Receiver {
            live,
            plan: self.clone(),
            origin: None,
            looked: Instant::now(),
            took: Duration::ZERO,
        }))
    }
}

/// The estimator that follows a receiver.
#[derive(Debug)]
struct Receiver {
    live: Live,
    plan: Receiving,
    /// The first position (ECEF, m), which is the map's origin.
    origin: Option<Vector3<f64>>,
    /// The time of the last evaluation.
    looked: Instant,
    /// The duration of the last evaluation.
    took: Duration,
}

impl Receiver {
    fn look(&mut self, is_end: bool) {
        let begun = Instant::now();
        self.live.look(&self.plan.paths(), &self.plan.shelf, is_end);
        self.origin = self.origin.or(self.live.now().map(|now| now.fix.position));
        (self.looked, self.took) = (Instant::now(), begun.elapsed());
    }
}

impl Online for Receiver {
    /// Ignores telemetry, which has no observations of satellites.
    fn take(&mut self, _message: &Message) -> Outcome {
        Outcome::NotMine
    }

    fn hear(&mut self, bytes: &[u8]) {
        // Evaluations leave most of the time to other work.
        let is_due = self.looked.elapsed() >= EVERY.max(self.took * SELDOM);
        if self.live.hear(bytes) || is_due {
            self.look(false);
        }
    }

    fn heard(&self) -> [u32; 2] {
        self.live.counts().map(|count| u32::try_from(count).unwrap_or(u32::MAX))
    }

    fn settle(&mut self) {
        self.look(false);
    }

    fn finish(&mut self) -> Result<(), Error> {
        self.look(true);
        Ok(())
    }

    fn position(&self) -> Option<[f64; 3]> {
        self.live.now().map(|now| now.fix.position.into())
    }

    fn place(&self) -> Option<[f64; 2]> {
        let (now, origin) = (self.live.now()?, self.origin?);
        let turned = Geodetic::from_ecef(&origin).enu_from_ecef() * (now.fix.position - origin);
        Some([turned.x, turned.y])
    }

    fn sigma_m(&self) -> Option<f64> {
        let [east, north, _] = self.live.now()?.sd_enu;
        Some(east.hypot(north) / std::f64::consts::SQRT_2)
    }

    fn facts(&self) -> Vec<(String, String)> {
        self.live.now().map(|now| facts(now, self.live.is_solved())).unwrap_or_default()
    }

    fn warnings(&self) -> Vec<String> {
        self.live.warnings().to_vec()
    }
}

fn facts(now: &Now, is_solved: bool) -> Vec<(String, String)> {
    let Geodetic { latitude, longitude, height } = Geodetic::from_ecef(&now.fix.position);
    let [latitude, longitude] = [latitude, longitude].map(f64::to_degrees);
    let [east, north, up] = now.sd_enu;
    let facts = [
        ("time", now.utc.clone()),
        ("latitude, longitude", format!("{latitude:.8}°, {longitude:.8}°")),
        ("height above the ellipsoid", format!("{height:.2} m")),
        ("σ east, north, up", format!("{east:.2} m, {north:.2} m, {up:.2} m")),
        ("satellites", now.satellites.to_string()),
        ("health", if is_solved { now.health.in_short().to_string() } else { STALE.to_owned() }),
    ];
    facts.map(|(name, value)| (name.to_owned(), value)).into()
}
