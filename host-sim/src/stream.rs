//! Named columns over time: what a run measured, estimated and knows to be true.

/// A table over time, such as the samples of a sensor or a track.
#[derive(Debug, Clone, PartialEq)]
pub struct Stream {
    /// What it is, as a path: `/system/truth`.
    pub topic: String,
    /// What stands in the columns, each with its unit: `x_m`, `gx_rad_s`.
    ///
    /// Columns `x_m`, `y_m` and perhaps `z_m` are a place, which viewers draw.
    pub columns: Vec<String>,
    /// Time in seconds, and a value a column; `NaN` is none.
    pub rows: Vec<(f64, Vec<f64>)>,
}

impl Stream {
    /// A stream of `rows`, each as long as there are `columns`.
    pub fn new(topic: impl Into<String>, columns: &[&str], rows: Vec<(f64, Vec<f64>)>) -> Self {
        let columns = columns.iter().map(|&name| name.to_owned()).collect();
        Self { topic: topic.into(), columns, rows }
    }
}
