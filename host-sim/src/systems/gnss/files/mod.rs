//! Readers of the files that precise positioning needs, one a format.
//!
//! Files may be compressed: [`Text::read`](lines::Text::read) unpacks gzip and Hatanaka.

pub mod antex;
pub mod blq;
mod compressed;
mod crinex;
mod fields;
pub mod lines;
pub mod rinex_clock;
pub mod rinex_obs;
mod satellites;
pub mod sp3;
pub mod time;

#[cfg(test)]
mod mutations;
#[cfg(test)]
mod samples;
