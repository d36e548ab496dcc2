use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// A stride: from one stance of the instrumented foot to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Stride<T: Scalar> {
    /// The end of the stance it arrived at (µs, the samples' clock).
    pub time_us: u64,
    /// Position of that stance (m, earth, from the start).
    pub position: SVector<T, 3>,
    /// Horizontal distance from the stance before (m).
    pub length: T,
    /// Time since the end of the stance before (s).
    pub duration: T,
    /// Turn of its direction from that of the stride before, anticlockwise from above (rad); zero
    /// for the first.
    pub heading_change: T,
}

/// A stance of the foot.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Footprint<T: Scalar> {
    time_us: u64,
    position: SVector<T, 3>,
}

/// Finds the strides in a stream of positions and stances.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Strides<T: Scalar> {
    standing: Option<Footprint<T>>,
    last: Option<Footprint<T>>,
    heading: Option<T>,
    path_length: T,
}

impl<T: Scalar> Strides<T> {
    /// A foot that moved less (m) shuffled or was misjudged; it made no stride.
    const SHORTEST: f64 = 0.1;

    pub(crate) fn new() -> Self {
        Self { standing: None, last: None, heading: None, path_length: T::ZERO }
    }

    /// The horizontal path from stance to stance so far (m).
    pub(crate) fn path_length(&self) -> T {
        self.path_length
    }

    /// Takes the next position; a stride is complete when the stance it led to ends.
    #[inline]
    pub(crate) fn update(
        &mut self,
        time_us: u64,
        position: SVector<T, 3>,
        stance: bool,
    ) -> Option<Stride<T>> {
        if stance {
            self.standing = Some(Footprint { time_us, position });
            return None;
        }
        self.finish()
    }

    /// Ends the stance there is, if any.
    pub(crate) fn finish(&mut self) -> Option<Stride<T>> {
        let footprint = self.standing.take()?;
        let Some(last) = self.last else {
            self.last = Some(footprint);
            return None;
        };
        let [x, y, _] = *(footprint.position - last.position).as_array();
        let length = x.hypot(y);
        if length < T::from_f64(Self::SHORTEST) {
            return None;
        }
        let heading = y.atan2(x);
        let heading_change = self.heading.map_or(T::ZERO, |before| wrapped(heading - before));
        self.path_length += length;
        self.last = Some(footprint);
        self.heading = Some(heading);
        let micro = footprint.time_us.saturating_sub(last.time_us).min(i32::MAX as u64);
        Some(Stride {
            time_us: footprint.time_us,
            position: footprint.position,
            length,
            duration: T::from_micro(micro as i32),
            heading_change,
        })
    }
}

/// An angle between −2π and 2π brought to −π..=π.
fn wrapped<T: Scalar>(angle: T) -> T {
    if angle > T::PI {
        angle - T::PI - T::PI
    } else if angle < -T::PI {
        angle + T::PI + T::PI
    } else {
        angle
    }
}
