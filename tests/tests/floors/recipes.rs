//! The recipes of CONTRIBUTING.md name files that exist, and no more of them than a change of that kind may touch.

use std::fs;

use anyhow::{Context, Result};

use super::root;

/// The recipes, and the largest number of existing files that each may change.
const RECIPES: [(&str, usize); 5] = [
    ("A sixth system", 4),
    ("A sensor of the robot", 10),
    ("A stance detector", 4),
    ("A log format", 3),
    ("A resampler", 4),
];

/// The placeholder for a name that a contributor chooses.
const NAME: &str = "NAME";

#[test]
fn every_file_that_it_names_exists() -> Result<()> {
    let text = fs::read_to_string(root().join("CONTRIBUTING.md"))?;
    let paths: Vec<_> = text.lines().flat_map(paths).collect();
    assert!(!paths.is_empty());
    for path in paths {
        // Of files that are to be created, the folder exists.
        let known = path.split_once(NAME).map_or(path, |(folder, _)| folder);
        assert!(root().join(known).exists(), "CONTRIBUTING.md: there is no {path}");
    }
    Ok(())
}

#[test]
fn a_recipe_changes_few_files() -> Result<()> {
    let text = fs::read_to_string(root().join("CONTRIBUTING.md"))?;
    for (title, most) in RECIPES {
        let (_, recipe) = text.split_once(&format!("### {title}\n")).context(title)?;
        let recipe = recipe.split("\n#").next().unwrap_or_default();
        let rows = recipe.lines().filter_map(|line| line.strip_prefix("| ")?.split_once(" |"));
        let files = rows.map(|(files, _)| files).filter(|files| !files.starts_with("new:"));
        let changed = files.flat_map(paths).count();
        assert!((1..=most).contains(&changed), "{title}: {changed} files");
    }
    Ok(())
}

/// The paths, relative to the root, in the code spans of a line.
fn paths(line: &str) -> impl Iterator<Item = &str> {
    let code = line.split('`').skip(1).step_by(2);
    code.filter(|code| {
        let first = code.split('/').next().unwrap_or_default();
        !code.contains(' ') && !first.is_empty() && root().join(first).exists()
    })
}
