//! Points that fill a box evenly.

use kestirim_scalar::Scalar;
use rand_core::Rng;

use crate::random::uniform;

/// Initial distribution of particles in a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Start {
    /// Independent uniform random points.
    Random,
    /// Roberts' sequence `R_D`, multiples of powers of the generalised golden ratio, whose first points fill the box as
    /// evenly as all of them do.
    QuasiRandom,
    /// A lattice of exactly as many points as particles: the first coordinate in equal steps, the others by R_(D − 1).
    /// In the plane it is the golden lattice.
    Lattice,
}

/// 2³²·φ⁻ᵏ for k = 1 to D, where φ is the positive root of x^(D + 1) = x + 1 (M. Roberts, "The unreasonable
/// effectiveness of quasirandom sequences", 2018).
const fn steps<const D: usize>(dimensions: usize) -> [u32; D] {
    let mut root = 2.0_f64;
    let mut iteration = 0;
    while iteration < 60 {
        let mut power = 1.0;
        let mut factor = 0;
        while factor < dimensions {
            power *= root;
            factor += 1;
        }
        // Newton's step for x·xᴰ − x − 1.
        let slope = (dimensions as f64 + 1.0) * power - 1.0;
        root -= (power * root - root - 1.0) / slope;
        iteration += 1;
    }
    let mut steps = [0; D];
    let mut step = 1.0;
    let mut k = 0;
    while k < D {
        step /= root;
        steps[k] = (step * 4_294_967_296.0) as u32;
        k += 1;
    }
    steps
}

/// Holder of the tables, which are computed at compile time.
struct Tables<const D: usize>;

impl<const D: usize> Tables<D> {
    const ALL: [u32; D] = steps(D);
    const ALL_BUT_ONE: [u32; D] = steps(D - 1);
}

/// First coordinates of a lattice: equal steps, the first of which begins half a step from the border.
#[derive(Clone, Copy)]
pub(crate) struct Steps {
    step: u32,
    half: u32,
}

impl Steps {
    #[inline]
    pub(crate) fn of(count: usize) -> Self {
        let step = (1_u64 << 32) / (count as u64).clamp(1, 1 << 31);
        // For a single point the step of 2³² wraps to zero, but no step is taken.
        Self { step: step as u32, half: (step / 2) as u32 }
    }
}

/// The point at position `index` of a lattice in the unit cube, whose side is 2³².
#[inline(always)]
pub(crate) fn lattice_point<const D: usize>(index: u32, steps: Steps) -> [u32; D] {
    let mut point = [0; D];
    for axis in 0..D {
        point[axis] = if axis == 0 {
            index.wrapping_mul(steps.step).wrapping_add(steps.half)
        } else {
            index.wrapping_mul(Tables::<D>::ALL_BUT_ONE[axis - 1]).wrapping_add(1 << 31)
        };
    }
    point
}

impl Start {
    /// The point at position `index` in the unit cube, whose side is 2³².
    #[inline]
    pub(crate) fn point<const D: usize, R: Rng + ?Sized>(
        self,
        index: u32,
        steps: Steps,
        rng: &mut R,
    ) -> [u32; D] {
        match self {
            Self::Random => [(); D].map(|()| rng.next_u32()),
            Self::QuasiRandom => {
                Tables::<D>::ALL.map(|step| index.wrapping_mul(step).wrapping_add(1 << 31))
            }
            Self::Lattice => lattice_point(index, steps),
        }
    }
}

/// Maps a point of the unit cube into a box.
#[inline(always)]
pub(crate) fn placed<T: Scalar, const D: usize>(
    point: [u32; D],
    low: &[T; D],
    width: &[T; D],
) -> [T; D] {
    let mut place = [T::ZERO; D];
    for axis in 0..D {
        place[axis] = low[axis] + width[axis] * uniform(point[axis]);
    }
    place
}
