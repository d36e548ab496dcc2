//! Access control: only this machine's own page, opened by a user who has the key.

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

/// The content security policy: the page fetches only from its own server. Plotly sets inline styles.
const POLICY: HeaderValue = HeaderValue::from_static(
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; img-src data: blob:; \
     base-uri 'none'; form-action 'self'; frame-ancestors 'none'",
);
/// The query parameter for the key in the address that is printed.
const QUERY: &str = "token=";

/// The data needed to decide whether a request is allowed.
#[derive(Debug, Clone)]
pub(super) struct Guard {
    pub(super) address: SocketAddr,
    pub(super) key: Key,
}

impl Guard {
    /// The page's address with the key. Opening it sets the key as a cookie and redirects to an address without the
    /// key, which may be shown to others.
    pub(super) fn address(&self) -> String {
        format!("http://{}/?{QUERY}{}", self.address, self.key)
    }

    /// The cookie's name, which contains the port as browsers do not separate cookies by port.
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

    /// Whether the request is for the printed address with the right key.
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

    /// Whether a header names this server or is absent.
    fn is_ours(&self, request: &Request, header: HeaderName) -> bool {
        let address = self.address;
        let Some(value) = request.headers().get(header) else { return true };
        let name = value.to_str().unwrap_or_default().trim_start_matches("http://");
        // Browsers omit port 80.
        let bare = address.port() == 80
            && [address.ip().to_string().as_str(), "localhost"].contains(&name);
        bare || name == address.to_string() || name == format!("localhost:{}", address.port())
    }
}

/// Refuses requests from foreign pages, detected by the host name or the origin, and from other users of this machine,
/// who do not have the key.
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
