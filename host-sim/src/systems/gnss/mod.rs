//! GNSS receivers, stationary or moving.
//!
//! [`recording`] → [`track`] → [`account`]; the [`paper`]'s experiment tracks the days that [`simulate`] generates.
//!
//! Times are in seconds since the midnight before the first epoch; positions are those of the marker, in ECEF.

pub mod account;
pub mod figures;
mod online;
pub mod paper;
mod recorded;
pub mod recording;
pub mod settings;
pub mod track;

use std::path::Path;
use std::sync::Arc;

use kestirim_gnss_files::Kind;
use kestirim_replay::gnss::{self, Recording};
pub use kestirim_simulate::gnss as simulate;
use kestirim_sweep::{Block, Samples};

use self::figures::streams;
use self::paper::experiment;
use self::settings::{Choice, Setup};
use self::track::Track;
use crate::Error;
use crate::report::Chapter;
use crate::stream::Stream;
use crate::system::{
    Account, Answer, Detail, FileField, Files, Finding, Idle, OutputField, Panel, Plan, RunOptions,
    Setting, Settings, Study, System, Table,
};

/// The GNSS system.
#[derive(Debug, Clone, Copy)]
pub struct Gnss;

impl System for Gnss {
    const NAME: &'static str = "gnss";
    const TITLE: &'static str =
        "where a GPS receiver is, to a centimetre, from precise orbits and clocks";
    const PAPER: &'static str =
        "Bahadur and Nohutcu 2020, robust Kalman filters for precise point positioning";
    const FILES: &'static [FileField] = &[
        FileField::required(
            "obs",
            "What the receiver observed: RINEX 2, 3 or 4, CRINEX, or a recorded stream, UBX (RXM-RAWX, RXM-SFRBX) or RTCM 3; GPS on L1 and L2, Galileo on E1 and E5a or E5b, GLONASS on G1 and G2, BeiDou on B1I and B3I or B2I or on B1C and B2a; any file may be packed with gzip",
        ),
        FileField::optional(
            "sp3",
            "Precise orbits, SP3, one file or more: those of the day before and after help at its ends",
        )
        .several()
        .live(),
        FileField::optional(
            "nav",
            "Where there are no precise orbits: what the satellites broadcast, RINEX navigation 2, 3 or 4, or a recorded stream, one file or more; positions are good to metres then, or as good as a service whose corrections are in a stream (SSR in RTCM 3)",
        )
        .several()
        .live(),
        FileField::optional(
            "clk",
            "Precise clocks, RINEX, one file or more [default: the clocks of the orbit files]",
        )
        .several()
        .live(),
        FileField::optional(
            "antex",
            "Phase centres of the satellites' and the receiver's antennas, ANTEX, one file or more: precise orbits need it",
        )
        .several()
        .live(),
        FileField::optional(
            "bias",
            "Biases of the satellites' codes, Bias-SINEX, one file or more [default: not corrected]",
        )
        .several()
        .live(),
        FileField::optional("blq", "Ocean loading of the station, BLQ [default: not corrected]"),
        FileField::optional("erp", "The Earth's rotation, ERP: for the tide of the pole, some millimetres [default: not corrected]").live(),
        FileField::optional("truth", "a file of which the first line is X,Y,Z"),
    ];
    const SYNTHETIC: &'static [(&'static str, &'static str)] = &[
        ("faults", "8 h of a synthetic station: outliers, biases, slips that nothing shows"),
        ("clean", "the same without faults"),
    ];
    const OUTPUTS: &'static [OutputField] = &[
        OutputField {
            name: "track",
            help: "Write t,x,y,z (s, ECEF m), standard deviations and health of each epoch with a solution to this file; \
                   by its ending .pos (RTKLIB), .nmea, .kml or .gpx instead",
            endings: &["csv", "pos", "nmea", "kml", "gpx"],
        },
        OutputField {
            name: "residuals",
            help: "Write residuals, weights and reasons of each observation to this file",
            endings: &["csv"],
        },
    ];
    const PANELS: &'static [Panel] = &[Panel::Map];
    const HEARS_BYTES: bool = true;
    const RECORDED: &'static [Study] = recorded::STUDIES;

    type Recording = Recording;
    type Trace = Track;
    type Experiment = experiment::Report;

    fn settings(recording: Option<&Recording>) -> Vec<Setting> {
        settings::table(recording)
    }

    fn idle(recording: Option<&Recording>, settings: &Settings, name: &str) -> Option<Idle> {
        match recording {
            Some(recording) if name == "systems" && !recording.has_others() => {
                Some(Idle::foreign("is for recordings with satellites of other systems than GPS"))
            }
            Some(recording) if name == "gradient" && recording.hides_gradients() => {
                Some(Idle::foreign("is for precise clocks every five minutes or more often"))
            }
            Some(recording) if name == "ambiguities" && recording.never_whole().is_some() => {
                Some(Idle::foreign(
                    "is for clocks or biases that make ambiguities whole, and a known antenna",
                ))
            }
            _ => settings::idle(settings, name),
        }
    }

    fn lacks_output(settings: &Settings) -> Option<&'static str> {
        let all = settings.chosen::<Choice>("filter") == Choice::All;
        all.then_some("is of one filter, not of --filter all")
    }

    fn read(files: &Files, _: &Settings) -> Result<Recording, Error> {
        recording::read(files)
    }

    fn fits(field: &str, path: &Path, _: &Files) -> bool {
        let kind = Kind::of_file(path).ok().flatten();
        match field {
            "obs" => matches!(kind, Some(Kind::Observations | Kind::Ubx | Kind::Rtcm)),
            "sp3" => kind == Some(Kind::Orbits),
            "nav" => matches!(kind, Some(Kind::Navigation | Kind::Corrections)),
            "clk" => kind == Some(Kind::Clocks),
            "antex" => kind == Some(Kind::Antennas),
            "bias" => kind == Some(Kind::Biases),
            "blq" => kind == Some(Kind::OceanLoading),
            "erp" => kind == Some(Kind::EarthRotation),
            _ => kind.is_none() && recording::truth::read(path).is_ok(),
        }
    }

    fn synthetic(name: &str) -> Result<Recording, Error> {
        recording::synthetic(name)
    }

    fn check(recording: &Recording, _: &Settings) -> Vec<Finding> {
        gnss::check(recording)
    }

    fn track(recording: &Recording, settings: &Settings, detail: Detail) -> Result<Track, Error> {
        Track::of(recording, &Setup::of(settings), detail)
    }

    fn account(
        recording: &Recording,
        settings: &Settings,
        track: &Track,
    ) -> Result<Account, Error> {
        account::account(recording, &Setup::of(settings), track)
    }

    fn figures(
        recording: &Recording,
        settings: &Settings,
        track: &Track,
        answer: &mut Answer,
    ) -> Result<(), Error> {
        figures::draw(recording, &Setup::of(settings), track, answer);
        Ok(())
    }

    fn table(output: &str, _: &Recording, _: &Settings, track: &Track) -> Table {
        match output {
            "track" => account::tables::track(track.best()),
            _ => account::tables::residuals(&track.main().residuals),
        }
    }

    fn text(output: &str, ending: &str, recording: &Recording, track: &Track) -> Option<String> {
        (output == "track").then(|| gnss::track_text(ending, recording, track.best()))?
    }

    fn streams(recording: &Recording, settings: &Settings, track: &Track) -> Vec<Stream> {
        let truth = Setup::of(settings).truth(recording);
        streams::streams(track.main(), &track.about(truth.as_ref()), truth.is_some())
    }

    fn firmware(_: Option<&Recording>, settings: &Settings) -> String {
        Setup::of(settings).firmware()
    }

    fn trials(run: &RunOptions, _: &Settings) -> Result<Vec<Block>, Error> {
        experiment::trials(*run)
    }

    fn experiment(
        run: &RunOptions,
        _: &Settings,
        samples: &[Samples],
    ) -> Result<experiment::Report, Error> {
        experiment::report(*run, samples)
    }

    fn chapter(experiment: &experiment::Report) -> Result<Chapter, Error> {
        paper::chapter::chapter(experiment)
    }

    fn online(settings: &Settings, files: &Files) -> Result<Option<Arc<dyn Plan>>, Error> {
        Ok(Some(Arc::new(online::Receiving::new(settings, files)?)))
    }
}

#[cfg(test)]
mod tests;
