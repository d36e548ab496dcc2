//! All linked code may be distributed under our licences, and comes from crates.io, as `deny.toml` requires;
//! `cargo deny` reads that file, too.

use std::fs;

use anyhow::{Context, Result, ensure};
use cargo_metadata::{MetadataCommand, Package};
use spdx::{Expression, LicenseReq, ParseMode};
use toml::Table;

/// What `deny.toml` allows.
struct Allowed {
    licences: Vec<String>,
    registries: Vec<String>,
}

impl Allowed {
    fn read() -> Result<Self> {
        let file: Table = fs::read_to_string(super::root().join("deny.toml"))?.parse()?;
        let texts = |table: &str, key: &str| -> Result<Vec<String>> {
            let list = file[table][key].as_array().context("a list")?;
            list.iter().map(|it| Ok(it.as_str().context("a text")?.to_owned())).collect()
        };
        Ok(Self {
            licences: texts("licenses", "allow")?,
            registries: texts("sources", "allow-registry")?,
        })
    }

    fn allows(&self, package: &Package) -> Result<bool> {
        let Some(licence) = licence(package)? else { return Ok(false) };
        let expression = Expression::parse_mode(&licence, ParseMode::LAX)?;
        let is_allowed = |req: &LicenseReq| self.licences.contains(&req.to_string());
        let source = package.source.as_ref().map(ToString::to_string);
        let from = |registry: &String| {
            source.as_ref().is_none_or(|source| *source == format!("registry+{registry}"))
        };
        Ok(expression.evaluate(is_allowed) && self.registries.iter().any(from))
    }
}

/// The licence that a package declares, or with which its licence file begins.
fn licence(package: &Package) -> Result<Option<String>> {
    if package.license.is_some() {
        return Ok(package.license.clone());
    }
    let Some(file) = package.license_file() else { return Ok(None) };
    let text = fs::read_to_string(file)?;
    Ok(text.starts_with("MIT License").then(|| "MIT".to_owned()))
}

#[test]
fn everything_may_be_given_away_and_comes_from_the_registry() -> Result<()> {
    let allowed = Allowed::read()?;
    let workspaces = [
        "Cargo.toml",
        "crates/c/staticlib/Cargo.toml",
        "tests/firmware/Cargo.toml",
        "tests/fuzz/Cargo.toml",
    ];
    for manifest in workspaces {
        let mut metadata = MetadataCommand::new();
        // A lock file that lacks something is told, too.
        metadata.manifest_path(super::root().join(manifest)).other_options(["--locked".to_owned()]);
        let metadata = metadata.exec()?;
        for package in &metadata.packages {
            let (name, licence) = (&package.name, &package.license);
            let is_allowed = allowed.allows(package).with_context(|| name.to_string())?;
            ensure!(is_allowed, "{manifest}: {name} under {licence:?} from {:?}", package.source);
        }
        ensure!(metadata.packages.len() > 10, "{manifest}: no packages");
    }
    Ok(())
}
