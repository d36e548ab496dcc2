//! Products that were read, for the recordings of other stations that need the same.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use kestirim_gnss_files::{Antennas, Biases, Clocks, EarthRotation, Error, Navigation, Orbits};

use super::recording::Paths;

/// Products that were read, for the recordings of other stations that need the same.
#[derive(Debug, Default)]
pub struct Shelf {
    orbits: Kept<Orbits>,
    clocks: Kept<Clocks>,
    navigation: Kept<Navigation>,
    biases: Kept<Biases>,
    antennas: Kept<Antennas>,
    rotation: Kept<EarthRotation>,
}

/// The paths, and the receiver's antenna if it matters.
type Key = (Vec<PathBuf>, String);

/// A shared place for a product; one that could not be read is not kept.
type Place<T> = Arc<Mutex<Option<Arc<T>>>>;

#[derive(Debug)]
struct Kept<T>(Mutex<HashMap<Key, Place<T>>>);

impl<T> Default for Kept<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T> Kept<T> {
    /// Returns the kept product, or reads it. A thread that comes while another one reads waits: `read` must not wait
    /// for the work of other threads.
    fn get(
        &self,
        paths: &[PathBuf],
        antenna: &str,
        read: impl FnOnce() -> Result<T, Error>,
    ) -> Result<Arc<T>, Error> {
        let place = {
            let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(all.entry((paths.to_vec(), antenna.to_owned())).or_default())
        };
        let mut kept = place.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(kept) = &*kept {
            return Ok(Arc::clone(kept));
        }
        let new = Arc::new(read()?);
        *kept = Some(Arc::clone(&new));
        Ok(new)
    }
}

impl Shelf {
    /// Reads the products, those of a receiver whose antenna is not known, so that problems in them are reported before
    /// they are needed.
    ///
    /// # Errors
    /// An error that names the file, the line and what was expected there.
    pub fn fill(&self, paths: &Paths<'_>) -> Result<(), Error> {
        if paths.sp3.is_empty() && !paths.nav.is_empty() {
            self.navigation(paths.nav)?;
        }
        if !paths.sp3.is_empty() {
            self.orbits(paths.sp3)?;
        }
        if !paths.clk.is_empty() {
            self.clocks(paths.clk)?;
        }
        self.biases(paths.bias)?;
        self.antennas(paths.antex, "")?;
        paths.erp.map(|path| self.rotation(path)).transpose().map(drop)
    }

    pub(super) fn orbits(&self, paths: &[PathBuf]) -> Result<Arc<Orbits>, Error> {
        self.orbits.get(paths, "", || Orbits::read(paths))
    }

    pub(super) fn clocks(&self, paths: &[PathBuf]) -> Result<Arc<Clocks>, Error> {
        self.clocks.get(paths, "", || Clocks::read(paths))
    }

    pub(super) fn navigation(&self, paths: &[PathBuf]) -> Result<Arc<Navigation>, Error> {
        self.navigation.get(paths, "", || Navigation::read(paths))
    }

    pub(super) fn biases(&self, paths: &[PathBuf]) -> Result<Arc<Biases>, Error> {
        self.biases.get(paths, "", || Biases::read(paths))
    }

    pub(super) fn rotation(&self, path: &Path) -> Result<Arc<EarthRotation>, Error> {
        self.rotation.get(&[path.to_path_buf()], "", || EarthRotation::read(path))
    }

    pub(super) fn antennas(
        &self,
        paths: &[PathBuf],
        receiver: &str,
    ) -> Result<Arc<Antennas>, Error> {
        self.antennas.get(paths, receiver, || Antennas::read(paths, receiver))
    }
}
