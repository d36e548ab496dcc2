//! Who may ask: this machine's own page, opened by whoever was told the key.

use std::net::SocketAddr;

use axum::extract::{Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, COOKIE, HOST, LOCATION, ORIGIN, REFERRER_POLICY,
    SET_COOKIE, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderName, HeaderValue, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use super::key::Key;

/// The page fetches from where it came from, and from nowhere else. Plotly styles its elements in place.
const POLICY: HeaderValue = HeaderValue::from_static(
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; img-src data: blob:; \
     base-uri 'none'; form-action 'self'; frame-ancestors 'none'",
);
/// Before the key, in the address that is printed.
const QUERY: &str = "token=";

/// What is to be known of a page to tell whether somebody may ask.
#[derive(Debug, Clone)]
pub(super) struct Guard {
    pub(super) address: SocketAddr,
    pub(super) key: Key,
}

impl Guard {
    /// The page's address with the key. Whoever opens it is given the key as a cookie, and sent on to an address that does
    /// not hold it: that one may be shown to others.
    pub(super) fn address(&self) -> String {
        format!("http://{}/?{QUERY}{}", self.address, self.key)
    }

    /// The cookie's name. Browsers do not tell the ports of a machine apart.
    fn cookie(&self) -> String {
        format!("kestirim-{}", self.address.port())
    }

    fn has_cookie(&self, request: &Request) -> bool {
        let name = self.cookie();
        let headers = request.headers().get_all(COOKIE).into_iter();
        headers
            .filter_map(|value| value.to_str().ok())
            .flat_map(|cookies| cookies.split(';'))
            .filter_map(|cookie| cookie.trim().split_once('='))
            .any(|(known, value)| known == name && self.key.is(value))
    }

    /// Whether this is the printed address.
    fn is_handed_over(&self, request: &Request) -> bool {
        let query = request.uri().query().and_then(|query| query.strip_prefix(QUERY));
        request.uri().path() == "/" && query.is_some_and(|text| self.key.is(text))
    }

    fn hand_over(&self) -> Response {
        let cookie = format!("{}={}; HttpOnly; SameSite=Lax; Path=/", self.cookie(), self.key);
        let headers = [
            (LOCATION, "/"),
            (SET_COOKIE, cookie.as_str()),
            (CACHE_CONTROL, "no-store"),
            (REFERRER_POLICY, "no-referrer"),
        ];
        (StatusCode::SEE_OTHER, headers).into_response()
    }

    /// Whether a header names this server, or is not there.
    fn is_ours(&self, request: &Request, header: HeaderName) -> bool {
        let address = self.address;
        let Some(value) = request.headers().get(header) else { return true };
        let name = value.to_str().unwrap_or_default().trim_start_matches("http://");
        // On port 80 browsers leave it out.
        let bare = address.port() == 80
            && [address.ip().to_string().as_str(), "localhost"].contains(&name);
        bare || name == address.to_string() || name == format!("localhost:{}", address.port())
    }
}

/// Refuses what a foreign page sends, by a name that leads here (the host) or to here (the origin), and whoever does not
/// have the key: another user of this machine.
pub(super) async fn only_with_key(
    State(guard): State<Guard>,
    request: Request,
    next: Next,
) -> Response {
    if !(guard.is_ours(&request, HOST) && guard.is_ours(&request, ORIGIN)) {
        return (StatusCode::FORBIDDEN, "only this machine's own page may ask").into_response();
    }
    if guard.is_handed_over(&request) {
        return guard.hand_over();
    }
    if !guard.has_cookie(&request) {
        let sentence = "open the address that host-sim printed: it holds the key to this page";
        return (StatusCode::FORBIDDEN, sentence).into_response();
    }
    let mut response = next.run(request).await;
    let headers = response.headers_mut();
    headers.insert(CONTENT_SECURITY_POLICY, POLICY);
    headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    response
}
