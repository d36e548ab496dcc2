//! The presentation of the state as facts and figures.

use kestirim_telemetry::Health;

use super::state::{Path, State};
use super::window::Window;
use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::STANDARD_GRAVITY;
use crate::system::Panel;

/// The label of time axes, which show the sender's time.
const TIME: &str = "sender's time, s";
const AXES: [&str; 3] = ["x", "y", "z"];
/// The colour of the sender's own estimate.
const SENDERS: Colour = Colour::Other(3);

impl State {
    /// Results by name, with their units.
    pub(super) fn all_facts(&self) -> Vec<(String, String)> {
        let counts = self.totals();
        let mut facts = vec![
            ("frames received", counts.received.to_string()),
            ("lost on the way", counts.lost.to_string()),
            ("torn", counts.torn.to_string()),
            ("corrupt", counts.corrupt.to_string()),
            ("unknown", counts.unknown.to_string()),
            ("bytes recorded", counts.bytes.to_string()),
            ("measurements taken in", counts.taken.to_string()),
            ("refused", counts.refused.to_string()),
        ];
        if !self.devices.is_empty() {
            facts.push(("devices", self.devices.len().to_string()));
        }
        if let Some(shown) = self.shown {
            facts.push(("shown in detail", format!("device {shown}")));
        }
        if let Some(time_us) = self.time_us {
            facts.push(("sender's time", format!("{:.1} s", time_us as f64 * 1e-6)));
        }
        if let Some([x, y, z]) = self.position {
            facts.push(("position", format!("{x:.2} m, {y:.2} m, {z:.2} m")));
        }
        if let Some(Health { accepted, rejected, failed, .. }) = self.health {
            let health = format!("{accepted} taken in, {rejected} refused, {failed} failed");
            facts.push(("the sender's own account", health));
        }
        if let Some(health) = self.own_health {
            facts.push(("the sender's own estimate", health.to_string()));
        }
        let named = facts.into_iter().map(|(name, value)| (name.to_owned(), value));
        named.chain(self.facts.iter().cloned()).collect()
    }

    /// The figures, always the same ones for a system.
    pub(super) fn figures(&self) -> Vec<Figure> {
        let figure = |panel: &Panel| match panel {
            Panel::Map => self.map_figure(),
            Panel::Forces => self.forces(),
            Panel::Rates => self.rates(),
            Panel::Ranges => self.range_figure(),
            Panel::Losses => self.loss_figure(),
            Panel::Angles => self.angles(),
            Panel::Airspeed => self.airspeed(),
        };
        self.panels.iter().map(figure).collect()
    }

    fn map_figure(&self) -> Figure {
        let path = |name: &str, path: &Path| Series::path(name, path.iter());
        let here = self.place;
        Figure::new("live-path", "Path")
            .axes("x or east, m", "y or north, m")
            .map()
            .caption("Where the estimator and the sender itself see the path so far.")
            .with_all(self.map.iter().cloned())
            .with(path("sender", &self.flown).marked(Mark::Dots).coloured(Colour::Other(2)))
            .with(path("sender's estimate", &self.senders_path).coloured(SENDERS))
            .with(
                path("sender's footprints", &self.footprints)
                    .marked(Mark::Points)
                    .coloured(SENDERS),
            )
            .with(path("estimate", &self.path))
            .with(Series::points("now", here).coloured(Colour::Alarm))
    }

    fn forces(&self) -> Figure {
        let times = times(&self.inertial);
        let axis = |axis: usize| {
            let values = self.inertial.iter().map(|(_, sample)| sample.force[axis].into());
            line(AXES[axis], &times, values).coloured(Colour::Other(axis + 1))
        };
        let size = |force: [f32; 3]| force.iter().fold(0.0_f64, |sum, &f| sum.hypot(f.into()));
        let sizes = self.inertial.iter().map(|(_, sample)| size(sample.force));
        let stances = self.inertial.iter().filter(|(_, sample)| sample.is_still);
        let stances = stances.map(|(time, sample)| [time, size(sample.force)]);
        Figure::new("live-force", "Specific force of the last 30 s")
            .axes(TIME, "m/s²")
            .clock(1.0)
            .caption("At rest its size is 1 g, 9.8 m/s².")
            .with_all([0, 1, 2].map(axis))
            .with(line("size", &times, sizes))
            .with(Series::points("foot stands", stances).marked(Mark::Dots).coloured(Colour::Truth))
            .with(level("1 g", &times, STANDARD_GRAVITY))
    }

    fn rates(&self) -> Figure {
        let times = times(&self.inertial);
        let axis = |axis: usize| {
            let values = self.inertial.iter().map(|(_, sample)| sample.rate[axis].into());
            line(AXES[axis], &times, values).coloured(Colour::Other(axis + 1))
        };
        Figure::new("live-rate", "Angular rate of the last 30 s")
            .axes(TIME, "rad/s")
            .clock(1.0)
            .caption("What the gyroscope shows, in its own axes.")
            .with_all([0, 1, 2].map(axis))
    }

    fn range_figure(&self) -> Figure {
        let all = || self.ranges.iter();
        let anchors: std::collections::BTreeSet<u16> =
            all().map(|(_, (anchor, ..))| *anchor).collect();
        let taken = |anchor: u16| {
            let of = all().filter(move |(_, (of, _, refused))| *of == anchor && !refused);
            let points = of.map(|(time, (_, range, _))| [time, f64::from(*range)]);
            Series::points(format!("anchor {anchor}"), points)
                .marked(Mark::Dots)
                .coloured(Colour::Other(anchor.into()))
        };
        let refused = all().filter(|(_, (.., refused))| *refused);
        let refused = refused.map(|(time, (_, range, _))| [time, f64::from(*range)]);
        Figure::new("live-ranges", "Ranges of the last 30 s")
            .axes(TIME, "m")
            .clock(1.0)
            .caption("Crosses are ranges that the estimator refused.")
            .with_all(anchors.into_iter().take(MOST_ANCHORS).map(taken))
            .with(Series::points("refused", refused).marked(Mark::Crosses).coloured(Colour::Alarm))
    }

    fn loss_figure(&self) -> Figure {
        let points = self.losses.iter().map(|(time, loss)| [time, f64::from(*loss)]);
        Figure::new("live-loss", "Path loss of the last 30 s")
            .axes(TIME, "dB")
            .clock(1.0)
            .caption("The nearer the sender is to what it hears, the smaller.")
            .with(Series::points("path loss", points).marked(Mark::LineAndPoints))
    }

    fn angles(&self) -> Figure {
        let states = [(0, "angle of attack, rad"), (1, "pitch rate, rad/s"), (3, "pitch, rad")];
        let series = states.iter().enumerate().flat_map(|(colour, &(state, name))| {
            let colour = Colour::Other(colour);
            let ours = of_state(&self.states, name, state).coloured(colour);
            let senders = of_state(&self.senders_states, &format!("sender's {name}"), state);
            [ours, senders.marked(Mark::Dashes).coloured(colour)]
        });
        Figure::new("live-angles", "Angles and pitch rate of the last 30 s")
            .axes(TIME, "rad, rad/s")
            .clock(1.0)
            .caption("Broken lines are what the sender itself estimates.")
            .with_all(series)
    }

    fn airspeed(&self) -> Figure {
        let senders = of_state(&self.senders_states, "sender's estimate", 2);
        Figure::new("live-airspeed", "Airspeed of the last 30 s")
            .axes(TIME, "m/s")
            .clock(1.0)
            .caption("The broken line is what the sender itself estimates.")
            .with(of_state(&self.states, "estimate", 2))
            .with(senders.marked(Mark::Dashes).coloured(SENDERS))
    }
}

/// The maximum number of anchors that are drawn apart.
const MOST_ANCHORS: usize = 16;

fn times<T>(window: &Window<T>) -> Vec<f64> {
    window.iter().map(|(time, _)| time).collect()
}

fn line(name: &str, times: &[f64], values: impl Iterator<Item = f64>) -> Series {
    Series::line(name, times.to_vec(), values.collect())
}

fn level(name: &str, times: &[f64], value: f64) -> Series {
    let ends = times.first().into_iter().chain(times.last());
    Series::path(name, ends.map(|&time| [time, value])).marked(Mark::Dashes).coloured(Colour::Limit)
}

fn of_state(window: &Window<[f64; 4]>, name: &str, state: usize) -> Series {
    Series::path(name, window.iter().map(|(time, values)| [time, values[state]]))
}
