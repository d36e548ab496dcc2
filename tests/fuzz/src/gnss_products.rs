//! Reads arbitrary bytes as orbits, clocks, ephemerides, antennas and ocean loading.

use kestirim_gnss_files::{
    Antennas, Clocks, EarthRotation, Navigation, Orbits, StationLoading, Text,
};

/// Feeds these bytes.
pub fn feed(bytes: &[u8]) {
    let Ok(text) = Text::unpack("a", bytes.to_vec()) else { return };
    let _ = StationLoading::parse(&text, "ESBC", None);
    let _ = EarthRotation::parse(&text);
    let texts = [text];
    let _ = Antennas::parse(&texts, "TRM59800.00     SCIS");
    let _ = Orbits::parse(&texts);
    let _ = Clocks::parse(&texts);
    let _ = Navigation::parse(&texts);
}
