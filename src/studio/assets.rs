//! The page: built from `studio/` by npm, part of the program.

use axum::http::{Method, StatusCode, Uri, header};
use axum::response::{IntoResponse, Response};

/// Address, type and bytes of every file.
const FILES: &[(&str, &str, &[u8])] = &[
    (
        "/",
        "text/html; charset=utf-8",
        include_bytes!("assets/index.html"),
    ),
    (
        "/app.js",
        "text/javascript; charset=utf-8",
        include_bytes!("assets/app.js"),
    ),
    (
        "/app.css",
        "text/css; charset=utf-8",
        include_bytes!("assets/app.css"),
    ),
    (
        "/icon.svg",
        "image/svg+xml",
        include_bytes!("assets/icon.svg"),
    ),
    (
        "/licences.txt",
        "text/plain; charset=utf-8",
        include_bytes!("assets/licences.txt"),
    ),
];

/// A file of the page.
pub(crate) async fn asset(method: Method, uri: Uri) -> Response {
    let found = FILES.iter().find(|(path, _, _)| *path == uri.path());
    match (found, method) {
        (Some((_, kind, bytes)), Method::GET) => {
            ([(header::CONTENT_TYPE, *kind)], *bytes).into_response()
        }
        _ => StatusCode::NOT_FOUND.into_response(),
    }
}
