//! Who may ask: this machine's own page and nobody else.

use std::net::SocketAddr;

use axum::extract::{Request, State};
use axum::http::header::{CONTENT_SECURITY_POLICY, HOST, ORIGIN, X_CONTENT_TYPE_OPTIONS};
use axum::http::{HeaderName, HeaderValue, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

/// The page fetches from where it came from, and from nowhere else. Plotly styles its elements in place.
const POLICY: HeaderValue = HeaderValue::from_static(
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; img-src data: blob:; \
     base-uri 'none'; form-action 'self'; frame-ancestors 'none'",
);

/// Refuses what a foreign page sends: by a name that leads here (the host), or to here (the origin).
pub(super) async fn only_this_machine(
    State(address): State<SocketAddr>,
    request: Request,
    next: Next,
) -> Response {
    if !(is_ours(&request, HOST, address) && is_ours(&request, ORIGIN, address)) {
        return (StatusCode::FORBIDDEN, "only this machine's own page may ask").into_response();
    }
    let mut response = next.run(request).await;
    let headers = response.headers_mut();
    headers.insert(CONTENT_SECURITY_POLICY, POLICY);
    headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    response
}

/// Whether a header names this server, or is not there.
fn is_ours(request: &Request, header: HeaderName, address: SocketAddr) -> bool {
    let Some(value) = request.headers().get(header) else { return true };
    let name = value.to_str().unwrap_or_default().trim_start_matches("http://");
    // On port 80 browsers leave it out.
    let bare =
        address.port() == 80 && [address.ip().to_string().as_str(), "localhost"].contains(&name);
    bare || name == address.to_string() || name == format!("localhost:{}", address.port())
}
