//! Answers as JSON, and refusals with their status.

use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde_json::{Value, json};

use super::document::SaveError;
use edifice_editing::work::Stopped;

/// An answer as JSON.
pub(super) fn answer(value: &Value) -> Response {
    let kind = [(header::CONTENT_TYPE, "application/json")];
    (kind, value.to_string()).into_response()
}

/// The refusal of a request: its status, and the reason.
pub(super) struct Refusal(pub(super) StatusCode, pub(super) String);

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (self.0, answer(&json!({"error": self.1}))).into_response()
    }
}

impl From<edifice_base::Error> for Refusal {
    fn from(error: edifice_base::Error) -> Self {
        Self(StatusCode::UNPROCESSABLE_ENTITY, error.to_string())
    }
}

impl From<Stopped> for Refusal {
    fn from(stopped: Stopped) -> Self {
        Self(StatusCode::CONFLICT, stopped.to_string())
    }
}

impl From<SaveError> for Refusal {
    fn from(error: SaveError) -> Self {
        let status = match &error {
            SaveError::ReadOnly | SaveError::Link(_) => StatusCode::FORBIDDEN,
            SaveError::Changed(_) => StatusCode::CONFLICT,
            SaveError::File(_) => StatusCode::UNPROCESSABLE_ENTITY,
        };
        Self(status, error.to_string())
    }
}
