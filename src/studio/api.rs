//! The routes.

use std::sync::{Arc, Mutex, PoisonError};

use axum::Router;
use axum::body::Bytes;
use axum::extract::{Path, State};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use super::document::SaveError;
use super::{Open, Studio, assets};
use crate::editing::examples::examples;

/// What answers a request: its status, and what is wrong.
struct Refusal(StatusCode, String);

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (self.0, answer(&json!({"error": self.1}))).into_response()
    }
}

impl From<crate::Error> for Refusal {
    fn from(error: crate::Error) -> Self {
        Self(StatusCode::UNPROCESSABLE_ENTITY, error.to_string())
    }
}

impl From<SaveError> for Refusal {
    fn from(error: SaveError) -> Self {
        let status = match &error {
            SaveError::ReadOnly => StatusCode::FORBIDDEN,
            SaveError::Changed(_) => StatusCode::CONFLICT,
            SaveError::File(_) => StatusCode::UNPROCESSABLE_ENTITY,
        };
        Self(status, error.to_string())
    }
}

type Answer = Result<Response, Refusal>;

/// The pages and the API, without the guard.
pub fn router(studio: Arc<Studio>) -> Router {
    let one = Router::new()
        .route("/", get(document))
        .route("/edit", post(edit))
        .route("/undo", post(undo))
        .route("/redo", post(redo))
        .route("/save", post(save))
        .route("/script", get(script))
        .route("/export/{format}", get(export));
    Router::new()
        .route("/api/documents", get(documents).post(open))
        .nest("/api/documents/{id}", one)
        .fallback(assets::asset)
        .with_state(studio)
}

fn answer(value: &Value) -> Response {
    let kind = [(header::CONTENT_TYPE, "application/json")];
    (kind, value.to_string()).into_response()
}

fn body<T: DeserializeOwned>(bytes: &Bytes) -> Result<T, Refusal> {
    serde_json::from_slice(bytes).map_err(|e| Refusal(StatusCode::BAD_REQUEST, e.to_string()))
}

/// Runs work that takes time beside the server's own threads.
async fn work<T: Send + 'static>(
    task: impl FnOnce() -> Result<T, Refusal> + Send + 'static,
) -> Result<T, Refusal> {
    let failed = |_| {
        Refusal(
            StatusCode::INTERNAL_SERVER_ERROR,
            "the method failed".into(),
        )
    };
    tokio::task::spawn_blocking(task).await.map_err(failed)?
}

/// Runs work on a document. One that another thread failed on is as it was before that edit.
async fn on<T: Send + 'static>(
    studio: &Studio,
    id: String,
    task: impl FnOnce(&mut Open, &str) -> Result<T, Refusal> + Send + 'static,
) -> Result<T, Refusal> {
    let missing = || Refusal(StatusCode::NOT_FOUND, format!("no document {id:?}"));
    let (_, document) = studio.get(&id).ok_or_else(missing)?;
    work(move || task(&mut lock(&document), &id)).await
}

fn lock(document: &Mutex<Open>) -> std::sync::MutexGuard<'_, Open> {
    document.lock().unwrap_or_else(PoisonError::into_inner)
}

async fn documents(State(studio): State<Arc<Studio>>) -> Answer {
    work(move || {
        let all = studio.all();
        let each = all.iter().enumerate();
        let documents: Vec<Value> = each
            .map(|(k, d)| lock(d).summary(&format!("d{}", k + 1)))
            .collect();
        Ok(answer(&json!({
            "version": env!("CARGO_PKG_VERSION"), "readOnly": studio.read_only, "documents": documents,
            "examples": examples().collect::<Vec<_>>(),
        })))
    })
    .await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OpenExample {
    example: String,
}

async fn open(State(studio): State<Arc<Studio>>, bytes: Bytes) -> Answer {
    let wanted: OpenExample = body(&bytes)?;
    work(move || {
        let id = format!("d{}", studio.open_example(&wanted.example)? + 1);
        let (_, document) = studio
            .get(&id)
            .ok_or(Refusal(StatusCode::NOT_FOUND, id.clone()))?;
        let whole = lock(&document).whole(&id)?;
        Ok(answer(&whole))
    })
    .await
}

async fn document(State(studio): State<Arc<Studio>>, Path(id): Path<String>) -> Answer {
    on(&studio, id, |open, id| Ok(answer(&open.whole(id)?))).await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Edit {
    commands: Vec<Value>,
    /// The revision that the page shows.
    revision: u64,
}

async fn edit(State(studio): State<Arc<Studio>>, Path(id): Path<String>, bytes: Bytes) -> Answer {
    let wanted: Edit = body(&bytes)?;
    on(&studio, id, move |open, id| {
        if open.document.revision() != wanted.revision {
            let text = "the document was changed in another tab; this one now shows it as it is";
            return Err(Refusal(StatusCode::CONFLICT, text.into()));
        }
        open.edit(&wanted.commands)?;
        Ok(answer(&open.whole(id)?))
    })
    .await
}

async fn undo(State(studio): State<Arc<Studio>>, Path(id): Path<String>) -> Answer {
    on(&studio, id, |open, id| {
        open.document.undo();
        Ok(answer(&open.whole(id)?))
    })
    .await
}

async fn redo(State(studio): State<Arc<Studio>>, Path(id): Path<String>) -> Answer {
    on(&studio, id, |open, id| {
        open.document.redo();
        Ok(answer(&open.whole(id)?))
    })
    .await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Save {
    #[serde(default)]
    overwrite: bool,
}

async fn save(State(studio): State<Arc<Studio>>, Path(id): Path<String>, bytes: Bytes) -> Answer {
    let wanted: Save = body(&bytes)?;
    if studio.read_only {
        return Err(SaveError::ReadOnly.into());
    }
    on(&studio, id, move |open, _| {
        let [file, script] = open.save(wanted.overwrite)?;
        Ok(answer(&json!({"file": file, "script": script})))
    })
    .await
}

async fn script(State(studio): State<Arc<Studio>>, Path(id): Path<String>) -> Answer {
    let text = on(&studio, id, |open, _| Ok(open.document.script()?)).await?;
    Ok(([(header::CONTENT_TYPE, "text/plain; charset=utf-8")], text).into_response())
}

async fn export(
    State(studio): State<Arc<Studio>>,
    Path((id, format)): Path<(String, String)>,
) -> Answer {
    let bytes = on(&studio, id, move |open, _| {
        Ok(open.document.state().export(&format)?)
    })
    .await?;
    // A drawing is data to be kept, never a page of this server.
    let kind = [(header::CONTENT_TYPE, "application/octet-stream")];
    Ok((kind, bytes).into_response())
}
