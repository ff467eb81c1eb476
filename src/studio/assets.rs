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
    (
        "/examples/boulevard.png",
        "image/png",
        include_bytes!("assets/examples/boulevard.png"),
    ),
    (
        "/examples/fig9.png",
        "image/png",
        include_bytes!("assets/examples/fig9.png"),
    ),
    (
        "/examples/four.png",
        "image/png",
        include_bytes!("assets/examples/four.png"),
    ),
    (
        "/examples/house.png",
        "image/png",
        include_bytes!("assets/examples/house.png"),
    ),
    (
        "/examples/modern.png",
        "image/png",
        include_bytes!("assets/examples/modern.png"),
    ),
    (
        "/examples/sketch.png",
        "image/png",
        include_bytes!("assets/examples/sketch.png"),
    ),
    (
        "/examples/town.png",
        "image/png",
        include_bytes!("assets/examples/town.png"),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_example_has_a_picture() {
        for example in edifice_editing::examples::examples() {
            let path = format!("/examples/{}.png", example.id);
            assert!(FILES.iter().any(|f| f.0 == path), "{path}");
        }
    }
}
