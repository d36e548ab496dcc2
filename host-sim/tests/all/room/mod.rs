//! A recording in a room with four anchors.

use std::fmt::Write;

use host_sim::random::{normal, stream};
use serde_json::Value;

use crate::program::{Desk, host_sim, json};

/// The anchors: two are high and two low, with the tag at one metre.
pub(crate) const ANCHORS: [[f64; 3]; 4] =
    [[0.0, 0.0, 2.0], [8.0, 0.0, 0.3], [8.0, 6.0, 2.0], [0.0, 6.0, 0.3]];
pub(crate) const HEIGHT: f64 = 1.0;

/// A recording as files on a desk: a tag on an ellipse for 40 s, with ten epochs per second.
pub(crate) struct Room {
    pub(crate) desk: Desk,
    pub(crate) anchors: String,
    pub(crate) log: String,
    pub(crate) truth: String,
}

pub(crate) fn place(t: f64) -> [f64; 2] {
    [4.0 + 2.0 * (0.2 * t).cos(), 3.0 + 1.5 * (0.2 * t).sin()]
}

pub(crate) fn distance(anchor: [f64; 3], [x, y]: [f64; 2]) -> f64 {
    ((x - anchor[0]).powi(2) + (y - anchor[1]).powi(2) + (HEIGHT - anchor[2]).powi(2)).sqrt()
}

impl Room {
    /// Writes the files; `spoil` may change each line of the log, given its time, anchor and range.
    pub(crate) fn new(
        biases: [f64; 4],
        spoil: impl Fn(usize, f64, usize, f64) -> Vec<String>,
    ) -> Self {
        let desk = Desk::new();
        let mut rng = stream(5, 0);
        let mut anchors = "anchor,x,y,z\n".to_owned();
        for (index, [x, y, z]) in ANCHORS.iter().enumerate() {
            let _ = writeln!(anchors, "A{index},{x},{y},{z}");
        }
        let (mut log, mut truth) = ("t,anchor,range\n".to_owned(), "t,x,y,z\n".to_owned());
        for epoch in 0..400 {
            let t = 0.1 * f64::from(epoch);
            let [x, y] = place(t);
            let _ = writeln!(truth, "{t:.3},{x:.5},{y:.5},{HEIGHT}");
            for (index, anchor) in ANCHORS.iter().enumerate() {
                let range = distance(*anchor, [x, y]) + biases[index] + normal(&mut rng, 0.03);
                for line in spoil(epoch as usize, t, index, range) {
                    let _ = writeln!(log, "{line}");
                }
            }
        }
        let [anchors, log, truth] = [
            desk.file("anchors.csv", anchors),
            desk.file("ranges.csv", log),
            desk.file("truth.csv", truth),
        ];
        Self { desk, anchors, log, truth }
    }

    pub(crate) fn clean() -> Self {
        Self::new([0.0; 4], |_, t, anchor, range| vec![line(t, anchor, range)])
    }

    pub(crate) fn replay<'a>(&'a self, more: &[&'a str]) -> Vec<&'a str> {
        let start = ["replay", "robot", "--anchors", &self.anchors, "--log", &self.log];
        [&start, more].concat()
    }

    /// The report of a replay compared with the truth.
    pub(crate) fn report(&self, more: &[&str]) -> Value {
        let with_truth = ["--truth", &self.truth, "--json"];
        json(&host_sim(&self.replay(&[&with_truth, more].concat())))
    }

    pub(crate) fn rmse(&self, more: &[&str]) -> f64 {
        self.report(more)["accuracy"]["rmse_m"].as_f64().expect("a number")
    }
}

pub(crate) fn line(t: f64, anchor: usize, range: f64) -> String {
    format!("{t:.3},A{anchor},{range:.4}")
}
