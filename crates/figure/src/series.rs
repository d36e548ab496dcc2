use crate::ellipse;

/// Points with a name, and how they are marked.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// What the legend calls it.
    pub name: String,
    /// Abscissae; `NaN` interrupts a line.
    pub x: Vec<f64>,
    /// Ordinates, as many.
    pub y: Vec<f64>,
    /// When each point was, in seconds of the clock of [`Figure::over_seconds`](crate::Figure::over_seconds): of a map, whose
    /// axes are no times.
    pub times: Option<Vec<f64>>,
    /// How uncertain each point of a map is, where that is known: the variance along x, the covariance and the variance along y, in
    /// the axes' unit squared. The page draws the ellipse of the point at the cursor.
    pub spread: Option<Vec<[f64; 3]>>,
    /// Half the length of the error bars, where there are any.
    pub error: Option<Vec<f64>>,
    /// What stands beside the points, where anything does.
    pub labels: Option<Vec<String>>,
    /// How it is drawn.
    pub mark: Mark,
    /// In which colour.
    pub colour: Colour,
    /// Whether only the legend shows it at first.
    pub hidden: bool,
    /// Whether it stands back behind the others.
    pub faint: bool,
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A line through the points.
    Line,
    /// A broken line: what was published, what is a threshold.
    Dashes,
    /// A line which keeps its value until the next point.
    Steps,
    /// Points, and a line through them.
    LineAndPoints,
    /// Points alone.
    Points,
    /// Small points, of which there are many.
    Dots,
    /// Crosses: what is rejected.
    Crosses,
}

/// What a colour stands for, the same in every figure; each is legible on white and on black.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    /// What this library makes of it.
    Ours,
    /// What the paper prints, or its method.
    Published,
    /// What nothing can be better than.
    Limit,
    /// What was true, walls, anchors.
    Truth,
    /// What is refused, or wrong.
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
    /// Points that are marked in some way; where one list is longer, its rest is dropped.
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

    /// Drawn in another way.
    pub fn marked(self, mark: Mark) -> Self {
        Self { mark, ..self }
    }

    /// In this colour.
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

    /// Shown by the legend alone at first.
    pub fn hidden(self) -> Self {
        Self { hidden: true, ..self }
    }

    /// The [`ellipse`] of each point, where covariances are known.
    pub(crate) fn ellipses(&self) -> Option<Vec<[f64; 3]>> {
        Some(self.spread.as_ref()?.iter().map(|&spread| ellipse(spread)).collect())
    }

    /// Points and their error bars and labels; a bar or text that is missing is none.
    pub(crate) fn len(&self) -> usize {
        self.x.len().min(self.y.len())
    }
}
