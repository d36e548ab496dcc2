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
    /// The end of the stance at which the stride arrived (µs, the samples' clock).
    pub time_us: u64,
    /// The position of that stance (m, earth, from the start).
    pub position: SVector<T, 3>,
    /// The horizontal distance from the preceding stance (m).
    pub length: T,
    /// The time since the end of the preceding stance (s).
    pub duration: T,
    /// The change of direction from the preceding stride, anticlockwise from above (rad); zero for the first.
    pub heading_change: T,
    /// The time for which the foot's motion on the way is unknown (s): where samples are missing while it may have
    /// moved, at most 60 s each time; and 0.2 s where the tilt was lost.
    pub unseen: T,
    /// The bridged turn of the body beyond the end of its gyroscope's range on the way (rad).
    pub bridged: T,
    /// The relative error of gravity at rest so far, combined with its standard deviation. It is due to the
    /// accelerometer's scale, which affects strides, too, or to its zero.
    pub gravity_off: T,
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
    /// The unseen time on the way to the next footprint, and to the one after it (s).
    unseen: [T; 2],
    bridged: T,
}

impl<T: Scalar> Strides<T> {
    /// The shortest stride (m): a foot that moved less shuffled or was misjudged.
    const SHORTEST: f64 = 0.1;

    pub(crate) fn new() -> Self {
        let zero = T::ZERO;
        let (path_length, unseen, bridged) = (zero, [zero; 2], zero);
        Self { standing: None, last: None, heading: None, path_length, unseen, bridged }
    }

    /// The length of the horizontal path so far, from stance to stance (m).
    pub(crate) fn path_length(&self) -> T {
        self.path_length
    }

    /// Notes that the foot's motion is unknown for a time (s), after which it stands or not.
    #[cold]
    pub(crate) fn miss(&mut self, seconds: T, stance: bool) {
        let [to_next, to_one_after] = &mut self.unseen;
        let has_left = self.standing.is_some() && !stance;
        *(if has_left { to_one_after } else { to_next }) += seconds;
    }

    /// Notes that the body turned by more than its gyroscope measured (rad).
    pub(crate) fn bridge(&mut self, turn: &SVector<T, 3>) {
        let [x, y, z] = *turn.as_array();
        self.bridged += x.hypot(y).hypot(z);
    }

    /// Processes the next position; a stride is complete when the stance to which it led ends.
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

    /// Ends the current stance, if any.
    pub(crate) fn finish(&mut self) -> Option<Stride<T>> {
        let footprint = self.standing.take()?;
        let [unseen, next] = self.unseen;
        // Until a stride reports it, it belongs to the way to the next one.
        self.unseen = [unseen + next, T::ZERO];
        let Some(last) = self.last else {
            self.last = Some(footprint);
            return None;
        };
        let [x, y, _] = *(footprint.position - last.position).as_array();
        let length = x.hypot(y);
        if length < T::from_f64(Self::SHORTEST) {
            return None;
        }
        self.unseen = [next, T::ZERO];
        let heading = y.atan2(x);
        let heading_change = self.heading.map_or(T::ZERO, |before| wrapped(heading - before));
        self.path_length += length;
        self.last = Some(footprint);
        self.heading = Some(heading);
        let micro = footprint.time_us.saturating_sub(last.time_us).min(i32::MAX as u64);
        let bridged = core::mem::replace(&mut self.bridged, T::ZERO);
        Some(Stride {
            time_us: footprint.time_us,
            position: footprint.position,
            length,
            duration: T::from_micro(micro as i32),
            heading_change,
            unseen,
            bridged,
            gravity_off: T::ZERO,
        })
    }
}

/// Wraps an angle between −2π and 2π to −π..=π.
fn wrapped<T: Scalar>(angle: T) -> T {
    if angle > T::PI {
        angle - T::PI - T::PI
    } else if angle < -T::PI {
        angle + T::PI + T::PI
    } else {
        angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    /// Stances and swings of half a second each, at these places.
    fn walked<const K: usize>(places: [[f64; 2]; K]) -> ([Option<Stride<f64>>; K], f64) {
        let mut strides = Strides::new();
        let mut begin_us = 0;
        let found = places.map(|[x, y]| {
            let position = SVector::from([x, y, 0.3]);
            let mut found = None;
            for step in 0..100 {
                let stride = strides.update(begin_us + step * 10_000, position, step < 50);
                assert!(stride.is_none() || step == 50, "a stride is told once, and at its end");
                found = found.or(stride);
            }
            begin_us += 1_000_000;
            found
        });
        assert!(strides.finish().is_none(), "no stance is open");
        (found, strides.path_length())
    }

    #[test]
    fn a_stride_leads_from_stance_to_stance() {
        let ([begin, first, shuffle, second], path) =
            walked([[0.0, 0.0], [0.6, 0.8], [0.6, 0.71], [-0.4, 0.8]]);
        assert_eq!((begin, shuffle), (None, None));
        let (first, second) = (first.expect("a stride"), second.expect("a stride"));
        assert!((first.length - 1.0).abs() < 1e-9 && (path - 2.0).abs() < 1e-9, "{first:?}");
        assert_eq!(first.time_us, 1_490_000);
        assert_eq!(first.position, SVector::from([0.6, 0.8, 0.3]));
        assert!((first.duration - 1.0).abs() < 1e-9 && first.heading_change == 0.0, "{first:?}");
        // The shuffle is no stance of its own: the next stride began before it.
        assert!((second.length - 1.0).abs() < 1e-9 && (second.duration - 2.0).abs() < 1e-9);
        assert!((second.heading_change - (PI - 0.8_f64.atan2(0.6))).abs() < 1e-9, "{second:?}");
    }

    #[test]
    fn what_was_not_seen_is_on_the_way_to_one_footprint() {
        // After the first stance, before a shuffle, and in the midst of a stance.
        let stances =
            [(0.0, None), (1.0, Some(0.25)), (1.05, None), (2.0, Some(0.5)), (3.0, Some(0.125))];
        let mut strides = Strides::new();
        for (at, (metres, unseen)) in stances.into_iter().enumerate() {
            let position = SVector::from([metres, 0.0, 0.0]);
            assert!(strides.update(0, position, true).is_none());
            match at {
                0 => strides.miss(0.25, false),
                1 => strides.miss(0.5, false),
                4 => strides.miss(0.125, true),
                _ => {}
            }
            let stride = strides.update(0, position, false);
            assert_eq!(stride.map(|stride| stride.unseen), unseen, "to {metres} m");
        }
    }

    #[test]
    fn a_walk_round_a_square_turns_by_right_angles() {
        for side in [1.0, -1.0] {
            let corner = |k: usize| match k % 4 {
                0 => [0.0, 0.0],
                1 => [1.0, 0.0],
                2 => [1.0, side],
                _ => [0.0, side],
            };
            let (strides, _) = walked::<10>(core::array::from_fn(corner));
            for stride in strides.iter().skip(2) {
                let turn = stride.expect("a stride").heading_change;
                assert!((turn - side * PI / 2.0).abs() < 1e-9, "{turn}");
            }
        }
    }

    #[test]
    fn a_stance_that_goes_on_is_a_stride_when_the_walk_ends() {
        let mut strides = Strides::new();
        assert!(strides.update(0, SVector::zeros(), true).is_none());
        assert!(strides.update(10, SVector::zeros(), false).is_none());
        assert!(strides.update(20, SVector::from([0.0, 0.101, 0.0]), true).is_none());
        assert!((strides.finish().expect("a stride").length - 0.101).abs() < 1e-12);
        assert!((strides.path_length() - 0.101).abs() < 1e-12);
    }

    #[test]
    fn an_angle_is_the_same_within_half_a_turn() {
        for step in -125..=125 {
            let angle = 0.05 * f64::from(step);
            let wrapped = wrapped(angle);
            assert!(wrapped.abs() <= PI, "{angle}: {wrapped}");
            let (sine, cosine) = wrapped.sin_cos();
            assert!((sine - angle.sin()).hypot(cosine - angle.cos()) < 1e-9, "{angle}: {wrapped}");
        }
    }
}
