//! Calls everything of `kestirim-snapshot`, with an estimator that has every kind of field.

use kestirim_scalar::{Q12_20, Scalar};
use kestirim_snapshot::arrays::{count, deserialize, index, serialize};
use kestirim_snapshot::{Layout, Name, Number, header, load, size, store};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::values::{any, call_each, keep, maybe, number, numbers, slice, whole, yes_or_no};

struct Row([f32; 5]);

impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serialize(&self.0, serializer)
    }
}

impl<'de> Deserialize<'de> for Row {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserialize(deserializer).map(Self)
    }
}

fn at<'de, D: Deserializer<'de>>(deserializer: D) -> Result<usize, D::Error> {
    index::<D, 5>(deserializer)
}

fn used<'de, D: Deserializer<'de>>(deserializer: D) -> Result<usize, D::Error> {
    count::<D, 5>(deserializer)
}

#[derive(Serialize, Deserialize)]
enum Mode {
    Waiting,
    Moving(u64),
    Resting { since: i64 },
}

#[derive(Serialize, Deserialize)]
struct Estimator {
    row: Row,
    #[serde(with = "kestirim_snapshot::arrays::rows")]
    rows: [[f32; 3]; 2],
    #[serde(with = "kestirim_snapshot::arrays::optional")]
    optional: Option<[f32; 3]>,
    #[serde(deserialize_with = "at")]
    at: usize,
    #[serde(deserialize_with = "used")]
    used: usize,
    mode: Mode,
    is_good: bool,
    small: (u8, u16, i32),
}

kestirim_snapshot::layout! {
    [] for Estimator as "surface", 1, f32, [5, 3, 2]
}

fn estimator() -> Estimator {
    let mode = match (yes_or_no(), yes_or_no()) {
        (true, _) => Mode::Moving(whole()),
        (_, true) => Mode::Resting { since: whole::<u64>() as i64 },
        _ => Mode::Waiting,
    };
    any(Estimator {
        row: Row(numbers()),
        rows: [numbers(), numbers()],
        optional: maybe(numbers()),
        at: whole(),
        used: whole(),
        mode,
        is_good: yes_or_no(),
        small: (whole(), whole(), whole()),
    })
}

fn stored() {
    let mut page = any([0; 256]);
    let estimator = estimator();
    keep(size(&estimator));
    let stored = any(store(&estimator, &mut page).map(<[u8]>::len));
    keep(header(slice(&page)).ok());
    keep(load::<Estimator>(slice(&page)).ok());
    // Load from a buffer that is too small, and from a damaged one.
    let place = whole::<usize>();
    if let Some(byte) = page.get_mut(place) {
        *byte = whole();
    }
    keep(load::<Estimator>(&page).ok());
    keep(stored.is_ok());
    let mut small = any([0; 60]);
    keep(store(&estimator, &mut small).is_ok());
}

fn names() {
    keep(Name::code(any(Name::new(any("surface")))));
    keep(<Estimator as Layout>::number());
    keep(<Estimator as Layout>::sizes());
}

fn numbers_of<T: Scalar>() {
    keep(Number::of::<T>());
    keep(number::<T>());
}

/// Calls everything in this module.
pub fn run() {
    call_each([stored, names, numbers_of::<f32>, numbers_of::<Q12_20>]);
}
