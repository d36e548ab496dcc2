use crate::Carriers;

/// A navigation message: it decides to which signals the broadcast clock refers, and for how long an ephemeris holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum NavigationMessage {
    /// The legacy message of GPS, whose clock refers to L1 and L2.
    Lnav,
    /// The message of Galileo on E1 and E5b, whose clock refers to both.
    Inav,
    /// The message of Galileo on E5a, whose clock refers to E1 and E5a.
    Fnav,
    /// The message of BeiDou on B1I, B2I and B3I, whose clock refers to B3I.
    D1,
}

/// The relation of a broadcast clock to that of the observed carriers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClockReference {
    /// The term to add to the broadcast clock for that of the ionosphere-free combination, s.
    pub correction: f64,
    /// The lead of that clock over the clock of the first carrier alone, s: see
    /// [`Ephemeris::group_delay`](crate::Ephemeris::group_delay).
    pub group_delay: f64,
}

impl NavigationMessage {
    /// The clock of two carriers from the message's two group delays (s): `TGD` and 0 of GPS, BGD(E1, E5a) and
    /// BGD(E1, E5b) of Galileo, TGD1 and TGD2 of BeiDou. `None` if the group delay between the message's own carriers
    /// and these is not given.
    pub fn clock_reference(
        self,
        carriers: Carriers,
        [first, second]: [f64; 2],
    ) -> Option<ClockReference> {
        let (group_delay, own) = match (carriers, self) {
            (Carriers::L1L2, Self::Lnav) | (Carriers::E1E5a, Self::Fnav) => (first, first),
            (Carriers::E1E5b, Self::Inav) => (second, second),
            // Galileo OS SIS ICD 5.1.5: the clock of E1 alone is the same, whichever message it is taken from.
            (Carriers::E1E5a, Self::Inav) => (first, second),
            // BDS-SIS-ICD-B1I, TGD1 and TGD2: the clock is that of B3I, and those of B1I and B2I are behind by their
            // delays.
            (Carriers::B1B3, Self::D1) => (first - carriers.ionosphere_free([first, 0.0]), first),
            (Carriers::B1B2, Self::D1) => {
                (first - carriers.ionosphere_free([first, second]), first)
            }
            _ => return None,
        };
        Some(ClockReference { correction: group_delay - own, group_delay })
    }

    /// The time, s, before and after its reference time for which an ephemeris may be used unless it states a fit
    /// interval.
    ///
    /// It is half the usual four hours for GPS; the maximum age by the Galileo OS service definition; for BeiDou the
    /// hour for which it is transmitted (BDS-SIS-ICD-B1I), and another.
    pub const fn holds(self) -> f64 {
        match self {
            Self::Inav | Self::Fnav => 14_400.0,
            Self::Lnav | Self::D1 => 7_200.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reference(message: NavigationMessage, carriers: Carriers) -> Option<[f64; 2]> {
        let told = message.clock_reference(carriers, [5e-9, 8e-9])?;
        Some([told.correction, told.group_delay])
    }

    #[test]
    fn each_clock_refers_to_its_own_carriers() {
        use NavigationMessage::{D1, Fnav, Inav, Lnav};
        assert_eq!(reference(Lnav, Carriers::L1L2), Some([0.0, 5e-9]));
        assert_eq!(reference(Fnav, Carriers::E1E5a), Some([0.0, 5e-9]));
        assert_eq!(reference(Inav, Carriers::E1E5b), Some([0.0, 8e-9]));
        assert_eq!(reference(Inav, Carriers::E1E5a), Some([5e-9 - 8e-9, 5e-9]));
        assert_eq!(reference(Fnav, Carriers::E1E5b), None);
        assert_eq!(reference(Lnav, Carriers::B1B3), None);
        // The ionosphere-free combination of the delays is subtracted from the clock of B3I.
        let [correction, _] = reference(D1, Carriers::B1B3).expect("a clock");
        let free = Carriers::B1B3.ionosphere_free([5e-9, 0.0]);
        assert!((correction + free).abs() < 1e-18 && correction < 0.0, "{correction}");
    }
}
