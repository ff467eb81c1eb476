//! The routes.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use axum::Router;
use axum::body::Bytes;
use axum::extract::{Path, State};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use tokio::time::timeout;

use super::answers::{Refusal, answer};
use super::document::SaveError;
use super::jobs::{End, Job};
use super::{Open, Studio, assets, compressed};
use edifice_editing::examples::{example, examples};
use edifice_editing::history::steps;
use edifice_editing::work::Stopped;

/// Work that takes longer than this is a job.
const PATIENCE: Duration = Duration::from_millis(300);

type Answer = Result<Response, Refusal>;

/// The pages and the API, without the guard.
pub fn router(studio: Arc<Studio>) -> Router {
    let one = Router::new()
        .route("/", get(document))
        .route("/edit", post(edit))
        .route("/ask", post(ask))
        .route("/undo", post(undo))
        .route("/redo", post(redo))
        .route("/save", post(save))
        .route("/close", post(close))
        .route("/script", get(script))
        .route("/export/{format}", get(export));
    Router::new()
        .route("/api/documents", get(documents).post(open))
        .nest("/api/documents/{id}", one)
        .route("/api/unsaved/{id}/open", post(recover))
        .route("/api/unsaved/{id}/discard", post(discard))
        .route("/api/jobs/{id}", get(job))
        .route("/api/jobs/{id}/stop", post(stop))
        .fallback(assets::asset)
        .with_state(studio)
        .layer(axum::middleware::from_fn(compressed::compressed))
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

fn known(studio: &Studio, id: &str) -> Result<Arc<Mutex<Open>>, Refusal> {
    let missing = || Refusal(StatusCode::NOT_FOUND, format!("no document {id:?}"));
    studio.get(id).ok_or_else(missing)
}

/// Runs work on a document. One that another thread failed on is as it was before that edit.
async fn on<T: Send + 'static>(
    studio: &Studio,
    id: String,
    task: impl FnOnce(&mut Open, &str) -> Result<T, Refusal> + Send + 'static,
) -> Result<T, Refusal> {
    let document = known(studio, &id)?;
    work(move || task(&mut lock(&document), &id)).await
}

/// Refuses while other work is done on the document.
fn free(open: &Open) -> Result<(), Refusal> {
    let text = "work is done on this document: wait for it, or stop it";
    match open.job.as_ref().is_some_and(|j| !j.is_over()) {
        true => Err(Refusal(StatusCode::CONFLICT, text.into())),
        false => Ok(()),
    }
}

/// Waits a little for a job that was begun; then whoever asked is told of the job instead.
async fn waited(
    job: Arc<Job>,
    task: impl FnOnce(&Job) -> Result<Value, Refusal> + Send + 'static,
) -> Answer {
    let own = job.clone();
    let run = tokio::task::spawn_blocking(move || {
        let done = catch_unwind(AssertUnwindSafe(|| task(&own)));
        let done = done.unwrap_or_else(|_| {
            let text = "the method failed; the document is as it was before";
            Err(Refusal(StatusCode::INTERNAL_SERVER_ERROR, text.into()))
        });
        own.end(match &done {
            Ok(_) => End::Done,
            Err(_) if own.work.is_stopped() => End::Stopped,
            Err(refusal) => End::Failed(refusal.1.clone()),
        });
        done
    });
    match timeout(PATIENCE, run).await {
        Ok(Ok(done)) => done.map(|value| answer(&value)),
        // The runtime ends.
        Ok(Err(e)) => Err(Refusal(StatusCode::SERVICE_UNAVAILABLE, e.to_string())),
        Err(_) => {
            let told = answer(&json!({"job": job.shown()}));
            Ok((StatusCode::ACCEPTED, told).into_response())
        }
    }
}

fn lock(document: &Mutex<Open>) -> std::sync::MutexGuard<'_, Open> {
    document.lock().unwrap_or_else(PoisonError::into_inner)
}

async fn documents(State(studio): State<Arc<Studio>>) -> Answer {
    work(move || {
        let all = studio.all();
        let documents: Vec<Value> = all.iter().map(|(id, d)| lock(d).summary(id)).collect();
        let unsaved: Vec<Value> = studio.offered().iter().map(|o| o.shown()).collect();
        Ok(answer(&json!({
            "version": env!("CARGO_PKG_VERSION"), "readOnly": studio.read_only, "documents": documents,
            "examples": examples().collect::<Vec<_>>(), "unsaved": unsaved,
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
    let job = studio.jobs.begin(None);
    waited(job, move |job| {
        let start = example(&wanted.example, &job.work)?;
        if job.is_over() {
            return Err(Stopped.into());
        }
        let id = studio.add(Open::example(&wanted.example, start))?;
        job.made(&id);
        let document = known(&studio, &id)?;
        let whole = lock(&document).whole(&id)?;
        Ok(whole)
    })
    .await
}

async fn document(
    State(studio): State<Arc<Studio>>,
    Path(id): Path<String>,
    uri: axum::http::Uri,
) -> Answer {
    let shows = uri
        .query()
        .and_then(|q| q.strip_prefix("shows=")?.parse().ok());
    on(&studio, id, move |open, id| {
        Ok(answer(&open.whole_for(id, shows)?))
    })
    .await
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Edit {
    commands: Vec<Value>,
    /// The revision that is edited.
    revision: u64,
    /// The revision whose view the page has.
    #[serde(default)]
    shows: Option<u64>,
}

async fn edit(State(studio): State<Arc<Studio>>, Path(id): Path<String>, bytes: Bytes) -> Answer {
    let wanted: Edit = body(&bytes)?;
    let document = known(&studio, &id)?;
    let (state, job) = on(&studio, id.clone(), {
        let studio = studio.clone();
        move |open, id| {
            if open.document.revision() != wanted.revision {
                let text =
                    "the document was changed in another tab; this one now shows it as it is";
                return Err(Refusal(StatusCode::CONFLICT, text.into()));
            }
            free(open)?;
            let job = studio.jobs.begin(Some(id));
            open.job = Some(job.clone());
            Ok((open.document.state().clone(), job))
        }
    })
    .await?;
    waited(job, move |job| {
        // Others may read the document while this goes on: it changes at once, at the end.
        let start = Instant::now();
        let steps = steps(&state, &wanted.commands, &job.work)?;
        let mut open = lock(&document);
        if !job.end(End::Done) {
            return Err(Stopped.into());
        }
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        open.take(&wanted.commands, steps, milliseconds, studio.journals());
        Ok(open.whole_for(&id, wanted.shows)?)
    })
    .await
}

async fn ask(State(studio): State<Arc<Studio>>, Path(id): Path<String>, bytes: Bytes) -> Answer {
    let question: Value = body(&bytes)?;
    let state = on(&studio, id, |open, _| Ok(open.document.state().clone())).await?;
    let said = work(
        move || match question.get("preview").and_then(Value::as_array) {
            Some(commands) => {
                let made = steps(&state, commands, &edifice_editing::work::Work::default())?;
                let state = made.last().map_or(&state, |step| &step.state);
                Ok(json!({"view": state.view()?}))
            }
            None => Ok(state.ask(&question)?),
        },
    )
    .await?;
    Ok(answer(&said))
}

fn known_job(studio: &Studio, id: &str) -> Result<Arc<Job>, Refusal> {
    let missing = || Refusal(StatusCode::NOT_FOUND, format!("no job {id:?}"));
    studio.jobs.get(id).ok_or_else(missing)
}

async fn job(State(studio): State<Arc<Studio>>, Path(id): Path<String>) -> Answer {
    Ok(answer(&json!({"job": known_job(&studio, &id)?.shown()})))
}

async fn stop(State(studio): State<Arc<Studio>>, Path(id): Path<String>) -> Answer {
    let job = known_job(&studio, &id)?;
    job.stop();
    Ok(answer(&json!({"job": job.shown()})))
}

/// A step back or forth, for a page that shows a revision.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct Turn {
    #[serde(default)]
    shows: Option<u64>,
}

async fn turn(
    studio: Arc<Studio>,
    id: String,
    bytes: Bytes,
    step: fn(&mut Open, Option<&std::path::Path>),
) -> Answer {
    let wanted: Turn = match bytes.is_empty() {
        true => Turn::default(),
        false => body(&bytes)?,
    };
    let own = studio.clone();
    on(&studio, id, move |open, id| {
        free(open)?;
        step(open, own.journals());
        Ok(answer(&open.whole_for(id, wanted.shows)?))
    })
    .await
}

async fn undo(State(studio): State<Arc<Studio>>, Path(id): Path<String>, bytes: Bytes) -> Answer {
    turn(studio, id, bytes, Open::undo).await
}

async fn redo(State(studio): State<Arc<Studio>>, Path(id): Path<String>, bytes: Bytes) -> Answer {
    turn(studio, id, bytes, Open::redo).await
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Close {
    #[serde(default)]
    discard: bool,
}

async fn close(State(studio): State<Arc<Studio>>, Path(id): Path<String>, bytes: Bytes) -> Answer {
    let wanted: Close = body(&bytes)?;
    let own = studio.clone();
    on(&studio, id, move |open, id| {
        if open.is_unsaved() && !wanted.discard {
            let text = "the document has unsaved work: save it, or close it without saving";
            return Err(Refusal(StatusCode::CONFLICT, text.into()));
        }
        if let Some(job) = &open.job {
            job.stop();
        }
        open.forget();
        own.close(id);
        Ok(answer(&json!({})))
    })
    .await
}

fn offered(studio: &Studio, id: &str) -> Result<super::recovery::Offered, Refusal> {
    let missing = || Refusal(StatusCode::NOT_FOUND, format!("no unsaved work {id:?}"));
    studio.offer(id).ok_or_else(missing)
}

async fn recover(State(studio): State<Arc<Studio>>, Path(id): Path<String>) -> Answer {
    let offer = offered(&studio, &id)?;
    let job = studio.jobs.begin(None);
    waited(job, move |job| {
        let open = match offer.open(&job.work) {
            Ok(open) => open,
            Err((offer, error)) => {
                // It is offered again.
                studio.offered().push(*offer);
                return Err(error.into());
            }
        };
        let id = studio.add(open)?;
        job.made(&id);
        let document = known(&studio, &id)?;
        let whole = lock(&document).whole(&id)?;
        Ok(whole)
    })
    .await
}

async fn discard(State(studio): State<Arc<Studio>>, Path(id): Path<String>) -> Answer {
    offered(&studio, &id)?.discard();
    Ok(answer(&json!({})))
}

async fn script(State(studio): State<Arc<Studio>>, Path(id): Path<String>) -> Answer {
    let text = on(&studio, id, |open, _| Ok(open.document.script()?)).await?;
    Ok(([(header::CONTENT_TYPE, "text/plain; charset=utf-8")], text).into_response())
}

async fn export(
    State(studio): State<Arc<Studio>>,
    Path((id, format)): Path<(String, String)>,
) -> Answer {
    let state = on(&studio, id, |open, _| Ok(open.document.state().clone())).await?;
    let bytes = work(move || Ok(state.export(&format)?)).await?;
    // A drawing is data to be kept, never a page of this server.
    let kind = [(header::CONTENT_TYPE, "application/octet-stream")];
    Ok((kind, bytes).into_response())
}
