//! Calls everything of `kestirim-gnss-message`.

use kestirim_gnss_message::accuracy::{sisa, ura};
use kestirim_gnss_message::{
    Bits, Collector, Ephemeris, Part, beidou, crc_24q, frame_data, frame_length,
};
use kestirim_gnss_message::{galileo, gps, ssr};

use super::values::{any, call_each, keep, number, one_of, slice, whole};

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
    let mut frame = bytes;
    [frame[0], frame[1], frame[2]] = [0xd3, 0, one_of([0, 1])];
    keep(frame_length(slice(&frame)));
    keep(frame_data(slice(&frame)));
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
        let ephemeris: Option<Ephemeris> = Collector::take(&mut collector, part, number());
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

/// A message with corrections, in most cases.
fn corrections() {
    let mut bytes: [u8; 64] = any([(); 64].map(|()| whole()));
    let kind: u16 = one_of([1057, 1058, 1059, 1060, 1240, 1241, 1242, 1243, 4076]);
    bytes[0] = (kind >> 4) as u8;
    bytes[1] = (kind << 4) as u8 | bytes[1] & 15;
    let Some(message) = ssr::Message::from_data(slice(&bytes)) else { return };
    let header: ssr::Header = message.header;
    keep(header);
    let mut corrections = any(ssr::Message::corrections(&message));
    while let Some((satellite, correction)) =
        <ssr::Corrections<'_> as Iterator>::next(&mut corrections)
    {
        keep(satellite);
        match correction {
            ssr::Correction::Orbit(orbit) => {
                keep(ssr::Orbit::is_of(&orbit, whole()));
                keep(ssr::Orbit::at(&orbit, number()));
            }
            ssr::Correction::Clock(clock) => keep(ssr::Clock::at(&clock, number())),
            ssr::Correction::Code { signal, bias } => keep((signal, bias)),
        }
    }
}

/// Calls everything in this module.
pub fn run() {
    call_each([bits, subframes, corrections]);
}
