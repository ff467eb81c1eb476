//! Long answers, compressed for who can read them.

use std::io::Write;

use axum::body::{Body, to_bytes};
use axum::extract::Request;
use axum::http::{HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use flate2::Compression;
use flate2::write::GzEncoder;

/// Answers shorter than this are sent as they are, in bytes.
const SHORT: usize = 8 << 10;

/// Compresses the answer to a request that accepts gzip, if the answer is long JSON or text of the page.
pub(crate) async fn compressed(request: Request, next: Next) -> Response {
    let accepted = (request.headers().get(header::ACCEPT_ENCODING))
        .and_then(|v| v.to_str().ok())
        .is_some_and(|v| v.split(',').any(|way| way.trim() == "gzip"));
    let response = next.run(request).await;
    let kind = response.headers().get(header::CONTENT_TYPE);
    let kind = kind.and_then(|v| v.to_str().ok()).unwrap_or_default();
    let is_text = kind.starts_with("application/json") || kind.starts_with("text/");
    if !accepted || !is_text {
        return response;
    }
    let (mut parts, body) = response.into_parts();
    // The whole answer is in memory already.
    let bytes = match to_bytes(body, usize::MAX).await {
        Ok(bytes) => bytes,
        Err(e) => return (StatusCode::INTERNAL_SERVER_ERROR, e.to_string()).into_response(),
    };
    if bytes.len() < SHORT {
        return Response::from_parts(parts, Body::from(bytes));
    }
    let work = tokio::task::spawn_blocking(move || {
        let mut out = GzEncoder::new(Vec::new(), Compression::fast());
        out.write_all(&bytes).and_then(|()| out.finish())
    });
    match work.await {
        Ok(Ok(short)) => {
            parts.headers.remove(header::CONTENT_LENGTH);
            let gzip = HeaderValue::from_static("gzip");
            parts.headers.insert(header::CONTENT_ENCODING, gzip);
            let by = HeaderValue::from_static("accept-encoding");
            parts.headers.append(header::VARY, by);
            Response::from_parts(parts, Body::from(short))
        }
        _ => (
            StatusCode::INTERNAL_SERVER_ERROR,
            "the answer could not be compressed",
        )
            .into_response(),
    }
}
