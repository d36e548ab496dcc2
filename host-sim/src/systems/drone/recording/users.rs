//! Which of several transmitters is looked for.

use std::collections::BTreeSet;
use std::path::Path;

use crate::Error;
use crate::text::{listed, printable};

/// The transmitters that a log names.
#[derive(Debug)]
pub(super) struct Users<'a> {
    /// The one that is looked for, if anybody says it.
    wanted: Option<&'a str>,
    heard: BTreeSet<String>,
}

/// So many are named in a complaint.
const MOST_NAMED: usize = 4;

impl<'a> Users<'a> {
    /// None was heard yet.
    pub(super) fn new(wanted: Option<&'a str>) -> Self {
        Self { wanted, heard: BTreeSet::new() }
    }

    /// Keeps a name, if there is one; whether it is the one that is looked for.
    pub(super) fn hear(&mut self, name: &str) -> bool {
        let name = name.trim();
        if !(name.is_empty() || self.heard.contains(name)) {
            self.heard.insert(name.to_owned());
        }
        self.wanted.is_none_or(|wanted| wanted == name)
    }

    /// What is to be told of the choice.
    ///
    /// # Errors
    /// [`Error::File`] if it is not known which of several is looked for, or it is none of them.
    pub(super) fn decided(&self, path: &Path) -> Result<Option<String>, Error> {
        let count = self.heard.len();
        let names = listed(self.heard.iter().map(String::as_str), MOST_NAMED);
        let refused = |problem| Err(Error::File { path: path.to_path_buf(), problem });
        match self.wanted {
            None if count > 1 => {
                refused(format!("expected one transmitter, found {names}: --topic says which"))
            }
            Some(wanted) if !self.heard.contains(wanted) => {
                let wanted = printable(wanted);
                refused(if count == 0 {
                    format!(
                        "--topic {wanted}: expected a column user that names transmitters, found none"
                    )
                } else {
                    format!("--topic {wanted}: expected one of the transmitters {names}")
                })
            }
            Some(wanted) if count > 1 => {
                Ok(Some(format!("transmitter {} of {count}, chosen by --topic", printable(wanted))))
            }
            _ => Ok(None),
        }
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
        assert_eq!(
            read(LOG, None).unwrap_err(),
            "log.csv: expected one transmitter, found \"a\", \"b\": --topic says which"
        );
        assert_eq!(
            read(LOG, Some("c")).unwrap_err(),
            "log.csv: --topic \"c\": expected one of the transmitters \"a\", \"b\""
        );
    }

    #[test]
    fn the_only_one_needs_no_choice_and_a_choice_needs_a_column() {
        let alone = LOG.replace(",b\n", ",a\n");
        assert_eq!(read(&alone, None).unwrap().0.len(), 6);
        // Rows in which nothing was heard, and a line that is cut.
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
