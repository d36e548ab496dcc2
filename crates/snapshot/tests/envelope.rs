//! The header of a snapshot, and what is refused.

use kestirim_scalar::{Q8_24, Q12_20, Q16_16};
use kestirim_snapshot::{
    Difference, Error, Layout, Name, Number, OVERHEAD, header, layout, load, size, store,
};
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Mean {
    sum: f64,
    #[serde(with = "kestirim_snapshot::arrays")]
    last: [f32; 40],
    #[serde(with = "kestirim_snapshot::arrays::rows")]
    rows: [[u32; 3]; 2],
    #[serde(with = "kestirim_snapshot::arrays::optional")]
    start: Option<[u8; 2]>,
    #[serde(with = "kestirim_snapshot::arrays")]
    none: [u8; 0],
    #[serde(deserialize_with = "kestirim_snapshot::arrays::index::<_, 40>")]
    newest: usize,
    #[serde(deserialize_with = "kestirim_snapshot::arrays::count::<_, 40>")]
    count: usize,
}

const MEAN: Mean = Mean {
    sum: -0.0,
    last: [1.5; 40],
    rows: [[1, 2, 3], [4, 5, u32::MAX]],
    start: Some([7, 8]),
    none: [],
    newest: 39,
    count: 40,
};

#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Log(f32);

layout! {
    [] for Mean as "mean", 3, f64, [40, 3];
    [] for Log as "log", 1, f32, [], infinite
}

fn stored(estimator: &(impl Layout + Serialize)) -> Vec<u8> {
    let mut bytes = vec![0xff; size(estimator).unwrap()];
    let length = store(estimator, &mut bytes).unwrap().len();
    assert_eq!(length, bytes.len());
    bytes
}

#[test]
fn what_is_stored_is_loaded() {
    let bytes = stored(&MEAN);
    assert_eq!(load(&bytes), Ok(MEAN));
    // The rest of the page, after the snapshot, is ignored.
    assert_eq!(load(&[bytes.clone(), vec![0xff; 9]].concat()), Ok(MEAN));
    let header = header(&bytes).unwrap();
    assert_eq!((header.name, header.version), (Name::new("mean"), 3));
    assert_eq!((header.sizes, header.length as usize), ([40, 3, 0, 0], bytes.len() - OVERHEAD));
    let without = Mean { start: None, ..MEAN };
    assert_eq!(load(&stored(&without)), Ok(without));
}

#[test]
fn a_short_buffer_is_told() {
    let whole = size(&MEAN).unwrap();
    for length in 0..whole {
        let mut buffer = vec![0; length];
        assert_eq!(store(&MEAN, &mut buffer), Err(Error::BufferTooShort), "{length} bytes");
    }
}

#[test]
fn what_is_not_a_whole_snapshot_is_refused() {
    let bytes = stored(&MEAN);
    for length in 0..bytes.len() {
        assert_eq!(load::<Mean>(&bytes[..length]), Err(Error::TooShort), "{length} bytes");
    }
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 0x10;
        assert!(load::<Mean>(&changed).is_err(), "byte {at}");
    }
    assert_eq!(load::<Mean>(&[0xff; 400]), Err(Error::NoSnapshot));
    assert_eq!(load::<Mean>(&[0; 400]), Err(Error::NoSnapshot));
}

#[test]
fn another_estimator_is_named() {
    let bytes = stored(&MEAN);
    let error = load::<Log>(&bytes).unwrap_err();
    let Error::Foreign(Difference { found, expected }) = error else { panic!("{error:?}") };
    assert_eq!((found.name, expected.name), (Name::new("mean"), Name::new("log")));
    assert_eq!(
        error.to_string(),
        "a snapshot of mean layout 3 in f64, sizes [40, 3, 0, 0], expected log layout 1 in f32, sizes [0, 0, 0, 0]"
    );
}

#[test]
fn indices_and_numbers_are_checked() {
    let refused = |mean: Mean| load::<Mean>(&stored(&mean)).err();
    assert_eq!(refused(MEAN), None);
    assert_eq!(refused(Mean { newest: 40, ..MEAN }), Some(Error::Invalid));
    assert_eq!(refused(Mean { count: 41, ..MEAN }), Some(Error::Invalid));
    assert_eq!(refused(Mean { sum: f64::NAN, ..MEAN }), Some(Error::NotFinite));
    assert_eq!(refused(Mean { sum: f64::NEG_INFINITY, ..MEAN }), Some(Error::NotFinite));
    let mut last = MEAN.last;
    last[39] = f32::INFINITY;
    assert_eq!(refused(Mean { last, ..MEAN }), Some(Error::NotFinite));
}

#[test]
fn never_is_a_logarithm() {
    assert_eq!(load(&stored(&Log(f32::NEG_INFINITY))), Ok(Log(f32::NEG_INFINITY)));
    for wrong in [f32::INFINITY, f32::NAN] {
        assert_eq!(load::<Log>(&stored(&Log(wrong))), Err(Error::NotFinite));
    }
}

#[test]
fn formats_of_numbers_are_told_apart() {
    let all = [
        (Number::of::<f32>(), "f32"),
        (Number::of::<f64>(), "f64"),
        (Number::of::<Q8_24>(), "Q8.24"),
        (Number::of::<Q12_20>(), "Q12.20"),
        (Number::of::<Q16_16>(), "Q16.16"),
    ];
    for (number, name) in all {
        assert_eq!(number.to_string(), name);
    }
    assert_eq!(Name::new("pedestrian/north-and-south").to_string(), "pedestrian/north");
    assert_ne!(Name::new("a").code(), Name::new("b").code());
}
