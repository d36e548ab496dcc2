//! Puts samples into the order of time. Those out of order are left out, clocks that wrap at midnight or at the end of
//! their counter are continued, and a recording that restarts is refused.

use super::raw::Raw;
use crate::counter::period;
use crate::damage::{Damage, Fault};
use crate::error::{Complaint, Error};
use crate::part::Part;

/// The largest number of doubled lines that are taken for an accident and dropped; more are the logger's habit, and
/// kept.
const ACCIDENTS: usize = 3;
/// The number of consecutive lines at the end of a log, all earlier than the latest time, that are taken for a
/// restarted recording.
const RESTART: usize = 4;

/// Samples with their lines and the indices of their rows.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    pub(crate) raw: Vec<Raw>,
    pub(crate) lines: Vec<usize>,
    pub(crate) places: Vec<usize>,
}

impl Rows {
    fn move_to(&mut self, to: usize, from: usize) {
        self.raw[to] = self.raw[from];
        self.lines[to] = self.lines[from];
        self.places[to] = self.places[from];
    }

    /// Drops the samples at these indices, which must ascend.
    pub(crate) fn remove(&mut self, left_out: &[usize]) {
        let Some(&first) = left_out.first() else { return };
        let (mut kept, mut left_out) = (first, left_out.iter().peekable());
        for i in first..self.raw.len() {
            if left_out.next_if_eq(&&i).is_none() {
                self.move_to(kept, i);
                kept += 1;
            }
        }
        self.truncate(kept);
    }

    fn truncate(&mut self, length: usize) {
        self.raw.truncate(length);
        self.lines.truncate(length);
        self.places.truncate(length);
    }

    /// Keeps only samples whose times ascend or repeat. A clock that wraps at one of `periods` is continued.
    ///
    /// # Errors
    /// [`Error::Line`] or [`Error::Part`] where a recording restarts.
    pub(crate) fn put_in_order(
        &mut self,
        periods: &[f64],
        damage: &mut Damage,
    ) -> Result<(), Error> {
        let allowed = Damage::allowed(self.raw.len());
        let (mut kept, mut passed, mut early, mut restart) = (0_usize, 0.0, 0, 0);
        for i in 0..self.raw.len() {
            let mut time = self.raw[i].time + passed;
            if let Some(last) = kept.checked_sub(1).map(|last| self.raw[last].time)
                && time < last
            {
                if let Some(period) = period(periods, last - passed, self.raw[i].time) {
                    passed += period;
                    time += period;
                } else if self.is_late(kept, i, passed) {
                    kept -= 1;
                    self.leave_out(kept, damage);
                } else {
                    early += 1;
                    restart = if early == 1 { self.lines[i] } else { restart };
                    self.leave_out(i, damage);
                    if early > allowed {
                        return Err(anew(damage.part, restart));
                    }
                    continue;
                }
            }
            early = 0;
            self.move_to(kept, i);
            self.raw[kept].time = time;
            kept += 1;
        }
        if early >= RESTART {
            return Err(anew(damage.part, restart));
        }
        self.truncate(kept);
        Ok(())
    }

    /// Whether the last kept sample is out of order rather than the earlier sample `i`: its predecessor and the
    /// successor of `i` decide.
    fn is_late(&self, kept: usize, i: usize, passed: f64) -> bool {
        let (last, time) = (self.raw[kept - 1].time, self.raw[i].time + passed);
        let next = self.raw.get(i + 1).map(|next| next.time + passed);
        let before = kept.checked_sub(2).map(|before| self.raw[before].time);
        next.is_some_and(|next| next >= time && next < last)
            && before.is_none_or(|before| before <= time)
    }

    fn leave_out(&self, place: usize, damage: &mut Damage) {
        let before = damage.part.before();
        damage.add(Fault::OutOfOrder, self.lines[place], || {
            format!("expected a time not before that of {before}, found an earlier one")
        });
    }

    /// Drops samples that repeat the one before, if they are few; returns the number of repeated samples that stay.
    pub(crate) fn without_doubles(&mut self, damage: &mut Damage) -> usize {
        let is_double = |i: usize, raw: &[Raw]| i > 0 && raw[i] == raw[i - 1];
        let doubles = (0..self.raw.len()).filter(|&i| is_double(i, &self.raw)).count();
        if doubles == 0 || doubles > ACCIDENTS || doubles * 2 > self.raw.len() {
            return doubles;
        }
        let mut kept = 0;
        for i in 0..self.raw.len() {
            if kept > 0 && self.raw[i] == self.raw[kept - 1] {
                let before = damage.part.before();
                let problem = || format!("expected another sample, found the one of {before}");
                damage.add(Fault::Doubled, self.lines[i], problem);
            } else {
                self.move_to(kept, i);
                kept += 1;
            }
        }
        self.truncate(kept);
        0
    }
}

fn anew(part: Part, line: usize) -> Error {
    let problem = "expected times that ascend, found a recording that begins anew".to_owned();
    Complaint { part, line, problem }.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ordered(times: &[f64], periods: &[f64]) -> Result<(Vec<f64>, Vec<usize>), Error> {
        let raw = |&time: &f64| Raw { time, force: [0.0, 0.0, time], rate: [0.0; 3] };
        let mut rows = Rows {
            raw: times.iter().map(raw).collect(),
            lines: (1..=times.len()).collect(),
            places: (0..times.len()).collect(),
        };
        let mut damage = Damage::default();
        rows.put_in_order(periods, &mut damage)?;
        rows.without_doubles(&mut damage);
        let lines = damage.losses.into_iter().flat_map(|loss| loss.lines).collect();
        Ok((rows.raw.into_iter().map(|raw| raw.time).collect(), lines))
    }

    #[test]
    fn what_is_out_of_order_is_left_out() {
        let cases: [(&[f64], &[f64], &[usize]); 5] = [
            (&[1.0, 2.0, 1.5, 3.0, 4.0], &[1.0, 2.0, 3.0, 4.0], &[3]),
            (&[1.0, 2.0, 99.0, 3.0, 4.0], &[1.0, 2.0, 3.0, 4.0], &[3]),
            (&[99.0, 2.0, 3.0, 4.0], &[2.0, 3.0, 4.0], &[1]),
            (&[1.0, 2.0, 2.0, 3.0, 4.0], &[1.0, 2.0, 3.0, 4.0], &[3]),
            (&[1.0, 2.0, 3.0, 1.0], &[1.0, 2.0, 3.0], &[4]),
        ];
        for (times, expected, lines) in cases {
            assert_eq!(ordered(times, &[]), Ok((expected.to_vec(), lines.to_vec())));
        }
    }

    #[test]
    fn a_recording_that_begins_anew_is_refused() {
        let error = ordered(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.0, 1.0, 2.0, 3.0], &[]).unwrap_err();
        assert!(error.to_string().starts_with("line 7: expected times that ascend"), "{error}");
    }

    #[test]
    fn clocks_that_begin_anew_go_on() {
        let times = ordered(&[86399.5, 86399.9, 0.3, 0.7], &[86400.0]).unwrap().0;
        assert_eq!(times, [86399.5, 86399.9, 86400.3, 86400.7]);
    }
}
