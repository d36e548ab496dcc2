//! Clocks that count, and begin anew at midnight or at the end of 32 bits.

const DAY: f64 = 86_400.0;
/// What a clock that counts may begin anew at, in its own unit.
pub(crate) const PERIODS: [f64; 4] = [DAY, DAY * 1e3, DAY * 1e6, 4_294_967_296.0];
/// How near to its ends a clock must be where it begins anew, as a share of its period.
const NEAR: f64 = 1e-3;

/// The period of a clock that began anew between `last` and `time`.
pub(crate) fn period(periods: &[f64], last: f64, time: f64) -> Option<f64> {
    periods.iter().copied().find(|period| {
        (0.0..=period * NEAR).contains(&time) && (0.0..=period * NEAR).contains(&(period - last))
    })
}

/// A clock whose times are continued where it begins anew.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counter {
    passed: f64,
    last: Option<f64>,
}

impl Counter {
    /// The time since the clock's first beginning, for one time after the other.
    pub(crate) fn continued(&mut self, time: f64) -> f64 {
        let last = self.last.replace(time).unwrap_or(time);
        if let Some(period) = period(&PERIODS, last, time) {
            self.passed += period;
        } else if let Some(period) = period(&PERIODS, time, last)
            && self.passed >= period
        {
            // A row from before the end that was written after it.
            self.passed -= period;
        }
        time + self.passed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_goes_on_where_it_begins_anew() {
        let bits = 4_294_967_296.0;
        let mut clock = Counter::default();
        let times = [bits - 20.0, bits - 5.0, 10.0, bits - 1.0, 25.0, 2e9, bits - 1.0, 3.0];
        let continued = times.map(|time| clock.continued(time) - bits);
        assert_eq!(continued, [-20.0, -5.0, 10.0, -1.0, 25.0, 2e9, bits - 1.0, bits + 3.0]);
        // What falls from anywhere else is another beginning, or out of order.
        let mut clock = Counter::default();
        assert_eq!([5000.0, 3.0, 86_000.0, 5.0].map(|time| clock.continued(time))[3], 5.0);
        let mut clock = Counter::default();
        assert_eq!([86_399.5, 0.5].map(|time| clock.continued(time)), [86_399.5, 86_400.5]);
    }
}
