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
    /// The name of its files and of its place on the page: lower case, with hyphens.
    pub id: String,
    /// The title: what the figure shows, in a few words.
    pub title: String,
    /// The caption: what to see in the figure.
    pub caption: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Whether both axes have the same scale, as on a map.
    pub equal: bool,
    /// The series in drawing order: the first lies below the others.
    pub series: Vec<Series>,
}

/// An axis of a figure.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// The label: quantity and unit.
    pub label: String,
    /// Whether the axis is logarithmic.
    pub logarithmic: bool,
    /// The range that is shown at first [default: everything].
    pub range: Option<[f64; 2]>,
    /// The number of seconds in one unit, if the axis is a time.
    pub seconds: Option<f64>,
}

/// The least and the greatest of the finite numbers; `None` if there are none.
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

    /// Makes the horizontal axis a time in seconds, on a clock that the figures of a page share, and labels the
    /// vertical axis.
    pub fn over_seconds(self, y: impl Into<String>) -> Self {
        self.axes("time, s", y).clock(1.0)
    }

    /// Like [`over_seconds`](Self::over_seconds), but in hours.
    pub fn over_hours(self, y: impl Into<String>) -> Self {
        self.axes("time, h", y).clock(3600.0)
    }

    /// Makes the horizontal axis a time, of which one unit is `seconds` long.
    pub fn clock(mut self, seconds: f64) -> Self {
        self.x.seconds = Some(seconds);
        self
    }

    /// With a logarithmic vertical axis.
    pub fn logarithmic(mut self) -> Self {
        self.y.logarithmic = true;
        self
    }

    /// Sets the ranges of the axes that are shown at first.
    pub fn showing(mut self, x: Option<[f64; 2]>, y: Option<[f64; 2]>) -> Self {
        (self.x.range, self.y.range) = (x, y);
        self
    }

    /// Makes the figure a map: both axes have the same scale.
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
