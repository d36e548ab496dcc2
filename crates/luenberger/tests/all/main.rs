//! Tests of the crate's public interface, in one program so that less is compiled and linked.

mod observers;
mod plant;
mod refusals;
