//! The state that is shown, in bounded memory however long the stream.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use kestirim_gnss_ppp::Geodetic;
use kestirim_telemetry::{
    EstimateHealth, Footprint, GlobalPosition, Health, Imu, Message, PathLoss, Position, Range,
};
use nalgebra::{Matrix3, Vector3};

use super::device::Row;
use super::options::Following;
use super::own_health::OwnHealth;
use super::report::{Counts, DeviceRow, Report};
use super::thinned::Thinned;
use super::window::Window;
use crate::figure::Series;
use crate::system::{Answer, Online, Outcome, Panel, Plan};
use crate::table::FARTHEST_POSITION;

/// The maximum number of points of a path on the map.
const POINTS: usize = 4096;

/// A path on the map, m.
pub(super) type Path = Thinned<[f64; 2]>;

/// The complete state that is shown.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) system: &'static str,
    pub(super) panels: &'static [Panel],
    /// Whether the estimator decodes the stream itself, which is then not telemetry.
    hears_bytes: bool,
    pub(super) counts: Counts,
    /// The devices that identify themselves, by number, and the one of them that is shown in detail.
    pub(super) devices: BTreeMap<u32, Row>,
    pub(super) shown: Option<u32>,
    /// The row of all anonymous senders together, if they are not shown in detail.
    pub(super) unnamed: Option<Row>,
    /// The number of frames of devices beyond the maximum.
    pub(super) beyond: u64,
    /// Whether nothing is kept for figures.
    is_brief: bool,
    /// The number of ignored datagrams from a second sender.
    pub(super) ignored: Arc<AtomicU64>,
    /// The latest time of the sender's clock, in microseconds.
    pub(super) time_us: Option<u64>,
    pub(super) health: Option<Health>,
    /// How far the sender relies on its own estimate.
    pub(super) own_health: Option<OwnHealth>,
    /// The position estimate (m).
    pub(super) position: Option<[f64; 3]>,
    /// The position estimate on the map (m).
    pub(super) place: Option<[f64; 2]>,
    pub(super) path_length_m: Option<f64>,
    /// How far the estimate made here can be relied upon.
    pub(super) estimate_health: Option<kestirim_health::Health>,
    pub(super) facts: Vec<(String, String)>,
    assumptions: Vec<String>,
    suspicions: Vec<String>,
    pub(super) map: Vec<Series>,
    /// The path estimated here.
    pub(super) path: Path,
    /// The path estimated by the sender.
    pub(super) senders_path: Path,
    pub(super) footprints: Path,
    /// The positions at which path losses were measured.
    pub(super) flown: Path,
    pub(super) inertial: Window<Inertial>,
    /// The anchors, ranges, and whether they were refused.
    pub(super) ranges: Window<(u16, f32, bool)>,
    pub(super) losses: Window<f32>,
    pub(super) states: Window<[f64; 4]>,
    pub(super) senders_states: Window<[f64; 4]>,
    /// The sender's first position on earth, with the rotation to east, north and up there.
    origin: Option<(Vector3<f64>, Matrix3<f64>)>,
}

/// A sample of an IMU, and whether the foot was stationary.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inertial {
    pub(super) force: [f32; 3],
    pub(super) rate: [f32; 3],
    pub(super) is_still: bool,
}

impl State {
    /// The state before anything has arrived.
    pub(super) fn new(following: &Following) -> Self {
        let plan = following.plan.as_deref();
        let path = Path::new(POINTS);
        Self {
            system: following.name,
            panels: following.panels,
            hears_bytes: following.hears_bytes(),
            counts: Counts::default(),
            devices: BTreeMap::new(),
            shown: None,
            unnamed: None,
            beyond: 0,
            is_brief: false,
            ignored: Arc::default(),
            time_us: None,
            health: None,
            own_health: None,
            position: None,
            place: None,
            path_length_m: None,
            estimate_health: None,
            facts: Vec::new(),
            assumptions: plan.map(Plan::assumptions).unwrap_or_default(),
            suspicions: Vec::new(),
            map: plan.map(Plan::map).unwrap_or_default(),
            path: path.clone(),
            senders_path: path.clone(),
            footprints: path.clone(),
            flown: path,
            inertial: Window::default(),
            ranges: Window::default(),
            losses: Window::default(),
            states: Window::default(),
            senders_states: Window::default(),
            origin: None,
        }
    }

    /// The state of a device that is not shown in detail.
    pub(super) fn brief() -> Self {
        Self { is_brief: true, ..Self::new(&Following::NONE) }
    }

    /// Adds decoded bytes and sets the counters of all frames so far, of which `left_out` were left out.
    pub(super) fn count(
        &mut self,
        bytes: usize,
        frames: kestirim_telemetry::Counts,
        left_out: u64,
    ) {
        let kestirim_telemetry::Counts { received, torn, corrupt, unknown, lost, .. } = frames;
        let bytes = self.counts.bytes + bytes as u64;
        self.counts =
            Counts { bytes, received, torn, corrupt, unknown, lost, left_out, ..self.counts };
    }

    /// Clears the figures after the sender has restarted.
    pub(super) fn restart(&mut self) {
        let path = Path::new(POINTS);
        self.counts.restarts += 1;
        (self.position, self.place) = (None, None);
        (self.estimate_health, self.own_health) = (None, None);
        self.path = path.clone();
        self.senders_path = path.clone();
        self.footprints = path.clone();
        self.flown = path;
        self.inertial = Window::default();
        self.ranges = Window::default();
        self.losses = Window::default();
        self.states = Window::default();
        self.senders_states = Window::default();
        self.origin = None;
    }

    /// Adds a measurement with the estimator's outcome.
    pub(super) fn measure(
        &mut self,
        time_us: u64,
        message: &Message,
        outcome: Outcome,
        estimator: Option<&dyn Online>,
    ) {
        let refused = outcome == Outcome::Refused;
        self.counts.taken += u64::from(outcome == Outcome::Taken);
        self.counts.refused += u64::from(refused);
        if self.is_brief {
            if !refused {
                self.time_us = Some(time_us);
                self.position = estimator.and_then(Online::position);
            }
            return;
        }
        match *message {
            Message::Range(Range { anchor, range, .. }) => {
                self.ranges.push(time_us, (anchor, range, refused));
            }
            // Other refused measurements would only clutter the figures.
            _ if refused => return,
            Message::Imu(Imu { specific_force: force, angular_rate: rate, .. }) => {
                let is_still = estimator.is_some_and(Online::is_still);
                self.inertial.push(time_us, Inertial { force, rate, is_still });
            }
            Message::PathLoss(PathLoss { place: [x, y, _], loss, .. }) => {
                self.flown.push([x, y].map(f64::from));
                self.losses.push(time_us, loss);
            }
            Message::Flight(_) => {
                if let Some(state) = estimator.and_then(Online::state) {
                    self.states.push(time_us, state);
                }
            }
            _ => {}
        }
        self.time_us = Some(time_us);
        self.move_to(estimator);
    }

    fn move_to(&mut self, estimator: Option<&dyn Online>) {
        let position = estimator.and_then(Online::position);
        let place = estimator.and_then(Online::place);
        if let Some(place) = place.filter(|_| !self.is_brief && position != self.position) {
            self.path.push(place);
        }
        (self.position, self.place) = (position, place);
    }

    /// Updates the state from the estimator.
    pub(super) fn show(&mut self, estimator: &dyn Online) {
        self.move_to(Some(estimator));
        self.path_length_m = estimator.path_length_m();
        self.facts = estimator.facts();
        self.estimate_health = estimator.health();
        let health = self.estimate_health.map(|health| ("health".to_owned(), health.to_string()));
        self.facts.extend(health);
        self.suspicions = estimator.warnings();
    }

    /// Adds a message about the sender itself.
    pub(super) fn tell(&mut self, message: &Message) {
        if let Message::EstimateHealth(EstimateHealth { reasons, .. }) = *message {
            self.own_health = Some(OwnHealth::from_bits(reasons));
        }
        if self.is_brief {
            return;
        }
        let believed = match *message {
            Message::Position(Position { position: [x, y, _], .. }) => {
                push(&mut self.senders_path, [x, y].map(f64::from))
            }
            Message::Footprint(Footprint { position: [x, y, _], .. }) => {
                push(&mut self.footprints, [x, y].map(f64::from))
            }
            Message::GlobalPosition(GlobalPosition { position, .. }) => {
                let place = self.near(position);
                push(&mut self.senders_path, place)
            }
            Message::State(kestirim_telemetry::State { time_us, state }) => {
                let believed = state.iter().all(|number| number.is_finite());
                if believed {
                    self.senders_states.push(time_us, state.map(f64::from));
                }
                believed
            }
            Message::Health(health) => {
                self.health = Some(health);
                true
            }
            // A kind of message that is not drawn.
            _ => true,
        };
        self.counts.refused += u64::from(!believed);
    }

    /// The position relative to the first one on earth, as east and north (m).
    fn near(&mut self, position: [f64; 3]) -> [f64; 2] {
        let position = Vector3::from(position);
        if !position.iter().all(|coordinate| coordinate.abs() <= FARTHEST_POSITION) {
            return [f64::NAN; 2];
        }
        let enu = |place: &Vector3<f64>| Geodetic::from_ecef(place).enu_from_ecef();
        let (origin, turn) = *self.origin.get_or_insert_with(|| (position, enu(&position)));
        let near = turn * (position - origin);
        [near.x, near.y]
    }

    /// Warnings for the user.
    pub(super) fn warnings(&self) -> Vec<String> {
        let restarts = self.counts.restarts;
        let anew = (restarts > 0).then(|| {
            format!("the sender's clock began anew ({restarts} times), and the estimator with it")
        });
        let Counts { left_out, .. } = self.counts;
        let left_out = (left_out > 0).then(|| {
            format!("{left_out} frames were left out: they came twice, too late, or from a second sender; a line is \
                     for one sender")
        });
        let ignored = self.ignored.load(Ordering::Relaxed);
        let ignored = (ignored > 0).then(|| {
            format!("{ignored} datagrams of a second sender were ignored: a port is for one sender (--udp)")
        });
        let doubts = self.own_health.filter(|health| health.is_bad());
        let doubts =
            doubts.map(|health| format!("the sender does not rely on its own estimate: {health}"));
        let told = [anew, left_out, ignored, doubts]
            .into_iter()
            .flatten()
            .chain(self.shared_numbers())
            .chain(self.doubted());
        self.assumptions.iter().chain(&self.suspicions).cloned().chain(told).collect()
    }

    /// Facts, warnings and figures.
    pub(super) fn answer(&self) -> Answer {
        Answer {
            facts: self.all_facts(),
            warnings: self.warnings(),
            figures: self.figures(),
            tables: self.fleet().into_iter().collect(),
            ..Answer::default()
        }
    }

    /// The report at the end of the stream.
    pub(super) fn report(&self, source: String, recording: PathBuf) -> Report {
        Report {
            system: self.system,
            source,
            recording,
            counts: self.totals(),
            devices: DeviceRow::all(&self.devices),
            position: self.position,
            state: self.states.last().copied(),
            path_length_m: self.path_length_m,
            facts: if self.hears_bytes {
                self.facts.iter().cloned().collect()
            } else {
                BTreeMap::new()
            },
            warnings: self.warnings(),
        }
    }
}

/// Appends a point to a path, unless it is implausibly far away.
fn push(path: &mut Path, place: [f64; 2]) -> bool {
    let believed = place.iter().all(|coordinate| coordinate.abs() <= FARTHEST_POSITION);
    if believed {
        path.push(place);
    }
    believed
}
