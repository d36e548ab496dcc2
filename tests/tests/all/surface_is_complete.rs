//! The programs of `panic_free.rs` call everything: each public function, method and trait of each `no_std` crate, as
//! found in the sources, is called by its path (`Gaussian::update(…)`) in the crate's program; a trait's function by
//! its type's path, or by the trait's in a program that names the type.
//!
//! Derived functions (`Clone`, `PartialEq`, serde, defmt) are not required: they contain no code of ours.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItem, Item, TraitItem, Type, UseTree, Visibility};

/// Traits that need not be called: human-readable text by way of `core::fmt`, which has panics of its own, and
/// serialisation, an optional feature that no program here has.
const NOT_ASKED_FOR: [&str; 6] =
    ["Debug", "Deserialize", "Display", "Error", "Format", "Serialize"];

/// Macros with which crates define items: this test does not see their expansion.
const MACROS: [(&str, &str); 9] = [
    ("begun", "of a type that is not public"),
    ("collection", "the same"),
    ("layout", "`Layout` for an estimator: two constants and two functions of one line"),
    ("passed", "of a type that is not public"),
    ("impl_scalar_for_float", "the functions of `Scalar`, which the trait asks for"),
    ("impl_assign", "the assigning operators of `Fixed`, called by `scalar.rs`"),
    ("assign", "the same of a type that is not public"),
    ("impl_conversions", "from and to the crate `fixed`, whose bits they copy"),
    ("messages", "plain data, and its `From`s"),
];

/// The crate whose functions are called from C programs: crates/c/tests/c links them and looks for panics.
const CALLED_FROM_C: &str = "c";

/// A function that must be called.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Wanted {
    /// The type or trait it belongs to; empty for a free function.
    of: String,
    name: String,
    /// The trait that declares it.
    by: Option<String>,
}

/// The public functions of a crate.
#[derive(Default)]
struct Offer {
    exported: BTreeSet<String>,
    wanted: BTreeSet<Wanted>,
    private_traits: BTreeSet<String>,
    macros: BTreeSet<String>,
}

/// The calls of a program: the last two names of paths.
#[derive(Default)]
struct Calls {
    called: BTreeSet<(String, String)>,
    names: BTreeSet<String>,
}

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn parsed(path: &Path) -> Result<syn::File> {
    let text = fs::read_to_string(path).with_context(|| path.display().to_string())?;
    syn::parse_file(&text).with_context(|| path.display().to_string())
}

/// All source files below a directory.
fn sources(directory: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(directory)? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(sources(&path)?);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    Ok(files)
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

/// Whether an item only exists with the optional feature of stored estimators, which no program here has.
/// `tests/all/snapshots` calls these.
fn is_stored(attributes: &[Attribute]) -> bool {
    let feature = |attribute: &Attribute| {
        let condition = attribute.parse_args::<syn::MetaNameValue>();
        let is_serde = |condition: syn::MetaNameValue| {
            let syn::Expr::Lit(value) = condition.value else { return false };
            matches!(value.lit, syn::Lit::Str(name) if name.value() == "serde")
        };
        attribute.path().is_ident("cfg") && condition.is_ok_and(is_serde)
    };
    attributes.iter().any(feature)
}

fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute.parse_args::<syn::Path>().is_ok_and(|condition| condition.is_ident("test"))
    })
}

fn last_name(path: &syn::Path) -> Option<String> {
    Some(path.segments.last()?.ident.to_string())
}

fn name_of(of: &Type) -> Option<String> {
    match of {
        Type::Path(path) => last_name(&path.path),
        Type::Reference(reference) => name_of(&reference.elem),
        _ => None,
    }
}

impl Offer {
    fn of(name: &str) -> Result<Self> {
        let directory = workspace().join("crates").join(name).join("src");
        let mut offer = Self::default();
        offer.export(&directory.join("lib.rs"))?;
        for file in sources(&directory)? {
            offer.take(&parsed(&file)?.items);
        }
        let private = &offer.private_traits;
        offer.wanted.retain(|wanted| !wanted.by.as_ref().is_some_and(|by| private.contains(by)));
        Ok(offer)
    }

    /// Collects the names that a public module exports.
    fn export(&mut self, file: &Path) -> Result<()> {
        for item in parsed(file)?.items {
            match item {
                Item::Use(item) if is_public(&item.vis) => self.export_tree(&item.tree),
                Item::Mod(item) if is_public(&item.vis) && !is_stored(&item.attrs) => {
                    let directory = file.with_file_name(item.ident.to_string());
                    let beside = directory.with_extension("rs");
                    let within = directory.join("mod.rs");
                    self.export(if beside.is_file() { &beside } else { &within })?;
                }
                Item::Struct(item) => self.export_name(&item.vis, &item.ident),
                Item::Enum(item) => self.export_name(&item.vis, &item.ident),
                Item::Trait(item) => self.export_name(&item.vis, &item.ident),
                Item::Fn(item) => self.export_name(&item.vis, &item.sig.ident),
                _ => {}
            }
        }
        Ok(())
    }

    fn export_name(&mut self, visibility: &Visibility, name: &syn::Ident) {
        if is_public(visibility) {
            self.exported.insert(name.to_string());
        }
    }

    fn export_tree(&mut self, tree: &UseTree) {
        match tree {
            UseTree::Path(path) => self.export_tree(&path.tree),
            UseTree::Name(name) => drop(self.exported.insert(name.ident.to_string())),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.export_tree(tree)),
            UseTree::Rename(_) | UseTree::Glob(_) => panic!("exports are spelt out"),
        }
    }

    fn want(&mut self, of: &str, name: &syn::Ident, by: Option<&String>) {
        self.wanted.insert(Wanted { of: of.into(), name: name.to_string(), by: by.cloned() });
    }

    /// Collects the functions of exported types and traits.
    fn take(&mut self, items: &[Item]) {
        for item in items {
            match item {
                Item::Fn(item) if self.exported.contains(&item.sig.ident.to_string()) => {
                    self.want("", &item.sig.ident, None);
                }
                Item::Trait(item) if self.exported.contains(&item.ident.to_string()) => {
                    for function in &item.items {
                        if let TraitItem::Fn(function) = function {
                            self.want(&item.ident.to_string(), &function.sig.ident, None);
                        }
                    }
                }
                Item::Trait(item) => drop(self.private_traits.insert(item.ident.to_string())),
                Item::Impl(item) if is_stored(&item.attrs) => {}
                Item::Impl(item) => self.take_impl(item),
                Item::Mod(item) if !is_for_tests(&item.attrs) => {
                    let inner = item.content.as_ref().map(|(_, items)| items.as_slice());
                    self.take(inner.unwrap_or_default());
                }
                Item::Macro(item) => {
                    self.macros.extend(item.ident.as_ref().map(ToString::to_string));
                }
                _ => {}
            }
        }
    }

    fn take_impl(&mut self, item: &syn::ItemImpl) {
        let Some(of) = name_of(&item.self_ty) else { return };
        let by = item.trait_.as_ref().and_then(|(_, path, _)| last_name(path));
        let asked = !by.as_ref().is_some_and(|by| NOT_ASKED_FOR.contains(&by.as_str()));
        if !self.exported.contains(&of) || !asked {
            return;
        }
        for function in &item.items {
            if let ImplItem::Fn(function) = function
                && (by.is_some() || is_public(&function.vis))
            {
                self.want(&of, &function.sig.ident, by.as_ref());
            }
        }
    }
}

impl Calls {
    /// The calls of a crate's program.
    fn of(name: &str) -> Result<Self> {
        let directory = workspace().join("tests/firmware/surface/src");
        let name = name.replace('-', "_");
        let mut calls = Self::default();
        calls.visit_file(&parsed(&directory.join(format!("{name}.rs")))?);
        let in_doubles = directory.join(format!("{name}_f64.rs"));
        if in_doubles.is_file() {
            calls.visit_file(&parsed(&in_doubles)?);
        }
        Ok(calls)
    }

    /// Whether a function is called: by its type's path, or by its trait's in a program that names the type.
    fn have(&self, wanted: &Wanted) -> bool {
        let called = |of: &String| self.called.contains(&(of.clone(), wanted.name.clone()));
        called(&wanted.of)
            || wanted.by.as_ref().is_some_and(called) && self.names.contains(&wanted.of)
    }
}

impl<'ast> Visit<'ast> for Calls {
    fn visit_expr_call(&mut self, call: &'ast syn::ExprCall) {
        if let syn::Expr::Path(function) = &*call.func {
            let mut names = function.path.segments.iter().rev().map(|part| part.ident.to_string());
            let name = names.next().unwrap_or_default();
            if let Some(of) = function.qself.as_ref().and_then(|of| name_of(&of.ty)) {
                self.called.insert((of, name.clone()));
            }
            self.called.insert((names.next().unwrap_or_default(), name));
        }
        visit::visit_expr_call(self, call);
    }

    fn visit_item_use(&mut self, _: &'ast syn::ItemUse) {
        // An import is not a use.
    }

    fn visit_ident(&mut self, name: &'ast syn::Ident) {
        self.names.insert(name.to_string());
    }
}

/// Whether a crate is for bare-metal targets. One that needs `std` has no program, as none could link it.
fn is_no_std(name: &str) -> Result<bool> {
    let root = parsed(&workspace().join("crates").join(name).join("src/lib.rs"))?;
    Ok(root.attrs.iter().any(|attribute| attribute.path().is_ident("no_std")))
}

#[test]
fn every_public_function_is_called() -> Result<()> {
    let mut missing = Vec::new();
    for entry in fs::read_dir(workspace().join("crates"))? {
        let name = entry?.file_name().into_string().ok().context("a crate with a name")?;
        if name == CALLED_FROM_C || !is_no_std(&name)? {
            continue;
        }
        let (offer, calls) = (Offer::of(&name)?, Calls::of(&name)?);
        assert!(!offer.wanted.is_empty(), "{name} offers nothing");
        let absent = offer.wanted.iter().filter(|wanted| !calls.have(wanted));
        missing.extend(absent.map(|Wanted { of, name: function, by }| match by {
            Some(by) => format!("{name}: <{of} as {by}>::{function}"),
            None => format!("{name}: {of}::{function}"),
        }));
        for unseen in &offer.macros {
            let known = MACROS.iter().any(|(known, _)| known == unseen);
            assert!(known, "{name}: what does {unseen}! define?");
        }
    }
    assert!(missing.is_empty(), "not called:\n{}", missing.join("\n"));
    Ok(())
}

#[test]
fn what_is_not_called_is_missed() -> Result<()> {
    let (offer, mut calls) = (Offer::of("kalman")?, Calls::of("kalman")?);
    assert!(offer.wanted.iter().all(|wanted| calls.have(wanted)));
    assert!(calls.called.remove(&("Gaussian".into(), "update".into())));
    let missed: Vec<_> = offer.wanted.iter().filter(|wanted| !calls.have(wanted)).collect();
    let update = Wanted { of: "Gaussian".into(), name: "update".into(), by: None };
    assert_eq!(missed, [&update]);
    Ok(())
}
