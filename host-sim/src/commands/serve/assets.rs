//! The page's own files, which are embedded in the program.

use axum::Router;
use axum::http::header::CONTENT_TYPE;
use axum::response::IntoResponse;
use axum::routing::get;

const FILES: [(&str, &str, &str); 12] = [
    ("/", "text/html; charset=utf-8", include_str!("../../../assets/explorer.html")),
    ("/page.css", "text/css; charset=utf-8", include_str!("../../../assets/page.css")),
    ("/elements.js", "text/javascript; charset=utf-8", include_str!("../../../assets/elements.js")),
    ("/clock.js", "text/javascript; charset=utf-8", include_str!("../../../assets/clock.js")),
    ("/controls.js", "text/javascript; charset=utf-8", include_str!("../../../assets/controls.js")),
    ("/drop.js", "text/javascript; charset=utf-8", include_str!("../../../assets/drop.js")),
    ("/figures.js", "text/javascript; charset=utf-8", include_str!("../../../assets/figures.js")),
    ("/answer.js", "text/javascript; charset=utf-8", include_str!("../../../assets/answer.js")),
    ("/session.js", "text/javascript; charset=utf-8", include_str!("../../../assets/session.js")),
    ("/live.js", "text/javascript; charset=utf-8", include_str!("../../../assets/live.js")),
    ("/explorer.js", "text/javascript; charset=utf-8", include_str!("../../../assets/explorer.js")),
    (
        "/plotly.js",
        "text/javascript; charset=utf-8",
        include_str!("../../../assets/plotly/plotly-basic.min.js"),
    ),
];

pub(super) fn router() -> Router {
    FILES.into_iter().fold(Router::new(), |router, (path, kind, text)| {
        router
            .route(path, get(move || async move { ([(CONTENT_TYPE, kind)], text).into_response() }))
    })
}
