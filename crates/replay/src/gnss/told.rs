//! Sources of satellite data: precise orbits and clocks, or broadcast ephemerides.

use std::collections::BTreeSet;
use std::sync::Arc;

use kestirim_gnss_files::{
    Antennas, Biases, Clocks, Error, GpsTime, Navigation, Observations, Orbits, Warning,
};
use kestirim_gnss_ppp::Correction;

use super::agreement;
use super::broadcast::Broadcast;
use super::coverage::{self, names};
use super::model;
use super::products::{Products, antenna_model};
use super::recording::Paths;
use super::shelf::Shelf;
use super::whole_biases::WholeBiases;

/// The source of satellite data.
#[derive(Debug)]
pub(super) enum Told {
    /// Orbits and clocks of a service.
    Precise(Arc<Orbits>, Option<Arc<Clocks>>),
    /// Ephemerides that the satellites broadcast.
    Broadcast(Arc<Navigation>),
}

/// A warning, with the correction that it concerns, if it does not concern all of them.
type Doubt = (Option<Correction>, String);

/// The satellite data for a recording.
#[derive(Debug)]
pub(super) struct Served {
    pub(super) products: Products,
    /// The satellites that are not to be used.
    pub(super) left_out: BTreeSet<u8>,
    /// The span of time covered by orbits, s since midnight.
    pub(super) span: [f64; 2],
}

impl Told {
    /// Reads precise orbits, if there are any, else broadcast ephemerides, which a receiver's stream contains itself.
    pub(super) fn read(paths: &Paths<'_>, shelf: &Shelf) -> Result<Self, Error> {
        if paths.sp3.is_empty() {
            let own = [paths.obs.to_path_buf()];
            let nav = if paths.nav.is_empty() { &own } else { paths.nav };
            return Ok(Self::Broadcast(shelf.navigation(nav)?));
        }
        let clocks = || (!paths.clk.is_empty()).then(|| shelf.clocks(paths.clk)).transpose();
        let (orbits, clocks) = rayon::join(|| shelf.orbits(paths.sp3), clocks);
        Ok(Self::Precise(orbits?, clocks?))
    }

    /// The warnings of the readers.
    pub(super) fn warnings(&self) -> impl Iterator<Item = &Warning> {
        let (one, other) = match self {
            Self::Precise(orbits, clocks) => {
                (&orbits.warnings[..], clocks.as_ref().map_or(&[][..], |clocks| &clocks.warnings))
            }
            Self::Broadcast(navigation) => (&navigation.warnings[..], &navigation.unserved[..]),
        };
        one.iter().chain(other)
    }

    /// The satellite data for observations that begin at `start`, with the antennas from the file `antex`.
    pub(super) fn serve(
        &self,
        start: GpsTime,
        observations: &Observations,
        biases: Arc<Biases>,
        (antennas, antex): (&Antennas, &str),
        warnings: &mut Vec<Doubt>,
    ) -> Served {
        let midnight = model::time(GpsTime::new(start.day(), 0.0));
        match self {
            Self::Precise(orbits, clocks) => {
                let clocks = clocks.as_deref();
                let whole = WholeBiases::new(clocks, biases, &observations.signals);
                let products = Products::new(start, orbits, clocks, antennas).with_whole(whole);
                let known = (antex, start);
                let left_out = coverage::left_out(observations, orbits, antennas, known, warnings);
                let model = antenna_model(orbits, clocks);
                warnings.extend(coverage::other_antennas(observations, &products, model));
                let apart = clocks.and_then(|clocks| agreement::doubt(orbits, clocks));
                let sentences = products.jumps().into_iter().chain(apart);
                warnings.extend(sentences.map(|sentence| (None, sentence)));
                Served { products, left_out, span: coverage::span(orbits, midnight) }
            }
            Self::Broadcast(navigation) => {
                let (start_time, with_codes) = (model::time(start), biases.is_empty());
                let signals = &observations.signals;
                let broadcast = Broadcast::new(navigation, signals, start_time, with_codes);
                let are_corrected = !with_codes || broadcast.has_codes_at(start_time);
                let sentences = quality(&broadcast, are_corrected);
                warnings.extend(sentences.map(|sentence| (None, sentence)));
                let disowned: Vec<_> = broadcast.disowned().collect();
                if !disowned.is_empty() {
                    let names = names(disowned);
                    warnings.push((
                        None,
                        format!(
                            "{names} call themselves unhealthy at times, and are left out then"
                        ),
                    ));
                }
                let left_out = coverage::without_ephemerides(observations, &broadcast, warnings);
                let span = coverage::span_of_broadcast(navigation, midnight);
                let products = Products::of_broadcast(start, broadcast);
                Served { products, left_out, span }
            }
        }
    }
}

/// Sentences about how good orbits and clocks are that the satellites broadcast, for codes whose biases are corrected or not.
fn quality(broadcast: &Broadcast, are_corrected: bool) -> impl Iterator<Item = String> {
    let Some(ssr) = broadcast.ssr() else {
        let sentence = "orbits and clocks are those that the satellites broadcast: positions are good to metres";
        return [Some(sentence.to_owned()), None, None].into_iter().flatten();
    };
    let (service, solution) = ssr.provider;
    let corrected = format!(
        "orbits and clocks are those that the satellites broadcast, corrected by service {service}, solution {solution}: as good as that service is"
    );
    let several = "there are corrections of other services or solutions, which are not used";
    let codes =
        "biases of the observed codes are not corrected: positions take longer to become good";
    let several = ssr.are_several.then(|| several.to_owned());
    let codes = (!are_corrected).then(|| codes.to_owned());
    [Some(corrected), several, codes].into_iter().flatten()
}
