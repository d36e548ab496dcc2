//! The importer against recordings, variants of them, and damage.

mod claims;
mod containers;
mod mutations;
mod plain;
mod recordings;
mod speed;
mod variants;
mod walk;
