//! What a filter believes.

use kestirim_replay::drone::Cloud;

use crate::figure::{Colour, Figure, Mark, Series};

/// Draws the light, the heavy, and where nine of ten were if it were normally distributed.
pub(in crate::systems::drone) fn on(figure: Figure, cloud: &Cloud) -> Figure {
    let dots = |name: &str, places: &[[f32; 2]], colour| {
        let places = places.iter().map(|place| place.map(f64::from));
        Series::points(name, places).marked(Mark::Dots).coloured(colour)
    };
    figure
        .with(dots("particles with the last tenth of the weight", &cloud.light, Colour::Truth))
        .with(dots("particles", &cloud.heavy, Colour::Other(4)))
        .with(Series::path("90 % ellipse", cloud.ellipse()).coloured(Colour::Ours))
}
