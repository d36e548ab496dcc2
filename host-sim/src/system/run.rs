//! Options of a synthetic experiment that all systems share.

use clap::Args;
use kestirim_replay::ScalarKind;

use crate::Error;

/// Options of a synthetic experiment.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Args)]
pub struct RunOptions {
    /// Repetitions of the experiment [default: as many as take a few seconds]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub trials: Option<u64>,
    /// Seed of all randomness; the same seed gives the same answer
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub seed: u64,
    /// Number type of the estimator [default: the system's own]
    #[arg(long, value_name = "TYPE")]
    pub scalar: Option<ScalarKind>,
}

/// The number type to compute in: the requested one, or else the `default`.
///
/// # Errors
/// [`Error::Usage`] if the system does not support the requested type.
pub fn choose_scalar(
    system: &str,
    asked: Option<ScalarKind>,
    supported: &[ScalarKind],
    default: ScalarKind,
) -> Result<ScalarKind, Error> {
    let chosen = asked.unwrap_or(default);
    if supported.contains(&chosen) {
        return Ok(chosen);
    }
    let names: Vec<_> = supported.iter().map(|kind| kind.name()).collect();
    let names = names.join(" or ");
    let chosen = chosen.name();
    Err(Error::Usage(format!("{system} computes in {names}, not in {chosen} (--scalar)")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unsupported_scalar_is_refused_with_a_sentence() {
        let floats = [ScalarKind::F32, ScalarKind::F64];
        let choose = |asked| choose_scalar("vehicle", asked, &floats, ScalarKind::F32);
        assert_eq!(choose(None).unwrap(), ScalarKind::F32);
        assert_eq!(choose(Some(ScalarKind::F64)).unwrap(), ScalarKind::F64);
        let sentence = choose(Some(ScalarKind::Fixed)).unwrap_err().to_string();
        assert_eq!(sentence, "vehicle computes in f32 or f64, not in fixed (--scalar)");
    }
}
