//! Points that fill a box evenly.

use kestirim_scalar::Scalar;
use rand_core::Rng;

use crate::random::uniform;

/// Initial distribution of particles in a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Start {
    /// Independently and uniformly.
    Random,
    /// By Roberts' sequence `R_D`, whose first points are as even as all of them: multiples of powers of the
    /// generalised golden ratio.
    QuasiRandom,
    /// On a lattice of just so many points: the first coordinate in equal steps, the others by R_(D − 1). In
    /// the plane that is the golden lattice.
    Lattice,
}

/// 2³²·φ⁻ᵏ for k = 1 to D, φ the positive root of x^(D + 1) = x + 1 (M. Roberts, "The unreasonable
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

/// Carries the tables, which are computed by the compiler.
struct Tables<const D: usize>;

impl<const D: usize> Tables<D> {
    const ALL: [u32; D] = steps(D);
    const ALL_BUT_ONE: [u32; D] = steps(D - 1);
}

/// The first coordinates of a lattice: equal steps, of which the first begins half a step from the border.
#[derive(Clone, Copy)]
pub(crate) struct Steps {
    step: u32,
    half: u32,
}

impl Steps {
    #[inline]
    pub(crate) fn of(count: usize) -> Self {
        let step = (1_u64 << 32) / (count as u64).clamp(1, 1 << 31);
        // One point alone has all of 2³², which is zero, and never takes a step.
        Self { step: step as u32, half: (step / 2) as u32 }
    }
}

/// The point number `index` of a lattice in the unit cube, 2³² to a side.
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
    /// A point in the unit cube, 2³² to a side.
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

/// From the unit cube into a box.
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
