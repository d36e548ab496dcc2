use crate::ellipse;

/// A named series of points, and how it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// The name in the legend.
    pub name: String,
    /// Abscissae; `NaN` interrupts a line.
    pub x: Vec<f64>,
    /// Ordinates, as many as abscissae.
    pub y: Vec<f64>,
    /// The time of each point of a map, whose axes are no times: in seconds of the clock of
    /// [`Figure::over_seconds`](crate::Figure::over_seconds).
    pub times: Option<Vec<f64>>,
    /// The covariance of each point of a map, if known: the variance along x, the covariance and the variance along y,
    /// in the axes' unit squared. The page draws the ellipse of the point at the cursor.
    pub spread: Option<Vec<[f64; 3]>>,
    /// Half the length of the error bars, if there are any.
    pub error: Option<Vec<f64>>,
    /// Texts beside the points, if there are any.
    pub labels: Option<Vec<String>>,
    /// The mark with which the series is drawn.
    pub mark: Mark,
    /// The colour of the series.
    pub colour: Colour,
    /// Whether the series is at first shown in the legend only.
    pub hidden: bool,
    /// Whether the series is drawn faintly, behind the others.
    pub faint: bool,
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A line through the points.
    Line,
    /// A dashed line: a published result or a threshold.
    Dashes,
    /// A line that keeps its value until the next point.
    Steps,
    /// Points, and a line through them.
    LineAndPoints,
    /// Points alone.
    Points,
    /// Small points, for series with many of them.
    Dots,
    /// Crosses, for rejected values.
    Crosses,
}

/// The meaning of a colour, the same in every figure; each colour is legible on white and on black.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    /// A result of this library.
    Ours,
    /// A result that a paper prints, or that of its method.
    Published,
    /// A bound that nothing can be better than.
    Limit,
    /// The ground truth, walls, anchors.
    Truth,
    /// Values that are rejected or wrong.
    Alarm,
    /// Any other series; counted from 0.
    Other(usize),
}

impl Colour {
    /// Red, green and blue.
    pub const fn rgb(self) -> [u8; 3] {
        const OTHERS: [[u8; 3]; 7] = [
            [0x2f, 0x86, 0xe0],
            [0xe0, 0x7b, 0x24],
            [0x2f, 0xa0, 0x60],
            [0x9a, 0x66, 0xd6],
            [0x1f, 0xa3, 0xa8],
            [0xc9, 0x58, 0x9b],
            [0xa0, 0x82, 0x2c],
        ];
        match self {
            Self::Ours => OTHERS[0],
            Self::Published => OTHERS[1],
            Self::Limit => OTHERS[2],
            Self::Truth => [0x8a, 0x8f, 0x98],
            Self::Alarm => [0xdd, 0x45, 0x4a],
            Self::Other(index) => OTHERS[index % OTHERS.len()],
        }
    }
}

impl Series {
    /// A series drawn with the given mark; if one list is longer than the other, its excess is dropped.
    pub fn new(name: impl Into<String>, mark: Mark, mut x: Vec<f64>, mut y: Vec<f64>) -> Self {
        let length = x.len().min(y.len());
        x.truncate(length);
        y.truncate(length);
        Self {
            name: name.into(),
            x,
            y,
            times: None,
            spread: None,
            error: None,
            labels: None,
            mark,
            colour: Colour::Ours,
            hidden: false,
            faint: false,
        }
    }

    /// A line.
    pub fn line(name: impl Into<String>, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self::new(name, Mark::Line, x, y)
    }

    /// A line through points of the plane.
    pub fn path(name: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let (x, y) = points.into_iter().map(|[x, y]| (x, y)).unzip();
        Self::line(name, x, y)
    }

    /// Points of the plane.
    pub fn points(name: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        Self { mark: Mark::Points, ..Self::path(name, points) }
    }

    /// With another mark.
    pub fn marked(self, mark: Mark) -> Self {
        Self { mark, ..self }
    }

    /// With another colour.
    pub fn coloured(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }

    /// With the time of each point, s.
    pub fn timed(self, times: impl IntoIterator<Item = f64>) -> Self {
        Self { times: Some(times.into_iter().collect()), ..self }
    }

    /// With the covariance of each point: variance along x, covariance, variance along y; `NaN` where none is known.
    pub fn uncertain(self, spread: impl IntoIterator<Item = [f64; 3]>) -> Self {
        Self { spread: Some(spread.into_iter().collect()), ..self }
    }

    /// With error bars of this half length.
    pub fn with_error(self, error: Vec<f64>) -> Self {
        Self { error: Some(error), ..self }
    }

    /// With a text at each point.
    pub fn labelled(self, labels: Vec<String>) -> Self {
        Self { labels: Some(labels), ..self }
    }

    /// At first shown in the legend only.
    pub fn hidden(self) -> Self {
        Self { hidden: true, ..self }
    }

    /// The [`ellipse`] of each point, where covariances are known.
    pub(crate) fn ellipses(&self) -> Option<Vec<[f64; 3]>> {
        Some(self.spread.as_ref()?.iter().map(|&spread| ellipse(spread)).collect())
    }

    /// The number of points. A missing error bar or label of a point is not drawn.
    pub(crate) fn len(&self) -> usize {
        self.x.len().min(self.y.len())
    }
}
