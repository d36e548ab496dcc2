//! Calls everything of `kestirim-gnss-message`.

use kestirim_gnss_message::accuracy::{sisa, ura};
use kestirim_gnss_message::{Bits, Collector, Ephemeris, Part, beidou, crc_24q};
use kestirim_gnss_message::{galileo, gps};

use super::values::{any, call_each, keep, one_of, slice, whole};

fn words<const N: usize>() -> [u32; N] {
    any([(); N].map(|()| whole()))
}

/// Words of a subframe that begins with a preamble, in most cases.
fn begun(preamble: u32) -> [u32; 10] {
    let mut words = words();
    if let Some(first) = words.first_mut() {
        *first = one_of([*first, preamble, preamble]);
    }
    words
}

fn bits() {
    let bytes: [u8; 6] = any([(); 6].map(|()| whole()));
    let mut bits = Bits::at(slice(&bytes), usize::from(whole::<u16>()));
    keep(Bits::integer(&mut bits, usize::from(whole::<u8>() % 65)));
    Bits::skip(&mut bits, usize::from(whole::<u16>()));
    keep(Bits::signed(&mut bits, usize::from(whole::<u8>() % 64), i32::from(whole::<i8>())));
    keep(Bits::unsigned(&mut bits, usize::from(whole::<u8>() % 65), i32::from(whole::<i8>())));
    keep(crc_24q(slice(&bytes)));
    keep(ura(whole()));
    keep(sisa(whole()));
}

fn collected<P: Part<N>, const N: usize>(part: impl Fn() -> Option<P>) {
    let mut collector = any(Collector::new());
    keep(Collector::<P, N>::default());
    for _ in 0..2 * N {
        let Some(part) = part() else { continue };
        keep(<P as Part<N>>::number(&part));
        keep(<P as Part<N>>::ephemeris(&[part; N]));
        let ephemeris: Option<Ephemeris> = Collector::take(&mut collector, part);
        keep(ephemeris);
    }
}

fn subframes() {
    collected(|| {
        let subframe = gps::Subframe::from_words(&begun(0x8b << 22))?;
        keep(gps::Subframe::ionosphere(&subframe));
        Some(subframe)
    });
    collected(|| beidou::Subframe::from_words(&begun(0b111_0001_0010 << 19)));
    collected(|| galileo::Word::from_page(&words()));
}

/// Calls everything in this module.
pub fn run() {
    call_each([bits, subframes]);
}
