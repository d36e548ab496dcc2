//! Named columns over time: what a run measured and estimated, and the truth.

/// A table over time, such as the samples of a sensor or a track.
#[derive(Debug, Clone, PartialEq)]
pub struct Stream {
    /// The topic of the stream, a path such as `/system/truth`.
    pub topic: String,
    /// The names of the columns, each with its unit: `x_m`, `gx_rad_s`.
    ///
    /// The columns `x_m`, `y_m` and optionally `z_m` are a position, which viewers draw.
    pub columns: Vec<String>,
    /// The time in seconds and a value per column, for each row; `NaN` marks a missing value.
    pub rows: Vec<(f64, Vec<f64>)>,
}

impl Stream {
    /// A stream of `rows`, each with one value per column.
    pub fn new(topic: impl Into<String>, columns: &[&str], rows: Vec<(f64, Vec<f64>)>) -> Self {
        let columns = columns.iter().map(|&name| name.to_owned()).collect();
        Self { topic: topic.into(), columns, rows }
    }
}
