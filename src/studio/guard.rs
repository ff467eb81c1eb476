//! The check of every request before it is routed.
//!
//! A page of another site can make a browser send requests here, and by a name that is bound to 127.0.0.1 (rebinding) even
//! read the answers. So: the `Host` must be one of two names with this port, an `Origin` one of two, `Sec-Fetch-Site` this
//! site or nobody (but for a window that goes to `/`), and all of `/api` needs the token, which is in the address that the command
//! prints and in a file that only this user reads ([`super::redirect`]). The
//! token is a header, which no form and no picture can send. Bodies are JSON, and limited in size and time.

use std::time::Duration;

use axum::body::{Body, to_bytes};
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use tokio::time::timeout;

/// Header of the token.
pub const TOKEN: &str = "x-edifice-token";
/// The content security policy of a page: it loads only what this server serves, and has no script in the page itself.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; \
     connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The limits of requests, in bytes and in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Longest time from one request of a connection to the whole head of the next: whoever sends a byte now and then, or nothing,
    /// is not waited for.
    pub head: Duration,
    /// Most bytes of a body.
    pub body: usize,
    /// Longest time that a body may take to come.
    pub sending: Duration,
    /// Longest time that an answer may take to be made; work that takes longer is a job.
    pub answering: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            head: Duration::from_secs(20),
            body: 2 << 20,
            sending: Duration::from_secs(10),
            answering: Duration::from_secs(120),
        }
    }
}

/// The rules by which requests are let in.
#[derive(Debug, Clone)]
pub struct Guard {
    hosts: [String; 2],
    token: String,
    limits: Limits,
}

impl Guard {
    /// For a server on a port of this machine.
    pub fn new(port: u16, token: String, limits: Limits) -> Self {
        Self {
            hosts: ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}")),
            token,
            limits,
        }
    }

    /// Why a request is not let in.
    ///
    /// # Errors
    /// Status and reason.
    fn check(&self, request: &Request) -> Result<(), (StatusCode, &'static str)> {
        let refuse = |why| Err((StatusCode::FORBIDDEN, why));
        let headers = request.headers();
        let known = |host: &str| self.hosts.iter().any(|h| h == host);
        match only(headers, header::HOST.as_str()) {
            Ok(Some(host)) if known(host) => {}
            _ => return refuse("foreign host"),
        }
        if request
            .uri()
            .authority()
            .is_some_and(|a| !known(a.as_str()))
        {
            return refuse("foreign host");
        }
        match only(headers, header::ORIGIN.as_str()) {
            Ok(None) => {}
            Ok(Some(origin)) if origin.strip_prefix("http://").is_some_and(known) => {}
            _ => return refuse("foreign origin"),
        }
        match only(headers, "sec-fetch-site") {
            Ok(None | Some("same-origin" | "none")) => {}
            // The file that leads the browser here. The page in a window of its own tells nothing, without the token it can do
            // nothing, and no other page may hold it in a frame.
            Ok(Some("cross-site")) if is_visit(request) => {}
            _ => return refuse("foreign site"),
        }
        if !matches!(*request.method(), Method::GET | Method::POST) {
            return Err((StatusCode::METHOD_NOT_ALLOWED, "GET or POST"));
        }
        if request.uri().path().starts_with("/api") {
            let given = only(headers, TOKEN).ok().flatten().unwrap_or_default();
            if !same(given.as_bytes(), self.token.as_bytes()) {
                return Err((StatusCode::UNAUTHORIZED, "no token"));
            }
        }
        if request.method() == Method::POST {
            match only(headers, header::CONTENT_TYPE.as_str()) {
                Ok(Some("application/json" | "application/json; charset=utf-8")) => {}
                _ => return Err((StatusCode::UNSUPPORTED_MEDIA_TYPE, "application/json only")),
            }
        }
        Ok(())
    }
}

/// True for a window that goes to the page itself.
fn is_visit(request: &Request) -> bool {
    let says = |name, value| only(request.headers(), name) == Ok(Some(value));
    *request.method() == Method::GET
        && request.uri().path() == "/"
        && says("sec-fetch-mode", "navigate")
        && says("sec-fetch-dest", "document")
}

/// The value of a header that stands at most once.
fn only<'h>(headers: &'h HeaderMap, name: &str) -> Result<Option<&'h str>, ()> {
    let mut values = headers.get_all(name).iter();
    match (values.next(), values.next()) {
        (None, _) => Ok(None),
        (Some(value), None) => value.to_str().map(Some).map_err(|_| ()),
        (Some(_), Some(_)) => Err(()),
    }
}

/// True if two texts are the same, in a time that does not tell where they differ.
fn same(a: &[u8], b: &[u8]) -> bool {
    let differ = a.iter().zip(b).fold(0, |d, (x, y)| d | (x ^ y));
    a.len() == b.len() && differ == 0
}

/// Lets a request in, or not.
pub async fn guard(State(guard): State<Guard>, request: Request, next: Next) -> Response {
    let mut response = match guard.check(&request) {
        Ok(()) => pass(request, next, guard.limits).await,
        Err(refused) => refused.into_response(),
    };
    let headers = response.headers_mut();
    for (name, value) in [
        ("content-security-policy", POLICY),
        ("x-content-type-options", "nosniff"),
        ("referrer-policy", "no-referrer"),
        ("cross-origin-resource-policy", "same-origin"),
        ("cross-origin-opener-policy", "same-origin"),
        ("cache-control", "no-store"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}

/// Reads the body whole, within its limits, and has the request answered in time.
async fn pass(request: Request, next: Next, limits: Limits) -> Response {
    let (parts, body) = request.into_parts();
    let bytes = match timeout(limits.sending, to_bytes(body, limits.body)).await {
        Ok(Ok(bytes)) => bytes,
        Ok(Err(_)) => return StatusCode::PAYLOAD_TOO_LARGE.into_response(),
        Err(_) => return StatusCode::REQUEST_TIMEOUT.into_response(),
    };
    let request = Request::from_parts(parts, Body::from(bytes));
    match timeout(limits.answering, next.run(request)).await {
        Ok(response) => response,
        Err(_) => StatusCode::GATEWAY_TIMEOUT.into_response(),
    }
}
