use std::collections::BTreeMap;

use serde_json::Value;

use super::Control;
use crate::Error;

/// How the controls stand: what a page sent, held against what there is to turn.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Settings(BTreeMap<&'static str, Value>);

impl Settings {
    /// Every control where it stands at first.
    pub fn initial(controls: &[Control]) -> Self {
        Self(controls.iter().map(|control| (control.name(), initial(control))).collect())
    }

    /// What was `sent`, the rest as at first.
    ///
    /// # Errors
    /// [`Error::Usage`] for a name that no control has, and a value that it cannot take.
    pub fn sent(
        controls: &[Control],
        sent: &serde_json::Map<String, Value>,
    ) -> Result<Self, Error> {
        let mut settings = Self::initial(controls);
        for (name, value) in sent {
            let control = controls
                .iter()
                .find(|control| control.name() == name)
                .ok_or_else(|| Error::Usage(format!("there is no control {name:?}")))?;
            if !takes(control, value) {
                return Err(Error::Usage(format!("{name} cannot be {value}")));
            }
            settings.0.insert(control.name(), value.clone());
        }
        Ok(settings)
    }

    /// Where a slider stands; 0 if there is none of that name.
    pub fn number(&self, name: &str) -> f64 {
        self.0.get(name).and_then(Value::as_f64).unwrap_or_default()
    }

    /// What is chosen; empty if there is no choice of that name.
    pub fn choice(&self, name: &str) -> &str {
        self.0.get(name).and_then(Value::as_str).unwrap_or_default()
    }

    /// Whether a switch is on; off if there is none of that name.
    pub fn is_on(&self, name: &str) -> bool {
        self.0.get(name).and_then(Value::as_bool).unwrap_or_default()
    }
}

fn initial(control: &Control) -> Value {
    match control {
        Control::Slider(slider) => Value::from(slider.value),
        Control::Choice(choice) => Value::from(choice.value.clone()),
        Control::Switch(switch) => Value::from(switch.value),
    }
}

fn takes(control: &Control, value: &Value) -> bool {
    match control {
        Control::Slider(slider) => {
            // A browser's slider ends on the last whole step, give or take its rounding.
            let slack = 1e-9 * slider.max.abs().max(slider.min.abs());
            value.as_f64().is_some_and(|v| (slider.min - slack..=slider.max + slack).contains(&v))
        }
        Control::Choice(choice) => value
            .as_str()
            .is_some_and(|chosen| choice.options.iter().any(|(name, _)| name == chosen)),
        Control::Switch(_) => value.is_boolean(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn controls() -> Vec<Control> {
        vec![
            Control::slider("threshold", "threshold", "g", [0.0, 1.0, 0.01], 0.1),
            Control::choice("tracker", "tracker", &[("ekf", "EKF"), ("lite", "the paper's")]),
            Control::switch("causal", "look only backwards", false),
        ]
    }

    #[test]
    fn what_is_not_sent_stands_as_at_first() -> Result<(), Error> {
        let sent = json!({ "threshold": 0.25, "causal": true });
        let settings = Settings::sent(&controls(), sent.as_object().unwrap())?;
        assert_eq!(settings.number("threshold"), 0.25);
        assert_eq!(settings.choice("tracker"), "ekf");
        assert!(settings.is_on("causal"));
        Ok(())
    }

    #[test]
    fn what_no_control_can_take_is_refused() {
        for sent in [
            json!({ "threshold": 2 }),
            json!({ "threshold": "high" }),
            json!({ "tracker": "best" }),
            json!({ "causal": 1 }),
            json!({ "speed": 1 }),
        ] {
            let refusal = Settings::sent(&controls(), sent.as_object().unwrap()).unwrap_err();
            assert!(!refusal.to_string().contains('\n'), "{refusal}");
        }
    }
}
