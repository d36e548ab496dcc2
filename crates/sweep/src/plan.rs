//! Plans: grids of what is to be tried, read from TOML.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use toml::{Table, Value};

use crate::{Error, hex};

/// A plan as written in TOML.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Written {
    system: Option<String>,
    systems: Vec<String>,
    seeds: Option<Vec<u64>>,
    trials: Option<u64>,
    scalar: Option<String>,
    shards: Option<u64>,
    settings: Table,
    config: Vec<Table>,
    logs: Option<String>,
    files: BTreeMap<String, Texts>,
}

/// One text or several.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Texts {
    One(String),
    Several(Vec<String>),
}

/// A plan: studies that are carried out one after the other, each made of trials or of recordings.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// The studies: all combinations of what the plan lists.
    pub studies: Vec<Study>,
    /// The recordings, each of which goes through every study; `None` if the studies are experiments.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub logs: Option<Logs>,
    /// The number of shards, unless set otherwise. It does not affect the results.
    #[serde(skip)]
    pub shards: Option<u64>,
    /// The folder to which paths are relative.
    #[serde(skip)]
    pub folder: PathBuf,
}

/// One system with one set of settings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// The name of the system.
    pub system: String,
    /// The seed of all randomness.
    pub seed: u64,
    /// The number of trials; `None` leaves it to the experiment.
    pub trials: Option<u64>,
    /// The number type; `None` leaves it to the system.
    pub scalar: Option<String>,
    /// The settings and their values, as texts like those of command-line options.
    pub settings: BTreeMap<String, String>,
}

/// The recordings of a plan.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Logs {
    /// Their paths in order, relative to the plan's folder.
    pub paths: Vec<PathBuf>,
    /// Other files: paths by the name of their option, relative to the plan's folder. `{dir}` stands for the folder of
    /// the recording, `{stem}` for its name without the extension, also without one before `.gz`.
    pub files: BTreeMap<String, Vec<String>>,
}

impl Logs {
    /// The other files of a recording: the option of each, and paths relative to the plan's folder.
    pub fn of(&self, path: &Path) -> Vec<(&str, Vec<PathBuf>)> {
        let dir = path.parent().filter(|dir| !dir.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let dir = dir.to_string_lossy();
        let unpacked = if path.extension().is_some_and(|it| it == "gz") {
            path.with_extension("")
        } else {
            path.to_owned()
        };
        let stem = unpacked.file_stem().unwrap_or_default().to_string_lossy();
        let named =
            |text: &String| PathBuf::from(text.replace("{dir}", &dir).replace("{stem}", &stem));
        self.files
            .iter()
            .map(|(name, texts)| (name.as_str(), texts.iter().map(named).collect()))
            .collect()
    }
}

impl Plan {
    /// Reads a plan.
    ///
    /// # Errors
    /// An error that names the file, the line and what was expected there.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let text = fs::read_to_string(path).map_err(Error::read(path))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(&text, folder).map_err(|Complaint { at, problem }| match at {
            Some(at) => {
                let line = 1 + text.bytes().take(at).filter(|&byte| byte == b'\n').count();
                Error::Line { path: path.to_owned(), line, problem }
            }
            None => Error::file(path, problem),
        })
    }

    fn parse(text: &str, folder: &Path) -> Result<Self, Complaint> {
        let written: Written = toml::from_str(text).map_err(|error| Complaint {
            at: error.span().map(|span| span.start),
            problem: error.message().lines().collect::<Vec<_>>().join("; "),
        })?;
        let systems = match (written.system, written.systems) {
            (Some(one), several) if several.is_empty() => vec![one],
            (None, several) if !several.is_empty() => several,
            _ => return Err("expected system = \"NAME\" or systems = [\"NAME\", …]".into()),
        };
        let configs = configs(&written.settings, &written.config)?;
        let seeds = written.seeds.unwrap_or_else(|| vec![0]);
        let Written { trials, scalar, shards, .. } = written;
        if trials == Some(0) || shards == Some(0) {
            return Err("expected trials and shards of 1 and more".into());
        }
        let mut studies = Vec::new();
        for system in &systems {
            for settings in &configs {
                studies.extend(seeds.iter().map(|&seed| Study {
                    system: system.clone(),
                    seed,
                    trials,
                    scalar: scalar.clone(),
                    settings: settings.clone(),
                }));
            }
        }
        if studies.is_empty() {
            return Err("expected a seed and a config at least, as there would be no trial".into());
        }
        let files: BTreeMap<_, _> = written
            .files
            .into_iter()
            .map(|(name, texts)| match texts {
                Texts::One(text) => (name, vec![text]),
                Texts::Several(texts) => (name, texts),
            })
            .collect();
        let logs = match written.logs {
            Some(_) if systems.len() > 1 || seeds.len() > 1 || trials.is_some() => {
                return Err("logs are of one system, without seeds and trials".into());
            }
            None if !files.is_empty() => return Err("files are for logs = \"PATTERN\"".into()),
            Some(pattern) => Some(Logs { paths: find(&pattern, folder)?, files }),
            None => None,
        };
        Ok(Self { studies, logs, shards, folder: folder.to_owned() })
    }

    /// The identity of the plan: the SHA-256 of everything that affects the results, in hexadecimal.
    pub fn hash(&self) -> String {
        // Maps of texts and numbers can always be written as JSON.
        let text = serde_json::to_string(self).unwrap_or_default();
        hex(&Sha256::digest(text))
    }
}

/// A problem in a plan, and the byte at which it was found.
struct Complaint {
    at: Option<usize>,
    problem: String,
}

impl<T: Into<String>> From<T> for Complaint {
    fn from(problem: T) -> Self {
        Self { at: None, problem: problem.into() }
    }
}

/// Every combination of the lists among the settings: of each config together with the common settings, which it
/// overrides.
fn configs(common: &Table, configs: &[Table]) -> Result<Vec<BTreeMap<String, String>>, Complaint> {
    let none = [Table::new()];
    let configs = if configs.is_empty() { &none } else { configs };
    let mut all = Vec::new();
    for config in configs {
        let mut combinations = vec![BTreeMap::new()];
        for (name, value) in common.iter().filter(|(name, _)| !config.contains_key(*name)) {
            combinations = each(combinations, name, value)?;
        }
        for (name, value) in config {
            combinations = each(combinations, name, value)?;
        }
        all.extend(combinations);
    }
    Ok(all)
}

fn each(
    combinations: Vec<BTreeMap<String, String>>,
    name: &str,
    value: &Value,
) -> Result<Vec<BTreeMap<String, String>>, Complaint> {
    let texts = match value {
        Value::Array(values) => values.iter().map(|value| text(name, value)).collect(),
        value => text(name, value).map(|text| vec![text]),
    }?;
    let with = |settings: BTreeMap<String, String>| {
        texts.iter().map(move |text| {
            let mut settings = settings.clone();
            settings.insert(name.to_owned(), text.clone());
            settings
        })
    };
    Ok(combinations.into_iter().flat_map(with).collect())
}

fn text(name: &str, value: &Value) -> Result<String, Complaint> {
    match value {
        Value::String(text) => Ok(text.clone()),
        Value::Integer(number) => Ok(number.to_string()),
        Value::Float(number) => Ok(number.to_string()),
        Value::Boolean(switch) => Ok(switch.to_string()),
        _ => Err(format!("{name}: expected a value or a list of values").into()),
    }
}

/// The files that a pattern names, relative to a folder, in order. Hidden ones are left out.
///
/// # Errors
/// [`Error::Refused`] if the pattern is invalid or names no file.
pub fn matching(pattern: &str, folder: &Path) -> Result<Vec<PathBuf>, Error> {
    find(pattern, folder).map_err(|complaint| Error::Refused(complaint.problem))
}

fn find(pattern: &str, folder: &Path) -> Result<Vec<PathBuf>, Complaint> {
    let begin = if folder.as_os_str().is_empty() { PathBuf::new() } else { folder.to_owned() };
    let begin_text = begin.to_str().ok_or("the plan's folder has a name that is no Unicode")?;
    let whole = Path::new(&glob::Pattern::escape(begin_text)).join(pattern);
    let options =
        glob::MatchOptions { require_literal_leading_dot: true, ..glob::MatchOptions::new() };
    let found = glob::glob_with(&whole.to_string_lossy(), options)
        .map_err(|error| format!("{pattern:?} is no pattern of files: {error}"))?;
    let mut paths = Vec::new();
    for path in found {
        let path = path.map_err(|error| error.to_string())?;
        if path.is_file() {
            paths.push(path.strip_prefix(&begin).map_or(path.clone(), Path::to_owned));
        }
    }
    if paths.is_empty() {
        return Err(format!("{pattern:?} names no file").into());
    }
    paths.sort();
    Ok(paths)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(text: &str) -> Result<Plan, String> {
        Plan::parse(text, Path::new("")).map_err(|complaint| complaint.problem)
    }

    #[test]
    fn a_list_is_every_combination() {
        let plan = plan(
            "system = 'boat'\nseeds = [1, 2]\ntrials = 5\nshards = 3\n[settings]\nspeed = [3, 4.5]\nquiet = true\n\
             [[config]]\nfilter = ['a', 'b']\n[[config]]\nfilter = 'c'\nspeed = 7",
        )
        .unwrap();
        let told: Vec<_> = plan
            .studies
            .iter()
            .map(|study| {
                (study.settings["filter"].as_str(), study.settings["speed"].as_str(), study.seed)
            })
            .collect();
        let expected = [
            ("a", "3", 1),
            ("a", "3", 2),
            ("b", "3", 1),
            ("b", "3", 2),
            ("a", "4.5", 1),
            ("a", "4.5", 2),
            ("b", "4.5", 1),
            ("b", "4.5", 2),
            ("c", "7", 1),
            ("c", "7", 2),
        ];
        assert_eq!(told, expected);
        assert!(plan.studies.iter().all(|study| study.settings["quiet"] == "true"));
        assert_eq!(plan.shards, Some(3));
    }

    #[test]
    fn only_what_is_done_tells_plans_apart() {
        let hash = |text: &str| plan(text).unwrap().hash();
        let one = hash("system = 'boat'\ntrials = 5\nshards = 3");
        assert_eq!(one, hash("# the same\nsystems = ['boat']\nseeds = [0]\ntrials = 5"));
        assert_ne!(one, hash("system = 'boat'\ntrials = 6"));
        assert_ne!(one, hash("system = 'boat'\ntrials = 5\n[settings]\nspeed = 1"));
        assert_eq!(one.len(), 64);
    }

    #[test]
    fn what_is_no_plan_is_refused_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.toml");
        for (text, expected) in [
            ("trials = 5", "expected system"),
            ("system = 'boat'\ntrails = 5", "line 2: unknown field `trails`"),
            ("system = 'boat'\ntrials = -5", "line 2"),
            ("system = 'boat'\ntrials = 0", "of 1 and more"),
            ("system = 'boat'\nseeds = []", "no trial"),
            ("system = 'boat'\n[settings]\nspeed = {}", "speed: expected a value"),
            ("system = 'boat'\nlogs = 'none/**'", "names no file"),
            ("system = 'boat'\nlogs = 'a***'", "no pattern"),
            ("system = 'boat'\n[files]\nmap = 'a'", "for logs"),
            ("system = 'boat", "line 1"),
        ] {
            fs::write(&path, text).unwrap();
            let sentence = Plan::read(&path).unwrap_err().to_string();
            assert!(sentence.contains(expected) && !sentence.contains('\n'), "{text}: {sentence}");
        }
    }

    #[test]
    fn recordings_are_found_from_the_plan() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b/two.csv", "a/one.csv", "a/.hidden.csv", "a/one.txt"] {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        let path = folder.path().join("plan.toml");
        fs::write(&path, "system = 'boat'\nlogs = '**/*.csv'\n[files]\nmap = 'm'").unwrap();
        let logs = Plan::read(&path).unwrap().logs.unwrap();
        assert_eq!(logs.paths, ["a/one.csv", "b/two.csv"].map(PathBuf::from));
        assert_eq!(logs.files["map"], ["m"]);
        let files = BTreeMap::from([("map".to_owned(), vec!["{dir}/{stem}.map".to_owned()])]);
        let logs = Logs { files, ..logs };
        for recording in ["a/one.csv", "a/one.csv.gz"] {
            let map = PathBuf::from("a/one.map");
            assert_eq!(logs.of(Path::new(recording)), [("map", vec![map])], "{recording}");
        }
    }
}
