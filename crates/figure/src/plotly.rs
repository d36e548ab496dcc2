//! Figures in the format of Plotly: <https://plotly.com/javascript/reference/>.

use serde_json::{Value, json};

use crate::{Axis, Colour, Figure, Mark, Series, View, extent, thin};

/// The figure for the page: its texts, and `data` and `layout` for `Plotly.react`.
///
/// Colours of paper, text and grid are left to the page, which knows whether it is dark.
pub fn figure(figure: &Figure, view: View) -> Value {
    // For a logarithmic axis, the page gives exponents.
    let exponents = figure.x.logarithmic && !figure.equal;
    let window =
        view.window.map(|ends| if exponents { ends.map(|e| 10_f64.powf(e)) } else { ends });
    let kept = thin::of(figure, View { window, ..view });
    let data: Vec<_> = figure.series.iter().zip(kept).map(|(it, kept)| trace(it, &kept)).collect();
    let mut y = axis(&figure.y);
    if figure.equal {
        y["scaleanchor"] = json!("x");
    }
    json!({
        "id": figure.id,
        "title": figure.title,
        "caption": figure.caption,
        "equal": figure.equal,
        "seconds": figure.x.seconds,
        "data": data,
        "layout": { "xaxis": axis(&figure.x), "yaxis": y },
    })
}

fn axis(axis: &Axis) -> Value {
    let mut value = json!({ "title": { "text": axis.label } });
    if axis.logarithmic {
        value["type"] = json!("log");
    }
    if let Some(range) = axis.range {
        let shown = range.map(|end| if axis.logarithmic { end.log10() } else { end });
        value["range"] = json!(shown);
    }
    value
}

fn trace(series: &Series, kept: &[usize]) -> Value {
    let pick = |values: &[f64]| -> Vec<f64> {
        rounded(kept.iter().map(|&i| values.get(i).copied().unwrap_or(f64::NAN)).collect())
    };
    let colour = css(series.colour);
    let labelled = series.labels.is_some();
    let mut trace = json!({
        "type": "scatter",
        "name": series.name,
        "x": pick(&series.x),
        "y": pick(&series.y),
        "mode": mode(series.mark, labelled),
        "line": { "color": colour, "width": if series.mark == Mark::Dashes { 1.5 } else { 1.8 } },
        "marker": { "color": colour, "size": size(series.mark) },
    });
    match series.mark {
        Mark::Dashes => trace["line"]["dash"] = json!("dash"),
        Mark::Steps => trace["line"]["shape"] = json!("hv"),
        Mark::Crosses => trace["marker"]["symbol"] = json!("x"),
        Mark::Dots => trace["marker"]["opacity"] = json!(0.55),
        Mark::Line | Mark::LineAndPoints | Mark::Points => {}
    }
    if let Some(error) = &series.error {
        trace["error_y"] = json!({ "type": "data", "array": pick(error), "thickness": 1 });
    }
    if let Some(labels) = &series.labels {
        let texts: Vec<_> =
            kept.iter().map(|&i| labels.get(i).map_or("", String::as_str)).collect();
        trace["text"] = json!(texts);
        trace["textposition"] = json!("top center");
    }
    if let Some(times) = &series.times {
        trace["customdata"] = json!(pick(times));
    }
    if let Some(ellipses) = series.ellipses() {
        let part = |place: usize| ellipses.iter().map(|ellipse| ellipse[place]).collect::<Vec<_>>();
        let parts = [0, 1, 2].map(|place| pick(&part(place)));
        trace["meta"] = json!({ "ellipses": parts });
    }
    if series.faint {
        trace["opacity"] = json!(0.45);
    }
    if series.hidden {
        trace["visible"] = json!("legendonly");
    }
    trace
}

fn mode(mark: Mark, labelled: bool) -> &'static str {
    match (mark, labelled) {
        (Mark::Line | Mark::Dashes | Mark::Steps, false) => "lines",
        (Mark::Line | Mark::Dashes | Mark::Steps, true) => "lines+text",
        (Mark::LineAndPoints, false) => "lines+markers",
        (Mark::LineAndPoints, true) => "lines+markers+text",
        (Mark::Points | Mark::Dots | Mark::Crosses, false) => "markers",
        (Mark::Points | Mark::Dots | Mark::Crosses, true) => "markers+text",
    }
}

fn size(mark: Mark) -> u32 {
    match mark {
        Mark::Dots => 3,
        Mark::LineAndPoints => 5,
        _ => 7,
    }
}

fn css(colour: Colour) -> String {
    let [r, g, b] = colour.rgb();
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Rounds to a millionth of the values' span: more digits are neither visible nor worth sending.
fn rounded(mut values: Vec<f64>) -> Vec<f64> {
    let span = extent(values.iter().copied()).map_or(0.0, |[low, high]| high - low);
    if span.is_finite() && span > 0.0 {
        // Dividing by a power of ten gives the shortest decimals.
        let scale = 10_f64.powi((6.0 - span.log10()).ceil() as i32);
        for value in &mut values {
            let scaled = (*value * scale).round() / scale;
            if scaled.is_finite() {
                *value = scaled;
            }
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIEW: View = View { most_points: 1000, window: None };

    #[test]
    fn lines_points_and_gaps_come_through() {
        let ours = Series::line("ours", vec![0.0, 1.0, 2.0], vec![1.0, f64::NAN, 0.5]);
        let marks = Series::points("anchors", [[0.0, 1.0]])
            .labelled(vec!["A1".to_owned()])
            .coloured(Colour::Truth)
            .hidden();
        let drawn =
            figure(&Figure::new("f", "F").axes("x, m", "y, m").map().with(ours).with(marks), VIEW);
        assert_eq!(drawn["data"][0]["y"], json!([1.0, null, 0.5]));
        assert_eq!(drawn["data"][1]["text"], json!(["A1"]));
        assert_eq!(drawn["data"][1]["visible"], "legendonly");
        assert_eq!(drawn["layout"]["yaxis"]["scaleanchor"], "x");
    }

    #[test]
    fn ellipses_come_through_thinned_as_their_points_are() {
        let points = (0..3000).map(|i| [f64::from(i), f64::from(i / 1000)]);
        let spread = |i: u32| match i {
            0 => [f64::NAN; 3],
            _ => [4.0, 1.2, 1.0].map(|part| part * f64::from(1 + i / 1000).powi(2)),
        };
        let path = Series::path("ours", points).timed((0..3000).map(f64::from));
        let path = path.uncertain((0..3000).map(spread));
        let drawn = figure(&Figure::new("f", "F").map().with(path), VIEW);
        let list = |value: &Value| value.as_array().unwrap().clone();
        let times = list(&drawn["data"][0]["customdata"]);
        let parts = list(&drawn["data"][0]["meta"]["ellipses"]);
        assert!(times.len() < 20 && parts.len() == 3, "{times:?}");
        for (place, part) in parts.iter().enumerate() {
            let part = list(part);
            assert_eq!((part.len(), &part[0]), (times.len(), &Value::Null));
            for (time, value) in times.iter().zip(part).skip(1) {
                let times_longer = f64::from(1 + time.as_f64().unwrap() as u32 / 1000);
                let expected = 5.991_f64.sqrt() * [2.0, 0.6, 0.8][place] * times_longer;
                let value = value.as_f64().unwrap();
                assert!((value - expected).abs() < 1e-5, "{value} after {time} s");
            }
        }
    }

    #[test]
    fn the_window_of_a_logarithmic_axis_is_in_exponents() {
        let x: Vec<f64> = (0..100).map(|i| 10_f64.powf(0.1 * f64::from(i) - 5.0)).collect();
        let mut drawn = Figure::new("f", "F").with(Series::line("ours", x.clone(), x));
        drawn.x.logarithmic = true;
        let data = figure(&drawn, View { most_points: 1000, window: Some([-2.0, -1.0]) });
        let shown = data["data"][0]["x"].as_array().unwrap();
        let within = shown.iter().filter_map(Value::as_f64).filter(|x| (0.0099..0.101).contains(x));
        // On the right, half of the window's width more, and the point after it.
        let last = shown.last().and_then(Value::as_f64).unwrap();
        assert!(within.count() == 11 && (0.1..0.2).contains(&last), "{shown:?}");
    }

    #[test]
    fn numbers_are_as_short_as_the_eye_is() {
        assert_eq!(rounded(vec![0.0, 0.123_456_789, 1.0]), [0.0, 0.123_457, 1.0]);
        assert_eq!(rounded(vec![5.0, 5.0]), [5.0, 5.0]);
        assert_eq!(rounded(vec![1e6, 1e6 + 1e-3]), [1e6, 1e6 + 1e-3]);
    }
}
