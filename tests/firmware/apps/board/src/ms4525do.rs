//! Simulates a TE Connectivity MS4525DO, type A, ±1 psi, on I²C, at the two ends of a Pitot tube: the ram pressure is
//! at its second port, as on the usual modules, so that it counts downwards.

use embedded_hal::i2c::SevenBitAddress;

use crate::Recording;
use crate::i2c::Device;

/// Pascals per pound-force per square inch.
const PSI: f32 = 6894.76;
/// The largest count.
const FULL: f32 = 16_383.0;
/// 15 °C in the sensor's eleven bits.
const TEMPERATURE: u16 = ((15 + 50) * 2047 / 200) as u16;
/// The density of air at that temperature and at sea level, kg/m³.
const DENSITY: f32 = 1.225;

const STALE: u8 = 0b10 << 6;

/// A sensor that measures what a recording of a flight holds: its fourth number, the airspeed (m/s).
pub struct Ms4525do<'a> {
    recording: &'a Recording<5>,
    asked: bool,
}

impl<'a> Ms4525do<'a> {
    /// The sensor after power-on.
    pub const fn new(recording: &'a Recording<5>) -> Self {
        Self { recording, asked: false }
    }
}

impl Device for Ms4525do<'_> {
    const ADDRESS: SevenBitAddress = 0x28;

    fn write(&mut self, _: &[u8]) {
        self.asked = true;
    }

    fn read(&mut self, bytes: &mut [u8]) {
        let [_, _, _, airspeed, _] = self.recording.values();
        let pressure = 0.5 * DENSITY * airspeed * airspeed / PSI;
        // A tenth of the counts is unused at either end.
        let count = FULL * (0.1 + 0.8 * (1.0 - pressure) / 2.0) + 0.5;
        let [high, low] = (count.clamp(0.0, FULL) as u16).to_be_bytes();
        let status = if core::mem::take(&mut self.asked) { 0 } else { STALE };
        let [warm, er] = (TEMPERATURE << 5).to_be_bytes();
        for (byte, said) in bytes.iter_mut().zip([status | high, low, warm, er]) {
            *byte = said;
        }
    }
}
