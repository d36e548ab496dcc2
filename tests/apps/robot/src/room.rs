//! The room: the part to adapt first when copying this application.

use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::AntennaDelay;
use kestirim_uwb_tracker::Anchor;
use nalgebra::SVector;

use crate::{Number, Tag};

/// An anchor of the room.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    /// Its address in the network.
    pub address: u16,
    /// Its position in the room's axes (right-handed, z up), cm.
    pub place: [i32; 3],
    /// The antenna delay of tag and anchor together that they do not correct themselves, ticks: from a calibration.
    pub antenna: AntennaDelay,
}

/// The tag.
pub const TAG: Tag =
    Tag { network: 0xdeca, address: 0x0001, receive_delay: 16_450, transmit_delay: 16_450 };

/// The height of the tag, cm.
pub const HEIGHT: i32 = 100;

/// The anchors, in the corners of 10 m × 8 m.
pub const SITES: [Site; 4] = [
    Site { address: 0x0a00, place: [0, 0, 250], antenna: AntennaDelay::new(12) },
    Site { address: 0x0a01, place: [1000, 0, 200], antenna: AntennaDelay::new(-7) },
    Site { address: 0x0a02, place: [1000, 800, 250], antenna: AntennaDelay::new(0) },
    Site { address: 0x0a03, place: [0, 800, 200], antenna: AntennaDelay::new(30) },
];

impl Site {
    /// The anchor in the tracker's form.
    pub(crate) fn anchor(&self) -> Anchor<Number> {
        Anchor { position: SVector::from(self.place.map(metres)), bias: Number::ZERO }
    }

    /// The bias of ranges to it, m.
    pub(crate) fn excess(&self) -> Number {
        self.antenna.excess(AntennaDelay::new(0))
    }
}

pub(crate) fn metres(centimetres: i32) -> Number {
    Number::from_micro(centimetres.saturating_mul(10_000))
}
