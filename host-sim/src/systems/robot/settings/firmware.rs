//! The settings of a tracker in the form of firmware source.

use kestirim_replay::robot::{Dimensions, Setup, TrackerKind, Tuning};

use crate::system::Literal;

/// The equivalent configuration of firmware: that of the tracker, and for a recording (`with_anchors`) the anchors.
pub(in crate::systems::robot) fn firmware(setup: &Setup, with_anchors: bool) -> String {
    Said(setup).firmware(with_anchors)
}

/// A setup, to be written as firmware source.
struct Said<'a>(&'a Setup);

impl Said<'_> {
    fn firmware(&self, with_anchors: bool) -> String {
        let height = self.number(self.0.height_m);
        let scalar = Literal::number_type(self.0.scalar);
        let config = format!("Config::<{scalar}>");
        let of_the_tracker = |base: &str| {
            let base = format!("Config::{base}({height})");
            self.literal("kestirim_uwb_tracker::Config", &config, &base)
        };
        let literal = match self.0.tracker {
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
                let learning = "kestirim_adaptive_kalman::Learning::new";
                let learning = format!("{learning}({forgetting}, {least}, {most}).ok()");
                self.with_noises(of_the_tracker("plain")).field("learning", learning)
            }
            TrackerKind::Default if self.0.biases.is_some() => {
                self.with_robustness(of_the_tracker("calibrated"))
            }
            TrackerKind::Default => self.with_robustness(of_the_tracker("uncalibrated")),
        };
        let literal = self.with_room(literal);
        if with_anchors { self.with_anchors(literal) } else { literal }.to_string()
    }

    fn number(&self, value: f64) -> String {
        Literal::number(self.0.scalar, value)
    }

    fn literal(&self, import: &str, config: &str, base: &str) -> Literal {
        Literal::new(import, self.0.scalar, config, base)
    }

    const fn axes(&self) -> usize {
        match self.0.dimensions {
            Dimensions::Two => 2,
            Dimensions::Three => 3,
        }
    }

    fn with_noises(&self, literal: Literal) -> Literal {
        let (tuning, own) = (self.0.tuning, Tuning::default());
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
        let (tuning, own) = (self.0.tuning, Tuning::default());
        let number = |value| self.number(value);
        let huber = tuning.huber_sigmas.map(|sigmas| {
            let [long, short] = sigmas.map(number);
            format!("kestirim_uwb_ranging::Huber {{ long: {long}, short: {short} }}")
        });
        let gate = tuning.gate_sigmas.map(|sigmas| number(sigmas * sigmas));
        let fields = [
            ("gate", tuning.gate_sigmas != own.gate_sigmas, gate),
            ("huber", tuning.huber_sigmas != own.huber_sigmas, huber),
            ("learning", tuning.learns != own.learns, None),
            (
                "decay_time",
                tuning.decay_time_s != own.decay_time_s,
                tuning.decay_time_s.map(number),
            ),
        ];
        let differing = fields.into_iter().filter(|(_, differs, _)| *differs);
        differing.fold(self.with_noises(literal), |literal, (name, _, value)| {
            let value = value.map_or_else(|| "None".to_owned(), |value| format!("Some({value})"));
            literal.field(name, value)
        })
    }

    fn with_room(&self, literal: Literal) -> Literal {
        let acts = !matches!(self.0.tracker, TrackerKind::Lsq | TrackerKind::AekfPublished);
        let Some(corners) = self.0.room.filter(|_| acts) else { return literal };
        let corners = corners.map(|metres| self.number(metres)).join(", ");
        literal.field("room", format!("Some(kestirim_uwb_ranging::Room::plane({corners}))"))
    }

    fn with_anchors(&self, literal: Literal) -> Literal {
        let anchors = self.0.anchors.iter().enumerate().map(|(index, place)| {
            let place = place.map(|metres| self.number(metres)).join(", ");
            let bias = self.number(self.0.bias(index));
            format!("\n    Anchor {{ position: [{place}].into(), bias: {bias} }},")
        });
        let anchors = anchors.collect::<String>();
        let (scalar, count) = (Literal::number_type(self.0.scalar), self.0.anchors.len());
        let (axes, states) = (self.axes(), 2 * self.axes());
        let (name, parameters, method) = match self.0.tracker {
            TrackerKind::Lsq => ("EpochSolver", String::new(), "EpochMethod::Trilateration, "),
            TrackerKind::Nls => ("EpochSolver", String::new(), "EpochMethod::LeastSquares, "),
            TrackerKind::AekfPublished => ("PublishedTracker", format!("{axes}, {states}, "), ""),
            TrackerKind::Default if self.0.is_wheeled() => ("WheelTracker", String::new(), ""),
            TrackerKind::Default if self.0.biases.is_none() => {
                ("Tracker", format!("{axes}, {}, ", states + 1), "")
            }
            _ => ("Tracker", format!("{axes}, {states}, "), ""),
        };
        let mut literal = literal
            .import("kestirim_uwb_tracker::Anchor")
            .import(&format!("kestirim_uwb_tracker::{name}"));
        if !method.is_empty() {
            literal = literal.import("kestirim_uwb_tracker::EpochMethod");
        }
        let tracker = format!("{name}::<{scalar}, {parameters}{count}>");
        literal
            .then(format!("let anchors = [{anchors}\n];"))
            .then(format!("let tracker = {tracker}::new({method}config, &anchors);"))
    }
}
