//! Overlays of two results of one figure, and their differences.

use crate::{Figure, Mark, Series};

impl Figure {
    /// Draws another result of the same figure behind this one. `names` are those of the other result and of this one,
    /// put before the names of their series; a series that is the same in both is drawn once.
    pub fn before(mut self, other: &Self, names: [&str; 2]) -> Self {
        let differing = |these: &Self, those: &Self| -> Vec<bool> {
            (0..these.series.len()).map(|place| !same(these, place, those)).collect()
        };
        let [theirs, ours] = [differing(other, &self), differing(&self, other)];
        let named = |name: &str, series: &Series| format!("{name}: {}", series.name);
        for (series, _) in self.series.iter_mut().zip(ours).filter(|(_, differs)| *differs) {
            series.name = named(names[1], series);
        }
        let behind = other.series.iter().zip(theirs).filter(|(_, differs)| *differs);
        let behind = behind.map(|(series, _)| {
            let name = named(names[0], series);
            Series { name, faint: true, ..series.clone() }
        });
        self.series.splice(0..0, behind.collect::<Vec<_>>());
        self
    }

    /// This result minus another one, series by series, at the times of this one; on a map, the distance between the
    /// places at the same time. `None` if there is nothing to show: no time, no other series of the same name, or no
    /// difference.
    pub fn less(&self, other: &Self) -> Option<Self> {
        let differing = (0..self.series.len()).filter(|&place| !same(self, place, other));
        let pairs = differing.filter_map(|place| {
            let (series, theirs) = (&self.series[place], twin(self, place, other)?);
            let difference =
                if self.equal { apart(series, theirs) } else { difference(series, theirs) };
            difference.map(|(x, y)| Series {
                hidden: series.hidden,
                ..Series::new(series.name.clone(), marked(series.mark), x, y)
                    .coloured(series.colour)
            })
        });
        let series: Vec<_> = pairs.collect();
        if series.is_empty() || (self.x.seconds.is_none() && !self.equal) {
            return None;
        }
        let figure = Self::new(self.id.clone(), self.title.clone()).with_all(series);
        Some(if self.equal {
            figure
                .over_seconds("distance, m")
                .caption("How far the places of the same time are apart.")
        } else {
            let seconds = self.x.seconds.unwrap_or(1.0);
            figure
                .axes(self.x.label.clone(), format!("difference of {}", self.y.label))
                .clock(seconds)
                .caption("The later one less the earlier one, at the same time.")
        })
    }
}

/// The series of the same name in another figure: if several have it, the one at the same place among them.
fn twin<'a>(figure: &Figure, place: usize, other: &'a Figure) -> Option<&'a Series> {
    let name = &figure.series.get(place)?.name;
    let before = figure.series[..place].iter().filter(|series| series.name == *name).count();
    other.series.iter().filter(|series| series.name == *name).nth(before)
}

/// The covariances of a series, flattened.
fn flat(series: &Series) -> Option<&[f64]> {
    series.spread.as_deref().map(<[_]>::as_flattened)
}

/// Whether another figure has an equal series of the same name.
fn same(figure: &Figure, place: usize, other: &Figure) -> bool {
    // Gaps are `NaN`, which equals nothing: two gaps count as equal.
    let equal = |a: &[f64], b: &[f64]| {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a == b || (a.is_nan() && b.is_nan()))
    };
    let both = |a: Option<&[f64]>, b: Option<&[f64]>| match (a, b) {
        (Some(a), Some(b)) => equal(a, b),
        (a, b) => a.is_none() && b.is_none(),
    };
    let ours = &figure.series[place];
    twin(figure, place, other).is_some_and(|theirs| {
        equal(&ours.x, &theirs.x)
            && equal(&ours.y, &theirs.y)
            && both(ours.error.as_deref(), theirs.error.as_deref())
            && both(ours.times.as_deref(), theirs.times.as_deref())
            && both(flat(ours), flat(theirs))
            && ours.labels == theirs.labels
    })
}

/// The mark of a difference: a line where the series is drawn as steps or dashes, else the mark of the series.
fn marked(mark: Mark) -> Mark {
    match mark {
        Mark::Steps | Mark::Dashes => Mark::Line,
        mark => mark,
    }
}

type Line = (Vec<f64>, Vec<f64>);

/// The first series minus the second, at the points of the first; `None` if either is not a function of the horizontal
/// axis.
fn difference(ours: &Series, theirs: &Series) -> Option<Line> {
    let is_held = theirs.mark == Mark::Steps;
    let theirs = Function::new(&theirs.x, &theirs.y)?;
    Function::new(&ours.x, &ours.y)?;
    let at = |x| if is_held { theirs.held(x) } else { theirs.at(x) };
    let values = ours.x.iter().zip(&ours.y).map(|(&x, &y)| y - at(x));
    Some((ours.x.clone(), values.collect()))
}

/// The distance between two paths at the times of the first; `None` if either has no times.
fn apart(ours: &Series, theirs: &Series) -> Option<Line> {
    let their_times = theirs.times.as_deref()?;
    let (x, y) = (Function::new(their_times, &theirs.x)?, Function::new(their_times, &theirs.y)?);
    let times = ours.times.as_deref()?;
    let places = times.iter().zip(ours.x.iter().zip(&ours.y));
    let values = places.map(|(&time, (&ax, &ay))| (ax - x.at(time)).hypot(ay - y.at(time)));
    Some((times.to_vec(), values.collect()))
}

/// A function given by points that are sorted along the horizontal axis.
struct Function<'a> {
    x: &'a [f64],
    y: &'a [f64],
}

impl<'a> Function<'a> {
    /// `None` without points, or if the abscissae are not sorted.
    fn new(x: &'a [f64], y: &'a [f64]) -> Option<Self> {
        let length = x.len().min(y.len());
        let (x, y) = (&x[..length], &y[..length]);
        (length > 0 && x.is_sorted()).then_some(Self { x, y })
    }

    /// The value of the last point that is not later than `x`; `NaN` before the first point and beyond the last.
    fn held(&self, x: f64) -> f64 {
        let after = self.x.partition_point(|&known| known <= x);
        match after.checked_sub(1) {
            Some(last) if after < self.x.len() || self.x[last] == x => self.y[last],
            _ => f64::NAN,
        }
    }

    /// The value interpolated linearly at `x`; `NaN` beyond the ends and in gaps.
    fn at(&self, x: f64) -> f64 {
        let after = self.x.partition_point(|&known| known < x);
        match (self.x.get(after), after.checked_sub(1)) {
            (Some(&known), _) if known == x => self.y[after],
            (Some(&right), Some(before)) => {
                let part = (x - self.x[before]) / (right - self.x[before]);
                self.y[before] + part * (self.y[after] - self.y[before])
            }
            _ => f64::NAN,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Colour;

    fn over_time(y: [f64; 3]) -> Figure {
        let ours = Series::line("ours", vec![0.0, 1.0, 2.0], y.to_vec());
        Figure::new("f", "F").over_seconds("y, m").with(ours)
    }

    #[test]
    fn both_are_drawn_the_other_faint_behind() {
        let level = Series::line("level", vec![0.0, 1.0], vec![1.0, f64::NAN]);
        let [ours, other] = [1.0, 0.0].map(|y| over_time([y; 3]).with(level.clone()));
        let both = ours.before(&other, ["A", "B"]);
        let names: Vec<_> = both.series.iter().map(|it| (it.name.as_str(), it.faint)).collect();
        assert_eq!(names, [("A: ours", true), ("B: ours", false), ("level", false)]);
    }

    #[test]
    fn differences_are_between_equal_times() {
        let other = Figure::new("f", "F").over_seconds("y, m").with(Series::line(
            "ours",
            vec![0.5, 2.0],
            vec![1.0, 4.0],
        ));
        let less = over_time([0.0, 5.0, 6.0]).less(&other).expect("a difference");
        let [series] = less.series.as_slice() else { panic!("{less:?}") };
        assert!(series.y[0].is_nan(), "before the other began");
        assert_eq!(series.y[1..], [3.0, 2.0]);
        assert_eq!((less.x.seconds, series.colour), (Some(1.0), Colour::Ours));
        assert!(less.y.label.contains("y, m"));
    }

    #[test]
    fn steps_are_held_and_series_of_one_name_are_told_apart_by_their_order() {
        let steps = |y: [f64; 3], z: f64| {
            let steps = Series::new("on", Mark::Steps, vec![0.0, 1.0, 2.0], y.to_vec());
            let again = Series::line("on", vec![0.0, 0.5], vec![z; 2]);
            Figure::new("f", "F").over_seconds("y").with(steps).with(again)
        };
        let mut ours = steps([0.0, 1.0, 1.0], 5.0);
        ours.series[0].x[1] = 0.5;
        let less = ours.less(&steps([0.0, 1.0, 1.0], 4.0)).expect("a difference");
        assert_eq!(less.series[0].y, [0.0, 1.0, 0.0], "between 0 and 1 the other is 0");
        assert_eq!(less.series[1].y, [1.0, 1.0]);
    }

    #[test]
    fn on_a_map_it_is_the_distance() {
        let map = |y: f64| {
            let path = Series::path("ours", [[0.0, y], [3.0, y]]).timed([0.0, 1.0]);
            Figure::new("m", "M").axes("x, m", "y, m").map().with(path)
        };
        let less = map(0.0).less(&map(2.0)).expect("a difference");
        assert_eq!((less.equal, less.series[0].y.as_slice()), (false, &[2.0, 2.0][..]));
    }

    #[test]
    fn what_has_no_time_has_no_difference() {
        let poles = Figure::new("p", "P").with(Series::points("ours", [[0.0, 1.0]]));
        assert_eq!(poles.less(&poles), None);
        assert_eq!(over_time([0.0; 3]).less(&over_time([0.0; 3])), None, "the same");
        let unknown = over_time([0.0; 3]).less(&Figure::new("f", "F"));
        assert_eq!(unknown, None);
    }
}
