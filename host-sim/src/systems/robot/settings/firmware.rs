//! The settings of a tracker as firmware says them.

use super::{Dimensions, Setup, TrackerKind};
use crate::system::Literal;
use crate::systems::robot::settings::tuning::Tuning;

impl Setup {
    /// The same in firmware: the tracker's configuration, and for a recording (`with_anchors`) its anchors.
    pub(in crate::systems::robot) fn firmware(&self, with_anchors: bool) -> String {
        let height = self.number(self.height_m);
        let scalar = Literal::number_type(self.scalar);
        let config = format!("Config::<{scalar}>");
        let of_the_tracker = |base: &str| {
            let base = format!("Config::{base}({height})");
            self.literal("kestirim_uwb_tracker::Config", &config, &base)
        };
        let literal = match self.tracker {
            TrackerKind::Lsq | TrackerKind::Nls => {
                let base = format!("Solver::new({height})");
                self.literal("kestirim_uwb_ranging::Solver", &format!("Solver::<{scalar}>"), &base)
            }
            TrackerKind::AekfPublished => {
                let config = format!("PublishedConfig::<{scalar}, {}>", self.axes());
                let base = format!("PublishedConfig::adaptive({height})");
                self.literal("kestirim_uwb_tracker::PublishedConfig", &config, &base)
            }
            TrackerKind::Ekf => self.with_noises(of_the_tracker("plain")),
            TrackerKind::Aekf => {
                let [forgetting, least, most] =
                    TrackerKind::AEKF_LEARNING.map(|value| self.number(value));
                let learning = format!("Learning::new({forgetting}, {least}, {most}).ok()");
                self.with_noises(of_the_tracker("plain"))
                    .import("kestirim_adaptive_kalman::Learning")
                    .field("learning", learning)
            }
            TrackerKind::Default if self.biases.is_some() => {
                self.with_robustness(of_the_tracker("calibrated"))
            }
            TrackerKind::Default => self.with_robustness(of_the_tracker("uncalibrated")),
        };
        let literal = self.with_room(literal);
        if with_anchors { self.with_anchors(literal) } else { literal }.to_string()
    }

    fn number(&self, value: f64) -> String {
        Literal::number(self.scalar, value)
    }

    fn literal(&self, import: &str, config: &str, base: &str) -> Literal {
        Literal::new(import, self.scalar, config, base)
    }

    const fn axes(&self) -> usize {
        match self.dimensions {
            Dimensions::Two => 2,
            Dimensions::Three => 3,
        }
    }

    fn with_noises(&self, literal: Literal) -> Literal {
        let (tuning, own) = (self.tuning, Tuning::default());
        let differing =
            |value: f64, own: f64| Some(value).filter(|&value| Some(value) != Some(own));
        literal
            .number_field("range_sigma", differing(tuning.range_sigma_m, own.range_sigma_m))
            .number_field(
                "acceleration_density",
                differing(tuning.acceleration_density, own.acceleration_density),
            )
    }

    fn with_robustness(&self, literal: Literal) -> Literal {
        let (tuning, own) = (self.tuning, Tuning::default());
        let some = |value: Option<String>| match value {
            Some(value) => format!("Some({value})"),
            None => "None".to_owned(),
        };
        let mut literal = self.with_noises(literal);
        if tuning.gate_sigmas != own.gate_sigmas {
            let square = tuning.gate_sigmas.map(|sigmas| self.number(sigmas * sigmas));
            literal = literal.field("gate", some(square));
        }
        if tuning.huber_sigmas != own.huber_sigmas {
            if tuning.huber_sigmas.is_some() {
                literal = literal.import("kestirim_uwb_ranging::Huber");
            }
            let huber = tuning.huber_sigmas.map(|sigmas| sigmas.map(|sigma| self.number(sigma)));
            let huber =
                huber.map(|[long, short]| format!("Huber {{ long: {long}, short: {short} }}"));
            literal = literal.field("huber", some(huber));
        }
        if tuning.learns != own.learns {
            literal = literal.field("learning", "None");
        }
        if tuning.decay_time_s != own.decay_time_s {
            let seconds = tuning.decay_time_s.map(|seconds| self.number(seconds));
            literal = literal.field("decay_time", some(seconds));
        }
        literal
    }

    fn with_room(&self, literal: Literal) -> Literal {
        let acts = !matches!(self.tracker, TrackerKind::Lsq | TrackerKind::AekfPublished);
        let Some(corners) = self.room.filter(|_| acts) else { return literal };
        let corners = corners.map(|metres| self.number(metres)).join(", ");
        literal
            .import("kestirim_uwb_ranging::Room")
            .field("room", format!("Some(Room::plane({corners}))"))
    }

    fn with_anchors(&self, literal: Literal) -> Literal {
        let anchors = self.anchors.iter().enumerate().map(|(index, place)| {
            let place = place.map(|metres| self.number(metres)).join(", ");
            let bias = self.number(self.bias(index));
            format!("\n    Anchor {{ position: [{place}].into(), bias: {bias} }},")
        });
        let anchors = anchors.collect::<String>();
        let (scalar, count) = (Literal::number_type(self.scalar), self.anchors.len());
        let (axes, states) = (self.axes(), 2 * self.axes());
        let method = match self.tracker {
            TrackerKind::Lsq => "EpochMethod::Trilateration, ",
            TrackerKind::Nls => "EpochMethod::LeastSquares, ",
            _ => "",
        };
        let (name, parameters) = match self.tracker {
            TrackerKind::Lsq | TrackerKind::Nls => ("EpochSolver", format!("{scalar}, {count}")),
            TrackerKind::AekfPublished => {
                ("PublishedTracker", format!("{scalar}, {axes}, {states}, {count}"))
            }
            TrackerKind::Default if self.biases.is_none() => {
                ("Tracker", format!("{scalar}, {axes}, {}, {count}", states + 1))
            }
            _ => ("Tracker", format!("{scalar}, {axes}, {states}, {count}")),
        };
        let mut literal = literal
            .import("kestirim_uwb_tracker::Anchor")
            .import(&format!("kestirim_uwb_tracker::{name}"));
        if !method.is_empty() {
            literal = literal.import("kestirim_uwb_tracker::EpochMethod");
        }
        literal
            .then(format!("let anchors = [{anchors}\n];"))
            .then(format!("let tracker = {name}::<{parameters}>::new({method}config, &anchors);"))
    }
}
