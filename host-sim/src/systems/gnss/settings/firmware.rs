//! Settings in the form of firmware source.

use kestirim_gnss_ppp::{Correction, Corrections};
use kestirim_ppp_filter::{Config, Motion};
use kestirim_replay::gnss::FilterKind;
use kestirim_robust_kalman::{Igg3, Weight};

use super::Setup;
use crate::system::{Literal, ScalarKind};

impl Setup {
    /// The equivalent configuration of firmware: the filter's settings and the corrections of the receiver.
    pub(in crate::systems::gnss) fn firmware(&self) -> String {
        let filter = self.main();
        let motion = match self.motion {
            Motion::Static => "Motion::Static".to_owned(),
            Motion::Kinematic { process_noise } => {
                format!("Motion::Kinematic {{ process_noise: {process_noise:?} }}")
            }
        };
        let base = format!("Config::new({motion})");
        let imports = "kestirim_ppp_filter::{Config, Motion}";
        let own = Config::new(self.motion);
        let gradient = Some(self.config(filter).gradient);
        let mut literal = Literal::new(imports, ScalarKind::F64, "Config", &base)
            .number_field("elevation_mask", self.mask.filter(|mask| *mask != own.elevation_mask))
            .number_field("gradient", gradient.filter(|it| *it != own.gradient));
        let constructor = match filter {
            FilterKind::Gkf => "plain()",
            FilterKind::Rkf => "igg3()",
            FilterKind::Skf => "t_test()",
            FilterKind::Ikf => "iterative_igg3()",
            FilterKind::Adaptive => "adaptive()",
            FilterKind::Default => &format!("guarded({motion})"),
        };
        let mut changes = Vec::new();
        if self.published && filter.is_published() {
            changes.push("estimator.robust = estimator.robust.published();".to_owned());
        }
        let weight = self.config(filter).estimator.robust.weight;
        if let (true, Weight::Igg3(Igg3 { k0, k1, descent })) =
            (filter.has_thresholds() && self.thresholds != [None; 2], weight)
        {
            literal = literal.import("kestirim_robust_kalman::{Descent, Igg3, Weight}");
            changes.push(format!(
                "estimator.robust.weight = Weight::Igg3(Igg3 {{ k0: {k0:?}, k1: {k1:?}, descent: \
                 Descent::{descent:?} }});"
            ));
        }
        if !changes.is_empty() || filter.estimator(self.motion, false) != own.estimator {
            let value = match &*changes {
                [] => format!("Estimator::{constructor}"),
                changes => format!(
                    "{{\n        let mut estimator = Estimator::{constructor};\n        {}\n        estimator\n    }}",
                    changes.join("\n        ")
                ),
            };
            literal = literal.import("kestirim_ppp_filter::Estimator").field("estimator", value);
        }
        if self.corrections != Corrections::ALL {
            let left_out = Correction::ALL.iter().filter(|part| !self.corrections.has(**part));
            let without = left_out.map(|part| format!(".without(Correction::{part:?})"));
            let without = without.collect::<Vec<_>>().concat();
            literal = literal
                .import("kestirim_gnss_ppp::{Correction, Corrections}")
                .then(format!("let corrections = Corrections::ALL{without};"));
        }
        literal.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::super::table;
    use super::*;
    use crate::system::Settings;

    #[test]
    fn firmware_says_what_differs() -> Result<(), crate::Error> {
        let mut settings = Settings::new(table(None));
        assert!(Setup::of(&settings).firmware().ends_with("= Config::new(Motion::Static);"));
        for (name, text) in [("filter", "rkf"), ("published", "true"), ("k0", "2"), ("mask", "15")]
        {
            settings.set(name, text)?;
        }
        let firmware = Setup::of(&settings).firmware();
        for line in [
            "elevation_mask: 0.2617993877991494",
            "let mut estimator = Estimator::igg3();",
            "estimator.robust = estimator.robust.published();",
            "Igg3 { k0: 2.0, k1: 6.0, descent: Descent::Published }",
        ] {
            assert!(firmware.contains(line), "{firmware}");
        }
        Ok(())
    }
}
