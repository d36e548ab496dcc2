//! A crate's README is its documentation, on docs.rs and elsewhere: it has the sections that a user looks for, and
//! every link in it leads to an item that exists.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use cargo_metadata::Package;
use syn::{ImplItem, Item, TraitItem, Visibility};

use super::{crates, folder, metadata, published, root};

/// The common prefix of all documentation addresses on docs.rs.
const DOCS: &str = "https://docs.rs/";

#[test]
fn every_readme_has_the_same_sections() -> Result<()> {
    let metadata = metadata()?;
    for package in published(&metadata)? {
        let text = fs::read_to_string(folder(package)?.join("README.md"))?;
        let name = package.name.as_str();
        assert_eq!(text.lines().next(), Some(format!("# {name}").as_str()));
        assert!(text.contains("\n```rust"), "{name}: an example");
        let headings: String = text.lines().filter(|line| line.starts_with("## ")).collect();
        let headings = headings.to_lowercase();
        for section in ["error", "features", "licence"] {
            assert!(headings.contains(section), "{name}: a section about {section}");
        }
        assert!(text.to_lowercase().contains("units"), "{name}: its units");
    }
    Ok(())
}

#[test]
fn every_bracket_of_a_readme_leads_somewhere() -> Result<()> {
    let metadata = metadata()?;
    let crates = crates(&metadata);
    let mut items = BTreeMap::new();
    for package in &crates {
        items.insert(package.name.as_str(), items_of(package)?);
    }
    let readmes = crates.iter().map(|package| Ok((folder(package)?.join("README.md"), true)));
    let others = ["README.md", "CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md"];
    let others = others.map(|name| Ok((root().join(name), false)));
    for (file, is_crate) in readmes.chain(others).collect::<Result<Vec<_>>>()? {
        let text = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
        for (label, target) in links(&text).with_context(|| file.display().to_string())? {
            // A registry shows a crate's README without the files around it.
            let folder = file.parent().filter(|_| !is_crate);
            check(folder, &target, &items)
                .with_context(|| format!("{}: [{label}]: {target}", file.display()))?;
        }
    }
    Ok(())
}

/// The book names the files in which its results are computed.
#[test]
fn every_file_that_the_book_names_exists() -> Result<()> {
    let crates = fs::read_dir(root().join("crates"))?.collect::<Result<Vec<_>, _>>()?;
    let sources = crates.into_iter().map(|entry| entry.path().join("src"));
    let mut folders: Vec<_> =
        ["", "crates", "docs/src", "tests/firmware"].map(|name| root().join(name)).into();
    folders.extend(sources);
    for entry in fs::read_dir(root().join("docs/src"))? {
        let chapter = entry?.path();
        if chapter.extension().is_none_or(|extension| extension != "md") {
            continue;
        }
        let text = fs::read_to_string(&chapter)?;
        for named in text.split('`').flat_map(alternatives).filter(|named| is_source(named)) {
            let exists = folders.iter().any(|folder| folder.join(&named).exists());
            ensure!(exists, "{}: there is no {named}", chapter.display());
        }
    }
    Ok(())
}

/// Expands `a/{b,c}.rs` as a shell does.
fn alternatives(path: &str) -> Vec<String> {
    let parts = path.split_once('{').and_then(|(before, rest)| {
        let (of, after) = rest.split_once('}')?;
        Some((before, of, after))
    });
    let Some((before, of, after)) = parts else { return vec![path.to_owned()] };
    of.split(',').flat_map(|one| alternatives(&format!("{before}{one}{after}"))).collect()
}

/// Whether a code span is the path of a source file.
fn is_source(words: &str) -> bool {
    let folder_of = words.strip_suffix(".rs").and_then(|path| path.split_once('/'));
    folder_of.is_some_and(|(folder, path)| {
        !folder.is_empty() && path.chars().all(|letter| is_in_name(letter) || "/-".contains(letter))
    })
}

/// Fails if a link in a file leads nowhere; `folder` is that of the file, if files around it can be reached.
fn check(
    folder: Option<&Path>,
    target: &str,
    items: &BTreeMap<&str, BTreeSet<String>>,
) -> Result<()> {
    if let Some(path) = target.strip_prefix(DOCS) {
        let (package, path) = path.split_once("/latest/").context("the newest version")?;
        if let Some(items) = items.get(package) {
            let (library, item) = path.split_once('/').context("an item")?;
            ensure!(library == package.replace('-', "_"), "the crate is called otherwise");
            ensure!(items.contains(item), "there is no such item");
        }
    } else if !target.starts_with("https://") {
        let folder = folder.context("not to be followed outside this repository")?;
        let path = target.split('#').next().unwrap_or_default();
        ensure!(folder.join(path).exists(), "there is no such file");
    }
    Ok(())
}

/// The links of a text, outside its code: their labels and targets.
fn links(text: &str) -> Result<Vec<(String, String)>> {
    let mut prose = String::new();
    let mut definitions = BTreeMap::new();
    let mut is_code = false;
    for line in text.lines() {
        if line.starts_with("```") {
            is_code = !is_code;
        } else if let Some((label, target)) =
            line.strip_prefix('[').and_then(|line| line.split_once("]: https://"))
        {
            // Labels that differ only in case are the same.
            let before = definitions.insert(label.to_lowercase(), format!("https://{target}"));
            ensure!(before.is_none(), "[{label}] is defined twice");
        } else if !is_code {
            prose.push_str(line);
            prose.push('\n');
        }
    }
    let mut links = Vec::new();
    let mut used = BTreeSet::new();
    let mut rest = prose.as_str();
    while let Some((label, after)) = next_bracket(rest)? {
        rest = after;
        if let Some(after) = rest.strip_prefix('(') {
            let (target, after) = after.split_once(')').context("a parenthesis is not closed")?;
            links.push((label.into(), target.into()));
            rest = after;
            continue;
        }
        let mut key = label;
        if rest.starts_with('[')
            && let Some((reference, after)) = next_bracket(rest)?
        {
            (key, rest) = (reference, after);
        }
        let key = key.to_lowercase();
        let target =
            definitions.get(&key).with_context(|| format!("[{label}] has no definition"))?;
        links.push((label.into(), target.clone()));
        used.insert(key);
    }
    for label in definitions.keys() {
        ensure!(used.contains(label), "nothing refers to [{label}]");
    }
    Ok(links)
}

/// The contents of the next brackets outside of code, and the text behind them.
fn next_bracket(text: &str) -> Result<Option<(&str, &str)>> {
    let mut is_code = false;
    let mut from = None;
    for (at, letter) in text.char_indices() {
        match (letter, from) {
            ('`', _) => is_code = !is_code,
            ('[', None) if !is_code && !text[..at].ends_with('\\') => from = Some(at + 1),
            (']', Some(from)) if !is_code => return Ok(Some((&text[from..at], &text[at + 1..]))),
            _ => {}
        }
    }
    ensure!(from.is_none(), "a bracket is not closed");
    Ok(None)
}

/// The pages of a crate's public items and their anchors, such as `struct.Gaussian.html#method.update`.
fn items_of(package: &Package) -> Result<BTreeSet<String>> {
    let source = folder(package)?.join("src");
    let library = fs::read_to_string(source.join("lib.rs"))?;
    let mut pages = BTreeSet::new();
    let mut anchors: Vec<(String, String)> = Vec::new();
    for file in rust_files(&source)? {
        // What is re-exported at the root has its page there; what is in a public module has it in that module's
        // folder.
        let module = file.strip_prefix(&source)?.iter().next().context("a name")?;
        let module = module.to_string_lossy().replace(".rs", "");
        let at = if library.contains(&format!("pub mod {module};")) {
            module + "/"
        } else {
            String::new()
        };
        if !at.is_empty() {
            pages.insert(format!("{at}index.html"));
        }
        for item in syn::parse_file(&fs::read_to_string(&file)?)?.items {
            let (kind, name) = match &item {
                Item::Struct(it) if is_public(&it.vis) => ("struct", &it.ident),
                Item::Enum(it) if is_public(&it.vis) => ("enum", &it.ident),
                Item::Trait(it) if is_public(&it.vis) => ("trait", &it.ident),
                Item::Type(it) if is_public(&it.vis) => ("type", &it.ident),
                Item::Const(it) if is_public(&it.vis) => ("constant", &it.ident),
                Item::Fn(it) if is_public(&it.vis) => ("fn", &it.sig.ident),
                Item::Impl(it) if it.trait_.is_none() => {
                    if let syn::Type::Path(of) = &*it.self_ty
                        && let Some(of) = of.path.segments.last()
                    {
                        let methods = it.items.iter().filter_map(|item| match item {
                            ImplItem::Fn(it) if is_public(&it.vis) => Some(&it.sig.ident),
                            _ => None,
                        });
                        anchors.extend(
                            methods.map(|it| (of.ident.to_string(), format!("method.{it}"))),
                        );
                    }
                    continue;
                }
                _ => continue,
            };
            let is_exported =
                !at.is_empty() || library.split(|c: char| !is_in_name(c)).any(|word| name == word);
            if !is_exported {
                continue;
            }
            pages.insert(format!("{at}{kind}.{name}.html"));
            anchors.extend(parts(&item).into_iter().map(|part| (name.to_string(), part)));
        }
    }
    let all = pages.iter().flat_map(|page| {
        let name = page.split('.').nth(1);
        let of_it = anchors.iter().filter(move |(of, _)| Some(of.as_str()) == name);
        of_it.map(move |(_, anchor)| format!("{page}#{anchor}"))
    });
    Ok(all.chain(pages.iter().cloned()).collect())
}

/// The anchors of an item's fields, variants or functions.
fn parts(item: &Item) -> Vec<String> {
    match item {
        Item::Struct(it) => {
            let public = it.fields.iter().filter(|field| is_public(&field.vis));
            public
                .filter_map(|field| Some(format!("structfield.{}", field.ident.as_ref()?)))
                .collect()
        }
        Item::Enum(it) => it.variants.iter().map(|it| format!("variant.{}", it.ident)).collect(),
        Item::Trait(it) => {
            let functions = it.items.iter().filter_map(|item| match item {
                TraitItem::Fn(it) if it.default.is_none() => {
                    Some(format!("tymethod.{}", it.sig.ident))
                }
                TraitItem::Fn(it) => Some(format!("method.{}", it.sig.ident)),
                _ => None,
            });
            functions.collect()
        }
        _ => Vec::new(),
    }
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

fn is_in_name(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

fn rust_files(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(rust_files(&path)?);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    Ok(files)
}
