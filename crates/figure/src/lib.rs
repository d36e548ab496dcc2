#![doc = include_str!("../README.md")]

mod compare;
mod contour;
pub mod csv;
mod ellipse;
mod outline;
pub mod plotly;
mod series;
pub mod svg;
mod thin;

pub use contour::Grid;
pub use ellipse::ellipse;
pub use series::{Colour, Mark, Series};
pub use thin::View;

/// A diagram of one or more series over two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Names its files and its place on the page: lower case, with hyphens.
    pub id: String,
    /// What it shows, in a few words.
    pub title: String,
    /// What to see in it.
    pub caption: String,
    /// From left to right.
    pub x: Axis,
    /// From below to above.
    pub y: Axis,
    /// Whether a metre is as long along either axis, as on a map.
    pub equal: bool,
    /// What is drawn, the first below the others.
    pub series: Vec<Series>,
}

/// An axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// Whether decades are equally long.
    pub logarithmic: bool,
    /// What is shown at first [default: everything].
    pub range: Option<[f64; 2]>,
    /// How many seconds one unit is, where the axis is a time.
    pub seconds: Option<f64>,
}

/// The least and the greatest of the numbers that are finite; none if there is none.
fn extent(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let finite = values.filter(|value| value.is_finite());
    let ends = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    });
    (ends[0] <= ends[1]).then_some(ends)
}

impl Figure {
    /// A figure without series and axes.
    pub fn new(id: impl Into<String>, title: impl Into<String>) -> Self {
        Self {
            id: id.into(),
            title: title.into(),
            caption: String::new(),
            x: Axis::default(),
            y: Axis::default(),
            equal: false,
            series: Vec::new(),
        }
    }

    /// With the labels of both axes: quantity and unit.
    pub fn axes(mut self, x: impl Into<String>, y: impl Into<String>) -> Self {
        (self.x.label, self.y.label) = (x.into(), y.into());
        self
    }

    /// Over seconds of a clock that the figures of a page have in common; with the label of the vertical axis.
    pub fn over_seconds(self, y: impl Into<String>) -> Self {
        self.axes("time, s", y).clock(1.0)
    }

    /// As [`over_seconds`](Self::over_seconds), in hours.
    pub fn over_hours(self, y: impl Into<String>) -> Self {
        self.axes("time, h", y).clock(3600.0)
    }

    /// The horizontal axis is a time; one unit of it is so many seconds.
    pub fn clock(mut self, seconds: f64) -> Self {
        self.x.seconds = Some(seconds);
        self
    }

    /// With a logarithmic vertical axis.
    pub fn logarithmic(mut self) -> Self {
        self.y.logarithmic = true;
        self
    }

    /// Showing these stretches of the axes at first.
    pub fn showing(mut self, x: Option<[f64; 2]>, y: Option<[f64; 2]>) -> Self {
        (self.x.range, self.y.range) = (x, y);
        self
    }

    /// A map: a metre is as long along either axis.
    pub fn map(mut self) -> Self {
        self.equal = true;
        self
    }

    /// With a sentence on what to see.
    pub fn caption(mut self, caption: impl Into<String>) -> Self {
        self.caption = caption.into();
        self
    }

    /// With another series.
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// With more series.
    pub fn with_all(mut self, series: impl IntoIterator<Item = Series>) -> Self {
        self.series.extend(series);
        self
    }
}
