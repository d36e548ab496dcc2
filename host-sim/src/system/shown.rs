//! The presentation of a setting on the command line and the page.

use clap::builder::{PossibleValuesParser, StringValueParser, TypedValueParser};
use clap::{Arg, ArgAction};
use serde_json::{Map, json};

use super::kind::{Kind, Named, Number, in_words, names};
use super::setting::Setting;

impl Setting {
    /// The option's name without its dashes.
    pub fn option(&self) -> String {
        match self.kind {
            Kind::Switch { default: true } => format!("no-{}", self.name),
            _ => self.name.to_owned(),
        }
    }

    /// The options of the command line.
    pub fn arguments(&self) -> Vec<Arg> {
        let flag = |&(name, choice): &(&'static str, &'static str)| {
            let help = format!("As --{} {choice}", self.name);
            let arg = Arg::new(name).long(name).help(help).action(ArgAction::SetTrue);
            arg.conflicts_with(self.name)
        };
        std::iter::once(self.argument()).chain(self.flags.iter().map(flag)).collect()
    }

    fn argument(&self) -> Arg {
        let arg = Arg::new(self.name).long(self.option()).help(self.help_with_default());
        let arg = if let Some(alias) = self.alias { arg.alias(alias) } else { arg };
        let setting = self.clone();
        let read = move |text: String| setting.read(&text);
        match &self.kind {
            Kind::Switch { .. } => arg.action(ArgAction::SetTrue),
            Kind::Number(_) | Kind::Text { .. } => arg
                .value_name(self.form())
                .allow_hyphen_values(true)
                .value_parser(StringValueParser::new().try_map(read)),
            Kind::Choice { of, .. } if self.shorthand.is_some() => {
                let form = self.shorthand.map_or("NAME", |shorthand| shorthand.form);
                arg.value_name(form)
                    .help(format!("{}: {}", self.help_with_default(), names(of)))
                    .value_parser(StringValueParser::new().try_map(read))
            }
            Kind::Choice { of, .. } | Kind::Set { of } => {
                let values = PossibleValuesParser::new(of.iter().map(Named::possible));
                let arg = arg.value_name("NAME").value_parser(values.try_map(read));
                let many = matches!(self.kind, Kind::Set { .. });
                arg.action(if many { ArgAction::Append } else { ArgAction::Set })
            }
        }
    }

    /// The page's control, as JSON.
    pub fn control(&self) -> serde_json::Value {
        let mut control = Map::new();
        control.insert("name".to_owned(), json!(self.name));
        control.insert("label".to_owned(), json!(self.help));
        let options = |of: &[Named]| -> serde_json::Value {
            of.iter().map(|named| json!([named.name, named.label])).collect()
        };
        let rest = match &self.kind {
            Kind::Number(number) => number.control(),
            Kind::Choice { of, default } => {
                json!({ "kind": "choice", "options": options(of), "value": default })
            }
            Kind::Set { of } => json!({ "kind": "set", "options": options(of) }),
            Kind::Switch { default } => json!({ "kind": "switch", "value": default }),
            Kind::Text { form, .. } => json!({ "kind": "text", "form": form }),
        };
        if let serde_json::Value::Object(rest) = rest {
            control.extend(rest);
        }
        control.into()
    }

    fn help_with_default(&self) -> String {
        let help = self.help;
        match &self.kind {
            Kind::Number(Number { unit, default: Some(default), .. }) => {
                format!("{help} [default: {}]", format!("{default} {unit}").trim_end())
            }
            Kind::Choice { default, .. } => format!("{help} [default: {default}]"),
            Kind::Switch { default: true } => {
                let mut words = help.chars();
                let first = words.next().into_iter().flat_map(char::to_lowercase);
                format!("Do not {}{}", first.collect::<String>(), words.as_str())
            }
            _ => help.to_owned(),
        }
    }

    /// The form of values on the command line: `METRES`, `X,Y,Z`, `P1|P2`.
    pub fn form(&self) -> String {
        let unit = match &self.kind {
            Kind::Number(number) => number.unit,
            Kind::Text { form, .. } => return (*form).to_owned(),
            Kind::Choice { of, .. } | Kind::Set { of } => {
                return of.iter().map(|named| named.name.as_str()).collect::<Vec<_>>().join("|");
            }
            Kind::Switch { .. } => return String::new(),
        };
        match unit {
            "" => "N".to_owned(),
            unit => in_words(unit).to_uppercase(),
        }
    }
}

impl Number {
    fn control(&self) -> serde_json::Value {
        json!({
            "kind": "slider",
            "unit": self.unit,
            "min": self.min,
            "max": self.max,
            "step": self.step,
            "value": self.initially,
            "logarithmic": self.logarithmic,
            "playable": self.playable,
        })
    }
}
