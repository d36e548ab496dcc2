//! The choice of a transmitter among several.

use std::collections::BTreeMap;
use std::path::Path;

use kestirim_replay::drone::Stop;

use super::flight::{Flight, Heard};
use crate::Error;
use crate::text::{listed, printable};

/// The transmitters that a log names, with the measurements of each.
#[derive(Debug)]
pub(super) struct Users<'a> {
    /// The transmitter to look for, if specified.
    wanted: Option<&'a str>,
    heard: BTreeMap<String, Vec<Stop>>,
}

/// The maximum number of transmitters named in an error message.
const MOST_NAMED: usize = 4;

impl<'a> Users<'a> {
    /// A collection without measurements.
    pub(super) fn new(wanted: Option<&'a str>) -> Self {
        Self { wanted, heard: BTreeMap::new() }
    }

    /// Stores a measurement, if it is usable, of the transmitter of this name, which may be empty. Returns whether this
    /// transmitter may be the one looked for.
    pub(super) fn hear(&mut self, name: &str, stop: Stop, is_usable: bool) -> bool {
        let name = name.trim();
        if !self.heard.contains_key(name) {
            self.heard.insert(name.to_owned(), Vec::new());
        }
        if let Some(stops) = self.heard.get_mut(name)
            && is_usable
        {
            stops.push(stop);
        }
        self.wanted.is_none_or(|wanted| wanted == name)
    }

    /// Assigns the measurements to a flight: those of the wanted transmitter, or else of the one heard most often,
    /// along with the others. Returns a description of the choice.
    ///
    /// # Errors
    /// [`Error::File`] if the wanted transmitter was not heard.
    pub(super) fn decide(
        mut self,
        path: &Path,
        flight: &mut Flight,
    ) -> Result<Option<String>, Error> {
        // Rows without a name belong to the only transmitter; if there are several, it is unknown to which one.
        let unnamed = self.heard.remove("").unwrap_or_default();
        let count = self.heard.len();
        let told = match self.wanted {
            Some(wanted) => {
                let Some(stops) = self.heard.remove(wanted) else {
                    return Err(self.refused(path, wanted));
                };
                flight.stops = stops;
                flight.transmitter = Some(wanted.to_owned());
                let wanted = printable(wanted);
                (count > 1).then(|| format!("transmitter {wanted} of {count}, chosen by --topic"))
            }
            None if count > 1 => {
                let most = |(_, a): &(&String, &Vec<Stop>), (_, b): &(&String, &Vec<Stop>)| {
                    a.len().cmp(&b.len())
                };
                // Of several heard equally often, the first is chosen.
                let name = self.heard.iter().rev().max_by(most).map(|(name, _)| name.clone());
                let name = name.unwrap_or_default();
                flight.stops = self.heard.remove(&name).unwrap_or_default();
                flight.unusable += unnamed.len();
                let heard = self.heard.into_iter();
                flight.others = heard.map(|(name, stops)| Heard { name, stops }).collect();
                let told = format!(
                    "transmitter {} of {count}, heard most often: --topic says another",
                    printable(&name)
                );
                flight.transmitter = Some(name);
                Some(told)
            }
            None => {
                flight.stops = unnamed;
                if let Some((name, stops)) = self.heard.pop_first() {
                    flight.stops.extend(stops);
                    flight.transmitter = Some(name);
                }
                None
            }
        };
        Ok(told)
    }

    /// The error that the wanted transmitter was not heard.
    fn refused(&self, path: &Path, wanted: &str) -> Error {
        let names = listed(self.heard.keys().map(String::as_str), MOST_NAMED);
        let wanted = printable(wanted);
        let problem = if self.heard.is_empty() {
            format!("--topic {wanted}: expected a column user that names transmitters, found none")
        } else {
            format!("--topic {wanted}: expected one of the transmitters {names}")
        };
        Error::File { path: path.to_path_buf(), problem }
    }
}

#[cfg(test)]
mod tests {
    use kestirim_import::Options;

    use super::super::flight;

    const LOG: &str = "t,x,y,h,rssi_db,user\n0,0,0,40,-50,a\n0,0,0,40,-70,b\n1,9,0,40,-51,a\n\
                       1,9,0,40,-71,b\n2,9,9,40,-52,a\n2,9,9,40,-72,b\n";

    fn read(text: &str, topic: Option<&str>) -> Result<(Vec<f64>, Vec<String>), String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        let options = Options { topic: topic.map(str::to_owned), ..Options::default() };
        let (flight, found) = flight::read(file.path(), &options).map_err(|error| {
            error.to_string().replace(&file.path().display().to_string(), "log.csv")
        })?;
        Ok((flight.stops.iter().map(|stop| stop.loss).collect(), found.import))
    }

    #[test]
    fn of_several_transmitters_one_is_chosen() {
        let (losses, told) = read(LOG, Some("b")).unwrap();
        assert_eq!(
            (losses, told),
            (vec![70.0, 71.0, 72.0], vec!["transmitter \"b\" of 2, chosen by --topic".to_owned()])
        );
        let (losses, told) = read(&format!("{LOG}3,9,9,40,-73,b\n"), None).unwrap();
        assert_eq!(losses, [70.0, 71.0, 72.0, 73.0]);
        assert_eq!(told, ["transmitter \"b\" of 2, heard most often: --topic says another"]);
        // Of several heard equally often, the first is chosen.
        assert_eq!(read(LOG, None).unwrap().0, [50.0, 51.0, 52.0]);
        assert_eq!(
            read(LOG, Some("c")).unwrap_err(),
            "log.csv: --topic \"c\": expected one of the transmitters \"a\", \"b\""
        );
    }

    #[test]
    fn the_only_one_needs_no_choice_and_a_choice_needs_a_column() {
        let alone = LOG.replace(",b\n", ",a\n");
        assert_eq!(read(&alone, None).unwrap().0.len(), 6);
        // Rows without a received signal, and a truncated line.
        let silent = format!("{alone}3,9,9,40,,\n4,9,9,40,,\n5,9,9,4");
        assert_eq!(read(&silent, None).unwrap().0.len(), 6);
        let without = LOG.replace(",user", ",remark");
        let (_, told) = read(&without, None).unwrap();
        assert_eq!(told, ["columns that are not used: \"remark\""]);
        assert_eq!(
            read(&without, Some("a")).unwrap_err(),
            "log.csv: --topic \"a\": expected a column user that names transmitters, found none"
        );
    }
}
